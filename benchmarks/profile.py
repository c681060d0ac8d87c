"""Where the time of short runs goes: python -m benchmarks.profile. Needs perf, of Linux.

The relaxing rods of benchmarks/peers and the heavy rods of benchmarks/pruning, at settings that reach the errors named,
one after the other and over and over, while perf looks five thousand times a second where the program is. Functions
that are called from one place only are kept apart for that, which costs little. What is left of all is Python and what
it calls.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.peers.problems import PROBLEMS, UNTIL, rod_of
from benchmarks.pruning import heavy
from geocosserat.conductor.kernels import kernel_text
from geocosserat.conductor.simulate import tolerances
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.compile import compiler
from geocosserat.kernel.load import load
from geocosserat.solver.integrate import integrate
from geocosserat.solver.trajectory import Trajectory

ROOT = Path(__file__).parent.parent
APART = "-fno-inline-functions-called-once"
QUIET, LOOKED = 2.0, 6.0
"""Seconds of the program until perf begins, when all is loaded and warm; and while it looks."""

PARTS = {
    "rates": (
        "rod_rate rod_rate_lanes drive_lanes stresses stresses_lanes gather_lanes move move_lanes strain_rates "
        "strain_rates_lanes orient orient_lanes circle march_element_lanes solve_turns_lanes take_rows_lanes "
        "multiply_lanes evaluate evaluate_stages problem_slopes"
    ),
    "Jacobians": (
        "rod_blocks rod_dense problem_dense responses world_responses answers drive march_element solve_turns "
        "take_rows differentiate_march add_product subtract factor_dense "
        "linearise __memset_avx512_unaligned_erms __memset_avx2_unaligned_erms"
    ),
    "reductions": "condense reduce factor_bound factor solve multiply",
    "linear solves": "solve_shifted untwist twist solve_all add_stages",
    "Newton and steps": (
        "solve_stages newton shift step error_of predict squares accept radau_go radau_start radau_new advance"
    ),
}
"""Functions in C, by what they are for. Of an inlined one the time is that of its caller."""
REST = "Python and system"



def _relaxing(number: int, elements: int, degree: int, rtol: float) -> Callable[[], Trajectory]:
    rod, kernel = rod_of(PROBLEMS[number], elements, degree)
    times = np.array([0.0, UNTIL])
    return lambda: integrate(kernel, rod.state, times, "radau", rtol, rtol)


def _heavy(name: str, degree: int, rtol: float) -> Callable[[], Trajectory]:
    scene = dict(heavy())[name]
    rod = discretise(scene, 1, degree)
    kernel = load(kernel_text(rod.structure), rod, "c")
    times, atol = np.array([0.0, scene.run.until]), tolerances(rod, rtol, None, 1.0)
    return lambda: integrate(kernel, rod.state, times, "radau", rtol, atol)


RUNS: dict[str, Callable[[], Callable[[], Trajectory]]] = {
    "planar, k = 1e4, to 1e-3": lambda: _relaxing(1, 1, 4, 0.1),
    "planar, k = 1e4, to 1e-6": lambda: _relaxing(1, 2, 4, 1e-2),
    "planar, k = 1e4, to 1e-9": lambda: _relaxing(1, 2, 8, 1e-4),
    "spatial, k = 1e4, to 1e-6": lambda: _relaxing(3, 1, 7, 3e-3),
    "heavy, planar, inextensible and unshearable, to 1e-6": lambda: _heavy(
        "planar, inextensible and unshearable", 9, 1e-2
    ),
    "heavy, spatial Cosserat, to 1e-6": lambda: _heavy("spatial Cosserat", 9, 1e-2),
}


def loop(name: str, seconds: float) -> None:
    """In a process of its own: runs for so long, but once at least; prints microseconds of a run (the least) and its
    counts."""
    run = RUNS[name]()
    begin, least = time.perf_counter(), float("inf")
    while True:
        at = time.perf_counter()
        found = run()
        now = time.perf_counter()
        least = min(least, now - at)
        if now > begin + seconds:
            break
    print(f"{1e6 * least:.1f} | {found.steps} | {found.rates} | {found.jacobians}")


def shares(report: str) -> dict[str, float]:
    """Of all samples, those in each part, from perf's lines: percent, symbol."""
    found = dict.fromkeys((*PARTS, REST), 0.0)
    of = {function: part for part, functions in PARTS.items() for function in functions.split()}
    for percent, symbol in re.findall(r"^\s*([\d.]+)%\s+\[[.k]\]\s+([\w@]+)", report, re.MULTILINE):
        found[of.get(symbol, REST)] += float(percent)
    return found


def profile(name: str) -> str:
    """A row of the table."""
    with tempfile.TemporaryDirectory() as folder:
        data = str(Path(folder) / "perf.data")
        used = {**os.environ, "CC": f"{compiler()} {APART}", "PYTHONPATH": str(ROOT), "OPENBLAS_NUM_THREADS": "1"}
        program = [sys.executable, "-m", "benchmarks.profile", name]
        subprocess.run([*program, "0"], cwd=ROOT, env=used, check=True, capture_output=True)  # compiles
        look = ["perf", "record", "-o", data, "-F", "5000", "-e", "cpu-clock", "-D", str(int(1e3 * QUIET)), *program]
        look.append(str(QUIET + LOOKED))
        done = subprocess.run(look, cwd=ROOT, env=used, check=True, capture_output=True, text=True)
        read = ["perf", "report", "-i", data, "--stdio", "--sort", "symbol"]
        report = subprocess.run(read, check=True, capture_output=True, text=True).stdout
    parts = shares(report)
    cells = " | ".join(f"{100 * share / sum(parts.values()):.0f}" for share in parts.values())
    return f"| {name} | {done.stdout.splitlines()[0]} | {cells} |"


def table() -> str:
    """Markdown."""
    if shutil.which("perf") is None or compiler() is None:
        return "Not measured: expected perf and a C compiler on the path.\n"
    head = f"| run | us | steps | rates | Jacobians | {' | '.join(f'{part}, %' for part in (*PARTS, REST))} |"
    return "\n".join([head, "|---" * (6 + len(PARTS)) + "|", *(profile(name) for name in RUNS)]) + "\n"


if __name__ == "__main__":
    if len(sys.argv) > 1:
        loop(sys.argv[1], float(sys.argv[2]))
    else:
        print(table())
