"""Work on input that may be hostile, in a process of its own: bounded in time and in memory."""

from __future__ import annotations

import multiprocessing
import multiprocessing.connection
import os
import resource
from collections.abc import Callable
from contextlib import suppress
from typing import Any, TypeVar

MEMORY = 4 * 2**30
"""Bytes of address space that the work may take beyond what the program has."""

T = TypeVar("T")


class OutOfBounds(Exception):
    """The work took more time or memory than it may; ``str()`` says which."""


def bounded(work: Callable[[], T], seconds: float, memory: int = MEMORY) -> T:
    """What ``work()`` returns, which must be picklable; it sees all that there is, and changes nothing of it.

    Raises OutOfBounds if it takes more than so many seconds or bytes, and what the work raises. Where processes cannot
    be forked it is done in this one, without bounds.
    """
    if "fork" not in multiprocessing.get_all_start_methods():
        return work()
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(work, sender, memory), daemon=True)
    process.start()
    sender.close()
    try:
        if not receiver.poll(seconds):
            raise OutOfBounds(f"it took more than {seconds:g} seconds")
        done, result = receiver.recv()
    except EOFError:
        raise OutOfBounds("its process ended early, most likely for want of memory") from None
    finally:
        process.kill()
        process.join()
        receiver.close()
    if not done:
        raise result
    found: T = result
    return found


def _work(work: Callable[[], Any], sender: multiprocessing.connection.Connection, memory: int) -> None:
    _limit(memory)
    try:
        answer: tuple[bool, Any] = (True, work())
    except MemoryError:
        answer = (False, OutOfBounds(f"it took more than {memory / 2**30:.3g} GiB of memory"))
    except RecursionError:
        answer = (False, OutOfBounds("it is nested too deeply"))
    except Exception as error:
        answer = (False, error)
    sender.send(answer)
    sender.close()
    os._exit(0)  # no handlers of the program that was forked


def _limit(memory: int) -> None:
    with suppress(OSError, ValueError):
        with open("/proc/self/statm") as file:
            used = int(file.read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + memory, resource.getrlimit(resource.RLIMIT_AS)[1]))
