"""The rod at time 0: its turn, and where its left end is."""

from __future__ import annotations

import math

import numpy as np

from geocosserat.model.checks import Array, check_all_finite, points_along
from geocosserat.model.expressions import evaluate, fixed
from geocosserat.model.fields import ALONG_ROD, Names, Table, number, numbers, vector
from geocosserat.model.place import Found, Place
from geocosserat.model.records import RodModel, Start, Vector
from geocosserat.model.ring import gap
from geocosserat.model.seen import AXES

FROZEN_GAP = 1e-9
"""How far a frozen mode may start from its reference: the rounding of two ways to write the same. Relative to 1, to 1 /
length for bends and twist, or to the reference if that is larger."""
OPEN = 1e-6
"""How far a ring may be open: of its length, and in radians."""


def read_start(table: Table, rod: Table, model: RodModel, names: Names) -> Start:
    """The start; the reference at time 0, with the left end at the origin along x, unless the scene says otherwise."""
    group = model.group
    strain = tuple(fixed(e, "t", 0.0) for e in model.reference)
    place = rod.at("reference")[0]
    if "strain" in table:
        place, values = table.at("strain")
        strain = vector(place, values, names, ALONG_ROD, group.strain)
        check_all_finite(place, strain, names)
        _check_frozen(place, strain, model, names)
    if model.joined:
        _check_closed(place, strain, model, names)
    axes = AXES[: group.space]
    position = numbers(*table.at("position"), names, axes) if "position" in table else (0.0,) * group.space
    return Start(strain, position, _read_rotation(table, group.rotations, names))


def _read_rotation(table: Table, rotations: int, names: Names) -> tuple[float, ...]:
    key, other, how = "rotation", "angle", "rotation = [x, y, z], a rotation vector"
    if rotations == 1:
        key, other, how = "angle", "rotation", "angle = a number"
    if other in table:
        raise table.at(other)[0].wrong(key, Found(other), f"this motion takes {how}")
    if key not in table:
        return (0.0,) * rotations
    return (number(*table.at(key), names),) if rotations == 1 else numbers(*table.at(key), names, AXES)


def _check_frozen(place: Place, strain: Vector, model: RodModel, names: Names) -> None:
    """Raise InputError unless frozen modes start at their reference."""
    for i in (i for i, held in enumerate(model.held) if held):
        u = points_along(place.at(i), [strain[i], model.reference[i]], names)
        values: dict[str, float | Array] = {**names.parameters, "u": u, "t": 0.0}
        found, expected = (np.asarray(evaluate(e, values)) for e in (strain[i], model.reference[i]))
        unit = 1.0 if i < model.group.translations else 1.0 / names.length
        gaps = np.abs(found - expected)
        if np.any(gaps > FROZEN_GAP * np.maximum(unit, np.abs(expected))):
            raise place.at(i).wrong(
                f"{model.group.strain[i]} at its reference, since it is frozen",
                Found(f"a difference of {float(gaps.max()):.3g}"),
                "write the reference here, or leave start.strain out",
            )


def _check_closed(place: Place, strain: Vector, model: RodModel, names: Names) -> None:
    """Raise InputError unless the ends meet and are turned alike."""
    distance, angle = gap(model.group, strain, names)
    if not max(distance, angle) <= OPEN:
        apart = f"ends {distance:.3g} of the length apart and turned by {angle:.3g} rad"
        raise place.wrong(
            "a closed ring, since the ends are joined",
            Found(apart if math.isfinite(distance) else "strains too large for that"),
            f"change these strains; in a circle {model.group.strain[-1]} is 2*pi over the length",
        )
