"""What an expression contains, and what it comes to in double precision."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from geocosserat.model.tree import Binary, Call, Expression, ExpressionError, Negate, Number, Symbol

Values: TypeAlias = float | NDArray[np.float64]


def children(e: Expression) -> tuple[Expression, ...]:
    """What the outermost part of ``e`` joins."""
    match e:
        case Call(_, argument):
            return (argument,)
        case Binary(_, left, right):
            return (left, right)
        case Negate(operand):
            return (operand,)
        case _:
            return ()


def walk(e: Expression) -> Iterator[Expression]:
    """``e`` and every part of it, from the outermost and from the left."""
    waiting = [e]
    while waiting:
        node = waiting.pop()
        yield node
        waiting.extend(reversed(children(node)))


def symbols(e: Expression) -> frozenset[str]:
    """The names that occur in ``e`` (functions and ``pi`` are not names)."""
    return frozenset(node.name for node in walk(e) if isinstance(node, Symbol))


def constant(e: Expression) -> float | None:
    """The value of ``e`` if no name occurs in it, else None; infinite or NaN for ``1/0`` and the like."""
    if isinstance(e, Number):
        return float(e.value)
    return None if symbols(e) else float(evaluate(e, {}))


def _heaviside(x: Any) -> Any:
    return np.heaviside(x, 0.5)


_FUNCTION: dict[str, Callable[[Any], Any]] = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "exp": np.exp, "log": np.log, "sqrt": np.sqrt,
    "tanh": np.tanh, "sinh": np.sinh, "cosh": np.cosh, "abs": np.abs, "heaviside": _heaviside,
}  # fmt: skip
_OPERATOR: dict[str, Callable[[Any, Any], Any]] = {
    "+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide, "**": np.power,
}  # fmt: skip


def evaluate(e: Expression, env: Mapping[str, float | NDArray[np.float64]]) -> Values:
    """The value of ``e`` for the values ``env`` of its names: a float, or an array if one of those is.

    Everything is computed in double precision. Outside a function's domain the value is NaN, beyond the
    largest number it is infinite; nothing is raised or warned, the caller checks. ``heaviside(0)`` is 1/2.
    Raises ExpressionError if a name has no value.
    """
    if isinstance(e, Number):  # most of what a scene says
        return float(e.value)
    with np.errstate(all="ignore"):
        value = _value(e, env)
    return value if isinstance(value, np.ndarray) and value.ndim else float(value)


def _value(e: Expression, env: Mapping[str, float | NDArray[np.float64]]) -> Any:
    match e:
        case Number(value):
            return np.float64(value)
        case Symbol(name):
            if name not in env:
                raise ExpressionError(f"the name {name} has no value here; known: {' '.join(sorted(env))}")
            return np.asarray(env[name], dtype=np.float64)[()]
        case Call(function, argument):
            return _FUNCTION[function](_value(argument, env))
        case Binary(operator, left, right):
            return _OPERATOR[operator](_value(left, env), _value(right, env))
        case Negate(operand):
            return -_value(operand, env)
