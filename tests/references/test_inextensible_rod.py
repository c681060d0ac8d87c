"""The inextensible rod in motion: its tension, its linear rates, its rest, its energy, and the limit of stiff rods."""

import math

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import solve_ivp

from tests.marks import slow
from tests.references import elastica, euler_bernoulli, relaxing_cantilever
from tests.references.inextensible_rod import Array, Collocation, Rod, solve

FORCE, WEIGHT = (0.5, -2.0), (1.0, -3.0)


def _bent(u: Array) -> Array:
    """Curvature 3 (1 - u)^2 (1 + 2 u): neither it nor its slope at the free end."""
    return 3.0 * u - 3.0 * u**3 + 1.5 * u**4


# curvature 300 u^4 (1 - u)^5: the clamp would not move and the tip not bend, so there is no layer at the start
GENTLE = 300.0 * Polynomial([0.0, 1.0]) ** 4 * Polynomial([1.0, -1.0]) ** 5
_gentle = GENTLE.integ()


def _loaded(friction3: float, force: tuple[float, float] = FORCE, weight: tuple[float, float] = WEIGHT) -> Rod:
    return Rod(1.0, 1.0, 1.0, 2.0, friction3, _bent, lambda t: force, weight)


def test_the_velocities_are_those_of_the_tension_equation_in_the_body() -> None:
    """friction3 = 0: F2 = -k3 theta'', and F1 from v1' = theta' v2, solved in components of the moving frame."""
    end = float(_gentle(1.0))
    # F2 = 0 at the tip of this start, so the force there may only be along it
    rod = Rod(1.0, 1.3, 0.8, 2.0, 0.0, _gentle, lambda t: (0.7 * math.cos(end), 0.7 * math.sin(end)), (1.5, 0.0))
    equations = Collocation(rod, 30)
    spin, force = equations.motion(0.0, equations.begin)
    u, d = equations.u, equations.slope
    theta = _gentle(u)
    c, s, bend = np.cos(theta), np.sin(theta), np.diag(GENTLE(u))
    f2 = -rod.k3 * GENTLE.deriv()(u)
    # v1 = (F1' - theta' F2 + w1) / friction1, v2 = (F2' + theta' F1 + w2) / friction2
    first = (d / rod.friction1, (1.5 * c - bend @ f2) / rod.friction1)
    second = (bend / rod.friction2, (d @ f2 - 1.5 * s) / rod.friction2)
    matrix, right = d @ first[0] - bend @ second[0], bend @ second[1] - d @ first[1]
    matrix[0], right[0] = first[0][0], -first[1][0]  # the clamp does not move along
    matrix[-1], right[-1] = np.eye(31)[-1], 0.7
    tension = np.linalg.solve(matrix, right)
    v1, v2 = first[0] @ tension + first[1], second[0] @ tension + second[1]
    np.testing.assert_allclose(c * force[0] + s * force[1], tension, atol=5e-9)
    np.testing.assert_allclose(c * force[1] - s * force[0], f2, atol=5e-9)
    np.testing.assert_allclose(spin, d @ v2 + bend @ v1, atol=5e-7 * np.abs(spin).max())


@pytest.mark.parametrize("friction3", [0.0, 0.3])
def test_small_motions_decay_at_the_rates_of_the_linear_theory(friction3: float) -> None:
    """About the straight rod: Euler and Bernoulli's characteristic equation, clamped-free, with rotary drag."""
    equations = Collocation(Rod(1.3, 0.9, 0.4, 0.7, friction3, np.zeros_like), 24)
    rates = -np.linalg.eigvals(equations.jacobians(0.0, equations.begin)[1][:-2, :-2])
    for expected in euler_bernoulli.decay_rates(1.3, 0.9, 0.7, friction3, "clamped-free", 4):
        assert np.abs(rates - expected).min() < 1e-9 * expected


