"""The field equations of one rod, derived from its group and its laws: nothing in them is transcribed.

From the structure constants: compatibility dE/dt = V' + ad_E V and balance S' + ad*_E S + j = 0. From the
model: the stress S(E) or S(E, dE/dt), the frozen modes, the wrench j, the ends. What the scene lacks does not occur.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import Array
from geocosserat.derivation import acting
from geocosserat.derivation.convert import exact, to_sympy
from geocosserat.derivation.distribute import distributed
from geocosserat.derivation.ends import conditions, joined
from geocosserat.derivation.notation import T, U, fields, symbol
from geocosserat.derivation.orientation import axes_seen, orientation, place, places_seen
from geocosserat.derivation.records import Equation, Equations, FieldEquations, Vector
from geocosserat.model.expressions import Expression
from geocosserat.model.law import Law, rates
from geocosserat.model.records import RodModel


def derive(model: RodModel) -> FieldEquations:
    """The equations of that rod; algebra only, a fraction of a second.

    Raises ValueError for kinds of end that there are not, and ExpressionError for coefficients that are infinite
    or not real.
    """
    group, held = model.group, model.held
    V = fields(group.twist)
    zero = (sp.S.Zero,) * group.dimension

    # laws: a frozen mode is its reference, and its stress is what keeps it there
    friction = _matrix(model.friction)
    reference = _vector(model.reference)
    E = _chosen(held, reference, fields(group.strain))
    elasticity = _of_law(model.law, E) if model.law else _of_stiffness(model, reference, E)
    stress_values = _chosen(held, fields(group.stress), elasticity.stress)
    push = acting.push(group, model.effects)
    medium = acting.medium(group, model.effects)
    slip = _sum(V, tuple(-v for v in medium))
    carried = _times(friction, medium)
    wrench_values = tuple(p - d for p, d in zip(push, _times(friction, slip), strict=True))
    S = _where_present(fields(group.stress), stress_values)
    j = _where_present(fields(group.wrench), wrench_values)

    # ends
    length = exact(model.length)
    if model.joined:
        left, right = joined(group, length, V, S)
    else:
        left = conditions(group, model.left, "left", sp.S.Zero, V, S)
        right = conditions(group, model.right, "right", length, V, S)

    # the world
    sides = (*push, *carried, *left.load, *right.load)
    places = places_seen(group, sides)
    here = place(group, places, V, E)
    frame = orientation(group, axes_seen(group, (*sides, *here.rates)), V, E)

    # kinematics and balance
    coad = group.coad(_array(E))
    compatibility = _equations((e.diff(T) for e in E), _sum(_slope(V), group.bracket(_array(E), _array(V))))
    balance = _equations(_sum(_slope(S), coad @ _array(S), j), zero)
    # where the law steps the stress is continuous and the turn is not: there the stress stays a field
    elastic = S if elasticity.steps else stress_values
    motion = (distributed(e) for e in _sum(_slope(elastic), coad @ _array(elastic), carried, push))

    return FieldEquations(
        model=model,
        turn=E,
        twist=V,
        stress=tuple(s for s in S if s != 0),
        wrench=tuple(f for f in j if f != 0),
        orientation=frame,
        position=here,
        multipliers=tuple(s for s, frozen in zip(S, held, strict=True) if frozen),
        compatibility=compatibility,
        balance=balance,
        stress_law=tuple(e for e in _equations(S, stress_values) if e.left not in (0, e.right)),
        wrench_law=tuple(e for e in _equations(j, wrench_values) if e.left != 0),
        orientation_rates=_equations((f.diff(T) for f in frame.fields), frame.rates),
        orientation_slopes=_equations((f.diff(U) for f in frame.fields), frame.slopes),
        position_rates=_equations((f.diff(T) for f in here.fields), here.rates),
        position_slopes=_equations((f.diff(U) for f in here.fields), here.slopes),
        motion=_equations(_times(friction, V), motion),
        left=left,
        right=right,
        energy=elasticity.energy,
        dissipation=_quadratic(friction, slip) + elasticity.lost,
    )


@dataclass(frozen=True)
class _Elasticity:
    """Stress of every mode, and its energy density if it has one; steps: whether the stress steps by itself; lost: the
    power density of its viscous part."""

    stress: Vector
    energy: sp.Expr | None
    steps: bool
    lost: sp.Expr = sp.S.Zero


def _of_stiffness(model: RodModel, reference: Vector, E: Vector) -> _Elasticity:
    held, d = model.held, model.group.dimension
    stiffness = _matrix(model.stiffness)
    strain = _chosen(held, (sp.S.Zero,) * d, _sum(E, tuple(-e for e in reference)))
    free = [a for a in range(d) if not held[a]]
    symmetric = all(stiffness[a, b] == stiffness[b, a] for a in free for b in free)
    energy = _quadratic(stiffness / 2, strain) if symmetric else None
    return _Elasticity(_times(stiffness, strain), energy, _steps(stiffness, reference, held))


def _of_law(law: Law, E: Vector) -> _Elasticity:
    values = dict(zip((symbol(name) for name in law.group.strain), E, strict=True))
    speeds = {symbol(name): e.diff(T) for name, e in zip(rates(law.group), E, strict=True)}
    said, still = _vector(law.stress or ()), dict.fromkeys(speeds, sp.S.Zero)
    stress = tuple(e.xreplace({**values, **speeds}) for e in said)
    viscous = (e - e.xreplace(still) for e in said)
    lost = sp.Add(*(e.xreplace({**values, **speeds}) * x for e, x in zip(viscous, speeds.values(), strict=True)))
    known = law.energy is not None and not law.remainder
    energy = to_sympy(law.energy).xreplace(values) if known and law.energy is not None else None
    return _Elasticity(stress, energy, any(e.has(sp.Heaviside) for e in stress), distributed(lost))


def _steps(stiffness: Array, reference: Vector, held: Sequence[bool]) -> bool:
    """Whether the law of a free mode has a step in u."""
    free = [a for a, frozen in enumerate(held) if not frozen]
    laws = (*(stiffness[a, b] for a in free for b in free), *(reference[a] for a in free))
    return any(U in h.free_symbols for e in laws for h in e.atoms(sp.Heaviside))


def _chosen(held: Sequence[bool], frozen: Vector, free: Vector) -> Vector:
    """For each component the one or the other."""
    return tuple(a if this else b for this, a, b in zip(held, frozen, free, strict=True))


def _vector(expressions: Iterable[Expression]) -> Vector:
    return tuple(to_sympy(e) for e in expressions)


def _matrix(rows: Iterable[Iterable[Expression]]) -> Array:
    return np.array([[to_sympy(e) for e in row] for row in rows], dtype=object)


def _array(vector: Sequence[sp.Expr]) -> Array:
    return np.array(vector, dtype=object)


def _times(matrix: Array, vector: Vector) -> Vector:
    """Product of a matrix and a vector, whose zero entries leave no term."""
    return tuple(sp.Add(*(m * x for m, x in zip(row, vector, strict=True))) for row in matrix)


def _sum(*vectors: Iterable[sp.Expr]) -> Vector:
    return tuple(sp.Add(*parts) for parts in zip(*vectors, strict=True))


def _slope(vector: Vector) -> Vector:
    return tuple(x.diff(U) for x in vector)


def _quadratic(matrix: Array, vector: Vector) -> sp.Expr:
    """The quadratic form of a matrix, each product of two components once."""
    d = len(vector)
    squares = (matrix[a, a] * vector[a] ** 2 for a in range(d))
    products = ((matrix[a, b] + matrix[b, a]) * vector[a] * vector[b] for a in range(d) for b in range(a + 1, d))
    return sp.Add(*squares, *products)


def _where_present(names: Vector, values: Vector) -> Vector:
    """The fields whose values are not zero, and zeros."""
    return tuple(name if value != 0 else sp.S.Zero for name, value in zip(names, values, strict=True))


def _equations(left: Iterable[sp.Expr], right: Iterable[sp.Expr]) -> Equations:
    return tuple(Equation(a, b) for a, b in zip(left, right, strict=True))
