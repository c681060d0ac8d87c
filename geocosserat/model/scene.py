"""From a scene file to a Scene: every key is read, checked and either used or refused."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, cast

from geocosserat.algebra.groups import Group, group_of
from geocosserat.model.checks import check_all_finite, check_positive
from geocosserat.model.ends import read_effects, read_ends
from geocosserat.model.expressions import Number, symbols
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
from geocosserat.model.place import NOTHING, Found, Place
from geocosserat.model.reading import read
from geocosserat.model.records import Backend, Matrix, RodModel, RunSettings, Scene, Start, Vector
from geocosserat.model.schema import (
    BACKENDS,
    DEFAULT_ACCURACY,
    DEFAULT_FRAMES,
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
    stiffness, friction, reference = _read_material(rod, group, names)
    ends = _optional_table(table, "ends")
    left, right = read_ends(*ends, group, names, run.until)
    at, effects = table.at("effects")
    model = RodModel(
        group=group,
        length=names.length,
        stiffness=stiffness,
        friction=friction,
        reference=reference,
        frozen=(),
        left=left,
        right=right,
        effects=read_effects(at, effects, group, names, run.until) if "effects" in table else (),
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


def _read_material(rod: Table, group: Group, names: Names) -> tuple[Matrix, Matrix, Vector]:
    """Stiffness, friction and the turn at rest."""
    if "law" in rod:
        place, law = rod.at("law")
        raise place.unavailable("no law file", law, "write rod.stiffness instead")
    if "frozen" in rod:
        _refuse_frozen(*rod.at("frozen"), group)
    stiffness = matrix(*rod.at("stiffness"), names, ALONG_ROD, group.strain)
    check_positive(
        rod.at("stiffness")[0], stiffness, names, group.strain, "a passive rod resists every deformation"
    )
    friction = matrix(*rod.at("friction"), names, ALONG_ROD, group.twist)
    check_positive(
        rod.at("friction")[0], friction, names, group.twist,
        "every motion must be damped (no friction for a rotation is not available in this version)",
    )  # fmt: skip
    if "reference" not in rod:
        return stiffness, friction, _straight(group)
    place, values = rod.at("reference")
    reference = vector(place, values, names, ALONG_ROD_IN_TIME, group.strain)
    for i, e in enumerate(reference):
        if "t" in symbols(e):
            hint = "write an expression of u without t"
            raise place.at(i).unavailable("a reference that does not change in time", values[i], hint)
    check_all_finite(place, reference, names)
    return stiffness, friction, reference


def _straight(group: Group) -> Vector:
    return (Number(1.0), *(Number(0.0) for _ in group.strain[1:]))


def _refuse_frozen(place: Place, modes: Any, group: Group) -> None:
    if not isinstance(modes, list):
        raise place.wrong("a list of modes", modes, f"choose from {', '.join(group.strain)}")
    for i, mode in enumerate(modes):
        word(place.at(i), mode, group.strain)
    if modes:
        raise place.unavailable("no frozen mode", modes, "remove it and give these modes a large stiffness")


def _read_start(table: Table, model: RodModel, names: Names) -> Start:
    group = model.group
    strain = model.reference
    if "strain" in table:
        strain = vector(*table.at("strain"), names, ALONG_ROD, group.strain)
        check_all_finite(table.at("strain")[0], strain, names)
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
