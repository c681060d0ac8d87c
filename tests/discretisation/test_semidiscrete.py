"""The numbers of a semi-discrete rod: sampled coefficients, start, carried poses."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from geocosserat.algebra.exponential import rotation_from_vector
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.model.scene import load_scene
from tests.discretisation import oracle
from tests.discretisation.rods import (
    CAST,
    CLAMPED,
    FREE,
    FROZEN,
    LENGTH,
    MOTIONS,
    NAMES,
    SIZES,
    changed,
    random_state,
    rod,
    scene,
    weight,
)

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
    """Turn by component (of frozen modes the stress), then the stress of viscous modes, then a carried pose, then two
    energies; coefficients in the order of the structure; the base's orientation, then its place, then its course if
    that is prescribed and matters."""
    r = rod(name, *size)
    d, Q = r.structure.group.dimension, r.mesh.elements * r.mesh.degree
    rows = d + sum(r.structure.viscous)
    assert r.state.shape == (rows * Q + r.structure.carried + 2,)
    assert r.unknowns == rows * Q + r.structure.carried
    assert r.uniform.shape == (len(r.structure.at("uniform")),)
    assert r.point.shape == (len(r.structure.at("point")), Q)
    assert r.node.shape == (len(r.structure.at("node")), Q + 1)
    course = r.course.table if r.course is not None and r.structure.sight != "nothing" else np.empty(0)
    if r.guide is not None:  # of the other end, likewise
        course = np.concatenate([course, r.guide.table])
    assert r.base.shape == ((3 if d == 3 else 12) + len(course),)
    np.testing.assert_array_equal(r.base[3 if d == 3 else 12 :], course)
    assert (r.course is not None) == ("driven" in (scene(name).model.left.kind, scene(name).model.right.kind))
    assert r.algebraic.shape == r.state.shape
    assert r.turn(np.stack([r.state] * 3)).shape == r.turn(np.stack([r.state] * 3), np.zeros(3)).shape == (3, d, Q)
    assert all(np.all(np.isfinite(a)) for a in (r.uniform, r.point, r.node, r.tables, r.base, r.state))


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("name", NAMES)
def test_the_mobility_is_the_inverse_of_the_friction(name: str, size: tuple[int, int]) -> None:
    """At every node; where the friction steps, of its mean over both sides by mass."""
    r = rod(name, *size)
    exact = oracle.Rod(scene(name), r.mesh.edges, r.mesh.degree, r.base)
    friction = oracle.floats(exact.friction)[:, exact.kept[:, None], exact.kept]
    d = r.structure.group.dimension
    mobility = np.zeros((len(r.mesh.u), d, d))
    for i, j in np.ndindex(d, d):
        entry = r.structure.mobility[i][j]
        mobility[:, i, j] = 0.0 if entry == "0" else named(r, entry)
    np.testing.assert_allclose(mobility @ friction, np.broadcast_to(np.eye(d), mobility.shape), rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", [f"{m} {n}" for m in MOTIONS for n in ("cranked", "hinged", "swept", "reeled")])
def test_a_held_end_has_the_friction_of_its_node_and_the_inverse_of_that_of_its_rotations(name: str) -> None:
    """Of the rotations alone, where their translations are held."""
    r = rod(name, 4, 2)
    exact = oracle.Rod(scene(name), r.mesh.edges, r.mesh.degree, r.base)
    friction = oracle.floats(exact.friction)[:, exact.kept[:, None], exact.kept]
    d, space = r.structure.group.dimension, r.structure.group.translations
    for end, node in ((r.structure.left, 0), (r.structure.right, -1)):
        for found, wanted in (
            (end.friction, friction[node]),
            (end.mobility, np.pad(np.linalg.inv(friction[node, space:, space:]), ((space, 0), (space, 0)))),
        ):
            if found is not None:
                entries = [[0.0 if e == "0" else named(r, e) for e in row] for row in found]
                np.testing.assert_allclose(entries, wanted, rtol=0, atol=1e-13)
    assert d == len(friction[0])


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize(
    ("run", "left"),
    [({}, 1e-8), ({"accuracy": 1e-6}, 1e-8), ({"accuracy": 2e-9}, 2e-10), ({"rtol": 1e-13}, 1e-10)],
    ids=["not said", "loose", "tight", "tightest"],
)
def test_a_rotation_without_friction_has_next_to_none(motion: str, run: dict[str, float], left: float) -> None:
    """A tenth of the accuracy asked for, within bounds, of what a rod of this length feels, so that the same kernels
    serve; other entries stay as they are."""
    friction = [2.0, 3.0, 0] if motion == "planar" else [2.0, 3.0, 3.0, 0.5, 0, 0]
    r = discretise(changed(f"{motion} plain", rod={"friction": friction}, run=run), 3, 2)
    for i, x in enumerate(friction, start=1):
        wanted = x or left * LENGTH**2 * 2.0
        assert named(r, f"mobility_{i}_{i}") == pytest.approx(1 / wanted, rel=1e-14)


@pytest.mark.parametrize("name", FROZEN)
def test_a_frozen_mode_yields_next_to_nothing(name: str) -> None:
    """1e-12 of what friction lets a force move the rod along, or a moment turn it."""
    r = discretise(scene(name), 4, 2)
    friction = oracle.floats(oracle.Rod(scene(name), r.mesh.edges, r.mesh.degree, r.base).friction)
    for stress, held in zip(r.structure.group.stress, r.structure.frozen, strict=True):
        if held and r.structure.indeterminate:
            wanted = 1e-12 / (friction[:, 0, 0].max() * LENGTH ** (2 if stress[0] == "F" else 4))
            assert named(r, f"slack_{stress}") == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("name", FROZEN)
def test_the_turn_of_a_frozen_mode_is_its_reference_at_its_time(name: str) -> None:
    """Whatever the state; of the other modes it is what the state holds."""
    r, times = rod(name, 4, 2), np.array([0.0, 0.4, 1.1])
    exact = oracle.Rod(scene(name), r.mesh.edges, r.mesh.degree, r.base)
    states = r.state + np.random.default_rng(2).normal(size=(3, len(r.state)))
    turn, Q = r.turn(states, times), len(r.mesh.u_point)
    for k, t in enumerate(times):
        rest = oracle.floats(exact.reference(oracle.MP.mpf(t)))
        for i, held in enumerate(r.structure.frozen):
            wanted = rest[i] if held else states[k, i * Q : (i + 1) * Q]
            np.testing.assert_allclose(turn[k, i], wanted, rtol=1e-15, atol=1e-15)
            np.testing.assert_array_equal(r.algebraic[i * Q : (i + 1) * Q], float(held))
    assert r.algebraic.sum() == Q * (sum(r.structure.frozen) + sum(r.structure.viscous))
    together = r.poses(states, times)
    for k, t in enumerate(times):
        np.testing.assert_allclose(together.position[k], r.poses(states[k], t).position, rtol=0, atol=1e-14)


def test_a_far_end_is_drawn_back_to_where_it_was_much_faster_than_the_rod_relaxes() -> None:
    """1e5 times as fast as its softest bend does on its whole length."""
    r = discretise(scene("spatial cranked"), 4, 2)
    soft, drag = 0.9 + 0.3 * LENGTH / 2, 1.0
    assert named(r, "left_pull") == pytest.approx(1e5 * soft / (drag * LENGTH**4), rel=1e-12)
    r = discretise(scene("planar held"), 4, 2)
    # at the middle, where it steps; friction 3 at most
    assert named(r, "right_pull") == pytest.approx(1e5 * 1.5 * 1.5 / (3.0 * LENGTH**4), rel=1e-12)


HOMED = [name for name in NAMES if name.split()[1] in ("held", "cranked", "swept")]


@pytest.mark.parametrize("name", HOMED)
def test_a_far_end_that_is_held_belongs_where_it_starts(name: str) -> None:
    """Its place, and of a clamped one its frame."""
    r = rod(name, 4, 2)
    side, node, end = ("right", -1, r.structure.right) if r.structure.base == "left" else ("left", 0, r.structure.left)
    poses = r.poses(r.state)
    place = [named(r, f"{side}_home_{axis}") for axis in "xyz"[: r.structure.group.translations]]
    np.testing.assert_allclose(place, poses.position[node], rtol=0, atol=1e-15)
    if end.kind == "clamped" and poses.angle is not None:
        frame = [named(r, f"{side}_home_{x}") for x in ("cos", "sin")]
        np.testing.assert_allclose(frame, poses.rotation[node][:, 0], rtol=0, atol=1e-15)
    elif end.kind == "clamped":
        axes = [[named(r, f"{side}_home_{i}{axis}") for i in (1, 2, 3)] for axis in "xyz"]
        np.testing.assert_allclose(axes, poses.rotation[node], rtol=0, atol=1e-15)


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("name", NAMES)
def test_poses_of_any_state_are_those_of_the_exact_march(name: str, size: tuple[int, int]) -> None:
    """From the base, carried, prescribed or still, to 40 digits and back: the same collocation, written twice."""
    r = rod(name, *size)
    exact, y = oracle.Rod(scene(name), r.mesh.edges, r.mesh.degree, r.base), random_state(r, 31)
    found = r.poses(y, 0.3)
    turn, _, pose = exact.unpack(oracle.MP.mpf(0.3), oracle.numbers(y))
    R, place = (oracle.floats(part) for part in exact.poses(turn, pose))
    space = exact.space
    np.testing.assert_allclose(found.rotation, R[:, :space, :space], rtol=0, atol=1e-13)
    np.testing.assert_allclose(found.position, place[:, :space], rtol=0, atol=1e-13)


def test_a_stepped_weight_adds_up_to_the_force_it_is() -> None:
    """Where a coefficient of the nodes steps between unequal elements, each side counts with its own mass."""
    heavy = CAST["planar plain"] | {"effects": [weight("planar", 0.0, "-2*heaviside(u - 0.4)")]}
    r = discretise(load_scene(heavy), 2, 3)
    assert r.mesh.half[0] != pytest.approx(r.mesh.half[1])
    assert r.mesh.mass @ named(r, "weight_force_2") == pytest.approx(-2 * (1.3 - 0.4), rel=1e-13)


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
    assert named(r, "p_double") == 0.4
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


@pytest.mark.parametrize(("bend", "angle", "apart"), [("3", 3.0, False), ("200*pi", 200 * np.pi, True)])
def test_a_march_with_more_points_tells_whether_a_rod_turns_too_often_for_its_mesh(
    bend: str, angle: float, apart: bool
) -> None:
    """Of a bow it says the same, of a hundred turns in one element something else; its strains are the same."""
    scene = load_scene({
        "rod": {"motion": "planar", "length": 2.0, "stiffness": [1, 1, 1], "friction": [1, 1, 1]},
        "start": {"strain": ["1", "0", bend], "position": [1, 2], "angle": 0.4},
        "run": {"until": 1.0},
    })  # fmt: skip
    made = discretise(scene, 1, 16)
    mesh, poses = made.finer_poses(made.state, 0.0)
    assert mesh.degree == 32
    assert poses.angle is not None
    assert poses.angle[-1] == pytest.approx(0.4 + 2 * angle)
    gap = np.linalg.norm(poses.position[-1] - made.poses(made.state).position[-1])
    assert (gap > 1e-3) == apart
    assert apart or gap < 1e-12
