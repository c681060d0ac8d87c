"""The verdicts as a table: how many cases each method survived, and what it failed."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from benchmarks.torture.judge import FAILED, OUTCOMES, REFUSED, SURVIVED, Verdict

PEER = "lines"
"""The method of lines, which refuses most cases."""

COLUMNS = ("fell back", "worst ledger", "worst rise of energy", "worst error")
LEGEND = (
    "Ledger: relative to its largest term; rise: of the energy of a rod on which nothing acts, relative to that at the",
    "start; error: over the one asked for. Each is the worst of the cases that were survived.",
)
NUMERAL = re.compile(r"-?\b\d[\d.]*(e[+-]?\d+)?")
EXPECTED = re.compile(r"\bexpected (?!.*\bexpected )")
"""Where the last reason begins that says what was expected and what was found."""

T = TypeVar("T")
Number = Callable[[Verdict], float | None]
NUMBERS: tuple[Number, ...] = (lambda v: v.ledger, lambda v: v.rise, lambda v: v.error)


def table(verdicts: Sequence[Verdict]) -> str:
    """A line for each method, then one for each reason for which a method did not survive a case."""
    methods = list(dict.fromkeys(v.method for v in verdicts))
    lines = [
        f"| {' | '.join(('method', 'cases', *OUTCOMES, *COLUMNS))} |",
        f"|---|---|{'---|' * (len(OUTCOMES) + len(COLUMNS))}",
    ]
    for method in methods:
        own = [v for v in verdicts if v.method == method]
        counts = [sum(v.outcome == outcome for v in own) for outcome in OUTCOMES]
        fell = sum(v.fell_back for v in own)
        worst = [_worst(own, number) for number in NUMBERS]
        lines.append(f"| {' | '.join(map(str, (method, len(own), *counts, fell, *worst)))} |")
    lines += ["", *LEGEND, ""]
    told = [v for v in verdicts if v.outcome != SURVIVED and (v.method, v.outcome) != (PEER, REFUSED)]
    return "\n".join((*lines, *_reasons(told)))


def _reasons(verdicts: Sequence[Verdict]) -> Iterator[str]:
    """Each outcome and reason once, the methods it is of, and the cases: but for failures, reasons that differ in
    numbers alone are one, told without these."""
    for of_kind in _grouped(verdicts, lambda v: (v.outcome, v.why if v.outcome == FAILED else _words(v))):
        by_case = _grouped(of_kind, lambda v: v.case)
        by_methods = _grouped(by_case, lambda own: ", ".join(v.method for v in own))
        yield f"* {of_kind[0].outcome}: {_common(of_kind) or 'no reason'}"
        for own in by_methods:
            yield f"  * {', '.join(v.method for v in own[0])} ({len(own)}): {'; '.join(of[0].case for of in own)}"


def _reason(verdict: Verdict) -> str:
    """All of a failure's; of others, the cause alone if one is told, not what each solver said before it."""
    cause = None if verdict.outcome == FAILED else EXPECTED.search(verdict.why)
    return verdict.why[cause.start() :] if cause else verdict.why


def _common(verdicts: Sequence[Verdict]) -> str:
    """The reason that they share but for numbers, with … for each number that they do not."""
    each = ([numeral.group() for numeral in NUMERAL.finditer(_reason(v))] for v in verdicts)
    shown = iter([of[0] if len({*of}) == 1 else "…" for of in zip(*each, strict=True)])
    return NUMERAL.sub(lambda _: next(shown), _reason(verdicts[0]))


def _words(verdict: Verdict) -> str:
    return NUMERAL.sub("…", _reason(verdict))


def _grouped(things: Sequence[T], key: Callable[[T], object]) -> list[list[T]]:
    """Those of the same key together, in the order in which keys come."""
    found: dict[object, list[T]] = {}
    for thing in things:
        found.setdefault(key(thing), []).append(thing)
    return list(found.values())


def _worst(verdicts: Sequence[Verdict], number: Number) -> str:
    values = [x for v in verdicts if v.outcome == SURVIVED and (x := number(v)) is not None]
    return f"{max(values):.1e}" if values else "-"
