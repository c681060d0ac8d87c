"""Work in a process of its own: what comes back, what ends it, and that nothing is left of it."""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import signal
import subprocess
import sys
import time
import warnings
from collections.abc import Callable
from functools import partial
from multiprocessing import resource_tracker
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocosserat.bounded import OutOfBounds, bounded
from geocosserat.model.errors import InputError

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork"), reason="processes cannot be forked here"),
    pytest.mark.usefixtures("patience"),
]


@pytest.fixture(autouse=True)
def no_tracker() -> None:
    """A pool of another test leaves the resource tracker of multiprocessing behind, a child like any other."""
    resource_tracker._resource_tracker._stop()  # type: ignore[attr-defined]


def _forever() -> None:
    while True:
        time.sleep(0.01)


def _raise(error: BaseException) -> None:
    raise error


class _Odd(Exception):
    """One that can be pickled but not be put together again."""

    def __init__(self, one: str, *, other: str) -> None:
        super().__init__(f"{one} and {other}")


def _no_children() -> bool:
    """No process of this one is left, running or waited for by nobody."""
    try:
        os.waitpid(-1, os.WNOHANG)
    except ChildProcessError:
        return True
    return False


def test_what_the_work_returns_comes_back() -> None:
    """Whatever can be pickled, however large: more than a pipe holds at once."""
    assert bounded(lambda: {"a": (1, None)}, 30) == {"a": (1, None)}
    assert bounded(lambda: None, 30) is None
    assert bounded(partial(bytes, 10_000_000), 30) == bytes(10_000_000)


def test_the_work_sees_all_and_changes_nothing() -> None:
    """It is done on a copy of the program."""
    seen = [1]

    def work() -> list[int]:
        seen.append(2)
        return seen

    assert bounded(work, 30) == [1, 2]
    assert seen == [1]


def test_what_takes_too_long_is_ended_in_time() -> None:
    """Soon after its time, whether it sleeps or computes, and even where Python cannot interrupt it."""
    for work in (_forever, lambda: sum(iter(int, 1)), lambda: 7 ** (7**9)):
        start = time.monotonic()
        with pytest.raises(OutOfBounds, match=r"^it took more than 0\.3 seconds$"):
            bounded(work, 0.3)
        assert time.monotonic() - start < 10


def test_what_takes_too_much_memory_is_ended() -> None:
    """Asked for at once, or little by little; the limit is on what comes on top of what there is."""
    works: list[Callable[[], Any]] = [
        lambda: bytearray(2**33), lambda: np.ones(2**30).sum(), lambda: [bytes(2**20) for _ in range(2**13)],
    ]  # fmt: skip
    for work in works:
        with pytest.raises(OutOfBounds, match=r"^it took more than 0\.25 GiB of memory$"):
            bounded(work, 60, memory=2**28)
    assert bounded(lambda: len(bytearray(2**20)), 30, memory=2**28) == 2**20


def test_what_is_nested_too_deeply_says_so() -> None:
    """Python's own bound on recursion, in the work or on its way back."""

    def deep() -> Any:
        return deep()

    def nested() -> Any:
        found: Any = None
        for _ in range(100_000):
            found = [found]
        return found

    for work in (deep, nested):
        with pytest.raises(OutOfBounds, match=r"^it is nested too deeply$"):
            bounded(work, 60)


def test_numbers_of_thousands_of_digits_are_out_of_bounds() -> None:
    """Python does not print them, for that would take long."""
    with pytest.raises(OutOfBounds, match=r"^it has numbers of thousands of digits$"):
        bounded(lambda: str(10**5000), 30)


def test_what_the_work_raises_is_raised() -> None:
    """With its type and its parts."""
    error = InputError("a number", "'x'", "write one", key="rod.length", file="scene.toml")
    with pytest.raises(InputError, match=r"^scene\.toml: rod\.length: expected a number, found 'x'; wri") as caught:
        bounded(partial(_raise, error), 30)
    assert vars(caught.value) == vars(error)


def test_what_cannot_be_sent_is_said_to_be_wrong_with_the_work() -> None:
    """Results and exceptions that cannot be pickled or put together again, and exits; never a want of memory."""
    with pytest.raises(Exception, match=r"(?i)can't pickle|cannot pickle|can't get local"):
        bounded(lambda: lambda: 0, 30)
    with pytest.raises(RuntimeError, match=r"^_Odd: one and other$"):
        bounded(partial(_raise, _Odd("one", other="other")), 30)
    with pytest.raises(RuntimeError, match=r"^SystemExit: 3$"):
        bounded(partial(sys.exit, 3), 30)


