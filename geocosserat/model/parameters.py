"""The parameters of a scene: numbers, or expressions of other parameters, in any order but no circle."""

from __future__ import annotations

import math
import re
from graphlib import CycleError, TopologicalSorter
from typing import Any

from geocosserat.model.expressions import RESERVED, ExpressionError, evaluate, parse, symbols
from geocosserat.model.place import Found, Place, shown
from geocosserat.model.schema import MAX_PARAMETERS

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,63}")


def read_parameters(place: Place, values: Any) -> dict[str, float]:
    """The value of every parameter, in the order of the file.

    Raises InputError for a name that is reserved or no name, for a value that is no finite number and no
    expression of other parameters, and for parameters defined by each other.
    """
    if not isinstance(values, dict):
        raise place.wrong("a table of numbers", values, "write [parameters] above lines such as kappa = 1e4")
    if len(values) > MAX_PARAMETERS:
        raise place.wrong(f"at most {MAX_PARAMETERS} parameters", Found(str(len(values))), "write numbers in place")
    for name in values:
        _check_name(place, name)
    definitions = {name: _definition(place.at(name), value, values) for name, value in values.items()}
    order = TopologicalSorter({name: symbols(e) for name, e in definitions.items()})
    found: dict[str, float] = {}
    try:
        for name in order.static_order():
            found[name] = float(evaluate(definitions[name], found))
            if not math.isfinite(found[name]):
                raise place.at(name).wrong("a finite number", Found(f"{shown(values[name])} = {found[name]!r}"))
    except CycleError as error:
        circle = list(reversed(error.args[1]))
        chain = " -> ".join(circle if len(circle) <= 6 else [*circle[:5], "..."])
        raise place.at(circle[0]).wrong("a value that does not depend on itself", Found(chain), "break it") from None
    return {name: found[name] for name in values}


def _check_name(place: Place, name: str) -> None:
    if name in RESERVED:
        raise place.at(name).wrong("a name of your own", Found(f"{name}, which every expression knows"), "rename it")
    if not _NAME.fullmatch(name):
        raise place.at(name).wrong("a name", name, "use at most 64 of the characters a-z A-Z 0-9 _, no digit first")


def _definition(place: Place, value: Any, values: dict[str, Any]) -> Any:
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise place.wrong("a number", value, "write a number, or an expression of other parameters in quotes")
    if isinstance(value, float) and not math.isfinite(value):
        raise place.wrong("a finite number", value)
    try:
        return parse(value, values)
    except ExpressionError as error:
        raise place.wrong("a number or an expression of other parameters", value, str(error)) from None
