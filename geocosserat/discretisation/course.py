"""The course of a driven end: its pose at any time, which follows from its twist alone.

phi_dot = phi V(t) knows of no state, so it is solved ahead of the integration, once, and to round-off: were it integrated
along with the rod, the errors of its steps would add up. Time is cut into cells. In each the pose relative to the cell's
start is found by Gauss collocation, of order 2 POINTS at its end, and kept as a polynomial; cells are halved until their
polynomials have converged, and end where the twist switches. In the plane the angle is unwrapped; in space a quaternion
turns any number of times.

Source: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration" (2006), section II.1.2 (collocation).
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from geocosserat.model.errors import InputError
from geocosserat.model.expressions import Expression, evaluate, switch_times

Array = NDArray[np.float64]
Twist = Callable[[Array], Array]
"""Instants (...) to twists (d, ...)."""

POINTS = 16
"""Gauss points in a cell; its polynomials are of this degree."""

CELLS = 64
"""Cells to begin with: what lasts less than a thousandth of the whole time may be overlooked, if it does not switch."""

RESOLVED = 1e-14
"""Last coefficients of a polynomial that has converged, in lengths of the rod and in radians."""

RADIANS = 3.0
"""A cell in which the end turns by more is halved unseen."""

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

    @property
    def table(self) -> Array:
        """All of it in a row, as kernels take it: the number of cells, the edges, the coefficients."""
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

    return follow(at, until, length, {t for e in twist for t in switch_times(e, until, values)})


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
            powers[batch] = np.moveaxis(_moved(begin[:, batch], local[:, order[batch]]) @ _POWERS, 0, -1)
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
        if len(a) <= BATCH or not _solved(twist, a[::16], b[::16], length, float(grid[-1]))[1].all():
            for i in range(0, len(a), BATCH):
                batch = slice(i, i + BATCH)
                local, coarse[batch] = _solved(twist, a[batch], b[batch], length, float(grid[-1]))
                yield a[batch][~coarse[batch]], local
        count += int(np.sum(~coarse))
        a, b = _halves(a[coarse], b[coarse])


def _halves(a: Array, b: Array) -> tuple[Array, Array]:
    middle = (a + b) / 2
    return np.concatenate([a, middle]), np.concatenate([middle, b])


_X, _WEIGHTS = legendre.leggauss(POINTS)
_MODES = np.arange(POINTS)
_PROJECT = legendre.legvander(_X, POINTS - 1) * _WEIGHTS[:, None] * (_MODES + 0.5)
"""(POINTS, POINTS) from values at the Gauss points to Legendre coefficients; all these act on rows."""
_INTEGRATE = (np.eye(POINTS, POINTS + 1, 1) - np.eye(POINTS, POINTS + 1, -1)) / (2 * _MODES[:, None] + 1)
_INTEGRATE[0, 0] = 1.0
"""(POINTS, POINTS + 1) from those of an integrand to those of its integral from -1."""
_VALUES = legendre.legvander(_X, POINTS).T
"""(POINTS + 1, POINTS) from those to values at the Gauss points."""
_INNER = _PROJECT @ _INTEGRATE @ _VALUES
"""(POINTS, POINTS) from values at the Gauss points to those of the integral."""
_POWERS = np.stack([np.pad(legendre.leg2poly(unit), (0, POINTS))[POINTS::-1] for unit in np.eye(POINTS + 1)])
"""(POINTS + 1, POINTS + 1) from those to coefficients of powers, the highest first."""


def _integral(values: Array) -> Array:
    """Legendre coefficients (..., POINTS + 1) of the integral from the start of values (..., POINTS)."""
    rows = values.reshape(-1, POINTS) @ _PROJECT @ _INTEGRATE
    return rows.reshape(*values.shape[:-1], POINTS + 1)


def _solved(twist: Twist, start: Array, end: Array, length: float, until: float) -> tuple[Array, NDArray[np.bool_]]:
    """Which cells are too coarse (n,), and of the others the Legendre coefficients (3 or 7, ., POINTS + 1) of the pose
    relative to their start."""
    half = (end - start)[:, None] / 2
    V = twist((start + end)[:, None] / 2 + half * _X)
    space = 2 if len(V) == 3 else 3
    step = V * half
    unit = np.array([length] * space + [1.0] * (len(V) - space))[:, None, None]
    # what the rounding of the time itself makes of a twist that changes is no error of a polynomial
    change = np.ptp(V / unit, axis=2).max(axis=0)
    allowed = RESOLVED + np.finfo(float).eps * end * change / POINTS
    turning = 2 * np.linalg.norm(step[space:], axis=0).max(axis=1)
    smallest = end - start < 16 * np.finfo(float).eps * until
    # if not even the twist has converged, the pose has not
    unresolved = np.abs(_integral(step / unit)[..., -2:]).max(axis=(0, 2)) > allowed
    coarse = (unresolved | (turning > RADIANS)) & ~smallest
    local = (_in_the_plane if space == 2 else _in_space)(step[:, ~coarse])
    unit = np.array([length] * space + [1.0] * (len(local) - space))[:, None, None]
    unresolved = np.abs(local[..., -2:] / unit).max(axis=(0, 2)) > allowed[~coarse]
    late = unresolved & ~smallest[~coarse]
    coarse[~coarse] = late
    return local[:, ~late], coarse


def _in_the_plane(step: Array) -> Array:
    """Position and angle of cells, from the twist at the points times half their duration (3, n, POINTS)."""
    angle = _integral(step[2])
    turned = angle @ _VALUES
    c, s = np.cos(turned), np.sin(turned)
    return np.stack([_integral(c * step[0] - s * step[1]), _integral(s * step[0] + c * step[1]), angle])


def _in_space(step: Array) -> Array:
    """Position and quaternion of cells, likewise from (6, n, POINTS): the collocation's equations, linear in the
    quaternion, by iteration, which gains a factor of about the angle over twice the count each time."""
    spin = step[3:] / 2
    q = np.zeros((4, *spin.shape[1:]))
    q[0] = 1.0
    for _ in range(4 * POINTS):
        before = q
        q = (_spun(q, spin).reshape(-1, POINTS) @ _INNER).reshape(q.shape)
        q[0] += 1.0
        if not np.abs(q - before).max(initial=0.0) > np.finfo(float).eps:
            break
    turned = _integral(_spun(q, spin))
    turned[0, :, 0] += 1.0
    return np.concatenate([_integral(turn(q, step[:3])), turned])


def _spun(q: Array, spin: Array) -> Array:
    """Quaternions (4, ...) times vectors (3, ...) as quaternions."""
    a, b, c, d = q
    x, y, z = spin
    out = np.empty_like(q)
    out[0] = -b * x - c * y - d * z
    out[1] = a * x + c * z - d * y
    out[2] = a * y + d * x - b * z
    out[3] = a * z + b * y - c * x
    return out


def product(p: Array, q: Array) -> Array:
    """Of quaternions (4, ...), real part first."""
    a, b, c, d = p
    e, f, g, h = q
    return np.stack(
        [
            a * e - b * f - c * g - d * h,
            a * f + b * e + c * h - d * g,
            a * g - b * h + c * e + d * f,
            a * h + b * g - c * f + d * e,
        ]
    )


def turn(q: Array, vector: Array) -> Array:
    """Vectors (3, ...) turned by quaternions (4, ...) of any norm."""
    a, v = q[0], q[1:]
    twice = 2 * _cross(v, vector) / np.sum(q * q, axis=0)
    return vector + a * twice + _cross(v, twice)


def _cross(v: Array, w: Array) -> Array:
    return np.stack([v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]])


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
    square = np.zeros((4, side * side))
    square[0] = 1.0
    square[:, 1:n] = steps[:, :-1]
    square = square.reshape(4, side, side)
    for k in range(1, side):
        square[:, :, k] = _of_unit_norm(product(square[:, :, k - 1], square[:, :, k]))
    for k in range(1, side):
        square[:, k] = _of_unit_norm(product(square[:, k - 1, -1:], square[:, k]))
    return square.reshape(4, -1)[:, :n]


def _of_unit_norm(q: Array) -> Array:
    return q / np.linalg.norm(q, axis=0)
