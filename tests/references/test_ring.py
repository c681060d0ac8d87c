"""The ring's rates against its energy in coordinates, against limits, and against the equations of the group."""

from dataclasses import replace

import numpy as np
import pytest

from tests.references import helix, ring
from tests.references.ring import Array, Ring

RING = Ring(length=2.3, stiffness=(40.0, 25.0, 0.8), friction=(1.0, 1.9, 0.03))


def _rates_from_energy(ring: Ring, points: int = 25) -> Array:
    """All rates, increasing: energy against drag, in coordinates of the world, by Fourier collocation.

    `points` is odd, so that no wave is without a slope. Forces of a perturbed ring are derivatives of its energy, by
    complex steps; their differences are the stiffness.
    """
    u = ring.length * np.arange(points) / points
    wave = np.fft.fftfreq(points, 1.0 / points) * 1j * ring.curvature
    slope = np.fft.ifft(wave[:, None] * np.fft.fft(np.eye(points), axis=0), axis=0).real
    theta = ring.curvature * u
    e1, e2 = np.stack([np.cos(theta), np.sin(theta)]), np.stack([-np.sin(theta), np.cos(theta)])
    place = -e2 / ring.curvature  # r' = e1

    def force(moved: Array) -> Array:
        """The gradient of the energy in the coordinates, which have `moved` from the circle."""
        steps = moved.astype(complex)[None] + 1e-30j * np.eye(3 * points)
        x, y, turn = np.split(steps, 3, axis=1)
        c, s = np.cos(theta + turn), np.sin(theta + turn)
        dx, dy = e1[0] + x @ slope.T, e1[1] + y @ slope.T
        strain = (c * dx + s * dy - 1.0, c * dy - s * dx, turn @ slope.T)
        energy = sum(0.5 * k * e**2 for k, e in zip(ring.stiffness, strain, strict=True)).sum(axis=1)
        return np.asarray(energy.imag / 1e-30)

    step = 1e-4
    hessian = np.stack([(force(step * e) - force(-step * e)) / (2.0 * step) for e in np.eye(3 * points)])
    mobility = np.zeros((3 * points, 3 * points))
    for k in range(points):
        frame = np.zeros((3, 3))
        frame[:2, 0], frame[:2, 1], frame[2, 2] = e1[:, k], e2[:, k], 1.0
        at = [k, points + k, 2 * points + k]
        mobility[np.ix_(at, at)] = frame @ np.diag(1.0 / np.array(ring.friction)) @ frame.T
    assert np.abs(slope @ place.T - e1.T).max() < 1e-12
    return np.sort(np.linalg.eigvals(mobility @ hessian).real)


def test_energy_in_coordinates_gives_the_same_rates_each_twice() -> None:
    """n = 2 to 5, and the four of n = 0 and 1: all rates of the nonlinear ring, linearised by differences."""
    everything = _rates_from_energy(RING)
    for n in range(6):
        for rate in ring.decay_rates(RING, n):
            near = np.sort(np.abs(everything - rate))
            assert near[0] < 1e-6 * rate
            assert n == 0 or near[1] < 1e-6 * rate
    slowest = np.sort([rate for n in range(6) for rate in ring.decay_rates(RING, n) for _ in range(2 if n else 1)])
    np.testing.assert_allclose(everything[3:13], slowest[:10], rtol=1e-6)  # three rigid motions


@pytest.mark.parametrize("n", [0, 1, 2, 5])
def test_a_mode_solves_the_matrix_equations_of_the_rod(n: int) -> None:
    """Compatibility and balance with commutators of matrices, complex amplitudes, to 1e-12."""
    rest = np.array([1.0, 0.0, RING.curvature])

    def bracket(x: Array, y: Array) -> Array:
        product = helix.hat(x) @ helix.hat(y) - helix.hat(y) @ helix.hat(x)
        return np.array([product[1, 0], product[2, 0], product[2, 1]])

    ad = np.stack([bracket(rest, basis) for basis in np.eye(3)], axis=1)
    wave = 1j * n * RING.curvature
    for mode in ring.modes(RING, n):
        size = np.abs(mode.rate * mode.strain).max()
        stress = np.array(RING.stiffness) * mode.strain
        np.testing.assert_allclose(wave * mode.twist + ad @ mode.twist, -mode.rate * mode.strain, atol=1e-12 * size)
        drag = np.array(RING.friction) * mode.twist
        np.testing.assert_allclose(wave * stress - ad.T @ stress, drag, atol=1e-12 * np.abs(drag).max())


def test_a_round_ring_changes_its_size_and_tilts_its_sections_at_known_rates() -> None:
    """n = 0: k1 q^2 / friction2 and k2 (1 / friction3 + q^2 / friction1)."""
    q, (k1, k2, _), (friction1, friction2, friction3) = RING.curvature, RING.stiffness, RING.friction
    expected = sorted([k1 * q**2 / friction2, k2 * (1.0 / friction3 + q**2 / friction1)])
    np.testing.assert_allclose(ring.decay_rates(RING, 0), expected, rtol=1e-13)


@pytest.mark.parametrize("n", [2, 3, 6])
def test_the_stiff_ring_tends_to_the_inextensible_one(n: int) -> None:
    """The slowest rate, with a difference in proportion to 1 / k."""
    differences = []
    for k in (1e5, 1e6):
        stiff = replace(RING, stiffness=(k, 2.0 * k, 0.8))
        differences.append(ring.decay_rates(stiff, n)[0] / ring.inextensible_rate(stiff, n) - 1.0)
    assert differences[0] / differences[1] == pytest.approx(10.0, rel=2e-2)
    assert abs(differences[1]) < 1e-3
