"""Changing a scene from outside: ``key=value`` settings, where the key is a parameter or a dotted path."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from typing import Any

from geocosserat.model.effects.catalogue import kind, kinds
from geocosserat.model.parser import nearest
from geocosserat.model.place import Found, Place, shown
from geocosserat.model.schema import scene_paths


def apply_settings(values: dict[str, Any], settings: Iterable[str], file: str) -> None:
    """Change ``values``, the plain tables of a scene, in place by ``key=value`` settings, in their order.

    The key is the name of a parameter, or a path such as ``rod.length``, ``ends.right.force``,
    ``effects.0.force`` or ``rod.stiffness.2``. The value is TOML, or else an expression or word as it is.
    Raises InputError for a setting that is no ``key=value`` and for an unknown key, with the nearest known.
    """
    for setting in settings:
        key, value = _split(setting, file)
        set_value(values, key, value, file)


def set_value(values: dict[str, Any], key: str, value: Any, file: str) -> None:
    """Set one parameter or dotted path in the plain tables of a scene. InputError for an unknown one."""
    steps = _steps(values, key, file)
    target: Any = values
    place = Place(file)
    for step, following in zip(steps, [*steps[1:], None], strict=True):
        if isinstance(target, list):
            index = _index(place, target, step)
            if following is None:
                target[index] = value
            else:
                target = target[index]
        elif not isinstance(target, dict):
            raise place.wrong("a table or a list", target, f"set {place.key} as a whole")
        elif following is None:
            target[step] = value
        else:
            target = target.setdefault(step, {})
        place = place.at(step)


def _split(setting: str, file: str) -> tuple[str, Any]:
    key, equals, text = setting.partition("=") if isinstance(setting, str) else ("", "", "")
    key, text = key.strip(), text.strip()
    if not (equals and key and text):
        raise Place(file, "--set").wrong("key=value", setting, "write for example rod.length=2")
    return key, _value(text)


def _value(text: str) -> Any:
    try:
        read = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    return read["value"] if set(read) == {"value"} else text  # a line break may smuggle in more keys


def _steps(values: dict[str, Any], key: str, file: str) -> list[str]:
    parameters = values.get("parameters")
    names = list(parameters) if isinstance(parameters, dict) else []
    if key in names or key in _of_law(values):
        return ["parameters", key]
    steps = key.split(".")
    known = scene_paths()
    if any(key == path or key.startswith(path + ".") for path in known):
        return steps
    if steps[0] == "parameters" and ".".join(steps[1:]) in names:
        return steps
    if steps[0] == "effects":
        keys = {"kind", *(each for name in kinds() for each in kind(name).keys)}
        if len(steps) == 1 or (len(steps) > 2 and steps[1].isdigit() and steps[2] in keys):
            return steps
        index = steps[1] if steps[1].isdigit() else "0"
        known = tuple(f"effects.{index}.{each}" for each in sorted(keys))
    raise _unknown(key, names, known, file)


def _of_law(values: dict[str, Any]) -> tuple[str, ...]:
    """Names of the parameters of the rod's law, which those of the scene override."""
    for step in ("rod", "law", "parameters"):
        values = values.get(step, {})
        if not isinstance(values, dict):
            return ()
    return tuple(values)


def _unknown(key: str, names: list[str], known: tuple[str, ...], file: str) -> Exception:
    inside = [path for path in known if path.startswith(key + ".")]
    like = nearest(key, [*names, *known])
    if inside:
        hint = f"{key} is a table: set {', '.join(inside[:9])}"
    elif like:
        hint = f"did you mean {like}?"
    else:
        hint = "set " + (f"a parameter ({', '.join(names[:9])}) or " if names else "") + "a path such as rod.length"
    place = Place(file, key if len(key) <= 60 and key.isprintable() else shown(key))
    return place.wrong("a parameter of the scene or a path in it", Found("neither"), hint)


def _index(place: Place, target: list[Any], step: str) -> int:
    if not (step.isascii() and step.isdigit() and len(step) < 9 and int(step) < len(target)):
        last = f"an index from 0 to {len(target) - 1}" if target else "no index into an empty list"
        raise place.wrong(last, step, f"or set {place.key} as a whole")
    return int(step)
