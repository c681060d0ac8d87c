"""What the program promises about rods, against closed forms and computations that share no code with it."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocosserat
from geocosserat.algebra.exponential import rotation_from_vector, vector_from_rotation
from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.load import load
from geocosserat.model.scene import load_scene
from tests.references import axial_twist, cantilever_modes, circle, elastica, static_rod

STRAIGHT: Mapping[str, Any] = {"motion": "planar", "length": 1.0}

pytestmark = pytest.mark.slow


def _table(path: Path) -> dict[str, Any]:
    return tomllib.loads(path.read_text())


def _tip(path: Path, elements: int, degree: int, rtol: float = 1e-12) -> np.ndarray:
    changes = [f"run.elements={elements}", f"run.degree={degree}", f"run.rtol={rtol}", "run.frames=2"]
    return np.array(geocosserat.run(path, settings=changes).tip["position"])


@pytest.mark.parametrize(
    ("scene", "finest", "degrees", "elements"),
    [
        ("cantilever.toml", (2, 20), {4: 1e-3, 8: 1e-8, 12: 1e-10, 16: 1e-11}, (16, 32, 64, 128)),
        ("helix.toml", (4, 20), {8: 2e-2, 12: 3e-5, 16: 1e-6, 20: 1e-9}, (32, 64, 128, 256)),
    ],
)
def test_the_tip_converges_spectrally_in_degree_and_at_second_order_in_elements(
    examples: Path, scene: str, finest: tuple[int, int], degrees: dict[int, float], elements: tuple[int, ...]
) -> None:
    """One element of growing degree, and growing numbers of degree one, go to the same tip."""
    exact = _tip(examples / scene, *finest)
    errors = [float(np.linalg.norm(_tip(examples / scene, 1, p) - exact)) for p in degrees]
    assert all(error < bound for error, bound in zip(errors, degrees.values(), strict=True)), errors
    coarse = [float(np.linalg.norm(_tip(examples / scene, n, 1, 1e-10) - exact)) for n in elements]
    orders = np.log2(np.array(coarse[:-1]) / np.array(coarse[1:]))
    np.testing.assert_allclose(orders[-2:], 2.0, atol=0.05)


def test_the_drawn_out_helix_comes_to_rest_where_the_boundary_value_problem_says(examples: Path) -> None:
    """All six stiffnesses and frictions differ; the shooting solution knows nothing of time or elements."""
    values = _table(examples / "helix.toml")
    run = geocosserat.run(examples / "helix.toml", settings=["run.until=0.6", "run.frames=2"], accuracy=1e-9)
    base = rotation_from_vector(np.array(values["start"]["rotation"]))
    pull, side = values["parameters"]["pull"], values["parameters"]["side"]
    rest = static_rod.solve(
        static_rod.Rod(
            length=1.0,
            stiffness=np.array(values["rod"]["stiffness"]),
            reference=np.array(values["rod"]["reference"]),
            tip_force=np.array([pull, 0.0, -side]),
            base_rotation=base,
        )
    )
    np.testing.assert_allclose(run.tip["position"], rest.tip_position, rtol=0, atol=1e-9)
    np.testing.assert_allclose(run.tip["rotation"], rest.tip_rotation, rtol=0, atol=1e-8)
    solution = run.solution
    np.testing.assert_allclose(solution.turn[-1], rest.at(solution.u_point).turn, rtol=0, atol=1e-7)


def _rates(scene: Mapping[str, Any], degree: int) -> np.ndarray:
    """Decay rates of the linearised rod about its start, slowest first."""
    rod = discretise(load_scene(scene), 1, degree)
    kernel = load(kernel_text(rod.structure), rod, "c")
    values = np.linalg.eigvals(kernel.jacobian(0.0, rod.state)[:-2, :-2])
    assert np.abs(values.imag).max() < 1e-6 * np.abs(values).max()
    return np.sort(-values.real)


@pytest.mark.usefixtures("c_compiler")
def test_a_cantilever_decays_at_the_rates_of_the_determinant() -> None:
    """Full linear planar system with finite k2 and gamma3, eight digits."""
    rod = {**STRAIGHT, "stiffness": [1e4, 400.0, 1.3], "friction": [1.0, 1.7, 0.02]}
    found = _rates({"rod": rod, "run": {"until": 1.0}}, 24)
    wanted = cantilever_modes.decay_rates(cantilever_modes.Rod(1.0, 400.0, 1.3, 1.7, 0.02), 4)
    for rate in wanted:
        assert np.abs(found / rate - 1).min() < 1e-8


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize(("motion", "component"), [("planar", 0), ("spatial", 3)])
def test_stretch_and_twist_diffuse_at_the_rates_of_the_heat_equation(motion: str, component: int) -> None:
    """Clamped-free: friction u_t = stiffness u''; rates in closed form."""
    d = 3 if motion == "planar" else 6
    stiffness, friction = [50.0 + 11 * i for i in range(d)], [1.0 + 0.3 * i for i in range(d)]
    rod = {"motion": motion, "length": 1.4, "stiffness": stiffness, "friction": friction}
    found = _rates({"rod": rod, "run": {"until": 1.0}}, 20)
    wanted = axial_twist.decay_rates(stiffness[component], friction[component], 1.4, 4, "clamped-free")
    for rate in wanted:
        assert np.abs(found / rate - 1).min() < 1e-8


def test_a_dead_load_bends_the_rod_into_the_elastica() -> None:
    """Equal k1 and k2: the closed form in elliptic integrals is exact at finite stiffness."""
    rod = {**STRAIGHT, "stiffness": [200.0, 200.0, 1.0], "friction": [1.0, 1.0, 0.01]}
    ends = {"right": {"kind": "free", "force": [-1.0, -4.0], "frame": "world"}}
    run = geocosserat.run({"rod": rod, "ends": ends, "run": {"until": 8.0, "frames": 2, "accuracy": 1e-10}})
    shape = elastica.elliptic(elastica.Cantilever(1.0, 200.0, 1.0, (-1.0, -4.0)), np.array([1.0]))
    np.testing.assert_allclose(run.tip["position"], shape.position[0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(run.tip["angle"], shape.angle[0], rtol=0, atol=1e-9)


def test_an_end_moment_rolls_the_rod_into_a_circle() -> None:
    """2 pi k3 / L closes the rod: the tip comes back to the clamp, one turn on."""
    torque = 2 * np.pi * 0.7 / 1.3
    rod = {"motion": "planar", "length": 1.3, "stiffness": [500.0, 400.0, 0.7], "friction": [1.0, 2.0, 0.01]}
    ends = {"right": {"kind": "free", "torque": torque, "frame": "body"}}
    run = geocosserat.run({"rod": rod, "ends": ends, "run": {"until": 12.0, "frames": 2, "accuracy": 1e-10}})
    u = np.array([1.3])
    np.testing.assert_allclose(run.tip["position"], circle.position(u, torque, 0.7)[0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(run.tip["angle"], 2 * np.pi, rtol=1e-9)


@pytest.mark.parametrize("scene", ["cantilever.toml", "follower.toml", "chiral.toml"])
def test_moving_the_whole_scene_changes_no_strain(examples: Path, scene: str) -> None:
    """A rod that sees no world is the same wherever it starts, as far away as a million lengths."""
    spatial = _table(examples / scene)["rod"]["motion"] == "spatial"
    far = "start.position=[1e6, -1e6, 1e6]" if spatial else "start.position=[1e6, -1e6]"
    turned = "start.rotation=[0.3, -1.1, 0.7]" if spatial else "start.angle=2.1"
    here = geocosserat.run(examples / scene, settings=["run.frames=3", "run.elements=2", "run.degree=6"])
    there = geocosserat.run(examples / scene, settings=[far, turned, "run.frames=3", "run.elements=2", "run.degree=6"])
    np.testing.assert_array_equal(here.solution.turn, there.solution.turn)


def test_turning_the_world_along_changes_no_strain(examples: Path) -> None:
    """Under a dead load, the rod and the load turned together are the same rod, to round-off of the time steps."""
    R = rotation_from_vector(np.array([0.4, 0.2, -0.9]))
    settings = ["run.frames=3", "run.elements=2", "run.degree=8", "run.rtol=1e-10"]
    here = geocosserat.run(examples / "helix.toml", settings=settings)
    start = rotation_from_vector(np.array(_table(examples / "helix.toml")["start"]["rotation"]))
    force = R @ np.array([30.0, 0.0, -3.0])
    moved = [
        f"ends.right.force={force.tolist()}",
        f"start.rotation={vector_from_rotation(R @ start).tolist()}",
        "start.position=[1e6, 2e6, -3e6]",
    ]
    there = geocosserat.run(examples / "helix.toml", settings=[*settings, *moved])
    np.testing.assert_allclose(here.solution.turn, there.solution.turn, rtol=0, atol=1e-8)


def test_the_drag_on_a_free_rod_balances_its_loads_to_round_off() -> None:
    """Sum over the nodes of mass times friction times twist, in the world, against the forces applied."""
    friction = np.diag([1.0, 2.0, 1.8, 0.01, 0.02, 0.03])
    rod = {
        "motion": "spatial",
        "length": 1.0,
        "stiffness": [900.0, 700.0, 600.0, 0.8, 1.5, 1.2],
        "friction": np.diag(friction).tolist(),
        "reference": ["1", "0", "0", "1", "2*u", "0.5"],
    }
    free = {"kind": "free", "force": [0.3, -0.2, 0.9], "torque": [0.1, 0.0, 0.2], "frame": "world"}
    scene = {
        "rod": rod,
        "start": {"strain": ["1.1", "0.1*u", "0", "2", "1", "3*u"], "rotation": [0.2, 0.5, -0.1]},
        "ends": {"left": {"kind": "free"}, "right": free},
        "effects": [{"kind": "weight", "force": [0.0, 0.0, "-2*(1 + u)"]}],
        "run": {"until": 0.3, "frames": 5, "elements": 2, "degree": 16, "rtol": 1e-9},
    }
    solution = geocosserat.run(scene).solution
    mass = discretise(load_scene(scene), 2, 16).mesh.mass
    drag = np.einsum("n,tnij,tnj->tni", mass, solution.rotation, solution.twist[..., :3] @ friction[:3, :3])
    couple = np.einsum("n,tnij,tnj->tni", mass, solution.rotation, solution.twist[..., 3:] @ friction[3:, 3:])
    force = np.array([0.3, -0.2, 0.9]) + np.array([0.0, 0.0, -2.0]) * np.sum(mass * (1 + solution.u))
    np.testing.assert_allclose(drag.sum(axis=1), np.broadcast_to(force, (5, 3)), rtol=0, atol=1e-11)
    # moments about the tip
    arm = solution.position - solution.position[:, -1:]
    weight = mass[:, None] * np.array([0.0, 0.0, -2.0]) * (1 + solution.u)[:, None]
    moment = (couple + np.cross(arm, drag)).sum(axis=1)
    applied = np.array([0.1, 0.0, 0.2]) + np.cross(arm, weight[None]).sum(axis=1)
    np.testing.assert_allclose(moment, applied, rtol=0, atol=1e-11)


def test_a_planar_scene_in_space_moves_in_its_plane(examples: Path) -> None:
    """The same rod given six components: the planar answer, and nothing out of the plane."""
    planar = geocosserat.run(examples / "cantilever.toml", accuracy=1e-9)
    values = _table(examples / "cantilever.toml")
    rod = {
        "motion": "spatial",
        "length": 1.0,
        "stiffness": [1e4, 1e4, 300.0, 2.0, 3.0, 1.0],
        "friction": [1.0, 1.0, 2.0, 0.02, 0.02, 0.01],
    }
    bend = values["start"]["strain"][2]
    scene = {"rod": rod, "start": {"strain": ["1", "0", "0", "0", "0", bend]}, "run": {**values["run"]}}
    spatial = geocosserat.run(scene, accuracy=1e-9)
    np.testing.assert_allclose(spatial.tip["position"][:2], planar.tip["position"], rtol=0, atol=2e-9)
    assert np.abs(spatial.solution.position[..., 2]).max() == 0.0


@pytest.mark.parametrize("path", sorted((Path(__file__).parents[2] / "examples").glob("*.toml")), ids=lambda p: p.stem)
def test_the_ledger_of_every_example_closes(path: Path) -> None:
    """Stored + dissipated = work, to ten times the accuracy asked for; and without loads the energy only falls."""
    run = geocosserat.run(path)
    assert run.reached
    assert run.error["estimated"] <= run.error["requested"]
    assert run.ledger["residual"] < 10 * run.error["requested"]
    if run.ledger["work"] == 0.0:
        energy = run.solution.energy
        assert np.all(np.diff(energy) <= 1e-9 * energy[0])


@pytest.mark.parametrize(
    "path", sorted((Path(__file__).parents[2] / "examples" / "stability").glob("*.toml")), ids=lambda p: p.stem
)
def test_a_rod_whose_stability_is_asked_for_runs_too_and_its_ledger_closes(path: Path) -> None:
    """Most are at rest, stable or not: all that stored + dissipated = work is off by is round-off, beside the energy of
    a bend, 1 in the units of these scenes, or the energy that the rod holds."""
    run = geocosserat.run(path, settings=["run.frames=2"])
    assert run.reached
    terms = [run.ledger[name] for name in ("stored", "dissipated", "work")]
    left = abs(terms[0] + terms[1] - terms[2])
    assert left < max(10 * run.error["requested"] * max(map(abs, terms)), 1e-9 * max(1.0, run.energy["start"]))
