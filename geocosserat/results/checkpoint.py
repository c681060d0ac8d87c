"""Where a run was when it stopped, so that it can go on from there."""

import io
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

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
        with np.load(path, allow_pickle=False) as stored:
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
