"""The course of a driven end: its pose at any time, which follows from its twist alone.

phi_dot = phi V(t) knows of no state, so it is solved ahead of the integration, once, and to round-off: were it
integrated along with the rod, the errors of its steps would add up. Time is cut into cells on which the pose is a
polynomial. They end where the twist switches, and are halved until their polynomials have converged. In the plane the
angle is unwrapped; in space a quaternion turns any number of times.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from geocosserat.discretisation.cells import POINTS, POWERS, Array, Twist, solved
from geocosserat.discretisation.quaternions import of_rotation, of_unit_norm, product, turn
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import Expression, evaluate, switch_times
from geocosserat.model.features import leaves, pulses

CELLS = 64
"""Cells to begin with: what lasts less than a thousandth of the whole time may be overlooked, if it does not switch."""

BATCH = 2**10
"""Cells that are solved at once: their arrays stay in the cache."""

MOST_CELLS = 2**19
"""Half a GiB of coefficients."""


@dataclass(frozen=True, eq=False)
class Course:
    """Poses relative to the start: position in its frame (lengths), then an angle, or a unit quaternion.

    edges (cells + 1,): instants. powers (cells, POINTS + 1, 3 or 7): coefficients of the powers of the place in the
    cell, which goes from -1 to 1; the highest first.
    """

    edges: Array
    powers: Array

    def at(self, times: Array | float) -> Array:
        """The pose (..., 3 or 7) at times (...); there is none before the first edge and after the last."""
        t = np.asarray(times, dtype=float)
        cell = np.clip(np.searchsorted(self.edges, t, side="right") - 1, 0, len(self.powers) - 1)
        a, b = self.edges[cell], self.edges[cell + 1]
        x = (((t - a) - (b - t)) / (b - a))[..., None]
        pose = self.powers[cell, 0]
        for k in range(1, POINTS + 1):
            pose = pose * x + self.powers[cell, k]
        return np.where(np.abs(x) < 1.01, pose, np.nan)

    def placed(self, position: Array, rotation: Array, angle: Array | None = None) -> "Course":
        """The course of an end whose start has this pose, instead of relative to it."""
        turned = [float(angle)] if angle is not None else of_rotation(rotation)
        start = np.concatenate([position, turned])[:, None]
        series = np.moveaxis(self.powers, -1, 0)[..., ::-1]
        return Course(self.edges, np.moveaxis(_moved(start, series)[..., ::-1], 0, -1))

    @property
    def table(self) -> Array:
        """All of it in a row, as kernels take it: how many cells, the edges, the coefficients."""
        return np.concatenate([[float(len(self.powers))], self.edges, self.powers.ravel()])


@lru_cache(maxsize=2)
def course_of(
    twist: tuple[Expression, ...], parameters: tuple[tuple[str, float], ...], until: float, length: float
) -> Course:
    """The course of an end with this twist (3 or 6 expressions of t and parameters) from 0 to `until` (a time).

    length: of the rod, what errors of positions are measured by. Raises InputError as `follow`.
    """
    values = dict(parameters)

    def at(t: Array) -> Array:
        return np.stack([np.broadcast_to(evaluate(e, {**values, "t": t}), t.shape) for e in twist])

    breaks = {t for e in twist for t in switch_times(e, until, values)}
    for e in twist:
        if pulses(e, "t", until, values):
            breaks |= set(leaves(e, "t", until, values))
    return follow(at, until, length, breaks)


def follow(twist: Twist, until: float, length: float, switches: Iterable[float] = ()) -> Course:
    """The course from 0 to `until` of what moves with this twist, which may jump at the `switches`.

    Raises InputError if the twist changes too often to be followed.
    """
    grid = np.union1d(np.linspace(0.0, until, CELLS + 1), np.fromiter(switches, dtype=float))
    with np.errstate(all="ignore"):  # a twist that is not finite makes a pose that is not
        starts, parts = zip(*_converged(twist, grid, length), strict=True)
        start, local = np.concatenate(starts), np.concatenate(parts, axis=1)
        del parts
        order = np.argsort(start)
        begin = _begins(local.sum(axis=-1)[:, order])  # Legendre polynomials are 1 at the end of a cell
        powers = np.empty((len(order), POINTS + 1, len(local)))
        for i in range(0, len(order), BATCH):
            batch = slice(i, i + BATCH)
            powers[batch] = np.moveaxis(_moved(begin[:, batch], local[:, order[batch]]) @ POWERS, 0, -1)
        return Course(np.append(start[order], until), powers)


def _converged(twist: Twist, grid: Array, length: float) -> Iterator[tuple[Array, Array]]:
    """Starts (n,) of cells and Legendre coefficients (3 or 7, n, POINTS + 1) of the pose in them, in any order."""
    a, b, count = grid[:-1], grid[1:], 0
    while len(a):
        if count + len(a) > MOST_CELLS:
            raise InputError(
                f"driven ends that can be followed with {MOST_CELLS} polynomials of degree {POINTS}",
                "one that moves to and fro, or jumps, more often, or without bound",
                "shorten run.until, or let it move more smoothly",
                key="ends",
            )
        coarse = np.ones(len(a), dtype=bool)
        # where one in sixteen shows that all are too coarse, the others need not be solved
        if len(a) <= BATCH or not solved(twist, a[::16], b[::16], length, float(grid[-1]))[1].all():
            for i in range(0, len(a), BATCH):
                batch = slice(i, i + BATCH)
                local, coarse[batch] = solved(twist, a[batch], b[batch], length, float(grid[-1]))
                yield a[batch][~coarse[batch]], local
        count += int(np.sum(~coarse))
        a, b = _halves(a[coarse], b[coarse])


def _halves(a: Array, b: Array) -> tuple[Array, Array]:
    middle = (a + b) / 2
    return np.concatenate([a, middle]), np.concatenate([middle, b])


def _begins(ends: Array) -> Array:
    """Poses (3 or 7, n) at which cells begin, relative to the first, from those at which they end relative to that."""
    space = 2 if len(ends) == 3 else 3
    turned = _added(ends[2:]) if space == 2 else _multiplied(ends[3:])
    there = np.concatenate([np.zeros((space, ends.shape[1])), turned])
    there[:space] = _added(_moved(there, ends[..., None])[:space, :, 0])
    return there


def _moved(pose: Array, series: Array) -> Array:
    """The coefficients (3 or 7, n, .) of poses relative to these poses (3 or 7, n), seen from where those are."""
    if len(pose) == 3:
        c, s = np.cos(pose[2])[:, None], np.sin(pose[2])[:, None]
        x, y, angle = series
        moved = np.stack([c * x - s * y, s * x + c * y, angle])
        moved[:, :, 0] += pose
    else:
        turned = pose[3:, :, None]
        moved = np.concatenate([turn(turned, series[:3]), product(turned, series[3:])])
        moved[:3, :, 0] += pose[:3]
    return moved


def _added(steps: Array) -> Array:
    """Sums (m, n) of all steps before each one; what rounding takes is kept, for equal steps would round alike."""
    rows = []
    for row in steps.tolist():
        total, lost, sums = 0.0, 0.0, []
        for step in row:
            sums.append(total)
            more = step - lost
            new = total + more
            lost = (new - total) - more
            total = new
        rows.append(sums)
    return np.array(rows)


def _multiplied(steps: Array) -> Array:
    """Products (4, n) of all unit quaternions before each one, from the left: along the rows of a square, then from row
    to row."""
    n = steps.shape[1]
    side = int(np.ceil(np.sqrt(n)))
    square = np.zeros((4, side, side))
    square[0] = 1.0
    square.reshape(4, -1)[:, 1:n] = steps[:, :-1]
    for k in range(1, side):
        square[:, :, k] = of_unit_norm(product(square[:, :, k - 1], square[:, :, k]))
    for k in range(1, side):
        square[:, k] = of_unit_norm(product(square[:, k - 1, -1:], square[:, k]))
    return square.reshape(4, -1)[:, :n]
