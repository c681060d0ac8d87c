"""Random inputs and what becomes of them: led by atheris, if it is installed, or by mutation of good ones."""

from __future__ import annotations

import os
import random
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from types import FunctionType, ModuleType
from typing import Any

from geocosserat.model.errors import InputError
from geocosserat.model.expressions import ExpressionError
from geocosserat.results.errors import FileError

try:
    atheris: Any = import_module("atheris")
except ImportError:
    atheris = None

MOST_MEMORY = 4096  # MiB; the courses of two driven ends may be half a GiB each, and are several while they are made
SLOW, SLOW_WHEN_FOLLOWED = 1.0, 10.0  # seconds of the processor; atheris makes all it follows some ten times slower
OTHERS = ('"', '"""', "\n", "\r\n", " ", "\t", "\0", "\ufeff", "\u0435", "\u200d", "\uff11", "\u2028", "\x85")


def pieces(words: str) -> tuple[bytes, ...]:
    """Nasty ones to be put into an input: these words, and characters that are often forgotten."""
    return (*(piece.encode() for piece in (*words.split(), *OTHERS)), b"\xff", b"\xc3")


class Tally:
    """What happened to the inputs of one kind."""

    def __init__(self, what: str, slow: float) -> None:
        self.what, self.slow = what, slow
        self.counts: Counter[str] = Counter()
        self.longest = 0.0
        self.failures: list[str] = []

    def take(self, content: bytes, use: Callable[[bytes], object]) -> object:
        """What comes of one input; None if it is refused or fails."""
        start = time.process_time()
        result = None
        self.counts["inputs"] += 1
        try:
            result = use(content)
            self.counts["accepted"] += 1
        except (InputError, ExpressionError, FileError) as error:
            self.counts["refused"] += 1
            if not str(error).isprintable():
                self.fail("a message that does not print on one line", content)
        except Exception as error:
            self.fail(f"{type(error).__name__}: {str(error)[:200]}", content)
        taken = time.process_time() - start
        self.longest = max(self.longest, taken)
        if taken > self.slow:
            self.fail(f"{taken:.1f} seconds", content)
        return result

    def fail(self, why: str, content: bytes) -> None:
        """Counts a failure and prints the first ones."""
        self.counts["failures"] += 1
        if len(self.failures) < 20:
            self.failures.append(why)
            print(f"{self.what}: {why}\n    {content[:4000]!r}", flush=True)

    def __str__(self) -> str:
        counts = ", ".join(f"{self.counts[key]} {key}" for key in ("inputs", "accepted", "refused", "failures"))
        return f"{self.what}: {counts}, longest {self.longest:.3g} s"


def mutated(seeds: Sequence[bytes], nasty: Sequence[bytes], chance: random.Random) -> bytes:
    """A seed with some bytes or pieces put in, taken out, doubled, or exchanged with another seed's."""
    content = bytearray(chance.choice(seeds))
    for _ in range(chance.choice((1, 1, 2, 3, 5, 20))):
        i = chance.randrange(len(content) + 1)
        j = min(len(content), i + chance.choice((0, 1, 1, 2, 5, 20)))
        match chance.randrange(6):
            case 0:
                content[i:j] = b""
            case 1:
                content[i:j] = content[i:j] * chance.choice((2, 3, 100))
            case 2:
                other = chance.choice(seeds)
                start = chance.randrange(len(other))
                content[i:j] = other[start : start + chance.randrange(1, 40)]
            case 3 if j > i:
                content[i] = chance.randrange(256)
            case _:
                content[i:j] = chance.choice(nasty)
    return bytes(content[:20_000])


def quoted(seeds: Sequence[bytes]) -> Iterator[bytes]:
    """What stands in quotes in the seeds."""
    for seed in seeds:
        yield from (part for part in seed.split(b'"')[1::2] if part)


def functions(modules: Sequence[ModuleType]) -> Iterator[FunctionType]:
    """All that is written in some modules, for atheris to follow."""
    for module in modules:
        for thing in vars(module).values():
            if getattr(thing, "__module__", None) != module.__name__:
                continue
            for function in (thing, *vars(thing).values()) if isinstance(thing, type) else (thing,):
                if isinstance(function, FunctionType):
                    yield function


def led(
    seconds: float,
    uses: Mapping[bytes, tuple[Tally, Callable[[bytes], object]]],
    seeds: Sequence[bytes],
    modules: Sequence[ModuleType],
) -> None:
    """Lets atheris find inputs for so many seconds of the processor, prints the counts and ends the program.

    uses: by the first byte of an input. seeds: good inputs, with that byte.
    """
    end = time.process_time() + seconds
    folder = mkdtemp()
    first = next(iter(uses.values()))

    def one(content: bytes) -> None:
        tally, use = uses.get(content[:1], first)
        tally.take(content[1:], use)
        if time.process_time() > end:
            tallies = [tally for tally, _ in uses.values()]
            print(*tallies, sep="\n", flush=True)
            rmtree(folder)
            os._exit(1 if any(tally.failures for tally in tallies) else 0)  # an exception would count as a find

    for function in functions(modules):
        atheris.instrument_func(function)
    for i, seed in enumerate(seeds):
        (Path(folder) / str(i)).write_bytes(seed)
    bounds = ["-max_len=4000", f"-rss_limit_mb={MOST_MEMORY}"]
    atheris.Setup([sys.argv[0], "-verbosity=0", *bounds, f"-artifact_prefix={folder}/", folder], one)
    atheris.Fuzz()
