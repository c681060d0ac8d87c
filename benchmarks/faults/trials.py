"""One trial of each kind of fault: what happened, and what was lost, which should be nothing."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from benchmarks.faults.programs import (
    CASES,
    CHECKPOINT,
    QUICK,
    Case,
    differences,
    finished,
    going_on,
    parts,
    small_files,
    start,
    stop,
    wait,
    wrong_with,
)
from geocosserat.conductor import run as running
from geocosserat.results.checkpoint import load_checkpoint
from geocosserat.results.errors import FileError
from geocosserat.results.netcdf import load
from geocosserat.results.solution import Solution

WRONG_INPUT, NOT_REACHED = 2, 3


@dataclass(frozen=True)
class Outcome:
    """What happened, in a word or two, and what is wrong with it; and whether the fault struck at all: a run may come
    to its end before, or a disk have room."""

    what: str
    lost: str = ""
    struck: bool = True


@dataclass(frozen=True)
class Reference:
    """The run that nobody disturbed, its folder, and the seconds that it took with its kernel at hand."""

    solution: Solution
    folder: Path
    seconds: float


@dataclass
class Ground:
    """A folder for trials, with a cache of its own; runs that were not disturbed, by their cases."""

    folder: Path
    known: dict[Case, Reference] = field(default_factory=dict)

    def reference(self, case: Case) -> Reference:
        """Made twice if it is not there: only the second one finds its kernel compiled."""
        if case not in self.known:
            for _ in range(2):
                out = Path(tempfile.mkdtemp(dir=self.folder)) / "reference"
                begun = time.monotonic()
                code = finished(case.arguments(out), self.said, case.prepare)
                assert code == 0, self.said.read_text()
            self.known[case] = Reference(load(out / running.SOLUTION), out, time.monotonic() - begun)
        return self.known[case]

    @property
    def said(self) -> Path:
        """Where a program's errors go."""
        return self.folder / "said"

    @contextmanager
    def new(self, older: Path | None = None) -> Iterator[Path]:
        """The folder of one run, which is not there yet, or holds what an older run left."""
        inside = Path(tempfile.mkdtemp(dir=self.folder))
        if older is not None:
            shutil.copytree(older, inside / "out")
        yield inside / "out"
        shutil.rmtree(inside)

    def after(self, code: int, out: Path, expected: Reference) -> str:
        """What is wrong with a run that should have come to its end."""
        return f"code {code}: {self.said.read_text()[-500:]}" if code else wrong_with(out, expected.solution)

    def message(self) -> str:
        """What is wrong with what a program said that refused something: one line is right."""
        lines = self.said.read_text(errors="replace").splitlines()
        return "" if len(lines) == 1 and lines[0].startswith("geocosserat: ") else f"said {lines[-3:]}"


Trial = Callable[[Ground, random.Random], Outcome]


def killed(
    ground: Ground, chance: random.Random, cases: tuple[Case, ...] = CASES, number: int = signal.SIGKILL
) -> Outcome:
    """Ended at a random moment, often twice, and gone on with."""
    case = chance.choice(cases)
    expected, times, resumed = ground.reference(case), chance.choice((1, 1, 2, 3)), 0
    with ground.new() as out:
        for _ in range(times):
            more = going_on(out) if out.exists() else []
            child = start([*case.arguments(out), *more], ground.said, case.prepare)
            time.sleep(chance.uniform(0.0, expected.seconds))
            stop(child, number)
            code = wait(child)
            resumed += "--resume" in more
            if code == 0:
                break
            if number == signal.SIGINT and (code != NOT_REACHED or ground.message()):
                return Outcome("interrupted", f"{case.name}: code {code}, {ground.message()}")
            if (out / running.SOLUTION).exists() and differences(load(out / running.SOLUTION), expected.solution):
                return Outcome("ended", f"{case.name}: a wrong solution was left")
        if code == 0:
            what = "came to its end from a checkpoint" if resumed else "came to its end before"
            return Outcome(what, wrong_with(out, expected.solution), struck=resumed > 0)
        more = going_on(out) if out.exists() else []
        code = finished([*case.arguments(out), *more], ground.said, case.prepare)
        if code:
            return Outcome("not gone on with", f"{case.name}: code {code}: {ground.said.read_text()[-500:]}")
        wrong = wrong_with(out, expected.solution)
    what = "went on from a checkpoint" if "--resume" in more or resumed else "had no checkpoint yet, began again"
    return Outcome(what, wrong and f"{case.name}: {wrong}")


interrupted: Trial = partial(killed, number=signal.SIGINT)


def _in_cache(case: Case, cache: Path) -> None:
    """Prepares a process for a case, with a cache of its own."""
    case.prepare()
    os.environ["GEOCOSSERAT_CACHE"] = str(cache)


