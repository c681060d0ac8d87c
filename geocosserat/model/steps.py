"""Where an expression steps: at places along the rod, which must be known and stay, and at instants."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocosserat.model.evaluation import evaluate, symbols, walk
from geocosserat.model.printing import to_text
from geocosserat.model.tree import Binary, Call, Expression, ExpressionError, Negate, Symbol


def steps(e: Expression) -> tuple[Expression, ...]:
    """The arguments of all ``heaviside`` in ``e``."""
    return tuple(node.argument for node in walk(e) if isinstance(node, Call) and node.function == "heaviside")


def jumps(e: Expression, variable: str = "u") -> tuple[Expression, ...]:
    """The arguments of ``heaviside`` in ``e`` that contain ``variable``, each once; it steps at their zeros.

    Raises ExpressionError unless each is affine in ``variable``, with coefficients that depend on no other of
    ``u``, ``s``, ``t``: element boundaries are placed on the steps, so they must be known and must not move.
    """
    found: dict[Expression, None] = {}
    for node in walk(e):
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
    for node in walk(e):
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
