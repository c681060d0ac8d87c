"""The folder that results go to: nothing in it is lost, one run at a time writes to it, and nothing empty is left."""

import os
import re
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from geocosserat.locks import Held, lock
from geocosserat.model.errors import InputError
from geocosserat.results.atomic import PART


@contextmanager
def claimed(folder: Path | None, overwrite: bool, names: Sequence[str]) -> Iterator[None]:
    """Makes sure, before anything is computed, that results can be written and that none are lost; keeps others from
    writing there meanwhile; removes a folder that it made if nothing was written. Does nothing without a folder.

    Raises InputError.
    """
    if folder is None:
        yield
        return
    with ExitStack() as stack:
        try:
            made = not folder.exists()
            folder.mkdir(parents=True, exist_ok=True)
            alone = stack.enter_context(lock(folder))
            writable = os.access(folder, os.W_OK | os.X_OK)
        except Held:
            raise InputError(
                "a folder that nobody is writing to", f"{folder}, in use", "wait, or choose another --out", key="--out"
            ) from None
        except OSError as error:
            found = f"{folder}: {error.strerror or error}"
            raise InputError("a folder to write to", found, "choose another --out", key="--out") from error
        try:
            _ready(folder, writable, overwrite, names)
            if alone:
                _tidy(folder)
            yield
        except BaseException:
            if made:
                with suppress(OSError):  # it is not empty
                    folder.rmdir()
            raise


def _ready(folder: Path, writable: bool, overwrite: bool, names: Sequence[str]) -> None:
    if not writable:
        raise InputError("a folder that can be written", f"{folder}, read-only", "choose another --out", key="--out")
    kept = [name for name in names if os.path.lexists(folder / name)]
    if kept and not overwrite:
        raise InputError(
            f"none of these files in {folder} yet",
            ", ".join(kept),
            "choose another --out, or say --overwrite",
            key="--out",
        )


def _tidy(folder: Path) -> None:
    """Removes what runs left that were ended while they wrote: nobody else writes there now."""
    with suppress(OSError):
        for path in folder.iterdir():
            if re.fullmatch(PART, path.name):
                path.unlink()
