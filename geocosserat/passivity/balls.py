"""Rigorous numbers: expressions enclosed in Arb's balls, and integrals along loops.

Everything holds at the precision of ``flint.ctx``, in bits; what is returned encloses the exact value whatever that
precision is. F. Johansson, Arb: efficient arbitrary-precision midpoint-radius interval arithmetic, IEEE Trans. Comput.
66, 1281 (2017); F. Johansson, Numerical integration in arbitrary-precision ball arithmetic, ICMS 2018.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from fractions import Fraction
from functools import lru_cache
from typing import Any, Final

from flint import acb, arb, ctx, fmpq

from geocosserat.model.expressions import Binary, Call, Expression, ExpressionError, Negate, Number, Symbol, derivative

PARAMETER: Final = "s"
"""The name that runs along a path."""

_NOTHING: Final = acb(arb("nan"), arb("nan"))
_HALF: Final = Fraction(1, 2)
EVALUATIONS: Final = 10_000


def precision(bits: int) -> AbstractContextManager[Any]:
    """A context in which balls have that many bits."""
    context: AbstractContextManager[Any] = ctx.workprec(bits)
    return context


def rational(value: float | Fraction) -> Fraction:
    """The rational that the shortest decimal form of a number spells: 0.1 is 1/10."""
    return value if isinstance(value, Fraction) else Fraction(repr(float(value)))


def ball_of(value: float | Fraction) -> arb:
    """The ball around an exact number; pi is pi."""
    return arb.pi() if value == math.pi else arb(_quotient(value))


@lru_cache(maxsize=4096)
def _quotient(value: float | Fraction) -> fmpq:
    ratio = rational(value)
    return fmpq(ratio.numerator, ratio.denominator)


def ball(e: Expression, values: Mapping[str, arb]) -> arb:
    """An enclosure of ``e`` where its names have any of the values in these balls.

    Not a number where ``e`` has no value, or is not proved to have one, for some of them: a root or logarithm of
    what may be negative, a division by what may be zero. A step across which the ball reaches gives [0, 1]. Raises
    ExpressionError for a name without value.
    """
    value = complex_ball(e, {name: acb(x) for name, x in values.items()})
    return value.real if value.imag.is_zero() else arb("nan")


def complex_ball(e: Expression, values: Mapping[str, acb], analytic: bool = False) -> acb:
    """The same over complex balls, where ``e`` is continued from the real line.

    ``analytic``: not a number unless the continuation is analytic on these balls, as `flint.acb.integral` wants it.
    """
    return _value(e, values, analytic, {})


def _value(e: Expression, values: Mapping[str, acb], analytic: bool, seen: dict[int, acb]) -> acb:
    # derivatives share their parts: each is worked out once
    if (known := seen.get(id(e))) is not None:
        return known
    match e:
        case Number(number):
            value = acb(ball_of(number))
        case Symbol(name):
            if name not in values:
                raise ExpressionError(f"the name {name} has no value here; known: {' '.join(sorted(values))}")
            value = values[name]
        case Negate(operand):
            value = -_value(operand, values, analytic, seen)
        case Call(function, argument):
            value = function_value(function, _value(argument, values, analytic, seen), analytic)
        case Binary("**", base, exponent):
            power = exactly(exponent)
            value = _value(base, values, analytic, seen)
            if power is not None:
                value = power_value(value, power, analytic)
            else:
                value = general_power(value, _value(exponent, values, analytic, seen), analytic)
        case Binary(mark, left, right):
            a, b = _value(left, values, analytic, seen), _value(right, values, analytic, seen)
            value = a + b if mark == "+" else a - b if mark == "-" else a * b if mark == "*" else a / b
    seen[id(e)] = value
    return value


def exactly(e: Expression) -> Fraction | None:
    """The rational that an expression of numbers is, if it is one."""
    match e:
        case Number(value):
            return None if value == math.pi else rational(value)
        case Negate(operand):
            a = exactly(operand)
            return None if a is None else -a
        case Binary(mark, left, right):
            a, b = exactly(left), exactly(right)
            if a is None or b is None or mark == "**" or (mark == "/" and b == 0):
                return None
            return a + b if mark == "+" else a - b if mark == "-" else a * b if mark == "*" else a / b
    return None


def function_value(function: str, x: acb, analytic: bool = False) -> acb:
    """One of the functions of an expression over a ball."""
    real = bool(x.imag.is_zero())
    match function:
        case "sqrt":
            if real and not x.real >= 0:
                return _NOTHING
            return x.sqrt(analytic=analytic)
        case "log":
            if real and not x.real > 0:
                return _NOTHING
            return x.log(analytic=analytic)
        case "abs":
            return x.real_abs(analytic=analytic)
        case "heaviside":
            if x.real > 0:
                return acb(1)
            if x.real < 0:
                return acb(0)
            if x.is_zero() and not analytic:
                return acb(ball_of(_HALF))
            if analytic or not x.real.is_finite():
                return _NOTHING
            return acb(arb(0).union(arb(1)))
        case _:
            value: acb = getattr(x, function)()
            return value


def power_value(x: acb, power: Fraction, analytic: bool = False) -> acb:
    """x to a power that is known exactly: of any x if it is whole, else of x > 0, or of 0 to a positive power."""
    if power.denominator == 1:
        whole = _whole_power(x, abs(int(power)))
        return whole if power >= 0 else 1 / whole
    if x.is_zero() and power > 0 and not analytic:
        return acb(0)
    return general_power(x, acb(ball_of(power)), analytic)


def _whole_power(x: acb, n: int) -> acb:
    result, square = acb(1), x
    while n:
        if n & 1:
            result = result * square
        n >>= 1
        if n:
            square = square * square
    return result


def general_power(x: acb, power: acb, analytic: bool = False) -> acb:
    """x to any real power, for x > 0."""
    if x.imag.is_zero() and not x.real > 0:
        return _NOTHING
    return (power * x.log(analytic=analytic)).exp()


def integral(
    e: Expression,
    values: Mapping[str, arb] | None = None,
    low: Fraction | arb = Fraction(0),
    high: Fraction | arb = Fraction(1),
    tolerance: arb | None = None,
    evaluations: int = EVALUATIONS,
) -> arb:
    """An enclosure of the integral of ``e`` over its name ``s`` from low to high.

    Steps and kinks are found by bisection. Not a number where ``e`` is not proved to be defined on all of the way.
    ``tolerance``: absolute, 2 to the power of minus the precision if not given; a goal, not a promise. What
    ``evaluations`` of ``e`` do not settle widens the enclosure.
    """
    fixed = {name: acb(x) for name, x in (values or {}).items()}
    return _integrated(
        lambda s, analytic: complex_ball(e, {**fixed, PARAMETER: s}, analytic), low, high, tolerance, evaluations
    )


def line_integral(
    form: Mapping[str, Expression],
    path: Mapping[str, Expression],
    values: Mapping[str, arb] | None = None,
    low: Fraction | arb = Fraction(0),
    high: Fraction | arb = Fraction(1),
    tolerance: arb | None = None,
    evaluations: int = EVALUATIONS,
) -> arb:
    """An enclosure of the sum of the integrals of ``form[x] dx`` along a path, x = path[x](s), low <= s <= high.

    A coordinate that is in ``form`` but not in ``path`` keeps its value in ``values``.
    """
    fixed = {name: acb(x) for name, x in (values or {}).items()}
    speed = {name: derivative(way, PARAMETER) for name, way in path.items()}
    moving = [name for name in form if name in path and speed[name] != Number(0.0)]

    def work(s: acb, analytic: bool) -> acb:
        here = {PARAMETER: s}
        at = {**fixed, **{name: complex_ball(way, here, analytic) for name, way in path.items()}}
        seen: dict[int, acb] = {}
        total = acb(0)
        for name in moving:
            total += _value(form[name], at, analytic, seen) * complex_ball(speed[name], here, analytic)
        return total

    return _integrated(work, low, high, tolerance, evaluations)


def _integrated(
    f: Callable[[acb, bool], acb],
    low: Fraction | arb,
    high: Fraction | arb,
    tolerance: arb | None,
    evaluations: int,
) -> arb:
    a, b = (acb(end if isinstance(end, arb) else ball_of(end)) for end in (low, high))
    value = acb.integral(f, a, b, abs_tol=tolerance, rel_tol=tolerance, eval_limit=evaluations)
    return value.real if value.is_finite() else arb("nan")
