"""Symbolic expressions as they are read best, as expressions of a model, and their slopes."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from fractions import Fraction
from typing import Any, Final

import sympy as sp

from geocosserat.derivation.convert import exact
from geocosserat.model.expressions import Binary, Call, Expression, Negate, Number, Symbol
from geocosserat.passivity.normal import normal_forms
from geocosserat.passivity.polynomials import NoForm

_LONG: Final = 300
_MOST_EXPANDED: Final = 12
_CALLS: Final[dict[Any, str]] = {
    sp.sin: "sin", sp.cos: "cos", sp.tan: "tan", sp.exp: "exp", sp.log: "log", sp.tanh: "tanh", sp.sinh: "sinh",
    sp.cosh: "cosh", sp.Abs: "abs", sp.Heaviside: "heaviside",
}  # fmt: skip


def slope(e: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """The derivative in x; that of a step is zero, its jump is not seen."""
    signs: dict[sp.Dummy, sp.Expr] = {}

    def smooth(part: sp.Expr) -> sp.Expr:
        if not part.has(sp.Abs, sp.sign, sp.Heaviside):
            return part
        inner = part.func(*(smooth(a) for a in part.args)) if not isinstance(part, sp.Heaviside) else part
        if part.func in (sp.sign, sp.Heaviside, sp.Abs):
            argument = part.args[0]
            dummy = sp.Dummy(real=True)
            signs[dummy] = part.func(argument) if part.func is not sp.Abs else sp.sign(argument)
            return smooth(argument) * dummy if part.func is sp.Abs else dummy
        return inner

    result = sp.diff(smooth(e), x)
    for dummy, meaning in reversed(signs.items()):
        result = result.xreplace({dummy: meaning})
    return result


def large_powers(e: sp.Expr) -> bool:
    """Whether expanding an expression could make very many terms."""
    return any(p.exp.is_Integer and abs(p.exp) > _MOST_EXPANDED and p.base.is_Add for p in e.atoms(sp.Pow))


def readable(e: sp.Expr, positive: Collection[str] = ()) -> sp.Expr:
    """The shortest of several ways to write an expression."""
    if e.is_Atom or sp.count_ops(e) > 4 * _LONG:
        return e
    ways = [e, sp.factor_terms(e)]
    if sp.count_ops(e) < _LONG and not large_powers(e):
        ways.append(sp.expand(e))
        ways.append(sp.factor_terms(ways[-1]))
        hyperbolic = {f: sp.tanh(f.args[0]) * sp.cosh(f.args[0]) for f in e.atoms(sp.sinh) if e.has(sp.cosh(f.args[0]))}
        if hyperbolic:
            ways.append(sp.expand(e.xreplace(hyperbolic)))
        try:
            tower, [(top, bottom)] = normal_forms([e], positive, seconds=0.5, noting=False)
            if len(top) + len(bottom) < _LONG and not e.has(sp.tanh, sp.sinh, sp.cosh, sp.tan, sp.Heaviside):
                ways.append(tower.expression(top) / tower.expression(bottom))
        except NoForm:
            pass
    return min(ways, key=lambda w: (_denominators(w), sp.count_ops(w), len(str(w))))


def _denominators(e: sp.Expr) -> int:
    return sum(1 for p in sp.preorder_traversal(e) if p.is_Pow and p.exp.could_extract_minus_sign())


def to_expression(e: sp.Expr) -> Expression | None:
    """The same expression for a model, or None where a function or a number has no place there."""
    try:
        return _converted(e)
    except _NoPlace:
        return None


class _NoPlace(Exception):
    pass


def _converted(e: sp.Expr) -> Expression:
    if e.is_Symbol:
        return Symbol(e.name)
    if e.is_Rational:
        return _number(Fraction(int(e.p), int(e.q)))
    if e is sp.pi:
        return Number(math.pi)
    if e is sp.E:
        return Call("exp", Number(1.0))
    if e.is_Add:
        return _sum(e.as_ordered_terms())
    if e.is_Mul:
        return _product(e)
    if e.is_Pow:
        return _power(e.base, e.exp)
    if e.func is sp.sign:
        return Binary("-", Binary("*", Number(2.0), Call("heaviside", _converted(e.args[0]))), Number(1.0))
    if e.func in _CALLS:
        return Call(_CALLS[e.func], _converted(e.args[0]))
    raise _NoPlace


def _number(value: Fraction) -> Expression:
    number = float(value)
    if exact(number) == sp.Rational(value.numerator, value.denominator):
        return Number(number)
    if value.denominator != 1:
        return Binary("/", _number(Fraction(value.numerator)), _number(Fraction(value.denominator)))
    raise _NoPlace


def _sum(terms: Sequence[sp.Expr]) -> Expression:
    total: Expression | None = None
    for term in terms:
        negative = term.could_extract_minus_sign()
        part = _converted(-term if negative else term)
        if total is None:
            total = Negate(part) if negative and not isinstance(part, Number) else -part if negative else part
        else:
            total = Binary("-" if negative else "+", total, part)
    if total is None:
        raise _NoPlace
    return total


def _product(e: sp.Expr) -> Expression:
    number, rest = e.as_coeff_Mul()
    if number < 0:
        return Negate(_converted(-e))
    top: list[Expression] = [] if number.p == 1 else [_number(Fraction(int(number.p)))]
    bottom: list[Expression] = [] if number.q == 1 else [_number(Fraction(int(number.q)))]
    if number.p != 1 and number.q != 1:
        top, bottom = [_number(Fraction(int(number.p), int(number.q)))], []
    for factor in sp.Mul.make_args(rest):
        if factor.is_Pow and factor.exp.is_Rational and factor.exp < 0:
            bottom.append(_converted(1 / factor))
        else:
            top.append(_converted(factor))
    result = _times(top) if top else Number(1.0)
    return Binary("/", result, _times(bottom)) if bottom else result


def _times(factors: Sequence[Expression]) -> Expression:
    result = factors[0]
    for factor in factors[1:]:
        result = Binary("*", result, factor)
    return result


def _power(base: sp.Expr, exponent: sp.Expr) -> Expression:
    if base is sp.E:
        return Call("exp", _converted(exponent))
    if exponent == sp.S.Half:
        return Call("sqrt", _converted(base))
    if exponent.is_Rational and exponent < 0:
        return Binary("/", Number(1.0), _power(base, -exponent) if exponent != -1 else _converted(base))
    return Binary("**", _converted(base), _converted(exponent))
