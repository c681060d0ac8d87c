"""Motions and states that are known in closed form: diffusion, the modes of the cantilever, elastica and circle."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.marks import slow
from tests.physics.scenes import Scene, changed, example, polynomial, semidiscrete, simulate, straight, tip
from tests.references import axial_twist, cantilever_modes, circle, elastica, static_rod

LENGTH = 1.3
STIFFNESS, FRICTION = [70.0, 50.0, 40.0, 0.9, 1.2, 1.0], [1.5, 2.0, 1.8, 0.03, 0.006, 0.008]
STRETCH, TWIST = 0, 3


def _rates(scene: Scene, degree: int) -> np.ndarray:
    """Decay rates (1 / time) of the linearised rod about its start, on one element, slowest first."""
    rod, kernel = semidiscrete(scene, 1, degree)
    values = np.linalg.eigvals(kernel.jacobian(0.0, rod.state)[: rod.unknowns, : rod.unknowns])
    assert np.abs(values.imag).max() < 1e-6 * np.abs(values).max()
    return np.sort(-values.real)


def _diffusing(component: int, ends: axial_twist.Ends, amplitudes: list[float]) -> Scene:
    """Stretch or twist that starts as a sum of modes."""
    waves = axial_twist.wave_numbers(LENGTH, len(amplitudes), ends)
    shape = "cos" if ends == "clamped-free" else "sin"
    start = ["1", "0", "0", "0", "0", "0"]
    start[component] += "".join(
        f" + ({a!r})*{shape}({q!r}*u)" for a, q in zip(amplitudes, map(float, waves), strict=True)
    )
    left = "clamped" if ends == "clamped-free" else "free"
    return changed(straight(STIFFNESS, FRICTION, left=left, length=LENGTH), {"start.strain": start, "run.until": 0.02})


@pytest.mark.parametrize("ends", ["clamped-free", "free-free"])
@pytest.mark.parametrize("component", [STRETCH, TWIST])
def test_stretch_and_twist_diffuse_in_their_closed_profiles(component: int, ends: axial_twist.Ends) -> None:
    """Three modes at once, large, as they fade: strain at all points, velocity at all nodes, at every frame."""
    amplitudes = [0.3, -0.2, 0.1]
    solution = simulate(_diffusing(component, ends, amplitudes), 1, 16, 1e-11, frames=5).solution
    k, friction = STIFFNESS[component], FRICTION[component]
    rates = axial_twist.decay_rates(k, friction, LENGTH, 3, ends)
    moving = axial_twist.velocity_modes(solution.u, k, friction, LENGTH, 3, ends)
    rest = 1.0 if component == STRETCH else 0.0
    for frame, t in enumerate(solution.time):
        strain = axial_twist.strain(solution.u_point, t, amplitudes, k, friction, LENGTH, ends)
        np.testing.assert_allclose(solution.turn[frame, :, component] - rest, strain, rtol=0, atol=1e-9)
        velocity = (np.array(amplitudes) * np.exp(-rates * t)) @ moving
        np.testing.assert_allclose(
            solution.twist[frame, :, component], velocity, rtol=0, atol=1e-8 * np.abs(moving).max()
        )
    others = np.delete(np.arange(6), component)
    np.testing.assert_array_equal(solution.turn[..., others], np.broadcast_to(solution.turn[0, 0, others], (5, 16, 5)))


@pytest.mark.parametrize("ends", ["clamped-free", "free-free"])
@pytest.mark.parametrize("component", [STRETCH, TWIST])
def test_stretch_and_twist_have_the_rates_of_the_heat_equation(component: int, ends: axial_twist.Ends) -> None:
    """Eigenvalues of the kernel's Jacobian, five modes to nine digits."""
    found = _rates(_diffusing(component, ends, [0.0]), 18)
    for rate in axial_twist.decay_rates(STIFFNESS[component], FRICTION[component], LENGTH, 5, ends):
        assert np.abs(found / rate - 1.0).min() < 1e-9


@pytest.mark.parametrize(("load", "component"), [("force", STRETCH), ("torque", TWIST)])
def test_a_load_along_the_rod_is_felt_at_the_clamp_as_heat_would_be(load: str, component: int) -> None:
    """Pulled or twisted at its end from rest, which no smooth function does: strain and work still converge."""
    k, friction, t, size = STIFFNESS[component], FRICTION[component], 0.02, 0.4
    scene = changed(
        straight(STIFFNESS, FRICTION, length=LENGTH), {f"ends.right.{load}": [size, 0.0, 0.0], "run.until": t}
    )
    run = simulate(scene, 2, 12, 1e-10)
    expected = axial_twist.loaded_strain(run.solution.u_point, t, size, k, friction, LENGTH)
    rest = 1.0 if component == STRETCH else 0.0
    np.testing.assert_allclose(run.solution.turn[-1, :, component] - rest, expected, rtol=0, atol=1e-4 * size / k)
    moved = axial_twist.loaded_tip(t, size, k, friction, LENGTH)
    assert run.ledger["work"] == pytest.approx(size * moved, rel=1e-6)