def killed_while_making(ground: Ground, chance: random.Random) -> Outcome:
    """Ended while its kernel is derived, compiled and stored, in an empty cache; the next run finds nothing broken."""
    case = Case("pinned", ("run.elements=2", f"run.degree={chance.choice((3, 4))}"))
    expected = ground.reference(case)
    with ground.new() as out:
        cache = out.parent / "cache"
        own = partial(_in_cache, case, cache)
        child = start(case.arguments(out), ground.said, own)
        time.sleep(chance.uniform(0.0, 4.0))
        stop(child, signal.SIGKILL)
        wait(child)
        litter = len(list(cache.glob(".part-*"))) if cache.exists() else 0
        code = finished([*case.arguments(out), "--overwrite"], ground.said, own)
        wrong = ground.after(code, out, expected)
        kept = [path.name for path in cache.glob(".part-*")]
    return Outcome("left unfinished files" if litter else "left none", wrong or (f"kept {kept}" if kept else ""))


def _over_an_older_run(ground: Ground, case: Case, prepare: Callable[[], None], older: Case) -> Outcome:
    """Writes over an older run where it cannot: each file is the old one or the new one."""
    expected, before = ground.reference(case), ground.reference(older)
    with ground.new(before.folder) as out:
        code = finished([*case.arguments(out), "--overwrite"], ground.said, prepare)
        if parts(out):
            return Outcome("left parts", ", ".join(parts(out)))
        found = load(out / running.SOLUTION)
        new = not differences(found, expected.solution)
        if not new and differences(found, before.solution):
            return Outcome("wrote", "a solution that is neither the old one nor the new one")
        if code == 0:
            return Outcome("there was room", wrong_with(out, expected.solution), struck=False)
        said = [line for line in ground.said.read_text().splitlines() if "no checkpoint could be written" not in line]
        if code != WRONG_INPUT or len(said) != 1 or not said[0].startswith("geocosserat: "):
            return Outcome("refused", f"code {code}, said {said[-3:]}")
        if (out / CHECKPOINT).exists():
            load_checkpoint(out)
        more = going_on(out)
        code = finished([*case.arguments(out), *more], ground.said, case.prepare)
        wrong = f"code {code}" if code else wrong_with(out, expected.solution)
    return Outcome(f"{'new' if new else 'old'} solution kept, {more[0][2:]} completed it", wrong)


def file_too_large(ground: Ground, chance: random.Random) -> Outcome:
    """The system writes no more than so many bytes of a file."""
    case, older = CASES[0], Case("cantilever", ("run.accuracy=1e-3",))
    largest = max(path.stat().st_size for path in ground.reference(case).folder.iterdir())
    size = chance.randrange(1, int(1.2 * largest))

    def prepare() -> None:
        case.prepare()
        small_files(size)

    return _over_an_older_run(ground, case, prepare, older)


@contextmanager
def _mounted(folder: Path, size: int) -> Iterator[bool]:
    """A file system of so many bytes, and whether there is one: only the system's administrator may mount it."""
    folder.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(folder)]
    mounted = subprocess.run(command, capture_output=True, check=False).returncode == 0
    try:
        yield mounted
    finally:
        if mounted:
            subprocess.run(["umount", str(folder)], check=True)


def _remount(folder: Path, option: str) -> None:
    subprocess.run(["mount", "-o", f"remount,{option}", str(folder)], check=True)


def full_disk(ground: Ground, chance: random.Random) -> Outcome:
    """A file system of a few pages, mounted for the trial."""
    case = CASES[0]
    expected = ground.reference(case)
    need = sum(path.stat().st_size for path in expected.folder.iterdir())
    with ground.new() as folder, _mounted(folder.with_name("disk"), chance.randrange(4096, int(1.5 * need))) as mounted:
        if not mounted:
            return Outcome("no right to mount", struck=False)
        disk = folder.with_name("disk")
        out = disk / "out"
        code = finished(case.arguments(out), ground.said, case.prepare)
        said = [line for line in ground.said.read_text().splitlines() if "no checkpoint could" not in line]
        if code == 0:
            return Outcome("there was room", wrong_with(out, expected.solution), struck=False)
        if code != WRONG_INPUT or len(said) != 1:
            return Outcome("refused", f"code {code}, said {said[-3:]}")
        _remount(disk, f"size={10 * need}")
        more = going_on(out) if out.exists() else []
        code = finished([*case.arguments(out), *more], ground.said, case.prepare)
        what = "went on" if "--resume" in more else "began again"
        return Outcome(f"{what} when there was room", ground.after(code, out, expected))


