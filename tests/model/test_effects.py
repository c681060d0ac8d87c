"""The formulas of effects: forces are the slopes of potentials, power is balanced, and no direction is preferred."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from geocosserat.algebra.exponential import exp
from geocosserat.model.effects.catalogue import EFFECTS, kind
from geocosserat.model.effects.effect import Effect, together
from geocosserat.model.expressions import Number, Symbol, fixed, symbols
from geocosserat.model.seen import Seen, cross, dot, nothing, seen
from tests.model.posed import (
    ENTRIES,
    GROUPS,
    KINDS,
    medium,
    number,
    of_numbers,
    plain,
    pose,
    potential,
    read,
    slope,
    values_at,
    wrench,
)

CONSERVATIVE = [(name, space) for name in KINDS for space in (2, 3) if name in ("weight", "field", "trap")]
SPACES = [2, 3]
SEEDS = [1, 2, 3]


def test_every_effect_that_comes_with_the_program_is_tried_here() -> None:
    """A new effect needs its entry in the tables of these tests."""
    assert [each.kind for each in EFFECTS] == ["weight", "follower", "couple", "field", "flow", "trap"]
    assert sorted(each.kind for each in EFFECTS) == KINDS


@pytest.mark.parametrize(("name", "space"), list(ENTRIES))
def test_only_weight_field_and_trap_have_a_potential(name: str, space: int) -> None:
    """A force that turns with the rod can do work around a closed loop, and drag always does."""
    assert (read(name, space).potential(seen(space)) is None) == ((name, space) not in CONSERVATIVE)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "space"), CONSERVATIVE)
def test_the_wrench_is_how_the_potential_falls(name: str, space: int, seed: int) -> None:
    """Along each axis of the moving frame and about it: differences of the potential, and its derivative in symbols."""
    effect, g, group = read(name, space), pose(space, seed), GROUPS[space]
    found = wrench(effect, g)
    fields = np.eye(group.dimension)
    falls = [-slope(lambda x, X=X: potential(effect, g @ exp(group, x * X))) for X in fields]
    np.testing.assert_allclose(found, falls, rtol=0, atol=1e-9)
    derived = Effect.wrench(effect, seen(space))
    np.testing.assert_allclose(found, [number(e, values_at(g)) for part in derived for e in part], rtol=0, atol=1e-12)
    assert np.linalg.norm(found) > 0.1


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "space"), CONSERVATIVE)
def test_power_is_balanced_in_a_moving_frame(name: str, space: int, seed: int) -> None:
    """Along a motion: the potential changes by what the wrench does not deliver, and by its own change in time."""
    effect, g, group, t = read(name, space), pose(space, seed), GROUPS[space], 0.7
    V = np.random.default_rng(seed + 10).normal(size=group.dimension)
    change = slope(lambda x: potential(effect, g @ exp(group, x * V), t=t + x))
    own = slope(lambda x: potential(effect, g, t=t + x))
    assert change == pytest.approx(own - wrench(effect, g, t=t) @ V, abs=1e-9)
    assert abs(own) > 0.01


def turned(effect: Effect, Q: Any, a: Any) -> Effect:
    """The same effect in a world that is turned by Q and then moved by a; its values as numbers."""
    values, space = plain(effect), len(Q)
    for key, shape in ((key, each.shape) for key, each in effect.keys.items()):
        if shape == "world":
            values[key] = Q @ values[key]
        if shape == "matrix":
            values[key] = Q @ values[key].reshape(space, space) @ Q.T
    if effect.kind == "trap":  # its centre is a place
        values["centre"] = values["centre"] + a
    if effect.kind == "flow":  # its velocity is that at the origin
        values["velocity"] = values["velocity"] - values["gradient"] @ a
    return of_numbers(type(effect), values)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "space"), list(ENTRIES))
def test_no_direction_and_no_place_is_preferred(name: str, space: int, seed: int) -> None:
    """The world and the rod turned and moved together: every component in the moving frame stays as it was."""
    effect, g, moved = read(name, space), pose(space, seed), pose(space, seed + 20)
    there = turned(effect, moved[1:, 1:], moved[1:, 0])
    np.testing.assert_allclose(wrench(there, moved @ g), wrench(effect, g), rtol=0, atol=1e-13)
    np.testing.assert_allclose(medium(there, moved @ g), medium(effect, g), rtol=0, atol=1e-13)
    assert np.linalg.norm(wrench(effect, g)) + np.linalg.norm(medium(effect, g)) > 0.1


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("space", SPACES)
def test_a_weight_is_the_same_force_in_the_world_however_the_rod_is_turned(space: int, seed: int) -> None:
    """And no moment."""
    effect, g = read("weight", space), pose(space, seed)
    found = wrench(effect, g)
    np.testing.assert_allclose(g[1:, 1:] @ found[:space], plain(effect)["force"], rtol=0, atol=1e-14)
    assert not found[space:].any()


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("space", SPACES)
def test_follower_and_couple_are_the_same_in_the_frame_however_it_is_turned(space: int, seed: int) -> None:
    """A force alone, a moment alone, as written."""
    g, force, torque = pose(space, seed), read("follower", space), read("couple", space)
    np.testing.assert_array_equal(wrench(force, g), [*plain(force)["force"], *np.zeros(GROUPS[space].rotations)])
    np.testing.assert_array_equal(wrench(torque, g), [*np.zeros(space), *plain(torque)["torque"]])


def test_a_field_turns_the_moment_towards_itself() -> None:
    """Magnetised along x, field along y: about z, to the left."""
    values = {"moment": [2, 0], "field": [0, 3]}
    np.testing.assert_array_equal(wrench(read("field", 2, values), np.eye(3)), [0, 0, 6])
    values = {"moment": [2, 0, 0], "field": [0, 3, 0]}
    np.testing.assert_array_equal(wrench(read("field", 3, values), np.eye(4)), [0, 0, 0, 0, 0, 6])


def test_a_trap_pulls_to_its_centre_and_pushes_if_its_stiffness_is_negative() -> None:
    """By stiffness times distance."""
    for stiffness in (5, -5):
        effect = read("trap", 3, {"stiffness": stiffness, "centre": [1, 0, 2]})
        np.testing.assert_array_equal(wrench(effect, np.eye(4)), [stiffness, 0, 2 * stiffness, 0, 0, 0])


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("space", SPACES)
def test_a_medium_that_turns_rigidly_has_the_twist_of_a_body_that_does(space: int, seed: int) -> None:
    """Whatever the pose: a rod carried along by it moves with it and turns with it, so that nothing drags."""
    group, g = GROUPS[space], pose(space, seed)
    X = np.random.default_rng(seed).normal(size=group.dimension)
    spatial = group.hat(X)
    values = {"gradient": spatial[1:, 1:].tolist(), "velocity": spatial[1:, 0].tolist()}
    body = group.vee(np.linalg.inv(g) @ spatial @ g)
    np.testing.assert_allclose(medium(read("flow", space, values), g), body, rtol=0, atol=1e-13)


def test_a_shear_flow_turns_what_it_carries_with_half_its_vorticity() -> None:
    """velocity = (y, 0): clockwise, at 1/2; a strain without vorticity does not turn."""
    shear = read("flow", 2, {"gradient": [[0, 1], [0, 0]], "velocity": [0, 0]})
    np.testing.assert_array_equal(medium(shear, np.array([[1.0, 0, 0], [0, 1, 0], [3, 0, 1]])), [3, 0, -0.5])
    strain = read("flow", 2, {"gradient": [2, -2], "velocity": [0, 0]})
    np.testing.assert_array_equal(medium(strain, np.array([[1.0, 0, 0], [1, 1, 0], [3, 0, 1]])), [2, -6, 0])


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize(
    ("name", "needs"),
    [
        ("weight", "direction"), ("follower", "nothing"), ("couple", "nothing"), ("field", "direction"),
        ("flow", "pose"), ("trap", "pose"),
    ],
)  # fmt: skip
def test_an_effect_needs_what_its_formulas_use(name: str, needs: str, space: int) -> None:
    """Nothing of the pose, directions, or the place: what is documented is what the symbols say."""
    effect, frame = read(name, space), seen(space)
    assert effect.needs(frame) == needs
    used = {s for part in (*effect.wrench(frame), *effect.medium(frame)) for e in part for s in symbols(e)}
    assert any(s.startswith("frame.") for s in used) == (needs != "nothing")
    assert any(s.startswith("place.") for s in used) == (needs == "pose")


@pytest.mark.parametrize(
    ("name", "space", "values", "needs"),
    [
        ("flow", 2, {"gradient": [[0, 0], [0, 0]], "velocity": [1, 0]}, "direction"),
        ("flow", 2, {"gradient": [0, 0], "velocity": [0, 0]}, "nothing"),
        ("flow", 3, {"gradient": [0, 0, 0], "velocity": [0, 0, 1]}, "direction"),
        ("trap", 3, {"stiffness": 0, "centre": [0, 0, 0]}, "nothing"),
        ("weight", 3, {"force": [0, 0, 0]}, "nothing"),
        ("field", 2, {"moment": [0, 0], "field": [1, 1]}, "nothing"),
    ],
)
def test_zeros_need_nothing(name: str, space: int, values: dict[str, Any], needs: str) -> None:
    """A uniform flow has no place, an effect of zeros no term."""
    effect = read(name, space, values)
    assert effect.needs(seen(space)) == needs
    if needs == "nothing":
        assert effect.wrench(seen(space)) == effect.medium(seen(space)) == (nothing(space), nothing(2 * space - 3))


@pytest.mark.parametrize(
    ("name", "space", "printed"),
    [
        ("weight", 2, "weight (1 + u, -2*t) per length, fixed in the world"),
        ("follower", 3, "follower force (sin(u - t), 0.5, load) per length, turning with the rod"),
        ("couple", 2, "couple (u*cos(t)) per length, turning with the rod"),
        ("field", 2, "field (3*cos(t), load) on a moment (1 + t, u) per length"),
        ("flow", 2, "flow of velocity (sin(t), 1) and gradient (t, 2, -0.5, load) (by rows)"),
        ("trap", 3, "trap of stiffness 2 + u*t per length about (cos(t), 0.2, -load)"),
    ],
)
def test_an_effect_prints_what_it_does(name: str, space: int, printed: str) -> None:
    """With its values, for a person who checks the scene."""
    assert str(read(name, space)) == printed


def test_effects_can_be_given_other_values() -> None:
    """Each expression replaced by its key and position; the rest of the effect stays."""
    effect = read("trap", 2).renamed(lambda key, i, e: Symbol(f"{key}{i}"))
    assert effect == kind("trap")((Symbol("stiffness0"),), (Symbol("centre0"), Symbol("centre1")))  # type: ignore[call-arg]
    assert read("trap", 2).renamed(lambda key, i, e: e) == read("trap", 2)


def test_effects_add_up() -> None:
    """Component by component; none at all is zero."""
    a, b = Symbol("a"), Symbol("b")
    assert together([(a, Number(0.0)), (b, b)], 2) == (a + b, b)
    assert together([], 3) == nothing(3)


# what is seen


@pytest.mark.parametrize("space", SPACES)
def test_world_and_body_are_seen_by_the_frame(space: int) -> None:
    """Components in the frame are those of R^T, back by R; symbols are those of no parameter."""
    g, frame = pose(space, 4), seen(space)
    values, v = values_at(g), np.arange(1.0, space + 1)
    R = g[1:, 1:]
    np.testing.assert_allclose([number(e, values) for e in frame.to_body(v)], R.T @ v, rtol=0, atol=1e-14)
    np.testing.assert_allclose([number(e, values) for e in frame.to_world(v)], R @ v, rtol=0, atol=1e-14)
    names = {s for row in (*frame.axes, frame.position) for e in row for s in symbols(e)}
    assert len(names) == (4 if space == 2 else 12)
    assert all("." in name for name in names)


@pytest.mark.parametrize("space", SPACES)
def test_slopes_are_those_along_and_about_the_axes_of_the_frame(space: int) -> None:
    """Of an expression of all symbols of the pose at once, against differences."""
    frame, group, g = seen(space), GROUPS[space], pose(space, 5)
    e = dot(frame.position, frame.position) * frame.axes[0][1] + frame.axes[1][0] ** 2 * frame.position[-1]
    found = [number(x, values_at(g)) for part in frame.slopes(e) for x in part]
    expected = [slope(lambda x, X=X: number(e, values_at(g @ exp(group, x * X)))) for X in np.eye(group.dimension)]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9)


def test_slopes_are_for_symbols_only() -> None:
    """A frame of numbers has no slopes, and says so."""
    numbers = Seen(((Number(1.0), Number(0.0)), (Number(0.0), Number(1.0))), (Number(0.0), Number(0.0)))
    with pytest.raises(TypeError, match=r"expected the symbols of a pose, found .*; use seen\(2\) or seen\(3\)"):
        numbers.slopes(Symbol("place.x"))


def test_products_of_vectors() -> None:
    """As numpy has them, and in the plane the one component out of it; plain numbers are welcome."""
    a, b = np.array([1.0, -2.0, 3.0]), np.array([0.5, 4.0, -1.0])
    assert [number(e, {}) for e in cross(a, b)] == np.cross(a, b).tolist()
    assert [number(e, {}) for e in cross(a[:2], b[:2])] == [5.0]
    assert dot(a, b) == Number(float(a @ b))
    assert dot((), ()) == Number(0.0)
    with pytest.raises(ValueError, match="zip"):
        dot(a, b[:2])
    assert fixed(dot((Symbol("t"), 2), (Symbol("u"), Symbol("u"))), "t", 0.0) == 2 * Symbol("u")
