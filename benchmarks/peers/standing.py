"""Time to the static state of the cantilever, solvers side by side: see statics, elastica, multibody, ours.

This project finds it by a motion that goes on until nothing moves (it is overdamped, so steps grow without bound);
Exudyn by Newton's method on the static equations; PyElastica by a damped motion with inertia. What takes PyElastica
minutes is estimated from shorter runs, and marked so.
"""

from itertools import product

import numpy as np

from benchmarks.peers import ours
from benchmarks.peers.motion import RTOLS
from benchmarks.peers.search import Found, Solver
from benchmarks.peers.statics import TARGETS

try:
    from benchmarks.peers import elastica
except ImportError:
    elastica = None  # type: ignore[assignment]
try:
    from benchmarks.peers import multibody
except ImportError:
    multibody = None  # type: ignore[assignment]

NO_ELASTICA, NO_EXUDYN = (f"not measured: {name} is not installed" for name in ("pyelastica", "exudyn"))
Row = dict[float, Found | None] | str
OURS, EXUDYN = "geocosserat, motion until it is static", "(e) Exudyn, static solver"
DOCUMENTED, SHIFTED = "(c) PyElastica, clamp as documented", "(c) PyElastica, half an element more"
FEW = (12, 14, 17, 20)
"""Elements of PyElastica's bar, half an element longer, of which one reaches 1e-3."""


def _mine() -> Solver:
    families = [
        [(degree, method, until) for degree in (2, 3, 4, 5, 6, 7, 8, 10)]
        for method, until in product(("radau", "cvode"), (0.6, 1.0, 1.6, 2.5))
    ]
    return Solver(ours.settle, families, RTOLS)


def _exudyn(elements: int, nodes: int, steps: int, _: float) -> tuple[float, float, int]:
    return multibody.settle(elements, nodes, steps)


def _exudyn_row(repeats: int) -> dict[float, Found | None]:
    counts = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 256)
    families = [[(n, nodes, steps) for n in counts] for nodes, steps in product((2, 3), (1, 2, 3, 5))]
    solver = Solver(_exudyn, families, [0.0])  # its own tolerance
    return {target: solver.cheapest(target, repeats) for target in TARGETS}


def _elastica_rows(quick: bool, repeats: int) -> dict[str, Row]:
    if elastica is None:
        return {DOCUMENTED: NO_ELASTICA, SHIFTED: NO_ELASTICA}
    seconds, error, how = elastica.measured(TARGETS[0], FEW[2:3] if quick else FEW, repeats)
    shifted: dict[float, Found | None] = {TARGETS[0]: Found(error, min(seconds), float(np.median(seconds)), how)}
    documented: dict[float, Found | None] = {}
    wanted = [(documented, TARGETS[0], False)]
    wanted += [] if quick else [(shifted, TARGETS[1], True)]  # as documented it would take a million elements
    for row, target, more in wanted:
        about, how = elastica.estimated(target, more)
        row[target] = Found(target, about, about, how, True)
    return {DOCUMENTED: documented, SHIFTED: shifted}


def measure(quick: bool) -> dict[str, Row]:
    """Seconds of each solver to each accuracy."""
    repeats = 3 if quick else 5
    mine = _mine()
    rows: dict[str, Row] = {OURS: {target: mine.cheapest(target, repeats) for target in TARGETS}}
    rows[EXUDYN] = _exudyn_row(repeats) if multibody else NO_EXUDYN
    return rows | _elastica_rows(quick, repeats)
