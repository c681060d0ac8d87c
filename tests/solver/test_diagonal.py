"""The methods of last resort: right, of their order, strict about energies, and hard to bring down."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocosserat.solver import diagonal
from geocosserat.solver.diagonal import GAMMAS, Stepper
from geocosserat.solver.integrate import LAST_RESORTS, integrate
from tests.solver.problems import (
    Array,
    Problem,
    constrained,
    diffusion,
    diffusion_mode,
    forced,
    forced_solution,
    van_der_pol,
)

TIMES = np.array([0.5, 0.500001, 0.6, 1.0, 2.0])
STIFFNESS = np.array([1.0, 10.0, 1e3, 1e6])


def _slope(y: Array) -> Array:
    return STIFFNESS * y


def _mobility(y: Array) -> Array:
    """Symmetric and positive, by any state."""
    B = np.eye(4) + 0.2 * np.outer(np.sin(y), np.cos(y[::-1]))
    return B @ B.T


def flow() -> Problem:
    """y' = -G(y) grad V for V = y K y / 2, and what that dissipates as the last entry."""

    def f(t: float, y: Array) -> Array:
        velocity = -_mobility(y[:4]) @ _slope(y[:4])
        return np.append(velocity, -_slope(y[:4]) @ velocity)

    def J(t: float, y: Array) -> Array:
        steps = 1e-30 * np.eye(5)  # by complex steps: exact
        return np.column_stack([f(t, y + 1j * step).imag / 1e-30 for step in steps])

    return Problem(5, f, J, quadratures=1)


def _stored(y: Array) -> float:
    return float(0.5 * y[:4] @ _slope(y[:4]))


def _stepper(method: str, problem: Problem, y: Array) -> Stepper:
    stepper = Stepper(problem, GAMMAS[method], 0.0, y, 1e-6, np.full(len(y), 1e-6))
    stepper.linearise(0.0, y)
    return stepper


START = np.array([1.0, -0.5, 0.03, 1e-4, 0.0])
STEPS = [(START, h) for h in (1e-9, 1e-6, 1e-4, 1e-2)] + [(1e-2 * START, h) for h in (1.0, 1e4)]


@pytest.mark.parametrize(("start", "h"), STEPS)
def test_the_safe_method_makes_no_energy_whatever_the_step(start: Array, h: float) -> None:
    """Stored and dissipated together do not grow in a step, and the stored energy falls; strictly, to round-off."""
    end = _stepper("safe", flow(), start).end(h)
    before, after = _stored(start), _stored(end)
    assert after <= before * (1 + 1e-14)
    assert after + end[4] <= before * (1 + 1e-13)


@pytest.mark.parametrize(("start", "h"), STEPS)
def test_the_balance_of_the_midpoint_rule_closes_whatever_the_step(start: Array, h: float) -> None:
    """What is stored less is what was dissipated, to round-off."""
    end = _stepper("midpoint", flow(), start).end(h)
    assert _stored(end) + end[4] == pytest.approx(_stored(start), rel=1e-12)


def test_the_midpoint_rule_does_not_damp_and_the_safe_method_does() -> None:
    """One step a million times too long leaves all of a mode, or next to nothing of it."""
    problem = Problem(1, lambda t, y: -1e6 * y, lambda t, y: np.array([[-1e6]]))
    left = {method: float(_stepper(method, problem, np.ones(1)).end(1.0)[0]) for method in LAST_RESORTS}
    assert left["midpoint"] == pytest.approx(1.0, rel=1e-4)
    assert abs(left["safe"]) < 1e-4


@pytest.mark.parametrize("method", LAST_RESORTS)
def test_both_are_of_second_order(method: str) -> None:
    """Half the step, a quarter of the error."""
    problem = Problem(
        2, lambda t, y: np.array([y[1], -np.sin(y[0])]), lambda t, y: np.array([[0, 1], [-np.cos(y[0]), 0]])
    )
    errors = []
    for steps in (20, 40, 2000):
        stepper = _stepper(method, problem, np.array([1.0, 0.0]))
        for _ in range(steps):
            stepper.y = stepper.end(1.0 / steps)
        errors.append(stepper.y)
    coarse, fine = (np.abs(y - errors[-1]).max() for y in errors[:2])
    assert 3.6 < coarse / fine < 4.4


@pytest.mark.parametrize("method", LAST_RESORTS)
def test_variables_that_follow_a_force_are_where_they_should_be(method: str) -> None:
    """Rates from 1 to a million, uneven instants of output, not from zero: every state is the closed solution."""
    found = integrate(forced(7), np.full(7, 2.0), TIMES, method, 1e-5, 1e-6)
    assert found.reached
    np.testing.assert_array_equal(found.times, TIMES)
    np.testing.assert_allclose(found.states, forced_solution(7, TIMES, 2.0), atol=3e-4)


