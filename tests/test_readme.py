"""The README's code does what the README says."""

import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocosserat
from tests.marks import slow

ROOT = Path(__file__).parents[1]
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```", (ROOT / "README.md").read_text(), re.MULTILINE | re.DOTALL)


def blocks(language: str) -> list[str]:
    return [text for found, text in BLOCKS if found == language]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "helix.toml").write_text(blocks("toml")[0])
    (tmp_path / "law.toml").write_text(blocks("toml")[1])
    return tmp_path


def _environment() -> dict[str, str]:
    paths = [str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}


def _lines() -> list[Any]:
    """All shell lines; quick is the first one of each command, but for that of the law, which is asked more below."""
    lines = [line for block in blocks("sh") for line in block.splitlines()]
    firsts = {line.split()[1]: line for line in reversed(lines)}
    return [line if line in firsts.values() and "check" not in line else slow(line) for line in lines]


@pytest.mark.parametrize("line", _lines())
def test_every_command_of_the_readme_works(line: str, folder: Path) -> None:
    """Each shell line runs as printed and says something."""
    words = shlex.split(line)
    assert words[0] == "geocosserat"
    done = subprocess.run(
        [sys.executable, "-m", *words], cwd=folder, env=_environment(), capture_output=True, text=True, timeout=300
    )
    assert done.returncode == (1 if words[1] == "check" else 0), done.stderr  # the law is not passive
    assert done.stdout
    if "--json" in words:
        assert json.loads(done.stdout)["error"]["estimated"] <= 1e-8
    if "--out" in words:
        assert any((folder / words[words.index("--out") + 1]).iterdir())


def test_what_the_readme_says_of_its_law_is_so() -> None:
    """The verdict, the condition, the witness, and a rod of the law."""
    law = blocks("toml")[1]
    found = geocosserat.check(law)
    assert (found.verdict, found.grade, found.conditions) == ("active", "proved", ["passive if and only if a = 0"])
    gain = geocosserat.run(found.found.scenes["stress"], settings=["run.backend=numpy"]).ledger["dissipated"]
    assert -gain == pytest.approx(found.stress["witness"]["work"], rel=1e-6)


def test_the_python_of_the_readme_works(folder: Path) -> None:
    """The Python block runs as printed and prints a tip, a shape and equations."""
    done = subprocess.run(
        [sys.executable, "-c", blocks("python")[0]],
        cwd=folder,
        env=_environment(),
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert "(11, " in done.stdout
    assert "Compatibility" in done.stdout


def test_the_twelve_lines_make_the_rod_of_the_demo(folder: Path, examples: Path) -> None:
    """The README's short scene and the demo's scene end at the same place."""
    assert len(blocks("toml")[0].splitlines()) == 12
    short = geocosserat.run(folder / "helix.toml", settings=["run.frames=2"])
    demo = geocosserat.run(examples / "helix.toml", settings=["run.frames=2"])
    np.testing.assert_allclose(short.tip["position"], demo.tip["position"], rtol=0, atol=2e-6)


@pytest.mark.slow
def test_the_scene_of_the_documentation_runs() -> None:
    """The annotated scene in docs/scenes.md is a scene; it is run coarsely."""
    text = (ROOT / "docs" / "scenes.md").read_text()
    scene = re.findall(r"^```toml\n(.*?)^```", text, re.MULTILINE | re.DOTALL)[0]
    run = geocosserat.run(scene, settings=["run.frames=2", "run.elements=2", "run.degree=5", "run.until=0.05"])
    assert run.reached
