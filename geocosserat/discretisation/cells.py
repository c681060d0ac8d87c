"""Motion over short cells of time: poses relative to the start of each, as polynomials, by Gauss collocation.

Source: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration" (2006), section II.1.2.
"""

from collections.abc import Callable

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from geocosserat.discretisation.quaternions import spun, turn

Array = NDArray[np.float64]
Twist = Callable[[Array], Array]
"""Instants (...) to twists (d, ...)."""

POINTS = 16
"""Gauss points in a cell; its polynomials are of this degree, and exact to the order of 2 POINTS at its end."""

RESOLVED = 1e-14
"""Last coefficients of a polynomial that has converged, in lengths of the rod and in radians."""

EDGE = 64.0
"""How much more the twist at an edge, times half the cell, may be off: polynomials are worst there."""

RADIANS = 3.0
"""A cell in which the end may turn by more is too coarse unseen."""

_X, _WEIGHTS = legendre.leggauss(POINTS)
_MODES = np.arange(POINTS)
_PROJECT = legendre.legvander(_X, POINTS - 1) * _WEIGHTS[:, None] * (_MODES + 0.5)
"""(POINTS, POINTS) from values at the Gauss points to Legendre coefficients; all these act on rows."""
_AT_EDGES = legendre.legvander(np.array([-1.0, 1.0]), POINTS - 1).T
"""(POINTS, 2) from those to values at both ends."""
_INTEGRATE = (np.eye(POINTS, POINTS + 1, 1) - np.eye(POINTS, POINTS + 1, -1)) / (2 * _MODES[:, None] + 1)
_INTEGRATE[0, 0] = 1.0
"""(POINTS, POINTS + 1) from those of an integrand to those of its integral from -1."""
_VALUES = legendre.legvander(_X, POINTS).T
"""(POINTS + 1, POINTS) from those to values at the Gauss points."""
_INNER = _PROJECT @ _INTEGRATE @ _VALUES
"""(POINTS, POINTS) from values at the Gauss points to those of the integral."""
POWERS = np.stack([np.pad(legendre.leg2poly(unit), (0, POINTS))[POINTS::-1] for unit in np.eye(POINTS + 1)])
"""(POINTS + 1, POINTS + 1) from those to coefficients of powers, the highest first."""


def _integral(values: Array) -> Array:
    """Legendre coefficients (..., POINTS + 1) of the integral from the start of values (..., POINTS)."""
    rows = values.reshape(-1, POINTS) @ _PROJECT @ _INTEGRATE
    return rows.reshape(*values.shape[:-1], POINTS + 1)


def solved(twist: Twist, start: Array, end: Array, length: float, until: float) -> tuple[Array, NDArray[np.bool_]]:
    """Which cells are too coarse (n,), and of the others the Legendre coefficients (3 or 7, ., POINTS + 1) of the pose
    relative to their start."""
    half = (end - start)[:, None] / 2
    V = twist((start + end)[:, None] / 2 + half * _X)
    edges = twist(np.stack([np.nextafter(start, end), np.nextafter(end, start)], axis=1))
    space = 2 if len(V) == 3 else 3
    step = V * half
    unit = np.array([length] * space + [1.0] * (len(V) - space))[:, None, None]
    # what the rounding of the time itself makes of a twist that changes is no error of a polynomial
    change = np.ptp(V / unit, axis=2).max(axis=0)
    allowed = RESOLVED + np.finfo(float).eps * end * change / POINTS
    turning = 2 * np.linalg.norm(step[space:], axis=0).max(axis=1)
    smallest = end - start < 16 * np.finfo(float).eps * until
    # if not even the twist has converged, or it is another one beyond the outermost points, neither has the pose
    unresolved = np.abs(_integral(step / unit)[..., -2:]).max(axis=(0, 2)) > allowed
    beyond = np.abs((edges - V @ _PROJECT @ _AT_EDGES) * half / unit).max(axis=(0, 2)) > EDGE * allowed
    coarse = (unresolved | beyond | (turning > RADIANS)) & ~smallest
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
        q = (spun(q, spin).reshape(-1, POINTS) @ _INNER).reshape(q.shape)
        q[0] += 1.0
        if not np.abs(q - before).max(initial=0.0) > np.finfo(float).eps:
            break
    turned = _integral(spun(q, spin))
    turned[0, :, 0] += 1.0
    return np.concatenate([_integral(turn(q, step[:3])), turned])
