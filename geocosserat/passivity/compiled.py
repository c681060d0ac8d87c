"""Many expressions in floats at once: what they have in common is worked out once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from geocosserat.model.expressions import Binary, Call, Expression, Negate, Number, Symbol

_FUNCTION: Final[dict[str, Callable[..., Any]]] = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "exp": np.exp, "log": np.log, "sqrt": np.sqrt, "tanh": np.tanh,
    "sinh": np.sinh, "cosh": np.cosh, "abs": np.abs, "heaviside": lambda x: np.heaviside(x, 0.5),
    "+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide, "**": np.power, "negate": np.negative,
}  # fmt: skip


class Compiled:
    """Expressions as one list of operations, each on the results of earlier ones; equal parts are one."""

    def __init__(self, expressions: Sequence[Expression]) -> None:
        self._places: dict[tuple[Any, ...], int] = {}
        self._seen: dict[int, int] = {}
        self._results = [self._place(e) for e in expressions]
        self._steps = list(self._places)
        self._kept = list(expressions)  # as long as their ids are known

    def __call__(self, values: Mapping[str, NDArray[np.float64]], count: int) -> NDArray[np.float64]:
        """The values of all expressions where names have those of arrays (count,): (count, number of expressions).

        Not a number or infinite where there is none; nothing is raised or warned.
        """
        found: list[Any] = []
        with np.errstate(all="ignore"):
            for what, *arguments in self._steps:
                if what == "number":
                    found.append(np.float64(arguments[0]))
                elif what == "name":
                    found.append(values[arguments[0]])
                else:
                    found.append(_FUNCTION[what](*(found[i] for i in arguments)))
        out = np.empty((count, len(self._results)))
        for i, place in enumerate(self._results):
            out[:, i] = found[place]
        return out

    def _place(self, e: Expression) -> int:
        if id(e) in self._seen:
            return self._seen[id(e)]
        key: tuple[Any, ...]
        match e:
            case Number(value):
                key = ("number", value)
            case Symbol(name):
                key = ("name", name)
            case Call(function, argument):
                key = (function, self._place(argument))
            case Binary(mark, left, right):
                key = (mark, self._place(left), self._place(right))
            case Negate(operand):
                key = ("negate", self._place(operand))
        place = self._places.setdefault(key, len(self._places))
        self._seen[id(e)] = place
        return place
