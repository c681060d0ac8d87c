"""Random files for the reader of laws and random texts for the parser: python -m benchmarks.fuzz_laws [--seconds N].

With atheris, if it is installed, which is led by what code each input reaches; else with mutations of the laws under
``examples/laws`` and of a list of nasty pieces. An input may be accepted or refused (InputError, ExpressionError, one
line); anything else is a failure and is printed, as is what takes the processor longer than a second (ten, where
atheris follows it). ``--check`` asks also of some accepted laws whether they are passive, each in a process of its own.
Ends with code 1 on failures.
"""

from __future__ import annotations

import argparse
import os
import random
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from importlib import import_module
from pathlib import Path
from shutil import rmtree
from tempfile import mkdtemp
from types import FunctionType
from typing import Any

from geocosserat.conductor.check import check
from geocosserat.model import evaluation, fields, law, parameters, parser, place, printing, reading, tree
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import ExpressionError, parse, to_text
from geocosserat.model.law import Law, load_law
from geocosserat.passivity.check import check as check_law  # imported once, not in every process  # noqa: F401

try:
    atheris: Any = import_module("atheris")
except ImportError:
    atheris = None

LAWS = sorted((Path(__file__).parent.parent / "examples" / "laws").glob("*.toml"))
NAMES = ("h1", "h2", "Pi", "h1_dot", "Pi_dot", "u", "t", "k", "a")
SLOW, SLOW_WHEN_FOLLOWED = 1.0, 10.0  # seconds of the processor; atheris makes all it follows some ten times slower
WORDS = r"""
h1 h2 Pi h1_dot Pi_dot u t k a theta e1x x y sin( exp( log( sqrt( abs( heaviside( tanh( ( ) ** * / + - 9**9**9 1e308
1e-308 1e999 0 0.1 nan inf -inf 99999999999999999999 __class__ __import__('os') lambda h1.real [ ] { } { symbol=true }
[stress] [energy] [wrench] [friction] [domain] [parameters] [[stress]] density matrix motion="spatial" F1= M= m= = '
  ''' \u0000 \U0010ffff . , # true 1979-05-27 0x1f (1+h1)**1000000 a.a.a.a.a.a.a.a.a.a.a ((((((((((((((((
"""
OTHERS = ('"', '"""', "\n", "\r\n", " ", "\t", "\0", "\ufeff", "\u0435", "\u200d", "\uff11", "\u2028", "\x85")
PIECES = (*(piece.encode() for piece in (*WORDS.split(), *OTHERS)), b"\xff", b"\xc3")


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
        except (InputError, ExpressionError) as error:
            self.counts["refused"] += 1
            if not str(error).isprintable():
                self._fail("a message that does not print on one line", content)
        except Exception as error:
            self._fail(f"{type(error).__name__}: {str(error)[:200]}", content)
        taken = time.process_time() - start
        self.longest = max(self.longest, taken)
        if taken > self.slow:
            self._fail(f"{taken:.1f} seconds", content)
        return result

    def _fail(self, why: str, content: bytes) -> None:
        self.counts["failures"] += 1
        if len(self.failures) < 20:
            self.failures.append(why)
            print(f"{self.what}: {why}\n    {content[:4000]!r}", flush=True)

    def __str__(self) -> str:
        counts = ", ".join(f"{self.counts[key]} {key}" for key in ("inputs", "accepted", "refused", "failures"))
        return f"{self.what}: {counts}, longest {self.longest:.3g} s"


def read_law(content: bytes) -> Law:
    """As a file would be read; the law then reads back from its own text."""
    found = load_law(content.decode("utf-8-sig", "replace") + "\n")
    str(found)
    load_law(found.source + "\n")
    return found


def read_expression(content: bytes) -> None:
    """What is accepted prints as a text that means the same."""
    e = parse(content.decode("utf-8", "replace"), NAMES)
    with suppress(ExpressionError):  # what is printed may be deeper by parentheses
        if parse(to_text(e), NAMES) != e:
            raise AssertionError(f"reads back as another expression: {to_text(e)}")


