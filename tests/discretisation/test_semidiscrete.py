"""The numbers of a semi-discrete rod: sampled coefficients, start, carried poses."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from geocosserat.algebra.exponential import rotation_from_vector
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.model.scene import load_scene
from tests.discretisation import oracle
from tests.discretisation.rods import CAST, CLAMPED, FREE, MOTIONS, NAMES, SIZES, changed, rod, scene, weight

Array = NDArray[np.float64]


def named(rod: SemiDiscrete, name: str) -> Array | float:
    """The sampled value of a coefficient."""
    for place in ("uniform", "point", "node"):
        names = [c.name for c in rod.structure.at(place)]  # type: ignore[arg-type]
        if name in names:
            return getattr(rod, place)[names.index(name)]
    raise KeyError(name)


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("name", NAMES)
def test_shapes_are_those_of_the_contract(name: str, size: tuple[int, int]) -> None:
    """Turn by component, then a carried pose, then two energies; coefficients in the order of the structure."""
    r = rod(name, *size)
    d, Q = r.structure.group.dimension, r.mesh.elements * r.mesh.degree
    assert r.state.shape == (d * Q + r.structure.carried + 2,)
    assert r.unknowns == d * Q + r.structure.carried
    assert r.uniform.shape == (len(r.structure.at("uniform")),)
    assert r.point.shape == (len(r.structure.at("point")), Q)
    assert r.node.shape == (len(r.structure.at("node")), Q + 1)
    assert r.turn(np.stack([r.state] * 3)).shape == (3, d, Q)
    assert all(np.all(np.isfinite(a)) for a in (r.uniform, r.point, r.node, r.tables, r.base, r.state))


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("name", NAMES)
def test_the_mobility_is_the_inverse_of_the_friction(name: str, size: tuple[int, int]) -> None:
    """At every node; where the friction steps, of its mean over both sides by mass."""
    r = rod(name, *size)
    friction = oracle.floats(oracle.Rod(scene(name), r.mesh.edges, r.mesh.degree, r.base).friction)
    d = r.structure.group.dimension
    mobility = np.zeros((len(r.mesh.u), d, d))
    for i, j in np.ndindex(d, d):
        entry = r.structure.mobility[i][j]
        mobility[:, i, j] = 0.0 if entry == "0" else named(r, entry)
    np.testing.assert_allclose(mobility @ friction, np.broadcast_to(np.eye(d), mobility.shape), rtol=0, atol=1e-12)


def test_a_stepped_weight_adds_up_to_the_force_it_is() -> None:
    """Where a coefficient of the nodes steps between unequal elements, each side counts with its own mass."""
    heavy = CAST["planar plain"] | {"effects": [weight("planar", 0.0, "-2*heaviside(u - 0.4)")]}
    r = discretise(load_scene(heavy), 2, 3)
    assert r.mesh.half[0] != pytest.approx(r.mesh.half[1])
    assert r.mesh.mass @ named(r, "weight_y") == pytest.approx(-2 * (1.3 - 0.4), rel=1e-13)


def test_a_step_in_a_weight_that_changes_in_time_is_sampled_like_any_other() -> None:
    """Once for all equal steps; what is left for the kernel to evaluate is smooth along the rod."""
    force = ("t*heaviside(u - 0.4)", "heaviside(u - 0.4)*sin(u + t) - cos(t)*heaviside(0.8 - u)")
    r = discretise(load_scene(CAST["planar plain"] | {"effects": [weight("planar", *force)]}), 2, 3)
    assert r.mesh.mass @ named(r, "step_1") == pytest.approx(1.3 - 0.4, rel=1e-13)
    assert r.mesh.mass @ named(r, "step_2") == pytest.approx(0.8, rel=1e-13)
    assert [c.name for c in r.structure.at("node")] == ["step_1", "step_2"]


def test_a_stepped_stiffness_is_seen_from_inside_each_element() -> None:
    """No Gauss point has a value of the other side, or one in between."""
    values = named(rod("planar held", 4, 2), "k_3_3")
    np.testing.assert_array_equal(values, [1.5] * 4 + [3.0] * 4)


def test_a_uniform_coefficient_is_the_value_of_its_expression() -> None:
    """Parameters at the values of the scene; those of loads in time by their own prefixed names."""
    r = rod("planar everything", 4, 2)
    assert named(r, "p_int") == 0.3
    assert named(r, "right_f1") == -0.3
    assert named(rod("planar plain", 1, 5), "k_2_2") == 2.0


@pytest.mark.parametrize("motion", MOTIONS)
def test_a_run_starts_at_rest_unless_the_scene_says_otherwise(motion: str) -> None:
    """The turn at the Gauss points is the start's, or the reference; no pose is gained, no energy spent."""
    r = rod(f"{motion} pushed", 4, 2)
    turn = r.turn(r.state)
    np.testing.assert_allclose(turn[0], 1 + 0.1 * r.mesh.u_point, rtol=1e-15)
    bent = [*([1.0] if motion == "planar" else [1.0, 0.0, 0.0, 0.0]), "0.5", "3*u**2"]
    turn = (lambda d: d.turn(d.state))(discretise(changed(f"{motion} pushed", start={"strain": bent}), 4, 2))
    np.testing.assert_allclose(turn[-1], 3 * r.mesh.u_point**2, rtol=1e-14)
    np.testing.assert_array_equal(r.state[-2:], 0)


