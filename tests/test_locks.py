"""A lock belongs to a process and ends with it."""

from __future__ import annotations

import errno
import os
import signal
import time
from pathlib import Path

import pytest

from geocosserat import locks
from geocosserat.locks import Held, lock


def _other(folder: Path, shared: bool = False) -> int:
    """A process that holds the lock until it is ended."""
    ready, tell = os.pipe()
    child = os.fork()
    if child == 0:
        with lock(folder, shared=shared):
            os.write(tell, b"x")
            time.sleep(100)
        os._exit(0)
    os.read(ready, 1)
    os.close(ready)
    os.close(tell)
    return child


def _end(child: int) -> None:
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)


def test_a_lock_is_held_by_one_and_free_again_once_that_is_ended(tmp_path: Path) -> None:
    """However it ends: nothing is left that would have to be removed."""
    child = _other(tmp_path)
    with pytest.raises(Held), lock(tmp_path):
        pass
    _end(child)
    with lock(tmp_path) as alone:
        assert alone
    assert list(tmp_path.iterdir()) == []


def test_a_shared_lock_is_held_by_many(tmp_path: Path) -> None:
    """But by nobody alone meanwhile."""
    child = _other(tmp_path, shared=True)
    with lock(tmp_path, shared=True, wait=True) as had:
        assert had
    with pytest.raises(Held), lock(tmp_path):
        pass
    _end(child)


def test_a_file_system_without_locks_is_no_obstacle(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One does without, and is told so."""

    def none(*_: object) -> None:
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(locks.fcntl, "flock", none)
    with lock(tmp_path) as alone:
        assert not alone


def test_a_folder_that_is_not_there_has_no_lock(tmp_path: Path) -> None:
    """Said by the system."""
    with pytest.raises(FileNotFoundError), lock(tmp_path / "none"):
        pass
