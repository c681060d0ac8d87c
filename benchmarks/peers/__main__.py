"""This project beside its peers, on the same problems to the same errors: python -m benchmarks.peers [--quick] [--json
F].

Markdown on standard output. Times are milliseconds, minimum (median) of five runs, each right after another one; then
how many times ours; then the setting that was found to be the cheapest. `--quick` measures one motion in the plane and
fewer accuracies. The optional libraries are the extra `bench`; where one is missing its row says so.
"""

import argparse
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benchmarks.peers import motion, standing, statics
from benchmarks.peers.others import LOOKED_AT
from benchmarks.peers.problems import reference_error
from benchmarks.peers.writing import plain, table


def sections(quick: bool = False) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """One after the other as they are measured: name, Markdown, numbers."""
    targets = motion.targets(quick)
    for problem in motion.problems(quick):
        rows = motion.measure(problem, quick)
        said = f"{problem.name}. The reference is good to {reference_error(problem):.0e}."
        yield problem.name, f"{said}\n\n{table(rows, targets)}", plain(rows)
    rows = standing.measure(quick)
    said = "Cantilever under a dead load, to its static state; error of the tip."
    yield "cantilever", f"{said}\n\n{table(rows, statics.TARGETS)}", plain(rows)


def tables() -> str:
    """All tables in Markdown."""
    return "\n".join([*(text for _, text, _ in sections()), LOOKED_AT])


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.peers", description="Time to an error, side by side.")
    parser.add_argument("--quick", action="store_true", help="one motion in the plane, fewer accuracies")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the numbers there too")
    words = parser.parse_args()
    numbers = {}
    for name, text, found in sections(words.quick):
        print(text, flush=True)
        numbers[name] = found
    print(LOOKED_AT)
    if words.json:
        words.json.write_text(json.dumps(numbers, indent=1) + "\n")


if __name__ == "__main__":
    main()