def test_a_process_that_dies_is_out_of_bounds() -> None:
    """Killed by the system, by a library that aborts, or by a bad address."""
    killed: Callable[[], Any] = lambda: os.kill(os.getpid(), signal.SIGKILL)  # noqa: E731
    for work in (os.abort, killed, partial(os._exit, 3), partial(ctypes.string_at, 0)):
        with pytest.raises(OutOfBounds, match=r"^its process ended early, most likely for want of memory$"):
            bounded(work, 30)


def test_nothing_that_the_work_prints_is_seen(capfd: pytest.CaptureFixture[str]) -> None:
    """Warnings, prints and the last words of libraries: standard output is for the answer alone."""

    def work() -> int:
        print("noise", flush=True)
        warnings.warn("noise", RuntimeWarning, stacklevel=1)
        os.write(1, b"noise")
        os.write(2, b"noise")
        return 1

    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert bounded(work, 30) == 1
    assert capfd.readouterr() == ("", "")


def test_no_process_and_no_pipe_is_left() -> None:
    """Whether the work ends, fails, dies or is ended."""
    before = sorted(os.listdir("/proc/self/fd")) if Path("/proc/self/fd").exists() else []
    assert bounded(lambda: 1, 30) == 1
    assert _no_children()
    for work, seconds in ((_forever, 0.1), (partial(_raise, ValueError("no")), 30), (os.abort, 30)):
        with pytest.raises((OutOfBounds, ValueError)):
            bounded(work, seconds)
        assert _no_children()
    if before:
        assert sorted(os.listdir("/proc/self/fd")) == before


def test_a_process_of_a_pool_may_bound_its_work() -> None:
    """Workers of multiprocessing may not have children of its own kind; these are not."""
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.apply(bounded, (partial(pow, 2, 3), 30)) == 8


def test_interrupting_the_program_ends_the_work() -> None:
    """KeyboardInterrupt in whoever waits; afterwards nobody works on."""

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGUSR1, interrupt)
    parent = os.getpid()

    def work() -> None:
        time.sleep(0.5)  # by then it waits
        os.kill(parent, signal.SIGUSR1)
        _forever()

    try:
        with pytest.raises(KeyboardInterrupt):
            bounded(work, 60)
    finally:
        signal.signal(signal.SIGUSR1, before)
    assert _no_children()
    assert signal.pthread_sigmask(signal.SIG_BLOCK, ()) == set()


PROGRAM = """
import sys, time
from geocosserat.bounded import bounded

def work():
    with open(sys.argv[1], "w") as file:
        import os
        file.write(str(os.getpid()))
    while True:
        pass

try:
    bounded(work, float(sys.argv[2]))
except KeyboardInterrupt:
    print("interrupted")
"""


def _started(folder: Path, seconds: float) -> tuple[subprocess.Popen[str], int]:
    """A program that waits for work without end, in a group of its own, and the process of the work."""
    note = folder / "pid"
    command = [sys.executable, "-c", PROGRAM, str(note), str(seconds)]
    program = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
        cwd=Path(__file__).parents[1],
    )  # fmt: skip
    while not (note.exists() and note.read_text()):
        time.sleep(0.01)
    return program, int(note.read_text())


def _gone(process: int) -> bool:
    """Whether a process has ended; one that nobody has waited for counts as ended."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except FileNotFoundError:
        return True


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processes are looked up under /proc")
def test_ctrl_c_ends_both_processes_without_a_word(tmp_path: Path) -> None:
    """A terminal sends it to the whole group: the work says nothing about it."""
    program, work = _started(tmp_path, 60)
    os.killpg(program.pid, signal.SIGINT)
    assert program.communicate() == ("interrupted\n", "")
    assert _gone(work)


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processes are looked up under /proc")
def test_the_work_of_a_program_that_was_killed_ends_by_itself(tmp_path: Path) -> None:
    """Soon after its time."""
    program, work = _started(tmp_path, 1.0)
    program.kill()
    program.communicate()
    limit = time.monotonic() + 40
    while not _gone(work):
        assert time.monotonic() < limit
        time.sleep(0.1)
