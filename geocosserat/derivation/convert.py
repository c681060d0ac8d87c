"""Scene expressions as exact symbolic ones: decimals become rationals, so that terms cancel exactly."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import sympy as sp

from geocosserat.derivation.notation import symbol
from geocosserat.model.expressions import (
    Binary,
    Call,
    Expression,
    ExpressionError,
    Negate,
    Number,
    Symbol,
    to_text,
)

# far beyond the range of doubles (1074 bits), far below what would take time
_MOST_BITS = 4096

_FUNCTION: dict[str, Any] = {
    "sin": sp.sin, "cos": sp.cos, "tan": sp.tan, "exp": sp.exp, "log": sp.log, "sqrt": sp.sqrt,
    "tanh": sp.tanh, "sinh": sp.sinh, "cosh": sp.cosh, "abs": sp.Abs, "heaviside": sp.Heaviside,
}  # fmt: skip


def to_sympy(e: Expression) -> sp.Expr:
    """The same expression in exact numbers and real symbols; ``heaviside(0)`` is 1/2.

    Raises ExpressionError where the exact value is infinite, undefined or not real, or a power is out of the
    range of doubles (it would otherwise be computed to its last digit).
    """
    converted = _convert(e)
    if converted.has(sp.zoo, sp.nan, sp.oo, -sp.oo, sp.I):
        raise ExpressionError(
            f"expected a finite real expression, found {to_text(e)}, which is {converted}; "
            f"remove the division by zero or the root or logarithm of a negative number"
        )
    return converted


def exact(value: float) -> sp.Expr:
    """The rational that the shortest decimal form of a finite number spells, so 0.1 is 1/10; pi stays pi."""
    if value == math.pi:
        return sp.pi
    ratio = Fraction(repr(float(value)))
    return sp.Rational(ratio.numerator, ratio.denominator)


def _convert(e: Expression) -> sp.Expr:
    match e:
        case Number(value):
            return exact(value)
        case Symbol(name):
            return symbol(name)
        case Negate(operand):
            return -_convert(operand)
        case Call(function, argument):
            return _call(function, _convert(argument), e)
        case Binary(operator, left, right):
            a, b = _convert(left), _convert(right)
            match operator:
                case "+":
                    return a + b
                case "-":
                    return a - b
                case "*":
                    return a * b
                case "/":
                    return a / b
                case "**":
                    return _power(a, b, e)


def _call(function: str, argument: sp.Expr, e: Expression) -> sp.Expr:
    # exp(n*log(k)) becomes the power k**n of its own accord
    if function == "exp" and argument.is_number and argument.has(sp.log) and abs(argument.evalf()) > 745:
        raise _out_of_range(e)
    return _FUNCTION[function](argument)


def _power(base: sp.Expr, exponent: sp.Expr, e: Expression) -> sp.Expr:
    if base.is_Rational and exponent.is_Rational and base not in (0, 1, -1):
        bits = max(int(base.p).bit_length(), int(base.q).bit_length())
        if abs(exponent) * bits > _MOST_BITS:
            raise _out_of_range(e)
    return base**exponent


def _out_of_range(e: Expression) -> ExpressionError:
    return ExpressionError(
        f"expected numbers in the range of doubles, found {to_text(e)}; write a smaller exponent"
    )
