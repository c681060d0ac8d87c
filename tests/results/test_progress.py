"""Progress is shown to a person who waits at a terminal, and to nobody else."""

from __future__ import annotations

import io
import os
import pty
import sys
import threading
from collections.abc import Iterator
from typing import TextIO

import pytest

from geocosserat.results.progress import progress


class Clock:
    """A clock that a test sets."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


class Terminal:
    """A pseudo-terminal whose output can be read."""

    def __init__(self) -> None:
        self._master, slave = pty.openpty()
        self.stream: TextIO = os.fdopen(slave, "w")
        self._chunks: list[bytes] = []
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        # Linux ends the reading side with an error when the other side closes
        try:
            while chunk := os.read(self._master, 65536):
                self._chunks.append(chunk)
        except OSError:
            pass

    def close(self) -> str:
        """Everything written, once."""
        if not self.stream.closed:
            self.stream.close()
            self._reader.join()
            os.close(self._master)
        return b"".join(self._chunks).decode()


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> Iterator[Terminal]:
    """A terminal that can move its cursor."""
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setenv("COLUMNS", "120")
    for name in ("NO_COLOR", "FORCE_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE"):
        monkeypatch.delenv(name, raising=False)
    opened = Terminal()
    yield opened
    opened.close()


def _simulate(stream: TextIO | None, seconds: float, steps: int = 50) -> None:
    clock = Clock()
    with progress("relaxing", stream=stream, clock=clock) as report:
        for step in range(steps):
            clock.now += seconds / steps
            report((step + 1) / steps, step + 1)


def test_a_long_run_on_a_terminal_shows_a_bar_and_takes_it_away(terminal: Terminal) -> None:
    """With the label, the percentage and the steps; at the end the line is erased."""
    _simulate(terminal.stream, seconds=20.0)
    text = terminal.close()
    for part in ("relaxing", "50%", "25 steps", "0:00:10"):
        assert part in text
    assert text.rindex("\x1b[2K") > text.rindex("relaxing")


def test_a_short_run_shows_nothing(terminal: Terminal) -> None:
    """What is done within a second needs no bar."""
    _simulate(terminal.stream, seconds=0.99)
    assert terminal.close() == ""


@pytest.mark.parametrize("environment", [{}, {"FORCE_COLOR": "1"}, {"TTY_COMPATIBLE": "1"}])
def test_a_stream_that_is_no_terminal_gets_nothing(
    environment: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file or a pipe, even where the environment asks for colour."""
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    stream = io.StringIO()
    _simulate(stream, seconds=100.0)
    assert stream.getvalue() == ""


def test_a_terminal_that_cannot_move_its_cursor_gets_nothing(
    terminal: Terminal, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An editor's output window would fill with bars."""
    monkeypatch.setenv("TERM", "dumb")
    _simulate(terminal.stream, seconds=100.0)
    assert terminal.close() == ""


def test_the_default_stream_is_standard_error(capsys: pytest.CaptureFixture[str]) -> None:
    """Which is no terminal here, so nothing appears, and standard output is never touched."""
    _simulate(None, seconds=100.0)
    assert capsys.readouterr() == ("", "")


def test_progress_without_any_standard_error_is_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a program without a console."""
    monkeypatch.setattr(sys, "stderr", None)
    _simulate(None, seconds=100.0)


def test_the_bar_is_drawn_ten_times_a_second_at_most(terminal: Terminal) -> None:
    """However many steps are reported."""
    _simulate(terminal.stream, seconds=3.0, steps=3000)
    assert terminal.close().count("relaxing") <= 25


def test_a_failed_run_takes_its_bar_away(terminal: Terminal) -> None:
    """So that the message of the error stands on a clean line, and the cursor is visible again."""
    clock = Clock()

    def fail() -> None:
        with progress("r", stream=terminal.stream, clock=clock) as report:
            clock.now += 5.0
            report(0.5, 7)
            raise RuntimeError("stop")

    with pytest.raises(RuntimeError, match="stop"):
        fail()
    text = terminal.close()
    assert "7 steps" in text
    assert text.rindex("\x1b[?25h") > text.rindex("\x1b[?25l")


def test_fractions_outside_the_run_are_cut(terminal: Terminal) -> None:
    """A last step may go a little too far."""
    clock = Clock()
    with progress("r", stream=terminal.stream, clock=clock) as report:
        clock.now += 5.0
        report(1.3, 7)
    assert "100%" in terminal.close()


def test_what_is_counted_has_a_name(terminal: Terminal) -> None:
    """Statements that are judged, say."""
    clock = Clock()
    with progress("judging", unit="statements", stream=terminal.stream, clock=clock) as report:
        clock.now += 5.0
        report(0.5, 12)
    assert "12 statements" in terminal.close()
