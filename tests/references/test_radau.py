"""Radau IIA: its order, its steps, and a system whose mass moves with a constraint."""

import numpy as np
import pytest

from tests.references.radau import Array, instants, integrate, tables


def test_collocation_has_its_order() -> None:
    """Six stages are exact for polynomials of degree 10 at the end and of degree 5 inside; one is backward Euler."""
    nodes, matrix = tables(6)
    for degree in range(6):
        np.testing.assert_allclose(matrix @ nodes**degree, nodes ** (degree + 1) / (degree + 1), atol=1e-14)
    for degree in range(11):
        assert matrix[-1] @ nodes**degree == pytest.approx(1.0 / (degree + 1), abs=1e-14)
    np.testing.assert_allclose(tables(1)[1], [[1.0]])


def test_time_steps_grow_and_end_on_time() -> None:
    """From the first to the longest, none longer, up to the end."""
    ends = instants(2.0, 1e-3, 2.0, 0.3)
    steps = np.diff(ends)
    assert (ends[0], ends[-1]) == (0.0, 2.0)
    assert steps[0] == 1e-3
    assert np.all(steps > 0)
    assert steps.max() <= 0.3


class _Constrained:
    """d (a^3) / dt = 3 a^3 cos t with the constraint b = a^2: a = exp(sin t)."""

    def moved(self, y: Array) -> Array:
        return np.stack([y[..., 0] ** 3, 0.0 * y[..., 1]], axis=-1)

    def residual(self, t: float, y: Array) -> Array:
        a, b = y[..., 0], y[..., 1]
        return np.stack([3.0 * a * b * np.cos(t), b - a**2], axis=-1)

    def jacobians(self, t: float, y: Array) -> tuple[Array, Array]:
        (a, b), c = y, 3.0 * np.cos(t)
        return np.array([[3.0 * a**2, 0.0], [0.0, 0.0]]), np.array([[c * b, c * a], [-2.0 * a, 1.0]])


@pytest.mark.parametrize(("stages", "order"), [(1, 1), (2, 3), (3, 5)])
def test_constrained_systems_are_integrated_at_full_order(stages: int, order: int) -> None:
    """Halving the steps gains 2 stages - 1 powers of two; the constraint holds at the end."""
    exact = np.exp(np.sin(2.0))
    errors = []
    for steps in (20, 40):
        a, b = integrate(_Constrained(), np.array([1.0, 1.0]), np.linspace(0.0, 2.0, steps + 1), stages, 1e-14)
        errors.append(abs(a - exact))
        assert b == pytest.approx(a**2, rel=1e-13)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.5)


def test_too_long_steps_are_refused() -> None:
    """Newton's method says so instead of returning what it has."""
    with np.errstate(all="ignore"), pytest.raises(ArithmeticError, match="expected shorter time steps"):
        integrate(_Constrained(), np.array([1.0, 1.0]), np.array([0.0, 60.0]), 3, 1e-14)