@pytest.mark.parametrize("method", LAST_RESORTS)
def test_variables_under_constraints_are_where_they_should_be(method: str) -> None:
    """What moves is the closed solution, what is fixed is exact though not given."""
    start = np.concatenate([np.full(7, 2.0), np.full(7, 77.0)])
    found = integrate(constrained(7), start, TIMES, method, 1e-5, 1e-6)
    assert found.reached
    np.testing.assert_allclose(found.states[:, :7], forced_solution(7, TIMES, 2.0), atol=3e-4)
    np.testing.assert_allclose(found.states[:, 7:] - np.cos(TIMES)[:, None], 0.0, atol=1e-13)


@pytest.mark.parametrize("method", LAST_RESORTS)
def test_heat_decays_at_its_rate(method: str) -> None:
    """A slow mode of the diffusion, kept to the tolerance although fast ones are 1e4 times as stiff."""
    shape, rate = diffusion_mode(30, 2)
    times = np.linspace(0.0, 1.0 / rate, 4)
    found = integrate(diffusion(30), shape, times, method, 1e-7, 1e-8)
    np.testing.assert_allclose(found.states, np.exp(-rate * times)[:, None] * shape, atol=2e-6)


def test_fast_jumps_are_followed() -> None:
    """Van der Pol's oscillator at its known state, across jumps."""
    found = integrate(van_der_pol(1e3), np.array([2.0, 0.0]), np.array([0.0, 1.5]), "safe", 1e-5, 1e-6)
    exact = integrate(van_der_pol(1e3), np.array([2.0, 0.0]), np.array([0.0, 1.5]), "lsoda", 1e-10, 1e-10)
    assert found.reached
    np.testing.assert_allclose(found.states[-1], exact.states[-1], rtol=1e-2)


@pytest.mark.parametrize("method", LAST_RESORTS)
def test_the_error_follows_the_tolerance(method: str) -> None:
    """Three decades of tolerance give at least one and a half of accuracy."""
    times = np.array([0.0, 2.0])
    exact = forced_solution(7, times, 0.0)[-1]
    errors = [
        np.abs(integrate(forced(7), np.zeros(7), times, method, rtol, rtol).states[-1] - exact).max()
        for rtol in (1e-3, 1e-6)
    ]
    assert errors[1] < 0.03 * errors[0]


@pytest.mark.parametrize("method", LAST_RESORTS)
def test_a_rate_that_becomes_nan_ends_the_run_there(method: str) -> None:
    """With a reason, soon, and what was before it is right."""

    def f(t: float, y: Array) -> Array:
        return forced(7).f(t, y) * (np.nan if t > 1.0 else 1.0)

    found = integrate(replace(forced(7), f=f), np.ones(7), TIMES, method, 1e-5, 1e-6)
    assert not found.reached
    assert "no step is short enough" in found.reason
    np.testing.assert_array_equal(found.times, TIMES[:4])
    assert np.isfinite(found.states).all()
    assert found.rates < 20_000


@pytest.mark.filterwarnings("ignore:overflow:RuntimeWarning")
@pytest.mark.parametrize("method", LAST_RESORTS)
def test_a_solution_that_grows_without_bound_ends_the_run(method: str) -> None:
    """y' = y^2 from 1 is 1 / (1 - t): it is left before 1, with a reason."""
    problem = Problem(3, lambda t, y: y**2, lambda t, y: np.diag(2 * y))
    found = integrate(problem, np.ones(3), np.linspace(0.0, 2.0, 21), method, 1e-5, 1e-6)
    assert not found.reached
    assert found.reason
    assert found.times[-1] == pytest.approx(0.9)
    np.testing.assert_allclose(found.states[-1], 10.0, rtol=1e-2)


@pytest.mark.parametrize("method", LAST_RESORTS)
def test_a_run_that_gets_nowhere_is_given_up(method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the pace of its steps: an oscillation that would take a hundred million."""
    monkeypatch.setattr(diagonal, "SOON", 200)
    turning = 1e6 * np.array([[0.0, 1.0], [-1.0, 0.0]])
    fast = Problem(2, lambda t, y: turning @ y, lambda t, y: turning)
    found = integrate(fast, np.array([1.0, 0.0]), np.array([0.0, 1e3]), method, 1e-4, 1e-4)
    assert not found.reached
    assert "did not reach the end" in found.reason
    assert found.steps < 1000


@pytest.mark.parametrize("error", [RuntimeError("a bug"), KeyboardInterrupt()])
def test_an_error_inside_a_kernel_comes_out_as_it_is(error: BaseException) -> None:
    """A bug, or a user's Ctrl-C, is never taken for numerical trouble."""

    def f(t: float, y: Array) -> Array:
        if t > 0.55:
            raise error
        return forced(7).f(t, y)

    with pytest.raises(type(error)):
        integrate(replace(forced(7), f=f), np.ones(7), TIMES, "safe", 1e-4, 1e-5)
