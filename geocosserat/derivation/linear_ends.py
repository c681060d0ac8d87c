"""What holds at the ends of a rod to first order in its displacement, in the changes of twist and stress."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import sympy as sp

from geocosserat.derivation.distribute import distributed
from geocosserat.derivation.linear import Base
from geocosserat.derivation.notation import U
from geocosserat.derivation.records import EndConditions, Equation, Vector

_HELD = {"clamped": "all", "driven": "all", "pinned": "place", "free": "nothing"}


def ends_displaced(base: Base) -> tuple[EndConditions, EndConditions]:
    """An end that is held is not displaced (where it is driven, it is where the base is); a loaded one keeps its load.

    A load that is fixed in the world turns back as seen by an end that turns.
    """
    left, right = base.equations.left, base.equations.right
    return _end(base, left, base.displacement), _end(base, right, base.displacement)


def ends_alone(base: Base) -> tuple[EndConditions, EndConditions]:
    """The same by twist and stress: the twist of an end that is held does not change."""
    left, right = base.equations.left, base.equations.right
    return _end(base, left, base.twist_change), _end(base, right, base.twist_change)


def _end(base: Base, end: EndConditions, motion: Vector) -> EndConditions:
    present = tuple(f for f, s in zip(base.stress_change, base.stress, strict=True) if s != 0)
    if end.kind == "joined":
        far = base.equations.right.position
        same = motion if end.side == "left" else present
        return replace(end, equations=tuple(Equation(f.subs(U, sp.S.Zero), f.subs(U, far)) for f in same))
    held = {"all": base.dimension, "place": base.equations.group.translations, "nothing": 0}[_HELD[end.kind]]
    still = tuple(Equation(x, sp.S.Zero) for x in motion[:held])
    pairs = zip(base.stress_change[held:], _turned(base, end)[held:], strict=True)
    loaded = tuple(Equation(f, x) for f, x in pairs if f in present or x != 0)
    return replace(end, equations=still + loaded)


def _turned(base: Base, end: EndConditions) -> Vector:
    """The change of the stress that balances the load of the end."""
    group, given = base.equations.group, getattr(base.equations.model, end.side)
    if given.frame == "body":
        return (sp.S.Zero,) * base.dimension
    # the stress there is the load: what is zero of one is zero of the other
    load = np.array([s if x != 0 else sp.S.Zero for s, x in zip(base.stress, end.load, strict=True)], dtype=object)
    turn = np.array([sp.S.Zero if a < group.translations else x for a, x in enumerate(base.displacement)], dtype=object)
    return tuple(distributed(-e) for e in group.coad(turn) @ load)
