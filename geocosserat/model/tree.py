"""The nodes of an expression: frozen, comparable by value, and nothing that could run code."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "sqrt", "tanh", "sinh", "cosh", "abs", "heaviside")
RESERVED = frozenset({"u", "t", "s", "pi", *FUNCTIONS})
"""Names that mean something in every expression; no parameter may take one."""

MAX_CHARACTERS = 10_000
MAX_DEPTH = 100
MAX_NODES = 5_000


class ExpressionError(ValueError):
    """A text is no expression; ``position`` counts characters from 0, None if there is no place."""

    def __init__(self, message: str, position: int | None = None) -> None:
        self.position = position
        super().__init__(message if position is None else f"{message} (at character {position + 1})")


class Arithmetic:
    """+ - * / and unary minus of expressions, and of expressions with numbers. What is literally zero or one leaves no
    trace, so that an expression made by a formula has only the terms that are there."""

    __slots__ = ()

    def __add__(self, other: Expression | float) -> Expression:
        a, b = _expression(self), _expression(other)
        if isinstance(a, Number) and isinstance(b, Number):
            return Number(a.value + b.value)
        return b if a == _ZERO else a if b == _ZERO else Binary("+", a, b)

    def __radd__(self, other: float) -> Expression:
        return _expression(other) + _expression(self)

    def __sub__(self, other: Expression | float) -> Expression:
        a, b = _expression(self), _expression(other)
        if isinstance(a, Number) and isinstance(b, Number):
            return Number(a.value - b.value)
        return -b if a == _ZERO else a if b == _ZERO else Binary("-", a, b)

    def __rsub__(self, other: float) -> Expression:
        return _expression(other) - _expression(self)

    def __mul__(self, other: Expression | float) -> Expression:
        a, b = _expression(self), _expression(other)
        if _ZERO in (a, b):
            return _ZERO
        if isinstance(a, Number) and isinstance(b, Number):
            return Number(a.value * b.value)
        return b if a == _ONE else a if b == _ONE else Binary("*", a, b)

    def __rmul__(self, other: float) -> Expression:
        return _expression(other) * _expression(self)

    def __truediv__(self, other: Expression | float) -> Expression:
        a, b = _expression(self), _expression(other)
        return a if a == _ZERO or b == _ONE else Binary("/", a, b)

    def __rtruediv__(self, other: float) -> Expression:
        return _expression(other) / _expression(self)

    def __pow__(self, other: Expression | float) -> Expression:
        power = _expression(other)
        return _expression(self) if power == _ONE else Binary("**", _expression(self), power)

    def __neg__(self) -> Expression:
        e = _expression(self)
        match e:
            case Number(value):
                return _ZERO if value == 0 else Number(-value)
            case Negate(operand):
                return operand
            case _:
                return Negate(e)


@dataclass(frozen=True, slots=True)
class Number(Arithmetic):
    """A finite number."""

    value: float

    def __post_init__(self) -> None:
        if not math.isfinite(self.value):
            raise ExpressionError(f"a number must be finite, found {self.value}")


@dataclass(frozen=True, slots=True)
class Symbol(Arithmetic):
    """A name whose value is given later: ``u``, ``t``, ``s`` or a parameter."""

    name: str


@dataclass(frozen=True, slots=True)
class Call(Arithmetic):
    """One of FUNCTIONS applied to its one argument."""

    function: str
    argument: Expression


@dataclass(frozen=True, slots=True)
class Binary(Arithmetic):
    """Two expressions joined by ``+ - * /`` or ``**``."""

    operator: Operator
    left: Expression
    right: Expression


@dataclass(frozen=True, slots=True)
class Negate(Arithmetic):
    """The negative of an expression (a negative literal is a Number, not this)."""

    operand: Expression


Operator: TypeAlias = Literal["+", "-", "*", "/", "**"]
Expression: TypeAlias = Number | Symbol | Call | Binary | Negate


_ZERO, _ONE = Number(0.0), Number(1.0)


def _expression(value: object) -> Expression:
    """A number as an expression. TypeError for anything else that is none."""
    if isinstance(value, Number | Symbol | Call | Binary | Negate):
        return _ZERO if value == _ZERO else value  # -0.0 is zero too
    if isinstance(value, int | float) and not isinstance(value, bool):
        return Number(float(value))
    raise TypeError(f"expected an expression or a number, found {type(value).__name__}")
