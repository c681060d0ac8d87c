"""Files that are either complete or not there."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from geocosserat.results.errors import FileError

PART = r"\.[0-9a-f]{12}\.part"
"""Names of files that are being written, or were when their program was ended."""


def write_bytes(path: str | os.PathLike[str], data: bytes) -> Path:
    """Write `data` to `path` so that a reader sees the old file or the whole new one, also after a power cut.

    The bytes go to a temporary file in the same folder (a rename is atomic only within one file system),
    reach the disk, and then take the name. On failure the temporary file is removed and an older file at
    `path` stays.

    Raises FileError when the folder is missing, cannot be written or is full.
    """
    target = Path(path)
    part = target.parent / f".{os.urandom(6).hex()}.part"
    try:
        # os.open rather than tempfile: the file then gets the ordinary permissions of the user's umask
        descriptor = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
        with os.fdopen(descriptor, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, target)
    except OSError as error:
        raise FileError(target, "a folder with room for the file and the right to write there",
                        error.strerror or str(error), "choose another folder or make it writable") from error
    finally:
        with suppress(OSError):
            part.unlink()
    _sync_folder(target.parent)
    return target


def _sync_folder(folder: Path) -> None:
    """Bring the new name to the disk as well, where the system lets a folder be synchronised."""
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
