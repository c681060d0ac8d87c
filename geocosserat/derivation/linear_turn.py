"""The linear equations of a rod that does not see the world, for the change of its turn alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geocosserat.derivation.distribute import distributed
from geocosserat.derivation.linear import Base
from geocosserat.derivation.operators import LinearSystem, Operator, identity
from geocosserat.derivation.records import Equation, Equations


@dataclass(frozen=True)
class TurnAlone:
    """``twist``: the change of the twist by the unknowns. ``motion``: the closed system of these: the changes of the
    free modes, and of the multiplier in the place of each frozen one, whose row has no rate."""

    twist: Equations
    motion: LinearSystem


def turn_alone(base: Base) -> TurnAlone | None:
    """Compatibility to first order, dE/dt = V' + ad_E V, with the twist by the balance.

    None if the rod sees the world, or where a velocity has no friction or friction couples too many.
    """
    equations, group = base.equations, base.equations.group
    Y, mass = base.mobility()
    one = identity(base.dimension)
    if equations.orientation.fields or equations.position.fields or np.any(mass != one):
        return None
    unknowns = tuple(
        f if a in base.frozen else e
        for a, (e, f) in enumerate(zip(base.turn_change, base.stress_change, strict=True))
    )
    turn, kept = Operator((base.free,)), Operator((one - base.free,))
    twist = Y @ base.force(base.tangent @ turn + kept, turn)
    rate = twist.slope() + group.ad(base.turn) @ twist - group.ad(base.twist) @ turn
    changes = zip(base.twist_change, twist.each(distributed).of(unknowns), strict=True)
    return TurnAlone(
        tuple(Equation(v, e) for v, e in changes), LinearSystem(unknowns, base.free, rate).each(distributed)
    )
