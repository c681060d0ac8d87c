"""The user's cache: a private folder, files that appear whole or not at all, and nothing read that others wrote."""

import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from geocosserat.locks import Held, lock

PART = ".part-"
"""How names of files and folders begin that are being made, or were when their program was ended."""


def cache_folder() -> Path:
    """The folder of this user's generated and compiled kernels, made if missing, closed to others.

    $GEOCOSSERAT_CACHE if set, else $XDG_CACHE_HOME/geocosserat, else ~/.cache/geocosserat; where none of them can
    be written (a read-only home), a private folder under the system's temporary one.
    """
    named = os.environ.get("GEOCOSSERAT_CACHE")
    base = os.environ.get("XDG_CACHE_HOME")
    try:
        home = Path(base) if base else Path.home() / ".cache"
        return _private(Path(named) if named else home / "geocosserat")
    except (OSError, RuntimeError):  # RuntimeError: a user without a home
        last = Path(tempfile.gettempdir()) / f"geocosserat-{os.getuid()}"
        if last.is_symlink():  # anybody can put one there
            raise PermissionError(f"expected {last} to be no link; set GEOCOSSERAT_CACHE to a folder") from None
        return _private(last)


def _private(folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    if not _ours(folder.stat()):
        raise PermissionError(
            f"expected {folder} to belong to this user and to be writable by nobody else; "
            "change its owner and mode, or set GEOCOSSERAT_CACHE to another folder"
        )
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(f"expected {folder} to be writable; set GEOCOSSERAT_CACHE to another folder")
    return folder


def _ours(status: os.stat_result) -> bool:
    """Whether this user and nobody else can have written it."""
    return status.st_uid == os.getuid() and not status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def own_bytes(path: Path) -> bytes:
    """The content of a file of the cache. Raises OSError unless it is plain and nobody else can have written it."""
    with open(os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK), "rb") as file:
        status = os.fstat(file.fileno())
        if not stat.S_ISREG(status.st_mode) or not _ours(status):
            raise PermissionError(f"expected {path} to be a file of this user's, writable by nobody else")
        return file.read()


@contextmanager
def making(folder: Path) -> Iterator[None]:
    """While something is made in a cache: what is unfinished there is somebody's, and before, if nobody is at work, was
    left by a program that was ended and is removed."""
    with suppress(Held, OSError), lock(folder) as alone:
        for path in folder.iterdir() if alone else ():
            if path.name.startswith(PART):
                shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)
    with lock(folder, shared=True, wait=True):
        yield


def write_whole(path: Path, content: bytes) -> None:
    """Writes a file so that readers see the old one or the new one, never a part."""
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=PART)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(name, path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
