"""A rod displaced a little from any motion of it, the base: its equations to first order in the displacement.

The base is what the fields of the rod's equations stand for, at rest or not, under stress or not. Displaced, the
configuration is phi exp(eta). Then the turn changes by eta' + ad_E eta and the twist by eta_t + ad_V eta (the mixed
derivatives are equal), and what is seen of the world changes as it would in time if the twist were eta.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import Array
from geocosserat.derivation.distribute import distributed
from geocosserat.derivation.elimination import coupled, inverted
from geocosserat.derivation.notation import fields
from geocosserat.derivation.operators import LinearSystem, Operator, identity, slope_by
from geocosserat.derivation.records import Equation, Equations, FieldEquations, Vector
from geocosserat.model.errors import InputError


@dataclass(frozen=True)
class Base:
    """What of the base stands in linear equations: object arrays, components in the moving frame.

    ``turn``, ``twist``, ``stress``: E, V and Sigma. ``free``: the projector on the free modes. ``tangent``: T, d Sigma
    / d E of these. ``prestress``: B, with B X = ad*_X Sigma. ``world``: S, the change of the wrench, the rod's own
    twist aside, by the displacement. ``friction``: Gamma.
    """

    equations: FieldEquations
    turn: Array
    twist: Array
    stress: Array
    free: Array
    tangent: Array
    prestress: Array
    world: Array
    friction: Array

    @property
    def dimension(self) -> int:
        """Of the group."""
        return self.equations.group.dimension

    @property
    def frozen(self) -> tuple[int, ...]:
        """The places of the frozen modes."""
        return tuple(a for a, held in enumerate(self.equations.model.held) if held)

    @property
    def displacement(self) -> Vector:
        """The fields eta."""
        return fields(f"eta{a + 1}" for a in range(self.dimension))

    @property
    def turn_change(self) -> Vector:
        """The fields delta E."""
        return fields(f"d{name}" for name in self.equations.group.strain)

    @property
    def twist_change(self) -> Vector:
        """The fields delta V."""
        return fields(f"d{name}" for name in self.equations.group.twist)

    @property
    def stress_change(self) -> Vector:
        """The fields delta Sigma."""
        return fields(f"d{name}" for name in self.equations.group.stress)

    @property
    def multipliers(self) -> Vector:
        """Those of the stresses that keep frozen modes."""
        return tuple(self.stress_change[a] for a in self.frozen)

    def force(self, stress: Operator, turn: Operator) -> Operator:
        """The change of Sigma' + ad*_E Sigma by those of stress and turn."""
        turned: Operator = self.equations.group.coad(self.turn) @ stress + self.prestress @ self.free @ turn
        return stress.slope() + turned

    def mobility(self) -> tuple[Array, Array]:
        """Y and Y Gamma: 1 in the rows of velocities of which friction couples few, elsewhere Gamma itself."""
        friction, known = self.friction, self.equations.twist
        Y, mass = identity(self.dimension), friction.copy()
        place = {v: a for a, v in enumerate(known)}
        damped = tuple(v for v, row in zip(known, friction, strict=True) if any(e != 0 for e in row))
        for block in coupled(damped, lambda a, b: friction[place[a], place[b]]):
            where = np.ix_(*([place[v] for v in block],) * 2)
            inverse = inverted(sp.Matrix(friction[where]))
            if inverse is not None:
                Y[where], mass[where] = np.array(inverse), identity(len(block))
        return Y, mass


