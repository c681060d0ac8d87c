"""From a scene file to a Scene: every key is read, checked and either used or refused."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np

from geocosserat.algebra.groups import Group, group_of
from geocosserat.model.checks import check_all_finite, check_positive, points_along
from geocosserat.model.ends import read_effects, read_ends, read_joined
from geocosserat.model.expressions import Number, constant, evaluate, steps, substitute, symbols
from geocosserat.model.fields import (
    ALONG_ROD,
    ALONG_ROD_IN_TIME,
    Names,
    Table,
    integer,
    matrix,
    number,
    number_between,
    numbers,
    vector,
    word,
)
from geocosserat.model.parameters import read_parameters
from geocosserat.model.place import NOTHING, Found, Place, shown
from geocosserat.model.reading import read
from geocosserat.model.records import Backend, End, Matrix, RodModel, RunSettings, Scene, Start, Vector
from geocosserat.model.schema import (
    BACKENDS,
    DEFAULT_ACCURACY,
    DEFAULT_FRAMES,
    ENDS_KEYS,
    LEAST_ACCURACY,
    MAX_DEGREE,
    MAX_ELEMENTS,
    MAX_FRAMES,
    METHODS,
    MOTIONS,
    ROD_KEYS,
    RUN_KEYS,
    SCENE_KEYS,
    START_KEYS,
)
from geocosserat.model.settings import apply_settings
from geocosserat.model.toml_text import to_toml

FROZEN_GAP = 1e-9
"""How far a frozen mode may start from its reference: the rounding of two ways to write the same."""


def load_scene(scene: str | os.PathLike[str] | Mapping[str, Any], settings: Sequence[str] = ()) -> Scene:
    """Read and check a scene from a TOML file, TOML text (a str with a line break) or a mapping.

    ``settings`` are ``key=value`` strings that change it first: ``kappa=1e5``, ``rod.length=2``,
    ``ends.right.force=[0, -2]``. The ``source`` of the result is the text that was read, or text that loads
    to the same scene if there was none or settings changed it.

    Raises InputError, with one message that says what to do, for anything wrong in the scene, and for what
    the scene format knows but this version does not do: nothing is silently ignored.
    """
    given = read(scene)
    settings = (settings,) if isinstance(settings, str) else tuple(settings)
    apply_settings(given.values, settings, given.file)
    place = Place(given.file)
    table = Table(place, given.values, SCENE_KEYS)
    parameters = read_parameters(*table.at("parameters")) if "parameters" in table else {}
    rod = Table(*_required_table(table, "rod"), ROD_KEYS)
    group = group_of(word(*rod.at("motion"), MOTIONS))
    names = Names(parameters, number(*rod.at("length"), Names(parameters), positive=True))
    run = _read_run(Table(*_required_table(table, "run"), RUN_KEYS), names)
    stiffness, friction, reference, frozen = _read_material(rod, group, names, run.until)
    ends = Table(*_optional_table(table, "ends"), ENDS_KEYS)
    joined = read_joined(ends)
    left, right = (End("free"), End("free")) if joined else read_ends(ends, group, names, run.until)
    at, effects = table.at("effects")
    model = RodModel(
        group=group,
        length=names.length,
        stiffness=stiffness,
        friction=friction,
        reference=reference,
        frozen=frozen,
        left=left,
        right=right,
        effects=read_effects(at, effects, group, names, run.until) if "effects" in table else (),
        joined=joined,
        parameters=parameters,
    )
    start = _read_start(Table(*_optional_table(table, "start"), START_KEYS), model, names)
    title = _read_title(*table.at("title")) if "title" in table else "untitled"
    unchanged = given.text is not None and not settings
    source = cast(str, given.text) if unchanged else to_toml(given.values)
    return Scene(title, model, start, run, source, given.path)


def _required_table(table: Table, key: str) -> tuple[Place, Any]:
    place, values = table.at(key)
    if key not in table:
        raise place.wrong("a table", NOTHING, f"write [{key}] above its keys")
    return place, values


def _optional_table(table: Table, key: str) -> tuple[Place, Any]:
    place, values = table.at(key)
    return place, values if key in table else {}


def _read_title(place: Place, value: Any) -> str:
    if not isinstance(value, str) or not value.isprintable() or len(value) > 200:
        raise place.wrong("one line of at most 200 characters", value, "write a title in quotes")
    return value


def _read_material(
    rod: Table, group: Group, names: Names, until: float
) -> tuple[Matrix, Matrix, Vector, tuple[str, ...]]:
    """Stiffness, friction, the turn at rest and the frozen modes."""
    if "law" in rod:
        place, law = rod.at("law")
        raise place.unavailable("no law file", law, "write rod.stiffness instead")
    frozen = _read_frozen(*rod.at("frozen"), group) if "frozen" in rod else ()
    stiffness = matrix(*rod.at("stiffness"), names, ALONG_ROD, group.strain)
    check_positive(
        rod.at("stiffness")[0], stiffness, names, group.strain, "a passive rod resists every deformation"
    )
    friction = matrix(*rod.at("friction"), names, ALONG_ROD, group.twist)
    moving = [i for i in range(group.dimension) if i < group.translations or not _nothing(friction, i)]
    check_positive(
        rod.at("friction")[0],
        [[friction[i][j] for j in moving] for i in moving],
        names,
        [group.twist[i] for i in moving],
        "every motion must be damped; only a rotation may have no friction at all (its whole row 0)",
    )
    if "reference" not in rod:
        return stiffness, friction, _straight(group), frozen
    place, values = rod.at("reference")
    reference = vector(place, values, names, ALONG_ROD_IN_TIME, group.strain)
    check_all_finite(place, reference, names, until)
    for i, e in enumerate(reference):
        if any("t" in symbols(step) for step in steps(e)):
            found = Found(f"{shown(values[i])}, which jumps in time")
            raise place.at(i).wrong("a reference that changes smoothly in time", found, "write a steep tanh instead")
    return stiffness, friction, reference, frozen


def _nothing(matrix: Matrix, i: int) -> bool:
    """Whether row and column i are literally zero."""
    return all(constant(matrix[i][j]) == 0.0 == constant(matrix[j][i]) for j in range(len(matrix)))


def _straight(group: Group) -> Vector:
    return (Number(1.0), *(Number(0.0) for _ in group.strain[1:]))


def _read_frozen(place: Place, modes: Any, group: Group) -> tuple[str, ...]:
    """Modes held at their reference, in the order of the group; never all of them."""
    if not isinstance(modes, list):
        raise place.wrong("a list of modes", modes, f"choose from {', '.join(group.strain)}")
    named = {word(place.at(i), mode, group.strain) for i, mode in enumerate(modes)}
    if len(named) == group.dimension:
        raise place.wrong(
            "a mode that is free", Found("every mode frozen"), "leave one out: a rigid body is not a rod"
        )
    return tuple(mode for mode in group.strain if mode in named)


def _read_start(table: Table, model: RodModel, names: Names) -> Start:
    group = model.group
    strain = tuple(substitute(e, {"t": Number(0.0)}) for e in model.reference)
    if "strain" in table:
        place, values = table.at("strain")
        strain = vector(place, values, names, ALONG_ROD, group.strain)
        check_all_finite(place, strain, names)
        _check_frozen_start(place, strain, model, names)
    axes = ("x", "y", "z")[: group.space]
    position = numbers(*table.at("position"), names, axes) if "position" in table else (0.0,) * group.space
    right_key, wrong_key = ("angle", "rotation") if group.rotations == 1 else ("rotation", "angle")
    if wrong_key in table:
        how = "angle = a number" if group.rotations == 1 else "rotation = [x, y, z], a rotation vector"
        raise table.at(wrong_key)[0].wrong(right_key, Found(f"{wrong_key}"), f"this motion takes {how}")
    if right_key not in table:
        rotation: tuple[float, ...] = (0.0,) * group.rotations
    elif group.rotations == 1:
        rotation = (number(*table.at("angle"), names),)
    else:
        rotation = numbers(*table.at("rotation"), names, axes)
    return Start(strain, position, rotation)


def _check_frozen_start(place: Place, strain: Vector, model: RodModel, names: Names) -> None:
    """Raise InputError unless frozen modes start at their reference."""
    for i in (i for i, held in enumerate(model.held) if held):
        u = points_along(place.at(i), [strain[i], model.reference[i]], names)
        values = {**names.parameters, "u": u, "t": 0.0}
        gap = np.abs(np.asarray(evaluate(strain[i], values)) - np.asarray(evaluate(model.reference[i], values)))
        if np.any(gap > FROZEN_GAP):
            raise place.at(i).wrong(
                f"{model.group.strain[i]} at its reference, since it is frozen",
                Found(f"a difference of {float(gap.max()):.3g}"),
                "write the reference here, or leave start.strain out",
            )


def _read_run(table: Table, names: Names) -> RunSettings:
    """The run; the accuracy has a default unless the mesh is chosen by hand."""

    def optional_integer(key: str, high: int) -> int | None:
        return integer(*table.at(key), names, 1, high) if key in table else None

    def tolerance(key: str) -> float | None:
        return number(*table.at(key), names, positive=True) if key in table else None

    accuracy = None if "elements" in table else DEFAULT_ACCURACY
    if "accuracy" in table:
        accuracy = number_between(*table.at("accuracy"), names, LEAST_ACCURACY, 1.0)
    return RunSettings(
        until=number(*table.at("until"), names, positive=True),
        frames=integer(*table.at("frames"), names, 2, MAX_FRAMES) if "frames" in table else DEFAULT_FRAMES,
        accuracy=accuracy,
        elements=optional_integer("elements", MAX_ELEMENTS),
        degree=optional_integer("degree", MAX_DEGREE),
        method=word(*table.at("method"), METHODS) if "method" in table else None,
        rtol=tolerance("rtol"),
        atol=tolerance("atol"),
        backend=cast(Backend, word(*table.at("backend"), BACKENDS) if "backend" in table else "auto"),
    )
