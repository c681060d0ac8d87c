"""Where a law is singular: walls, lines that a loop can encircle, ends of its domain."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import sympy as sp

from geocosserat.derivation.convert import to_sympy
from geocosserat.model.expressions import Binary, Call, Expression, ExpressionError, Negate, symbols
from geocosserat.passivity.balls import exactly
from geocosserat.passivity.normal import normal_forms
from geocosserat.passivity.polynomials import NoForm
from geocosserat.passivity.ranges import Range, sign_on

Shape: TypeAlias = Literal["wall", "line", "small", "edge", "curved", "essential"]


@dataclass(frozen=True)
class Singular:
    """The strains where ``expression`` vanishes, at which the law has no value or no slope.

    shape: "wall", planes, which part the strains into convex pieces; "edge", the boundary of a convex domain; "line",
    of codimension two, which a loop can encircle; "small", of a higher codimension; "curved", anything else;
    "essential", walls and curved ones within a function (exp(1/x)), across which the law may step. point: on a line.
    """

    expression: sp.Expr
    shape: Shape
    point: Mapping[str, sp.Rational] | None = None


def singular_sets(
    stress: Sequence[Expression],
    strain: Sequence[str],
    box: Mapping[str, Range],
    positive: Collection[str],
    centre: Mapping[str, sp.Rational],
) -> tuple[Singular, ...]:
    """The singular sets of expressions that are not proved to lie outside a box.

    ``centre``: of strain components that a line leaves free.
    """
    found: dict[str, Singular] = {}
    # each once, though derivatives repeat it
    suspects = dict.fromkeys(suspect for e in stress for suspect in _suspects(e, False))
    signs: dict[Expression, int] = {}
    for inner, above, within in suspects:
        if not symbols(inner) & set(strain):
            continue
        if inner not in signs:
            signs[inner] = sign_on(inner, box)
        if signs[inner]:
            continue
        for item in _shapes(inner, above, within, strain, positive, centre):
            known = found.get(str(item.expression))
            if known is None or item.shape == "essential":
                found[str(item.expression)] = item
    return tuple(found.values())


def _suspects(e: Expression, within: bool) -> list[tuple[Expression, bool, bool]]:
    """(what must not vanish, whether it must be above zero, whether it lies within a function)."""
    match e:
        case Call(function, argument):
            found = _suspects(argument, within or function not in ("abs", "heaviside"))
            if function in ("log", "sqrt"):
                found.append((argument, True, within))
            elif function == "tan":
                found.append((Call("cos", argument), False, within))
            return found
        case Binary(mark, left, right):
            power = exactly(right) if mark == "**" else None
            whole = power is not None and power.denominator == 1
            found = _suspects(left, within or (mark == "**" and not whole)) + _suspects(right, within or mark == "**")
            if mark == "/":
                found.append((right, False, within))
            elif mark == "**" and not (whole and power is not None and power >= 0):
                found.append((left, not whole, within))
            return found
        case Negate(operand):
            return _suspects(operand, within)
    return []


def _shapes(
    inner: Expression,
    above: bool,
    within: bool,
    strain: Sequence[str],
    positive: Collection[str],
    centre: Mapping[str, sp.Rational],
) -> list[Singular]:
    try:
        e = to_sympy(inner)
    except ExpressionError:
        return [Singular(sp.Symbol("undefined"), "curved")]
    try:
        tower, [(top, bottom)] = normal_forms([e], positive, seconds=2)
        number, powers = tower.factors((top, bottom))
    except NoForm:
        return [_single(e, above, within, strain)]
    shapes = []
    for p, n in powers:
        if tower.sign(p):
            continue
        meant = tower.expression(p)
        meant = meant.args[0] if isinstance(meant, sp.Abs) else meant
        if not {x.name for x in meant.free_symbols} & set(strain):
            continue
        alone = above and len(powers) == 1 and n == 1
        # what must be above zero, with its sign
        shapes.append(_shape(-meant if alone and number < 0 else meant, alone, within, strain, centre))
    return [s for s in shapes if s is not None]


def _single(e: sp.Expr, above: bool, within: bool, strain: Sequence[str]) -> Singular:
    inside = [x for x in e.free_symbols if x.name in strain]
    if len(inside) == 1:
        return Singular(e, "essential" if within and not above else "edge" if above else "wall")
    return _curved(e, above, within)


def _curved(e: sp.Expr, above: bool, within: bool) -> Singular:
    return Singular(e, "essential" if within and not above else "curved")


def _shape(
    e: sp.Expr, above: bool, within: bool, strain: Sequence[str], centre: Mapping[str, Any]
) -> Singular | None:
    inside = [x for x in sorted(e.free_symbols, key=str) if x.name in strain]
    if len(inside) == 1:
        return _single(e, above, within, strain)
    if not e.is_polynomial(*inside):
        return _curved(e, above, within)
    polynomial = sp.Poly(e, *inside)
    if polynomial.total_degree() == 1:
        return Singular(e, "essential" if within and not above else "edge" if above else "wall")
    if polynomial.total_degree() == 2 and all(c.is_Rational for c in polynomial.coeffs()):
        found = _quadric(polynomial, e, above, centre)
        parts = found is not None and found.shape in ("curved", "wall")
        return _curved(e, above, within) if within and parts else found
    return _curved(e, above, within)


def _quadric(polynomial: sp.Poly, e: sp.Expr, above: bool, centre: Mapping[str, Any]) -> Singular | None:
    """By the signs of the form and its least value, exactly."""
    x = polynomial.gens
    form = sp.Matrix(len(x), len(x), lambda i, j: sp.diff(e, x[i], x[j]) / 2)
    slope = sp.Matrix([sp.diff(e, v).subs(dict.fromkeys(x, 0)) for v in x])
    for sign in (1, -1):
        ranks = _semidefinite(sign * form)
        if ranks is None:
            continue
        # the stationary point nearest to the centre in what the form leaves free
        try:
            solution = next(iter(sp.linsolve((2 * form, -slope), *x)))
        except StopIteration:
            return Singular(e, "edge" if above and sign < 0 else "curved")
        point = {v: s.subs({w: centre[w.name] for w in x}) for v, s in zip(x, solution, strict=True)}
        value = sign * e.subs(point)
        if value > 0:
            return None
        if value == 0:
            shape: Shape = "line" if ranks == 2 else "small" if ranks > 2 else "wall"
            return Singular(e, shape, {v.name: value for v, value in point.items()})
        # below zero somewhere: inside an ellipsoid, or outside of it
        return Singular(e, "edge" if above and sign < 0 else "curved")
    return Singular(e, "curved")


def _semidefinite(form: sp.Matrix) -> int | None:
    """The rank of a matrix of rationals whose quadratic form is nowhere below zero, else None; by elimination."""
    a, rank = form.copy(), 0
    n = a.shape[0]
    left = list(range(n))
    while left:
        if any(a[i, i] < 0 for i in left):
            return None
        pivot = next((i for i in left if a[i, i] > 0), None)
        if pivot is None:
            return rank if all(a[i, j] == 0 for i in left for j in left) else None
        left.remove(pivot)
        rank += 1
        for i in left:
            for j in left:
                a[i, j] = a[i, j] - a[i, pivot] * a[pivot, j] / a[pivot, pivot]
    return rank
