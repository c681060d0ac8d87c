"""Time to an accuracy of the relaxing rods, all solvers side by side.

Each setting is a grid and a tolerance. Grids: cells from 8 on, each about 1.4 times the last; for us 1 or 2
elements of degree 3 to 20. Tolerances: half decades from 0.1 on, absolute and relative alike (all unknowns are of
the order of one), so that no solver is held to a tolerance it does not need. Solvers (a) and (b) are measured to
1e-6 and solver (e) to 1e-3, from where their cost is extrapolated in their favour: cells grow as the second order
wants it and the number of steps stays, or (for (e), of first order in time) steps grow and elements stay.
"""

from collections.abc import Sequence
from functools import partial

import numpy as np

from benchmarks.peers import by_hand, lines, ours
from benchmarks.peers.problems import PROBLEMS, Problem
from benchmarks.peers.search import Found, Setting, Solver, extrapolated

try:
    from benchmarks.peers import compiled_lines
except ImportError:
    compiled_lines = None  # type: ignore[assignment]
try:
    from benchmarks.peers import multibody
except ImportError:
    multibody = None  # type: ignore[assignment]

Row = dict[float, Found | None] | str
TARGETS = (1e-3, 1e-6, 1e-9)
OURS, NUMPY, NUMBA, HAND = "geocosserat", "(a) numpy, scipy", "(b) numba, CVODE", "(d) C by hand, RODAS4"
EXUDYN = "(e) Exudyn, massless with dashpots"
LIMITS = {NUMPY: (-6, 2.0), NUMBA: (-6, 2.0), EXUDYN: (-3, 1.0)}
"""Decades of the least error that is measured, and the order from which the cost of less follows."""

MISSING = "not measured: {} is not installed"
IMPOSSIBLE = "not possible: its dashpots do not turn with the rod"
DEGREES = (*range(3, 13), 14, 16, 18, 20)
LOOSEST = 30.0
STEPS = tuple(25 * 2**k for k in range(9))
RTOLS = tuple(round(10 ** (-k / 2), 14) for k in range(2, 27))


def cells(most: int) -> list[Setting]:
    """Even numbers of cells from 8 on, growing by about the square root of two."""
    return [(n,) for k in range(40) if (n := 2 * round(4 * 2 ** (k / 2))) <= most]


def solvers(problem: Problem) -> dict[str, Solver | str]:
    """All of them, by name; why one is missing, if it is."""
    mine: list[Sequence[Setting]] = [
        [(elements, p, method) for p in DEGREES] for elements in (1, 2) for method in ("radau", "cvode")
    ]
    scipys: list[Sequence[Setting]] = [[(*n, method) for n in cells(1500)] for method in lines.METHODS]
    found: dict[str, Solver | str] = {
        OURS: Solver(partial(ours.solve, problem), mine, RTOLS, LOOSEST),
        NUMPY: Solver(partial(lines.solve, problem), scipys, RTOLS[:16], LOOSEST),
        NUMBA: MISSING.format("numba"),
        HAND: Solver(partial(by_hand.solve, problem), [cells(30_000)], RTOLS, LOOSEST),
        EXUDYN: MISSING.format("exudyn") if problem.motion == "planar" else IMPOSSIBLE,
    }
    if compiled_lines:
        theirs = [[(*n, jacobians) for n in cells(1500)] for jacobians in compiled_lines.JACOBIANS]
        found[NUMBA] = Solver(partial(compiled_lines.solve, problem), theirs, RTOLS[:16], LOOSEST)
    if multibody and problem.motion == "planar":
        found[EXUDYN] = Solver(partial(multibody.relax, problem), [[(n,) for n in (2, 4, 6, 8, 12)]], STEPS)
    return found


def problems(quick: bool) -> tuple[Problem, ...]:
    """Those that are measured."""
    return PROBLEMS[1:2] if quick else PROBLEMS


def targets(quick: bool) -> tuple[float, ...]:
    """The errors asked for."""
    return TARGETS[:2] if quick else TARGETS


def measure(problem: Problem, quick: bool) -> dict[str, Row]:
    """What each solver needs for each accuracy."""
    repeats, found = 3 if quick else 5, {}
    for name, solver in solvers(problem).items():
        found[name] = solver if isinstance(solver, str) else _row(name, solver, targets(quick), repeats)
    return found


def _row(name: str, solver: Solver, wanted: Sequence[float], repeats: int) -> dict[float, Found | None]:
    row: dict[float, Found | None] = {}
    least, order = LIMITS.get(name, (-99, 1.0))
    for target in wanted:
        decades = least - round(np.log10(target))
        found = solver.cheapest(max(target, 10.0**least), repeats)
        row[target] = extrapolated(found, decades, order) if found and decades > 0 else found
    return row
