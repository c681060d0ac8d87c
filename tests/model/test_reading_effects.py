"""Effects read from scenes: every key of every kind, and every way to get it wrong."""

from __future__ import annotations

import re
from typing import Any

import pytest

from geocosserat.model.effects.catalogue import kind
from geocosserat.model.effects.effect import Key
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import parse, to_text
from geocosserat.model.scene import load_scene
from tests.model.posed import ENTRIES, KINDS, read, scene_with
from tests.model.scenes import MISSING, SPATIAL, changed

KEYS = [(name, space, key, kind(name).keys[key]) for name, space in ENTRIES for key in kind(name).keys]
ENTRIES_OF = {
    # shape: how many numbers it is written with in the plane and in space; None: without brackets
    "scalar": (None, None), "world": (2, 3), "body": (2, 3), "moment": (None, 3), "matrix": (2, 3),
}  # fmt: skip


def refused(name: str, space: int, key: str, value: Any, wording: str) -> None:
    """Asserts that an effect with this value is refused in these words."""
    values = dict(ENTRIES[name, space]) | {key: value}
    if value is MISSING:
        del values[key]
    with pytest.raises(InputError, match=wording) as caught:
        load_scene(scene_with(name, space, values))
    assert "\n" not in str(caught.value)


def with_entry(size: int | None, entry: Any, shape: str) -> tuple[Any, str]:
    """A value of this shape with the entry last, and where in it that is."""
    if size is None:
        return entry, ""
    if shape == "matrix":
        return [[0] * size] * (size - 1) + [[*[0] * (size - 1), entry]], f".{size - 1}.{size - 1}"
    return [*[0] * (size - 1), entry], f".{size - 1}"


@pytest.mark.parametrize(("name", "space"), list(ENTRIES))
def test_every_value_is_read_as_it_is_written(name: str, space: int) -> None:
    """Each key, in its order, rows one after the other."""
    for key, found in read(name, space).values().items():
        written = ENTRIES[name, space][key]
        flat = written if isinstance(written, list) else [written]
        flat = [x for row in flat for x in (row if isinstance(row, list) else [row])]
        assert found == tuple(parse(x, {"u", "t", "load"}) for x in flat)


@pytest.mark.parametrize("side", ["source", "setting"])
@pytest.mark.parametrize(("name", "space"), list(ENTRIES))
def test_every_effect_survives_being_written_and_set(name: str, space: int, side: str) -> None:
    """As TOML text, and with one value set from outside to what it is."""
    scene = load_scene(scene_with(name, space))
    if side == "source":
        assert load_scene(scene.source).model == scene.model
    else:
        key, value = next(iter(ENTRIES[name, space].items()))
        assert load_scene(scene_with(name, space), [f"effects.0.{key}={value!r}"]).model == scene.model


@pytest.mark.parametrize(("name", "space", "key", "how"), KEYS)
def test_a_key_that_is_missing_is_asked_for(name: str, space: int, key: str, how: Key) -> None:
    """No value has a default."""
    refused(name, space, key, MISSING, rf"^scene: effects\.0\.{key}: expected .*, found nothing; write ")


@pytest.mark.parametrize(("name", "space", "key", "how"), KEYS)
def test_a_value_of_another_length_is_refused(name: str, space: int, key: str, how: Key) -> None:
    """One too many, one too few, brackets where there are none."""
    size = ENTRIES_OF[how.shape][space - 2]
    place = rf"^scene: effects\.0\.{key}"
    if size is None:
        refused(name, space, key, [1], rf"{place}: expected .*, found \[1\]; write ")
        return
    for wrong in (size - 1, size + 1):
        refused(
            name, space, key, [1] * wrong, rf"{place}: expected a list of {size} .*, found a list of {wrong}; write"
        )
    refused(name, space, key, 1, rf"{place}: expected a list of {size} .*, found 1; write")
    if how.shape == "matrix":
        rows = [[1] * size for _ in range(size - 1)]
        refused(name, space, key, [*rows, [1] * (size - 1)], rf"{place}\.{size - 1}: expected a list of {size}")


@pytest.mark.parametrize("wrong", [True, {"a": 1}, None])
@pytest.mark.parametrize(("name", "space", "key", "how"), KEYS)
def test_a_value_of_another_type_is_refused(name: str, space: int, key: str, how: Key, wrong: Any) -> None:
    """At the top and inside."""
    refused(name, space, key, wrong, rf"^scene: effects\.0\.{key}: expected ")
    value, inside = with_entry(ENTRIES_OF[how.shape][space - 2], wrong, how.shape)
    refused(
        name, space, key, value, rf"^scene: effects\.0\.{key}{re.escape(inside)}: expected a number or an expression"
    )


