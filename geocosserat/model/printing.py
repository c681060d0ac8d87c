"""Expressions as text, with no more parentheses than needed to read it."""

from __future__ import annotations

import math

from geocosserat.model.tree import Binary, Call, Expression, Negate, Number, Symbol

_SUM, _PRODUCT, _SIGN, _POWER, _ATOM = 1, 2, 3, 4, 5
_STRENGTH = {"+": _SUM, "-": _SUM, "*": _PRODUCT, "/": _PRODUCT, "**": _POWER}


def to_text(e: Expression) -> str:
    """``e`` as text with no more parentheses than needed to read it; ``parse`` gives the same tree back."""
    return _text(e)[0]


def _number_text(value: float) -> str:
    if value == math.pi:
        return "pi"
    if value == int(value) and abs(value) < 1e6:
        return f"{value:.0f}"
    return repr(value)


def _text(e: Expression) -> tuple[str, int]:
    """The text of ``e`` and how strongly its outermost part binds."""
    match e:
        case Number(value):
            return _number_text(value), _SIGN if math.copysign(1.0, value) < 0 else _ATOM
        case Symbol(name):
            return name, _ATOM
        case Call(function, argument):
            return f"{function}({to_text(argument)})", _ATOM
        case Negate(operand):
            text, strength = _text(operand)
            # the parentheses keep -(2) apart from the number -2
            bare = strength >= _POWER and not isinstance(operand, Number)
            return "-" + (text if bare else f"({text})"), _SIGN
        case Binary(operator, left, right):
            own = _STRENGTH[operator]
            # + - * / group to the left, ** to the right; a sign after an operator gets parentheses to be seen
            left_needs, right_needs = (_ATOM, _POWER) if own == _POWER else (own, own + 1)
            first, strength = _text(left)
            first = first if strength >= left_needs else f"({first})"
            second, strength = _text(right)
            second = second if strength >= right_needs and strength != _SIGN else f"({second})"
            return first + (f" {operator} " if own == _SUM else operator) + second, own
