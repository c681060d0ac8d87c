"""Kernels to take away: they build and run where geocosserat is not, and both languages print the same numbers."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocosserat.conductor.derive import generate
from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.load import load
from tests.discretisation.rods import CAST, FROZEN, JOINED, VISCOUS, changed

STEPS = "12"
SCENES = (
    "planar everything", "spatial everything", "planar held", "spatial hung", "spatial reeled", "planar cranked",
    "planar ring", "spatial ring", "planar creeping", "spatial damped",
)  # fmt: skip


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Folders of taken-away kernels by scene and backend, each written once."""

    @cache
    def folder(name: str, backend: str, degree: int = 4) -> Path:
        place = tmp_path_factory.mktemp(backend)
        scene = changed(name, run={"until": 0.05, "elements": 3, "degree": degree})
        generate(scene, backend, place)
        return place

    return folder


def run(command: list[str], folder: Path, *, path: bool = True) -> str:
    """Standard output of a command in an otherwise empty environment; it may say nothing else."""
    environment = {"PATH": os.environ["PATH"]} if path else {}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    return done.stdout


def built(folder: Path, *flags: str) -> Path:
    if shutil.which("make") is None:
        pytest.skip("no make on the path")
    run(["make", f"CC={os.environ.get('CC') or 'cc'}", *flags], folder)
    return folder / "driver"


def python(folder: Path, *, optimised: bool = False) -> str:
    """What the numpy driver prints where only numpy can be imported."""
    for name in ("geocosserat", "sympy", "scipy", "jinja2", "cffi"):
        (folder / f"{name}.py").write_text("raise ImportError('the driver needs numpy only')\n")
    return run([sys.executable, "-E", "-s", "-W", "error", "driver.py", STEPS], folder, path=False)


def numbers(printed: str) -> dict[str, list[float]]:
    """The numbers of each line by its words."""
    found = {}
    for line in printed.splitlines():
        values = re.findall(r"-?\d\.\d+e[+-]\d+", line)
        found[line.split(values[0])[0].strip()] = [float(v) for v in values]
    return found


@pytest.mark.parametrize("name", SCENES)
def test_both_drivers_print_the_same_numbers(name: str, folders: Any, c_compiler: str) -> None:
    """Built with make and with numpy alone, to 1e-11; the run dissipates, and its turns are finite."""
    driver = built(folders(name, "c"), "CFLAGS=-O1 -Wall -Wextra -Werror")
    c = numbers(run([str(driver), STEPS], driver.parent))
    numpy = numbers(python(folders(name, "numpy")))
    assert list(c) == list(numpy)
    assert list(c)[4:] == signature(folders(name, "c"))["state"]
    for words, values in c.items():
        np.testing.assert_allclose(values, numpy[words], rtol=1e-11, atol=1e-11, err_msg=words)
    assert c["dissipated"][0] > 0


def signature(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / "signature.json").read_text())
    return found


@pytest.mark.parametrize(("name", "degree"), list(zip(SCENES, (1, 1, 4, 4, 1, 4, 1, 4, 4, 1), strict=True)))
def test_the_kernel_stays_inside_the_memory_it_asks_for(
    name: str, degree: int, folders: Any, tmp_path: Path, c_compiler: str
) -> None:
    """Under the address and undefined-behaviour sanitisers: what the kernel asks for is enough, and all is given
    back, where the machine lets them look for leaks."""
    folder = tmp_path / "checked"
    shutil.copytree(folders(name, "c", degree), folder, ignore=shutil.ignore_patterns("driver"))
    flags = "-O0 -g -fsanitize=address,undefined -fno-sanitize-recover"
    (tmp_path / "empty.c").write_text("int main(void) { return 0; }\n")
    probe = [c_compiler, *flags.split(), "empty.c", "-o", "empty"]
    if subprocess.run(probe, cwd=tmp_path, capture_output=True).returncode:
        pytest.skip("this compiler has no sanitisers")
    driver = built(folder, f"CFLAGS={flags}")
    looks = subprocess.run(["./empty"], cwd=tmp_path, capture_output=True).returncode == 0
    environment = {"PATH": os.environ["PATH"], "ASAN_OPTIONS": f"detect_leaks={int(looks)}"}
    done = subprocess.run([str(driver), "2"], cwd=folder, env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr[:2000]


def test_a_driver_starts_from_the_rate_of_the_scene(folders: Any) -> None:
    """The first line is the norm of the rate at the start, which the kernel in the program gives as well."""
    r = discretise(changed("planar everything"), 3, 4)
    out = np.empty_like(r.state)
    load(kernel_text(r.structure), r, "numpy").rate(0.0, r.state, out)
    printed = numbers(python(folders("planar everything", "numpy")))
    assert printed["initial rate"][0] == pytest.approx(np.linalg.norm(out), rel=1e-13)


CHECK = """
import sys
sys.path.insert(0, ".")
import driver as d
import numpy as np
d.rod.rate(d.scene["until"], d.y, d.rate)
print(np.abs(d.rate[d.held]).max(), np.abs(d.rate[~d.held]).max(), d.change @ d.change)
"""


@pytest.mark.parametrize("name", [name for name in SCENES if name in (*FROZEN, *JOINED, *VISCOUS)])
def test_a_driver_keeps_frozen_modes_frozen_and_viscous_ones_at_their_law(name: str, folders: Any) -> None:
    """At the end of the run what must vanish has vanished, to round-off of what moves; and Newton's method had come to
    an end."""
    folder = folders(name, "numpy")
    printed = run([sys.executable, "-E", "-c", CHECK, STEPS], folder, path=False)
    strayed, moved, last = (float(x) for x in printed.split()[-3:])
    assert strayed < 1e-9 * moved
    assert last < 1e-20


@pytest.mark.parametrize("backend", ["c", "numpy"])
def test_the_signature_tells_what_the_arrays_hold(backend: str, folders: Any) -> None:
    """Names and order of all coefficients, of turn and twist; group, ends, operations."""
    found = signature(folders("planar everything", backend))
    assert found["state"] == ["h1", "h2", "Pi"]
    assert found["frozen"] == []
    assert found["ends"] == ["free", "free"]
    assert (found["base"], found["sight"]) == ("left", "direction")
    assert found["twist"] == ["v1", "v2", "Omega"]
    assert found["group"] == "SE(2)"
    assert found["carried"] == 3
    assert "p_int" in found["uniform"]
    assert "k_1_1" in found["point"]
    assert "mobility_1_1" in found["node"]


@pytest.mark.parametrize("title", ['*/ int main; /*', '""" + exit() + """', "ends in a backslash \\"])
def test_no_title_breaks_a_driver(title: str, tmp_path: Path, c_compiler: str) -> None:
    """In the kernel, the driver and the Makefile alike."""
    scene = CAST["planar plain"] | {"title": title, "run": {"until": 0.01, "elements": 1, "degree": 2}}
    for backend in ("c", "numpy"):
        generate(scene, backend, tmp_path / backend)
    driver = built(tmp_path / "c", "CFLAGS=-O1 -Wall -Wextra -Werror")
    assert numbers(run([str(driver), "2"], driver.parent))["work"] == [0.0]
    assert numbers(python(tmp_path / "numpy"))["work"] == [0.0]


def test_a_driver_with_no_steps_says_so(folders: Any, c_compiler: str) -> None:
    """Not an endless loop or a division by zero."""
    driver = built(folders("planar held", "c"))
    done = subprocess.run([str(driver), "0"], capture_output=True, text=True, timeout=20)
    assert done.returncode == 1
