"""Self-buckling: Greenhill's number by Bessel functions and by series, and energy bounds."""

import math

import numpy as np
import pytest

from tests.references.stability import heavy, linear
from tests.references.stability.straight import Rod


def test_greenhills_number_comes_from_bessel_functions_and_from_the_series() -> None:
    """q L^3 / k3 = 7.8373, Greenhill's, to 14 digits either way and at any scale."""
    number = heavy.classical()
    assert number == pytest.approx(7.8373, abs=5e-5)
    rod = Rod(length=1.7, bend=0.6)
    found = linear.divergence(lambda q: heavy.standing(rod, q), 1.01 * number * 0.6 / 1.7**3)
    assert found == pytest.approx(number * 0.6 / 1.7**3, rel=1e-14)


def test_a_trial_shape_bounds_the_weight_from_above() -> None:
    """Rayleigh's quotient of theta = sin(pi u / 2 L), k3 theta'^2 against -T eta theta^2, is a little above."""
    rod = Rod(1.0, 40.0, 16.0)
    found = linear.divergence(lambda q: heavy.standing(rod, q), 7.0)
    u = (np.arange(4000) + 0.5) / 4000
    theta, slope = np.sin(0.5 * math.pi * u), 0.5 * math.pi * np.cos(0.5 * math.pi * u)

    def excess(q: float) -> float:
        load = q * (1.0 - u)
        return float(np.mean(slope**2 - load * (1.0 - load / rod.k1 + load / rod.k2) * theta**2))

    assert excess(found) > 0.0
    assert excess(1.1 * found) < 0.0
