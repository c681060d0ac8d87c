"""What is lost by faults: python -m benchmarks.faults [--share X] [--only WORD] [--seed N] [--json FILE].

The program is run in processes of its own and ended, starved, damaged or doubled at random, until that struck as often
as `TRIALS` says, times --share. Each trial ends with a run that must have the arrays of the undisturbed one, bit for
bit, or a refusal of one line; anything else is a loss and is printed. Ends with code 1 on losses.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any

from benchmarks.faults.programs import AS_IT_IS
from benchmarks.faults.trials import TRIALS, Ground, Trial, killed
from geocosserat.kernel import compile as compiling

MOST_MISSES = 3
"""For each trial asked for: then a fault is taken for one that cannot be had here."""


def tried(ground: Ground, trial: Trial, count: int, chance: random.Random) -> tuple[Counter[str], list[str]]:
    """What happened how often, and what was lost, in so many trials in which the fault struck."""
    happened: Counter[str] = Counter()
    losses, missed = [], 0
    while happened.total() < count and missed < MOST_MISSES * count:
        outcome = trial(ground, chance)
        if outcome.struck or outcome.lost:
            happened[outcome.what] += 1
        else:
            missed += 1
        if outcome.lost:
            losses.append(f"{outcome.what}: {outcome.lost}")
            print(f"    LOST: {losses[-1]}", flush=True)
    return happened, losses


def main() -> None:
    """Runs and prints counts."""
    words = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else None)
    words.add_argument("--share", type=float, default=1.0, help="of the number of trials")
    words.add_argument("--only", default="", help="kinds whose name has this word")
    words.add_argument("--seed", type=int, default=1)
    words.add_argument("--json", type=Path, help="a file for the counts")
    asked = words.parse_args()
    kinds: dict[str, tuple[int, Trial]] = {
        **TRIALS,
        "kill -9 of a long run as it is": (6, lambda ground, chance: killed(ground, chance, (AS_IT_IS,))),
    }
    found: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as folder:
        os.environ["GEOCOSSERAT_CACHE"] = str(Path(folder) / "cache")
        # kernels are compiled in a third of the time, and are the same for all runs
        compiling.FLAGS = tuple("-O1" if flag == "-O3" else flag for flag in compiling.FLAGS)  # type: ignore[assignment]
        ground = Ground(Path(folder))
        print("| fault | trials | lost | what happened | seconds |\n|---|---|---|---|---|", flush=True)
        for name, (count, trial) in kinds.items():
            if asked.only not in name:
                continue
            begun, many = time.monotonic(), max(1, round(asked.share * count))
            happened, losses = tried(ground, trial, many, random.Random(f"{asked.seed} {name}"))
            seconds = time.monotonic() - begun
            shown = ", ".join(f"{what}: {number}" for what, number in happened.most_common())
            print(f"| {name} | {happened.total()} | {len(losses)} | {shown} | {seconds:.0f} |", flush=True)
            found[name] = {"trials": happened.total(), "lost": len(losses), "happened": happened, "losses": losses}
    lost = sum(kind["lost"] for kind in found.values())
    print(f"{sum(kind['trials'] for kind in found.values())} trials, {lost} losses")
    if asked.json:
        asked.json.write_text(json.dumps(found, indent=2) + "\n")
    if lost:
        sys.exit(1)


if __name__ == "__main__":
    main()
