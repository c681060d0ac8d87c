"""The rotor against numerical integration, and the stress it carries against the balances of the rod."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.references import chebyshev, magnetic_rotor
from tests.references.magnetic_rotor import Rotor

ROTOR = Rotor(length=1.4, friction2=2.1, friction3=0.03, torque=0.9, spin=1.0, phase=0.4)
CRITICAL = ROTOR.critical


@pytest.mark.parametrize("spin", [0.3, -0.8, 1.0, 1.05, -3.0])
@pytest.mark.parametrize("start", [0.0, 2.9, -7.0])
def test_the_angle_solves_the_balance_of_torque(spin: float, start: float) -> None:
    """Below, at and above the critical spin, either way round; the angle counts turns."""
    rotor = replace(ROTOR, spin=spin * CRITICAL)
    until = 40.0 / CRITICAL
    times = np.linspace(0.0, until, 9)

    def rate(t: float, theta: list[float]) -> float:
        return rotor.torque * rotor.length * math.sin(rotor.spin * t + rotor.phase - theta[0]) / rotor.drag

    found = solve_ivp(rate, (0.0, until), [start], t_eval=times, method="DOP853", rtol=1e-12, atol=1e-13)
    exact = [magnetic_rotor.angle(rotor, start, t) for t in times]
    np.testing.assert_allclose(exact, found.y[0], atol=1e-9)


def test_the_rod_that_follows_lags_by_the_sine_of_the_spin() -> None:
    """After a long time; the torque of the field is then the drag; beyond the critical spin it is refused."""
    rotor = replace(ROTOR, spin=0.7 * CRITICAL)
    late = 40.0 / CRITICAL
    delta = rotor.spin * late + rotor.phase - magnetic_rotor.angle(rotor, 1.0, late)
    assert delta == pytest.approx(magnetic_rotor.lag(rotor), abs=1e-11)
    assert rotor.torque * rotor.length * math.sin(delta) == pytest.approx(rotor.drag * rotor.spin, rel=1e-10)
    assert magnetic_rotor.mean_velocity(rotor) == rotor.spin
    with pytest.raises(ValueError, match="expected a spin of at most"):
        magnetic_rotor.lag(replace(rotor, spin=-1.01 * CRITICAL))


@pytest.mark.parametrize("share", [1.1, -4.0])
def test_the_rod_that_slips_advances_by_the_mean_velocity(share: float) -> None:
    """Over one period of slipping it loses exactly one turn; the advance is that period times the mean velocity."""
    rotor = replace(ROTOR, spin=share * CRITICAL)
    period = magnetic_rotor.slip_period(rotor)
    begin, end = (magnetic_rotor.angle(rotor, 0.2, t) for t in (0.7, 0.7 + period))
    assert end - begin == pytest.approx(magnetic_rotor.mean_velocity(rotor) * period, abs=1e-11)
    assert rotor.spin * period - (end - begin) == pytest.approx(math.copysign(2.0 * math.pi, share), abs=1e-11)


@pytest.mark.parametrize("about", ["middle", "end"])
def test_the_stress_balances_drag_and_field_section_by_section(about: str) -> None:
    """F2' = friction2 v2, M' + F2 = friction3 Omega - couple; free ends, and no moment at a pin."""
    rotor = replace(ROTOR, about=about)
    u, slope = chebyshev.points(8, rotor.length), chebyshev.derivative(8, rotor.length)
    delta = 0.9
    turning = magnetic_rotor.angle(replace(rotor, phase=delta), 0.0, 1e-7) / 1e-7
    f1, f2, moment = magnetic_rotor.stress(rotor, u, delta).T
    arm = u - (0.5 * rotor.length if about == "middle" else 0.0)
    np.testing.assert_allclose(f1, 0.0)
    np.testing.assert_allclose(slope @ f2, rotor.friction2 * turning * arm, atol=1e-6)
    expected = rotor.friction3 * turning - rotor.torque * math.sin(delta)
    np.testing.assert_allclose(slope @ moment + f2, expected, atol=1e-6)
    np.testing.assert_allclose([f2[-1], moment[0], moment[-1]], 0.0, atol=1e-14)
    assert abs(f2[0]) == pytest.approx(0.0, abs=1e-14) if about == "middle" else abs(f2[0]) > 0.1
