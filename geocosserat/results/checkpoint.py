"""Where a run was when it stopped, so that it can go on from there."""

import io
import time
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geocosserat.model.errors import InputError
from geocosserat.results.atomic import write_bytes
from geocosserat.results.errors import FileError
from geocosserat.results.solution import Array

NAME = "checkpoint.npz"


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """key: what is being computed (a hash); rung: which refinement; states (frames so far, size) of it;
    before (nodes, axis): final positions of the refinement before, empty if there was none."""

    key: str
    rung: int
    states: Array
    before: Array


def save_checkpoint(checkpoint: Checkpoint, folder: Path) -> Path:
    """Writes it to `folder`, whole or not at all. Raises FileError when it cannot."""
    stream = io.BytesIO()
    np.savez(
        stream,
        key=np.array(checkpoint.key),
        rung=np.array(checkpoint.rung),
        states=checkpoint.states,
        before=checkpoint.before,
    )
    return write_bytes(folder / NAME, stream.getvalue())


def load_checkpoint(folder: Path) -> Checkpoint:
    """Reads the checkpoint in `folder`; damage is noticed by the checksums of the archive.

    Raises FileError if there is none or it is damaged.
    """
    path = folder / NAME
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as stored:
            found = Checkpoint(
                str(stored["key"]), int(stored["rung"]), np.asarray(stored["states"]), np.asarray(stored["before"])
            )
    except FileNotFoundError:
        raise FileError(path, "a checkpoint to go on from", "none", "start without --resume") from None
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise FileError(
            path, "a checkpoint to go on from", f"a damaged file ({error})", "start without --resume"
        ) from None
    if found.states.ndim != 2 or not len(found.states) or not np.all(np.isfinite(found.states)):
        raise FileError(path, "a checkpoint to go on from", "states that are not usable", "start without --resume")
    return found


class Keeper:
    """Writes a checkpoint now and then, if there is a folder to write to."""

    EVERY = 5.0  # seconds

    def __init__(self, folder: Path | None, key: str, resume: bool) -> None:
        self.folder, self.key = folder, key
        self.resumed: Checkpoint | None = None
        if resume:
            assert folder is not None
            self.resumed = load_checkpoint(folder)
            if self.resumed.key != key:
                raise InputError(
                    "the scene and settings of the interrupted run",
                    f"others than those of the checkpoint in {folder}",
                    "resume with the same scene, or start without --resume",
                    key="--resume",
                )
        self.rung, self.states, self.before = 0, [np.empty(0)], np.empty((0, 0))
        self.saved = time.monotonic()

    def begin(self, rung: int, start: Array, before: Array) -> Array:
        """States (frames, size) of this rung that are there already; at least the start."""
        resumed = self.resumed
        done = resumed.states if resumed is not None and resumed.rung == rung else start[None]
        if done.shape[1] != len(start):
            raise InputError(f"states of {len(start)} numbers", f"{done.shape[1]}", "start without --resume")
        self.rung, self.states, self.before = rung, list(done), before
        return np.array(done)

    def frame(self, _: int, state: Array) -> None:
        """Notes a state that was reached."""
        self.states.append(state.copy())
        if time.monotonic() - self.saved > self.EVERY:
            self.save()

    def save(self) -> None:
        """Writes the checkpoint now."""
        if self.folder is not None and self.states[0].size:
            save_checkpoint(Checkpoint(self.key, self.rung, np.array(self.states), self.before), self.folder)
        self.saved = time.monotonic()

    def finish(self) -> None:
        """The run is complete: nothing to go on from."""
        if self.folder is not None:
            (self.folder / NAME).unlink(missing_ok=True)
