"""A progress bar that appears only for a person who waits: on a terminal, and after a second."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

Report = Callable[[float, int], None]
"""Called with the fraction of the time simulated, 0 to 1, and the number of steps taken so far."""

_PAUSE = 0.1  # seconds between two drawings


@contextmanager
def progress(
    label: str = "",
    *,
    unit: str = "steps",
    stream: TextIO | None = None,
    delay: float = 1.0,
    clock: Callable[[], float] = time.monotonic,
) -> Iterator[Report]:
    """Give a `Report` that draws a bar on `stream` (default: standard error) and takes it away at the end.

    `unit` is what the second number of a report counts.

    Nothing is ever written unless the stream is a terminal and `delay` seconds have passed. There is no
    thread: the bar moves when the report is called, and a call between two drawings costs one look at the
    clock.
    """
    chosen = sys.stderr if stream is None else stream
    if chosen is None or chosen.closed or not chosen.isatty():  # sys.stderr is None without a console
        yield _silent
        return
    console = Console(file=chosen)
    if not console.is_terminal or console.is_dumb_terminal:
        yield _silent
        return
    bar = _Bar(console, label, delay, clock, unit)
    try:
        yield bar
    finally:
        bar.close()


def _silent(fraction: float, steps: int) -> None:
    """Report to nobody."""


class _Bar:
    """A rich progress bar that starts late and is drawn at most ten times a second."""

    def __init__(self, console: Console, label: str, delay: float, clock: Callable[[], float], unit: str) -> None:
        self._console, self._label, self._clock, self._unit = console, label, clock, unit
        self._started = clock()
        self._next = self._started + delay
        self._shown: Progress | None = None

    def __call__(self, fraction: float, steps: int) -> None:
        now = self._clock()
        if now < self._next:
            return
        self._next = now + _PAUSE
        if self._shown is None:
            self._shown = self._open()
        self._shown.update(self._shown.task_ids[0], completed=fraction, steps=steps)
        self._shown.refresh()

    def _open(self) -> Progress:
        shown = Progress(
            TextColumn("{task.description}", markup=False),
            BarColumn(), TaskProgressColumn(), TextColumn(f"{{task.fields[steps]}} {self._unit}"),
            TimeElapsedColumn(), TimeRemainingColumn(),
            console=self._console, transient=True, auto_refresh=False, get_time=self._clock,
            redirect_stdout=False, redirect_stderr=False,
        )
        shown.add_task(self._label, total=1.0, steps=0)
        shown.tasks[0].start_time = self._started  # not the time of the first drawing
        shown.start()
        return shown

    def close(self) -> None:
        """Take the bar away."""
        if self._shown is not None:
            self._shown.stop()
