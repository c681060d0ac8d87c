"""Rods made of a law: from a file beside the scene or a table in it, with the scene's values of its parameters."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from geocosserat.model.errors import InputError
from geocosserat.model.expressions import Number
from geocosserat.model.scene import load_scene

LAW = """
motion = "planar"
[parameters]
k = 2.0
a = { symbol = true }
[stress]
F1 = "k*(h1 - 1)"
F2 = "k*h2 + a*Pi"
M = "log(h1)*Pi + Pi**3"
[friction]
matrix = [1, 2, 0.1]
"""


def values(**more: Any) -> dict[str, Any]:
    """A scene whose rod has a law and nothing else but a length."""
    law = {
        "motion": "planar",
        "parameters": {"k": 2.0, "a": {"symbol": True}},
        "stress": {"F1": "k*(h1 - 1)", "F2": "k*h2 + a*Pi", "M": "log(h1)*Pi + Pi**3"},
        "friction": {"matrix": [1, 2, 0.1]},
    }
    rod = {"motion": "planar", "length": 1.0, "law": law}
    return {"parameters": {"a": 0.5}, "rod": rod, "run": {"until": 1.0}} | more


def test_a_file_beside_the_scene_is_the_same_as_a_table_in_it(tmp_path: Path) -> None:
    """The name is relative to the scene; the scene's source is whole without the file."""
    (tmp_path / "laws").mkdir()
    (tmp_path / "laws" / "odd.toml").write_text(LAW)
    text = '[parameters]\na = 0.5\n[rod]\nmotion = "planar"\nlength = 1\nlaw = "laws/odd.toml"\n[run]\nuntil = 1.0\n'
    (tmp_path / "scene.toml").write_text(text)
    from_file, inline = load_scene(tmp_path / "scene.toml"), load_scene(values())
    assert from_file.model.law is not None
    assert inline.model.law is not None
    assert from_file.model.law.stress == inline.model.law.stress
    (tmp_path / "laws" / "odd.toml").unlink()
    assert load_scene(from_file.source).model == from_file.model


def test_a_law_gives_friction_and_reference_to_a_rod_without_its_own() -> None:
    """The rod's own come first."""
    model = load_scene(values()).model
    assert [row[i] for i, row in enumerate(model.friction)] == [Number(1.0), Number(2.0), Number(0.1)]
    assert model.reference == (Number(1.0), Number(0.0), Number(0.0))
    own = values()
    own["rod"]["friction"] = [3, 3, 3]
    assert load_scene(own).model.friction[2][2] == Number(3.0)


def test_parameters_of_the_scene_override_those_of_the_law() -> None:
    """By name, in the file or set from outside; those of the law are parameters of the model."""
    assert load_scene(values()).model.parameters == {"k": 2.0, "a": 0.5}
    assert load_scene(values(parameters={"a": 1.0, "k": 7.0})).model.parameters == {"k": 7.0, "a": 1.0}
    assert load_scene(values(), ["k=9"]).model.parameters["k"] == 9.0
    bare = values()
    del bare["parameters"]
    assert load_scene(bare, ["a=0.25"]).model.parameters["a"] == 0.25


def test_a_law_is_about_as_stiff_as_its_tangent_at_the_reference() -> None:
    """In numbers; where the tangent has no value it is zero."""
    model = load_scene(values()).model
    assert [[e.value for e in row] for row in model.stiffness] == [[2, 0, 0], [0, 2, 0.5], [0, 0, 0]]  # type: ignore[union-attr]


def test_a_stress_that_is_not_finite_at_the_start_is_refused() -> None:
    """With the place along the rod."""
    with pytest.raises(InputError, match=r"rod.law.stress.M: expected a finite stress at the start, found .* at u = 0"):
        load_scene(values(start={"strain": ["u - 0.5", 0, 1]}))


def test_a_rod_of_a_law_has_a_reference_that_rests() -> None:
    """What changes in time is written in the law."""
    moving = values()
    moving["rod"]["reference"] = [1, 0, "sin(t)"]
    with pytest.raises(InputError, match=r"rod.reference.2: expected a reference that rests, .*; write t in the law"):
        load_scene(moving)


def test_a_law_without_a_stress_leaves_the_stiffness_to_the_rod() -> None:
    """Its wrench acts along the rod all the same."""
    scene = values()
    scene["rod"]["law"] = {"motion": "planar", "wrench": {"f1": "0.1*cos(theta) - x", "m": "0.2"}}
    scene["rod"] |= {"stiffness": [1, 1, 1], "friction": [1, 1, 1]}
    model = load_scene(scene).model
    assert model.law is None
    assert [effect.kind for effect in model.effects] == ["law"]
    assert "wrench (0.1*frame.cos - place.x, 0, 0.2) of the law" in str(model)


def test_the_law_is_printed_with_the_model() -> None:
    """By its name, and the stress in place of a stiffness."""
    text = str(load_scene(values()).model)
    assert "law        unnamed law" in text
    assert "F2 = k*h2 + a*Pi" in text
    assert "stiffness" not in text
