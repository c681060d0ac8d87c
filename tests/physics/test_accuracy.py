"""The accuracy asked for is the accuracy got: space and time together, in every example."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import geocosserat
from geocosserat.conductor import search
from geocosserat.discretisation.mesh import make_mesh
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.model.scene import load_scene
from geocosserat.planning.gap import interpolate, position_gap
from tests.physics.scenes import EXAMPLES, NAMES, Array, example, simulate

pytestmark = pytest.mark.slow


@cache
def _fine(name: str) -> Array:
    """Positions of an example at the end on a mesh that is fine enough for all its answers."""
    return simulate(example(name), 4, 16, 1e-10, backend="auto").solution.position[-1]


@pytest.mark.parametrize("accuracy", [1e-3, 1e-5])
@pytest.mark.parametrize("name", NAMES)
def test_the_true_error_is_below_the_one_asked_for(name: str, accuracy: float) -> None:
    """Largest distance of any node from a far finer rod, relative to the length; and it says that it is."""
    settings = ["run.frames=2"]
    run = geocosserat.run(EXAMPLES / f"{name}.toml", settings=settings, accuracy=accuracy)
    scene = load_scene(EXAMPLES / f"{name}.toml")
    fine = discretise(scene, 4, 16).mesh
    solution = run.solution
    gap = np.linalg.norm(interpolate(fine, _fine(name), solution.u) - solution.position[-1], axis=1).max()
    assert run.reached
    assert gap < accuracy * scene.model.length
    assert run.error["requested"] == accuracy
    assert run.error["estimated"] <= accuracy


def test_more_accuracy_costs_more_and_is_estimated_smaller() -> None:
    """Requests a thousand times stricter, twice."""
    runs = [
        geocosserat.run(EXAMPLES / "cantilever.toml", settings=["run.backend=numpy"], accuracy=accuracy)
        for accuracy in (1e-2, 1e-5, 1e-8)
    ]
    steps = [run.evaluations["steps"] for run in runs]
    estimates = [run.error["estimated"] for run in runs]
    assert steps == sorted(steps)
    assert estimates == sorted(estimates, reverse=True)


def test_an_accuracy_that_refinement_does_not_reach_is_said_not_to_be(monkeypatch: pytest.MonkeyPatch) -> None:
    """The finest rod is returned, with the estimate of its error and the reason."""
    monkeypatch.setattr(search, "SIZES", ((1, 4), (1, 5)))
    monkeypatch.setattr(search, "most_decades", lambda *_: 0.5)
    run = geocosserat.run(EXAMPLES / "cantilever.toml", settings=["run.backend=numpy"])
    assert not run.reached
    assert run.reason == "the accuracy asked for was not reached by refinement"
    assert run.degree == 5
    assert 1e-5 < run.error["estimated"] < 1e-2


@pytest.mark.parametrize("degree", [1, 3, 16, 40])
def test_nodal_values_are_interpolated_as_polynomials(degree: int) -> None:
    """Polynomials of the degree are kept to round-off, anywhere: at nodes, between them, at ends and steps."""
    mesh = make_mesh(2.0, 3, degree, [0.7])
    power = min(degree, 9)
    values = np.stack([mesh.u**power, 1.0 - mesh.u], axis=1)
    u = np.concatenate([[0.0, 0.7, 2.0], mesh.u, np.random.default_rng(0).uniform(0.0, 2.0, 50)])
    expected = np.stack([u**power, 1.0 - u], axis=1)
    np.testing.assert_allclose(interpolate(mesh, values, u), expected, rtol=1e-12, atol=1e-12)


def test_the_gap_is_the_largest_distance_at_the_nodes_of_the_coarse_rod() -> None:
    """A straight rod against one that bulges by a known amount in the middle."""
    coarse, fine = make_mesh(1.0, 2, 2), make_mesh(1.0, 1, 8)
    straight = np.stack([coarse.u, 0.0 * coarse.u], axis=1)
    bulging = np.stack([fine.u, 0.4 * fine.u * (1.0 - fine.u)], axis=1)
    assert position_gap(coarse, straight, fine, bulging) == pytest.approx(0.1, rel=1e-12)
