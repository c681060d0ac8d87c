"""The unwrapped direction against the matrix exponential in small steps."""

import math

import numpy as np
import pytest
from scipy.linalg import expm

from tests.references.director import turned

MATRICES = (
    ((0.3, 2.0), (-1.4, 0.5)),  # turns, growing
    ((0.3, -2.0), (1.4, 0.5)),  # turns the other way
    ((1.3, 0.4), (0.7, -0.2)),  # comes to rest
    ((0.0, 1.7), (0.0, 0.0)),  # in between
    ((0.0, 0.0), (-1.7, 0.0)),
    ((2.0, 0.0), (0.0, 2.0)),  # only stretches
)


@pytest.mark.parametrize("matrix", MATRICES)
@pytest.mark.parametrize("angle", [0.0, 0.4, -2.2, 9.0])
def test_the_angle_adds_up_as_the_vector_is_carried_in_small_steps(
    matrix: tuple[tuple[float, float], ...], angle: float
) -> None:
    """exp(t A) times the vector, its turns counted by steps that each turn it by little."""
    step = expm(0.02 * np.array(matrix))
    vector, total = np.array([math.cos(angle), math.sin(angle)]), 0.0
    for n in range(1, 501):
        after = step @ vector
        total += math.atan2(vector[0] * after[1] - vector[1] * after[0], vector @ after)
        vector = after / np.linalg.norm(after)
        if n % 50 == 0:
            assert turned(matrix, angle, 0.02 * n) == pytest.approx(total, abs=1e-12)
