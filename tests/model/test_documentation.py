"""What docs/effects.md and docs/scenes.md show works as they say."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocosserat.model import reading
from geocosserat.model.effects.catalogue import EFFECTS
from geocosserat.model.effects.effect import Shape
from geocosserat.model.expressions import FUNCTIONS, Number
from geocosserat.model.scene import load_scene
from geocosserat.model.seen import seen
from tests.model.posed import pose, potential, read, wrench
from tests.model.scenes import PLANAR, SPATIAL, changed

DOCS = Path(__file__).parents[2] / "docs"
TEXT = (DOCS / "effects.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
# text that is run as a user would run it, apart from the tests' own names
PROGRAMS = [
    compile(text, "docs/effects.md", "exec", dont_inherit=True) for language, text in BLOCKS if language == "python"
]


def test_the_examples_of_the_documentation_are_short() -> None:
    """Under twenty lines each."""
    assert len(PROGRAMS) == 2
    assert all(len(text.splitlines()) < 20 for language, text in BLOCKS if language == "python")


@pytest.mark.parametrize("space", [2, 3])
def test_the_floor_of_the_documentation_pushes_up_as_it_says(space: int) -> None:
    """The program as printed, the scene as printed: strength exp(-height/depth), upwards, and no moment."""
    exec(PROGRAMS[0], {"__name__": "own"})
    (scene,) = [text for language, text in BLOCKS if language == "toml"]
    weight, floor = load_scene(scene).model.effects
    assert (weight.kind, floor.kind) == ("weight", "floor")
    assert str(floor) == "floor of strength (2 + u), depth (0.05)"
    if space == 3:
        floor = read("floor", 3, {"strength": "2 + u", "depth": 0.05})
    for seed in range(3):
        g = pose(space, seed)
        g[-1, 0] = height = 0.02 + 0.05 * seed
        found = wrench(floor, g, u=0.4)
        upwards = np.eye(space)[-1] * 2.4 * np.exp(-height / 0.05)
        np.testing.assert_allclose(g[1:, 1:] @ found[:space], upwards, rtol=0, atol=1e-14)
        assert not found[space:].any()
        assert potential(floor, g, u=0.4) == pytest.approx(2.4 * 0.05 * np.exp(-height / 0.05))
    assert floor.needs(seen(space)) == "pose"


@pytest.mark.parametrize("space", [2, 3])
def test_the_swirl_of_the_documentation_goes_around_the_origin(space: int) -> None:
    """A wrench written by hand, without a potential."""
    exec(PROGRAMS[1], {"__name__": "own"})
    swirl, g = read("swirl", space, {"rate": "2*t"}), pose(space, 1)
    x, y = g[1:3, 0]
    expected = 1.4 * np.array([-y, x, 0.0][:space])
    found = wrench(swirl, g)
    np.testing.assert_allclose(g[1:, 1:] @ found[:space], expected, rtol=0, atol=1e-14)
    assert swirl.potential(seen(space)) is None


def test_the_documentation_lists_what_there_is() -> None:
    """Every effect with its keys, every shape of a key, every function."""
    for each in EFFECTS:
        (row,) = re.findall(rf"^\| `{each.kind}` \| (`.*)$", TEXT, re.MULTILINE)
        assert all(f"`{key}`" in row.split(" | ")[0] for key in each.keys)
        needs = {"direction": "directions", "pose": "the place", "nothing": "nothing"}
        assert needs[read(each.kind, 3).needs(seen(3))] == row.split(" | ")[2]
        assert (row.split(" | ")[3] == "none |") == (read(each.kind, 3).potential(seen(3)) is None)
    for shape in Shape.__args__:  # type: ignore[attr-defined]
        assert f"`{shape}`" in TEXT.split("**Keys.**")[1].split("**Formulas**")[0]
    listed = re.findall(r"`(sin cos [^`]*)`", TEXT)[0].split()
    assert [name.rstrip("_") for name in sorted(listed)] == sorted(set(FUNCTIONS) - {"heaviside"})


def test_the_scenes_of_the_documentation_are_scenes() -> None:
    """Every fragment in docs/scenes.md, in the scene around it that it is for."""
    text = (DOCS / "scenes.md").read_text(encoding="utf-8")
    whole, *fragments = re.findall(r"^```toml\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    assert load_scene(whole).model.effects
    loaded = []
    for fragment in fragments:
        tables = load_tables(fragment)
        rod = tables.get("rod", {})
        spatial = "h3" in rod.get("frozen", ()) or len(rod.get("friction", ())) == 6 or "left" in tables.get("ends", {})
        scene = SPATIAL if spatial else PLANAR
        if tables.get("ends") == {"joined": True}:
            scene = changed(scene, "rod.reference", [1, 0, "2*pi"])
        loaded.append(load_scene({**scene, **tables, "rod": {**scene["rod"], **rod}}).model)
    frozen, quasistatic, wave, held, joined, circle, acted = loaded
    assert frozen.frozen == ("h1", "h2", "h3")
    assert quasistatic.friction[5][5] == Number(0.0)
    assert wave.reference[2] != Number(0.0)
    assert (held.left.kind, held.right.kind) == ("driven", "pinned")
    assert joined.joined
    assert circle.group.space == 2
    assert sorted(effect.kind for effect in acted.effects) == sorted(each.kind for each in EFFECTS)


def load_tables(text: str) -> dict[str, Any]:
    """The tables of a fragment of TOML."""
    return reading.read(text).values
