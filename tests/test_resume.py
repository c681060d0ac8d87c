"""A run that was interrupted goes on from its checkpoint."""

import io
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocosserat
from geocosserat.conductor import simulate
from geocosserat.kernel.contract import Array
from geocosserat.model.errors import InputError
from geocosserat.results import seal
from geocosserat.results.checkpoint import NAME, load_checkpoint
from geocosserat.results.errors import FileError
from geocosserat.results.solution import SHAPES, Solution
from geocosserat.solver import legs
from geocosserat.solver.trajectory import Progress, Trajectory
from tests.marks import slow


def _interrupt_after(calls: int, monkeypatch: pytest.MonkeyPatch, from_fraction: float = 0.0) -> None:
    """Presses Ctrl-C when progress beyond a fraction has been reported so many times in all."""
    left = [calls]

    @contextmanager
    def progress(label: str) -> Iterator[Progress]:
        def report(fraction: float, steps: int) -> None:
            left[0] -= fraction >= from_fraction
            if left[0] < 0:
                raise KeyboardInterrupt

        yield report

    monkeypatch.setattr(simulate, "progress", progress)


@pytest.fixture
def short_legs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Runs of the tests take fewer steps than one leg has; here they begin anew every 30."""
    monkeypatch.setattr(legs, "enough", lambda size: 30)


def _same(one: Solution, other: Solution) -> None:
    """In all that was computed, to the last bit; not in seconds and dates."""
    for name in SHAPES:
        assert np.array_equal(getattr(one, name), getattr(other, name)), name
    for name in ("method", "elements", "degree", "unknowns", "estimated", "evaluations", "reached", "reason"):
        assert getattr(one, name) == getattr(other, name), name


@pytest.mark.parametrize("calls", [0, 1, 7, 40])
def test_an_interrupted_run_goes_on_to_the_same_end_bit_for_bit(
    calls: int, tmp_path: Path, examples: Path, short_legs: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Interrupted at the start, in the first run, in the second or in the third one of its plan: all is the same."""
    scene, out = examples / "cantilever.toml", tmp_path / "out"
    with monkeypatch.context() as patched:
        _interrupt_after(calls, patched)
        with pytest.raises(KeyboardInterrupt):
            geocosserat.run(scene, out)
    assert (out / NAME).exists()
    assert not (out / "solution.nc").exists()
    _same(geocosserat.run(scene, out, resume=True).solution, geocosserat.run(scene).solution)
    assert not (out / NAME).exists()


