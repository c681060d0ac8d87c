"""Readers of single fields: a word, a number, an expression, a vector, a matrix, each with its messages."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from geocosserat.model.expressions import (
    Binary,
    Expression,
    ExpressionError,
    Number,
    Symbol,
    evaluate,
    parse,
    substitute,
    symbols,
)
from geocosserat.model.place import NOTHING, Found, Place, one_of, shown

_VARIABLES = ("u", "s", "t")
_MEANING = {
    frozenset[str](): "the parameters",
    frozenset("u"): "u, s and the parameters",
    frozenset("t"): "t and the parameters",
    frozenset("ut"): "u, s, t and the parameters",
}
FIXED = frozenset[str]()
ALONG_ROD = frozenset("u")
IN_TIME = frozenset("t")
ALONG_ROD_IN_TIME = frozenset("ut")


@dataclass(frozen=True, slots=True)
class Names:
    """What a name in an expression stands for: the parameters, and the length that makes ``s`` of ``u``."""

    parameters: Mapping[str, float] = field(default_factory=dict)
    length: float = 1.0


class Table:
    """A table of the scene in which only known keys may occur."""

    def __init__(self, place: Place, values: Any, known: Iterable[str]) -> None:
        if not isinstance(values, dict):
            raise place.wrong("a table", values, f"write [{place.key}] above its keys" if place.key else None)
        self._values = values
        self._place = place
        known = tuple(known)
        for key in values:
            if key not in known:
                raise place.unknown(key, known)

    def __contains__(self, key: str) -> bool:
        return key in self._values

    def at(self, key: str) -> tuple[Place, Any]:
        """The place and value of a key, None if it is missing: what every reader takes."""
        return self._place.at(key), self._values.get(key)


def word(place: Place, value: Any, known: Sequence[str]) -> str:
    """One of the known words."""
    if not isinstance(value, str):
        raise place.wrong(one_of(known), NOTHING if value is None else value, "write one of the words in quotes")
    if value not in known:
        raise place.unknown(value, known, "word")
    return value


def number(place: Place, value: Any, names: Names, *, positive: bool = False) -> float:
    """A finite number, or an expression of the parameters that gives one."""
    what = "a positive number" if positive else "a finite number"
    if value is None:
        raise place.wrong(what, NOTHING, "add it")
    e = expression(place, value, names, FIXED)
    result = float(evaluate(e, names.parameters))
    if not math.isfinite(result) or (positive and result <= 0):
        raise place.wrong(what, _result(value, result))
    return result


def number_between(place: Place, value: Any, names: Names, low: float, high: float) -> float:
    """A number in a closed interval."""
    result = number(place, value, names)
    if not low <= result <= high:
        raise place.wrong(f"a number between {low:g} and {high:g}", _result(value, result))
    return result


def integer(place: Place, value: Any, names: Names, low: int, high: int) -> int:
    """A whole number in a closed interval."""
    result = number(place, value, names)
    if result != int(result) or not low <= result <= high:
        raise place.wrong(f"a whole number from {low} to {high}", _result(value, result))
    return int(result)


def expression(place: Place, value: Any, names: Names, variables: frozenset[str]) -> Expression:
    """A number or an expression of the parameters and of ``variables``, some of ``u`` and ``t``.

    ``s`` may stand wherever ``u`` may, and becomes ``u/length``.
    """
    what = f"a number or an expression of {_MEANING[variables]}"
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise place.wrong(what, NOTHING if value is None else value, "write a number, or an expression in quotes")
    if isinstance(value, float) and not math.isfinite(value):
        raise place.wrong("a finite number", value)
    try:
        e = parse(value, {*names.parameters, *_VARIABLES})
        used = symbols(e)
        if "s" in used:
            e = substitute(e, {"s": Binary("/", Symbol("u"), Number(names.length))})
    except ExpressionError as error:
        raise place.wrong(what, value, str(error)) from None
    for variable in _VARIABLES:
        if variable in used and {"s": "u"}.get(variable, variable) not in variables:
            raise place.wrong(what, Found(f"{shown(value)}, which depends on {variable}"), f"remove {variable}")
    if not used & set(_VARIABLES) and not math.isfinite(result := float(evaluate(e, names.parameters))):
        raise place.wrong("a finite number", _result(value, result))
    return e


def vector(
    place: Place, value: Any, names: Names, variables: frozenset[str], components: Sequence[str]
) -> tuple[Expression, ...]:
    """A list of expressions, one for each component."""
    _check_length(place, value, components)
    return tuple(expression(place.at(i), entry, names, variables) for i, entry in enumerate(value))


def moment(
    place: Place, value: Any, names: Names, variables: frozenset[str], components: Sequence[str]
) -> tuple[Expression, ...]:
    """A vector with a component for each rotation; of the plane it has one, and is written without brackets."""
    if len(components) > 1:
        return vector(place, value, names, variables, components)
    if isinstance(value, list):
        what = "one number or expression (the plane has one rotation)"
        raise place.wrong(what, value, "write it without brackets")
    return (expression(place, value, names, variables),)


def numbers(place: Place, value: Any, names: Names, components: Sequence[str]) -> tuple[float, ...]:
    """A list of finite numbers, one for each component."""
    _check_length(place, value, components)
    return tuple(number(place.at(i), entry, names) for i, entry in enumerate(value))


def matrix(
    place: Place, value: Any, names: Names, variables: frozenset[str], components: Sequence[str]
) -> tuple[tuple[Expression, ...], ...]:
    """A full matrix as a list of rows, or a diagonal one as the list of its diagonal."""
    _check_length(place, value, components, "or of as many rows")
    size = len(components)
    if any(isinstance(row, list) for row in value):
        return tuple(vector(place.at(i), row, names, variables, components) for i, row in enumerate(value))
    diagonal = vector(place, value, names, variables, components)
    return tuple(tuple(diagonal[i] if i == j else Number(0.0) for j in range(size)) for i in range(size))


def _check_length(place: Place, value: Any, components: Sequence[str], also: str = "") -> None:
    size = len(components)
    what = f"a list of {size} ({', '.join(components)})" + (f" {also}" if also else "")
    if not isinstance(value, list):
        raise place.wrong(what, NOTHING if value is None else value, f"write [..] with {size} entries")
    if len(value) != size:
        raise place.wrong(what, Found(f"a list of {len(value)}"), f"write {size} entries")


def _result(value: Any, result: float) -> Found:
    """The value as written, and what it comes to if that is not the same."""
    return Found(f"{shown(value)} = {result!r}" if isinstance(value, str) else shown(value))