def base_of(equations: FieldEquations) -> Base:
    """The base of linear equations for that rod.

    Raises InputError for a law whose stress answers to rates of strain: rates would not stand alone on one side.
    """
    if equations.viscous:
        raise InputError(
            "a stress that answers to the strain alone, so that D, A and R are matrices",
            "a law with rates of strain, under which the rates solve a boundary value problem",
            "leave these rates out of the law, or use the form intrinsic",
            key="--form linearised",
        )
    group = equations.group
    stress = [s if s in equations.stress else sp.S.Zero for s in fields(group.stress)]
    law = {e.left: e.right for e in equations.stress_law}
    units = identity(group.dimension)
    sigma = np.array(stress, dtype=object)
    return Base(
        equations=equations,
        turn=np.array(equations.turn, dtype=object),
        twist=np.array(equations.twist, dtype=object),
        stress=sigma,
        free=units * [int(not held) for held in equations.model.held],
        tangent=_matrix([slope_by(law.get(s, sp.S.Zero), x) for x in fields(group.strain)] for s in stress),
        prestress=np.column_stack([group.coad(unit) @ sigma for unit in units]),
        world=_world(equations),
        friction=_matrix([e.left.diff(v) for v in equations.twist] for e in equations.motion),
    )


@dataclass(frozen=True)
class LinearEquations:
    """The linear equations for the displacement (lengths, then radians) and the changes of the multipliers.

    ``kinematics``: the change of the turn by the displacement, for frozen modes 0. ``stress``: the change of each
    stress that has a law. ``balance``: the closed system, Gamma eta_t = ... and the rows of frozen modes.
    """

    base: Base
    kinematics: Equations
    stress: Equations
    balance: LinearSystem

    @property
    def motion(self) -> LinearSystem:
        """The closed system solved for the rates, as far as friction couples few velocities."""
        whole, mass, d = identity(len(self.balance.mass)), 0 * self.balance.mass, self.base.dimension
        whole[:d, :d], mass[:d, :d] = self.base.mobility()
        return LinearSystem(self.balance.unknowns, mass, (whole @ self.balance.operator).each(distributed))


def linearise(equations: FieldEquations) -> LinearEquations:
    """The equations of that rod to first order in a displacement from any motion of it.

    Raises InputError as `base_of`.
    """
    return about(base_of(equations))


def about(base: Base) -> LinearEquations:
    """The linear equations about that base."""
    group, d, m = base.equations.group, base.dimension, len(base.frozen)
    unit = identity(d + m)
    eta, kept = Operator((unit[:d],)), Operator((unit[:d, list(base.frozen)] @ unit[d:],))
    turn = eta.slope() + group.ad(base.turn) @ eta
    stress = base.tangent @ turn + kept
    push = base.force(stress, turn) + (base.world - base.friction @ group.ad(base.twist)) @ eta
    unknowns = (*base.displacement, *base.multipliers)
    mass = 0 * unit
    mass[:d, :d] = base.friction
    changes = base.free @ np.array(base.turn_change, dtype=object)
    return LinearEquations(
        base=base,
        kinematics=_equations(changes, turn.each(distributed).of(unknowns)),
        stress=_laws(base),
        balance=LinearSystem(unknowns, mass, push.above(turn.rows(base.frozen)).each(distributed)),
    )


def _laws(base: Base) -> Equations:
    """The change of each stress that has a law, by that of the turn."""
    given = base.tangent @ np.array(base.turn_change, dtype=object)
    rows = zip(base.stress_change, given, base.stress, strict=True)
    return tuple(Equation(f, e) for f, e, s in rows if s != 0 and f not in base.multipliers)


def _world(equations: FieldEquations) -> Array:
    """By which the wrench changes, row by row, with each component of the displacement."""
    group, seen = equations.group, (equations.orientation, equations.position)
    wrench = {e.left: e.right for e in equations.wrench_law}
    by_sight = _matrix(
        [slope_by(wrench.get(j, sp.S.Zero), f) for part in seen for f in part.fields] for j in fields(group.wrench)
    )
    # fields of the world change with a displacement as their rates say of a twist
    sight = _matrix([rate.diff(v) for v in equations.twist] for part in seen for rate in part.rates)
    return by_sight @ sight if sight.size else 0 * identity(group.dimension)


def _matrix(rows: Iterable[Sequence[sp.Expr]]) -> Array:
    return np.array(list(rows), dtype=object)


def _equations(left: Iterable[sp.Expr], right: Iterable[sp.Expr]) -> Equations:
    return tuple(Equation(a, b) for a, b in zip(left, right, strict=True))
