"""Sums of products of fields: multiplied out, like products merged, coefficients kept short."""

from __future__ import annotations

import sympy as sp

from geocosserat.derivation.notation import has_fields

Terms = dict[sp.Expr, sp.Expr]
"""Product of fields -> its coefficient, free of fields."""

_MOST_EXPANDED = 6


def terms(e: sp.Expr) -> Terms:
    """The terms of e that do not cancel, as product of fields -> coefficient.

    Coefficients keep the form in which the scene gives them unless multiplied out they are shorter. A
    function of fields that is no polynomial (the sine of an angle) counts as one factor.
    """
    return {product: _shorter(c) for product, c in _terms(e).items() if not vanishes(c)}


def distributed(e: sp.Expr) -> sp.Expr:
    """e as the sum of its `terms`."""
    return sp.Add(*(c * product for product, c in terms(e).items()))


def vanishes(c: sp.Expr) -> bool:
    """Whether an expression without fields is zero: as it stands, or as a sum at two points to 30 digits."""
    if not c.is_Add:
        return bool(c == 0)
    names = sorted(c.free_symbols, key=str)
    for shift in (sp.Rational(37, 101), sp.Rational(151, 97)):
        # evaluated, never substituted: an exact high power would take for ever
        point = {name: shift + sp.Rational(23 * k, 89) for k, name in enumerate(names)}
        values = [part.evalf(40, subs=point) for part in c.args]
        if abs(sp.Add(*values)) > sp.Float("1e-30") * sum(abs(x) for x in values):
            return False
    return True


def _shorter(c: sp.Expr) -> sp.Expr:
    if not c.has(sp.Add) or any(p.exp.is_number and abs(p.exp) > _MOST_EXPANDED for p in c.atoms(sp.Pow)):
        return c
    return min(c, sp.expand(c), key=sp.count_ops)


def _terms(e: sp.Expr) -> Terms:
    if not has_fields(e):
        return {sp.S.One: e}
    if e.is_Add:
        out: Terms = {}
        for part in e.args:
            for product, c in _terms(part).items():
                out[product] = out.get(product, sp.S.Zero) + c
        return out
    if e.is_Mul:
        out = {sp.S.One: sp.S.One}
        for factor in e.args:
            out = _times(out, _terms(factor))
        return out
    if e.is_Pow and e.exp.is_Integer and e.exp > 1 and e.base.is_Add:
        base = _terms(e.base)
        out = base
        for _ in range(int(e.exp) - 1):
            out = _times(out, base)
        return out
    return {e: sp.S.One}


def _times(left: Terms, right: Terms) -> Terms:
    out: Terms = {}
    for x, a in left.items():
        for y, b in right.items():
            out[x * y] = out.get(x * y, sp.S.Zero) + a * b
    return out