def test_a_run_that_is_interrupted_again_and_again_comes_to_the_same_end(
    tmp_path: Path, examples: Path, short_legs: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each time a little further on, through all runs of a plan."""
    scene, resume = examples / "cantilever.toml", False
    for calls in range(10, 1000, 10):
        with monkeypatch.context() as patched:
            _interrupt_after(calls, patched)
            try:
                found = geocosserat.run(scene, tmp_path, resume=resume)
                break
            except KeyboardInterrupt:
                resume = True
    assert calls > 30
    _same(found.solution, geocosserat.run(scene).solution)


DRIVEN: dict[str, Any] = {
    "rod": {"motion": "planar", "length": 1.0, "stiffness": [60.0, 40.0, 1.0], "friction": [1.0, 2.0, 0.1]},
    "ends": {"left": {"kind": "driven", "twist": ["cos(3*t)", "0.3*heaviside(t - 0.5)", "5*cos(7*t)"]}},
    "effects": [{"kind": "weight", "force": [0.0, -3.0]}],
    "run": {"until": 1.0, "frames": 21, "elements": 4, "degree": 3, "rtol": 1e-8},
}


@pytest.mark.parametrize("frozen", [[], ["h1", "h2"]], ids=["elastic", "inextensible"])
@pytest.mark.parametrize(
    ("method", "backend"),
    [("cvode", "c"), ("radau", "c"), slow("cvode", "numpy"), slow("bdf", "c"), slow("lsoda", "numpy")],
)
def test_every_integrator_goes_on_bit_for_bit(
    method: str, backend: str, frozen: list[str], tmp_path: Path, short_legs: None, monkeypatch: pytest.MonkeyPatch,
    c_compiler: str,
) -> None:
    """Each has another history from step to step; a load that switches cuts through legs, and constraints through
    starts."""
    scene = {**DRIVEN, "rod": {**DRIVEN["rod"], "frozen": frozen}}
    scene["run"] = {**DRIVEN["run"], "elements": 2, "rtol": 1e-5, "method": method, "backend": backend}
    if method == "radau":  # whose steps are few
        monkeypatch.setattr(legs, "enough", lambda size: 10)
    with monkeypatch.context() as patched:
        _interrupt_after(0, patched, 0.8)
        with pytest.raises(KeyboardInterrupt):
            geocosserat.run(scene, tmp_path)
    assert 2 < len(load_checkpoint(tmp_path).states) < 21
    _same(geocosserat.run(scene, tmp_path, resume=True).solution, geocosserat.run(scene).solution)


def test_legs_end_when_there_is_enough_to_lose_and_leave_short_runs_whole(
    monkeypatch: pytest.MonkeyPatch
) -> None:
    """A short run is one leg; cut into many, it stays as accurate, at the price of some steps."""
    whole = geocosserat.run(DRIVEN)
    with monkeypatch.context() as patched:
        patched.setattr(legs, "enough", lambda size: 10**9)
        uncut = geocosserat.run(DRIVEN)
    _same(whole.solution, uncut.solution)
    monkeypatch.setattr(legs, "enough", lambda size: 60)
    cut = geocosserat.run(DRIVEN)
    assert uncut.evaluations["steps"] < cut.evaluations["steps"] < 3 * uncut.evaluations["steps"]
    np.testing.assert_allclose(cut.solution.position[-1], whole.solution.position[-1], rtol=0, atol=1e-6)
    np.testing.assert_allclose(cut.ledger["dissipated"], whole.ledger["dissipated"], rtol=1e-5)


def test_a_run_that_fell_back_goes_on_bit_for_bit(
    tmp_path: Path, short_legs: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The method that failed fails again at the same time, and the safe one takes over there: nothing else would come
    to the same end."""
    whole, legs_of_safe = simulate.integrate, []

    def breaks(kernel: Any, start: Array, times: Array, method: str, *rest: Any) -> Trajectory:
        if method == "safe":
            legs_of_safe.append(times[0])
            if len(legs_of_safe) == 4:
                raise KeyboardInterrupt
            return whole(kernel, start, times, method, *rest)
        found = whole(kernel, start, times[times <= 0.5], method, *rest)
        done = len(found.times) > 1 and found.times[-1] < 0.5  # a leg that ended before
        return found if done else replace(found, reached=False, reason="broke")

    monkeypatch.setattr(simulate, "integrate", breaks)
    monkeypatch.setattr(legs, "enough", lambda size: 5)
    scene = {**DRIVEN, "run": {**DRIVEN["run"], "rtol": 1e-4, "elements": 1}}
    with pytest.raises(KeyboardInterrupt):
        geocosserat.run(scene, tmp_path)
    assert legs_of_safe[-1] > 0.5
    assert 2 < len(load_checkpoint(tmp_path).states) < 12
    found = geocosserat.run(scene, tmp_path, resume=True)
    assert found.fell_back["at"] == 0.5
    _same(found.solution, geocosserat.run(scene).solution)


def test_a_driven_end_goes_on_from_where_it_was(
    tmp_path: Path, short_legs: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its pose follows from the time, and that from the checkpoint."""
    with monkeypatch.context() as patched:
        _interrupt_after(13, patched)
        with pytest.raises(KeyboardInterrupt):
            geocosserat.run(DRIVEN, tmp_path)
    assert 2 < len(load_checkpoint(tmp_path).states) < 21
    _same(geocosserat.run(DRIVEN, tmp_path, resume=True).solution, geocosserat.run(DRIVEN).solution)


def test_a_checkpoint_of_another_scene_is_refused(
    tmp_path: Path, examples: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Going on with other numbers than one began with would be a run of no scene at all."""
    with monkeypatch.context() as patched:
        _interrupt_after(7, patched)
        with pytest.raises(KeyboardInterrupt):
            geocosserat.run(examples / "cantilever.toml", tmp_path)
    left = (tmp_path / NAME).read_bytes()
    with pytest.raises(InputError, match=r"--resume: expected the scene and settings of the interrupted run"):
        geocosserat.run(examples / "cantilever.toml", tmp_path, settings=["kappa=2e4"], resume=True)
    assert (tmp_path / NAME).read_bytes() == left


def test_a_damaged_or_missing_checkpoint_is_refused(tmp_path: Path, examples: Path) -> None:
    """A file that is not whole is named, with what to do; nothing is written."""
    with pytest.raises(FileError, match=r"checkpoint.npz: expected a checkpoint to go on from, found none"):
        geocosserat.run(examples / "cantilever.toml", tmp_path, resume=True)
    (tmp_path / NAME).write_bytes(b"PK\x03\x04 half of an archive")
    with pytest.raises(FileError, match=r"expected a checkpoint to go on from, found a damaged file .*start without"):
        geocosserat.run(examples / "cantilever.toml", tmp_path, resume=True)
    assert [path.name for path in tmp_path.iterdir()] == [NAME]


def _sealed(path: Path, stream: io.BytesIO) -> None:
    """As whoever means harm would write it: with a right checksum."""
    with zipfile.ZipFile(stream, "a") as archive:
        archive.comment = seal.BLANK.encode()
    path.write_bytes(seal.seal(stream.getvalue()))


@pytest.mark.parametrize(
    "wrong",
    [
        {"number": np.array([1, 2])},
        {"number": np.array(np.inf)},
        {"states": np.array([["a"]])},
        {"states": np.zeros((500, 38))},
        {"end_0": np.zeros((3, 2))},
        {"end_0": np.zeros((9, 0))},
        {"end_0": np.zeros((2, 2), dtype=complex)},
        {"counts": np.array([1, 2])},
        {"counts": np.array([1, -2, 3])},
        {"states": np.array([[None]])},
    ],
    ids=str,
)
def test_a_checkpoint_with_other_contents_is_refused(
    wrong: dict[str, np.ndarray], tmp_path: Path, examples: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whole as an archive, and of this run, but not what a run leaves: one message, whatever it is."""
    with monkeypatch.context() as patched:
        _interrupt_after(7, patched)
        with pytest.raises(KeyboardInterrupt):
            geocosserat.run(examples / "cantilever.toml", tmp_path)
    with np.load(tmp_path / NAME) as stored:
        content = dict(stored)
    stream = io.BytesIO()
    np.savez(stream, **{**content, **wrong})  # type: ignore[arg-type]
    _sealed(tmp_path / NAME, stream)
    with pytest.raises((InputError, FileError), match="start without --resume"):
        geocosserat.run(examples / "cantilever.toml", tmp_path, resume=True)


def test_a_run_that_had_not_begun_begins(tmp_path: Path, examples: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Interrupted while its kernel was compiled, at a setting of its own."""
    settings = ["run.elements=2", "run.degree=8", "run.frames=3"]

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(simulate, "load", stop)
        with pytest.raises(KeyboardInterrupt):
            geocosserat.run(examples / "cantilever.toml", tmp_path, settings=settings)
    assert geocosserat.run(examples / "cantilever.toml", tmp_path, settings=settings, resume=True).reached


def test_resuming_needs_a_folder(examples: Path) -> None:
    """Without --out there is nothing to go on from."""
    with pytest.raises(InputError, match=r"--resume: expected the folder of the interrupted run, found none; name it"):
        geocosserat.run(examples / "cantilever.toml", resume=True)
