"""Where a run was when it stopped, so that it can go on from there."""

from __future__ import annotations

import io
import math
import time
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from geocosserat.model.errors import InputError
from geocosserat.results import seal
from geocosserat.results.atomic import write_bytes
from geocosserat.results.errors import FileError
from geocosserat.results.solution import Array
from geocosserat.solver.trajectory import Trajectory

NAME = "checkpoint.npz"
_ALONE = ("key", "number", "counts", "states")
_HINT = "start without --resume"


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """key: what is being computed (a hash). number: of the run, out of those of a plan, whose states (frames so far,
    size) are kept, if any; counts: its rates, Jacobians and steps. ends: what each run that is over left behind, an
    array each."""

    key: str
    number: int
    counts: tuple[int, int, int]
    states: Array
    ends: tuple[Array, ...]


def save_checkpoint(checkpoint: Checkpoint, folder: Path) -> Path:
    """Writes it to `folder`, whole or not at all, with a checksum of all its bytes. Raises FileError when it cannot."""
    stream = io.BytesIO()
    np.savez(
        stream,
        key=np.array(checkpoint.key),
        number=np.array(checkpoint.number),
        counts=np.array(checkpoint.counts),
        states=checkpoint.states,
        allow_pickle=False,
        **{f"end_{i}": end for i, end in enumerate(checkpoint.ends)},
    )
    with zipfile.ZipFile(stream, "a") as archive:
        archive.comment = seal.BLANK.encode()
    return write_bytes(folder / NAME, seal.seal(stream.getvalue()))


def load_checkpoint(folder: Path) -> Checkpoint:
    """Reads the checkpoint in `folder`. Nothing of a file is read but its checksum until that is right, and no more
    memory taken than it has bytes.

    Raises FileError if there is none or it is damaged.
    """
    path = folder / NAME
    wanted = "a checkpoint to go on from"
    try:
        sealed = path.read_bytes()
    except FileNotFoundError:
        raise FileError(path, wanted, "none", _HINT) from None
    except OSError as error:
        raise FileError(path, wanted, error.strerror or str(error), _HINT) from None
    if not seal.intact(sealed):
        raise FileError(path, wanted, "a damaged file (its checksum differs: cut short or changed)", _HINT)
    try:
        return _read(sealed)
    except Exception as error:  # the library may make anything of a file that was written to do harm
        said = " ".join(str(error).split())[:200] or type(error).__name__
        raise FileError(path, wanted, f"a damaged file ({said})", _HINT) from None


def _read(sealed: bytes) -> Checkpoint:
    """Raises ValueError, or what the archive raises, for contents that no run leaves."""
    with zipfile.ZipFile(io.BytesIO(sealed)) as archive:
        stored = {member.filename.removesuffix(".npy"): _array(archive, member) for member in archive.infolist()}
    ends = tuple(stored[f"end_{i}"] for i in range(len(stored) - len(_ALONE)))
    key, number, counts, states = (stored[name] for name in _ALONE)
    if number.shape or number.dtype.kind != "i" or number < 0:
        raise ValueError("the number of the run is none")
    if counts.shape != (3,) or counts.dtype.kind != "i" or (counts < 0).any():
        raise ValueError("its counts are none")
    if not all(_usable(array) for array in (states, *ends)):
        raise ValueError("states that are not usable")
    return Checkpoint(str(key), int(number), (int(counts[0]), int(counts[1]), int(counts[2])), states, ends)


def _array(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> np.ndarray[Any, Any]:
    """An array as it stands in the archive, not compressed: a few bytes cannot claim to be more than they are."""
    if member.compress_type != zipfile.ZIP_STORED or member.file_size != member.compress_size:
        raise ValueError("a compressed member")
    content = io.BytesIO(archive.read(member))
    if np.lib.format.read_magic(content) != (1, 0):
        raise ValueError("an array in another format")
    shape, by_columns, dtype = np.lib.format.read_array_header_1_0(content)
    if (by_columns and len(shape) > 1) or dtype.hasobject:
        raise ValueError("an array that no run writes")
    return np.frombuffer(content.read(), dtype).reshape(shape)


def _usable(array: np.ndarray[Any, Any]) -> bool:
    return array.ndim == 2 and array.dtype == np.float64 and bool(np.all(np.isfinite(array)))


class Keeper:
    """Writes a checkpoint now and then, if there is a folder to write to.

    tell: is called with one line where no checkpoint can be written; the run goes on without.
    """

    EVERY = 5.0  # seconds
    SHARE = 20.0  # and at least so many times as long as writing one takes

    def __init__(
        self, folder: Path | None, key: str, resume: bool, tell: Callable[[str], None] = lambda _: None
    ) -> None:
        self.folder, self.key, self.tell = folder, key, tell
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
        self.number, self.counts, self.states = 0, (0, 0, 0), np.empty((0, 0))
        self.ends = list[Array]()
        if self.resumed is not None:
            self.number, self.counts, self.states = self.resumed.number, self.resumed.counts, self.resumed.states
            self.ends = list(self.resumed.ends)
        self.saved, self.pause = math.inf, self.EVERY

    def begin(self, number: int, start: Array, times: Array) -> Trajectory:
        """What is there already of this run from `start` (size,) through `times` (frames,); at least the start."""
        states, counts = start[None].copy(), (0, 0, 0)
        if self.resumed is not None and self.holds(number):
            states, counts = self.resumed.states, self.resumed.counts
        if states.shape[1] != len(start) or len(states) > len(times):
            expected = f"up to {len(times)} states of {len(start)} numbers"
            raise InputError(expected, f"{len(states)} of {states.shape[1]}", _HINT, key="--resume")
        self.number, self.counts, self.states = number, counts, states
        self.saved = min(self.saved, time.monotonic())  # before, there was nothing to lose
        return Trajectory(times[: len(states)].copy(), states, *counts, reached=len(states) == len(times))

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
        self._now_and_then()

    def keep(self, done: Trajectory) -> None:
        """Notes what there is of the run that has begun, from which one may go on."""
        self.counts, self.states = (done.rates, done.jacobians, done.steps), done.states
        self._now_and_then()

    def _now_and_then(self) -> None:
        start = time.monotonic()
        if start - self.saved > self.pause:
            try:
                self.save()
            except FileError as error:
                self.tell(f"no checkpoint could be written: {error}")
            self.saved = time.monotonic()
            self.pause = max(self.EVERY, self.SHARE * (self.saved - start))

    def save(self) -> None:
        """Writes the checkpoint now. Raises FileError where it cannot."""
        if self.folder is not None:
            content = Checkpoint(self.key, self.number, self.counts, self.states, tuple(self.ends))
            save_checkpoint(content, self.folder)

    def finish(self) -> None:
        """The run is complete: nothing to go on from."""
        if self.folder is not None:
            (self.folder / NAME).unlink(missing_ok=True)
