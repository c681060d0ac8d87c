"""Frozen modes and rotations without friction are limits: of stiff modes, and of ever less friction."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from scipy.spatial.transform import Rotation

from geocosserat.results.solution import Solution
from tests.physics.scenes import Array, Scene, changed, gap, simulate, straight
from tests.references import axial_twist, inextensible_rod, kirchhoff_statics

pytestmark = pytest.mark.slow

DECADES = (1e3, 1e4, 1e5, 1e6, 1e7)


def _planar(k: float, left: str = "clamped") -> Scene:
    """A bent rod under weight, a dead force and a follower; pinned, it swings."""
    return changed(
        straight([k, 0.7 * k, 1.0], [1.0, 2.0, 0.02], left),
        {
            "rod.reference": ["1", "0", "1 - u"],
            "start.strain": ["1", "0", "3*(1 - u)**2*(1 + 2*u)"],
            "start.angle": 0.3,
            "ends.right": {"kind": "free", "force": ["1 + t", -2.0], "frame": "world"},
            "effects": [
                {"kind": "weight", "force": [0.5, -3.0]},
                {"kind": "follower", "force": ["0", "1 + u"]},
            ],
            "run.until": 0.2,
        },
    )


def _spatial(k: float, left: str = "clamped") -> Scene:
    """A curl that opens under weight and a dead force."""
    return changed(
        straight([k, 0.7 * k, 0.5 * k, 0.8, 1.2, 1.0], [1.0, 2.0, 1.8, 0.02, 0.01, 0.015], left),
        {
            "rod.reference": ["1", "0", "0", "1", "u", "2"],
            "start.rotation": [0.3, -0.5, 0.8],
            "ends.right": {"kind": "free", "force": [1.0, 2.0, -2.0], "frame": "world"},
            "effects": [{"kind": "weight", "force": [1.0, -2.0, -4.0]}],
            "run.until": 0.2,
        },
    )


def _solved(scene: Scene, degree: int = 12, rtol: float = 1e-11) -> Solution:
    return simulate(scene, 1, degree, rtol, backend="auto").solution


@pytest.mark.parametrize("left", ["clamped", "pinned"])
@pytest.mark.parametrize("make", [_planar, _spatial])
def test_the_stiff_rod_tends_to_the_one_that_neither_stretches_nor_shears(make: Any, left: str) -> None:
    """As 1/k over four decades: poses, bends, and the stresses of the stiff modes, whose limit are the multipliers."""
    modes = 3 if make is _spatial else 2
    limit = _solved(changed(make(1.0, left), {"rod.frozen": ["h1", "h2", "h3"][:modes]}))
    stiff = [_solved(make(k, left)) for k in DECADES]
    poses = [gap(one.position[-1], limit.position[-1]) for one in stiff]
    bends = [gap(one.turn[-1, :, modes:], limit.turn[-1, :, modes:]) for one in stiff]
    forces = [gap(one.stress[-1, :, :modes], limit.stress[-1, :, :modes]) for one in stiff]
    for errors in (poses, bends, forces):
        # ten times nearer for ten times stiffer, but for a part of the second order, which is of relative size 1/k
        np.testing.assert_allclose(np.divide(errors[1:-1], errors[2:]), 10.0, rtol=0.05)
        np.testing.assert_allclose(errors[0] / errors[1], 10.0, rtol=0.2)
    assert poses[-1] < 1e-5
    assert forces[-1] < 1e-4 * np.abs(limit.stress).max()
    held = np.array([1.0, 0.0, 0.0])[:modes]
    np.testing.assert_array_equal(limit.turn[..., :modes], np.broadcast_to(held, (*limit.turn.shape[:2], modes)))


@pytest.mark.parametrize(
    ("make", "frozen"),
    [(_planar, "h1"), (_planar, "h2"), (_planar, "Pi"), (_spatial, "h2"), (_spatial, "Pi1"), (_spatial, "Pi2")],
)
def test_the_limit_of_one_stiff_mode_is_that_mode_frozen(make: Any, frozen: str) -> None:
    """Any mode, held at a reference that may vary along the rod: pose and multiplier, as 1/k over four decades."""
    names = ["h1", "h2", "Pi"] if make is _planar else ["h1", "h2", "h3", "Pi1", "Pi2", "Pi3"]
    mode = names.index(frozen)
    base = changed(make(500.0), {"start.strain": make(500.0)["rod"]["reference"], "rod.frozen": [frozen]})
    limit = _solved(base)
    stiff = []
    for k in DECADES:
        stiffness = list(base["rod"]["stiffness"])
        stiffness[mode] = k
        stiff.append(_solved(changed(base, {"rod.stiffness": stiffness, "rod.frozen": []})))
    poses = [gap(one.position[-1], limit.position[-1]) for one in stiff]
    stresses = [gap(one.stress[-1, :, mode], limit.stress[-1, :, mode]) for one in stiff]
    for errors in (poses, stresses):
        np.testing.assert_allclose(np.divide(errors[:-1], errors[1:]), 10.0, rtol=0.05)


def test_a_frozen_bend_follows_a_reference_that_changes_as_a_stiff_one_does() -> None:
    """A swimmer whose shape is given: how it moves, and the work it does, as 1/k."""
    scene = changed(
        straight([400.0, 300.0, 1.0], [1.0, 2.0, 0.02], "free"),
        {"rod.reference": ["1", "0", "3*sin(2*pi*(u - t))"], "run.until": 1.0},
    )
    limit = simulate(changed(scene, {"rod.frozen": ["Pi"]}), 1, 16, 1e-11, backend="auto")
    # stiffer ones do the difference of two large works, of which little is left
    stiff = [
        simulate(changed(scene, {"rod.stiffness": [400.0, 300.0, k]}), 1, 16, 1e-11, backend="auto")
        for k in (1e1, 1e2, 1e3)
    ]
    for errors in (
        [gap(one.solution.position[-1], limit.solution.position[-1]) for one in stiff],
        [gap(one.ledger["work"], limit.ledger["work"]) for one in stiff],
    ):
        np.testing.assert_allclose(errors[1] / errors[2], 10.0, rtol=0.1)
    assert limit.ledger["residual"] < 1e-8
    assert np.linalg.norm(limit.solution.position[-1].mean(axis=0) - limit.solution.position[0].mean(axis=0)) > 0.01


def _bent(u: Array) -> Array:
    return 3.0 * u - 3.0 * u**3 + 1.5 * u**4


@pytest.mark.parametrize("friction3", [0, 1e-3, 0.02])
@pytest.mark.parametrize("mirrored", [False, True], ids=["left", "right"])
def test_a_rod_that_cannot_stretch_moves_as_the_equations_of_its_line_say(friction3: float, mirrored: bool) -> None:
    """Large motion under weight and a dead force on its tip, with friction of the rotation and without: to 1e-9."""
    rod = inextensible_rod.Rod(1.0, 1.0, 1.0, 2.0, friction3, _bent, lambda t: (1.0 + 20.0 * t, -2.0), (0.5, -3.0))
    expected = inextensible_rod.solve(rod, 0.05)
    scene = changed(
        straight([1.0, 1.0, 1.0], [1.0, 2.0, friction3]),
        {
            "rod.frozen": ["h1", "h2"],
            "start.strain": ["1", "0", "3*(1 - u)**2*(1 + 2*u)"],
            "ends.right": {"kind": "free", "force": ["1 + 20*t", -2.0], "frame": "world"},
            "effects": [{"kind": "weight", "force": [0.5, -3.0]}],
            "run.until": 0.05,
        },
    )
    if mirrored:  # the same rod counted from its other end
        scene = changed(
            scene,
            {
                "start.strain": ["1", "0", "-3*u**2*(3 - 2*u)"],
                "start.position": _start_of_tip().tolist(),
                "start.angle": 1.5 + np.pi,
                "ends": {"left": scene["ends"]["right"], "right": {"kind": "clamped"}},
            },
        )
    run = simulate(scene, 1, 16, 1e-11, backend="auto")
    far = 0 if mirrored else -1
    assert gap(run.solution.position[-1, far], expected.position[-1]) < 1e-9
    assert run.solution.angle is not None
    assert gap(run.solution.angle[-1, far] - np.pi * mirrored, expected.angle[-1]) < 1e-8
    assert gap(run.ledger["work"], expected.work) < 1e-8
    # without friction of the rotation: it has 1e-10 of the other, and dissipates so much less or more
    assert gap(run.ledger["dissipated"] / expected.dissipated, 1.0) < 1e-8


@cache
def _start_of_tip() -> Array:
    """Where the tip of the bent rod is at the start."""
    x, weight = np.polynomial.legendre.leggauss(40)
    u = 0.5 * (1.0 + x)
    return np.array([0.5 * weight @ np.cos(_bent(u)), 0.5 * weight @ np.sin(_bent(u))])


@pytest.mark.parametrize("friction", [0.01, 0], ids=["rubbed", "quasi-static"])
@pytest.mark.parametrize("frozen", ["h1", "h2"], ids=["Timoshenko-like", "extensible, unshearable"])
def test_at_rest_a_planar_rod_without_stretch_or_without_shear_is_the_one_of_its_own_equations(
    frozen: str, friction: float
) -> None:
    """theta' = M/k3 + curl, M' = h2 F1 - h1 F2, r' = h1 e1 + h2 e2, F the tip's force seen from the section; one of
    h1 = 1 + F1/k1 and h2 = F2/k2 is held: pose, bend and stresses, the held one's too, to 1e-9."""
    k1, k2, k3, load, torque = 30.0, 20.0, 1.1, np.array([2.0, -3.0]), 0.4

    def seen(theta: Array) -> tuple[Array, Array, Array, Array]:
        along = load[0] * np.cos(theta) + load[1] * np.sin(theta)
        across = load[1] * np.cos(theta) - load[0] * np.sin(theta)
        nothing = 0.0 * theta
        h1, h2 = (1.0 + nothing, across / k2) if frozen == "h1" else (1.0 + along / k1, nothing)
        return along, across, h1, h2

    def slope(u: Array, y: Array) -> Array:
        _, _, theta, moment = y
        along, across, h1, h2 = seen(theta)
        c, s = np.cos(theta), np.sin(theta)
        return np.stack([h1 * c - h2 * s, h1 * s + h2 * c, moment / k3 + 1.0 - u, h2 * along - h1 * across])

    def ends(a: Array, b: Array) -> Array:
        return np.array([a[0], a[1], a[2] - 0.3, b[3] - torque])

    u = np.linspace(0.0, 1.0, 41)
    rest = solve_bvp(slope, ends, u, np.stack([u, 0.0 * u, 0.3 + 0.0 * u, 0.0 * u]), tol=1e-11, max_nodes=100_000)
    assert rest.success
    scene = changed(
        straight([k1, k2, k3], [1.0, 2.0, friction]),
        {
            "rod.frozen": [frozen],
            "rod.reference": ["1", "0", "1 - u"],
            "start.angle": 0.3,
            "ends.right": {"kind": "free", "force": load.tolist(), "torque": torque, "frame": "world"},
            "run.until": 40.0,
        },
    )
    solution = _solved(scene, 14, 1e-8)  # it comes to rest: the tolerance in time does not matter
    assert solution.angle is not None
    tip, shape = rest.sol(1.0), rest.sol(solution.u_point)
    along, across, h1, h2 = seen(shape[2])
    assert gap(solution.position[-1, -1], tip[:2]) < 1e-9
    assert gap(solution.angle[-1, -1], tip[2]) < 1e-9
    assert gap(solution.turn[-1].T, [h1, h2, shape[3] / k3 + 1.0 - solution.u_point]) < 1e-8
    assert gap(solution.stress[-1].T, [along, across, shape[3]]) < 1e-8


