"""The 45 degree bend: published places, and fourteen digits of other programs for a parabola that goes by its name."""

import numpy as np
import pytest

from tests.references.stability import bend45


def test_the_parabola_has_the_fourteen_published_digits() -> None:
    """Shooting agrees with the spectral elements of two programs to 1e-12 of the displacement."""
    found = bend45.parabola(600.0).tip_position - np.array([*bend45.POINTS[-1], 0.0])
    np.testing.assert_allclose(found, bend45.PUBLISHED, atol=5e-12)


def test_the_published_places_are_near_the_two_exact_ones() -> None:
    """With I2 + I3 Simo and Vu-Quoc's to 0.15; with Saint-Venant's Crisfield's to 0.12, Ibrahimbegovic's to 0.01."""
    polar = bend45.solve(600.0, bend45.POLAR).tip_position
    thin = bend45.solve(600.0, bend45.SAINT_VENANT).tip_position
    np.testing.assert_allclose(polar, (47.23, 15.79, 53.37), atol=0.15)
    np.testing.assert_allclose(thin, (46.84, 15.61, 53.71), atol=0.12)
    np.testing.assert_allclose(thin, (46.897, 15.560, 53.605), atol=0.01)
    assert np.abs(polar - thin).max() > 0.25
    sheared = bend45.solve(600.0, bend45.POLAR, 5.0 / 6.0).tip_position
    assert 0.0 < np.abs(sheared - polar).max() < 1e-3


def test_the_force_and_its_moment_are_in_balance() -> None:
    """The moment at the clamp is that of the force at the tip's place, in the world's axes."""
    found = bend45.solve(450.0, bend45.SAINT_VENANT)
    moment = np.cross(found.tip_position, (0.0, 0.0, 450.0))
    np.testing.assert_allclose(found.base_stress, [0.0, 0.0, 450.0, *moment], atol=1e-8)


def test_a_small_force_moves_it_as_the_unit_load_method_says() -> None:
    """Bending and torsion of a quarter ring's half, in closed form; shear beside them."""
    radius, angle = 100.0, 0.25 * np.pi
    bending = 0.5 * (angle - np.sin(angle) * np.cos(angle))  # of sin^2
    torsion = angle - 2.0 * np.sin(angle) + 0.5 * (angle + np.sin(angle) * np.cos(angle))  # of (1 - cos)^2
    expected = radius**3 * (bending / (1e7 / 12.0) + torsion / bend45.SAINT_VENANT) + radius * angle / 5e6
    found = bend45.solve(1e-3, bend45.SAINT_VENANT)
    assert found.tip_position[2] / 1e-3 == pytest.approx(expected, rel=1e-8)
