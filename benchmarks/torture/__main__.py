"""All cases by all methods, each in a process of its own; a table, and all verdicts as lines of JSON.

    python -m benchmarks.torture [--methods auto,safe] [--lines FILE] [words of names or families of cases]
    python -m benchmarks.torture --table FILE
"""

from __future__ import annotations

import json
import sys
from argparse import ArgumentParser
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path

from benchmarks.torture.case import Case
from benchmarks.torture.cases import cases
from benchmarks.torture.judge import AUTO, CUT_OFF, FAILED, Reference, Verdict, judge, reference
from benchmarks.torture.peer import judge_peer
from benchmarks.torture.table import PEER, table
from geocosserat.bounded import OutOfBounds, bounded
from geocosserat.solver.integrate import LAST_RESORTS, METHODS

SECONDS = 60.0
"""For a case by a method; three times as long by those that must not fail, and for references."""

PATIENT = (AUTO, LAST_RESORTS[0])
"""The default, which must come to an end in that time, and the safe method, which may be slow and is then cut off."""

EVERY = (AUTO, *LAST_RESORTS, *METHODS, PEER)


def verdicts(some: Sequence[Case], methods: Sequence[str]) -> Iterator[Verdict]:
    """Every case by every method; none is left out."""
    for case in some:
        try:
            known = bounded(partial(reference, case), 3 * SECONDS)
        except OutOfBounds as error:
            known = Reference(None, str(error))
        for method in methods:
            yield _bounded(case, method, known)


def _bounded(case: Case, method: str, known: Reference) -> Verdict:
    """One verdict; what breaks has failed, and the default if it hangs; others are cut off."""
    patient = method in PATIENT
    seconds = 3 * SECONDS if patient else SECONDS
    work = partial(judge_peer, case, known) if method == PEER else partial(judge, case, method, known)
    try:
        return bounded(work, seconds)
    except OutOfBounds as error:
        return Verdict(case.name, method, FAILED if method == AUTO else CUT_OFF, str(error), seconds=seconds)
    except Exception as error:  # whatever it is: that is what is looked for
        return Verdict(case.name, method, FAILED, f"{type(error).__name__}: {error}")


def main() -> None:
    """Judges the cases that are wanted, or prints the table of verdicts that are there."""
    parser = ArgumentParser(prog="python -m benchmarks.torture")
    parser.add_argument("words", nargs="*", help="of names or families of cases; all if none")
    parser.add_argument("--methods", default=",".join(EVERY))
    parser.add_argument("--lines", default="out/torture.jsonl", help="file for the verdicts")
    parser.add_argument("--table", help="print the table of the verdicts in this file, and judge nothing")
    asked = parser.parse_args()
    if asked.table is not None:
        lines = Path(asked.table).read_text().splitlines()
        print(table([Verdict(**json.loads(line)) for line in lines]))
        return
    some = [case for case in cases() if not asked.words or any(w in (case.name, case.family) for w in asked.words)]
    found = []
    path = Path(asked.lines)
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w") as file:
        for verdict in verdicts(some, asked.methods.split(",")):
            found.append(verdict)
            print(json.dumps(asdict(verdict)), file=file, flush=True)
            print(f"{verdict.case}, {verdict.method}: {verdict.outcome} {verdict.why}", file=sys.stderr)
    print(table(found))


if __name__ == "__main__":
    main()
