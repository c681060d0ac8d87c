"""Twisted rods: the equation with cotangents, the determinant, and the classical numbers."""

import math
from typing import Any

import pytest

from tests.references.stability import greenhill, linear
from tests.references.stability.straight import Rod


@pytest.mark.parametrize("tension", [0.0, 0.5, 5.0, 20.0, 60.0, 200.0])
def test_the_equation_with_cotangents_has_the_first_zero_of_the_determinant(tension: float) -> None:
    """The moment at which the rod without stretch and shear buckles, whatever the tension."""
    moment = greenhill.classical(tension)

    def family(m: Any) -> linear.Problem:
        return greenhill.twisted(Rod(), m, tension)

    assert linear.divergence(family, moment * (1.0 + 1e-4)) == pytest.approx(moment, rel=1e-13)
    assert linear.growths(family(0.999 * moment), 1)[0].real < 0.0
    assert linear.growths(family(1.001 * moment), 1)[0].real > 0.0


def test_without_tension_it_is_twice_the_first_solution_of_tan_x_equal_to_x() -> None:
    """8.9868, in units of bend / L."""
    moment = greenhill.classical()
    assert moment == pytest.approx(8.9868, abs=5e-5)
    assert math.tan(0.5 * moment) == pytest.approx(0.5 * moment, rel=1e-13)
    assert greenhill.classical(1e-6) == pytest.approx(moment, rel=1e-6)


def test_under_great_tension_it_is_that_of_the_long_rod() -> None:
    """M1^2 -> 4 bend T from above."""
    ratios = [greenhill.classical(pull) / math.sqrt(4.0 * pull) for pull in (1e2, 1e3, 1e4)]
    assert ratios[0] > ratios[1] > ratios[2] > 1.0
    assert ratios[2] == pytest.approx(1.0, abs=2e-3)


def test_growths_are_real() -> None:
    """The ends being held, the twisted rod has an energy, and friction is symmetric: nothing swings."""
    rod = Rod(1.2, 40.0, 16.0, 0.9, 2.0, 0.02)
    for growth in linear.growths(greenhill.twisted(rod, 8.0, 3.0), 5):
        assert abs(growth.imag) < 1e-8 * abs(growth)
