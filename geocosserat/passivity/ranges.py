"""Bounds of an expression over a box of values, which may reach to infinity."""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import Any, Final, TypeAlias

from flint import arb

from geocosserat.model.expressions import Binary, Call, Expression, Negate, Number, Symbol, symbols
from geocosserat.passivity.balls import ball_of, precision, rational

End: TypeAlias = Fraction | float
"""A rational number, or an infinite float."""
Range: TypeAlias = tuple[End, End]

ALL: Final[Range] = (-math.inf, math.inf)
_BOXES: Final = 240
_LONG: Final = 160
_HUGE: Final = Fraction(10) ** 300
_LARGEST: Final = Fraction(10) ** 1000


def bounds(e: Expression, box: Mapping[str, Range]) -> Range | None:
    """Numbers between which ``e`` lies wherever its names lie in their ranges (anywhere, for names without one).

    None where it is not proved to be defined everywhere.
    """
    with precision(80):
        return _range(e, box)


def sign_on(e: Expression, box: Mapping[str, Range]) -> int:
    """1 or -1 if ``e`` is proved to be defined, and above or below zero, on all of a box; else 0."""
    inside = symbols(e)
    names = [name for name, (low, high) in box.items() if low < high and name in inside]
    waiting, met = [dict(box)], set[int]()
    for _ in range(_BOXES):
        if not waiting:
            return met.pop()
        part = waiting.pop()
        found = bounds(e, part)
        if found is not None and (found[0] > 0 or found[1] < 0):
            met.add(1 if found[0] > 0 else -1)
            if len(met) > 1:
                return 0
            continue
        if not names or (found is not None and found[0] == found[1]):
            return 0
        name = max(names, key=lambda n: _width(part[n]))
        low, high = part[name]
        middle = _middle(low, high)
        waiting += [{**part, name: (low, middle)}, {**part, name: (middle, high)}]
    return 0


def _endless(x: End) -> bool:
    return isinstance(x, float)


def _width(r: Range) -> float:
    low, high = (math.atan(float(max(min(x, _HUGE), -_HUGE))) for x in r)
    return high - low


def _middle(low: End, high: End) -> Fraction:
    if _endless(low) and _endless(high):
        return Fraction(0)
    if _endless(high):
        return max(Fraction(1), 2 * Fraction(low))
    if _endless(low):
        return min(Fraction(-1), 2 * Fraction(high))
    return (Fraction(low) + Fraction(high)) / 2


def _range(e: Expression, box: Mapping[str, Range]) -> Range | None:
    match e:
        case Number(value):
            return _around(arb.pi()) if value == math.pi else (rational(value), rational(value))
        case Symbol(name):
            return box.get(name, ALL)
        case Negate(operand):
            a = _range(operand, box)
            return None if a is None else (-a[1], -a[0])
        case Call(function, argument):
            a = _range(argument, box)
            return None if a is None else _call(function, a)
        case Binary(mark, left, right):
            a, b = _range(left, box), _range(right, box)
            if a is None or b is None:
                return None
            return _joined(mark, a, b, left == right)


def _joined(mark: str, a: Range, b: Range, same: bool) -> Range | None:
    match mark:
        case "+":
            return _rounded(a[0] + b[0], a[1] + b[1])
        case "-":
            return (Fraction(0), Fraction(0)) if same and not _infinite(a) else _rounded(a[0] - b[1], a[1] - b[0])
        case "*":
            return _power(a, 2) if same else _product(a, b)
        case "/":
            inverse = _inverse(b)
            return None if inverse is None else _product(a, inverse)
    if b[0] == b[1] and not _endless(b[0]):
        power = Fraction(b[0])
        if power.denominator == 1 and abs(power) <= 64:
            whole = _power(a, abs(int(power)))
            return whole if power >= 0 else _inverse(whole)
        if power == Fraction(1, 2):
            return _call("sqrt", a)
    logarithm = _call("log", a)
    return None if logarithm is None else _call("exp", _product(logarithm, b))