@pytest.mark.parametrize(("name", "space", "key", "how"), KEYS)
def test_a_value_is_finite_wherever_and_whenever_it_is_used(name: str, space: int, key: str, how: Key) -> None:
    """All along the rod, and from the start to the end of the run."""
    for variable in how.varies:
        value, inside = with_entry(ENTRIES_OF[how.shape][space - 2], f"1/({variable} - 0.5)", how.shape)
        wording = (
            rf"effects\.0\.{key}{re.escape(inside)}: expected a finite value, found inf at {variable} = 0.5; change"
        )
        refused(name, space, key, value, wording)
    value, inside = with_entry(ENTRIES_OF[how.shape][space - 2], "1/0", how.shape)
    refused(
        name, space, key, value, rf"effects\.0\.{key}{re.escape(inside)}: expected a finite number, found '1/0' = inf"
    )


@pytest.mark.parametrize(("name", "space", "key", "how"), KEYS)
def test_a_value_varies_only_with_what_it_may(name: str, space: int, key: str, how: Key) -> None:
    """A field, a flow and a centre are the same all along the rod; all else may vary along it and in time."""
    size = ENTRIES_OF[how.shape][space - 2]
    for variable in "ust":
        value, inside = with_entry(size, f"1 + {variable}", how.shape)
        if variable.replace("s", "u") in how.varies:
            found = read(name, space, dict(ENTRIES[name, space]) | {key: value}).values()[key][-1]
            assert to_text(found) == f"1 + {variable}".replace("s", "u/2" if space == 3 else "u/1")
        else:
            wording = (
                rf"effects\.0\.{key}{re.escape(inside)}: expected .*, which depends on {variable}; remove {variable}$"
            )
            refused(name, space, key, value, wording)


def test_what_varies_is_what_the_documentation_says() -> None:
    """In space and time, or in time alone."""
    timed = {(name, key) for name in KINDS for key, how in kind(name).keys.items() if how.varies == "t"}
    assert timed == {("field", "field"), ("flow", "gradient"), ("flow", "velocity"), ("trap", "centre")}
    assert {how.varies for name in KINDS for how in kind(name).keys.values()} == {"t", "ut"}


@pytest.mark.parametrize(("name", "space", "key", "how"), KEYS)
def test_steps_along_the_rod_are_at_known_places(name: str, space: int, key: str, how: Key) -> None:
    """Elements end on them, so they must not move; steps in time may be anywhere."""
    size = ENTRIES_OF[how.shape][space - 2]
    value, _ = with_entry(size, "heaviside(sin(9*t))", how.shape)
    assert read(name, space, dict(ENTRIES[name, space]) | {key: value})
    if "u" in how.varies:
        value, inside = with_entry(size, "heaviside(u - t)", how.shape)
        refused(name, space, key, value, rf"{key}{re.escape(inside)}: expected steps at known places, .* must not move")


@pytest.mark.parametrize("name", KINDS)
def test_a_key_that_is_unknown_is_an_error_with_the_nearest(name: str) -> None:
    """Misspelt, or of another effect."""
    key = next(iter(kind(name).keys))
    refused(name, 2, f"{key}s", 1, rf"effects\.0\.{key}s: expected one of kind, {key}.*; did you mean {key}\?$")
    refused(name, 2, "mass", 1, r"effects\.0\.mass: expected one of kind, .*, found an unknown key")


@pytest.mark.parametrize(
    ("written", "wording"),
    [
        ({"kind": "traps"}, r"effects\.0\.kind: expected one of couple, .*, found 'traps'; did you mean trap\?"),
        ({"kind": "wind"}, r"effects\.0\.kind: expected one of .*, found 'wind'"),
        ({"kind": 3}, r"effects\.0\.kind: .*, found 3; write one of the words in quotes"),
        ({"force": [0, 0, 1]}, r"effects\.0\.kind: .*, found nothing; write one of the words in quotes"),
    ],
)
def test_a_kind_is_one_that_is_known(written: dict[str, Any], wording: str) -> None:
    """The nearest is suggested; nothing else of the effect is looked at before."""
    with pytest.raises(InputError, match=wording):
        load_scene(changed(SPATIAL, "effects", [written]))


def test_effects_act_together() -> None:
    """Any number, also of one kind, in the order of the file; a wrong one is named by its place."""
    entries = [{"kind": name, **ENTRIES[name, 3]} for name in (*KINDS, "trap", "weight")]
    effects = load_scene(changed(SPATIAL, "effects", entries)).model.effects
    assert [effect.kind for effect in effects] == [*KINDS, "trap", "weight"]
    with pytest.raises(InputError, match=r"^scene: effects\.6\.stiffness: expected"):
        load_scene(changed(SPATIAL, "effects", [*entries[:6], {"kind": "trap", "stiffness": "x", "centre": [0, 0, 0]}]))
