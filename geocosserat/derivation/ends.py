"""What holds at the two ends of a rod."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from geocosserat.algebra.groups import Group
from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.orientation import axes_of, seen_in_frame
from geocosserat.derivation.records import EndConditions, Equation, Vector
from geocosserat.model.records import End

# the ends' power is <S, V> at the right minus <S, V> at the left: a load on the left is minus the stress
_OUTWARD = {"left": -1, "right": 1}


def conditions(
    group: Group, end: End, side: str, position: sp.Expr, twist: Sequence[sp.Expr], stress: Sequence[sp.Expr]
) -> EndConditions:
    """Clamped: no twist. Free: the stress is the load, or zero. ValueError for what is not available.

    ``stress`` has a zero for each component that vanishes throughout.
    """
    if end.kind == "clamped" and end.force is None and end.torque is None:
        equations = tuple(Equation(v, sp.S.Zero) for v in twist)
        return EndConditions(side, end.kind, position, (sp.S.Zero,) * group.dimension, equations)
    if end.kind != "free":
        raise ValueError(
            f'{side} end: expected "clamped" without a load or "free", found {end}; choose one of the two'
        )
    seen = load(group, end)
    pairs = ((s, _OUTWARD[side] * x) for s, x in zip(stress, seen, strict=True))
    equations = tuple(Equation(s, x) for s, x in pairs if s != 0 or x != 0)
    return EndConditions(side, end.kind, position, seen, equations)


def load(group: Group, end: End) -> Vector:
    """Load on an end in moving-frame components: force, then torque (force x length); zeros if none."""
    force, torque = _world_or_body(group, end)
    if end.frame == "world":
        force = seen_in_frame(group, force)
        # in the plane the torque is normal to it and looks the same from everywhere
        torque = seen_in_frame(group, torque) if group.rotations == group.space else torque
    return (*force, *torque)


def axes_seen(group: Group, end: End) -> frozenset[int]:
    """The world axes along which a load fixed in the world acts."""
    if end.frame != "world":
        return frozenset()
    force, torque = _world_or_body(group, end)
    return axes_of(force) | (axes_of(torque) if group.rotations == group.space else frozenset())


def _world_or_body(group: Group, end: End) -> tuple[Vector, Vector]:
    force = end.force or ()
    torque = end.torque or ()
    return (
        tuple(to_sympy(e) for e in force) or (sp.S.Zero,) * group.space,
        tuple(to_sympy(e) for e in torque) or (sp.S.Zero,) * group.rotations,
    )