def _infinite(a: Range) -> bool:
    return _endless(a[0]) or _endless(a[1])


def _times(x: End, y: End) -> End:
    # what is infinite is a bound, not a value: zero times it is zero
    return Fraction(0) if x == 0 or y == 0 else x * y


def _product(a: Range, b: Range) -> Range:
    ends = [_times(x, y) for x in a for y in b]
    return _rounded(min(ends), max(ends))


def _inverse(a: Range) -> Range | None:
    if a[0] <= 0 <= a[1]:
        return None
    return _rounded(_one_over(a[1]), _one_over(a[0]))


def _one_over(x: End) -> Fraction:
    return Fraction(0) if _endless(x) else 1 / Fraction(x)


def _power(a: Range, n: int) -> Range:
    ends = [x**n if _endless(x) else Fraction(x) ** n for x in a]
    if n == 0:
        return Fraction(1), Fraction(1)
    if n % 2 == 0 and a[0] <= 0 <= a[1]:
        return _rounded(Fraction(0), max(ends))
    return _rounded(min(ends), max(ends))


def _rounded(low: End, high: End) -> Range:
    """Outward, where rationals have grown long or large."""
    low = -math.inf if low < -_LARGEST else low if low < _LARGEST else _LARGEST
    high = math.inf if high > _LARGEST else high if high > -_LARGEST else -_LARGEST
    if any(isinstance(x, Fraction) and x.denominator.bit_length() > _LONG for x in (low, high)):
        low = low if _endless(low) else _around(ball_of(Fraction(low)))[0]
        high = high if _endless(high) else _around(ball_of(Fraction(high)))[1]
    return low, high


def _around(x: arb) -> Range:
    def exact(y: arb) -> Fraction:
        ratio: Any = y.fmpq()
        return Fraction(int(ratio.p), int(ratio.q))

    return (exact(x.lower()), exact(x.upper())) if x.is_finite() else ALL


def _call(function: str, a: Range) -> Range | None:
    low, high = a
    match function:
        case "sin" | "cos":
            if _infinite(a) or high - low > 4:
                return Fraction(-1), Fraction(1)
            return _clipped(_of_ball(function, a))
        case "tan":
            if _infinite(a) or (of := _of_ball("tan", a)) is None or _infinite(of):
                return None
            return of
        case "abs":
            if low >= 0 or high <= 0:
                return (low, high) if low >= 0 else (-high, -low)
            return Fraction(0), max(-low, high)
        case "heaviside":
            return Fraction(low > 0), Fraction(high >= 0)
        case "cosh":
            small, large = _call("abs", a) or a
            return _end("cosh", small)[0], _end("cosh", large)[1]
        case "sqrt" if low < 0:
            return None
        case "log" if low <= 0:
            return None
    return _end(function, low)[0], _end(function, high)[1]


_AT_INFINITY: Final[dict[str, tuple[End, End]]] = {
    "exp": (Fraction(0), math.inf),
    "tanh": (Fraction(-1), Fraction(1)),
}


def _end(function: str, x: End) -> Range:
    """A growing function at an end."""
    if _endless(x):
        low, high = _AT_INFINITY.get(function, ALL)
        value = high if x > 0 else low
        return value, value
    at = Fraction(x)
    if function == "exp" and abs(at) > 10_000:
        return (_HUGE, math.inf) if at > 0 else (Fraction(0), 1 / _HUGE)
    if function in ("sinh", "cosh") and abs(at) > 10_000:
        return (_HUGE, math.inf) if at > 0 else (-math.inf, -_HUGE)
    return _around(getattr(ball_of(at), function)())


def _of_ball(function: str, a: Range) -> Range | None:
    ball = ball_of(Fraction(a[0])).union(ball_of(Fraction(a[1])))
    value = getattr(ball, function)()
    return _around(value) if value.is_finite() else None


def _clipped(a: Range | None) -> Range:
    if a is None:
        return Fraction(-1), Fraction(1)
    return max(Fraction(-1), a[0]), min(Fraction(1), a[1])
