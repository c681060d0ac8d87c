"""The two ends of the rod and the effects along it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, cast

from geocosserat.algebra.groups import Group
from geocosserat.model.checks import check_all_finite, check_finite
from geocosserat.model.expressions import Expression, Number
from geocosserat.model.fields import (
    ALONG_ROD_IN_TIME,
    FIXED,
    IN_TIME,
    Names,
    Table,
    expression,
    matrix,
    number,
    numbers,
    vector,
    word,
)
from geocosserat.model.place import Found, Place
from geocosserat.model.records import Effect, End, Frame, Vector, Weight
from geocosserat.model.schema import (
    AVAILABLE_EFFECTS,
    AVAILABLE_ENDS,
    EFFECT_KEYS,
    END_KEYS,
    END_KINDS,
    ENDS_KEYS,
    FRAMES,
    MAX_EFFECTS,
)

_AXES = ("x", "y", "z")


def read_ends(place: Place, values: Any, group: Group, names: Names, until: float) -> tuple[End, End]:
    """The left and the right end; clamped and free unless the scene says otherwise."""
    ends = Table(place, values, ENDS_KEYS)
    left, right = (
        _read_end(*ends.at(side), default, group, names, until) if side in ends else End(default)
        for side, default in (("left", "clamped"), ("right", "free"))
    )
    return left, right


def _read_end(place: Place, values: Any, default: str, group: Group, names: Names, until: float) -> End:
    table = Table(place, values, END_KEYS)
    kind = word(*table.at("kind"), END_KINDS) if "kind" in table else default
    if kind in ("clamped", "driven", "joined"):
        for key in ("force", "torque", "frame"):
            if key in table:
                raise table.at(key)[0].wrong(
                    f"no load on a {kind} end",
                    Found("one"),
                    "a load cannot move it; remove this or free the end",
                )
    if kind != "driven" and "twist" in table:
        raise table.at("twist")[0].wrong(
            f"no twist of a {kind} end", Found("one"), 'only kind = "driven" takes it; remove it'
        )
    if kind == "driven":
        vector(*table.at("twist"), names, IN_TIME, group.twist)
    force = torque = None
    if "force" in table:
        force = vector(*table.at("force"), names, IN_TIME, _force_names(group))
        check_all_finite(table.at("force")[0], force, names, until)
    if "torque" in table:
        torque = _read_torque(*table.at("torque"), group, names, IN_TIME, until)
    frame = word(*table.at("frame"), FRAMES) if "frame" in table else "body"
    if kind not in AVAILABLE_ENDS:
        at, found = table.at("kind")
        raise at.unavailable(" or ".join(AVAILABLE_ENDS), found, "change the kind of this end")
    return End(kind, _none_if_zero(force), _none_if_zero(torque), cast(Frame, frame))


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
    kind = word(place.at("kind"), values.get("kind"), tuple(EFFECT_KEYS))
    table = Table(place, values, ("kind", *EFFECT_KEYS[kind]))
    axes = _AXES[: group.space]
    variables = ALONG_ROD_IN_TIME
    match kind:
        case "weight":
            force = vector(*table.at("force"), names, variables, axes)
            check_all_finite(table.at("force")[0], force, names, until)
            return Weight(force)
        case "follower":
            vector(*table.at("force"), names, variables, _force_names(group))
        case "couple":
            _read_torque(*table.at("torque"), group, names, variables, until)
        case "field":
            vector(*table.at("moment"), names, variables, _force_names(group))
            vector(*table.at("field"), names, IN_TIME, axes)
        case "flow":
            matrix(*table.at("gradient"), names, FIXED, axes)
            numbers(*table.at("velocity"), names, axes)
        case "trap":
            number(*table.at("stiffness"), names, positive=True)
            numbers(*table.at("centre"), names, axes)
    available = " or ".join(AVAILABLE_EFFECTS)
    raise place.at("kind").unavailable(available, kind, "remove this effect")


def _force_names(group: Group) -> Sequence[str]:
    return group.wrench[: group.translations]


def _none_if_zero(load: tuple[Expression, ...] | None) -> Vector | None:
    """A load that is zero whatever the parameters are is no load, and leaves no term in the equations."""
    return None if load is None or all(e in (Number(0.0), Number(-0.0)) for e in load) else load
