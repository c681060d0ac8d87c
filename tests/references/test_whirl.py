"""The onset of whirling: the published number, shooting, and the equations of the group in the turning frame."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.references import chebyshev, helix, linear_rod, whirl
from tests.references.whirl import Complex, Rod, growths, threshold

PLAIN = Rod(length=1.0, k2=math.inf, bend=1.0, friction2=1.0, friction4=1.0, friction5=0.0, spin=0.0)
THICK = Rod(length=1.3, k2=30.0, bend=1.2, friction2=0.7, friction4=0.02, friction5=0.05, spin=250.0)


def test_the_threshold_is_the_published_one() -> None:
    """8.9 bend / (friction4 L^2), whatever the other coefficients, for the rod without shear and rotary drag."""
    spin, _ = threshold(PLAIN)
    assert spin == pytest.approx(8.9, abs=0.05)
    scaled, _ = threshold(Rod(1.7, math.inf, 0.6, 2.1, 0.03, 0.0, 0.0))
    assert scaled == pytest.approx(spin * 0.6 / (0.03 * 1.7**2), rel=1e-10)


@pytest.mark.parametrize("rod", [PLAIN, THICK])
def test_at_the_threshold_shooting_finds_a_growth_without_real_part(rod: Rod) -> None:
    """The zero of the determinant, by integration along the rod, is i times the whirling velocity: to 1e-10."""
    spin, velocity = threshold(rod)
    found = whirl.refined(replace(rod, spin=spin), 1.001j * velocity)
    assert abs(found - 1j * velocity) < 1e-10 * velocity


@pytest.mark.parametrize("rod", [replace(PLAIN, friction5=0.3), THICK])
def test_without_spin_the_growths_are_the_rates_of_the_planar_rod(rod: Rod) -> None:
    """Decay of the clamped-free rod in either plane."""
    planar = linear_rod.Rod(rod.length, rod.k2, rod.bend, rod.friction2, rod.friction5)
    expected = linear_rod.decay_rates(planar, "clamped", "free", 3)
    found = growths(replace(rod, spin=0.0), 3)
    np.testing.assert_allclose(found, -expected, rtol=1e-10)


def _in_the_turning_frame(rod: Rod, degree: int = 24) -> Complex:
    """Growths from E_t = V' + [E, V] and Gamma V = Sigma' + ad*_E Sigma in the body, brackets by commutators."""
    slope = chebyshev.derivative(degree, rod.length)
    u = chebyshev.points(degree, rod.length)
    basis = [helix.hat(x) for x in np.eye(6)]
    structure = np.zeros((6, 6, 6))
    for a, left in enumerate(basis):
        for b, right in enumerate(basis):
            m = left @ right - right @ left
            structure[a, b] = [*m[1:, 0], m[3, 2], m[1, 3], m[2, 1]]
    stiffness = np.array([50.0, rod.k2, rod.k2, 0.8, rod.bend, rod.bend])
    friction = np.array([0.5, rod.friction2, rod.friction2, rod.friction4, rod.friction5, rod.friction5])
    rest = np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    steady = np.tile(rest, (degree + 1, 1))
    steady[:, 3] = rod.moment(u) / stiffness[3]

    def rate(inner: Complex) -> Complex:
        turn = np.concatenate([inner.reshape(degree, 6), rest[None]])  # no stress at the tip
        stress = stiffness * (turn - rest)
        coadjoint = -np.einsum("ua,abc,uc->ub", turn, structure, stress)
        velocity = (slope @ stress + coadjoint) / friction
        velocity[0] = [0.0, 0.0, 0.0, rod.spin, 0.0, 0.0]
        return (slope @ velocity + np.einsum("ua,ub,abc->uc", turn, velocity, structure))[:-1].ravel()

    state = steady[:-1].ravel()
    assert np.abs(rate(state)).max() < 1e-7 * abs(rod.spin)
    jacobian = np.stack([rate(state + 1e-30j * e).imag / 1e-30 for e in np.eye(len(state))], axis=1)
    return np.asarray(np.linalg.eigvals(jacobian))


@pytest.mark.parametrize("spin", [250.0, -400.0])
def test_the_equations_of_the_group_have_the_same_growths_in_the_turning_frame(spin: float) -> None:
    """growth - i spin and its conjugate are eigenvalues of the linearised Lie-algebra form."""
    rod = replace(THICK, spin=spin)
    everything = _in_the_turning_frame(rod)
    for growth in growths(rod, 3):
        for wanted in (growth - 1j * spin, (growth - 1j * spin).conjugate()):
            assert np.abs(everything - wanted).min() < 1e-8 * abs(wanted)
