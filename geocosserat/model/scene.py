"""From a scene file to a Scene: every key is read, checked and either used or refused."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, cast

from geocosserat.algebra.groups import group_of
from geocosserat.model.effects.reading import read_effects
from geocosserat.model.ends import read_ends, read_joined
from geocosserat.model.fields import Names, Table, integer, number, number_between, word
from geocosserat.model.material import read_friction, read_frozen, read_reference, read_stiffness
from geocosserat.model.parameters import read_parameters
from geocosserat.model.place import NOTHING, Place
from geocosserat.model.reading import read
from geocosserat.model.records import Backend, End, RodModel, RunSettings, Scene
from geocosserat.model.rod_law import check_law_starts, read_law, read_law_wrench, take_in_law
from geocosserat.model.schema import (
    BACKENDS,
    DEFAULT_ACCURACY,
    DEFAULT_FRAMES,
    ENDS_KEYS,
    LEAST_ACCURACY,
    LENGTHS,
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
from geocosserat.model.start import read_start
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
    taken = take_in_law(given)
    apply_settings(given.values, settings, given.file)
    taken |= take_in_law(given)
    place = Place(given.file)
    table = Table(place, given.values, SCENE_KEYS)
    parameters = read_parameters(*table.at("parameters")) if "parameters" in table else {}
    rod = Table(*_required_table(table, "rod"), ROD_KEYS)
    group = group_of(word(*rod.at("motion"), MOTIONS))
    law = read_law(rod, group, parameters)
    parameters = {**(law.parameters if law else {}), **parameters}
    names = Names(parameters, _read_length(*rod.at("length"), Names(parameters)))
    run = _read_run(Table(*_required_table(table, "run"), RUN_KEYS), names)
    ends = Table(*_optional_table(table, "ends"), ENDS_KEYS)
    joined = read_joined(ends)
    left, right = (End("free"), End("free")) if joined else read_ends(ends, group, names, run.until)
    at, effects = table.at("effects")
    law_place = rod.at("law")[0]
    acting = read_effects(at, effects, group, names, run.until) if "effects" in table else ()
    reference = read_reference(rod, group, names, run.until, law)
    model = RodModel(
        group=group,
        length=names.length,
        stiffness=read_stiffness(rod, group, names, law, reference),
        friction=read_friction(rod, group, names, law),
        reference=reference,
        frozen=read_frozen(rod, group),
        left=left,
        right=right,
        effects=(*acting, *read_law_wrench(law_place, law)),
        joined=joined,
        parameters=parameters,
        law=law if law is not None and law.stress is not None else None,
    )
    start = read_start(Table(*_optional_table(table, "start"), START_KEYS), rod, model, names)
    check_law_starts(law_place, model, start, names)
    title = _read_title(*table.at("title")) if "title" in table else "untitled"
    unchanged = given.text is not None and not settings and not taken
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


def _read_length(place: Place, value: Any, names: Names) -> float:
    """One whose fourth power, by which rods relax, is a number as well, and not the last one."""
    length = number(place, value, names, positive=True)
    least, most = LENGTHS
    if not least <= length <= most:
        raise place.wrong(f"a length from {least:g} to {most:g}", value, "choose a unit of length nearer to the rod's")
    return length


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
