"""The scenes in ``examples/``: each loads, says what one sees, and shows what its name says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocosserat.model.expressions import Number, evaluate, jump_positions, symbols
from geocosserat.model.scene import load_scene
from geocosserat.model.schema import END_KINDS

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
NAMES = {file.stem for file in EXAMPLES}
EFFECTS = ("weight", "follower", "couple", "field", "flow", "trap")
PROMISED = {
    "cantilever", "chiral", "cilium", "circle", "couple", "driven", "elastica", "euler_bernoulli", "follower",
    "hanging", "helix", "inextensible", "kirchhoff", "magnetic", "pinned", "pure_stretch", "pure_twist", "ring",
    "sinking", "spun", "stepped", "swimmer", "towed", "trapped", "tumbling", "unshearable",
}  # fmt: skip


def test_the_promised_examples_are_there() -> None:
    """Deleting an example is noticed."""
    assert PROMISED <= NAMES


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda file: file.stem)
def test_every_example_loads_and_says_what_one_sees(file: Path) -> None:
    """The first line is one comment; the scene has a title, an accuracy and prints itself."""
    scene = load_scene(file)
    first, second = file.read_text(encoding="utf-8").splitlines()[:2]
    assert first.startswith("# ")
    assert 60 < len(first) <= 120
    assert second.startswith("title = ")
    assert scene.run.accuracy == 1e-6
    printed = str(scene)
    assert scene.title in printed
    assert all(name in printed for name in scene.model.group.strain + scene.model.group.twist)


def test_the_cantilever_is_the_measured_one() -> None:
    """The numbers of the cantilever whose tip is known to ten digits."""
    scene = load_scene(next(file for file in EXAMPLES if file.stem == "cantilever"))
    model = scene.model
    assert model.parameters == {"kappa": 1e4}
    assert [evaluate(model.stiffness[i][i], model.parameters) for i in range(3)] == [1e4, 1e4, 1.0]
    assert [evaluate(model.friction[i][i], {}) for i in range(3)] == [1.0, 1.0, 0.01]
    u = np.linspace(0, 1, 5)
    np.testing.assert_allclose(evaluate(scene.start.strain[2], {"u": u}), 3 * (1 - u) ** 2 * (1 + 2 * u))
    assert (model.left.kind, model.right.kind) == ("clamped", "free")
    assert (scene.run.until, scene.run.frames) == (0.05, 51)


def test_the_examples_show_what_their_names_say() -> None:
    """Every kind of thing the format offers occurs in some example."""
    scenes = {file.stem: load_scene(file) for file in EXAMPLES}
    helix = scenes["helix"].model
    assert len({evaluate(helix.stiffness[i][i], helix.parameters) for i in range(6)}) == 6
    assert len({evaluate(helix.friction[i][i], helix.parameters) for i in range(6)}) == 6
    assert helix.right.frame == "world"
    assert scenes["sinking"].model.left.kind == scenes["sinking"].model.right.kind == "free"
    assert scenes["hanging"].model.effects
    stepped = scenes["stepped"].model
    assert jump_positions(stepped.stiffness[2][2], stepped.length, stepped.parameters) == (0.5,)
    assert symbols(scenes["chiral"].model.stiffness[3][5]) == {"coupling"}
    follower = scenes["follower"].model.right
    assert follower.frame == "body"
    assert follower.force is not None
    assert "t" in symbols(follower.force[1])
    circle = scenes["circle"].model
    assert circle.right.torque is not None
    assert evaluate(circle.right.torque[0], circle.parameters) == pytest.approx(2 * np.pi)


def test_every_effect_and_every_kind_of_end_has_an_example() -> None:
    """So have joined ends, frozen modes, a rotation without friction, and a reference that changes in time."""
    models = [load_scene(file).model for file in EXAMPLES]
    assert {effect.kind for model in models for effect in model.effects} == set(EFFECTS)
    assert {end.kind for model in models for end in (model.left, model.right)} >= set(END_KINDS)
    assert any(model.joined for model in models)
    assert any(model.friction[-1][-1] == Number(0.0) for model in models)
    assert any("t" in symbols(e) for model in models for e in model.reference)


def test_every_limit_has_an_example() -> None:
    """Euler and Bernoulli's, Kirchhoff's, Timoshenko's without stretch, without shear, pure twist, pure stretch."""
    frozen = {tuple(load_scene(file).model.frozen) for file in EXAMPLES}
    assert {("h1", "h2"), ("h1", "h2", "h3"), ("h1",), ("h2",), ("h2", "Pi")} <= frozen
    assert ("h1", "h2", "h3", "Pi2", "Pi3") in frozen


def test_ends_are_driven_in_every_way_and_loaded_on_either_side() -> None:
    """Spun about the axis, rocked, moved along; forces and torques that turn with an end and that do not."""
    models = [load_scene(file).model for file in EXAMPLES]
    ways = set()
    for end in (end for model in models for end in (model.left, model.right) if end.kind == "driven"):
        assert end.twist is not None
        ways.add(tuple(e != Number(0.0) for e in end.twist))
    assert {(False, False, True), (False, False, True, False, False, False), (*[False] * 3, True, False, False)} <= ways
    sides = {
        (side, end.frame)
        for model in models
        for side, end in (("left", model.left), ("right", model.right))
        if end.force is not None or end.torque is not None
    }
    assert sides == {(side, frame) for side in ("left", "right") for frame in ("body", "world")}
