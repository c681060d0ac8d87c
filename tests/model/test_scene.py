"""Scenes: what is read is what was written, and what is wrong is refused with what to do."""

from __future__ import annotations

import datetime
import math
from typing import Any

import numpy as np
import pytest

from geocosserat.algebra.groups import SE2, SE3
from geocosserat.model.effects.weight import Weight
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import Number, evaluate, parse
from geocosserat.model.records import End, RunSettings
from geocosserat.model.scene import load_scene
from tests.model.refusals import REFUSALS, SPATIAL_REFUSALS
from tests.model.scenes import PLANAR, SPATIAL, changed


def load(path: str, value: Any, scene: dict[str, Any] = PLANAR) -> Any:
    """The scene with one entry changed."""
    return load_scene(changed(scene, path, value))


def expression(text: str | float) -> Any:
    """The expected expression of a field."""
    return parse(text, {"u", "t", "kappa", "load"})


def test_every_field_of_a_planar_scene_is_read() -> None:
    """A scene that sets every key arrives complete in the records."""
    scene = load_scene(
        {
            "title": "all keys",
            "parameters": {"kappa": 1e4, "load": "kappa/5000"},
            "rod": {
                "motion": "planar",
                "length": "2*load",
                "stiffness": ["kappa", "2*kappa", "1 + u"],
                "friction": [[1, 0.1, 0], [0.1, 2, 0], [0, 0, "load/100"]],
                "reference": ["1", "0", "s"],
                "frozen": [],
            },
            "start": {"strain": [1, 0, "u"], "position": [1, "-load"], "angle": "pi/2"},
            "ends": {
                "left": {"kind": "free", "force": ["cos(t)", 0], "torque": "load*t", "frame": "world"},
                "right": {"kind": "clamped"},
            },
            "effects": [{"kind": "weight", "force": ["u*t", -1]}, {"kind": "weight", "force": [0, "-load"]}],
            "run": {
                "until": "load/2",
                "frames": 5,
                "accuracy": 1e-4,
                "elements": 8,
                "degree": "load",
                "method": "radau",
                "rtol": 1e-5,
                "atol": 1e-9,
                "backend": "numpy",
            },
        }
    )
    model = scene.model
    zero, one = Number(0.0), Number(1.0)
    assert scene.title == "all keys"
    assert model.group is SE2
    assert model.parameters == {"kappa": 1e4, "load": 2.0}
    assert model.length == 4.0
    assert model.stiffness == (
        (expression("kappa"), zero, zero),
        (zero, expression("2*kappa"), zero),
        (zero, zero, expression("1+u")),
    )  # fmt: skip
    assert model.friction[0] == (one, Number(0.1), zero)
    assert model.friction[2] == (zero, zero, expression("load/100"))
    assert model.reference == (one, zero, expression("u/4"))
    assert model.frozen == ()
    assert model.left == End("free", (expression("cos(t)"), zero), (expression("load*t"),), "world")
    assert model.right == End("clamped")
    assert model.effects == (
        Weight((expression("u*t"), Number(-1.0))), Weight((zero, expression("-load"))),
    )  # fmt: skip
    assert scene.start.strain == (one, zero, expression("u"))
    assert scene.start.position == (1.0, -2.0)
    assert scene.start.rotation == (math.pi / 2,)
    assert scene.run == RunSettings(1.0, 5, 1e-4, 8, 2, "radau", 1e-5, 1e-9, "numpy")


def test_every_field_of_a_spatial_scene_is_read() -> None:
    """In space: six strains, a torque of three components, a rotation vector."""
    scene = load("start", {"position": [1, 2, 3], "rotation": [0.1, 0.2, "load"]}, SPATIAL)
    assert scene.model.group is SE3
    assert len(scene.model.stiffness) == len(scene.model.friction[5]) == 6
    assert scene.model.right.torque == (Number(0.0), Number(0.0), Number(1.0))
    assert scene.start.position == (1.0, 2.0, 3.0)
    assert scene.start.rotation == (0.1, 0.2, 2.0)


def test_what_a_scene_leaves_out_has_the_documented_default() -> None:
    """Straight at rest and at the start, clamped left, free right, at the origin along x."""
    scene = load_scene({"rod": PLANAR["rod"] | {"stiffness": [1, 1, 1]}, "run": {"until": 2}})
    straight = (Number(1.0), Number(0.0), Number(0.0))
    assert scene.title == "untitled"
    assert scene.model.reference == scene.start.strain == straight
    assert (scene.model.left, scene.model.right) == (End("clamped"), End("free"))
    assert (scene.start.position, scene.start.rotation) == ((0.0, 0.0), (0.0,))
    assert scene.model.effects == ()
    assert scene.run == RunSettings(2.0, 51, 1e-6)


def test_the_start_is_the_reference_unless_given() -> None:
    """A rod with curvature at rest starts with it."""
    scene = load("rod.reference", [1, 0, "2*u"])
    assert scene.start.strain == scene.model.reference == (Number(1.0), Number(0.0), expression("2*u"))


def test_choosing_the_mesh_is_choosing_not_to_ask_for_an_accuracy() -> None:
    """With elements given there is no default accuracy; an accuracy that is given stays."""
    assert load("run.elements", 4).run.accuracy is None
    assert load("run.degree", 4).run.accuracy == 1e-6
    assert load("run", {"until": 1, "elements": 4, "accuracy": 1e-3}).run.accuracy == 1e-3