def test_a_dead_force_leads_to_the_elastica() -> None:
    """Long after: the tip of the inextensible elastica, by elliptic functions, to 1e-11."""
    exact = elastica.elliptic(elastica.Cantilever(1.0, math.inf, 1.0, FORCE), [1.0])
    found = solve(_loaded(0.01, weight=(0.0, 0.0)), 6.0, longest=1 / 10)
    np.testing.assert_allclose(found.position[-1], exact.position[0], atol=1e-11)
    assert found.angle[-1] == pytest.approx(exact.angle[0], abs=1e-11)


@pytest.mark.slow
def test_stiff_rods_tend_to_it() -> None:
    """Equal frictions: the stretching, shearing rod of `relaxing_cantilever` for k to infinity, extrapolated."""
    tips = [
        relaxing_cantilever.solve(relaxing_cantilever.Rod(1.0, k, 1.0, 1.0, 1e-2, _bent), 0.05).position[-1]
        for k in (1e5, 2e5, 4e5)
    ]
    once = [2.0 * tips[1] - tips[0], 2.0 * tips[2] - tips[1]]
    expected = (4.0 * once[1] - once[0]) / 3.0
    found = solve(Rod(1.0, 1.0, 1.0, 1.0, 1e-2, _bent), 0.05).position[-1]
    assert np.abs(tips[0] - found).max() > 1e-6
    np.testing.assert_allclose(found, expected, atol=1e-10)


@pytest.mark.parametrize("friction3", [0.0, slow(0.01)])
def test_energy_is_dissipated_or_was_given(friction3: float) -> None:
    """Stored + dissipated - work stays what it was: to 2e-9 for a smooth start, 1e-8 for a sudden load."""
    stored = 0.5 * float(((3.0 * Polynomial([1.0, 0.0, -3.0, 2.0])) ** 2).integ()(1.0))
    sudden = solve(_loaded(friction3), 0.05, degree=28, first=1e-8, longest=1 / 30)
    assert sudden.energy + sudden.dissipated - sudden.work == pytest.approx(stored, abs=1e-8)
    assert sudden.work > 0.5
    smooth = solve(Rod(1.0, 1.0, 0.6, 2.0, friction3, _gentle), 0.05, degree=28)
    assert smooth.energy + smooth.dissipated == pytest.approx(0.5 * float((GENTLE**2).integ()(1.0)), abs=2e-9)
    assert smooth.dissipated > 0.03


@pytest.mark.parametrize("friction3", [0.0, 0.01])
def test_scipy_integrates_to_the_same_shape(friction3: float) -> None:
    """scipy's Radau of order 5 with error control, on the same equations in space."""
    equations = Collocation(_loaded(friction3), 12)
    found = solve_ivp(
        equations.residual, (0.0, 0.05), equations.begin, method="Radau", rtol=1e-8, atol=1e-10,
        jac=lambda t, y: equations.jacobians(t, y)[1],
    )  # fmt: skip
    other, shape = equations.shape(found.y[:, -1]), solve(_loaded(friction3), 0.05, degree=12)
    np.testing.assert_allclose(shape.position, other.position, atol=1e-9)
    np.testing.assert_allclose(shape.angle, other.angle, atol=1e-8)


CONVERGED = (
    (0.0, (0.0, 0.0), (0.0, 0.0), (0.70290611701798, 0.64701141010223)),
    slow(0.0, FORCE, WEIGHT, (0.86767237165963, 0.46101781246989)),
    slow(0.01, FORCE, (0.0, 0.0), (0.80294881083059, 0.55199572999611)),
    (0.01, FORCE, WEIGHT, (0.85950762982808, 0.47251126283027)),
)


@pytest.mark.parametrize(("friction3", "force", "weight", "tip"), CONVERGED)
def test_the_reference_has_converged(
    friction3: float, force: tuple[float, float], weight: tuple[float, float], tip: tuple[float, float]
) -> None:
    """More points and shorter steps change nothing in the tip, to 1e-12; unequal frictions, all loads."""
    rod = _loaded(friction3, force, weight)
    fine = solve(rod, 0.05, degree=30, first=1e-8, growth=1.6, longest=1 / 30)
    np.testing.assert_allclose(solve(rod, 0.05).position[-1], fine.position[-1], atol=1e-12)
    np.testing.assert_allclose(fine.position[-1], tip, atol=1e-12)
