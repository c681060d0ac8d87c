"""Integration from one switch of the right-hand side to the next.

A step that reaches over a jump of the rate sees only one side of it, and at rest steps grow so long that a pulse is not
seen at all. Each smooth piece is therefore integrated by itself.
"""

from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from geocosserat.kernel.contract import Array
from geocosserat.solver.trajectory import Frame, Progress, Trajectory

HAIR = 1e-13
"""Of the whole time: how far from a switch a piece ends and the next one begins, so that each sees its own side."""

Piece = Callable[[Array, Array, Progress, Frame], Trajectory]
"""start, times, progress, frame -> trajectory"""


def in_pieces(
    piece: Piece, start: Array, times: Array, switches: Sequence[float], progress: Progress, frame: Frame
) -> Trajectory:
    """Integrates from times[0] through all of `times`, anew from each of the `switches` between."""
    if not switches:
        return piece(start, times, progress, frame)
    first, last = float(times[0]), float(times[-1])
    hair = HAIR * (last - first)
    between = {t for t in switches if first + 2 * hair < t < last - 2 * hair}
    if not between:
        return piece(start, times, progress, frame)
    edges = [first, *sorted(between), last]
    total = Trajectory(times[:1].copy(), start[None].copy(), 0, 0, 0, True)
    state = start
    for a, b in pairwise(edges):
        wanted = np.flatnonzero((times > a + hair) & (times < b - hair))
        ends = np.array([a + (hair if a > first else 0.0), b - (hair if b < last else 0.0)])
        told = partial(_tell_share, progress, ((a - first) / (last - first), (b - a) / (last - first)), total.steps)
        noted = partial(_note_wanted, frame, wanted, total.steps)
        found = piece(state, np.concatenate([ends[:1], times[wanted], ends[1:]]), told, noted)
        state = found.states[-1]
        states = found.states[1 : 1 + len(wanted)]
        count = len(total.times) + len(states)
        if found.reached and count < len(times) and abs(times[count] - b) <= hair:
            states = np.concatenate([states, state[None]])  # an instant of output on the switch, or the end
            # no pause on a switch: from there one would see its other side
            frame(count, state, total.steps + found.steps)
            count += 1
        total = Trajectory(
            times=times[:count].copy(),
            states=np.concatenate([total.states, states]),
            rates=total.rates + found.rates,
            jacobians=total.jacobians + found.jacobians,
            steps=total.steps + found.steps,
            reached=found.reached,
            reason=found.reason,
        )
        if not found.reached:
            break
    return total


def _tell_share(progress: Progress, share: tuple[float, float], before: int, fraction: float, steps: int) -> None:
    """Progress of one piece as progress of the whole."""
    progress(share[0] + share[1] * fraction, before + steps)


def _note_wanted(frame: Frame, wanted: NDArray[np.intp], before: int, i: int, y: Array, steps: int) -> bool:
    """An instant of a piece as one of the whole; its end is told by the whole."""
    return i <= len(wanted) and frame(int(wanted[i - 1]), y, before + steps)
