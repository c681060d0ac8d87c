"""The made-up solutions of these tests are motions of a rod, so that what is drawn and balanced from them is right."""

from __future__ import annotations

import numpy as np
import pytest

from geocosserat.results.curves import smooth
from geocosserat.results.solution import Solution
from tests.results.motions import rolling, unrolling, unwinding

MOTIONS = [make(frames=4001, degree=20) for make in (rolling, unrolling, unwinding)]


def _hat(solution: Solution, components: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Translation and rotation matrix of elements of the Lie algebra."""
    group = solution.group
    matrices = group.hat(components)
    return matrices[..., 1:, 0], matrices[..., 1:, 1:]


@pytest.mark.parametrize("solution", MOTIONS, ids=lambda s: s.title)
def test_the_twist_of_a_made_up_motion_is_the_velocity_of_its_configuration(solution: Solution) -> None:
    """dr/dt = R v and dR/dt = R Omega^, by central differences."""
    v, omega = _hat(solution, solution.twist)
    for path, rate in ((solution.position[..., None], v[..., None]), (solution.rotation, omega)):
        expected = (solution.rotation @ rate)[1:-1]
        found = (path[2:] - path[:-2]) / (solution.time[2:] - solution.time[:-2])[:, None, None, None]
        np.testing.assert_allclose(found, expected, atol=1e-4 * np.abs(expected).max())


@pytest.mark.parametrize("solution", MOTIONS, ids=lambda s: s.title)
def test_the_turn_of_a_made_up_motion_is_the_derivative_along_the_rod(solution: Solution) -> None:
    """dr/du = R h at the middle of the smooth curves, by central differences."""
    places, positions = smooth(solution, solution.position[::400], pieces=4000)
    _, turns = smooth(solution, solution.turn[::400], pieces=4000)
    size = solution.group.space
    frames = solution.rotation[::400].reshape(-1, solution.u.size, size * size)
    _, rotations = smooth(solution, frames, pieces=4000)
    middle = np.arange(200, 1800)
    slopes = (positions[:, middle + 1] - positions[:, middle - 1]) / (
        places[middle + 1] - places[middle - 1])[:, None]
    rotations = rotations[:, middle].reshape(len(frames), len(middle), size, size)
    expected = (rotations @ turns[:, middle, :size, None])[..., 0]
    np.testing.assert_allclose(slopes, expected, atol=1e-4)
