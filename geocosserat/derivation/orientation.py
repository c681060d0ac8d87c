"""Where a rod sees the world: the orientation and the place that a scene needs as fields, and how they evolve.

In the plane the orientation is the angle theta. In space a direction of the world is carried only where it is
called for: one world axis seen in the moving frame, (e1z, e2z, e3z) for z, closes on itself. A coordinate of the
place needs its own axis in space, and the angle in the plane.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import Array, Group
from geocosserat.derivation.notation import field, field_names, fields

AXES = "xyz"


@dataclass(frozen=True)
class Carried:
    """Fields that are carried along with the rod, angles and directions (dimensionless) or coordinates (lengths).

    ``rates`` and ``slopes`` are the right-hand sides of the time and the space derivative of each field.
    """

    fields: tuple[sp.Expr, ...] = ()
    rates: tuple[sp.Expr, ...] = ()
    slopes: tuple[sp.Expr, ...] = ()


def orientation(group: Group, axes: Iterable[int], twist: Sequence[sp.Expr], turn: Sequence[sp.Expr]) -> Carried:
    """The fields needed to see those world axes (0 for x, ...): R' = R hat(turn) and dR/dt = R hat(twist)."""
    needed = sorted(set(axes))
    if not needed:
        return Carried()
    R = rotation(group)
    rates, slopes = (R @ group.rotation(group.hat(np.array(X, dtype=object))) for X in (twist, turn))
    if group.space == 2:
        theta = field("theta")
        # R(theta) is a one-parameter subgroup: its rate, seen in the moving frame, is its derivative at zero
        generator = np.zeros((group.size, group.size), dtype=object)
        generator[1:, 1:] = [[entry.diff(theta).subs(theta, 0) for entry in row] for row in R]
        per_radian = group.vee(generator)[-1]
        return Carried((theta,), (twist[-1] / per_radian,), (turn[-1] / per_radian,))
    where = [(axis, i) for axis in needed for i in range(group.space)]
    return Carried(*(tuple(matrix[index] for index in where) for matrix in (R, rates, slopes)))


def rotation(group: Group) -> Array:
    """The rotation matrix R in its fields, columns e_1, e_2(, e_3): object array (space, space)."""
    if group.space == 2:
        theta = field("theta")
        return np.array([[sp.cos(theta), -sp.sin(theta)], [sp.sin(theta), sp.cos(theta)]], dtype=object)
    return np.array([[field(f"e{i + 1}{axis}") for i in range(3)] for axis in AXES], dtype=object)


def place(group: Group, axes: Iterable[int], twist: Sequence[sp.Expr], turn: Sequence[sp.Expr]) -> Carried:
    """Those coordinates (0 for x, ...) of the point r that a cross-section sits at: r' = R h and dr/dt = R v."""
    needed = sorted(set(axes))
    if not needed:
        return Carried()
    R, n = rotation(group), group.space
    rates, slopes = (R @ np.array(X[:n], dtype=object) for X in (twist, turn))
    return Carried(position(group, needed), tuple(rates[needed]), tuple(slopes[needed]))


def position(group: Group, axes: Iterable[int] | None = None) -> tuple[sp.Expr, ...]:
    """The fields x, y(, z) of the place in the world (lengths), or those of the axes named."""
    return fields(AXES[axis] for axis in (range(group.space) if axes is None else axes))


def axes_seen(group: Group, expressions: Iterable[sp.Expr]) -> frozenset[int]:
    """The world axes whose directions occur in expressions; in the plane all of them where the angle does."""
    names = field_names(expressions)
    if group.space == 2:
        return frozenset(range(2)) if "theta" in names else frozenset()
    return frozenset(k for k, axis in enumerate(AXES) if any(f"e{i}{axis}" in names for i in (1, 2, 3)))


def places_seen(group: Group, expressions: Iterable[sp.Expr]) -> frozenset[int]:
    """The coordinates of the place that occur in expressions."""
    names = field_names(expressions)
    return frozenset(k for k, axis in enumerate(AXES[: group.space]) if axis in names)
