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
    """key: what is being computed (a hash). number: of the run, out of those of a plan, whose states (frames so far,
    size) are kept, if any. ends: what each run that is over left behind, an array each."""

    key: str
    number: int
    states: Array
    ends: tuple[Array, ...]


def save_checkpoint(checkpoint: Checkpoint, folder: Path) -> Path:
    """Writes it to `folder`, whole or not at all. Raises FileError when it cannot."""
    stream = io.BytesIO()
    np.savez(
        stream,
        key=np.array(checkpoint.key),
        number=np.array(checkpoint.number),
        states=checkpoint.states,
        allow_pickle=False,
        **{f"end_{i}": end for i, end in enumerate(checkpoint.ends)},
    )
    return write_bytes(folder / NAME, stream.getvalue())


def load_checkpoint(folder: Path) -> Checkpoint:
    """Reads the checkpoint in `folder`; damage is noticed by the checksums of the archive.

    Raises FileError if there is none or it is damaged.
    """
    path = folder / NAME
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as stored:
            ends = tuple(np.asarray(stored[f"end_{i}"]) for i in range(len(stored.files) - 3))
            number, states = np.asarray(stored["number"]), np.asarray(stored["states"])
            if number.shape or number.dtype.kind != "i":
                raise ValueError("the number of the run is none")
            found = Checkpoint(str(stored["key"]), int(number), states, ends)
    except FileNotFoundError:
        raise FileError(path, "a checkpoint to go on from", "none", "start without --resume") from None
    except (OSError, ValueError, KeyError, EOFError, AttributeError, zipfile.BadZipFile) as error:
        raise FileError(
            path, "a checkpoint to go on from", f"a damaged file ({error})", "start without --resume"
        ) from None
    if not all(_usable(array) for array in (found.states, *found.ends)):
        raise FileError(path, "a checkpoint to go on from", "states that are not usable", "start without --resume")
    return found


def _usable(array: Array) -> bool:
    return array.ndim == 2 and array.dtype == np.float64 and bool(np.all(np.isfinite(array)))


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
        self.number, self.states, self.ends = 0, list[Array](), list[Array]()
        if self.resumed is not None:
            self.number, self.states = self.resumed.number, list(self.resumed.states)
            self.ends = list(self.resumed.ends)
        self.saved = time.monotonic()

    def begin(self, number: int, start: Array, frames: int) -> Array:
        """States (frames so far, size) of this run that are there already; at least the start."""
        done = self.resumed.states if self.resumed is not None and self.holds(number) else start[None]
        if done.shape[1] != len(start) or len(done) > frames:
            expected, found = f"up to {frames} states of {len(start)} numbers", f"{done.shape[0]} of {done.shape[1]}"
            raise InputError(expected, found, "start without --resume", key="--resume")
        self.number, self.states = number, list(done)
        return np.array(done)

    def holds(self, number: int) -> bool:
        """Whether the states of this run were kept when it was interrupted."""
        return self.resumed is not None and self.resumed.number == number and len(self.resumed.states) > 0

    def ended(self, number: int) -> Array | None:
        """What a run left behind before the interruption, if it was over."""
        ends = self.resumed.ends if self.resumed is not None else ()
        return ends[number] if number < len(ends) else None

    def end(self, left: Array) -> None:
        """Notes what the next run left behind that was not over before the interruption."""
        self.ends.append(left)

    def frame(self, _: int, state: Array) -> None:
        """Notes a state that was reached."""
        self.states.append(state.copy())
        if time.monotonic() - self.saved > self.EVERY:
            self.save()

    def save(self) -> None:
        """Writes the checkpoint now."""
        if self.folder is not None:
            states = np.array(self.states) if self.states else np.empty((0, 0))
            save_checkpoint(Checkpoint(self.key, self.number, states, tuple(self.ends)), self.folder)
        self.saved = time.monotonic()

    def finish(self) -> None:
        """The run is complete: nothing to go on from."""
        if self.folder is not None:
            (self.folder / NAME).unlink(missing_ok=True)
