"""Random files for the reader of laws and random texts for the parser: python -m benchmarks.fuzz_laws [--seconds N].

With atheris, if it is installed, which is led by what code each input reaches; else with mutations of the laws under
``examples/laws`` and of a list of nasty pieces. An input may be accepted or refused (InputError, ExpressionError, one
line); anything else is a failure and is printed, as is what takes the processor longer than a second (ten, where
atheris follows it). ``--check`` asks also of some accepted laws whether they are passive, each in a process of its own.
Ends with code 1 on failures.
"""

from __future__ import annotations

import argparse
import random
import sys
import time
from contextlib import suppress
from functools import partial
from pathlib import Path

from benchmarks.fuzzing import SLOW, SLOW_WHEN_FOLLOWED, Tally, atheris, led, mutated, pieces, quoted
from geocosserat.conductor.check import check
from geocosserat.model import evaluation, fields, law, parameters, parser, place, printing, reading, tree
from geocosserat.model.expressions import ExpressionError, parse, to_text
from geocosserat.model.law import Law, load_law
from geocosserat.passivity.check import check as check_law  # imported once, not in every process  # noqa: F401

LAWS = sorted((Path(__file__).parent.parent / "examples" / "laws").glob("*.toml"))
NAMES = ("h1", "h2", "Pi", "h1_dot", "Pi_dot", "u", "t", "k", "a")
MODULES = (evaluation, fields, law, parameters, parser, place, printing, reading, tree)
PIECES = pieces(r"""
h1 h2 Pi h1_dot Pi_dot u t k a theta e1x x y sin( exp( log( sqrt( abs( heaviside( tanh( ( ) ** * / + - 9**9**9 1e308
1e-308 1e999 0 0.1 nan inf -inf 99999999999999999999 __class__ __import__('os') lambda h1.real [ ] { } { symbol=true }
[stress] [energy] [wrench] [friction] [domain] [parameters] [[stress]] density matrix motion="spatial" F1= M= m= = '
  ''' \u0000 \U0010ffff . , # true 1979-05-27 0x1f (1+h1)**1000000 a.a.a.a.a.a.a.a.a.a.a ((((((((((((((((
""")


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


def _asked(read: Law, _: bytes) -> None:
    check(read, seconds=5)


def _mutate(seconds: float, law_tally: Tally, text_tally: Tally, checked: Tally | None) -> None:
    chance = random.Random(time.time_ns())
    laws = [path.read_bytes() for path in LAWS]
    texts = [*quoted(laws), *PIECES]
    end = time.process_time() + seconds
    while time.process_time() < end:
        content = mutated(laws, PIECES, chance)
        found = law_tally.take(content, read_law)
        if found is not None and chance.random() < 0.1 and len(laws) < 2000:
            laws.append(content)
        for _ in range(4):
            text_tally.take(mutated(texts, PIECES, chance), read_expression)
        if checked is not None and isinstance(found, Law) and chance.random() < 0.02:
            checked.take(content, partial(_asked, found))


def main() -> None:
    """Runs and prints counts."""
    words = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else None)
    words.add_argument("--seconds", type=float, default=60.0, help="of the processor")
    words.add_argument("--check", action="store_true", help="ask also whether accepted laws are passive")
    words.add_argument("--own", action="store_true", help="mutate, even if atheris is installed")
    asked = words.parse_args()
    follow = atheris is not None and not asked.own
    slow = SLOW_WHEN_FOLLOWED if follow else SLOW
    tallies = Tally("law files", slow), Tally("expressions", slow)
    if follow:
        laws = [path.read_bytes() for path in LAWS]
        seeds = [*(b"\x01" + seed for seed in laws), *(b"\x00" + text for text in quoted(laws))]
        led(asked.seconds, {b"\x01": (tallies[0], read_law), b"\x00": (tallies[1], read_expression)}, seeds, MODULES)
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
