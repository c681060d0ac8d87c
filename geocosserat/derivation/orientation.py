"""How the moving frame sees the world: the orientation fields that a scene needs, and how they evolve.

In the plane the field is the angle theta. In space a direction of the world is carried only where it is
called for: one world axis seen in the moving frame, (e1z, e2z, e3z) for z, closes on itself.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import Array, Group
from geocosserat.derivation.notation import field

AXES = "xyz"


@dataclass(frozen=True)
class Orientation:
    """Fields that give the world's directions in the moving frame, with their rates.

    ``rates`` and ``slopes`` are the right-hand sides of the time and the space derivative of each field.
    """

    fields: tuple[sp.Expr, ...] = ()
    rates: tuple[sp.Expr, ...] = ()
    slopes: tuple[sp.Expr, ...] = ()


def orientation(
    group: Group, axes: Iterable[int], twist: Sequence[sp.Expr], turn: Sequence[sp.Expr]
) -> Orientation:
    """The fields needed to see those world axes (0 for x, ...): R' = R hat(turn) and dR/dt = R hat(twist)."""
    needed = sorted(set(axes))
    if not needed:
        return Orientation()
    R = rotation(group)
    rates, slopes = (R @ group.rotation(group.hat(np.array(X, dtype=object))) for X in (twist, turn))
    if group.space == 2:
        theta = field("theta")
        # R(theta) is a one-parameter subgroup: its rate, seen in the moving frame, is its derivative at zero
        generator = np.zeros((group.size, group.size), dtype=object)
        generator[1:, 1:] = [[entry.diff(theta).subs(theta, 0) for entry in row] for row in R]
        per_radian = group.vee(generator)[-1]
        return Orientation((theta,), (twist[-1] / per_radian,), (turn[-1] / per_radian,))
    where = [(axis, i) for axis in needed for i in range(group.space)]
    return Orientation(*(tuple(matrix[index] for index in where) for matrix in (R, rates, slopes)))


def rotation(group: Group) -> Array:
    """The rotation matrix R in its fields, columns e_1, e_2(, e_3): object array (space, space)."""
    if group.space == 2:
        theta = field("theta")
        return np.array([[sp.cos(theta), -sp.sin(theta)], [sp.sin(theta), sp.cos(theta)]], dtype=object)
    return np.array([[field(f"e{i + 1}{axis}") for i in range(3)] for axis in AXES], dtype=object)


def axes_of(vector: Sequence[sp.Expr]) -> frozenset[int]:
    """The world axes along which a vector has a component."""
    return frozenset(axis for axis, x in enumerate(vector) if x != 0)


def seen_in_frame(group: Group, vector: Sequence[sp.Expr]) -> tuple[sp.Expr, ...]:
    """Components in the moving frame of a vector with those world components, R^T vector."""
    return tuple(rotation(group).T @ np.array(vector, dtype=object))
