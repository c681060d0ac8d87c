"""The law of a rod in a scene: a file beside the scene, or a table in it; and what it must be fit for to be run."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from geocosserat.algebra.groups import Group
from geocosserat.model.checks import points_along
from geocosserat.model.effects.law_wrench import LawWrench, law_wrench
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import ExpressionError, evaluate, symbols, to_text
from geocosserat.model.fields import Names, Table
from geocosserat.model.law import Law, law_of, rates
from geocosserat.model.linear import is_linear
from geocosserat.model.place import Found, Place, shown
from geocosserat.model.reading import Read, read
from geocosserat.model.records import RodModel, Start


def take_in_law(given: Read) -> bool:
    """Puts the tables of the law's file in place of its name, so that a scene is whole by itself; whether it did.

    The name is relative to the scene's folder. Raises InputError for a file that cannot be read or is no TOML.
    """
    rod = given.values.get("rod")
    if not isinstance(rod, dict) or not isinstance(rod.get("law"), str):
        return False
    folder = os.path.dirname(given.path) if given.path else ""
    try:
        rod["law"] = read(os.path.join(folder, rod["law"]), "law").values
    except InputError as error:
        found = Found(f"{shown(rod['law'])}: {error.found}")
        raise Place(given.file).at("rod").at("law").wrong(f"a law in {error.expected}", found, error.hint) from None
    return True


def read_law(rod: Table, group: Group, parameters: Mapping[str, float]) -> Law | None:
    """The law of the rod with the scene's values of its parameters; None if it has none.

    Raises InputError for a law of another motion, for parameters left open, and for a stress that is not linear in the
    rates of strain: what gives it in a rod that moves is a linear system.
    """
    if "law" not in rod:
        return None
    place, values = rod.at("law")
    if not isinstance(values, dict):
        raise place.wrong("the name of a file, or a table", values, 'write law = "file.toml"')
    law = law_of(place, values, parameters)
    if law.group != group:
        raise place.at("motion").wrong("a law for the motion of the rod", Found(f"one in {law.group.name}"))
    for name in law.open:
        raise place.at("parameters").at(name).wrong(
            "a number", Found("a parameter left open"), f"write {name} = ... under [parameters] of the scene"
        )
    for name, e in zip(group.stress, law.stress or (), strict=law.stress is not None):
        if not is_linear(e, rates(group)):
            raise place.at("stress").at(name).wrong(
                "a stress that is linear in the rates of strain",
                to_text(e),
                "write it as a sum in which each rate stands once, times what does not depend on rates",
            )
    return law


def read_law_wrench(place: Place, law: Law | None) -> tuple[LawWrench, ...]:
    """What the law says of the wrench, as an effect; nothing if it says nothing.

    Raises InputError for an angle that is not inside a sine or cosine: a rod in motion does not count its turns.
    """
    if law is None or law.wrench is None:
        return ()
    try:
        return (law_wrench(law),)
    except ExpressionError as error:
        raise place.at("wrench").wrong("cos(theta) and sin(theta)", Found("theta by itself"), str(error)) from None


def check_law_starts(place: Place, model: RodModel, start: Start, names: Names) -> None:
    """Raise InputError unless the stress is finite all along the rod at the start, as far as it is known by then: what
    rates of strain add to it follows from the balance."""
    if model.law is None or model.law.stress is None:
        return
    u = points_along(place, start.strain, names)
    turn: dict[str, Any] = {
        name: evaluate(e, {**names.parameters, "u": u})
        for name, e in zip(model.group.strain, start.strain, strict=True)
    }
    for name, e in zip(model.group.stress, model.law.stress, strict=True):
        still = dict.fromkeys(rates(model.group), 0.0)
        values = {k: x for k, x in {**names.parameters, "u": u, "t": 0.0, **turn, **still}.items() if k in symbols(e)}
        stress = np.broadcast_to(evaluate(e, values), u.shape)
        for at in u[~np.isfinite(stress)]:
            found = Found(f"another at u = {float(at):.6g}")
            raise place.at("stress").at(name).wrong("a finite stress at the start", found, "start from other strains")
