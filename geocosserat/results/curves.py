"""Smooth curves through the values of a solution, and the moments worth drawing."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from geocosserat.results.solution import Solution

Array = NDArray[np.float64]


def smooth(solution: Solution, values: Array, pieces: int = 200) -> tuple[Array, Array]:
    """Fields at many places: the polynomial that the scheme means in each element, not chords of its nodes.

    values is (T, N, c), at the nodes, or (T, Q, c), at the Gauss points. Returns places (M,), lengths along
    the rod at rest, and values (T, M, c), with M about `pieces`; each element gives its own value at a common
    boundary, so a field of the Gauss points keeps its jumps.
    """
    n, p = solution.elements, solution.degree
    at_nodes = values.shape[1] == n * p + 1
    coordinates = solution.u if at_nodes else solution.u_point
    count = p + 1 if at_nodes else p
    index = np.arange(n)[:, None] * p + np.arange(count)
    left, right = solution.u[:-1:p], solution.u[p::p]
    # all elements are alike on [-1, 1], so one matrix serves: values -> Legendre coefficients -> fine values
    known = (2 * coordinates[index[0]] - left[0] - right[0]) / (right[0] - left[0])
    fine = np.linspace(-1.0, 1.0, max(2, round(pieces / n) + 1))
    matrix = legendre.legvander(fine, count - 1) @ np.linalg.inv(legendre.legvander(known, count - 1))
    places = left[:, None] + (right - left)[:, None] * (fine + 1) / 2
    drawn = np.einsum("fk,tnkc->tnfc", matrix, values[:, index])
    return places.ravel(), drawn.reshape(len(values), -1, values.shape[2])


def way(solution: Solution) -> Array:
    """Distance travelled until each frame, (T,), a length: root mean square over the nodes, added up.

    Steps to or from a position that is not finite count as none.
    """
    moved = np.diff(solution.position, axis=0)
    steps = np.sqrt(np.mean(np.sum(moved**2, axis=2), axis=1))
    return np.concatenate(([0.0], np.cumsum(np.where(np.isfinite(steps), steps, 0.0))))


def moments(solution: Solution, count: int) -> NDArray[np.intp]:
    """Indices of at most `count` frames, first and last among them, about even along the way travelled.

    Evenly spaced in time, the shapes of a rod that relaxes would lie on top of each other at its end.
    """
    travelled, last = way(solution), len(solution.time) - 1
    spacing = travelled[-1] / max(count - 1, 1)
    chosen = [0]
    for frame in range(1, last + 1):
        if travelled[frame] - travelled[chosen[-1]] >= spacing * (1 - 1e-9) and spacing > 0:
            chosen.append(frame)
    if chosen[-1] != last:
        # the last shape is always shown: instead of its neighbour when that is close, or one too many
        close = travelled[last] - travelled[chosen[-1]] < spacing / 2 or len(chosen) == count
        chosen = [*(chosen[:-1] if close and len(chosen) > 1 else chosen), last]
    return np.array(chosen, dtype=np.intp)