def read_only(ground: Ground, chance: random.Random) -> Outcome:
    """A folder, or one above it, in which nobody may write."""
    case = QUICK
    expected = ground.reference(case)
    with ground.new() as folder, _mounted(folder.with_name("disk"), 2**24) as mounted:
        above = folder.with_name("disk")
        out = above / "out"
        inside = chance.random() < 0.5
        if inside:
            shutil.copytree(expected.folder, out)
        before = {path: path.read_bytes() for path in above.rglob("*.*")}
        if mounted:
            _remount(above, "ro")
        elif os.getuid() == 0:  # whom no mode stops
            return Outcome("no right to mount", struck=False)
        for path in () if mounted else (out, above) if inside else (above,):
            path.chmod(0o555)
        code = finished([*case.arguments(out), "--overwrite"], ground.said, case.prepare)
        same = {path: path.read_bytes() for path in above.rglob("*.*")} == before
        for path in () if mounted else (above, out) if inside else (above,):
            path.chmod(0o755)
    wrong = "" if code == WRONG_INPUT else f"code {code}"
    return Outcome("refused", wrong or ground.message() or ("" if same else "files changed"))


def damage(content: bytes, chance: random.Random) -> bytes:
    """Cut off, with changed bits, zeros in the place of blocks, or something in addition."""
    bad = bytearray(content)
    at = chance.randrange(len(bad))
    match chance.randrange(5):
        case 0:
            bad = bad[:at]
        case 1:
            bad[at] ^= 1 << chance.randrange(8)
        case 2:
            for _ in range(20):
                bad[chance.randrange(len(bad))] ^= chance.randrange(1, 256)
        case 3:
            bad[at : at + 4096] = bytes(len(bad[at : at + 4096]))
        case _:
            bad += os.urandom(chance.randrange(1, 100))
    return bytes(bad) if bytes(bad) != content else bytes(bad[:-1])


def damaged_solution(ground: Ground, chance: random.Random) -> Outcome:
    """A solution file is read as it was written or not at all."""
    expected = ground.reference(QUICK)
    with ground.new(expected.folder) as out:
        path = out / running.SOLUTION
        path.write_bytes(damage(path.read_bytes(), chance))
        try:
            load(path)
        except FileError as error:
            return Outcome("refused", "" if str(error).isprintable() else f"said {error}")
    return Outcome("read", "a damaged solution was read as a good one")


def ended_run(ground: Ground) -> Path:
    """A folder with the checkpoint of a run that was ended."""
    folder = ground.folder / "interrupted"
    while not (folder / CHECKPOINT).exists():
        child = start([*QUICK.arguments(folder), "--overwrite"], ground.said, QUICK.prepare)
        while not (folder / CHECKPOINT).exists() and not (folder / running.SOLUTION).exists():
            time.sleep(1e-3)
        stop(child, signal.SIGKILL)
        wait(child)
    return folder


def damaged_checkpoint(ground: Ground, chance: random.Random) -> Outcome:
    """A run does not go on from a damaged checkpoint, says so, and leaves it."""
    with ground.new(ended_run(ground)) as out:
        path = out / CHECKPOINT
        bad = damage(path.read_bytes(), chance)
        path.write_bytes(bad)
        code = finished([*QUICK.arguments(out), "--resume"], ground.said, QUICK.prepare)
        left = path.read_bytes() == bad and not (out / running.SUMMARY).exists()
    wrong = "" if code == WRONG_INPUT else f"code {code}"
    return Outcome("refused", wrong or ground.message() or ("" if left else "files changed"))


def damaged_cache(ground: Ground, chance: random.Random) -> Outcome:
    """Kernels, as text or compiled, are used as they were made or made again."""
    case = Case("pinned", ("run.elements=2", "run.degree=3"))
    expected = ground.reference(case)
    cache = Path(os.environ["GEOCOSSERAT_CACHE"])
    path = chance.choice(sorted(path for path in cache.iterdir() if path.suffix in (".so", ".json")))
    good = path.read_bytes()
    path.write_bytes(damage(good, chance))
    with ground.new() as out:
        code = finished(case.arguments(out), ground.said, case.prepare)
        wrong = ground.after(code, out, expected)
    path.write_bytes(good)
    path.chmod(0o700)
    return Outcome(f"{path.suffix[1:]} damaged", wrong)


def two_runs(ground: Ground, chance: random.Random) -> Outcome:
    """Two runs into one folder: one writes there, the other is refused, whenever it comes."""
    case = CASES[6]
    expected = ground.reference(case)
    with ground.new() as out:
        said = ground.folder / "also said"
        children = [start(case.arguments(out), ground.said, case.prepare)]
        time.sleep(chance.uniform(0.0, 1.2 * expected.seconds) * chance.choice((0, 1)))
        children.append(start(case.arguments(out), said, case.prepare))
        codes = [wait(child) for child in children]
        refused = (said if codes[1] else ground.said).read_text().splitlines()
        wrong = wrong_with(out, expected.solution)
    if sorted(codes) != [0, WRONG_INPUT] or len(refused) != 1:
        return Outcome("both", f"codes {codes}, said {refused[-3:]}")
    return Outcome("in use" if "in use" in refused[0] else "not empty", wrong)


