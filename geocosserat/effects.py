"""For effects of your own: a few lines of formulas, a kind of effect that scenes may name. See docs/effects.md."""

from __future__ import annotations

from geocosserat.model.effects.catalogue import EFFECTS
from geocosserat.model.effects.effect import Effect, Key, Pair
from geocosserat.model.effects.registry import register
from geocosserat.model.seen import Seen, Vector, cross, dot, nothing, seen
from geocosserat.model.tree import Call, Expression, Number, as_expression

__all__ = [
    "EFFECTS",
    "Effect",
    "Expression",
    "Key",
    "Number",
    "Pair",
    "Seen",
    "Vector",
    "abs_",
    "cos",
    "cosh",
    "cross",
    "dot",
    "exp",
    "log",
    "nothing",
    "register",
    "seen",
    "sin",
    "sinh",
    "sqrt",
    "tan",
    "tanh",
]


def sin(x: Expression | float) -> Expression:
    """Sine of an angle in radians."""
    return Call("sin", as_expression(x))


def cos(x: Expression | float) -> Expression:
    """Cosine of an angle in radians."""
    return Call("cos", as_expression(x))


def tan(x: Expression | float) -> Expression:
    """Tangent of an angle in radians."""
    return Call("tan", as_expression(x))


def exp(x: Expression | float) -> Expression:
    """Exponential."""
    return Call("exp", as_expression(x))


def log(x: Expression | float) -> Expression:
    """Natural logarithm."""
    return Call("log", as_expression(x))


def sqrt(x: Expression | float) -> Expression:
    """Square root."""
    return Call("sqrt", as_expression(x))


def sinh(x: Expression | float) -> Expression:
    """Hyperbolic sine."""
    return Call("sinh", as_expression(x))


def cosh(x: Expression | float) -> Expression:
    """Hyperbolic cosine."""
    return Call("cosh", as_expression(x))


def tanh(x: Expression | float) -> Expression:
    """Hyperbolic tangent: a step that is smooth, from -1 to 1."""
    return Call("tanh", as_expression(x))


def abs_(x: Expression | float) -> Expression:
    """Absolute value; its slope is taken as 0 at 0."""
    return Call("abs", as_expression(x))
