"""One scheme from second order to spectral: the error against the degree, the elements and the stiffness."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.marks import slow
from tests.physics.scenes import Array, Scene, changed, example, simulate, straight, tip
from tests.references import moving_rod, relaxing_cantilever

CANTILEVER = example("cantilever")
HOOK = "16*u**2*(1-u)**2"
SPATIAL = changed(
    straight([4e3, 1.5e3, 1e3, 0.8, 1.2, 1.0], [1.0, 2.0, 1.8, 0.01, 0.006, 0.008]),
    {
        "rod.reference": [1.0, 0.0, 0.0, 1.0, 0.0, 2.0],
        "start.strain": [1.0, 0.0, 0.0, f"1 + 0.5*{HOOK}", f"-{HOOK}", f"2 - 1.5*{HOOK}"],
        "start.position": [0.1, 0.2, 0.3],
        "start.rotation": [0.3, -0.5, 0.8],
        "ends.right.force": ["3*sin(10*pi*t)**2", "sin(10*pi*t)**2", "-2*sin(10*pi*t)**2"],
        "ends.right.frame": "world",
        "run.until": 0.05,
    },
)
"""All six stiffnesses and frictions differ, a helix at rest, a dead force that comes on gently."""


def _bent(u: Array) -> Array:
    """Integral of the curvature at the start."""
    return 3.0 * u - 3.0 * u**3 + 1.5 * u**4


@cache
def _relaxed() -> Array:
    """Tip of the relaxing cantilever, from the equations in x, y and theta."""
    rod = relaxing_cantilever.Rod(1.0, 1e4, 1.0, 1.0, 1e-2, _bent)
    return relaxing_cantilever.solve(rod, 0.05).position[-1]


@cache
def _drawn() -> Array:
    """Tip of the spatial rod, on a mesh that is fine enough."""
    return tip(simulate(SPATIAL, 3, 16, 1e-12))


def _error(
    scene: Scene, expected: Array, elements: int, degree: int, rtol: float = 1e-12, backend: str = "numpy"
) -> float:
    return float(np.linalg.norm(tip(simulate(scene, elements, degree, rtol, backend)) - expected))


@pytest.mark.parametrize(
    ("degree", "bound"), [(3, 8e-4), (4, 4e-4), (5, 5e-6), (6, 2e-6), (8, 6e-9), (10, 2e-10), (12, 3e-11), (16, 3e-12)]
)
def test_one_element_in_the_plane_converges_with_its_degree(degree: int, bound: float) -> None:
    """To the tip of an independent solution of the coordinate equations, by four digits every four degrees."""
    assert _error(CANTILEVER, _relaxed(), 1, degree) < bound


def test_low_degree_in_the_plane_is_second_order() -> None:
    """16 to 256 elements of degree 1: four times nearer to the same tip for twice as many."""
    errors = [_error(CANTILEVER, _relaxed(), n, 1, 1e-9, "auto") for n in (16, 32, 64, 128, 256)]
    np.testing.assert_allclose(np.log2(errors[:-1]) - np.log2(errors[1:]), 2.0, atol=0.05)
    assert errors[0] < 3e-4
    assert errors[-1] < 1e-6


@pytest.mark.parametrize(("degree", "order"), [(2, 4), slow(3, 6)])
def test_elements_of_degree_p_have_order_2p_at_the_tip(degree: int, order: int) -> None:
    """The nodal order of Gauss collocation."""
    errors = [_error(CANTILEVER, _relaxed(), n, degree) for n in (4, 8, 16)]
    rates = np.log2(errors[:-1]) - np.log2(errors[1:])
    assert np.all(rates > order - 0.5)


@pytest.mark.parametrize(
    ("degree", "bound"), [slow(4, 3e-3), slow(6, 2e-5), (8, 5e-7), slow(10, 2e-8), slow(12, 3e-9), (16, 1e-10)]
)
def test_one_element_in_space_converges_with_its_degree(degree: int, bound: float) -> None:
    """All stiffnesses and frictions different, curled at rest, a dead load that changes."""
    assert _error(SPATIAL, _drawn(), 1, degree) < bound


@pytest.mark.slow
def test_low_degree_in_space_is_second_order() -> None:
    """To the same tip as high degree."""
    errors = [_error(SPATIAL, _drawn(), n, 1, 1e-8, "auto") for n in (16, 32, 64, 128)]
    np.testing.assert_allclose(np.log2(errors[:-1]) - np.log2(errors[1:]), 2.0, atol=0.1)
    assert errors[-1] < 1e-3


@pytest.mark.slow
def test_the_motion_in_space_is_that_of_an_independent_solution() -> None:
    """Positions and quaternions at Chebyshev points, implicit Runge-Kutta in time: no strains, no Lie bracket there."""

    def start(u: float) -> Array:
        hook = 16.0 * u**2 * (1.0 - u) ** 2
        return np.array([1.0, 0.0, 0.0, 1.0 + 0.5 * hook, -hook, 2.0 - 1.5 * hook])

    rod = moving_rod.Rod(
        length=1.0,
        stiffness=np.diag(SPATIAL["rod"]["stiffness"]),
        friction=np.diag(SPATIAL["rod"]["friction"]),
        reference=np.array(SPATIAL["rod"]["reference"]),
        start=start,
        force=lambda t: np.array([3.0, 1.0, -2.0]) * np.sin(10.0 * np.pi * t) ** 2,
        position=SPATIAL["start"]["position"],
        rotation=Rotation.from_rotvec(SPATIAL["start"]["rotation"]).as_matrix(),
    )
    expected = moving_rod.solve(rod, 0.05)
    run = simulate(SPATIAL, 3, 16, 1e-10)
    np.testing.assert_allclose(tip(run), expected.position[-1], atol=5e-9)
    np.testing.assert_allclose(run.tip["rotation"], expected.rotation[-1], atol=5e-9)


@pytest.mark.parametrize(("degree", "bound"), [slow(3, 1e-3), (5, 1e-5), slow(6, 3e-6), slow(8, 3e-8)])
def test_stiff_stretch_and_shear_do_not_lock_the_rod(degree: int, bound: float) -> None:
    """One element: from k = 1e2 to 1e6, with rotational friction 1/k, the error stays what it was, and small."""
    errors = []
    for k in (1e2, 1e4, 1e6):
        scene = changed(CANTILEVER, {"parameters.kappa": k, "rod.friction": [1.0, 1.0, 1.0 / k]})
        reference = relaxing_cantilever.solve(relaxing_cantilever.Rod(1.0, k, 1.0, 1.0, 1.0 / k, _bent), 0.05)
        errors.append(_error(scene, reference.position[-1], 1, degree, 1e-11))
    assert max(errors) < bound
    assert max(errors) < 10 * min(errors)
