"""Large motions in closed form: falling, hanging, in traps and flows, in turning fields, sliding along itself, spun."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.marks import slow
from tests.physics.scenes import Scene, changed, gap, semidiscrete, simulate, straight
from tests.references import axial, jeffery, magnetic_rotor, sliding_helix, spun_rod

LENGTH = 1.3
PLANE = ([50.0, 30.0, 0.8], [1.0, 1.7, 0.02])
SPACE = ([50.0, 30.0, 20.0, 0.8, 1.2, 1.0], [1.5, 2.0, 1.8, 0.03, 0.006, 0.008])


def _free(coefficients: tuple[list[float], list[float]], *effects: dict[str, Any], **changes: Any) -> Scene:
    return changed(straight(*coefficients, "free", "free", LENGTH), {"effects": list(effects)} | changes)


@pytest.mark.parametrize("coefficients", [PLANE, SPACE], ids=["planar", "spatial"])
def test_a_free_straight_rod_falls_without_bending_at_the_speeds_of_its_frictions(
    coefficients: tuple[list[float], list[float]],
) -> None:
    """It drifts aside, being dragged harder across than along; position, strain and work to round-off of the steps."""
    weight, start = np.array([1.0, -2.0, 0.7]), np.array([0.3, -0.2, 0.5])
    axes = len(coefficients[0]) // 3 + 1
    if axes == 2:
        axis, place = Rotation.from_rotvec([0.0, 0.0, 0.6]).as_matrix()[:2, :2], {"angle": 0.6}
    else:
        axis, place = Rotation.from_rotvec([0.6, -0.3, 0.8]).as_matrix(), {"rotation": [0.6, -0.3, 0.8]}
    weight, start = weight[:axes], start[:axes]
    effect = {"kind": "weight", "force": weight.tolist()}
    scene = _free(coefficients, effect, start=place | {"position": start.tolist()})
    run = simulate(scene, 1, 6, 1e-10)
    speed = axis @ [axial.falling(w, g) for w, g in zip(axis.T @ weight, coefficients[1], strict=False)]
    expected = start + speed + run.solution.u[:, None] * axis[:, 0]
    assert gap(run.solution.position[-1], expected) < 1e-9
    assert gap(run.solution.turn[-1], [1.0] + [0.0] * (len(coefficients[0]) - 1)) < 1e-11
    assert gap(run.ledger["work"], LENGTH * speed @ weight) < 1e-9
    assert gap(run.ledger["dissipated"], LENGTH * speed @ weight) < 1e-9


@pytest.mark.parametrize("ends", ["held-free", "held-held"])
@pytest.mark.parametrize("time", [0.02, 2.0])
def test_a_rod_hung_up_by_its_ends_stretches_as_the_heat_equation_says(ends: Any, time: float) -> None:
    """Let go unstretched, on its way and at rest."""
    right = {"held-free": "free", "held-held": "clamped"}[ends]
    scene = straight(*PLANE, right=right, length=LENGTH)
    scene = changed(scene, {"effects": [{"kind": "weight", "force": [4.0, 0.0]}], "run.until": time})
    solution = simulate(scene, 1, 16, 1e-11).solution
    position, _ = axial.sagging(solution.u, time, 4.0, 50.0, 1.0, LENGTH, ends)
    _, stretch = axial.sagging(solution.u_point, time, 4.0, 50.0, 1.0, LENGTH, ends)
    assert gap(solution.position[-1, :, 0], position) < 1e-8
    assert gap(solution.turn[-1, :, 0], stretch) < 1e-8


def test_a_trap_pulls_a_straight_rod_home_at_the_rate_of_each_axis() -> None:
    """From far along and far across: compressed along, unbent; positions and stretch at every frame."""
    trap = {"kind": "trap", "stiffness": 3.0, "centre": [0.5, -0.4]}
    middle = np.array([2.5, 1.6])
    scene = _free(PLANE, trap, **{"start.position": [middle[0] - LENGTH / 2, middle[1]], "run.until": 1.5})
    solution = simulate(scene, 1, 12, 1e-11, frames=4).solution
    for frame, t in enumerate(solution.time):
        x, _ = axial.carried(solution.u, t, -3.0, 2.0, 50.0, 1.0, LENGTH)
        y = axial.returning(2.0, t, 3.0, 1.7)
        if frame:  # at the start the series converges slowly
            _, stretch = axial.carried(solution.u_point, t, -3.0, 2.0, 50.0, 1.0, LENGTH)
            assert gap(solution.turn[frame, :, 0], stretch) < 1e-8
            assert gap(solution.position[frame, :, 0], 0.5 + x) < 1e-8
        assert gap(solution.position[frame, :, 1], -0.4 + y) < 1e-8


@pytest.mark.parametrize("coefficients", [PLANE, SPACE], ids=["planar", "spatial"])
def test_a_straining_flow_draws_a_rod_out_and_carries_its_middle(coefficients: tuple[list[float], list[float]]) -> None:
    """Put aside of the point where the flow stands still: the sine of the steady state, and the way there."""
    extension, k1, friction1 = 2.0, coefficients[0][0], coefficients[1][0]
    diagonal = [extension, -extension] if len(coefficients[0]) == 3 else [extension, -0.5, -1.5]
    still = [0.0] * len(diagonal)
    flow = {"kind": "flow", "gradient": diagonal, "velocity": still}
    place = [0.1 - LENGTH / 2, *still[1:]]
    solution = simulate(
        _free(coefficients, flow, **{"start.position": place, "run.until": 0.8}), 1, 12, 1e-11, frames=3
    ).solution
    for frame in (1, 2):
        t = float(solution.time[frame])
        x, _ = axial.carried(solution.u, t, extension, 0.1, k1, friction1, LENGTH)
        _, stretch = axial.carried(solution.u_point, t, extension, 0.1, k1, friction1, LENGTH)
        assert gap(solution.position[frame, :, 0], x) < 1e-8
        assert gap(solution.turn[frame, :, 0], stretch) < 1e-8
    _, steady = axial.extended(solution.u_point, extension, k1, friction1, LENGTH)
    assert gap(solution.turn[-1, :, 0], steady) < 1e-6


RIGID = {"rod.stiffness": [1e9, 1.0, 1.0], "rod.frozen": ["h2", "Pi"]}
"""Neither shears nor bends, and hardly stretches: by 1e-9 of the forces here."""


@pytest.mark.parametrize(
    ("gradient", "velocity"),
    [([[0.0, 2.0], [0.0, 0.0]], [0.3, -0.1]), slow([[0.3, 2.0], [-0.5, -0.3]], [0.0, 0.2])],
    ids=["shear", "general"],
)
def test_a_stiff_rod_in_a_flow_follows_its_jeffery_orbit_and_carries_the_stress_of_it(
    gradient: list[list[float]], velocity: list[float]
) -> None:
    """Through half a turn or more: pose at every frame; the multipliers are the shear force and the moment."""
    rod = jeffery.Rod(LENGTH, *PLANE[1], gradient, velocity)
    flow = {"kind": "flow", "gradient": gradient, "velocity": velocity}
    middle = np.array([0.2, -0.1]) + 0.5 * LENGTH * np.array([np.cos(0.7), np.sin(0.7)])
    changes = {"start.position": [0.2, -0.1], "start.angle": 0.7, "run.until": 12.0}
    scene = _free(PLANE, flow, **(RIGID | changes))
    solution = simulate(scene, 1, 6, 1e-12, backend="auto", frames=13).solution
    assert solution.angle is not None
    for frame, t in enumerate(map(float, solution.time)):
        theta = jeffery.angle(rod, 0.7, t)
        assert gap(solution.angle[frame], theta) < 1e-8
        expected = jeffery.position(rod, solution.u, middle, 0.7, t)
        assert gap(solution.position[frame], expected) < 1e-8 * max(1.0, np.abs(expected).max())
        assert gap(solution.stress[frame, :, 1:], jeffery.stress(rod, solution.u_point, theta)[:, 1:]) < 1e-7
    assert abs(solution.angle[-1, 0] - 0.7) > np.pi


@pytest.mark.parametrize("about", ["middle", slow("end")])
@pytest.mark.parametrize("share", [slow(0.7), 1.4])
def test_a_stiff_magnetised_rod_follows_a_turning_field_or_slips(about: Any, share: float) -> None:
    """Below the critical spin with its lag, above it with a drift; free, or about a pin; the multipliers carry it."""
    spin = share * magnetic_rotor.Rotor(LENGTH, *PLANE[1][1:], 6.0, 1.0, about=about).critical
    rotor = magnetic_rotor.Rotor(LENGTH, *PLANE[1][1:], 6.0, spin, 0.4, about)
    field = {"kind": "field", "moment": [2.0, 0.0], "field": [f"3*cos({spin!r}*t + 0.4)", f"3*sin({spin!r}*t + 0.4)"]}
    left = {"kind": "pinned" if about == "end" else "free"}
    until = 60.0 / rotor.critical
    scene = _free(PLANE, field, **(RIGID | {"ends.left": left, "start.angle": 1.0, "run.until": until}))
    solution = simulate(scene, 1, 6, 1e-13, backend="auto", frames=31).solution
    assert solution.angle is not None
    for frame, t in enumerate(map(float, solution.time)):
        assert gap(solution.angle[frame], magnetic_rotor.angle(rotor, 1.0, t)) < 1e-8
    if share < 1.0:
        lag = spin * until + 0.4 - solution.angle[-1, 0]
        assert gap(lag, magnetic_rotor.lag(rotor)) < 1e-8
        wanted = magnetic_rotor.stress(rotor, solution.u_point, lag)
        assert gap(solution.stress[-1, :, 1:], wanted[:, 1:]) < 1e-7
        assert gap(solution.stress[-1, :, 0], wanted[:, 0]) < 1e-6  # 1e9 times a stretch, whose last digit is 2e-16
    else:
        # to the motion within one period of slipping
        drift = (solution.angle[-1, 0] - 1.0) / until
        assert gap(drift, magnetic_rotor.mean_velocity(rotor)) < 2 * np.pi / until
        assert solution.angle[-1, 0] < spin * until - 4 * np.pi


HELIX = np.array([1.02, 0.05, -0.03, 3.0, 1.0, 4.0])
DRAG = np.diag(SPACE[1]) + 0.02 * (np.eye(6, k=3) + np.eye(6, k=-3))
ARC = np.array([1.02, 0.05, 4.0])


@pytest.mark.parametrize("turn", [ARC, HELIX], ids=["planar", "spatial"])
@pytest.mark.parametrize(
    "ends", [("free", "free"), slow(("driven", "free")), ("free", "driven"), slow(("driven", "driven"))]
)
def test_a_curled_rod_that_is_pushed_along_itself_slides_along_itself(ends: tuple[str, str], turn: Any) -> None:
    """Twenty turns and more by forces and couples fixed in it, or drawn by its ends: the exact helix, to 1e-8."""
    speed, d = 1.5, len(turn)
    drag = DRAG if d == 6 else np.diag(PLANE[1])
    push = sliding_helix.wrench(turn, drag, speed)
    axes = 3 if d == 6 else 2
    twist = sliding_helix.twist(turn, speed).tolist()
    kinds = {name: {"kind": end} | ({"twist": twist} if end == "driven" else {}) for name, end in
             zip(("left", "right"), ends, strict=True)}  # fmt: skip
    effects = [
        {"kind": "follower", "force": push[:axes].tolist()},
        {"kind": "couple", "torque": push[axes:].tolist() if d == 6 else float(push[axes])},
    ]
    rod = {
        "motion": "spatial" if d == 6 else "planar",
        "length": LENGTH,
        "stiffness": (SPACE if d == 6 else PLANE)[0],
        "friction": drag.tolist(),
        "reference": turn.tolist(),
    }
    until = 20 * 2 * np.pi / (speed * np.linalg.norm(turn[axes:]))
    scene = {"rod": rod, "ends": kinds, "effects": effects, "run": {"until": until}}
    run = simulate(scene, 1, 14, 1e-13, backend="auto")
    expected = sliding_helix.pose(turn, run.solution.u, speed * until)
    assert gap(run.solution.position[-1], expected[:, 1:, 0]) < 1e-8
    assert gap(run.solution.rotation[-1], expected[:, 1:, 1:]) < 1e-8
    power = sliding_helix.power(turn, drag, speed, LENGTH)
    assert gap(run.ledger["work"] / (power * until), 1.0) < 1e-9
    assert gap(run.ledger["dissipated"] / (power * until), 1.0) < 1e-9


def test_a_rod_that_is_spun_at_its_base_is_wound_up_by_many_turns() -> None:
    """Below the threshold of whirling: twist, torque and work on the way and in the end, in closed form."""
    rod = spun_rod.Rod(LENGTH, 0.05, 0.03, 90.0)
    scene = changed(
        straight([50.0, 30.0, 30.0, 0.05, 2.0, 2.0], [1.0, 1.7, 1.7, 0.03, 0.01, 0.01], length=LENGTH),
        {"ends.left": {"kind": "driven", "twist": [0.0, 0.0, 0.0, rod.spin, 0.0, 0.0]}, "run.until": 20.0},
    )
    solution = simulate(scene, 1, 14, 1e-11, backend="auto", frames=21).solution
    for frame, t in enumerate(map(float, solution.time)):
        if frame:
            assert gap(solution.turn[frame, :, 3], spun_rod.twist(rod, solution.u_point, t)) < 1e-7
            assert gap(solution.work[frame] / spun_rod.work_of_base(rod, t), 1.0) < 1e-6
    mesh = semidiscrete(scene, 1, 14)[0].mesh
    wound = mesh.weight @ solution.turn[-1, :, 3]
    assert gap(wound, spun_rod.steady_lag(rod, LENGTH)) < 1e-7
    assert abs(wound) > 7 * 2 * np.pi
    assert gap(solution.position[-1], np.stack([solution.u, 0 * solution.u, 0 * solution.u], axis=1)) < 1e-9
    assert gap(solution.energy[-1] / spun_rod.stored_energy(rod), 1.0) < 1e-8
