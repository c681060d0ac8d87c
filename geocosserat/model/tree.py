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


@dataclass(frozen=True, slots=True)
class Number:
    """A finite number."""

    value: float

    def __post_init__(self) -> None:
        if not math.isfinite(self.value):
            raise ExpressionError(f"a number must be finite, found {self.value}")


@dataclass(frozen=True, slots=True)
class Symbol:
    """A name whose value is given later: ``u``, ``t``, ``s`` or a parameter."""

    name: str


@dataclass(frozen=True, slots=True)
class Call:
    """One of FUNCTIONS applied to its one argument."""

    function: str
    argument: Expression


@dataclass(frozen=True, slots=True)
class Binary:
    """Two expressions joined by ``+ - * /`` or ``**``."""

    operator: Operator
    left: Expression
    right: Expression


@dataclass(frozen=True, slots=True)
class Negate:
    """The negative of an expression (a negative literal is a Number, not this)."""

    operand: Expression


Operator: TypeAlias = Literal["+", "-", "*", "/", "**"]
Expression: TypeAlias = Number | Symbol | Call | Binary | Negate