def mutated(seeds: Sequence[bytes], chance: random.Random) -> bytes:
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
                content[i:j] = chance.choice(PIECES)
    return bytes(content[:20_000])


def expressions(seeds: Sequence[bytes]) -> Iterator[bytes]:
    """What stands in quotes in the seeds."""
    for seed in seeds:
        yield from (part for part in seed.split(b'"')[1::2] if part)


def _asked(read: Law, _: bytes) -> None:
    check(read, seconds=5)


def _mutate(seconds: float, law_tally: Tally, text_tally: Tally, checked: Tally | None) -> None:
    chance = random.Random(time.time_ns())
    laws = [path.read_bytes() for path in LAWS]
    texts = [*expressions(laws), *PIECES]
    end = time.process_time() + seconds
    while time.process_time() < end:
        content = mutated(laws, chance)
        found = law_tally.take(content, read_law)
        if found is not None and chance.random() < 0.1 and len(laws) < 2000:
            laws.append(content)
        for _ in range(4):
            text_tally.take(mutated(texts, chance), read_expression)
        if checked is not None and isinstance(found, Law) and chance.random() < 0.02:
            checked.take(content, partial(_asked, found))


def _functions() -> Iterator[FunctionType]:
    """All that reads laws, for atheris to follow."""
    for module in (evaluation, fields, law, parameters, parser, place, printing, reading, tree):
        for thing in vars(module).values():
            if getattr(thing, "__module__", None) != module.__name__:
                continue
            for function in (thing, *vars(thing).values()) if isinstance(thing, type) else (thing,):
                if isinstance(function, FunctionType):
                    yield function


def _led(seconds: float, law_tally: Tally, text_tally: Tally) -> None:
    end = time.process_time() + seconds
    folder = mkdtemp()

    def one(content: bytes) -> None:
        if content[:1] < b"\x40":
            text_tally.take(content[1:], read_expression)
        else:
            law_tally.take(content[1:], read_law)
        if time.process_time() > end:
            print(law_tally, text_tally, sep="\n", flush=True)
            rmtree(folder)
            os._exit(1 if law_tally.failures or text_tally.failures else 0)  # an exception would count as a find

    for function in _functions():
        atheris.instrument_func(function)
    seeds = [path.read_bytes() for path in LAWS]
    marked = [*(b"\x40" + seed for seed in seeds), *(b"\x00" + text for text in expressions(seeds))]
    for i, seed in enumerate(marked):
        (Path(folder) / str(i)).write_bytes(seed)
    atheris.Setup([sys.argv[0], "-verbosity=0", "-max_len=4000", f"-artifact_prefix={folder}/", folder], one)
    atheris.Fuzz()


def main() -> None:
    """Runs and prints counts."""
    words = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else None)
    words.add_argument("--seconds", type=float, default=60.0, help="of the processor")
    words.add_argument("--check", action="store_true", help="ask also whether accepted laws are passive")
    words.add_argument("--own", action="store_true", help="mutate, even if atheris is installed")
    asked = words.parse_args()
    led = atheris is not None and not asked.own
    slow = SLOW_WHEN_FOLLOWED if led else SLOW
    tallies = Tally("law files", slow), Tally("expressions", slow)
    if led:
        _led(asked.seconds, *tallies)
        return
    if atheris is None:
        print("atheris is not installed (pip install atheris): mutating the laws under examples/laws instead")
    checked = Tally("checked", float("inf")) if asked.check else None
    _mutate(asked.seconds, *tallies, checked)
    shown = [*tallies, *([checked] if checked else [])]
    print(*shown, sep="\n")
    if any(tally.failures for tally in shown):
        sys.exit(1)


if __name__ == "__main__":
    main()
