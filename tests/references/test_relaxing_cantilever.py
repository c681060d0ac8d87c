"""The relaxing cantilever: its equations against other forms of them, its time steps against scipy."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.references import axial_twist, cantilever_modes, chebyshev
from tests.references.derivatives import assert_derivatives
from tests.references.relaxing_cantilever import Array, Collocation, Rod, solve


def _bent(u: Array) -> Array:
    """Curvature 3 (1 - u)^2 (1 + 2 u): none at the free end."""
    return 3.0 * u - 3.0 * u**3 + 1.5 * u**4


SOFT = Rod(1.0, 50.0, 1.0, 1.0, 1e-2, _bent)


def test_the_rates_balance_force_and_moment_in_the_world() -> None:
    """friction r_t = n' and friction3 theta_t = k3 theta'' + r' x n, from the coordinates of a stirred rod."""
    rod = Rod(1.3, 40.0, 0.7, 1.5, 0.02, lambda u: np.sin(u) * (1.3 - u) ** 2)
    equations = Collocation(rod, 24)
    u, slope = equations.u, chebyshev.derivative(24, rod.length)
    # a smooth state that obeys the end conditions
    shape = u * (u**2 - 3.0 * rod.length**2)
    state = np.concatenate([(0.05 * shape)[1:-1], (-0.03 * shape)[1:-1], (0.3 * shape + rod.angle(u))[1:-1]])
    now = equations.shape(state)
    inner = slice(1, -1)
    moved = np.concatenate([now.position[inner].T.ravel(), now.angle[inner]])
    np.testing.assert_allclose(equations.moved(state), moved, atol=1e-15)
    tangent = np.stack([np.cos(now.angle), np.sin(now.angle)], axis=1)
    force = rod.k * (slope @ now.position - tangent)
    couple = rod.k3 * slope @ slope @ now.angle + np.linalg.det(np.stack([slope @ now.position, force], axis=1))
    expected = np.concatenate([(slope @ force)[inner].T.ravel() / rod.friction, couple[inner] / rod.friction3])
    np.testing.assert_allclose(equations.residual(0.0, state), expected, atol=1e-9 * np.abs(expected).max())


def test_the_jacobians_are_derivatives() -> None:
    """Against central differences at a bent and stretched state."""
    equations = Collocation(SOFT, 12)
    assert_derivatives(equations, equations.start() + 0.01 * np.sin(np.arange(33.0)), 1e-8)


def test_small_motions_decay_at_the_rates_of_the_linear_theory() -> None:
    """About the straight rod: the bending modes of `cantilever_modes` and the stretch modes of `axial_twist`."""
    rod = Rod(1.3, 50.0, 0.7, 1.5, 0.02, np.zeros_like)
    equations = Collocation(rod, 24)
    mass, jacobian = equations.jacobians(0.0, equations.start())
    rates = -np.linalg.eigvals(np.linalg.solve(mass, jacobian))
    bending = cantilever_modes.decay_rates(cantilever_modes.Rod(1.3, 50.0, 0.7, 1.5, 0.02), 4)
    stretch = axial_twist.decay_rates(50.0, 1.5, 1.3, 4, "clamped-free")
    for expected in (*bending, *stretch):
        nearest = rates[np.abs(rates - expected).argmin()]
        assert abs(nearest - expected) < 1e-9 * expected


def test_scipy_integrates_to_the_same_shape() -> None:
    """scipy's Radau of order 5 with error control, on the same equations in space."""
    equations = Collocation(SOFT, 14)

    def rate(t: float, y: Array) -> Array:
        return np.linalg.solve(equations.jacobians(t, y)[0], equations.residual(t, y))

    found = solve_ivp(rate, (0.0, 0.05), equations.start(), method="Radau", rtol=1e-8, atol=1e-9)
    other = equations.shape(found.y[:, -1])
    shape = solve(SOFT, 0.05, degree=14)
    np.testing.assert_allclose(shape.position, other.position, atol=1e-8)
    np.testing.assert_allclose(shape.angle, other.angle, atol=1e-8)


def test_the_reference_has_converged() -> None:
    """More points and shorter steps change nothing in the stiff rod's tip, to 1e-13."""
    rod = Rod(1.0, 1e4, 1.0, 1.0, 1e-2, _bent)
    coarse, fine = solve(rod, 0.05), solve(rod, 0.05, degree=24, first=1e-8, growth=1.7, longest=1 / 24)
    np.testing.assert_allclose(coarse.position[-1], fine.position[-1], atol=1e-13)
    np.testing.assert_allclose(coarse.position[-1], [0.82507706946494, 0.51831043029012], atol=1e-13)
    assert coarse.angle[-1] == pytest.approx(fine.angle[-1], abs=1e-12)
