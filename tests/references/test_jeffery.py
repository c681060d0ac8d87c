"""Jeffery's orbits against the drag added up along the rod, against his formula, and the balance of each section."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.references import chebyshev, jeffery
from tests.references.jeffery import Array, Rod

FLOWS = (
    ((0.0, 1.7), (0.0, 0.0)),  # simple shear
    ((0.9, 0.0), (0.0, -0.9)),  # extension
    ((0.0, -1.1), (1.1, 0.0)),  # rotation
    ((0.3, 2.0), (-0.4, 0.5)),  # turns for ever, with a divergence
    ((0.3, 2.0), (0.7, 0.5)),  # comes to rest
)
ROD = Rod(length=1.4, friction1=1.0, friction2=2.1, friction3=0.06, gradient=FLOWS[0], velocity=(0.2, -0.1))


def _rate(rod: Rod, state: Array) -> Array:
    """(X_t, theta_t) from no total force and torque, by Gauss quadrature of the drag along the rod."""
    node, weight = np.polynomial.legendre.leggauss(4)
    s, weight = 0.5 * rod.length * node, 0.5 * rod.length * weight
    rotation = np.stack(jeffery.frame(state[2]), axis=1)
    friction = rotation @ np.diag([rod.friction1, rod.friction2]) @ rotation.T

    def total(rates: Array) -> Array:
        places = state[:2] + s[:, None] * rotation[:, 0]
        slip = np.asarray(rod.velocity) + places @ rod.flow.T - rates[:2] - rates[2] * s[:, None] * rotation[:, 1]
        force = slip @ friction
        torque = s * (rotation[0, 0] * force[:, 1] - rotation[1, 0] * force[:, 0])
        couple = rod.friction3 * (0.5 * (rod.flow[1, 0] - rod.flow[0, 1]) - rates[2])
        return np.array([*(weight @ force), weight @ (torque + couple)])

    nothing = total(np.zeros(3))
    return np.linalg.solve(np.stack([nothing - total(e) for e in np.eye(3)], axis=1), nothing)


@pytest.mark.parametrize("gradient", FLOWS)
def test_the_orbit_has_no_force_and_no_torque_in_all(gradient: tuple[tuple[float, float], ...]) -> None:
    """Integrated numerically from the drag on each piece; the angle counts turns, the middle goes with the flow."""
    rod = replace(ROD, gradient=gradient)
    until = 4.0 if np.linalg.det(np.array(gradient) - 0.5 * np.trace(gradient) * np.eye(2)) < 0.0 else 9.0
    times = np.linspace(0.0, until, 7)
    start = np.array([0.3, 0.5, 0.8])
    found = solve_ivp(
        lambda _, y: _rate(rod, y), (0.0, until), start, t_eval=times, method="DOP853", rtol=1e-11, atol=1e-11
    )
    for t, expected in zip(times, found.y.T, strict=True):
        assert jeffery.angle(rod, 0.8, t) == pytest.approx(expected[2], abs=1e-9)
        np.testing.assert_allclose(jeffery.centre(rod, start[:2], t), expected[:2], rtol=1e-9, atol=1e-9)
    ends = jeffery.position(rod, [0.0, rod.length], start[:2], 0.8, until)
    tangent = rod.length * np.array([np.cos(found.y[2, -1]), np.sin(found.y[2, -1])])
    np.testing.assert_allclose(ends[1] - ends[0], tangent, atol=1e-8)


@pytest.mark.parametrize("shear", [1.7, -1.7])
def test_in_a_shear_it_is_jefferys_formula(shear: float) -> None:
    """tan(theta) = c tan(phase), through several turns, and one turn in the known period."""
    rod = replace(ROD, gradient=((0.0, shear), (0.0, 0.0)))
    for t in np.linspace(0.0, 60.0, 37):
        assert jeffery.angle(rod, 2.0, t) == pytest.approx(jeffery.angle_in_shear(rod, 2.0, t), abs=1e-11)
    turn = jeffery.angle(rod, 2.0, jeffery.period_in_shear(rod)) - 2.0
    assert turn == pytest.approx(-math.copysign(2.0 * math.pi, shear), abs=1e-12)


def test_a_thin_rod_without_rotary_friction_is_a_material_line() -> None:
    """friction3 = 0: B = 1 and e_1 is carried like a line drawn into the fluid."""
    rod = replace(ROD, friction3=0.0, gradient=FLOWS[3])
    far = jeffery.centre(rod, [0.3 + 1e-3 * math.cos(0.8), 0.5 + 1e-3 * math.sin(0.8)], 0.9)
    line = far - jeffery.centre(rod, [0.3, 0.5], 0.9)
    assert math.remainder(jeffery.angle(rod, 0.8, 0.9) - math.atan2(line[1], line[0]), 2.0 * math.pi) < 1e-11
    assert math.remainder(jeffery.angle(rod, 0.8, 0.9) - math.atan2(line[1], line[0]), 2.0 * math.pi) > -1e-11


@pytest.mark.parametrize("gradient", FLOWS)
def test_the_stress_balances_the_drag_on_every_section(gradient: tuple[tuple[float, float], ...]) -> None:
    """F' + f = 0 and M' + F2 + m = 0 with the drag of the rigid motion, nothing carried at the ends."""
    rod = replace(ROD, gradient=gradient)
    u, slope = chebyshev.points(8, rod.length), chebyshev.derivative(8, rod.length)
    theta = 0.8
    e1, e2 = jeffery.frame(theta)
    rates = _rate(rod, np.array([0.3, 0.5, theta]))
    s = u - 0.5 * rod.length
    places = np.array([0.3, 0.5]) + s[:, None] * e1
    slip = np.asarray(rod.velocity) + places @ rod.flow.T - rates[:2] - rates[2] * s[:, None] * e2
    f1, f2, moment = jeffery.stress(rod, u, theta).T
    np.testing.assert_allclose(slope @ f1 + rod.friction1 * slip @ e1, 0.0, atol=1e-12)
    np.testing.assert_allclose(slope @ f2 + rod.friction2 * slip @ e2, 0.0, atol=1e-12)
    np.testing.assert_allclose(slope @ moment + f2 + rod.friction3 * (rod.vorticity - rates[2]), 0.0, atol=1e-12)
    np.testing.assert_allclose(jeffery.stress(rod, [0.0, rod.length], theta), 0.0, atol=1e-15)
