"""The folder that results go to: nothing in it is lost, and nothing empty is left."""

import os
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from geocosserat.model.errors import InputError


def claim(folder: Path, overwrite: bool, names: Sequence[str]) -> None:
    """Makes sure, before anything is computed, that results can be written and that none are lost."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        writable = os.access(folder, os.W_OK | os.X_OK)
    except OSError as error:
        found = f"{folder}: {error.strerror or error}"
        raise InputError("a folder to write to", found, "choose another --out", key="--out") from error
    if not writable:
        raise InputError("a folder that can be written", f"{folder}, read-only", "choose another --out", key="--out")
    kept = [name for name in names if (folder / name).exists()]
    if kept and not overwrite:
        raise InputError(
            f"none of these files in {folder} yet",
            ", ".join(kept),
            "choose another --out, or say --overwrite",
            key="--out",
        )


def give_back(folder: Path) -> None:
    """Removes a folder in which nothing was written."""
    with suppress(OSError):
        folder.rmdir()
