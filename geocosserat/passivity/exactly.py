"""The value of an expression at a rational point, where that is a rational number that is plain to see."""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import Final

from geocosserat.model.expressions import Binary, Call, Expression, Negate, Number, Symbol
from geocosserat.passivity.balls import rational

_MOST_BITS: Final = 4096
_AT_ZERO: Final = {"sin": 0, "tan": 0, "tanh": 0, "sinh": 0, "cos": 1, "cosh": 1, "exp": 1}


def exact_value(
    e: Expression, point: Mapping[str, Fraction], seen: dict[int, Fraction | None] | None = None
) -> Fraction | None:
    """The value, None where it is not rational, has too many digits, or is not seen to be rational.

    Functions are known at zero, logarithms at one, roots of squares. ``seen``: values by the identity of parts, to be
    shared by expressions that are kept meanwhile.
    """
    known = {} if seen is None else seen
    if id(e) not in known:
        value = _value(e, point, known)
        short = value is not None and max(abs(value.numerator), value.denominator).bit_length() <= _MOST_BITS
        known[id(e)] = value if short else None
    return known[id(e)]


def _value(e: Expression, point: Mapping[str, Fraction], seen: dict[int, Fraction | None]) -> Fraction | None:
    match e:
        case Number(number):
            return None if number == math.pi else rational(number)
        case Symbol(name):
            return point[name]
        case Negate(operand):
            a = exact_value(operand, point, seen)
            return None if a is None else -a
        case Call(function, argument):
            a = exact_value(argument, point, seen)
            return None if a is None else _function(function, a)
        case Binary(mark, left, right):
            a, b = exact_value(left, point, seen), exact_value(right, point, seen)
            return None if a is None or b is None else _joined(mark, a, b)


def _function(function: str, a: Fraction) -> Fraction | None:
    match function:
        case "abs":
            return abs(a)
        case "heaviside":
            return Fraction(1, 2) if a == 0 else Fraction(int(a > 0))
        case "log":
            return Fraction(0) if a == 1 else None
        case "sqrt":
            if a < 0:
                return None
            root = Fraction(math.isqrt(a.numerator), math.isqrt(a.denominator))
            return root if root * root == a else None
        case _:
            return Fraction(_AT_ZERO[function]) if a == 0 else None


def _joined(mark: str, a: Fraction, b: Fraction) -> Fraction | None:
    match mark:
        case "+":
            return a + b
        case "-":
            return a - b
        case "*":
            return a * b
        case "/":
            return None if b == 0 else a / b
        case _:
            if b.denominator != 1 or (a == 0 and b < 0):
                return None
            bits = max(abs(a.numerator), a.denominator).bit_length()
            return None if bits * abs(b) > _MOST_BITS else a ** int(b)
