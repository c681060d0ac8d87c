"""Symbolic expressions enclosed in Arb's balls at points where they are smooth."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, Final

import sympy as sp
from flint import acb, arb, fmpq

from geocosserat.passivity.balls import function_value, power_value

_KNOWN: Final[dict[Any, str]] = {
    sp.sin: "sin", sp.cos: "cos", sp.tan: "tan", sp.exp: "exp", sp.log: "log", sp.tanh: "tanh", sp.sinh: "sinh",
    sp.cosh: "cosh", sp.Abs: "abs", sp.atan: "atan", sp.asinh: "asinh", sp.cot: "cot", sp.sec: "sec", sp.csc: "csc",
    sp.coth: "coth", sp.sech: "sech", sp.csch: "csch",
}  # fmt: skip


def enclosure(e: sp.Expr, values: Mapping[str, arb], seen: dict[sp.Expr, arb]) -> arb:
    """An enclosure of ``e``; not a number where it is not proved to be defined, or lies on a step or at a root of zero.

    ``seen``: what was worked out already at this point and precision. Raises TypeError for what is no real function of
    the known kinds, and KeyError for a symbol without value.
    """
    if (known := seen.get(e)) is not None:
        return known
    value = _enclosed(e, values, seen)
    seen[e] = value
    return value


def _enclosed(e: sp.Expr, values: Mapping[str, arb], seen: dict[sp.Expr, arb]) -> arb:
    if e.is_Symbol:
        return values[e.name]
    if e.is_Rational:
        return arb(fmpq(int(e.p), int(e.q)))
    if e is sp.pi:
        return arb.pi()
    if e is sp.E:
        return arb(1).exp()
    parts = [enclosure(a, values, seen) for a in e.args]
    if e.is_Add:
        total = arb(0)
        for part in parts:
            total = total + part
        return total
    if e.is_Mul:
        product = arb(1)
        for part in parts:
            product = product * part
        return product
    if e.is_Pow:
        if e.exp.is_Integer:
            return power_value(acb(parts[0]), Fraction(int(e.exp.p))).real
        if not parts[0] > 0:
            return arb("nan")
        return parts[0].sqrt() if e.exp == sp.S.Half else (parts[1] * parts[0].log()).exp()
    if e.func is sp.DiracDelta:
        return arb("nan") if parts[0].contains(0) else arb(0)
    if e.func in (sp.sign, sp.Heaviside):
        if parts[0].contains(0):
            return arb("nan")
        return arb(1) if parts[0] > 0 else arb(-1 if e.func is sp.sign else 0)
    if e.func in _KNOWN:
        value = function_value(_KNOWN[e.func], acb(parts[0]))
        return value.real if value.imag.is_zero() else arb("nan")
    raise TypeError(f"expected a real function of known kinds, found {e.func}")