def test_a_rod_may_be_held_nowhere() -> None:
    """Free at both ends is a rod that swims or sinks."""
    scene = load("ends", {"left": {"kind": "free"}})
    assert scene.model.left.kind == scene.model.right.kind == "free"


def test_a_load_of_zeros_is_no_load() -> None:
    """Zeros leave no term; a parameter that happens to be zero does, for it may be swept."""
    assert load("ends.right", {"force": [0, "-0.0"], "torque": 0}).model.right == End("free")
    scene = load("parameters.load", 0.0)
    assert scene.model.right.force == (Number(0.0), expression("-load"))


def test_s_runs_from_zero_to_one_whatever_the_length() -> None:
    """``s`` becomes ``u/length``."""
    scene = load_scene(changed(changed(PLANAR, "rod.length", 4), "rod.reference", [1, 0, "s**2"]))
    assert evaluate(scene.model.reference[2], {"u": 4.0}) == 1.0
    assert evaluate(scene.model.reference[2], {"u": 2.0}) == 0.25


def test_numpy_numbers_and_tuples_are_welcome_in_a_mapping() -> None:
    """From Python, arrays and tuples stand for lists."""
    scene = load("rod.stiffness", np.diag([1e4, 1e4, 1.0]))
    assert scene.model.stiffness[0][0] == Number(1e4)
    assert load("rod.length", np.float64(2.0)).model.length == 2.0
    assert load("run.frames", np.int64(7)).run.frames == 7
    assert load("start.position", (1, 2)).start.position == (1.0, 2.0)


def test_the_mapping_given_is_left_as_it_was() -> None:
    """Loading with settings copies first."""
    scene = changed(PLANAR, "rod.length", 1.0)
    load_scene(scene, ["rod.length=3", "kappa=5"])
    assert scene == PLANAR


NOT_FINITE = [float("nan"), float("inf"), "9**9**9**9", "1/0", "log(-1)", "exp(1000)"]


@pytest.mark.parametrize("value", NOT_FINITE)
@pytest.mark.parametrize(
    "path",
    [
        "parameters.kappa", "rod.length", "rod.stiffness.0", "rod.friction.2", "start.position.1",
        "start.angle", "ends.right.force.0", "ends.right.torque", "effects.0.force.1", "run.until",
        "run.accuracy", "run.frames",
    ],
)  # fmt: skip
def test_no_number_may_be_infinite_or_nan(path: str, value: Any) -> None:
    """Wherever a number stands, written or computed, it must be finite."""
    scene = changed(changed(PLANAR, "start.position", [0, 0]), path, value)
    wording = rf"^scene: {path.replace('.', '[.]')}: expected a (finite|positive) number, found .*(nan|inf)"
    with pytest.raises(InputError, match=wording):
        load_scene(scene)


@pytest.mark.parametrize("value", [True, [1.0], {"a": 1}, datetime.date(2000, 1, 1), None])
@pytest.mark.parametrize(
    "path",
    [
        "parameters.kappa", "rod.length", "rod.stiffness.0", "start.position.1", "start.angle",
        "ends.right.force.0",
        "ends.right.torque", "effects.0.force.1", "run.until", "run.accuracy", "run.frames", "run.rtol",
    ],
)  # fmt: skip
def test_no_number_may_be_anything_else(path: str, value: Any) -> None:
    """Booleans, lists, tables and dates are not numbers; the message names the place."""
    scene = changed(changed(PLANAR, "start.position", [0, 0]), path, value)
    with pytest.raises(InputError, match=rf"^scene: {path.replace('.', '[.]')}.*: expected .*, found ") as caught:
        load_scene(scene)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("path", "value", "wording"), REFUSALS)
def test_what_is_wrong_is_refused_with_place_and_remedy(path: str, value: Any, wording: str) -> None:
    """Every key, every way to get it wrong: one line that says what was expected, found, and to be done."""
    with pytest.raises(InputError, match=wording) as caught:
        load(path, value)
    message = str(caught.value)
    assert message.startswith("scene: ")
    assert "\n" not in message
    assert message.isprintable()
    assert len(message) < 500


@pytest.mark.parametrize(("path", "value", "wording"), SPATIAL_REFUSALS)
def test_space_has_other_lengths_than_the_plane(path: str, value: Any, wording: str) -> None:
    """What is right in the plane is refused in space, with the names of the components."""
    with pytest.raises(InputError, match=wording):
        load(path, value, SPATIAL)


def test_a_nearly_symmetric_matrix_is_symmetric() -> None:
    """Rounding in expressions is not asymmetry, even where an entry crosses zero."""
    rows = [[1, 0, "0.1*sin(pi*u)"], [0, 1, 0], ["0.1*sin(pi*(1-u))", 0, 1]]
    assert load("rod.stiffness", rows).model.stiffness


def test_stiffnesses_of_very_different_size_are_positive_definite() -> None:
    """Whether a matrix is positive definite does not depend on the units."""
    assert load("rod.stiffness", [[1e20, 0, 1e4], [0, 1e20, 0], [1e4, 0, 1e-10]]).model.stiffness
    with pytest.raises(InputError, match="positive definite"):
        load("rod.stiffness", [[1e20, 0, 1.1e5], [0, 1e20, 0], [1.1e5, 0, 1e-10]])


def test_an_error_has_its_parts_as_attributes() -> None:
    """For a caller that wants to do more than print."""
    with pytest.raises(InputError) as caught:
        load("rod.length", -1)
    error = caught.value
    assert (error.file, error.key, error.found) == ("scene", "rod.length", "-1")
    assert error.expected == "a positive number"
