"""Ends: what each kind takes, how it prints, and rings, which must be closed."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import Number, evaluate, parse
from geocosserat.model.fields import Names
from geocosserat.model.records import End
from geocosserat.model.ring import gap
from geocosserat.model.scene import load_scene
from tests.model.scenes import PLANAR, SPATIAL, changed


def load(path: str, value: Any, scene: dict[str, Any] = PLANAR) -> Any:
    """The scene with one entry changed."""
    return load_scene(changed(scene, path, value))


def expression(text: str) -> Any:
    """The expected expression of a load."""
    return parse(text, {"t", "load"})


@pytest.mark.parametrize(
    ("written", "end", "printed"),
    [
        ({"kind": "clamped"}, End("clamped"), "clamped"),
        ({"kind": "free"}, End("free"), "free"),
        ({"kind": "pinned"}, End("pinned"), "pinned"),
        ({"kind": "pinned", "torque": "load*t"}, End("pinned", torque=(expression("load*t"),)),
         "pinned, torque (load*t), fixed in the body"),
        ({"kind": "pinned", "torque": 1, "frame": "world"}, End("pinned", torque=(Number(1.0),), frame="world"),
         "pinned, torque (1), fixed in the world"),
        ({"kind": "pinned", "torque": 0, "frame": "world"}, End("pinned"), "pinned"),
        ({"kind": "free", "force": [0, 0.0], "frame": "world"}, End("free"), "free"),
        ({"kind": "driven", "twist": [0, 0, "cos(t)"]},
         End("driven", twist=(Number(0.0), Number(0.0), expression("cos(t)"))), "driven with twist (0, 0, cos(t))"),
        ({"kind": "driven", "twist": [0, 0, 0]}, End("driven", twist=(Number(0.0),) * 3),
         "driven with twist (0, 0, 0)"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("side", ["left", "right"])
def test_every_kind_of_end_is_read_and_prints_itself(
    side: str, written: dict[str, Any], end: End, printed: str
) -> None:
    """On either side; a load of zeros is none, and then has no frame."""
    model = load("ends", {side: written}).model
    assert getattr(model, side) == end
    assert f"{side} end" in str(model)
    assert str(model).split(f"{side} end")[1].split("\n")[0].strip() == printed


def test_ends_of_space_have_three_torques_and_six_velocities() -> None:
    """In the order of the components of the twist."""
    ends = {
        "left": {"kind": "driven", "twist": [0, 0, 0, "2*pi", 0, 0]},
        "right": {"kind": "pinned", "torque": [1, 0, "t"]},
    }
    model = load("ends", ends, SPATIAL).model
    assert model.left.twist is not None
    assert evaluate(model.left.twist[3], {}) == 2 * math.pi
    assert model.right.torque == (Number(1.0), Number(0.0), expression("t"))


def test_a_rod_may_be_held_at_both_ends() -> None:
    """By any two kinds."""
    model = load("ends", {"left": {"kind": "pinned"}, "right": {"kind": "driven", "twist": [0, "t", 0]}}).model
    assert (model.left.kind, model.right.kind) == ("pinned", "driven")


# rings


def ring(strain: list[Any], scene: dict[str, Any] = PLANAR, **rod: Any) -> Any:
    """The scene with joined ends and this start."""
    scene = changed(changed(scene, "ends", {"joined": True}), "start.strain", strain)
    for key, value in rod.items():
        scene = changed(scene, f"rod.{key}", value)
    return load_scene(scene)


def test_joined_ends_are_free_of_everything() -> None:
    """Neither end is clamped or loaded; the ring prints as one."""
    model = ring([1, 0, "2*pi"]).model
    assert model.joined
    assert model.left == model.right == End("free")
    assert "\n  ends       joined\n" in str(model)
    assert "left end" not in str(model)


def test_ends_that_are_not_joined_are_two() -> None:
    """joined = false says what is so anyway."""
    model = load("ends", {"joined": False, "left": {"kind": "pinned"}}).model
    assert not model.joined
    assert model.left == End("pinned")


def test_a_ring_at_rest_needs_no_start_of_its_own() -> None:
    """The reference is the start, at time 0, and is checked where it stands."""
    scene = changed(PLANAR, "ends", {"joined": True})
    assert load_scene(changed(scene, "rod.reference", [1, 0, "2*pi + t"])).model.joined
    with pytest.raises(InputError, match=r"rod.reference: expected a closed ring, .* found ends 0.00159 of the length"):
        load_scene(changed(scene, "rod.reference", [1, 0, "2*pi + 0.01 + t"]))


def test_a_ring_may_be_set_from_outside() -> None:
    """As any other key."""
    scene = changed(changed(PLANAR, "rod.reference", [1, 0, "2*pi"]), "ends", {})
    assert load_scene(scene, ["ends.joined=true"]).model.joined


@pytest.mark.parametrize(
    ("strain", "length"),
    [
        ([1, 0, "2*pi"], 1.0),
        ([1, 0, "4*pi"], 1.0),  # twice around
        ([1, 0, "-2*pi/3"], 3.0),
        ([0.7, 0.2, "2*pi"], 1.0),  # stretched and sheared
        ([1, 0, "2*pi*(1 + 0.4*cos(4*pi*u))"], 1.0),  # an oval
        ([1, 0, "2*pi*(1 + 0.3*cos(4*pi*s))/250"], 250.0),
        ([1, 0, "6.2831853"], 1.0),
    ],
)
def test_closed_shapes_of_the_plane_are_rings(strain: list[Any], length: float) -> None:
    """Circles, ovals, more than once around, on any scale."""
    assert ring(strain, length=length).model.joined


@pytest.mark.parametrize(
    "strain", [[1, 0, 0], [1, 0, "pi"], [1, 0, "4*pi*heaviside(0.75 - u)"], [1, 0, "2*pi + 2e-6"], ["1 + u", 0, "2*pi"]]
)
def test_open_shapes_of_the_plane_are_no_rings(strain: list[Any]) -> None:
    """A line, a half circle, a hook, a gap of two millionths; a ring that is stretched more on one side."""
    with pytest.raises(
        InputError, match=r"start.strain: expected a closed ring, .*, found ends .* of the length apart"
    ):
        ring(strain)


@pytest.mark.parametrize("strain", [[1, 0, 0, 0, 0, 1e99], [1, 0, 0, 1e160, 0, 0], [1e200, 0, 0, 0, 0, "pi"]])
def test_strains_too_large_to_be_followed_are_no_ring(strain: list[Any]) -> None:
    """Frames that overflow on their way around are refused, and no warning is printed."""
    with pytest.raises(InputError, match=r"start.strain: expected a closed ring, .*, found strains too large for that"):
        ring(strain, SPATIAL)


@pytest.mark.parametrize(
    ("strain", "closed"),
    [
        ([1, 0, 0, 0, 0, "pi"], True),
        ([1, 0, 0, 0, "pi", 0], True),
        ([1, 0, 0, "pi", "pi*sin(pi*u)", "pi*cos(pi*u)"], True),  # the frame turns once about the rod
        ([1, 0, 0, "pi/2", "pi*sin(pi*u/2)", "pi*cos(pi*u/2)"], False),  # half a turn: the frames do not meet
        ([1, 0, 0, 0.1, 0, "pi"], False),
        ([1, 0, 0, 0, 0, "pi + 3e-6"], False),
        ([1, 0, 0, 0, 0, "pi + 1e-7"], True),
    ],
)
def test_in_space_both_ends_meet_and_are_turned_alike(strain: list[Any], closed: bool) -> None:
    """A circle in any plane, with any number of full turns about itself; the rod has the length 2."""
    if closed:
        assert ring(strain, SPATIAL).model.joined
    else:
        with pytest.raises(InputError, match=r"start.strain: expected a closed ring, since the ends are joined"):
            ring(strain, SPATIAL)


def test_a_ring_with_steps_is_closed_where_its_parts_meet() -> None:
    """Two half circles joined by straight lines; no step of the march lies across a step of the curvature."""
    strain = [1, 0, "pi/0.3*(heaviside(0.3 - u) + heaviside(u - 0.5) - heaviside(u - 0.8))"]
    assert ring(strain).model.joined


@pytest.mark.parametrize("group", [SE2, SE3])
@given(data=st.data())
@settings(max_examples=25)
def test_how_far_a_ring_is_open_is_what_an_integrator_finds(group: Group, data: st.DataObject) -> None:
    """Any smooth strains: distance and angle of the ends, marched here by a general method."""
    numbers = data.draw(st.lists(st.floats(-3, 3), min_size=2 * group.dimension, max_size=2 * group.dimension))
    length = data.draw(st.sampled_from([0.5, 1.0, 40.0]))
    texts = [f"({a!r}) + ({b!r})*sin(5*s)" for a, b in zip(numbers[::2], numbers[1::2], strict=True)]
    texts[group.translations :] = [f"({text})/{length}" for text in texts[group.translations :]]
    strain = tuple(parse(text.replace("s)", f"u/{length})"), {"u"}) for text in texts)
    distance, angle = gap(group, strain, Names({}, length))

    def slope(u: float, flat: Any) -> Any:
        turn = np.array([evaluate(e, {"u": u}) for e in strain])
        return (flat.reshape(group.size, group.size) @ group.hat(turn)).ravel()

    whole = solve_ivp(slope, (0, length), group.identity().ravel(), rtol=1e-9, atol=1e-9 * length).y[:, -1]
    g = whole.reshape(group.size, group.size)
    assert distance == pytest.approx(np.linalg.norm(group.position(g)) / length, abs=1e-6)
    cosine = np.trace(group.rotation(g)) / 2 if group is SE2 else (np.trace(group.rotation(g)) - 1) / 2
    assert math.cos(angle) == pytest.approx(cosine, abs=1e-6)
