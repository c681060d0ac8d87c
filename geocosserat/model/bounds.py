"""Between which numbers an expression lies while its names run over intervals: of many intervals at once.

Samples may all miss a narrow feature; bounds cannot. Ends are computed in double precision and not rounded outwards.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from geocosserat.model.evaluation import evaluate
from geocosserat.model.tree import Binary, Call, Expression, Negate, Number, Symbol

Array: TypeAlias = NDArray[np.float64]
Interval: TypeAlias = tuple[Array, Array]
"""Lower and upper ends, of one interval or of many."""


def bounds(e: Expression, ranges: Mapping[str, Interval | float]) -> Interval:
    """Ends between which ``e`` lies, where each name lies in its interval or is a number.

    Infinite where nothing is known: beside poles, and where ``e`` may not be defined. ``heaviside`` lies between 0
    and 1 on an interval with its step, and is constant on others.
    """
    with np.errstate(all="ignore"):
        return _bounds(e, ranges)


def _bounds(e: Expression, ranges: Mapping[str, Interval | float]) -> Interval:
    match e:
        case Symbol(name):
            found = ranges[name]
            return found if isinstance(found, tuple) else _one(found)
        case Number(value):
            return _one(value)
        case Negate(operand):
            low, high = _bounds(operand, ranges)
            return -high, -low
        case Call(function, argument):
            return _known(*_call(function, _bounds(argument, ranges)))
        case Binary("**", base, Number(n)) if n == int(n):
            return _known(*_whole_power(_bounds(base, ranges), int(n)))
        case Binary(mark, left, right):
            return _known(*_JOINED[mark](_bounds(left, ranges), _bounds(right, ranges)))


def _one(x: float) -> Interval:
    return np.asarray(x, dtype=np.float64), np.asarray(x, dtype=np.float64)


def _known(low: Array, high: Array) -> Interval:
    """All numbers where one of the ends is none."""
    lost = np.isnan(low) | np.isnan(high)
    return np.where(lost, -np.inf, low), np.where(lost, np.inf, high)


def _hull(*ends: Array) -> Interval:
    """From the least to the largest; none where one of them is none."""
    low = high = ends[0]
    for x in ends[1:]:
        low, high = np.minimum(low, x), np.maximum(high, x)
    return low, high


def _call(function: str, x: Interval) -> Interval:
    low, high = x
    match function:
        case "abs" | "cosh":
            near = np.where(low * high <= 0.0, 0.0, np.minimum(abs(low), abs(high)))
            far = np.maximum(abs(low), abs(high))
            return (near, far) if function == "abs" else (np.cosh(near), np.cosh(far))
        case "sin":
            return _cosine((low - np.pi / 2, high - np.pi / 2))
        case "cos":
            return _cosine(x)
        case "tan":
            poles = np.floor(high / np.pi + 0.5) - np.floor(low / np.pi + 0.5)
            return np.where(poles == 0.0, np.tan(low), np.nan), np.where(poles == 0.0, np.tan(high), np.nan)
        case _:  # the others rise
            rising = Call(function, Symbol("x"))
            return (np.asarray(evaluate(rising, {"x": low})), np.asarray(evaluate(rising, {"x": high})))


def _cosine(x: Interval) -> Interval:
    low, high = x
    turns = 2.0 * np.pi
    least, most = _hull(np.cos(low), np.cos(high))
    most = np.where(np.floor(high / turns) > np.floor(low / turns), 1.0, most)
    least = np.where(np.floor(high / turns + 0.5) > np.floor(low / turns + 0.5), -1.0, least)
    wide = ~(high - low < turns)  # infinite ones, too
    return np.where(wide, -1.0, least), np.where(wide, 1.0, most)


def _whole_power(x: Interval, n: int) -> Interval:
    low, high = x
    if n < 0:
        return _quotient(_one(1.0), _whole_power(x, -n))
    if n % 2 == 0:
        low, high = _call("abs", x)
    return low**n, high**n


def _product(x: Interval, y: Interval) -> Interval:
    return _hull(x[0] * y[0], x[0] * y[1], x[1] * y[0], x[1] * y[1])


def _quotient(x: Interval, y: Interval) -> Interval:
    safe = np.where((y[0] > 0.0) | (y[1] < 0.0), 1.0, np.nan)
    return _product(x, (safe / y[1], safe / y[0]))


def _power(x: Interval, y: Interval) -> Interval:
    """y log x is largest, and least, in a corner."""
    return _hull(x[0] ** y[0], x[0] ** y[1], x[1] ** y[0], x[1] ** y[1])


_JOINED: dict[str, Callable[[Interval, Interval], Interval]] = {
    "+": lambda x, y: (x[0] + y[0], x[1] + y[1]),
    "-": lambda x, y: (x[0] - y[1], x[1] - y[0]),
    "*": _product,
    "/": _quotient,
    "**": _power,
}
