"""The field equations of one rod, derived from its group and its laws: nothing in them is transcribed.

From the structure constants: compatibility dE/dt = V' + ad_E V and balance S' + ad*_E S + j = 0. From the
model: the stress S(E), the wrench j, the ends. What the scene lacks does not occur.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import Array
from geocosserat.derivation.convert import exact, to_sympy
from geocosserat.derivation.distribute import distributed
from geocosserat.derivation.ends import axes_seen, conditions
from geocosserat.derivation.notation import T, U, fields
from geocosserat.derivation.orientation import axes_of, orientation, seen_in_frame
from geocosserat.derivation.records import Equation, Equations, FieldEquations, Vector
from geocosserat.model.effects.weight import Weight
from geocosserat.model.expressions import Expression
from geocosserat.model.records import RodModel


def derive(model: RodModel) -> FieldEquations:
    """The equations of that rod; algebra only, a fraction of a second.

    Raises ValueError for frozen modes, kinds of end and effects that are not available, and ExpressionError
    for coefficients that are infinite or not real.
    """
    _refuse_the_unavailable(model)
    group = model.group
    E, V = fields(group.strain), fields(group.twist)
    zero = (sp.S.Zero,) * group.dimension

    # laws
    stiffness, friction = _matrix(model.stiffness), _matrix(model.friction)
    reference = _vector(model.reference)
    strain = _sum(E, tuple(-e for e in reference))
    stress_values, drag = _times(stiffness, strain), _times(friction, V)
    weight = _sum((sp.S.Zero,) * group.space, *(_vector(effect.force) for effect in model.effects))
    push = (*seen_in_frame(group, weight), *zero[group.space :])
    wrench_values = tuple(p - d for p, d in zip(push, drag, strict=True))
    S = _where_present(fields(group.stress), stress_values)
    j = _where_present(fields(group.wrench), wrench_values)

    # the world
    axes = axes_of(weight) | axes_seen(group, model.left) | axes_seen(group, model.right)
    frame = orientation(group, axes, V, E)

    # kinematics and balance
    coad = group.coad(_array(E))
    compatibility = _equations((e.diff(T) for e in E), _sum(_slope(V), group.bracket(_array(E), _array(V))))
    balance = _equations(_sum(_slope(S), coad @ _array(S), j), zero)
    # where the law steps the stress is continuous and the turn is not: there the stress stays a field
    steps = any(U in h.free_symbols for e in (*stiffness.ravel(), *reference) for h in e.atoms(sp.Heaviside))
    elastic = S if steps else stress_values
    motion = (distributed(e) for e in _sum(_slope(elastic), coad @ _array(elastic), push))

    symmetric = all(stiffness[a, b] == stiffness[b, a] for a, b in np.ndindex(stiffness.shape))
    return FieldEquations(
        model=model,
        turn=E,
        twist=V,
        stress=tuple(s for s in S if s != 0),
        wrench=tuple(f for f in j if f != 0),
        orientation=frame,
        compatibility=compatibility,
        balance=balance,
        stress_law=tuple(e for e in _equations(S, stress_values) if e.left != 0),
        wrench_law=tuple(e for e in _equations(j, wrench_values) if e.left != 0),
        orientation_rates=_equations((f.diff(T) for f in frame.fields), frame.rates),
        orientation_slopes=_equations((f.diff(U) for f in frame.fields), frame.slopes),
        motion=_equations(drag, motion),
        left=conditions(group, model.left, "left", sp.S.Zero, V, S),
        right=conditions(group, model.right, "right", exact(model.length), V, S),
        energy=_quadratic(stiffness / 2, strain) if symmetric else None,
        dissipation=_quadratic(friction, V),
    )


def _refuse_the_unavailable(model: RodModel) -> None:
    if model.frozen:
        found = ", ".join(model.frozen)
        raise ValueError(f"frozen: expected no frozen modes, found {found}; not available yet, remove them")
    for effect in model.effects:
        if not isinstance(effect, Weight):
            found = type(effect).__name__
            raise ValueError(f"effects: expected weight, found {found}; not available yet, remove it")


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
    products = (
        (matrix[a, b] + matrix[b, a]) * vector[a] * vector[b] for a in range(d) for b in range(a + 1, d)
    )
    return sp.Add(*squares, *products)


def _where_present(names: Vector, values: Vector) -> Vector:
    """The fields whose values are not zero, and zeros."""
    return tuple(name if value != 0 else sp.S.Zero for name, value in zip(names, values, strict=True))


def _equations(left: Iterable[sp.Expr], right: Iterable[sp.Expr]) -> Equations:
    return tuple(Equation(a, b) for a, b in zip(left, right, strict=True))
