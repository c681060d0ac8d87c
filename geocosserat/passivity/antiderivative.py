"""Antiderivatives by rules that cannot run away; the caller differentiates back.

Terms one by one: powers, functions of what is linear, products with polynomials by parts, substitutions, products of
sines, exponentials; what is rational last. None where no rule fits.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any, Final

import sympy as sp
from sympy.simplify.fu import TR8

from geocosserat.passivity.readable import large_powers

_MOST_OPERATIONS: Final = 400
_MOST_DEPTH: Final = 6
_MOST_DEGREE: Final = 40
_SECONDS: Final = 3.0

_OF_FUNCTION: Final[dict[Any, Any]] = {
    sp.sin: lambda z: -sp.cos(z),
    sp.cos: sp.sin,
    sp.tan: lambda z: -sp.log(sp.Abs(sp.cos(z))),
    sp.exp: sp.exp,
    sp.log: lambda z: z * sp.log(z) - z,
    sp.sinh: sp.cosh,
    sp.cosh: sp.sinh,
    sp.tanh: lambda z: sp.log(sp.cosh(z)),
    sp.Abs: lambda z: z * sp.Abs(z) / 2,
    sp.sign: sp.Abs,
    sp.Heaviside: lambda z: z * sp.Heaviside(z),
    sp.atan: lambda z: z * sp.atan(z) - sp.log(1 + z**2) / 2,
}


@dataclass(frozen=True)
class Search:
    """How deep a search is, and until when (of the monotonic clock) it may go on."""

    depth: int
    until: float

    @property
    def deeper(self) -> Search:
        return Search(self.depth + 1, self.until)

    @property
    def over(self) -> bool:
        return self.depth > _MOST_DEPTH or time.monotonic() > self.until


def antiderivative(e: sp.Expr, x: sp.Symbol, search: Search | None = None) -> sp.Expr | None:
    """An expression whose derivative in x is ``e``, or None if none is found (in three seconds)."""
    search = search or Search(0, time.monotonic() + _SECONDS)
    if not e.has(x):
        return e * x
    if search.over or (search.depth == 0 and sp.count_ops(e) > 20 * _MOST_OPERATIONS):
        return None
    if e.is_Add:
        return _terms(e, x, search)
    factor, rest = e.as_independent(x, as_Add=False)
    if factor != 1:
        inner = antiderivative(rest, x, search)
        return None if inner is None else factor * inner
    for rule in _FEW_RULES if large_powers(rest) else _RULES:
        if (found := rule(rest, x, search)) is not None:
            return found
    return None


def _terms(e: sp.Expr, x: sp.Symbol, search: Search) -> sp.Expr | None:
    parts = [antiderivative(term, x, search) for term in e.args]
    if all(part is not None for part in parts):
        return sp.Add(*parts)
    # what no rule fits alone may fit together
    others = [sp.together(e), sp.expand(e)] if sp.count_ops(e) < _MOST_OPERATIONS and not large_powers(e) else []
    for other in others:
        if other != e and not other.is_Add and (found := antiderivative(other, x, search.deeper)) is not None:
            return found
    return _substituted(e, x, search)


def _slope(z: sp.Expr, x: sp.Symbol) -> sp.Expr | None:
    """The slope of what is linear in x."""
    slope = sp.diff(z, x)
    return None if slope.has(x) or slope == 0 else slope


def _simple(e: sp.Expr, x: sp.Symbol, search: Search) -> sp.Expr | None:
    """A power of what is linear, or a function of it."""
    if e == x:
        return x**2 / 2
    if e.is_Pow and not e.exp.has(x) and (slope := _slope(e.base, x)) is not None:
        if e.exp == -1:
            return sp.log(sp.Abs(e.base)) / slope
        if (e.exp + 1).is_zero is False or e.exp.is_Rational:
            return e.base ** (e.exp + 1) / (e.exp + 1) / slope
        return None
    if e.func in _OF_FUNCTION and (slope := _slope(e.args[0], x)) is not None:
        return _OF_FUNCTION[e.func](e.args[0]) / slope
    if e.is_Pow and e.exp.is_Integer and (slope := _slope(e.base.args[0], x) if e.base.args else None) is not None:
        return _power_of_function(e.base.func, e.base.args[0], int(e.exp), slope)
    return None


def _power_of_function(function: Any, z: sp.Expr, n: int, slope: sp.Expr) -> sp.Expr | None:
    """tanh, tan to a power; cosh, cos to the power -2."""
    if function in (sp.tanh, sp.tan) and 2 <= n <= 12:
        sign = 1 if function is sp.tanh else -1
        if n > 3:
            lower = _power_of_function(function, z, n - 2, slope)
        else:
            lower = (z if n == 2 else _OF_FUNCTION[function](z)) / slope
        return None if lower is None else sign * lower - sign * function(z) ** (n - 1) / (n - 1) / slope
    if n == -2 and function in (sp.cosh, sp.cos):
        return (sp.tanh if function is sp.cosh else sp.tan)(z) / slope
    if n == -1 and function is sp.cosh:
        return 2 * sp.atan(sp.tanh(z / 2)) / slope
    return None


def _power_of_modulus(e: sp.Expr, x: sp.Symbol, search: Search) -> sp.Expr | None:
    """z**m |z|**q for what is linear."""
    for factor in sp.Mul.make_args(e):
        base, q = factor.as_base_exp()
        if base.func is sp.Abs and q.is_Rational and (slope := _slope(base.args[0], x)) is not None:
            z = base.args[0]
            other, m = (e / factor).as_base_exp() if e != factor else (z, sp.S.Zero)
            if other == z and m.is_Integer and m + q + 1 != 0 and m >= 0:
                return z ** (m + 1) * base**q / (m + q + 1) / slope
    return None


def _of_polynomial(e: sp.Expr, x: sp.Symbol, search: Search) -> sp.Expr | None:
    if not e.is_polynomial(x) or sp.degree(e, x) > _MOST_DEGREE:
        return None
    return sp.Add(*(c * x ** (n + 1) / (n + 1) for (n,), c in sp.Poly(e, x).terms()))


def _step(e: sp.Expr, x: sp.Symbol, search: Search) -> sp.Expr | None:
    """A step or modulus of what is linear times something: continuous across the step."""
    for factor in sp.Mul.make_args(e):
        if factor.func in (sp.Heaviside, sp.Abs, sp.sign) and (slope := _slope(factor.args[0], x)) is not None:
            z = factor.args[0]
            rest = e / factor * (z if factor.func is sp.Abs else 1)
            inner = antiderivative(rest, x, search.deeper) if rest.has(x) else rest * x
            if inner is None:
                return None
            at_step = inner.subs(x, sp.expand(x - z / slope))
            if at_step.has(sp.zoo, sp.nan, sp.oo):
                return None
            turned = sp.Heaviside(z) if factor.func is sp.Heaviside else sp.sign(z)
            return turned * (inner - at_step)
    return None


def _by_parts(e: sp.Expr, x: sp.Symbol, search: Search) -> sp.Expr | None:
    """A polynomial times exp, sin, cos, sinh, cosh or log of what is linear."""
    polynomial, others = sp.S.One, []
    for factor in sp.Mul.make_args(e):
        if factor.is_polynomial(x):
            polynomial *= factor
        else:
            others.append(factor)
    if len(others) != 1 or others[0].func not in (sp.exp, sp.sin, sp.cos, sp.sinh, sp.cosh, sp.log, sp.atan):
        return None
    function = others[0]
    if function.func in (sp.log, sp.atan):
        whole = antiderivative(polynomial, x, search.deeper)
        if whole is None or _slope(function.args[0], x) is None:
            return None
        rest = antiderivative(sp.together(whole * sp.diff(function, x)), x, search.deeper)
        return None if rest is None else whole * function - rest
    if _slope(function.args[0], x) is None or sp.degree(polynomial, x) > _MOST_DEGREE:
        return None
    total, sign, inner = sp.S.Zero, 1, function
    while polynomial != 0:
        inner = _simple_with_factor(inner, x)
        total += sign * polynomial * inner
        polynomial, sign = sp.diff(polynomial, x), -sign
    return total


def _simple_with_factor(e: sp.Expr, x: sp.Symbol) -> sp.Expr:
    factor, rest = e.as_independent(x, as_Add=False)
    return factor * _simple(rest, x, Search(0, 0.0))


def _squares(e: sp.Expr, x: sp.Symbol, search: Search) -> sp.Expr | None:
    """sqrt(a*x**2 + b*x + c), alone or below one."""
    if not (e.is_Pow and abs(e.exp) == sp.S.Half and e.base.is_polynomial(x) and sp.degree(e.base, x) == 2):
        return None
    a, b, c = sp.Poly(e.base, x).all_coeffs()
    if not a.is_positive:
        return None
    root = sp.sqrt(e.base)
    logarithm = sp.log(2 * sp.sqrt(a) * root + 2 * a * x + b) / sp.sqrt(a)
    if e.exp < 0:
        return logarithm
    return (2 * a * x + b) / (4 * a) * root + (4 * a * c - b**2) / (8 * a) * logarithm


def _substituted(e: sp.Expr, x: sp.Symbol, search: Search) -> sp.Expr | None:
    """g(z) dz/dx for a part z of the expression."""
    if sp.count_ops(e) > _MOST_OPERATIONS:
        return None
    w = sp.Dummy("w", real=True)
    for z in _parts(e, x):
        if search.over:
            return None
        slope = sp.diff(z, x)
        if slope == 0:
            continue
        rest = _cancelled(e.subs(z, w) if z.is_Function else e.xreplace({z: w}).subs(z, w), slope.subs(z, w), x)
        if rest is None or rest.has(x):
            continue
        inner = antiderivative(rest, w, search.deeper)
        if inner is not None:
            return inner.subs(w, z)
    return None


def _cancelled(e: sp.Expr, slope: sp.Expr, x: sp.Symbol) -> sp.Expr | None:
    ratio = e / slope
    if not ratio.has(x):
        return ratio
    if sp.count_ops(ratio) > _MOST_OPERATIONS:
        return None
    try:
        return sp.cancel(ratio)
    except (sp.PolynomialError, NotImplementedError):
        return None


def _parts(e: sp.Expr, x: sp.Symbol) -> list[sp.Expr]:
    """Functions, what they and powers are of, and bases, the largest first."""
    found: set[sp.Expr] = set()
    for part in e.atoms(sp.Function):
        if part.has(x):
            found |= {part, *(a for a in part.args if a.has(x))}
    for part in e.atoms(sp.Pow):
        if part.base.has(x):
            found.add(part.base)
            if part.exp == 2 or not part.exp.is_Integer:
                found.add(part)
    found -= {x, e}
    return sorted(found, key=lambda p: (-sp.count_ops(p), str(p)))[:12]


def _expanded(e: sp.Expr, x: sp.Symbol, search: Search) -> sp.Expr | None:
    other = sp.powsimp(sp.expand(e, trig=False)) if sp.count_ops(e) < _MOST_OPERATIONS else e
    other = other if not other.is_Add else sp.Add(*(sp.powsimp(t) for t in other.args))
    return antiderivative(other, x, search.deeper) if other != e else None


def _products(e: sp.Expr, x: sp.Symbol, search: Search) -> sp.Expr | None:
    """Products of sines as sums, products of exponentials as one."""
    if sp.count_ops(e) > _MOST_OPERATIONS:
        return None
    if e.has(sp.sinh, sp.cosh) and not e.has(sp.tanh):
        other = sp.expand(e.rewrite(sp.exp))
        other = sp.Add(*(sp.powsimp(t) for t in sp.Add.make_args(other)))
        found = antiderivative(other, x, search.deeper) if other != e else None
        if found is not None:
            return found
    if e.has(sp.sin, sp.cos):
        other = sp.expand(TR8(sp.expand(e)))
        if other != e:
            return antiderivative(other, x, search.deeper)
    return None


def _rational(e: sp.Expr, x: sp.Symbol, search: Search) -> sp.Expr | None:
    """What is rational in x with denominators of a low degree, by partial fractions."""
    if not e.is_rational_function(x) or sp.count_ops(e) > _MOST_OPERATIONS:
        return None
    top, bottom = sp.fraction(sp.together(e))
    if not bottom.has(x) or sp.degree(bottom, x) > 8 or sp.degree(top, x) > _MOST_DEGREE:
        return None
    if sp.degree(bottom, x) == 2 and sp.degree(top, x) < 2:
        return _over_quadratic(top, bottom, x)
    parts = sp.apart(e, x)
    if parts != e and (parts.is_Add or search.depth < _MOST_DEPTH):
        return antiderivative(parts, x, search.deeper)
    return None


def _over_quadratic(top: sp.Expr, bottom: sp.Expr, x: sp.Symbol) -> sp.Expr | None:
    """(p*x + q) / (a*x**2 + b*x + c) by a logarithm, and an arctangent if c is large enough."""
    a, b, c = sp.Poly(bottom, x).all_coeffs()
    p, q = sp.diff(top, x), top.subs(x, 0)
    part = p / (2 * a) * sp.log(sp.Abs(bottom))
    left = sp.cancel(q - p * b / (2 * a))
    if left == 0:
        return part
    square = sp.factor(4 * a * c - b**2)
    if square.is_nonpositive:
        if square == 0:
            return part - left * 2 / (2 * a * x + b)
        root = sp.sqrt(-square)
        return part + left / root * sp.log(sp.Abs((2 * a * x + b - root) / (2 * a * x + b + root)))
    root = sp.sqrt(square)
    root = root.replace(sp.Abs, lambda z: z)  # the quotient below is even in it
    return part + 2 * left / root * sp.atan((2 * a * x + b) / root)


_FEW_RULES: Final = (_simple, _power_of_modulus, _step, _substituted)
_RULES: Final = (
    _simple, _power_of_modulus, _of_polynomial, _step, _by_parts, _squares, _substituted, _expanded, _products,
    _rational,
)  # fmt: skip
