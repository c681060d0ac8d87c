"""The nodes of an expression: frozen, comparable by value, and nothing that could run code."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from dataclasses import dataclass
from numbers import Real
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
    """+ - * / ** of expressions, and of expressions with numbers.

    What is literally zero or one leaves no trace, and numbers are computed, so that an expression made by a formula
    has only the terms that are there. A result that is no finite number stays as it is written.
    """

    __slots__ = ()
    __array_ufunc__ = None  # numpy's numbers leave the operation to these methods

    def __add__(self, other: Expression | float) -> Expression:
        return _joined("+", self, other)

    def __radd__(self, other: float) -> Expression:
        return _joined("+", other, self)

    def __sub__(self, other: Expression | float) -> Expression:
        return _joined("-", self, other)

    def __rsub__(self, other: float) -> Expression:
        return _joined("-", other, self)

    def __mul__(self, other: Expression | float) -> Expression:
        return _joined("*", self, other)

    def __rmul__(self, other: float) -> Expression:
        return _joined("*", other, self)

    def __truediv__(self, other: Expression | float) -> Expression:
        return _joined("/", self, other)

    def __rtruediv__(self, other: float) -> Expression:
        return _joined("/", other, self)

    def __pow__(self, other: Expression | float) -> Expression:
        return _joined("**", self, other)

    def __rpow__(self, other: float) -> Expression:
        return _joined("**", other, self)

    def __neg__(self) -> Expression:
        e = as_expression(self)
        match e:
            case Number(value):
                return as_expression(-value)
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
_OF_NUMBERS: dict[Operator, Callable[[float, float], float]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "**": math.pow,
}  # fmt: skip


def as_expression(value: object) -> Expression:
    """A number as an expression, -0.0 as zero. TypeError for anything else that is none."""
    if isinstance(value, Number | Symbol | Call | Binary | Negate):
        return _ZERO if value == _ZERO else value
    if isinstance(value, Real) and not isinstance(value, bool):
        return as_expression(Number(float(value)))
    raise TypeError(f"expected an expression or a number, found {type(value).__name__}")


def _joined(mark: Operator, left: object, right: object) -> Expression:
    a, b = as_expression(left), as_expression(right)
    if isinstance(a, Number) and isinstance(b, Number):
        return _computed(mark, a, b)
    match mark:
        case "+" if a == _ZERO:
            return b
        case "-" if a == _ZERO:
            return -b
        case "+" | "-" if b == _ZERO:
            return a
        case "*" if _ZERO in (a, b):
            return _ZERO
        case "*" if a == _ONE:
            return b
        case "*" | "/" | "**" if b == _ONE:
            return a
        case "/" if a == _ZERO:
            return _ZERO
        case "**" if b == _ZERO or a == _ONE:
            return _ONE
    return Binary(mark, a, b)


def _computed(mark: Operator, a: Number, b: Number) -> Expression:
    try:
        value = _OF_NUMBERS[mark](a.value, b.value)
    except (ArithmeticError, ValueError):
        value = math.nan
    return as_expression(value) if math.isfinite(value) else Binary(mark, a, b)