@pytest.mark.parametrize(("k2", "friction3"), [(400.0, 0.02), (1e4, 1e-3), (8.0, 0.3)])
def test_the_straight_cantilever_decays_at_the_rates_of_the_linear_theory(k2: float, friction3: float) -> None:
    """Slender, stiff and shear-soft: the first five modes of bending and shear, to eight digits."""
    modes = cantilever_modes.Rod(LENGTH, k2, 0.8, 1.7, friction3)
    planar = straight([1e4, k2, 0.8], [1.0, 1.7, friction3], length=LENGTH)
    spatial = straight([1e4, k2, 77.0, 3.0, 5.0, 0.8], [1.0, 1.7, 0.3, 0.07, 0.05, friction3], length=LENGTH)
    turned = straight([1e4, 77.0, k2, 3.0, 0.8, 5.0], [1.0, 0.3, 1.7, 0.07, friction3, 0.05], length=LENGTH)
    expected = cantilever_modes.decay_rates(modes, 5)
    for scene in (planar, spatial, turned):
        found = _rates(scene, 22)
        for rate in expected:
            assert np.abs(found / rate - 1.0).min() < 1e-8


@pytest.mark.parametrize("index", [0, 1])
def test_a_mode_of_the_cantilever_keeps_its_shape_and_fades_at_its_rate(index: int) -> None:
    """A small mode in a run: one time constant later all strains and velocities are 1 / e of what they were."""
    modes = cantilever_modes.Rod(LENGTH, 400.0, 0.8, 1.7, 0.02)
    mode = cantilever_modes.mode(modes, index, np.linspace(0.0, LENGTH, 60))
    size = 1e-5
    shear, bend = (polynomial(mode.u, size * mode.strain[:, i], 18) for i in (1, 2))
    scene = changed(
        straight([1e4, 400.0, 0.8], [1.0, 1.7, 0.02], length=LENGTH),
        {"start.strain": ["1", shear, bend], "run.until": 1.0 / mode.rate},
    )
    solution = simulate(scene, 1, 18, 1e-10, atol=1e-16, frames=3).solution
    at_points = cantilever_modes.mode(modes, index, solution.u_point).strain
    at_nodes = cantilever_modes.mode(modes, index, solution.u).velocity
    for frame, t in enumerate(solution.time):
        fade = size * np.exp(-mode.rate * t)
        np.testing.assert_allclose(solution.turn[frame, :, 2], fade * at_points[:, 2], rtol=0, atol=1e-8 * size)
        np.testing.assert_allclose(solution.turn[frame, :, 1], fade * at_points[:, 1], rtol=0, atol=1e-8 * size)
        np.testing.assert_allclose(solution.twist[frame], fade * at_nodes, rtol=0, atol=1e-5 * size * mode.rate)


@pytest.mark.parametrize("force", [(0.0, -5.0), (-4.0, 1.0), (3.0, 2.0)])
@pytest.mark.parametrize("k", [slow(50.0), 1e4])
def test_a_dead_tip_force_bends_the_rod_into_the_elastica(force: tuple[float, float], k: float) -> None:
    """Across, pushing and pulling: after a long time the closed form, positions, angles and strains."""
    scene = changed(
        straight([k, k, 1.0], [1.0, 1.0, 0.01]),
        {"ends.right.force": list(force), "ends.right.frame": "world", "run.until": 15.0},
    )
    solution = simulate(scene, 2, 12, 1e-10).solution
    shape = elastica.elliptic(elastica.Cantilever(1.0, k, 1.0, force), solution.u)
    np.testing.assert_allclose(solution.position[-1], shape.position, rtol=0, atol=1e-9)
    assert solution.angle is not None
    np.testing.assert_allclose(solution.angle[-1], shape.angle, rtol=0, atol=1e-9)
    at_points = elastica.elliptic(elastica.Cantilever(1.0, k, 1.0, force), solution.u_point)
    np.testing.assert_allclose(solution.turn[-1], at_points.strain, rtol=0, atol=2e-9)


