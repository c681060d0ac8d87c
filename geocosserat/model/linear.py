"""Whether an expression is linear in some of its names, by how it is written."""

from __future__ import annotations

from collections.abc import Collection

from geocosserat.model.evaluation import symbols
from geocosserat.model.tree import Binary, Expression, Negate, Number, Symbol


def is_linear(e: Expression, names: Collection[str]) -> bool:
    """Whether each term of ``e`` holds at most one of the names, as a factor; terms without any are welcome.

    Nothing is multiplied out: ``(x + 1)**2 - x**2`` does not count as linear in x.
    """
    if not symbols(e) & set(names):
        return True
    match e:
        case Symbol():
            return True
        case Negate(operand):
            return is_linear(operand, names)
        case Binary("+" | "-", left, right):
            return is_linear(left, names) and is_linear(right, names)
        case Binary("*", left, right):
            apart = not (symbols(left) & set(names) and symbols(right) & set(names))
            return apart and is_linear(left, names) and is_linear(right, names)
        case Binary("/", left, right):
            return not symbols(right) & set(names) and is_linear(left, names)
        case Binary("**", base, Number(1.0)):
            return is_linear(base, names)
        case _:
            return False
