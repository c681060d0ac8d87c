"""The value of an expression at as many digits as mpmath is told to work with, and what rounding may do to it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import mpmath
from hypothesis import assume

from geocosserat.model.expressions import FUNCTIONS, Binary, Call, Expression, Negate, Number, Symbol

HUGE = 1e100
FUNCTION: dict[str, Any] = {name: getattr(mpmath, name) for name in FUNCTIONS if name not in ("abs", "heaviside")}
FUNCTION |= {"abs": abs, "heaviside": lambda x: mpmath.mpf((x > 0) + (x >= 0)) / 2}


def exactly(e: Expression, values: Mapping[str, Any]) -> tuple[mpmath.mpf, mpmath.mpf]:
    """The value at 60 digits and a bound on what rounding each operation to a double may do to it.

    What is ill-conditioned or huge on the way is assumed away.
    """
    value, error = _exactly(e, values)
    _assume(isinstance(value, mpmath.mpf) and abs(value) < HUGE and error < 1e-6 * (1 + abs(value)))
    return value, error


def _exactly(e: Expression, values: Mapping[str, Any]) -> tuple[mpmath.mpf, mpmath.mpf]:
    match e:
        case Number(value):
            return mpmath.mpf(value), mpmath.mpf(0)
        case Symbol(name):
            return mpmath.mpf(values[name]), mpmath.mpf(0)
        case Negate(operand):
            x, error = exactly(operand, values)
            return -x, error
        case Call(function, argument):
            x, error = exactly(argument, values)
            f = FUNCTION[function]
            y = f(x)
            # what the error of the argument does, seen on both sides of it
            spread = max(abs(f(x + side * error) - y) for side in (-1, 1))
            return y, 2 * spread + _rounding(y)
        case Binary(operator, left, right):
            (x, dx), (y, dy) = exactly(left, values), exactly(right, values)
            if operator in "+-":
                z = x + y if operator == "+" else x - y
                return z, dx + dy + _rounding(z)
            if operator == "*":
                return x * y, abs(x) * dy + abs(y) * dx + dx * dy + _rounding(x * y)
            if operator == "/":
                _assume(abs(y) > 2 * dy)
                return x / y, 2 * (dx + abs(x / y) * dy) / abs(y) + _rounding(x / y)
            _assume(abs(x) > 2 * dx and abs(y) < 1000 and (x > 0 or dy == 0))
            z = x**y
            grown = 2 * abs(z) * (abs(y) * dx / abs(x) + abs(mpmath.log(abs(x))) * dy)
            return z, grown + _rounding(z)


def _assume(condition: object) -> None:
    assume(bool(condition))


def _rounding(value: mpmath.mpf) -> mpmath.mpf:
    return 4 * abs(value) * mpmath.mpf(2) ** -53 + mpmath.mpf(2) ** -1070
