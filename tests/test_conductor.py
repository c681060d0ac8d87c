"""From a scene to files: what `geocosserat.run`, `derive` and `generate` take, give and write."""

from __future__ import annotations

import dataclasses
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray

import geocosserat
from geocosserat.conductor import kernels
from geocosserat.kernel import compile as compiling
from geocosserat.kernel.compile import CompileError
from geocosserat.model.errors import InputError
from geocosserat.model.scene import load_scene
from geocosserat.results.netcdf import dataset
from geocosserat.results.summary import summary

QUICK = ("run.elements=1", "run.degree=4", "run.frames=4", "run.backend=numpy")
"""Settings of a run that takes no time."""
FILES = {"solution.nc", "picture.png", "summary.json"}


@pytest.fixture
def cantilever(examples: Path) -> Path:
    """A planar scene whose kernel comes with the program."""
    return examples / "cantilever.toml"


@pytest.fixture
def no_compiler(monkeypatch: pytest.MonkeyPatch) -> None:
    """CC="" says: use no compiler."""
    monkeypatch.setenv("CC", "")
    monkeypatch.setattr(compiling, "compiler", compiling.compiler.__wrapped__)
    monkeypatch.setattr(kernels, "compiler", compiling.compiler)


def test_a_scene_may_be_a_path_a_text_a_mapping_or_read_already(cantilever: Path) -> None:
    """All four give the same rod."""
    scene = load_scene(cantilever)
    forms: list[Any] = [cantilever, str(cantilever), cantilever.read_text(), scene]
    tips = [geocosserat.run(form, settings=QUICK).tip for form in forms]
    assert all(tip == tips[0] for tip in tips)


def test_settings_change_a_scene_that_was_read_already(cantilever: Path) -> None:
    """As they change its file."""
    scene = load_scene(cantilever)
    settings = (*QUICK, "kappa=50")
    found = geocosserat.run(scene, settings=settings)
    assert found.tip == geocosserat.run(cantilever, settings=settings).tip
    assert found.tip != geocosserat.run(scene, settings=QUICK).tip


def test_a_run_has_the_fields_of_its_json_as_attributes(cantilever: Path) -> None:
    """And says which they are when asked for another."""
    run = geocosserat.run(cantilever, settings=QUICK)
    assert dict(run.fields) == summary(run.solution, scene=str(cantilever))
    assert all(getattr(run, name) == value for name, value in run.fields.items())
    with pytest.raises(AttributeError, match="a run has no field 'tipp'; it has scene, title, motion"):
        _ = run.tipp


def test_a_solution_says_how_it_came_about(cantilever: Path) -> None:
    """Method, mesh, backend, tolerance, versions, and the scene as text that runs to the same solution."""
    run = geocosserat.run(cantilever, settings=[*QUICK, "kappa=2e3", "run.method=bdf", "run.rtol=1e-5"])
    solution = run.solution
    assert (solution.method, solution.elements, solution.degree, solution.backend) == ("bdf", 1, 4, "numpy")
    assert {"geocosserat", "python", "numpy", "platform", "kernel", "kernel_origin", "rtol", "date"} <= set(
        solution.provenance
    )
    assert float(solution.provenance["rtol"]) == 1e-5
    assert solution.unknowns == 12
    again = geocosserat.run(solution.scene).solution
    volatile = {"seconds": solution.seconds, "provenance": solution.provenance}
    assert dataclasses.replace(again, **volatile) == solution


def test_frames_are_even_from_zero_to_the_end(cantilever: Path) -> None:
    """The first is the start of the scene: the reference, bent as given."""
    solution = geocosserat.run(cantilever, settings=[*QUICK, "run.frames=6"]).solution
    np.testing.assert_allclose(solution.time, np.linspace(0.0, 0.05, 6), rtol=1e-15)
    u = solution.u_point
    start = np.stack([1.0 + 0.0 * u, 0.0 * u, 3 * (1 - u) ** 2 * (1 + 2 * u)], axis=1)
    np.testing.assert_allclose(solution.turn[0], start, rtol=0, atol=1e-14)
    np.testing.assert_array_equal(solution.position[:, 0], 0.0)


def test_time_spent_is_booked_once(cantilever: Path) -> None:
    """Attempts before the one that is reported are planning; a fixed mesh needs none."""
    fixed = geocosserat.run(cantilever, settings=QUICK).seconds
    assert fixed["plan"] == 0.0
    assert fixed["solve"] > 0.0
    refined = geocosserat.run(cantilever, settings=["run.backend=numpy", "run.frames=2"]).seconds
    assert min(refined["plan"], refined["solve"]) > 0.0


def test_files_hold_what_the_run_returned(cantilever: Path, tmp_path: Path) -> None:
    """solution.nc reads back bit for bit, summary.json is the fields, the picture is one, nothing else is there."""
    run = geocosserat.run(cantilever, tmp_path / "deep" / "out", settings=QUICK)
    folder = tmp_path / "deep" / "out"
    assert {path.name for path in folder.iterdir()} == FILES
    assert run.files == [str(folder / name) for name in ("solution.nc", "picture.png", "summary.json")]
    assert geocosserat.load(folder / "solution.nc") == run.solution
    assert json.loads((folder / "summary.json").read_text()) == run.fields
    picture = (folder / "picture.png").read_bytes()
    assert picture.startswith(b"\x89PNG\r\n\x1a\n")
    assert len(picture) > 5_000


