"""From the effects of a scene to Effects: values read by their keys, formulas tried before they are relied upon."""

from __future__ import annotations

from typing import Any

from geocosserat.algebra.groups import Group
from geocosserat.model.checks import check_all_finite, check_written
from geocosserat.model.effects.catalogue import kind, kinds
from geocosserat.model.effects.effect import Effect, Key
from geocosserat.model.expressions import Binary, Call, Negate, Number, Symbol, symbols
from geocosserat.model.fields import Names, Table, expression, matrix, moment, vector, word
from geocosserat.model.place import Found, Place
from geocosserat.model.schema import MAX_EFFECTS
from geocosserat.model.seen import AXES, Vector, seen


def read_effects(place: Place, values: Any, group: Group, names: Names, until: float) -> tuple[Effect, ...]:
    """What acts along the rod; none unless the scene says otherwise."""
    if not isinstance(values, list) or not all(isinstance(entry, dict) for entry in values):
        raise place.wrong("a list of tables", values, "write [[effects]] above each effect")
    if len(values) > MAX_EFFECTS:
        raise place.wrong(f"at most {MAX_EFFECTS} effects", values, "add their forces up in one")
    return tuple(_read_effect(place.at(i), entry, group, names, until) for i, entry in enumerate(values))


def _read_effect(place: Place, values: dict[str, Any], group: Group, names: Names, until: float) -> Effect:
    effect = kind(word(place.at("kind"), values.get("kind"), kinds()))
    table = Table(place, values, ("kind", *effect.keys))
    read = effect(**{name: _read_value(*table.at(name), key, group, names, until) for name, key in effect.keys.items()})
    try:
        check_formulas(read, group.space)
    except Exception as error:  # of an effect that someone wrote, so it may be any
        where = "the plane" if group.space == 2 else "space"
        what = f"an effect with formulas for {where}"
        found = Found(f"{effect.kind}, with {type(error).__name__}: {error}")
        raise place.at("kind").wrong(what, found, f"correct {effect.__name__}") from error
    return read


def _read_value(place: Place, value: Any, key: Key, group: Group, names: Names, until: float) -> Vector:
    """A value of an effect as expressions, a matrix by rows, finite wherever and whenever it is used."""
    axes, forces, moments = AXES[: group.space], group.wrench[: group.space], group.wrench[group.space :]
    variables = frozenset(key.varies)
    match key.shape:
        case "matrix":
            rows = matrix(place, value, names, variables, axes)
            for i, row in enumerate(rows):
                check_all_finite(place.at(i), row, names, until)
            return tuple(e for row in rows for e in row)
        case "scalar":
            found: Vector = (expression(place, value, names, variables),)
        case "moment":
            found = moment(place, value, names, variables, moments)
        case "body":
            found = vector(place, value, names, variables, forces)
        case "world":
            found = vector(place, value, names, variables, axes)
    check_written(place, value, found, names, until)
    return found


def check_formulas(effect: Effect, space: int) -> None:
    """Raise TypeError unless wrench, medium and potential are expressions, of the right number, of nothing unknown.

    They are made for symbols in the place of all values, as for a kernel; what they raise themselves goes through.
    """
    frame = seen(space)
    known: set[str] = set().union(*map(symbols, (*sum(frame.axes, ()), *frame.position)))

    def symbol(key: str, i: int, e: object) -> Symbol:
        known.add(f"{key}.{i + 1}")
        return Symbol(f"{key}.{i + 1}")

    named = effect.renamed(symbol)
    for name, pair in (("wrench", named.wrench(frame)), ("medium", named.medium(frame))):
        sizes = tuple(len(part) for part in pair)
        if sizes != (space, frame.rotations):
            raise TypeError(
                f"{name}: expected {space} components and {frame.rotations}, found {' and '.join(map(str, sizes))}; "
                f"fill up with nothing(...)"
            )
        for e in (*pair[0], *pair[1]):
            _check_formula(name, e, known)
    energy = named.potential(frame)
    if energy is not None:
        _check_formula("potential", energy, known)


def _check_formula(name: str, e: object, known: set[str]) -> None:
    if not isinstance(e, Number | Symbol | Call | Binary | Negate):
        raise TypeError(f"{name}: expected expressions, found {type(e).__name__}; write Number(...) for a number")
    if unknown := sorted(symbols(e) - known):
        raise TypeError(f"{name}: expected only values of its keys and what is seen, found {unknown[0]}; make it a key")
