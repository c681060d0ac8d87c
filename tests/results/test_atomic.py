"""A result file is whole or not there, whatever goes wrong while it is written."""

from __future__ import annotations

import errno
import os
import pickle
import resource
import stat
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from geocosserat.results import atomic
from geocosserat.results.atomic import write_bytes
from geocosserat.results.errors import FileError
from geocosserat.results.netcdf import load, save
from geocosserat.results.picture import picture
from geocosserat.results.summary import summary, write_summary
from tests.results.motions import rolling, unrolling

WRITERS: dict[str, Callable[[Path], Any]] = {
    "solution.nc": lambda path: save(unrolling(), path),
    "picture.png": lambda path: picture(unrolling(), path),
    "summary.json": lambda path: write_summary(summary(unrolling()), path),
}


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.parametrize("step", ["fsync", "replace"])
@pytest.mark.parametrize(
    ("failure", "seen"),
    [(OSError(errno.ENOSPC, "No space left on device"), FileError), (KeyboardInterrupt("stop"), KeyboardInterrupt)],
)
def test_a_failed_write_leaves_the_old_file_and_nothing_else(
    name: str, step: str, failure: BaseException, seen: type[BaseException], tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A full disk or an interruption, while the bytes go out or the name is taken."""
    path = tmp_path / name
    path.write_bytes(b"older")

    def fail(*_: object) -> None:
        raise failure

    monkeypatch.setattr(atomic.os, step, fail)
    with pytest.raises(seen, match=r"No space left on device|stop"):
        WRITERS[name](path)
    monkeypatch.undo()
    assert path.read_bytes() == b"older"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("name", WRITERS)
def test_a_disk_that_takes_only_a_part_leaves_nothing(name: str, tmp_path: Path) -> None:
    """The system itself refuses to write beyond the first 512 bytes."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (512, hard))
    try:
        with pytest.raises(FileError, match=rf"{name}: expected .* room .*, found File too large; choose another"):
            WRITERS[name](tmp_path / name)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", WRITERS)
def test_a_folder_that_is_not_there_is_one_clear_message(name: str, tmp_path: Path) -> None:
    """The file is named, and what to do; nothing is created."""
    with pytest.raises(FileError, match=rf"{name}: expected a folder .*, found No such file .*; choose another"):
        WRITERS[name](tmp_path / "none" / name)
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="found Not a directory"):
        WRITERS[name](tmp_path / "file" / name)
    (tmp_path / name).mkdir()
    with pytest.raises(FileError, match="found Is a directory"):
        WRITERS[name](tmp_path / name)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(["file", name])


def test_the_bytes_reach_the_disk_before_the_name_is_given(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In the order file, rename, folder; otherwise a power cut could leave the name on an empty file."""
    done: list[str] = []
    for step in ("fsync", "replace"):
        original = getattr(os, step)

        def record(*arguments: Any, step: str = step, original: Callable[..., Any] = original) -> Any:
            done.append(step)
            return original(*arguments)

        monkeypatch.setattr(atomic.os, step, record)
    write_bytes(tmp_path / "a", b"x")
    assert done == ["fsync", "replace", "fsync"]


def test_a_reader_never_sees_half_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Just before the name is taken the old solution is whole, just after it the new one."""
    path = tmp_path / "solution.nc"
    save(rolling(), path)
    rename = os.replace

    def look(old: str, new: str) -> None:
        assert load(path) == rolling()
        assert Path(old).parent == tmp_path  # a rename across file systems would be a copy
        rename(old, new)

    monkeypatch.setattr(atomic.os, "replace", look)
    save(unrolling(), path)
    assert load(path) == unrolling()


def test_a_file_gets_the_permissions_that_the_user_chose(tmp_path: Path) -> None:
    """Temporary files are often readable by their owner only, and would stay so."""
    mask = os.umask(0o027)
    try:
        path = write_bytes(tmp_path / "a", b"x")
    finally:
        os.umask(mask)
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_a_long_name_is_no_obstacle(tmp_path: Path) -> None:
    """The temporary name does not grow with the name of the file."""
    assert write_bytes(tmp_path / ("a" * 255), b"x").read_bytes() == b"x"


def test_the_error_says_its_parts_and_survives_a_process_boundary() -> None:
    """It may be raised in a worker of a sweep."""
    error = FileError("a.nc", "one thing", "another", "do this")
    assert str(error) == "a.nc: expected one thing, found another; do this"
    copy = pickle.loads(pickle.dumps(error))
    assert type(copy) is FileError
    assert (str(copy), copy.file, copy.expected, copy.found, copy.hint) == (
        str(error), "a.nc", "one thing", "another", "do this")
