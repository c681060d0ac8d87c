"""Small motions about the straight rod at rest: limit equations to first order, by expansion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import sympy as sp

from geocosserat.derivation.distribute import distributed, terms
from geocosserat.derivation.elimination import put_in
from geocosserat.derivation.limit import LimitEquations, given
from geocosserat.derivation.notation import T, has_fields
from geocosserat.derivation.records import EndConditions, Equation, Equations


@dataclass(frozen=True)
class SmallMotion:
    """The first-order equations for the same unknowns as the limit; ``left``, ``right``: the ends."""

    rows: Equations
    left: EndConditions
    right: EndConditions


def small_motion(limit: LimitEquations) -> SmallMotion | None:
    """The limit equations to first order in the distance from the straight reference at rest.

    None where there is no such form: the reference is curved or moves, the rod sees the world, or something acts on
    it. The twist of a driven end counts as small.
    """
    equations = limit.equations
    group = equations.group
    references = dict(zip(group.strain, equations.reference, strict=True))
    curved = any(references[name] != 0 for name in group.strain[group.translations :])
    moves = any(T in e.free_symbols for e in equations.reference)
    if curved or moves or equations.orientation.fields or equations.position.fields:
        return None
    rest = {f: references.get(f.func.__name__, sp.S.Zero) for f in limit.unknowns}
    ends = (limit.left, limit.right)
    sides = [side for e in limit.rows for side in (e.left, e.right)]
    separate = [end for end in ends if end.kind != "joined"]
    sides += [e.left if end.kind == "driven" else e.residual for end in separate for e in end.equations]
    if any(distributed(put_in(side, rest)) != 0 for side in sides):
        return None
    return SmallMotion(
        tuple(Equation(_first_order(e.left, rest), _first_order(e.right, rest)) for e in limit.rows),
        *(_small_end(end, rest, equations.turn[0]) for end in ends),
    )


def _small_end(end: EndConditions, rest: Mapping[sp.Expr, sp.Expr], stretch: sp.Expr) -> EndConditions:
    if end.kind == "joined":
        return end
    conditions = []
    for e in end.equations:
        left = _first_order(e.left, rest)
        # what is given does not depend on the rod: the value of a field at rest, or a small twist
        right = _first_order(e.right, rest) if has_fields(e.right) else e.right - put_in(e.left, rest)
        conditions.append(given(left, distributed(right), stretch))
    return replace(end, equations=tuple(conditions))


def _first_order(e: sp.Expr, rest: Mapping[sp.Expr, sp.Expr]) -> sp.Expr:
    """The slope of e at rest in the direction of the fields' distance from rest."""
    return distributed(sp.Add(*(c * _slope(product, rest) for product, c in terms(e).items())))


def _slope(product: sp.Expr, rest: Mapping[sp.Expr, sp.Expr]) -> sp.Expr:
    """That of a product of powers of fields and their derivatives: the sum over the factors that move."""
    factors = [f.as_base_exp() for f in sp.Mul.make_args(product)]
    values = [put_in(base, rest) for base, _ in factors]
    slopes = []
    for k, (base, power) in enumerate(factors):
        others = [v**p for i, ((_, p), v) in enumerate(zip(factors, values, strict=True)) if i != k]
        slopes.append(power * values[k] ** (power - 1) * (base - values[k]) * sp.Mul(*others))
    return sp.Add(*slopes)
