"""The program in processes of its own, to be ended at any moment, and what it should have left."""

from __future__ import annotations

import os
import re
import resource
import signal
import sys
import time
import traceback
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from geocosserat.__main__ import main
from geocosserat.conductor import run as running
from geocosserat.passivity.check import check as check_law  # imported once, not in every process  # noqa: F401
from geocosserat.results import picture as pictures
from geocosserat.results.atomic import PART, write_bytes
from geocosserat.results.checkpoint import NAME as CHECKPOINT
from geocosserat.results.checkpoint import Keeper
from geocosserat.results.netcdf import load
from geocosserat.results.solution import SHAPES, Solution
from geocosserat.solver import legs

EXAMPLES = Path(__file__).parents[2] / "examples"
SAME = ("method", "elements", "degree", "unknowns", "estimated", "evaluations", "reached", "reason")
HURRIED_LEG = 40
PATIENCE = 300.0
"""Seconds after which a program counts as hanging."""


def _blank(_: Solution, path: str | os.PathLike[str]) -> Path:
    return write_bytes(path, b"a picture")


@dataclass(frozen=True)
class Case:
    """A scene and how it is run. hurried: with legs of few steps and a checkpoint after each, as if it took hours, and
    without drawing, which would take most of the time."""

    scene: str
    settings: tuple[str, ...] = ()
    hurried: bool = True

    @property
    def name(self) -> str:
        return " ".join((self.scene, *self.settings, *(() if self.hurried else ("as it is",))))

    def arguments(self, out: Path) -> list[str]:
        changes = [word for setting in self.settings for word in ("--set", setting)]
        return ["run", str(EXAMPLES / f"{self.scene}.toml"), "--out", str(out), *changes]

    def prepare(self) -> None:
        if self.hurried:
            legs.enough = lambda size: HURRIED_LEG  # type: ignore[assignment]
            Keeper.EVERY = Keeper.SHARE = 0.0
            pictures.picture = _blank


def _fixed(elements: int, degree: int, rtol: float, method: str, *more: str) -> tuple[str, ...]:
    chosen = {"elements": elements, "degree": degree, "rtol": rtol, "method": f'"{method}"'}
    return (*(f"run.{key}={value}" for key, value in chosen.items()), *more)


CASES = (
    Case("cantilever", ("run.accuracy=1e-9",)),
    Case("helix", ("run.frames=301",)),
    Case("kirchhoff"),
    Case("swimmer", ("run.accuracy=1e-7",)),
    Case("driven"),
    Case("stepped"),
    Case("driven", _fixed(8, 4, 1e-9, "cvode", "run.frames=801")),
    Case("inextensible", _fixed(8, 4, 1e-9, "cvode", "run.frames=801")),
    Case("helix", _fixed(16, 4, 1e-10, "cvode", "run.frames=1201")),
    Case("swimmer", _fixed(2, 6, 1e-7, "radau", "run.frames=801")),
    Case("cantilever", _fixed(2, 4, 1e-6, "bdf", 'run.backend="numpy"', "run.frames=201")),
    Case("cantilever", _fixed(2, 4, 1e-6, "lsoda", 'run.backend="numpy"', "run.frames=201")),
    Case("inextensible", _fixed(2, 4, 1e-6, "cvode", 'run.backend="numpy"', "run.frames=201")),
)
QUICK = Case("cantilever", _fixed(2, 4, 1e-7, "cvode", "run.frames=201"))
AS_IT_IS = Case("driven", _fixed(64, 8, 1e-11, "cvode", "run.frames=2001", "run.until=15"), hurried=False)
"""Long enough for checkpoints by the clock."""


def start(arguments: Sequence[str], said: Path, prepare: Callable[[], None] = lambda: None) -> int:
    """The program in a process of its own, by its number; what it says of errors goes to a file. An interrupt that
    comes before it has begun waits until then."""
    said.parent.mkdir(parents=True, exist_ok=True)
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    child = os.fork()
    if child:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        return child
    code = 1
    try:
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115
        sys.stderr = open(said, "w", buffering=1)  # noqa: SIM115
        os.dup2(sys.stderr.fileno(), 2)
        sys.argv = ["geocosserat", *arguments]
        signal.signal(signal.SIGINT, signal.default_int_handler)
        prepare()
        _begun()
        code = 0
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 0 if end.code is None else 1
    except BaseException:
        traceback.print_exc()
    finally:
        os._exit(code)


def _begun() -> None:
    """The program; interrupts are let through where it first asks who looks after them."""
    asked = signal.getsignal

    def first(number: int) -> object:
        signal.getsignal = asked
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        return asked(number)

    signal.getsignal = first  # type: ignore[assignment]
    main()


def wait(child: int) -> int:
    """Its exit code, negative for a signal; one that hangs is ended, and counts so."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.002)
    stop(child, signal.SIGKILL)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def stop(child: int, number: int) -> None:
    """Sends a signal to a process that may be over."""
    with suppress(ProcessLookupError):
        os.kill(child, number)


def finished(arguments: Sequence[str], said: Path, prepare: Callable[[], None] = lambda: None) -> int:
    """Runs the program to its end: its exit code."""
    return wait(start(arguments, said, prepare))


def wrong_with(folder: Path, expected: Solution) -> str:
    """What is wrong with the files of a run that came to its end; nothing if they are as they should be."""
    names = {path.name for path in folder.iterdir()}
    if names != {running.SOLUTION, running.PICTURE, running.SUMMARY}:
        return f"files {sorted(names)}"
    return differences(load(folder / running.SOLUTION), expected)


def differences(one: Solution, other: Solution) -> str:
    """Names of what differs between two solutions in any bit; seconds and dates may."""
    def bits(solution: Solution, name: str) -> bytes | None:
        array = getattr(solution, name)
        return None if array is None else array.tobytes()

    arrays = (name for name in SHAPES if bits(one, name) != bits(other, name))
    return ", ".join((*arrays, *(name for name in SAME if getattr(one, name) != getattr(other, name))))


def going_on(folder: Path) -> list[str]:
    """What to say to a run that was interrupted: go on, or, where it left no checkpoint, begin again."""
    if (folder / CHECKPOINT).exists():
        return ["--resume"]
    return ["--overwrite"] if (folder / running.SOLUTION).exists() else []


def parts(folder: Path) -> list[str]:
    """Files that were being written."""
    return [path.name for path in folder.iterdir() if re.fullmatch(PART, path.name)]


def small_files(size: int) -> None:
    """No file may be larger from here on, in this process."""
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))
