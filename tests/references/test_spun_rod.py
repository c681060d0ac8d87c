"""The spun rod against the exponential of its collocated equation, and its account of energy."""

import numpy as np
import pytest
from scipy.linalg import expm

from tests.references import chebyshev, spun_rod
from tests.references.spun_rod import Array, Rod

ROD = Rod(length=1.6, stiffness4=0.9, friction4=0.7, spin=-60.0)
DEGREE = 40
U, SLOPE = chebyshev.points(DEGREE, ROD.length), chebyshev.derivative(DEGREE, ROD.length)


def _collocated(t: float) -> Array:
    """psi at the points: the base is driven, the tip has no slope; unknowns (inner psi, psi of the base, 1)."""
    fill = np.zeros((DEGREE + 1, DEGREE + 1))
    fill[1:-1, :-2], fill[0, -2] = np.eye(DEGREE - 1), 1.0
    fill[-1] = -SLOPE[-1, :-1] @ fill[:-1] / SLOPE[-1, -1]
    rate = np.zeros((DEGREE + 1, DEGREE + 1))
    rate[:-2] = (ROD.stiffness4 / ROD.friction4 * SLOPE @ SLOPE @ fill)[1:-1]
    rate[-2, -1] = ROD.spin
    return np.asarray(fill @ (expm(rate * t) @ np.eye(DEGREE + 1)[-1]))


@pytest.mark.parametrize("t", [0.02, 0.3, 2.0])
def test_the_angle_is_what_the_matrix_exponential_says(t: float) -> None:
    """Early, in between and late, to 1e-11 of the largest angle, twist being its slope."""
    expected = _collocated(t)
    angle = spun_rod.angle(ROD, U, t)
    np.testing.assert_allclose(angle, expected, atol=1e-11 * np.abs(expected).max())
    np.testing.assert_allclose(spun_rod.twist(ROD, U, t), SLOPE @ angle, atol=1e-9 * np.abs(expected).max())


def test_in_the_end_each_section_carries_the_drag_of_those_beyond() -> None:
    """stiffness4 Pi1' = friction4 spin, none at the tip; the tip lags by ten turns; the series tends to it."""
    steady = spun_rod.steady_twist(ROD, U)
    np.testing.assert_allclose(ROD.stiffness4 * SLOPE @ steady, ROD.friction4 * ROD.spin, rtol=1e-11)
    np.testing.assert_allclose(SLOPE @ spun_rod.steady_lag(ROD, U), steady, atol=1e-10)
    assert steady[-1] == 0.0
    assert abs(spun_rod.steady_lag(ROD, [ROD.length])[0]) > 9.0 * 2.0 * np.pi
    np.testing.assert_allclose(spun_rod.twist(ROD, U, 60.0), steady, atol=1e-12)
    assert spun_rod.base_torque(ROD, 60.0) == pytest.approx(spun_rod.steady_torque(ROD), rel=1e-13)
    assert spun_rod.steady_torque(ROD) == pytest.approx(-ROD.stiffness4 * steady[0], rel=1e-15)


def test_what_the_base_spends_is_stored_or_dissipated() -> None:
    """At t = 0.3: torque times spin, integrated in time, and energy and drag by quadrature."""
    node, weight = np.polynomial.legendre.leggauss(60)
    end = 0.3
    # times from 0 by a power, since the torque starts like 1 / sqrt(t)
    share, at = 0.5 * (node + 1.0), 0.5 * ROD.length * (node + 1.0)
    times, dt = end * share**4, end * 4.0 * share**3 * 0.5 * weight
    number = 4000
    spent = sum(h * ROD.spin * spun_rod.base_torque(ROD, t, number) for t, h in zip(times, dt, strict=True))
    assert spun_rod.work_of_base(ROD, end, number) == pytest.approx(spent, rel=1e-6)
    wave, rate = ROD.waves(number), ROD.rates(number)
    energy = 0.5 * ROD.stiffness4 * 0.5 * ROD.length * weight @ spun_rod.twist(ROD, at, end) ** 2
    # psi_t = spin - spin sum 2 / (L q) sin(q u) exp(-rate t): its square over the rod, over the time, by Parseval
    share_of = 2.0 / (ROD.length * wave)
    gone = -np.expm1(-rate * end) / rate
    drag = ROD.length * end - 2.0 * np.sum(share_of / wave * gone)
    drag += 0.5 * ROD.length * np.sum(share_of**2 * -np.expm1(-2.0 * rate * end) / (2.0 * rate))
    dissipated = ROD.friction4 * ROD.spin**2 * drag
    assert spun_rod.work_of_base(ROD, end, number) == pytest.approx(energy + dissipated, rel=1e-9)


def test_the_stored_energy_is_that_of_the_steady_twist() -> None:
    """By quadrature."""
    node, weight = np.polynomial.legendre.leggauss(8)
    steady = spun_rod.steady_twist(ROD, 0.5 * ROD.length * (node + 1.0))
    expected = 0.5 * ROD.stiffness4 * 0.5 * ROD.length * weight @ steady**2
    assert spun_rod.stored_energy(ROD) == pytest.approx(expected, rel=1e-14)
