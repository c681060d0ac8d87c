"""The verdicts as a table: how many cases each method survived, and what it failed."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from benchmarks.torture.judge import OUTCOMES, REFUSED, SURVIVED, Verdict

PEER = "lines"
"""The method of lines, which refuses most cases."""

COLUMNS = ("fell back", "worst ledger", "worst rise of energy", "worst error")
LEGEND = (
    "Ledger: relative to its largest term; rise: of the energy of a rod on which nothing acts, relative to that at the",
    "start; error: over the one asked for. Each is the worst of the cases that were survived.",
)
Number = Callable[[Verdict], float | None]
NUMBERS: tuple[Number, ...] = (lambda v: v.ledger, lambda v: v.rise, lambda v: v.error)


def table(verdicts: Sequence[Verdict]) -> str:
    """A line for each method, then one for each case that a method did not survive."""
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
    lines += [f"* {v.case}, {v.method}: {v.outcome}: {v.why}" for v in told]
    return "\n".join(lines)


def _worst(verdicts: Sequence[Verdict], number: Number) -> str:
    values = [x for v in verdicts if v.outcome == SURVIVED and (x := number(v)) is not None]
    return f"{max(values):.1e}" if values else "-"
