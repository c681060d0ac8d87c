"""Work on input that may be hostile, in a process of its own: bounded in time and in memory."""

from __future__ import annotations

import faulthandler
import os
import pickle
import signal
import sys
import warnings
from collections.abc import Callable
from contextlib import suppress
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from typing import Any, NoReturn, TypeVar

if sys.platform != "win32":
    import resource

MEMORY = 4 * 2**30
"""Bytes of address space that the work may take beyond what the program has."""

_LONGEST = 1e6  # seconds, for a timer

T = TypeVar("T")


class OutOfBounds(Exception):
    """The work took more time or memory than it may; ``str()`` says which."""


def bounded(work: Callable[[], T], seconds: float, memory: int = MEMORY) -> T:
    """What ``work()`` returns, which must be picklable; it sees all that there is, and changes nothing of it.

    Nothing that it prints is seen. Raises OutOfBounds if it takes more than so many seconds or bytes, and what the work
    raises. Where processes cannot be forked it is done in this one, without bounds.
    """
    if sys.platform == "win32":
        return work()
    receiver, sender = Pipe(duplex=False)
    child = 0
    # Ctrl-C waits until it is known which of the two processes this is
    masked = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        child = os.fork()
        if child == 0:
            _in_child(work, sender, seconds, memory)
        signal.pthread_sigmask(signal.SIG_SETMASK, masked)
        sender.close()
        if not receiver.poll(seconds):
            raise OutOfBounds(f"it took more than {seconds:g} seconds")
        done, result = pickle.loads(receiver.recv_bytes())
    except (EOFError, OSError):  # the latter if it ended while it wrote
        raise OutOfBounds("its process ended early, most likely for want of memory") from None
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, masked)
        if child:
            _end(child)
        receiver.close()
        sender.close()
    if not done:
        raise result
    found: T = result
    return found


def _end(child: int) -> None:
    """Of a process that may have ended already; none is left that nobody waited for."""
    with suppress(ProcessLookupError):
        os.kill(child, signal.SIGKILL)
    with suppress(ChildProcessError):
        os.waitpid(child, 0)


def _in_child(work: Callable[[], Any], sender: Connection, seconds: float, memory: int) -> NoReturn:
    try:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever waits for it ends it
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        signal.signal(signal.SIGALRM, signal.SIG_DFL)  # ends it if its parent was killed and cannot do so
        signal.setitimer(signal.ITIMER_REAL, min(seconds, _LONGEST) + 1)
        _silence()
        _limit(memory)
        sender.send_bytes(_answer(work, memory))
        sender.close()
    finally:
        os._exit(0)  # no handlers of the program that was forked


def _answer(work: Callable[[], Any], memory: int) -> bytes:
    """Whether it was done, and what came of it, pickled."""
    try:
        return pickle.dumps((True, work()))
    except MemoryError:
        failure: Exception = OutOfBounds(f"it took more than {memory / 2**30:.3g} GiB of memory")
    except RecursionError:
        failure = OutOfBounds("it is nested too deeply")
    except Exception as error:
        digits = isinstance(error, ValueError) and "integer string conversion" in str(error)  # Python's own bound
        failure = OutOfBounds("it has numbers of thousands of digits") if digits else error
    except BaseException as error:  # an exit of the work is not one of the program
        failure = RuntimeError(f"{type(error).__name__}: {error}")
    try:
        content = pickle.dumps((False, failure))
        pickle.loads(content)
    except Exception:  # not every exception can be sent
        content = pickle.dumps((False, RuntimeError(f"{type(failure).__name__}: {failure}")))
    return content


def _silence() -> None:
    """Warnings, and the last words of libraries in C that are out of memory."""
    faulthandler.disable()
    warnings.simplefilter("ignore")
    with suppress(OSError):
        nowhere = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
        sys.stdout = sys.stderr = nowhere
        os.dup2(nowhere.fileno(), 1)
        os.dup2(nowhere.fileno(), 2)


def _limit(memory: int) -> None:
    with suppress(OSError, ValueError):
        _at_most(resource.RLIMIT_CORE, 0)
    with suppress(OSError, ValueError):
        with open("/proc/self/statm") as file:
            used = int(file.read().split()[0]) * resource.getpagesize()
        _at_most(resource.RLIMIT_AS, used + memory)


def _at_most(what: int, value: int) -> None:
    hard = resource.getrlimit(what)[1]
    resource.setrlimit(what, (value if hard == resource.RLIM_INFINITY else min(value, hard), hard))
