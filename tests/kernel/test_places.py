"""The cache: private, whole files or none, and never a reason for a run to fail."""

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Callable
from pathlib import Path

import pytest

from geocosserat.kernel.places import cache_folder, own_bytes, write_whole


@pytest.fixture
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Another home and temporary folder, and no cache named."""
    (tmp_path / "tmp").mkdir()
    (tmp_path / "home").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "tmp"))
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.delenv("GEOCOSSERAT_CACHE", raising=False)
    return tmp_path


def test_the_cache_is_where_the_environment_says(elsewhere: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """GEOCOSSERAT_CACHE before XDG_CACHE_HOME before the home folder; made if missing."""
    assert cache_folder() == elsewhere / "home" / ".cache" / "geocosserat"
    monkeypatch.setenv("XDG_CACHE_HOME", str(elsewhere / "xdg"))
    assert cache_folder() == elsewhere / "xdg" / "geocosserat"
    monkeypatch.setenv("GEOCOSSERAT_CACHE", str(elsewhere / "named" / "deep"))
    assert cache_folder() == elsewhere / "named" / "deep"
    assert cache_folder().is_dir()


def test_a_new_cache_is_closed_to_others(elsewhere: Path) -> None:
    """Whatever the umask: code that is loaded from it must be this user's own."""
    before = os.umask(0)
    try:
        folder = cache_folder()
    finally:
        os.umask(before)
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700


@pytest.mark.parametrize("mode", [0o777, 0o720, 0o702])
def test_a_cache_that_others_can_write_is_not_used(
    elsewhere: Path, monkeypatch: pytest.MonkeyPatch, mode: int
) -> None:
    """Anybody could have put a library there; a private folder under the temporary one serves instead."""
    shared = elsewhere / "shared"
    shared.mkdir()
    shared.chmod(mode)
    monkeypatch.setenv("GEOCOSSERAT_CACHE", str(shared))
    folder = cache_folder()
    assert folder == elsewhere / "tmp" / f"geocosserat-{os.getuid()}"
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700


def test_a_temporary_folder_prepared_by_somebody_else_is_refused(
    elsewhere: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The last resort is checked as well, and the message says what to do."""
    monkeypatch.setenv("GEOCOSSERAT_CACHE", "/dev/null/nowhere")
    trap = elsewhere / "tmp" / f"geocosserat-{os.getuid()}"
    trap.mkdir()
    trap.chmod(0o777)
    with pytest.raises(PermissionError, match=r"writable by nobody else; .*set GEOCOSSERAT_CACHE to another folder"):
        cache_folder()


def test_a_link_in_the_temporary_folder_is_refused(elsewhere: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Anybody can put one there, to a folder of this user's."""
    monkeypatch.setenv("GEOCOSSERAT_CACHE", "/dev/null/nowhere")
    (elsewhere / "tmp" / f"geocosserat-{os.getuid()}").symlink_to(elsewhere / "home")
    with pytest.raises(PermissionError, match=r"to be no link; set GEOCOSSERAT_CACHE"):
        cache_folder()


@pytest.mark.parametrize(
    "make", [os.mkfifo, os.mkdir, lambda path: os.symlink("/dev/zero", path)], ids=["pipe", "folder", "link"]
)
def test_only_plain_files_are_read(tmp_path: Path, make: Callable[[Path], None], patience: None) -> None:
    """Not pipes, on which one waits, nor links, nor devices without an end."""
    make(tmp_path / "thing")
    with pytest.raises(OSError):  # noqa: PT011
        own_bytes(tmp_path / "thing")


def test_where_no_folder_can_be_made_the_temporary_one_serves(
    elsewhere: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A home that is no folder, or read-only."""
    (elsewhere / "file").write_text("not a folder")
    monkeypatch.setenv("GEOCOSSERAT_CACHE", str(elsewhere / "file" / "cache"))
    assert cache_folder().parent == elsewhere / "tmp"


def test_a_folder_that_is_there_but_read_only_is_passed_over(
    elsewhere: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A cache on a file system mounted read-only: found, but nothing can be added."""
    locked = elsewhere / "locked"
    locked.mkdir(mode=0o700)
    monkeypatch.setenv("GEOCOSSERAT_CACHE", str(locked))
    # modes do not stop root; what the system says about the folder is what counts
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != locked)
    assert cache_folder().parent == elsewhere / "tmp"


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A failure in the middle leaves the old content and no litter."""
    path = tmp_path / "kernel.json"
    write_whole(path, b"old")
    assert stat.S_IMODE(path.stat().st_mode) == 0o600

    def full(_: int) -> None:
        raise OSError("no space left")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="no space left"):
        write_whole(path, b"new, longer than before")
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]
