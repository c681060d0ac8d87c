"""A run that was interrupted goes on from its checkpoint."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

import geocosserat
from geocosserat.conductor import simulate
from geocosserat.model.errors import InputError
from geocosserat.results.checkpoint import NAME, load_checkpoint
from geocosserat.results.errors import FileError
from geocosserat.solver.trajectory import Progress


def _interrupt_after(calls: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Presses Ctrl-C when progress has been reported so many times in all."""
    left = [calls]

    @contextmanager
    def progress(label: str) -> Iterator[Progress]:
        def report(fraction: float, steps: int) -> None:
            left[0] -= 1
            if left[0] < 0:
                raise KeyboardInterrupt

        yield report

    monkeypatch.setattr(simulate, "progress", progress)


@pytest.mark.parametrize("calls", [0, 1, 7, 40])
def test_an_interrupted_run_goes_on_to_the_same_end(
    calls: int, tmp_path: Path, examples: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Interrupted at the start, between the first run and the second, or in that one: the tip is the same."""
    scene, out = examples / "cantilever.toml", tmp_path / "out"
    with monkeypatch.context() as patched:
        _interrupt_after(calls, patched)
        with pytest.raises(KeyboardInterrupt):
            geocosserat.run(scene, out)
    assert (out / NAME).exists()
    assert not (out / "solution.nc").exists()
    resumed = geocosserat.run(scene, out, resume=True)
    whole = geocosserat.run(scene)
    assert resumed.reached
    assert len(resumed.solution.time) == len(whole.solution.time)
    np.testing.assert_allclose(resumed.tip["position"], whole.tip["position"], rtol=0, atol=1e-6)
    np.testing.assert_allclose(resumed.ledger["dissipated"], whole.ledger["dissipated"], rtol=1e-5)
    assert not (out / NAME).exists()


def test_a_driven_end_goes_on_from_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its pose follows from the time, and that from the checkpoint: the base and the strains of the whole run."""
    scene = {
        "rod": {"motion": "planar", "length": 1.0, "stiffness": [60.0, 40.0, 1.0], "friction": [1.0, 2.0, 0.1]},
        "ends": {"left": {"kind": "driven", "twist": ["cos(3*t)", "0.3*heaviside(t - 0.5)", "5*cos(7*t)"]}},
        "effects": [{"kind": "weight", "force": [0.0, -3.0]}],
        "run": {"until": 1.0, "frames": 21, "elements": 4, "degree": 3, "rtol": 1e-8},
    }
    with monkeypatch.context() as patched:
        _interrupt_after(13, patched)
        with pytest.raises(KeyboardInterrupt):
            geocosserat.run(scene, tmp_path)
    assert 2 < len(load_checkpoint(tmp_path).states) < 21
    resumed, whole = geocosserat.run(scene, tmp_path, resume=True).solution, geocosserat.run(scene).solution
    np.testing.assert_array_equal(resumed.position[:, 0], whole.position[:, 0])
    np.testing.assert_allclose(resumed.position[-1], whole.position[-1], rtol=0, atol=1e-6)
    np.testing.assert_allclose(resumed.turn[-1], whole.turn[-1], rtol=0, atol=1e-5)


def test_a_checkpoint_of_another_scene_is_refused(
    tmp_path: Path, examples: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Going on with other numbers than one began with would be a run of no scene at all."""
    with monkeypatch.context() as patched:
        _interrupt_after(7, patched)
        with pytest.raises(KeyboardInterrupt):
            geocosserat.run(examples / "cantilever.toml", tmp_path)
    with pytest.raises(InputError, match=r"--resume: expected the scene and settings of the interrupted run"):
        geocosserat.run(examples / "cantilever.toml", tmp_path, settings=["kappa=2e4"], resume=True)
    assert load_checkpoint(tmp_path).states.shape[0] > 7


def test_a_damaged_or_missing_checkpoint_is_refused(tmp_path: Path, examples: Path) -> None:
    """A file that is not whole is named, with what to do; nothing is written."""
    with pytest.raises(FileError, match=r"checkpoint.npz: expected a checkpoint to go on from, found none"):
        geocosserat.run(examples / "cantilever.toml", tmp_path, resume=True)
    (tmp_path / NAME).write_bytes(b"PK\x03\x04 half of an archive")
    with pytest.raises(FileError, match=r"expected a checkpoint to go on from, found a damaged file .*start without"):
        geocosserat.run(examples / "cantilever.toml", tmp_path, resume=True)
    assert [path.name for path in tmp_path.iterdir()] == [NAME]


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
    np.savez(tmp_path / NAME, **{**content, **wrong})  # type: ignore[arg-type]
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
