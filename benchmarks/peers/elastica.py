"""Solver (c): PyElastica, an explicit dynamic solver, on the cantilever of `statics`.

Its static states are found by damped motion. All that may be chosen is chosen in its favour: the fewest elements,
density such that a length of the bar weighs 1 (only the ratio of the step to the slowest period matters),
`AnalyticalLinearDamper` near critical damping of the slowest mode (the best of several), the longest stable step,
the load at once, and a run that stops exactly when the tip is there to stay, which a user could not know.
Compilation by numba is not timed.

Its clamp holds the first element rigid, so the bar begins to bend half an element too late and the error is of
first order. "as documented" is that; for "half an element more" the bar is longer, and its clamped element sticks
out to the left, so that its middle is where the bar begins: of second order, but not what the documentation tells
one to do.
"""

import time
from collections.abc import Sequence
from itertools import product
from typing import Any

import elastica as ea
import numpy as np

from benchmarks.peers.statics import LOAD, RADIUS, STIFFNESS, tip
from geocosserat.discretisation.mesh import Array

SLOWEST = 3.516
"""Angular frequency of the slowest mode of a straight cantilever."""

DAMPINGS, SHARES = (1.4, 1.7, 2.0), (0.98, 0.9)
"""Rates of damping, times the slowest frequency; steps, times the bound of stability."""

CAREFUL = 0.7
"""Step of runs that are only extrapolated: at 0.9 one of 961 elements blew up late."""

COARSE, SAMPLE, LOOK, PATIENCE = 24, 300, 20, 4.0
"""Elements, and steps, that extrapolations start from; steps between looks at the tip; time until 1e-3 is reached."""


class _Simulator(ea.BaseSystemCollection, ea.Constraints, ea.Forcing, ea.Damping):
    pass


class _TipForce(ea.NoForces):
    def apply_forces(self, system: Any, time: float = 0.0) -> None:
        system.external_forces[1, -1] -= LOAD


def _built(elements: int, step: float, damping: float, shifted: bool) -> tuple[Any, Any]:
    """The simulator and its rod. shifted: with half an element more."""
    length = 1.0 * elements / (elements - 0.5) if shifted else 1.0
    area, inertia = np.pi * RADIUS**2, np.pi * RADIUS**4 / 4
    rod = ea.CosseratRod.straight_rod(
        elements,
        np.array([1.0 - length, 0.0, 0.0]),
        np.array([1.0, 0.0, 0.0]),
        np.array([0.0, 0.0, 1.0]),
        length,
        RADIUS,
        1.0 / area,
        youngs_modulus=1.0 / inertia,
    )
    simulator = _Simulator()
    simulator.append(rod)
    simulator.constrain(rod).using(ea.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,))
    simulator.add_forcing_to(rod).using(_TipForce)
    simulator.dampen(rod).using(ea.AnalyticalLinearDamper, uniform_damping_constant=damping, time_step=step)
    simulator.finalize()
    return simulator, rod


def longest_step(elements: int) -> float:
    """Bound of the explicit step by its stretching waves and its shearing oscillations."""
    rotation = np.sqrt(RADIUS**2 / 4 / STIFFNESS[1])  # one over the frequency of shear against rotary inertia
    return 1.0 / np.sqrt(STIFFNESS[0] * elements**2 + 0.25 / rotation**2)


def _run(elements: int, shifted: bool, damping: float, step: float, steps: int, look: int) -> tuple[Array, float]:
    """The tip (looks, 2) each `look` steps, and seconds."""
    simulator, rod = _built(elements, step, damping * SLOWEST, shifted)
    stepper, now, tips = ea.PositionVerlet(), np.float64(0.0), []
    begin = time.perf_counter()
    for i in range(1, steps + 1):
        now = stepper.step(simulator, now, np.float64(step))
        if i % look == 0:
            tips.append(rod.position_collection[:2, -1].copy())
    return np.array(tips), time.perf_counter() - begin


def arrival(tips: Array, where: Array, target: float) -> int | None:
    """Looks until the tip stays within a distance of where it belongs, None if it is not there to stay."""
    outside = np.flatnonzero(~(np.linalg.norm(tips - where, axis=1) <= target))
    looks = int(outside[-1]) + 2 if len(outside) else 1
    return None if looks > len(tips) else looks


def _motion(elements: int, shifted: bool, damping: float, share: float, target: float) -> Array:
    """The tip over a time in which it settles to that accuracy."""
    step = share * longest_step(elements)
    steps = int(PATIENCE * np.log10(1 / target) / 3 / step)
    return _run(elements, shifted, damping, step, steps, LOOK)[0]


def measured(target: float, elements: Sequence[int], repeats: int) -> tuple[list[float], float, tuple[float, ...]]:
    """Seconds of runs to an accuracy with half an element more, their error, and elements, damping, share, steps."""
    _run(4, False, 1.0, 1e-5, 2, 2)  # numba compiles
    found = []
    for n, damping, share in product(elements, DAMPINGS, SHARES):
        looks = arrival(_motion(n, True, damping, share, target), tip(), target)
        if looks is not None:
            found.append((looks, n, damping, share))
    looks, n, damping, share = min(found)
    runs = [_run(n, True, damping, share * longest_step(n), LOOK * looks, LOOK * looks) for _ in range(repeats)]
    error = float(np.linalg.norm(runs[0][0][-1] - tip()))
    return [run[1] for run in runs], error, (n, damping, share, LOOK * looks)


def estimated(target: float, shifted: bool) -> tuple[float, tuple[float, ...]]:
    """Seconds to an accuracy that takes too long to measure, and elements, damping, share, steps.

    Elements from the error of a coarse bar and its order, seven tenths of the error for them; the time of the motion
    from that of the coarse bar to its own rest, within the other three; seconds of a step from some of the fine bar.
    """
    best = None
    for damping in DAMPINGS:
        tips = _motion(COARSE, shifted, damping, CAREFUL, 0.1 * target)
        looks = arrival(tips, tips[-1], 0.3 * target)
        if looks is not None and (best is None or looks < best[0]):
            best = looks, damping, float(np.linalg.norm(tips[-1] - tip()))
    assert best is not None
    looks, damping, error = best
    n = int(np.ceil(COARSE * (error / (0.7 * target)) ** (0.5 if shifted else 1.0)))
    step = CAREFUL * longest_step(n)
    steps = int(LOOK * looks * longest_step(COARSE) / longest_step(n))
    _run(4, False, 1.0, 1e-5, 2, 2)
    seconds = min(_run(n, shifted, damping, step, SAMPLE, SAMPLE)[1] for _ in range(3)) / SAMPLE * steps
    return seconds, (n, damping, CAREFUL, steps)
