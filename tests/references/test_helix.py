"""Uniform turns: the exponential against Rodrigues' formula, the differential equation and the geometry."""

import numpy as np
import pytest

from tests.references import chebyshev, helix

PLANAR = (1.1, -0.2, 2.3)
SPATIAL = (1.1, -0.2, 0.3, 1.7, -0.8, 2.1)
BASE = helix.pose((0.3, -0.5, 0.2, 0.4, 1.1, -0.7), [1.0])[0]


@pytest.mark.parametrize("turn", [PLANAR, SPATIAL, (1.0, 0.1, -0.2, 1e-9, 0.0, 2e-9), (1.0, 0.0, 0.0)])
def test_the_exponential_and_rodrigues_formula_agree(turn: tuple[float, ...]) -> None:
    """For large, small and vanishing angles, in the plane and in space."""
    u = np.array([0.0, 1e-7, 0.3, 2.0, 9.0])
    np.testing.assert_allclose(helix.pose(turn, u), helix.closed_pose(turn, u), rtol=0.0, atol=4e-14)


@pytest.mark.parametrize("turn", [PLANAR, SPATIAL])
def test_the_pose_solves_its_differential_equation(turn: tuple[float, ...]) -> None:
    """phi' = phi E, differentiated by Chebyshev collocation."""
    u = chebyshev.points(24, 1.5)
    base = BASE if len(turn) == 6 else None
    poses = helix.pose(turn, u, base)
    slope = np.einsum("ij,jab->iab", chebyshev.derivative(24, 1.5), poses)
    np.testing.assert_allclose(slope, poses @ helix.hat(turn), atol=1e-11)


def test_the_centreline_winds_round_its_axis_with_its_radius_and_pitch() -> None:
    """Every point is one radius from the axis; one turn on is one pitch on, in the same orientation."""
    found = helix.geometry(SPATIAL)
    u = np.linspace(0.0, 5.0, 40)
    from_axis = helix.pose(SPATIAL, u)[:, 1:, 0] - found.point
    across = from_axis - np.outer(from_axis @ found.axis, found.axis)
    np.testing.assert_allclose(np.linalg.norm(across, axis=1), found.radius, rtol=1e-13)
    after = helix.pose(SPATIAL, [2.0 * np.pi / np.linalg.norm(SPATIAL[3:])])[0]
    np.testing.assert_allclose(after[1:, 0], found.pitch * found.axis, atol=1e-13)
    np.testing.assert_allclose(after[1:, 1:], np.eye(3), atol=1e-13)


def test_the_uniform_stress_is_in_balance() -> None:
    """ad*_E Sigma = 0, with ad from matrix commutators: <Sigma, [E, X]> vanishes for every X."""
    stress = helix.uniform_stress(SPATIAL, 0.7, -0.4)
    for x in np.eye(6):
        bracket = helix.hat(SPATIAL) @ helix.hat(x) - helix.hat(x) @ helix.hat(SPATIAL)
        components = [*bracket[1:, 0], bracket[3, 2], bracket[1, 3], bracket[2, 1]]
        assert abs(stress @ components) < 1e-14
