"""How short runs of all solvers are timed: as the second of two, one right after the other."""

from collections.abc import Callable
from typing import TypeVar

LONG = 0.1
"""Seconds from which on it makes no difference."""

Result = TypeVar("Result")


def warm(run: Callable[[], tuple[Result, float]]) -> tuple[Result, float]:
    """What a run returns, and its seconds, when the processor's caches hold what it needs, as they do where a run
    follows on another. Whatever else is done to prepare it or to judge it comes before both or after both."""
    found = run()
    return found if found[1] > LONG else run()
