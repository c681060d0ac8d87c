"""The two ends of the rod: how each is held or loaded, or that they are joined."""

from __future__ import annotations

from typing import Any, cast

from geocosserat.algebra.groups import Group
from geocosserat.model.checks import check_all_finite, check_written
from geocosserat.model.expressions import Number
from geocosserat.model.fields import IN_TIME, Names, Table, moment, vector, word
from geocosserat.model.place import Found, Place
from geocosserat.model.records import End, Frame, Vector
from geocosserat.model.schema import END_KEYS, END_KINDS, FRAMES, SIDES

_REFUSED = {"clamped": ("force", "torque", "frame"), "driven": ("force", "torque", "frame"), "pinned": ("force",)}


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
    _refuse(table, kind)
    twist = force = torque = None
    if kind == "driven":
        at, values = table.at("twist")
        twist = vector(at, values, names, IN_TIME, group.twist)
        check_all_finite(at, twist, names, until)
    if "force" in table:
        at, values = table.at("force")
        force = vector(at, values, names, IN_TIME, group.wrench[: group.translations])
        check_all_finite(at, force, names, until)
    if "torque" in table:
        at, values = table.at("torque")
        torque = moment(at, values, names, IN_TIME, group.wrench[group.translations :])
        check_written(at, values, torque, names, until)
    frame = word(*table.at("frame"), FRAMES) if "frame" in table else "body"
    force, torque = _none_if_zero(force), _none_if_zero(torque)
    return End(kind, force, torque, cast(Frame, frame) if force or torque else "body", twist)


def _refuse(table: Table, kind: str) -> None:
    """Raise InputError for what an end of this kind cannot have."""
    for key in _REFUSED.get(kind, ()):
        if key in table:
            what = "force" if kind == "pinned" else "load"
            hint = "it cannot move it; remove this, or free the end"
            raise table.at(key)[0].wrong(f"no {what} on a {kind} end", Found("one"), hint)
    if kind != "driven" and "twist" in table:
        hint = 'only kind = "driven" takes one; remove it'
        raise table.at("twist")[0].wrong(f"no twist of a {kind} end", Found("one"), hint)


def _none_if_zero(load: Vector | None) -> Vector | None:
    """A load that is zero whatever the parameters are is no load, and leaves no term in the equations."""
    return None if load is None or all(e == Number(0.0) for e in load) else load
