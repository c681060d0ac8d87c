"""An integration in legs, so that one that was interrupted comes to the same end bit for bit.

Integrators carry a history from step to step which no file keeps. So each begins anew now and then, at an instant of
output and whether it is interrupted or not: what follows is a function of the state at that instant alone.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from geocosserat.kernel.contract import Array
from geocosserat.solver.settings import LONGEST, SINGULAR, STEP_LIMIT
from geocosserat.solver.trajectory import Frame, Trajectory

LONGEST_LEG, SHORTEST_LEG, NUMBERS = 20_000, 1_000, 10_000_000
"""Steps of a leg, of small rods and of the largest, and numbers that are computed in it between those: seconds of work,
of which a new beginning is some hundredths at most. No clock says when it ends: the result would depend on it."""

Leg = Callable[[Trajectory, Array, Frame], Trajectory]
"""what there is, from whose last state to go on, times to come, frame -> trajectory"""


def enough(size: int) -> int:
    """Steps after which a leg ends at the next instant of output."""
    return max(SHORTEST_LEG, min(LONGEST_LEG, NUMBERS // size))


def in_legs(leg: Leg, done: Trajectory, times: Array, kept: Callable[[Trajectory], None]) -> Trajectory:
    """Goes on from the last state of what is `done`, which ended a leg or is the start, through all of `times` (T,).

    kept: is told what there is after each leg. Where one does not come to its end, its reason is that of the whole.
    """
    count, size = done.states.shape
    states = np.empty((len(times), size))
    states[:count] = done.states
    total, most = done, enough(size)
    while count < len(times) and not total.reason:
        found = leg(total, times[count - 1 :], lambda _, __, steps: steps >= most)
        first = 0 if count == 1 else 1  # the start need not hold the constraints, and begins to with the first leg
        states[count - 1 + first : count - 1 + len(found.states)] = found.states[first:]
        before, count = total, count - 1 + len(found.states)
        total = Trajectory(
            times=times[:count].copy(),
            states=states[:count],
            rates=before.rates + found.rates,
            jacobians=before.jacobians + found.jacobians,
            steps=before.steps + found.steps,
            reached=found.reached,
            reason=found.reason,
        )
        if not total.reached and not total.reason and never_ends(before, total, float(times[-1])):
            why = f"stopped at t = {total.times[-1]:.6g}: {total.steps} steps did not reach the end; {SINGULAR}"
            total = replace(total, reason=why)
        if not total.reason:
            kept(total)
    return total


def never_ends(before: Trajectory, now: Trajectory, end: float) -> bool:
    """Whether at the pace of the last leg the rest takes more steps than the longest run may."""
    made, left = float(now.times[-1] - before.times[-1]), end - float(now.times[-1])
    return now.steps >= STEP_LIMIT and left * (now.steps - before.steps) > LONGEST * made