@pytest.mark.parametrize("friction", [0.01, 0], ids=["rubbed", "quasi-static"])
@pytest.mark.parametrize("frozen", [[], ["Pi1"]], ids=["twistable", "untwistable"])
def test_at_rest_it_is_the_rod_of_kirchhoff(frozen: list[str], friction: float) -> None:
    """Curled at rest, weight, force and torque in the world: pose, bends and all six stresses, to 1e-9."""
    stiffness = (np.inf if frozen else 0.8, 1.2, 1.0)
    base = np.array([0.3, -0.5, 0.8])
    rod = kirchhoff_statics.Rod(
        1.2, stiffness, lambda u: (0.7, 0.5 * np.cos(2.0 * u), 1.0 - 0.6 * u), (0.5, 0.8, -1.0), (0.1, -0.2, 0.15),
        (0.2, -0.5, -1.0), (0.3, -0.2, 0.5), Rotation.from_rotvec(base).as_matrix(),
    )  # fmt: skip
    scene = changed(
        straight([1.0, 1.0, 1.0, 0.8, 1.2, 1.0], [1.0, 2.0, 1.5, *[friction] * 3], length=1.2),
        {
            "rod.frozen": ["h1", "h2", "h3", *frozen],
            "rod.reference": ["1", "0", "0", "0.7", "0.5*cos(2*u)", "1 - 0.6*u"],
            "start.position": [0.3, -0.2, 0.5],
            "start.rotation": base.tolist(),
            "ends.right": {"kind": "free", "force": [0.5, 0.8, -1.0], "torque": [0.1, -0.2, 0.15], "frame": "world"},
            "effects": [{"kind": "weight", "force": [0.2, -0.5, -1.0]}],
            "run.until": 60.0,
        },
    )
    solution = _solved(scene, 14, 1e-7)  # it comes to rest: the tolerance in time does not matter
    expected = kirchhoff_statics.solve(rod)
    shape = expected.at(solution.u_point)
    assert gap(solution.position[-1, -1], expected.tip_position) < 1e-9
    assert gap(solution.rotation[-1, -1], expected.tip_rotation) < 1e-9
    assert gap(solution.turn[-1, :, 3:], shape.bend) < 1e-8
    assert gap(solution.stress[-1, :, :3], shape.force) < 1e-8
    assert gap(solution.stress[-1, :, 3:], shape.moment) < 1e-8