def test_the_solution_file_has_the_agreed_names(examples: Path, tmp_path: Path) -> None:
    """Dimensions, coordinates and variables, in space."""
    geocosserat.run(examples / "helix.toml", tmp_path, settings=QUICK)
    with dataset(tmp_path / "solution.nc") as data:
        assert isinstance(data, xarray.Dataset)
        assert dict(data.sizes) == {"time": 4, "node": 5, "point": 4, "component": 6, "axis": 3, "frame": 3}
        assert data.position.dims == ("time", "node", "axis")
        assert data.twist.dims == ("time", "node", "component")
        assert data.turn.dims == data.stress.dims == ("time", "point", "component")
        assert {"energy", "dissipated", "work", "rotation", "u", "u_point"} <= set(data.variables)


def test_results_are_not_overwritten_unless_asked_for(cantilever: Path, tmp_path: Path) -> None:
    """Before anything is computed; with `overwrite` the files are the new ones."""
    first = geocosserat.run(cantilever, tmp_path, settings=QUICK)
    with pytest.raises(InputError, match=r"--out: expected none of these files in .* yet, found solution.nc, picture"):
        geocosserat.run(cantilever, tmp_path, settings=[*QUICK, "kappa=10"])
    assert geocosserat.load(tmp_path / "solution.nc") == first.solution
    second = geocosserat.run(cantilever, tmp_path, settings=[*QUICK, "kappa=10"], overwrite=True)
    assert geocosserat.load(tmp_path / "solution.nc") == second.solution
    assert {path.name for path in tmp_path.iterdir()} == FILES


def test_other_files_in_the_folder_stay(cantilever: Path, tmp_path: Path) -> None:
    """A folder that holds something else is no obstacle."""
    (tmp_path / "notes.txt").write_text("mine")
    geocosserat.run(cantilever, tmp_path, settings=QUICK, overwrite=True)
    assert (tmp_path / "notes.txt").read_text() == "mine"


@pytest.mark.parametrize("wrong", [["kapa=1"], ["rod.length=-1"], ["run.backend=c"]])
def test_wrong_input_leaves_no_trace(cantilever: Path, tmp_path: Path, wrong: list[str], no_compiler: None) -> None:
    """Not even the folder, also when C is asked for and cannot be had."""
    with pytest.raises(InputError):
        geocosserat.run(cantilever, tmp_path / "out", settings=wrong)
    assert not (tmp_path / "out").exists()


def test_a_solution_that_fits_into_no_memory_is_refused(cantilever: Path, tmp_path: Path) -> None:
    """Before anything is computed, and with nothing left behind."""
    settings = ["run.frames=100000", "run.elements=10000", "run.degree=1"]
    with pytest.raises(InputError, match=r"run.frames: expected at most 268435456 numbers.*100000 frames of 30002"):
        geocosserat.run(cantilever, tmp_path / "out", settings=settings)
    assert list(tmp_path.iterdir()) == []


def test_without_a_compiler_numpy_takes_over_and_says_so(
    cantilever: Path, no_compiler: None, capfd: pytest.CaptureFixture[str]
) -> None:
    """The same tip, one line on standard error, none on standard output."""
    run = geocosserat.run(cantilever, settings=["run.frames=2"])
    assert run.backend == "numpy"
    out, err = capfd.readouterr()
    assert out == ""
    assert err == "no C compiler found: running on numpy, with the same results in more time\n"
    np.testing.assert_allclose(run.tip["position"], [0.82507706946494, 0.51831043029012], atol=1e-6)


