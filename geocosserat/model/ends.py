"""The two ends of the rod and the effects along it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

from geocosserat.algebra.groups import Group
from geocosserat.model.checks import check_all_finite, check_finite
from geocosserat.model.effects.catalogue import EFFECTS
from geocosserat.model.effects.effect import Effect, Key, kind, kinds
from geocosserat.model.expressions import Expression, Number
from geocosserat.model.fields import (
    IN_TIME,
    Names,
    Table,
    expression,
    matrix,
    vector,
    word,
)
from geocosserat.model.place import Found, Place
from geocosserat.model.records import End, Frame, Vector
from geocosserat.model.schema import END_KEYS, END_KINDS, FRAMES, MAX_EFFECTS, SIDES

_AXES = ("x", "y", "z")
assert EFFECTS  # importing them makes them known


def read_ends(table: Table, group: Group, names: Names, until: float) -> tuple[End, End]:
    """The left and the right end; clamped and free unless the scene says otherwise."""
    left, right = (
        _read_end(*table.at(side), default, group, names, until) if side in table else End(default)
        for side, default in zip(SIDES, ("clamped", "free"), strict=True)
    )
    return left, right


def read_joined(table: Table) -> bool:
    """Whether the ends are joined; then neither is described by itself."""
    place, joined = table.at("joined")
    if "joined" not in table:
        return False
    if not isinstance(joined, bool):
        raise place.wrong("true or false", joined, "write joined = true for a closed ring")
    for side in SIDES if joined else ():
        if side in table:
            raise table.at(side)[0].wrong("no kind of its own", Found("one"), "joined ends are one point; remove this")
    return joined


def _read_end(place: Place, values: Any, default: str, group: Group, names: Names, until: float) -> End:
    table = Table(place, values, END_KEYS)
    kind = word(*table.at("kind"), END_KINDS) if "kind" in table else default
    refused = {"clamped": ("force", "torque", "frame"), "driven": ("force", "torque", "frame"), "pinned": ("force",)}
    for key in refused.get(kind, ()):
        if key in table:
            raise table.at(key)[0].wrong(
                f"no {key if kind == 'pinned' else 'load'} on a {kind} end",
                Found("one"),
                "it cannot move it; remove this or free the end",
            )
    if kind != "driven" and "twist" in table:
        raise table.at("twist")[0].wrong(
            f"no twist of a {kind} end", Found("one"), 'only kind = "driven" takes it; remove it'
        )
    twist = force = torque = None
    if kind == "driven":
        twist = vector(*table.at("twist"), names, IN_TIME, group.twist)
        check_all_finite(table.at("twist")[0], twist, names, until)
    if "force" in table:
        force = vector(*table.at("force"), names, IN_TIME, _force_names(group))
        check_all_finite(table.at("force")[0], force, names, until)
    if "torque" in table:
        torque = _read_torque(*table.at("torque"), group, names, IN_TIME, until)
    frame = word(*table.at("frame"), FRAMES) if "frame" in table else "body"
    return End(kind, _none_if_zero(force), _none_if_zero(torque), cast(Frame, frame), twist)


def _read_torque(
    place: Place, value: Any, group: Group, names: Names, variables: frozenset[str], until: float
) -> Vector:
    """A moment: one component in the plane, written without brackets, three in space."""
    if group.rotations > 1:
        torque = vector(place, value, names, variables, group.wrench[group.translations :])
        check_all_finite(place, torque, names, until)
    elif isinstance(value, list):
        raise place.wrong(
            "one number or expression (the plane has one rotation)", value, "write it without brackets"
        )
    else:
        torque = (expression(place, value, names, variables),)
        check_finite(place, torque[0], names, until)
    return torque


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
    return effect(**{name: _read_value(*table.at(name), key, group, names, until) for name, key in effect.keys.items()})


def _read_value(place: Place, value: Any, key: Key, group: Group, names: Names, until: float) -> Vector:
    """A value of an effect as expressions, a matrix by rows, finite wherever and whenever it is used."""
    axes, variables = _AXES[: group.space], frozenset(key.varies)
    match key.shape:
        case "scalar":
            found: Vector = (expression(place, value, names, variables),)
            check_finite(place, found[0], names, until)
            return found
        case "moment":
            return _read_torque(place, value, group, names, variables, until)
        case "matrix":
            rows = matrix(place, value, names, variables, axes)
            for i, row in enumerate(rows):
                check_all_finite(place.at(i), row, names, until)
            return tuple(e for row in rows for e in row)
        case _:
            found = vector(place, value, names, variables, _force_names(group) if key.shape == "body" else axes)
            check_all_finite(place, found, names, until)
            return found


def _force_names(group: Group) -> Sequence[str]:
    return group.wrench[: group.translations]


def _none_if_zero(load: tuple[Expression, ...] | None) -> Vector | None:
    """A load that is zero whatever the parameters are is no load, and leaves no term in the equations."""
    return None if load is None or all(e in (Number(0.0), Number(-0.0)) for e in load) else load
