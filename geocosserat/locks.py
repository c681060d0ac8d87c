"""Locks on folders. They belong to an open file, so they end with the process that holds them, however it ends."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

if sys.platform != "win32":
    import fcntl


class Held(Exception):
    """Another process holds the lock."""


@contextmanager
def lock(folder: Path, *, shared: bool = False, wait: bool = False) -> Iterator[bool]:
    """Holds the lock of a folder; nothing is written to it. Gives False where the file system knows no locks.

    shared: with others that share it. wait: until it is free, instead of raising Held. Raises OSError if the folder
    cannot be opened.
    """
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        yield _take(descriptor, shared, wait)
    finally:
        os.close(descriptor)


def _take(descriptor: int, shared: bool, wait: bool) -> bool:
    if sys.platform == "win32":
        return False
    try:
        fcntl.flock(descriptor, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | (0 if wait else fcntl.LOCK_NB))
    except BlockingIOError:
        raise Held from None
    except OSError:  # of a network, most likely
        return False
    return True