@pytest.mark.parametrize("frozen", [True, False], ids=["frozen", "full"])
@pytest.mark.parametrize("make", [_planar, _spatial])
def test_a_rod_with_ever_less_friction_of_its_rotations_tends_to_one_without(make: Any, frozen: bool) -> None:
    """Linearly over three decades: poses and bends."""
    turns = slice(3, None) if make is _spatial else slice(2, None)
    modes = 3 if make is _spatial else 2
    scene = changed(make(200.0), {"rod.frozen": ["h1", "h2", "h3"][:modes] if frozen else []})
    rest = scene["rod"]["friction"][:modes]
    limit = _solved(changed(scene, {"rod.friction": [*rest, *[0] * (len(rest) * 2 - 3)]}), 10, 1e-10)
    near = [
        _solved(changed(scene, {"rod.friction": [*rest, *[size] * (len(rest) * 2 - 3)]}), 10, 1e-10)
        for size in (1e-3, 1e-4, 1e-5)
    ]
    for errors in (
        [gap(one.position[-1], limit.position[-1]) for one in near],
        [gap(one.turn[-1, :, turns], limit.turn[-1, :, turns]) for one in near],
    ):
        np.testing.assert_allclose(np.divide(errors[:-1], errors[1:]), 10.0, rtol=0.1)
        assert errors[-1] < 1e-4


@pytest.mark.parametrize("component", [0, 3])
def test_pure_stretch_and_pure_twist_diffuse_in_their_closed_profiles(component: int) -> None:
    """All other modes frozen: two modes at once, large, on their way."""
    stiffness, friction = [70.0, 50.0, 40.0, 0.9, 1.2, 1.0], [1.5, 2.0, 1.8, 0.03, 0.006, 0.008]
    names = ["h1", "h2", "h3", "Pi1", "Pi2", "Pi3"]
    start = ["1", "0", "0", "0", "0", "0"]
    start[component] += " + 0.3*cos(0.5*pi*u) - 0.2*cos(1.5*pi*u)"
    scene = changed(
        straight(stiffness, friction),
        {
            "rod.frozen": [name for i, name in enumerate(names) if i != component],
            "start.strain": start,
            "run.until": 0.02,
        },
    )
    solution = _solved(scene, 14)
    expected = axial_twist.strain(
        solution.u_point, 0.02, [0.3, -0.2], stiffness[component], friction[component], 1.0, "clamped-free"
    )
    assert gap(solution.turn[-1, :, component] - (component == 0), expected) < 1e-9
