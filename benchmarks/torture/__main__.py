"""All cases by all methods, each in a process of its own, into a table and JSON."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from functools import partial

from benchmarks.torture.cases import cases
from benchmarks.torture.judge import FAILED, Reference, Verdict, judge, reference
from geocosserat.bounded import OutOfBounds, bounded

SECONDS = 60.0

def main() -> None:
    methods = sys.argv[1].split(",")
    words = sys.argv[2:]
    for case in cases():
        if words and not any(w in case.name or w == case.family for w in words):
            continue
        try:
            known = bounded(partial(reference, case), 3 * SECONDS)
        except OutOfBounds as error:
            known = Reference(None, str(error))
        for method in methods:
            try:
                v = bounded(partial(judge, case, method, known), 3 * SECONDS)
            except OutOfBounds as error:
                v = Verdict(case.name, method, FAILED, str(error))
            except Exception as error:
                v = Verdict(case.name, method, FAILED, repr(error))
            print(json.dumps({**asdict(v), "known": known.why}), flush=True)

main()
