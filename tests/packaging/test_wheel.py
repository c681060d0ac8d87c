"""What a user installs: the wheel, built through the source distribution, tried where no checkout is in sight."""

import json
import os
import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

from geocosserat.kernel.compile import compiler

ROOT = Path(__file__).parents[2]
SCENE = ROOT / "examples" / "cantilever.toml"


def _run(*command: str | Path, cwd: Path, **environment: str) -> str:
    """Standard output of a command that must succeed; of this environment it sees only the search path, and CC with
    what benchmarks/sanitize.py sets beside it."""
    kept = {name: os.environ[name] for name in ("PATH", "CC", "LD_PRELOAD", "ASAN_OPTIONS") if name in os.environ}
    environment = kept | environment
    done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Built as for a release: the checkout to a source distribution, that one to a wheel. No network."""
    folder = tmp_path_factory.mktemp("dist")
    _run(sys.executable, "-m", "build", "--no-isolation", "--outdir", folder, ROOT, cwd=folder)
    (found,) = folder.glob("*.whl")
    return found


@pytest.fixture(scope="module")
def elsewhere(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A new environment that holds the wheel and borrows its dependencies from this one, but not the checkout.

    Borrowed folders stand in a .pth file: Python does not read the .pth files inside them, editable installs included.
    """
    folder = tmp_path_factory.mktemp("elsewhere")
    venv.create(folder / "venv", symlinks=True, with_pip=False)
    python = folder / "venv" / "bin" / "python"
    options = ("--no-deps", "--no-index", "--disable-pip-version-check")
    _run(sys.executable, "-m", "pip", "--python", python, "install", *options, wheel, cwd=folder)
    (packages,) = (folder / "venv").glob("lib/python*/site-packages")
    borrowed = [path for path in sys.path if path.endswith(("site-packages", "dist-packages"))]
    (packages / "borrowed.pth").write_text("\n".join(borrowed) + "\n")
    return folder


def _files(folder: str, name: str) -> set[str]:
    """The files of a folder of the checkout, as they should be named in the wheel."""
    paths = (path for path in (ROOT / folder).rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return {f"{name}/{path.relative_to(ROOT / folder)}" for path in paths}


def test_the_wheel_holds_the_package_its_templates_and_its_kernels(wheel: Path) -> None:
    """Every module, template and generated kernel, what is checked of the paper, the licence; and nothing else."""
    names = {name for name in zipfile.ZipFile(wheel).namelist() if not name.endswith("/")}
    inside = {name for name in names if name.startswith("geocosserat/")}
    templates, kernels = (_files(folder, f"geocosserat/{folder}") for folder in ("templates", "generated"))
    assert templates
    assert kernels
    assert inside == _files("geocosserat", "geocosserat") | templates | kernels
    assert "geocosserat/py.typed" in inside
    records = _files("paper_checks", "paper_checks")
    assert "paper_checks/ids.json" in records
    assert {name for name in names if name.startswith("paper_checks/")} == records
    rest = {Path(name).name for name in names - inside - records}
    assert rest == {"METADATA", "WHEEL", "RECORD", "entry_points.txt", "LICENSE"}


def test_the_installed_package_finds_its_own_files(elsewhere: Path) -> None:
    """Not those of the checkout."""
    code = "from geocosserat.shipped import shipped; print(shipped('templates'), shipped('generated'))"
    found = _run(elsewhere / "venv" / "bin" / "python", "-c", code, cwd=elsewhere).split()
    assert len(found) == 2
    assert all(Path(path).is_relative_to(elsewhere / "venv") for path in found), found


def test_the_installed_program_runs_a_scene_from_anywhere(elsewhere: Path) -> None:
    """One JSON object on standard output; the files it names are there; a shipped kernel needs no derivation."""
    program, cache = elsewhere / "venv" / "bin" / "geocosserat", elsewhere / "cache"
    home = {"HOME": str(elsewhere), "GEOCOSSERAT_CACHE": str(cache)}
    fields = json.loads(_run(program, "run", SCENE, "--json", "--out", "out", cwd=elsewhere, **home))
    assert fields["reached"]
    assert fields["files"]
    assert all((elsewhere / file).stat().st_size > 0 for file in fields["files"])
    assert fields["backend"] == ("numpy" if compiler() is None else "c")
    assert not list(cache.glob("*.json")), "expected a shipped kernel, found one generated"


def test_the_installed_package_judges_the_paper_and_shows_how(elsewhere: Path) -> None:
    """The first statement is enough: records, their source, the template and the converter of formulas are there."""
    code = """
from geocosserat.referee.page import page
from geocosserat.referee.report import review
from geocosserat.referee.statement import Section
from paper_checks import SECTIONS
first = Section(SECTIONS[0].title)
first.statements.append(SECTIONS[0].statements[0])
report = review([first])
text = page(report, "one statement")
print(report.passed, "<math" in text, "print(verdict_on(" in text)
"""
    assert _run(elsewhere / "venv" / "bin" / "python", "-c", code, cwd=elsewhere).split() == ["True"] * 3


def test_the_version_installed_is_the_one_in_the_source(elsewhere: Path) -> None:
    """One place holds it: geocosserat/version.py."""
    code = "import importlib.metadata as m, geocosserat.version as v; print(m.version('geocosserat'), v.VERSION)"
    assert len(set(_run(elsewhere / "venv" / "bin" / "python", "-c", code, cwd=elsewhere).split())) == 1
