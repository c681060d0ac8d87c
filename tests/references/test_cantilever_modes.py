"""The rates of the clamped-free planar rod, by collocation, by limits and by the matrix equations."""

import math

import numpy as np
import pytest

from tests.references import cantilever_modes, chebyshev
from tests.references.cantilever_modes import Array, Rod

RODS = (
    Rod(length=1.0, k2=1e4, k3=1.0, friction2=1.0, friction3=0.01),  # nearly without shear
    Rod(length=1.3, k2=5.0, k3=1.1, friction2=0.7, friction3=0.4),
    Rod(length=1.0, k2=1.0, k3=1.0, friction2=1.0, friction3=1.0),  # rates in close pairs
    Rod(length=2.0, k2=30.0, k3=3.0, friction2=1.0, friction3=1e-3),
)
EULER_BERNOULLI = Rod(length=1.7, k2=math.inf, k3=2.0, friction2=0.6, friction3=0.0)


def _collocated_rates(rod: Rod, degree: int = 40) -> Array:
    """Resolved rates, increasing: 1 / the eigenvalues of the inverse (integral) operator on (F2, M).

    Integrating from the clamp and back from the free end builds the boundary conditions in, and keeps full
    relative accuracy for the slow rates, which differentiation matrices do not.
    """
    from_clamp = chebyshev.integral(degree, rod.length, 0)
    from_free = chebyshev.integral(degree, rod.length, -1)
    zero = np.zeros_like(from_clamp)
    turning = np.hstack([zero, -from_clamp / rod.k3])  # Omega / rate
    sliding = from_clamp @ turning - np.hstack([from_clamp / rod.k2, zero])  # v2 / rate
    force = rod.friction2 * from_free @ sliding
    moment = from_free @ (rod.friction3 * turning - force)
    inverse = np.linalg.eigvals(np.vstack([force, moment]))
    inverse = inverse[np.abs(inverse.imag) < 1e-9 * np.abs(inverse).max()].real
    return np.sort(1.0 / inverse[inverse > 1e-7 * inverse.max()])


@pytest.mark.parametrize("rod", RODS)
def test_rates_agree_with_a_collocated_eigenproblem_to_twelve_digits(rod: Rod) -> None:
    """The zeros of the determinant are the eigenvalues found by Chebyshev collocation."""
    rates = cantilever_modes.decay_rates(rod, 4)
    np.testing.assert_allclose(rates, _collocated_rates(rod)[:4], rtol=1e-12)


def test_without_shear_and_rotary_friction_the_roots_are_those_of_euler_and_bernoulli() -> None:
    """cos(beta) cosh(beta) = -1; the first two to all printed digits of the tables."""
    rates = cantilever_modes.decay_rates(EULER_BERNOULLI, 4)
    scale = EULER_BERNOULLI.k3 / (EULER_BERNOULLI.friction2 * EULER_BERNOULLI.length**4)
    beta = (rates / scale) ** 0.25
    np.testing.assert_allclose(beta[:2], [1.875104068711961, 4.694091132974175], rtol=1e-14)
    np.testing.assert_allclose(np.cos(beta) + 1.0 / np.cosh(beta), 0.0, atol=1e-14)


def test_the_full_rod_tends_to_euler_and_bernoulli_in_proportion_to_shear_and_rotary_friction() -> None:
    """Ten times less shear or rotary friction gives a tenth of the difference of the first rate."""
    limit = cantilever_modes.decay_rates(Rod(1.0, math.inf, 1.0, 1.0, 0.0), 1)[0]
    for compliance, rotary in ((1e-4, 0.0), (0.0, 1e-4)):
        differences = [
            cantilever_modes.decay_rates(
                Rod(1.0, 1.0 / (q * compliance) if compliance else math.inf, 1.0, 1.0, q * rotary), 1
            )[0]
            - limit
            for q in (1.0, 0.1)
        ]
        assert differences[0] / differences[1] == pytest.approx(10.0, rel=5e-3)
        assert differences[0] < 0.0


def test_the_count_of_rates_below_a_trial_is_exact() -> None:
    """For random coefficients the focal points counted equal the collocated rates below the trial."""
    generator = np.random.default_rng(20240607)
    for _ in range(25):
        k2, k3, friction2, friction3, length = np.exp(generator.normal(0.0, 1.2, 5))
        rod = Rod(length=length, k2=k2, k3=k3, friction2=friction2, friction3=friction3)
        rates = np.concatenate([[0.0], _collocated_rates(rod)])
        below = int(generator.integers(0, 12))
        trial = 0.5 * (rates[below] + rates[below + 1])
        assert cantilever_modes.count_below(rod, (trial / rod.rate(1.0)) ** 0.25) == below


@pytest.mark.parametrize("index", [0, 2])
def test_a_mode_solves_the_matrix_equations_of_the_rod(index: int) -> None:
    """Compatibility and balance, built from matrix commutators alone, hold to first order for each mode."""
    rod = RODS[1]
    u = chebyshev.points(24, rod.length)
    found = cantilever_modes.mode(rod, index, u)
    slope = chebyshev.derivative(24, rod.length)

    def hat(x: Array) -> Array:
        return np.array([[0.0, 0.0, 0.0], [x[0], 0.0, -x[2]], [x[1], x[2], 0.0]])

    def bracket(x: Array, y: Array) -> Array:
        product = hat(x) @ hat(y) - hat(y) @ hat(x)
        return np.array([product[1, 0], product[2, 0], product[2, 1]])

    rest = np.array([1.0, 0.0, 0.0])
    ad = np.stack([bracket(rest, basis) for basis in np.eye(3)], axis=1)
    stress = found.strain * np.array([7.0, rod.k2, rod.k3])  # k1 plays no part: h1 stays 1
    drag = found.velocity * np.array([3.0, rod.friction2, rod.friction3])
    strain_rate = slope @ found.velocity + found.velocity @ ad.T
    scale = np.abs(drag).max()
    np.testing.assert_allclose(strain_rate, -found.rate * found.strain, atol=1e-9 * found.rate)
    np.testing.assert_allclose(slope @ stress - stress @ ad, drag, atol=1e-9 * scale)  # ad* = -ad^T
    np.testing.assert_allclose(found.velocity[0], 0.0, atol=1e-13 * scale)
    np.testing.assert_allclose(stress[-1], 0.0, atol=1e-13 * scale)
    assert found.strain[0, 2] == pytest.approx(1.0, rel=1e-13)
