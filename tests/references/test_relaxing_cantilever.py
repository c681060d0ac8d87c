"""The relaxing cantilever: its equations against other forms of them, its time steps against scipy."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.references import axial_twist, cantilever_modes, chebyshev
from tests.references.relaxing_cantilever import Array, Collocation, Rod, instants, radau, solve


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
    rate = equations.rate(state)
    step = 1e-4 / np.abs(rate).max()
    before, after = (equations.shape(state + change * rate) for change in (-step, step))
    velocity = (after.position - before.position) / (2.0 * step)
    spin = (after.angle - before.angle) / (2.0 * step)
    now = equations.shape(state)
    tangent = np.stack([np.cos(now.angle), np.sin(now.angle)], axis=1)
    force = rod.k * (slope @ now.position - tangent)
    couple = np.linalg.det(np.stack([slope @ now.position, force], axis=1))
    inner = slice(1, -1)
    scale = 1e-7 * np.abs(rate).max()
    np.testing.assert_allclose(rod.friction * velocity[inner], (slope @ force)[inner], atol=scale)
    turning = rod.k3 * slope @ slope @ now.angle + couple
    np.testing.assert_allclose(rod.friction3 * spin[inner], turning[inner], atol=scale * rod.friction3)


def test_the_jacobian_is_the_derivative_of_the_rate() -> None:
    """Against central differences at a bent and stretched state."""
    equations = Collocation(SOFT, 12)
    state = equations.start() + 0.01 * np.sin(np.arange(33.0))
    step = 1e-6 * np.eye(33)
    differences = [(equations.rate(state + e) - equations.rate(state - e)) / 2e-6 for e in step]
    jacobian = equations.jacobian(state)
    np.testing.assert_allclose(jacobian, np.stack(differences, axis=1), atol=1e-8 * np.abs(jacobian).max())


def test_small_motions_decay_at_the_rates_of_the_linear_theory() -> None:
    """About the straight rod: the bending modes of `cantilever_modes` and the stretch modes of `axial_twist`."""
    rod = Rod(1.3, 50.0, 0.7, 1.5, 0.02, np.zeros_like)
    equations = Collocation(rod, 24)
    rates = -np.linalg.eigvals(equations.jacobian(equations.start()))
    bending = cantilever_modes.decay_rates(cantilever_modes.Rod(1.3, 50.0, 0.7, 1.5, 0.02), 4)
    stretch = axial_twist.decay_rates(50.0, 1.5, 1.3, 4, "clamped-free")
    for expected in (*bending, *stretch):
        nearest = rates[np.abs(rates - expected).argmin()]
        assert abs(nearest - expected) < 1e-9 * expected


def test_radau_collocation_has_its_order() -> None:
    """Six stages are exact for polynomials of degree 10 at the end and of degree 5 inside; one is backward Euler."""
    nodes, matrix = radau(6)
    for degree in range(6):
        np.testing.assert_allclose(matrix @ nodes**degree, nodes ** (degree + 1) / (degree + 1), atol=1e-14)
    for degree in range(11):
        assert matrix[-1] @ nodes**degree == pytest.approx(1.0 / (degree + 1), abs=1e-14)
    np.testing.assert_allclose(radau(1)[1], [[1.0]])


def test_time_steps_grow_and_end_on_time() -> None:
    """From the first to the longest, none longer, up to the end."""
    ends = instants(2.0, 1e-3, 2.0, 0.3)
    steps = np.diff(ends)
    assert (ends[0], ends[-1]) == (0.0, 2.0)
    assert steps[0] == 1e-3
    assert np.all(steps > 0)
    assert steps.max() <= 0.3


def test_scipy_integrates_to_the_same_shape() -> None:
    """scipy's Radau of order 5 with error control, on the same equations in space."""
    equations = Collocation(SOFT, 14)
    found = solve_ivp(
        lambda t, y: equations.rate(y),
        (0.0, 0.05),
        equations.start(),
        method="Radau",
        jac=lambda t, y: equations.jacobian(y),
        rtol=1e-8,
        atol=1e-9,
    )
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


def test_too_long_steps_are_refused() -> None:
    """Newton's method says so instead of returning what it has."""
    with pytest.raises(ArithmeticError, match="expected shorter time steps"):
        solve(Rod(1.0, 1e4, 1.0, 1.0, 1e-2, lambda u: 8.0 * u), 50.0, first=1.0, longest=1.0)
