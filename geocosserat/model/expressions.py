"""What can be done with an expression, from one place: read, print, evaluate, differentiate, replace, find steps.

An Expression is a small frozen tree (``tree``), read from text by a whitelist parser (``parser``).
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping

from geocosserat.model.derivative import derivative
from geocosserat.model.evaluation import constant, evaluate, symbols, walk
from geocosserat.model.parser import parse
from geocosserat.model.printing import to_text
from geocosserat.model.steps import jump_positions, jumps, steps, switch_times
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
    Operator,
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
    "fixed",
    "jump_positions",
    "jumps",
    "parse",
    "steps",
    "substitute",
    "switch_times",
    "symbols",
    "to_text",
]


def substitute(e: Expression, replacements: Mapping[str, Expression]) -> Expression:
    """``e`` with every name in ``replacements`` replaced, all at once.

    Raises ExpressionError if the result has more than 5 000 nodes.
    """
    replaced = _substitute(e, replacements)
    for count, _ in enumerate(walk(replaced), start=1):
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


_JOIN: dict[Operator, Callable[[Expression, Expression], Expression]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "**": operator.pow,
}  # fmt: skip


def fixed(e: Expression, name: str, value: float) -> Expression:
    """``e`` at one value of a name: what then is a number, zero or one is worked out, the rest stays as it is written.

    ``fixed`` of ``1 + t*sin(2*pi*u)`` at t = 0 is 1; substitution would leave ``1 + 0*sin(2*pi*u)``.
    """
    if name not in symbols(e):
        return e
    match e:
        case Call(function, argument):
            call = Call(function, fixed(argument, name, value))
            result = constant(call) if isinstance(call.argument, Number) else None
            return call if result is None or not math.isfinite(result) else Number(result)
        case Binary(mark, left, right):
            return _JOIN[mark](fixed(left, name, value), fixed(right, name, value))
        case Negate(operand):
            return -fixed(operand, name, value)
        case _:
            return Number(float(value))
