"""Laws that no rod may break, whatever its coefficients: symmetry, balance, dissipation."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.marks import slow
from tests.physics.scenes import Array, Scene, changed, semidiscrete, simulate, straight

PLANE = ([1e4, 5e3, 1.0], [1.0, 2.0, 0.01])
SPACE = ([4e3, 1.5e3, 1e3, 0.8, 1.2, 1.0], [1.0, 2.0, 1.8, 0.01, 0.006, 0.008])


def _in_the_world(dimension: int, left: str, loads: Rotation, place: dict[str, Any]) -> Scene:
    """A curled rod with a dead load on its end, a couple and a weight, all fixed in a world that may be turned."""
    d = 3 if dimension == 6 else 2
    force, couple, weight = (loads.apply(v)[:d] for v in ([3.0, 1.0, -2.0], [0.1, 0.2, 0.3], [1.0, -2.0, -4.0]))
    planar = dimension == 3
    return changed(
        straight(*(PLANE if planar else SPACE), left=left),
        {
            "rod.reference": ["1", "0", "2*u"] if planar else ["1", "0", "0", "1", "u", "2"],
            "start": place,
            "ends.right.force": [f"{float(x)!r}*cos(9*t)" for x in force],
            "ends.right.torque": 0.3 if planar else [float(x) for x in couple],
            "ends.right.frame": "world",
            "effects": [{"kind": "weight", "force": [f"{float(x)!r}*(1 + u)" for x in weight]}],
            "run.until": 0.05,
        },
    )


def _plane(left: str, turned: float, shift: Array) -> Scene:
    place = {"position": (np.array([0.1, 0.2]) + shift).tolist(), "angle": 0.3 + turned}
    return _in_the_world(3, left, Rotation.from_rotvec([0.0, 0.0, turned]), place)


def _space(left: str, turned: list[float], shift: Array) -> Scene:
    turn, base = Rotation.from_rotvec(turned), Rotation.from_rotvec([0.3, -0.5, 0.8])
    place = {"position": (np.array([0.1, 0.2, 0.3]) + shift).tolist(), "rotation": (turn * base).as_rotvec().tolist()}
    return _in_the_world(6, left, turn, place)


@pytest.mark.parametrize("left", ["clamped", slow("free")])
def test_a_scene_shifted_by_a_million_lengths_moves_as_it_did(left: str) -> None:
    """Strains do not change in a single bit; positions shift, up to their own rounding."""
    for make, still, shift in (
        (_plane, 0.0, np.array([1e6, -3e5])),
        (_space, [0.0, 0.0, 0.0], np.array([1e6, -3e5, 7.0])),
    ):
        here, there = (simulate(make(left, still, by), 1, 8, 1e-6, frames=4).solution for by in (0.0 * shift, shift))
        np.testing.assert_array_equal(there.turn, here.turn)
        np.testing.assert_allclose(there.position - shift, here.position, rtol=0, atol=3e-10)


@pytest.mark.parametrize("left", [slow("clamped"), "free"])
def test_a_scene_turned_as_a_whole_moves_as_it_did(left: str) -> None:
    """With its loads, by any angle, in the plane by many turns: equal strains, but for the rounding of the loads."""
    for make, turns in ((_plane, [2.0, -300.0]), (_space, [[1.2, -2.0, 0.7], [0.0, 3.1, 0.0]])):
        nothing = 0.0 * np.asarray(turns[0])
        shift = np.zeros(2 if make is _plane else 3)
        here = simulate(make(left, nothing if nothing.ndim else 0.0, shift), 1, 10, 1e-12).solution
        for turn in turns:
            there = simulate(make(left, turn, shift), 1, 10, 1e-12).solution
            np.testing.assert_allclose(there.turn, here.turn, rtol=0, atol=1e-10)
            np.testing.assert_allclose(there.twist, here.twist, rtol=0, atol=1e-8)


@pytest.mark.parametrize(
    ("elements", "degree", "bound"), [(1, 8, 1e-5), (2, 8, 1e-8), (4, 8, 1e-12), slow(4, 16, 1e-13)]
)
def test_a_free_rod_in_the_plane_drags_exactly_what_weighs_on_it(elements: int, degree: int, bound: float) -> None:
    """Force and moment of the drag against the weight, at every frame: to the discretisation, then to round-off."""
    friction, weight = np.diag([1.0, 2.0, 5e-3]), np.array([0.0, -500.0])
    scene = changed(
        straight([1e4, 1e4, 1.0], np.diag(friction).tolist(), left="free"),
        {
            "rod.reference": ["1", "0", "4*u**2"],
            "start.angle": 0.6,
            "effects": [{"kind": "weight", "force": weight.tolist()}],
            "run.until": 0.05,
        },
    )
    solution = simulate(scene, elements, degree, 1e-9, frames=6).solution
    mass = semidiscrete(scene, elements, degree)[0].mesh.mass
    drag = solution.twist @ friction
    pull = np.einsum("tnij,tnj->tni", solution.rotation, drag[..., :2])
    arm = solution.position - solution.position[:, :1]

    def moment(force: Array) -> Array:
        return arm[..., 0] * force[..., 1] - arm[..., 1] * force[..., 0]

    np.testing.assert_allclose(np.einsum("n,tni->ti", mass, pull - weight), 0.0, atol=500 * bound)
    couple = (moment(pull) + drag[..., 2] - moment(np.broadcast_to(weight, pull.shape))) @ mass
    np.testing.assert_allclose(couple, 0.0, atol=500 * bound)


def test_a_planar_rod_given_in_space_stays_in_its_plane_and_moves_as_in_the_plane() -> None:
    """Under dead and follower loads and weight, whatever the coefficients of the other modes; free at the left."""
    planar = changed(
        straight([900.0, 400.0, 0.8], [1.0, 2.0, 0.01], left="free"),
        {
            "rod.reference": ["1", "0", "2*u"],
            "start.angle": 0.4,
            "ends.left.force": [0.5, -1.0],
            "ends.right.force": ["2*cos(20*t)", "1"],
            "ends.right.torque": "0.5*t",
            "ends.right.frame": "world",
            "effects": [{"kind": "weight", "force": ["1", "-3*u"]}],
            "run.until": 0.1,
        },
    )
    spatial = changed(
        straight([900.0, 400.0, 77.0, 3.0, 5.0, 0.8], [1.0, 2.0, 0.3, 0.07, 0.05, 0.01], left="free"),
        {
            "rod.reference": ["1", "0", "0", "0", "0", "2*u"],
            "start.rotation": [0.0, 0.0, 0.4],
            "ends.left.force": [0.5, -1.0, 0.0],
            "ends.right.force": ["2*cos(20*t)", "1", "0"],
            "ends.right.torque": ["0", "0", "0.5*t"],
            "ends.right.frame": "world",
            "effects": [{"kind": "weight", "force": ["1", "-3*u", "0"]}],
            "run.until": 0.1,
        },
    )
    flat, deep = (simulate(scene, 1, 12, 1e-11, frames=4).solution for scene in (planar, spatial))
    np.testing.assert_allclose(deep.position[..., :2], flat.position, rtol=0, atol=1e-9)
    np.testing.assert_allclose(deep.turn[..., [0, 1, 5]], flat.turn, rtol=0, atol=1e-8)
    np.testing.assert_array_equal(deep.position[..., 2], 0.0)
    np.testing.assert_array_equal(deep.turn[..., 2:5], 0.0)
    np.testing.assert_allclose([deep.energy, deep.dissipated, deep.work], [flat.energy, flat.dissipated, flat.work],
                               rtol=0, atol=1e-8)  # fmt: skip


@pytest.mark.parametrize("ends", [("clamped", "free"), ("free", "free"), ("clamped", "clamped"), ("free", "clamped")])
@pytest.mark.parametrize("coefficients", [PLANE, SPACE], ids=["planar", "spatial"])
@pytest.mark.parametrize("rtol", [1e-3, 1e-8])
def test_a_passive_rod_without_loads_never_gains_energy(
    coefficients: tuple[list[float], list[float]], ends: tuple[str, str], rtol: float
) -> None:
    """From a wild start, frame by frame, also at a loose tolerance; what it loses is what friction takes."""
    rng = np.random.default_rng(5)
    d = len(coefficients[0])
    waves = [f"{a:.2f}*sin({b:.2f}*u) + {c:.2f}" for a, b, c in rng.uniform(-3, 3, (d, 3))]
    stretch = 2 if d == 3 else 3
    strain = [f"{int(i == 0)} + 0.02*({w})" if i < stretch else f"2*({w})" for i, w in enumerate(waves)]
    scene = changed(straight(*coefficients, *ends), {"start.strain": strain, "run.until": 0.3})
    solution = simulate(scene, 1, 6, rtol, frames=60).solution
    start = solution.energy[0]
    assert np.all(np.diff(solution.energy) <= 0.1 * rtol * start)
    np.testing.assert_array_equal(solution.work, 0.0)
    assert np.all(np.diff(solution.dissipated) >= -0.1 * rtol * start)
    balance = solution.energy + solution.dissipated
    np.testing.assert_allclose(balance, start, rtol=0, atol=1000 * rtol * start)
    assert solution.energy[-1] < 0.8 * start


def test_a_matrix_of_stiffness_and_friction_is_felt_in_any_basis() -> None:
    """Turning the section about its normal turns full matrices, strains and loads, and nothing else."""
    rng = np.random.default_rng(3)
    turn = Rotation.from_rotvec([0.7, 0.0, 0.0]).as_matrix()
    both = np.kron(np.eye(2), turn)

    def full(diagonal: list[float]) -> Array:
        root = np.sqrt(np.outer(diagonal, diagonal))
        mixing = rng.uniform(-0.15, 0.15, (6, 6))
        return root * (np.eye(6) + mixing + mixing.T - 2 * np.diag(np.diag(mixing)))

    stiffness, friction = full([40.0, 30.0, 25.0, 0.8, 1.0, 1.3]), full(SPACE[1])
    reference, force = np.array([1.0, 0.0, 0.0, 0.5, 0.2, 1.0]), np.array([0.3, 1.0, -0.4])

    def scene(stiffness: Array, friction: Array, reference: Array, force: Array) -> Scene:
        return changed(
            straight(stiffness.tolist(), friction.tolist()),
            {
                "rod.motion": "spatial",
                "rod.reference": reference.tolist(),
                "ends.right.force": force.tolist(),
                "ends.right.frame": "body",
                "run.until": 0.1,
            },
        )

    plain = simulate(scene(stiffness, friction, reference, force), 1, 8, 1e-11).solution
    other = simulate(
        scene(both @ stiffness @ both.T, both @ friction @ both.T, both @ reference, turn @ force), 1, 8, 1e-11
    ).solution
    np.testing.assert_allclose(other.turn, plain.turn @ both.T, rtol=0, atol=1e-9)
    np.testing.assert_allclose(other.energy, plain.energy, rtol=1e-9, atol=1e-11)
