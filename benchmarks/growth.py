"""How time and memory of a run grow with the number of elements: python -m benchmarks.growth [--most N].

The relaxing rod of benchmarks/pruning.py, in its plane and in space, as `geocosserat.run` does it by default
(CVODE, all frames kept, no files) but for a degree of 4 and a tolerance of 1e-4, on 10 to 10 000 elements. The
motion is the same and so is the tolerance, so the number of steps hardly changes. Each run has a process of its
own, whose peak of memory is its own; that of an empty one, which has only imported everything, is taken off. A rod
of one element in each process comes first, so that what is opened once is not timed. Exponents are fitted to all
sizes from 100 elements on: below, what a run costs however small it is counts for more. `--most` goes further by
tens; where a run ends for want of memory, that is said, and the largest that fits this machine is estimated from
the slope in any case.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parent.parent
SIZES = (10, 30, 100, 300, 1000, 3000, 10_000)
FROM = (100, 1000)
FITTED = {"seconds": "time", "solve": "integration", "step": "a step", "more": "memory"}
DEGREE, RTOL = 4, 1e-4
BEND = "3*(1 - u)**2*(1 + 2*u)"
RODS: dict[str, dict[str, Any]] = {
    "planar": {"stiffness": [1e4, 1e4, 1.0], "friction": [1.0, 1.0, 0.01]},
    "spatial": {"stiffness": [1e4, 1e4, 1e4, 1.0, 1.0, 1.0], "friction": [1.0, 1.0, 1.0, 0.01, 0.01, 0.01]},
}
START = {"planar": ["1", "0", BEND], "spatial": ["1", "0", "0", BEND, "0", BEND]}
EMPTY, WARM = 0, 1


def scene(motion: str, elements: int) -> dict[str, Any]:
    """The relaxing rod on so many elements."""
    return {
        "rod": {"motion": motion, "length": 1.0, **RODS[motion]},
        "start": {"strain": START[motion]},
        "run": {"until": 0.05, "elements": elements, "degree": DEGREE, "rtol": RTOL},
    }


def one(motion: str, elements: int) -> dict[str, float]:
    """A run in this process: seconds of all and of the integration, steps, unknowns, and peak of memory in MiB."""
    import geocosserat

    found = {"seconds": 0.0, "solve": 0.0, "steps": 1.0, "unknowns": 0.0}
    if elements != EMPTY:
        geocosserat.run(scene(motion, 1))  # what is opened and imported once is no part of what grows
        begin = time.perf_counter()
        run = geocosserat.run(scene(motion, elements))
        found["seconds"] = time.perf_counter() - begin
        found |= {"solve": run.seconds["solve"], "steps": run.evaluations["steps"], "unknowns": run.unknowns}
    return {**found, "memory": peak()}


def peak() -> float:
    """The most memory that this process had, in MiB. On Linux from its own file: what is said of usage may be that of
    the process that started it."""
    try:
        line = next(line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("VmHWM"))
        return int(line.split()[1]) / 2**10
    except (OSError, StopIteration):
        most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        return most / (2**20 if sys.platform == "darwin" else 2**10)


def _apart(motion: str, elements: int) -> dict[str, float] | None:
    """A run in a process of its own; None if it did not end well."""
    words = [sys.executable, "-m", "benchmarks.growth", "--one", motion, str(elements)]
    done = subprocess.run(words, cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)}, capture_output=True, text=True)
    if done.returncode:
        return None
    found: dict[str, float] = json.loads(done.stdout)
    return found


def exponent(sizes: list[int], values: list[float], least: int) -> float:
    """Of the power law through values over sizes, those from `least` on."""
    kept = [(n, v) for n, v in zip(sizes, values, strict=True) if n >= least and v > 0]
    return float(np.polyfit(*np.log(np.array(kept)).T, 1)[0]) if len(kept) > 1 else float("nan")


def room() -> float:
    """Memory of this machine, in MiB."""
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**20


def table(motion: str, sizes: tuple[int, ...] = SIZES) -> str:
    """Markdown: one row a size, then exponents and the largest run."""
    _apart(motion, WARM)
    empty = _apart(motion, EMPTY)
    if empty is None:
        raise SystemExit("expected an empty process to end well")
    lines = [
        f"{motion}, degree {DEGREE}, rtol {RTOL:.0e}",
        "",
        "| elements | unknowns | seconds | of these integration | steps | us a step | ns a step, unknown | MiB more |",
        "|---" * 8 + "|",
    ]
    reached: list[int] = []
    runs: list[dict[str, float]] = []
    for n in sizes:
        run = _apart(motion, n)
        if run is None:
            lines.append(f"| {n} | did not end |")
            break
        reached.append(n)
        runs.append({**run, "more": run["memory"] - empty["memory"], "step": run["solve"] / run["steps"]})
        last = runs[-1]
        cells = [n, int(last["unknowns"]), f"{last['seconds']:.3g}", f"{last['solve']:.3g}", int(last["steps"])]
        cells += [f"{1e6 * last['step']:.3g}", f"{1e9 * last['step'] / last['unknowns']:.3g}", f"{last['more']:.3g}"]
        lines.append(f"| {' | '.join(map(str, cells))} |")
    powers = [[exponent(reached, [run[key] for run in runs], n) for key in FITTED] for n in FROM]
    said = ", ".join(
        f"from {n} on {' and '.join(f'{name} as {p:.2f}' for name, p in zip(FITTED.values(), row, strict=True))}"
        for n, row in zip(FROM, powers, strict=True)
    )
    each = (runs[-1]["more"] - runs[-2]["more"]) / (reached[-1] - reached[-2])
    most = (room() - runs[-1]["memory"]) / each + reached[-1]
    lines += [
        "",
        f"Power of the elements, {said}. Memory grows by {1024 * each:.0f} KiB an element: with "
        f"{room() / 1024:.0f} GiB about {most:.1g} elements fit.",
    ]
    return "\n".join(lines) + "\n"


def tables(most: int = SIZES[-1]) -> str:
    """Both motions, in Markdown."""
    more = tuple(10**k for k in range(5, 10) if SIZES[-1] < 10**k <= most)
    return "\n".join(table(motion, SIZES + more) for motion in RODS)


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.growth", description="Cost against elements.")
    parser.add_argument("--most", type=int, default=SIZES[-1], help="elements of the largest run")
    parser.add_argument("--one", nargs=2, metavar=("MOTION", "ELEMENTS"), help="a single run, as JSON")
    words = parser.parse_args()
    if words.one:
        print(json.dumps(one(words.one[0], int(words.one[1]))))
    else:
        print(tables(words.most))


if __name__ == "__main__":
    main()
