"""What can be done with an expression: print it, evaluate it, substitute in it, find its steps.

An Expression is a small frozen tree (``tree``), read from text by a whitelist parser (``parser``).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from geocosserat.model.parser import parse
from geocosserat.model.tree import (
    FUNCTIONS,
    MAX_NODES,
    RESERVED,
    Binary,
    Call,
    Expression,
    ExpressionError,
    Negate,
    Number,
    Symbol,
)

__all__ = [
    "FUNCTIONS",
    "RESERVED",
    "Binary",
    "Call",
    "Expression",
    "ExpressionError",
    "Negate",
    "Number",
    "Symbol",
    "constant",
    "derivative",
    "evaluate",
    "jump_positions",
    "jumps",
    "parse",
    "steps",
    "substitute",
    "switch_times",
    "symbols",
    "to_text",
]

Values: TypeAlias = float | NDArray[np.float64]


def _children(e: Expression) -> tuple[Expression, ...]:
    match e:
        case Call(_, argument):
            return (argument,)
        case Binary(_, left, right):
            return (left, right)
        case Negate(operand):
            return (operand,)
        case _:
            return ()


def _walk(e: Expression) -> Iterator[Expression]:
    waiting = [e]
    while waiting:
        node = waiting.pop()
        yield node
        waiting.extend(reversed(_children(node)))


def symbols(e: Expression) -> frozenset[str]:
    """The names that occur in ``e`` (functions and ``pi`` are not names)."""
    return frozenset(node.name for node in _walk(e) if isinstance(node, Symbol))


def constant(e: Expression) -> float | None:
    """The value of ``e`` if no name occurs in it, else None; infinite or NaN for ``1/0`` and the like."""
    return None if symbols(e) else float(evaluate(e, {}))


# evaluation


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


# differentiation


def derivative(e: Expression, name: str) -> Expression:
    """d e / d name, with what is literally zero left out.

    A step has the derivative zero (its jump is not seen); that of ``abs`` is 1 or -1, and 0 at zero.
    """
    if name not in symbols(e):
        return Number(0.0)
    match e:
        case Symbol():
            return Number(1.0)
        case Negate(operand):
            return -derivative(operand, name)
        case Binary("+", left, right):
            return derivative(left, name) + derivative(right, name)
        case Binary("-", left, right):
            return derivative(left, name) - derivative(right, name)
        case Binary("*", left, right):
            return derivative(left, name) * right + left * derivative(right, name)
        case Binary("/", left, right):
            return (derivative(left, name) - e * derivative(right, name)) / right
        case Binary("**", base, power):
            fixed, moving = Number(0.0) * base, Number(0.0) * base
            if name in symbols(base):
                fixed = power * base ** (power - 1) * derivative(base, name)
            if name in symbols(power):
                moving = e * Call("log", base) * derivative(power, name)
            return fixed + moving
        case Call(function, argument):
            return _SLOPE[function](argument) * derivative(argument, name)
    raise TypeError(f"expected an expression, found {type(e).__name__}")


_SLOPE: dict[str, Callable[[Expression], Expression]] = {
    "sin": lambda x: Call("cos", x),
    "cos": lambda x: -Call("sin", x),
    "tan": lambda x: 1 + Call("tan", x) ** 2,
    "exp": lambda x: Call("exp", x),
    "log": lambda x: 1 / x,
    "sqrt": lambda x: 0.5 / Call("sqrt", x),
    "tanh": lambda x: 1 - Call("tanh", x) ** 2,
    "sinh": lambda x: Call("cosh", x),
    "cosh": lambda x: Call("sinh", x),
    "abs": lambda x: 2 * Call("heaviside", x) - 1,
    "heaviside": lambda x: Number(0.0),
}


# substitution


def substitute(e: Expression, replacements: Mapping[str, Expression]) -> Expression:
    """``e`` with every name in ``replacements`` replaced, all at once.

    Raises ExpressionError if the result has more than 5 000 nodes.
    """
    replaced = _substitute(e, replacements)
    for count, _ in enumerate(_walk(replaced), start=1):
        if count > MAX_NODES:
            raise ExpressionError(f"substitution makes more than {MAX_NODES} parts; shorten the expression")
    return replaced


def _substitute(e: Expression, replacements: Mapping[str, Expression]) -> Expression:
    match e:
        case Symbol(name):
            return replacements.get(name, e)
        case Call(function, argument):
            return Call(function, _substitute(argument, replacements))
        case Binary(operator, left, right):
            return Binary(operator, _substitute(left, replacements), _substitute(right, replacements))
        case Negate(operand):
            return Negate(_substitute(operand, replacements))
        case Number():
            return e


# printing


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


# steps


def steps(e: Expression) -> tuple[Expression, ...]:
    """The arguments of all ``heaviside`` in ``e``."""
    return tuple(node.argument for node in _walk(e) if isinstance(node, Call) and node.function == "heaviside")


def jumps(e: Expression, variable: str = "u") -> tuple[Expression, ...]:
    """The arguments of ``heaviside`` in ``e`` that contain ``variable``, each once; it steps at their zeros.

    Raises ExpressionError unless each is affine in ``variable``, with coefficients that depend on no other of
    ``u``, ``s``, ``t``: element boundaries are placed on the steps, so they must be known and must not move.
    """
    found: dict[Expression, None] = {}
    for node in _walk(e):
        if not (isinstance(node, Call) and node.function == "heaviside"):
            continue
        names = symbols(node.argument)
        if variable not in names:
            continue
        if moving := sorted(names & ({"u", "s", "t"} - {variable})):
            raise ExpressionError(
                f"a step must not move, but heaviside({to_text(node.argument)}) depends on {variable} and {moving[0]}"
            )
        if _degree(node.argument, variable) != 1:
            raise ExpressionError(
                f"heaviside({to_text(node.argument)}) is not a step at one place; "
                f"write steps as heaviside({variable} - 0.5)"
            )
        found[node.argument] = None
    return tuple(found)


def _degree(e: Expression, variable: str) -> int:
    """0 if ``e`` does not contain ``variable``, 1 if it is affine in it, 2 for anything else."""
    match e:
        case Symbol(name):
            return int(name == variable)
        case Negate(operand):
            return _degree(operand, variable)
        case Binary("+" | "-", left, right):
            return max(_degree(left, variable), _degree(right, variable))
        case Binary("*", left, right):
            return min(2, _degree(left, variable) + _degree(right, variable))
        case Binary("/", left, right):
            return _degree(left, variable) if _degree(right, variable) == 0 else 2
        case _:
            return 2 if variable in symbols(e) else 0


def jump_positions(e: Expression, length: float, values: Mapping[str, float]) -> tuple[float, ...]:
    """Where in the open interval (0, length) of ``u`` the expression steps, in rising order, each once.

    ``values`` holds the parameters. Raises ExpressionError as ``jumps`` does.
    """
    places: set[float] = set()
    for argument in jumps(e):
        start = float(evaluate(argument, {**values, "u": 0.0}))
        end = float(evaluate(argument, {**values, "u": length}))
        if start < 0 < end or end < 0 < start:
            places.add(length * (start / (start - end)))
    return tuple(sorted(places))


def switch_times(e: Expression, until: float, values: Mapping[str, float]) -> tuple[float, ...]:
    """Instants in the open interval (0, until) at which a ``heaviside`` of ``t`` in the expression switches.

    ``values`` holds the parameters. Sign changes of its argument are looked for on 4000 intervals and bisected;
    an argument that is affine in t is found however short the pulse that two of them make.
    """
    grid = np.linspace(0.0, until, 4001)
    found: set[float] = set()
    for node in _walk(e):
        if not (isinstance(node, Call) and node.function == "heaviside"):
            continue
        names = symbols(node.argument)
        if "t" not in names or names & {"u", "s"}:
            continue
        signs = np.sign(np.broadcast_to(evaluate(node.argument, {**values, "t": grid}), grid.shape))
        found.update(float(t) for t in grid[1:-1][signs[1:-1] == 0])
        for i in np.flatnonzero(signs[:-1] * signs[1:] < 0):
            low, high = float(grid[i]), float(grid[i + 1])
            while low < (middle := (low + high) / 2) < high:
                if np.sign(evaluate(node.argument, {**values, "t": middle})) == signs[i]:
                    low = middle
                else:
                    high = middle
            found.add(high)
    return tuple(sorted(found))