@pytest.mark.parametrize("end", ["left", "right"])
@pytest.mark.parametrize("turns", [1.0, -2.5])
def test_an_end_moment_rolls_the_rod_into_an_arc(turns: float, end: str) -> None:
    """One turn closes the circle, more wind it up; the angle counts the turns; from either end."""
    torque = 2.0 * np.pi * turns * 0.7 / LENGTH
    clamp = "right" if end == "left" else "left"
    scene = changed(
        straight([500.0, 400.0, 0.7], [1.0, 2.0, 0.01], length=LENGTH),
        {f"ends.{end}": {"kind": "free", "torque": torque}, f"ends.{clamp}": {"kind": "clamped"}, "run.until": 40.0},
    )
    solution = simulate(scene, 1, 20 if abs(turns) > 1 else 14, 1e-10).solution
    assert solution.angle is not None
    sign = 1.0 if end == "right" else -1.0
    np.testing.assert_allclose(solution.turn[-1, :, 2], sign * torque / 0.7, rtol=1e-9)
    turned = solution.angle[-1] - solution.angle[-1, 0 if end == "right" else -1]
    distance = solution.u if end == "right" else solution.u - LENGTH
    np.testing.assert_allclose(turned, sign * torque / 0.7 * distance, rtol=0, atol=1e-8)
    along = circle.position(np.array([LENGTH]), torque, 0.7)[0]
    chord = solution.position[-1, -1] - solution.position[-1, 0]
    np.testing.assert_allclose(np.linalg.norm(chord), np.linalg.norm(along), rtol=0, atol=1e-9)


@pytest.mark.parametrize("frame", ["world", "body"])
def test_at_rest_it_is_the_rod_that_shooting_finds(frame: str) -> None:
    """Every mode coupled, curled at rest, a force, a torque and a weight that grows along it: pose, strain, stress."""
    size = np.array([40.0, 30.0, 25.0, 0.8, 1.0, 1.3])
    mixing = 0.12 * np.sin(np.add.outer(np.arange(6), np.arange(6)) * 1.7 + 0.4) * (1.0 - np.eye(6))
    stiffness = np.sqrt(np.outer(size, size)) * (np.eye(6) + mixing)
    force, torque, base = np.array([0.2, 0.4, -0.5]), np.array([0.1, -0.2, 0.15]), np.array([0.3, -1.2, 0.7])
    world = frame == "world"
    rod = static_rod.Rod(
        length=1.4,
        stiffness=stiffness,
        reference=lambda u: np.array([1.0, 0.05 * u, 0.0, 0.3, 0.5 * np.cos(2.0 * u), -0.4 + 0.6 * u]),
        tip_force=force if world else static_rod.ZERO,
        tip_torque=torque if world else static_rod.ZERO,
        body_force=static_rod.ZERO if world else force,
        body_torque=static_rod.ZERO if world else torque,
        weight=lambda u: np.array([0.2, -0.3 - 0.5 * u, 0.1 * u**2]),
        base_position=(0.3, -0.2, 0.5),
        base_rotation=Rotation.from_rotvec(base).as_matrix(),
    )
    scene = changed(
        straight([list(map(float, row)) for row in stiffness], [1.0, 2.0, 1.5, 0.02, 0.03, 0.01], length=1.4),
        {
            "rod.motion": "spatial",
            "rod.reference": ["1", "0.05*u", "0", "0.3", "0.5*cos(2*u)", "-0.4 + 0.6*u"],
            "start.position": [0.3, -0.2, 0.5],
            "start.rotation": base.tolist(),
            "ends.right": {"kind": "free", "force": force.tolist(), "torque": torque.tolist(), "frame": frame},
            "effects": [{"kind": "weight", "force": ["0.2", "-0.3 - 0.5*u", "0.1*u**2"]}],
            "run.until": 60.0,
        },
    )
    solution = simulate(scene, 1, 18, 1e-9).solution
    expected = static_rod.solve(rod)
    np.testing.assert_allclose(solution.position[-1, -1], expected.tip_position, rtol=0, atol=1e-9)
    np.testing.assert_allclose(solution.rotation[-1, -1], expected.tip_rotation, rtol=0, atol=1e-9)
    shape = expected.at(solution.u_point)
    np.testing.assert_allclose(solution.turn[-1], shape.turn, rtol=0, atol=1e-9)
    np.testing.assert_allclose(solution.stress[-1], shape.stress, rtol=0, atol=1e-8)
    np.testing.assert_allclose(solution.twist[-1], 0.0, atol=1e-7)


def test_the_circle_example_closes() -> None:
    """Given time, its tip comes back to the clamp, one turn on."""
    run = simulate(changed(example("circle"), {"run.until": 10.0}), 2, 12, 1e-10)
    np.testing.assert_allclose(tip(run), [0.0, 0.0], atol=1e-9)
    assert run.tip["angle"] == pytest.approx(2.0 * np.pi, rel=1e-9)
