"""What holds at the two ends of a rod."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import Group
from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.notation import U
from geocosserat.derivation.orientation import rotation
from geocosserat.derivation.records import EndConditions, Equation, Vector
from geocosserat.model.records import End

KINDS = ("clamped", "free", "pinned", "driven")
# the ends' power is <S, V> at the right minus <S, V> at the left: a load on the left is minus the stress
_OUTWARD = {"left": -1, "right": 1}


def conditions(
    group: Group, end: End, side: str, position: sp.Expr, twist: Sequence[sp.Expr], stress: Sequence[sp.Expr]
) -> EndConditions:
    """Where the end is held its twist is given, elsewhere the stress is the load or zero.

    Clamped: no twist. Pinned: no velocity, but the moment of the load. Driven: the twist of the scene. Free: the
    stress of the load. ``stress`` has a zero for each component that vanishes throughout.

    Raises ValueError for another kind, and for a load that the end does not take.
    """
    _check(end, side)
    seen = load(group, end)
    held = {"clamped": group.dimension, "driven": group.dimension, "pinned": group.translations, "free": 0}[end.kind]
    given = tuple(to_sympy(e) for e in end.twist or ()) or (sp.S.Zero,) * group.dimension
    still = tuple(Equation(v, x) for v, x in zip(twist[:held], given[:held], strict=True))
    pairs = ((s, _OUTWARD[side] * x) for s, x in zip(stress[held:], seen[held:], strict=True))
    loaded = tuple(Equation(s, x) for s, x in pairs if s != 0 or x != 0)
    return EndConditions(side, end.kind, position, seen, still + loaded)


def joined(
    group: Group, length: sp.Expr, twist: Sequence[sp.Expr], stress: Sequence[sp.Expr]
) -> tuple[EndConditions, EndConditions]:
    """Both ends are one cross-section: it has one twist and one stress."""

    def same(fields: Sequence[sp.Expr]) -> tuple[Equation, ...]:
        return tuple(Equation(f.subs(U, sp.S.Zero), f.subs(U, length)) for f in fields if f != 0)

    nothing = (sp.S.Zero,) * group.dimension
    return (
        EndConditions("left", "joined", sp.S.Zero, nothing, same(twist)),
        EndConditions("right", "joined", length, nothing, same(stress)),
    )


def load(group: Group, end: End) -> Vector:
    """Load on an end in moving-frame components: force, then torque (force x length); zeros if none."""
    force = tuple(to_sympy(e) for e in end.force or ()) or (sp.S.Zero,) * group.space
    torque = tuple(to_sympy(e) for e in end.torque or ()) or (sp.S.Zero,) * group.rotations
    if end.frame == "world":
        force = _seen_in_frame(group, force)
        # in the plane the torque is normal to it and looks the same from everywhere
        torque = _seen_in_frame(group, torque) if group.rotations == group.space else torque
    return (*force, *torque)


def _check(end: End, side: str) -> None:
    """Raise ValueError for what no scene can ask for."""
    if end.kind not in KINDS:
        raise ValueError(f"{side} end: expected one of {', '.join(KINDS)}, found {end.kind}; choose one of these")
    if (end.kind == "driven") != (end.twist is not None):
        raise ValueError(f"{side} end: expected a twist if it is driven and only then, found {end}; change either")
    if end.kind in ("clamped", "driven") and (end.force or end.torque):
        raise ValueError(f"{side} end: expected no load on a {end.kind} end, found {end}; remove it or free the end")
    if end.kind == "pinned" and end.force:
        raise ValueError(f"{side} end: expected no force on a pinned end, found {end}; remove it or free the end")


def _seen_in_frame(group: Group, vector: Sequence[sp.Expr]) -> Vector:
    return tuple(rotation(group).T @ np.array(vector, dtype=object))