def one_kernel_twice(ground: Ground, chance: random.Random) -> Outcome:
    """Processes that derive and compile the same kernel at once, one of which may be ended meanwhile."""
    case = Case("pinned", ("run.elements=2", "run.degree=3"))
    expected = ground.reference(case)
    with ground.new() as out:
        cache = out.parent / "cache"
        own = partial(_in_cache, case, cache)
        outs = [out.with_name(f"out{i}") for i in range(2)]
        children = [start(case.arguments(one), out.with_name(f"said{one.name}"), own) for one in outs]
        end_one = chance.random() < 0.3
        if end_one:
            time.sleep(chance.uniform(1.0, 4.0))
            stop(children[1], signal.SIGKILL)
        codes = [wait(child) for child in children]
        pairs = [(one, code) for one, code in zip(outs, codes, strict=True) if not (end_one and code < 0)]
        wrong = [f"code {code}" if code else wrong_with(one, expected.solution) for one, code in pairs]
    return Outcome("one was ended" if end_one else "both", "; ".join(filter(None, wrong)))


def other_clock(ground: Ground, chance: random.Random) -> Outcome:
    """The clock jumps by years, forth and back, between every two looks, and files are of any age."""
    case = chance.choice(CASES[:4])
    expected = ground.reference(case)
    seed = chance.random()

    def prepare() -> None:
        case.prepare()
        jumps, now = random.Random(seed), time.time
        time.time = lambda: now() + jumps.uniform(-1e9, 1e9)
        time.time_ns = lambda: int(1e9 * time.time())

    with ground.new() as out:
        child = start(case.arguments(out), ground.said, prepare)
        time.sleep(chance.uniform(0.0, expected.seconds))
        stop(child, signal.SIGKILL)
        wait(child)
        files = list(out.iterdir()) if out.exists() else []
        for path in (*files, *Path(os.environ["GEOCOSSERAT_CACHE"]).iterdir()):
            with suppress(FileNotFoundError):
                os.utime(path, (age := chance.uniform(0, 4e9), age))
        more = going_on(out) if out.exists() else []
        code = finished([*case.arguments(out), *(more or ["--overwrite"])], ground.said, prepare)
        wrong = ground.after(code, out, expected)
    return Outcome("went on" if "--resume" in more else "began again", wrong and f"{case.name}: {wrong}")


def overwriting(ground: Ground, chance: random.Random) -> Outcome:
    """Files that are there stay as they are unless one says otherwise, whatever they are."""
    names = [running.SOLUTION, running.PICTURE, running.SUMMARY, CHECKPOINT]
    with ground.new() as out:
        out.mkdir()
        for name in chance.sample(names, chance.randrange(1, 5)):
            kind = chance.randrange(3)
            if kind == 0:
                (out / name).write_bytes(os.urandom(10))
            elif kind == 1:
                (out / name).mkdir()
            else:
                (out / name).symlink_to(out / "nowhere")
        before = {path.name: path.lstat() for path in out.iterdir()}
        code = finished(QUICK.arguments(out), ground.said, QUICK.prepare)
        after = {path.name: path.lstat() for path in out.iterdir()}
    same = {name: (s.st_ino, s.st_mtime_ns, s.st_size) for name, s in before.items()} == {
        name: (s.st_ino, s.st_mtime_ns, s.st_size) for name, s in after.items()
    }
    wrong = "" if code == WRONG_INPUT else f"code {code}"
    return Outcome("refused", wrong or ground.message() or ("" if same else "files changed"))


TRIALS: dict[str, tuple[int, Trial]] = {
    "kill -9 at a random moment": (200, killed),
    "kill -9 while a kernel is made": (20, killed_while_making),
    "Ctrl-C at a random moment": (100, interrupted),
    "file larger than the system takes": (60, file_too_large),
    "full disk": (40, full_disk),
    "read-only folder": (20, read_only),
    "damaged solution file": (500, damaged_solution),
    "damaged checkpoint": (100, damaged_checkpoint),
    "damaged cache": (40, damaged_cache),
    "two runs into one folder": (40, two_runs),
    "one kernel compiled twice at once": (10, one_kernel_twice),
    "clock that jumps": (40, other_clock),
    "files that are there already": (40, overwriting),
}
"""How many of each make a whole torture."""