def test_a_compiler_that_fails_is_an_error_only_if_c_was_asked_for(
    cantilever: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """Else numpy takes over, and the compiler's words are on standard error."""
    for module in (compiling, kernels):
        monkeypatch.setattr(module, "compiler", lambda: "/bin/false")
    settings = ("run.elements=1", "run.degree=4", "run.frames=2")
    run = geocosserat.run(cantilever, settings=settings)
    assert run.backend == "numpy"
    assert "running on numpy instead" in capfd.readouterr().err
    with pytest.raises(CompileError, match="/bin/false failed on a generated kernel"):
        geocosserat.run(cantilever, settings=[*settings, "run.backend=c"])


def test_a_run_that_cannot_go_on_returns_what_it_has(cantilever: Path, tmp_path: Path) -> None:
    """A tolerance below round-off: the start is kept, written and readable, with the reason."""
    run = geocosserat.run(cantilever, tmp_path, settings=[*QUICK, "run.rtol=1e-30", "run.atol=1e-300"])
    assert not run.reached
    assert "CVODE stopped at t = 0" in run.reason
    assert run.until < 0.05
    loaded = geocosserat.load(tmp_path / "solution.nc")
    assert loaded == run.solution
    assert len(loaded.time) < 4
    assert json.loads((tmp_path / "summary.json").read_text())["reached"] is False


def test_a_kernel_is_generated_once_and_found_again(tmp_path: Path) -> None:
    """A rod that comes with no kernel: generated, then from the cache; a damaged cache is generated again."""
    rod = {"motion": "planar", "length": 1.0, "stiffness": [100.0, 90.0, 1.0], "friction": [1.0, 2.0, 0.01],
           "reference": ["1", "0.001*u", "u"]}  # fmt: skip
    scene = {"rod": rod, "run": {"until": 0.01, "frames": 2, "elements": 1, "degree": 3, "backend": "numpy"}}
    code = (
        "import json, sys, geocosserat\n"
        f"run = geocosserat.run({scene!r})\n"
        "slow = [name for name in ('sympy', 'jinja2', 'matplotlib') if name in sys.modules]\n"
        "print(json.dumps([run.solution.provenance['kernel_origin'], slow, run.tip]))"
    )
    cache = tmp_path / "cache"

    def origin() -> tuple[str, list[str], Any]:
        done = subprocess.run(
            [sys.executable, "-W", "error", "-c", code],
            env={**os.environ, "GEOCOSSERAT_CACHE": str(cache), "PYTHONPATH": os.pathsep.join(sys.path)},
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        found, slow, tip = json.loads(done.stdout)
        return found, slow, tip

    first, second = origin(), origin()
    assert first[:2] == ("generated", ["sympy", "jinja2"])
    assert second == ("cache", [], first[2])
    for file in cache.glob("*.json"):
        file.write_text(file.read_text()[:-40])
    assert origin() == first


def test_derived_equations_print_in_two_ways(cantilever: Path) -> None:
    """Readable, as LaTeX, and as fields; plain ASCII where the terminal has no more."""
    equations = geocosserat.derive(cantilever)
    assert str(equations) == equations.text
    assert "F" in equations.text
    assert "\\" in equations.latex
    assert equations.fields["parameters"] == {"kappa": 1e4}
    assert equations.fields["sees_the_world"] is False
    assert geocosserat.derive(cantilever, unicode=False).text.isascii()
    world = geocosserat.derive(cantilever.parent / "elastica.toml")
    assert world.fields["sees_the_world"] is True
    with pytest.raises(InputError, match="--form: expected one of intrinsic"):
        geocosserat.derive(cantilever, "extrinsic")


@pytest.mark.parametrize("backend", ["c", "numpy"])
def test_generated_kernels_run_without_this_program(
    cantilever: Path, tmp_path: Path, backend: str, request: pytest.FixtureRequest
) -> None:
    """Their driver, alone in its folder, relaxes the rod: stored + dissipated is what there was."""
    build, command = [], [sys.executable, "driver.py", "60"]
    if backend == "c":
        compiler = request.getfixturevalue("c_compiler")
        build = [compiler, "-std=c99", "-O1", "-DDEGREE=8", "rod.c", "driver.c", "-lm", "-o", "driver"]
        command = ["./driver", "400"]
    done = geocosserat.generate(cantilever, backend, tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {path.name for path in done.files}
    assert done.signature
    for words in filter(None, (build, command)):
        result = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=True, timeout=120)
    numbers = {line[:14].strip(): float(line[14:]) for line in result.stdout.splitlines()[:4]}
    relaxed = geocosserat.run(cantilever, settings=["run.backend=numpy", "run.frames=2"])
    assert numbers["final energy"] == pytest.approx(relaxed.energy["end"], rel=0.1)
    assert numbers["dissipated"] == pytest.approx(relaxed.ledger["dissipated"], rel=0.05)
    assert numbers["work"] == 0.0


def test_generated_files_are_not_overwritten_unless_asked_for(cantilever: Path, tmp_path: Path) -> None:
    """As results are not."""
    geocosserat.generate(cantilever, "numpy", tmp_path)
    with pytest.raises(InputError, match="--out: expected none of these files"):
        geocosserat.generate(cantilever, "numpy", tmp_path)
    geocosserat.generate(cantilever, "numpy", tmp_path, overwrite=True)
    with pytest.raises(InputError, match='--backend: expected "c" or "numpy", found \'rust\''):
        geocosserat.generate(cantilever, "rust", tmp_path / "other")
    assert not (tmp_path / "other").exists()


@pytest.mark.parametrize("place", [0, 2])
@pytest.mark.parametrize("size", [1e155, 1e300])
def test_strains_beyond_all_measure_are_refused(place: int, size: float) -> None:
    """An energy that is no number is found before anything is computed; no infinity is kept, no warning printed."""
    strain: list[float] = [1.0, 0.0, 0.0]
    strain[place] = size
    rod = {"motion": "planar", "length": 1.0, "stiffness": [20, 20, 20], "friction": [1, 1, 1]}
    scene = {"rod": rod, "start": {"strain": strain}, "run": {"until": 1.0, "frames": 3, "backend": "numpy"}}
    with pytest.raises(InputError, match=r"start.strain: expected a finite energy at the start, found inf; start from"):
        geocosserat.run(scene)