@pytest.mark.parametrize("name", NAMES)
def test_the_left_end_starts_where_the_scene_puts_it(name: str) -> None:
    """Whichever end the poses are marched from."""
    r, start = rod(name, 6, 1), scene(name).start
    found = r.poses(r.state)
    np.testing.assert_allclose(found.position[0], start.position, rtol=0, atol=1e-14)
    if found.angle is not None:
        assert found.angle[0] == pytest.approx(start.rotation[0], abs=1e-14)
        np.testing.assert_allclose(found.rotation[0, :, 0], [np.cos(0.7), np.sin(0.7)], rtol=0, atol=1e-14)
    else:
        wanted = rotation_from_vector(np.array(start.rotation))
        np.testing.assert_allclose(found.rotation[0], wanted, rtol=0, atol=1e-14)


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("side", ["left", "right"])
def test_a_held_end_stays_where_it_is_whatever_the_turn(motion: str, side: str) -> None:
    """In any state, to the last digits."""
    ends = {"left": CLAMPED, "right": FREE} if side == "left" else {"left": FREE, "right": CLAMPED}
    r = discretise(changed(f"{motion} pushed", ends=ends), 4, 2)
    end = 0 if side == "left" else -1
    states = r.state + np.random.default_rng(1).normal(size=(5, len(r.state)))
    moved, still = r.poses(states), r.poses(r.state)
    np.testing.assert_allclose(moved.position[:, end] - still.position[end], 0, atol=1e-15)
    np.testing.assert_allclose(moved.rotation[:, end] - still.rotation[end], 0, atol=1e-15)


@pytest.mark.parametrize("motion", MOTIONS)
def test_a_carried_pose_is_relative_to_the_start(motion: str) -> None:
    """Position in the frame of the start, then an angle or a quaternion of any norm."""
    r = rod(f"{motion} drifting", 4, 2)
    start = r.poses(r.state)
    states = np.stack([r.state] * 2)
    if motion == "planar":
        states[:, -5:-2] = [2.0, -1.0, 0.3]
        relative = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])
        offset = np.array([2.0, -1.0])
    else:
        half = np.array([0.1, -0.2, 0.3])
        size = np.linalg.norm(half)
        states[:, -9:-2] = [2.0, -1.0, 0.5, *(1.7 * np.array([np.cos(size), *(np.sin(size) / size * half)]))]
        relative, offset = rotation_from_vector(2 * half), np.array([2.0, -1.0, 0.5])
    found = r.poses(states)
    np.testing.assert_allclose(found.rotation[:, 0], [start.rotation[0] @ relative] * 2, rtol=0, atol=1e-15)
    wanted = start.position[0] + start.rotation[0] @ offset
    np.testing.assert_allclose(found.position[:, 0], [wanted] * 2, rtol=0, atol=1e-15)
