"""All integrators, on stiff problems that are no rods."""

from __future__ import annotations

import numpy as np
import pytest

from geocosserat.solver.integrate import METHODS, integrate
from tests.marks import slow
from tests.solver.problems import (
    ROBERTSON,
    ROBERTSON_END,
    VAN_DER_POL,
    Array,
    constrained,
    diffusion,
    diffusion_mode,
    forced,
    forced_solution,
    robertson,
    van_der_pol,
)

SIZES = (7, 30)
"""One for dense matrices and one for the kernel's own elimination."""
TIMES = np.array([0.5, 0.500001, 0.6, 1.0, 1.7, 3.0])


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("method", METHODS)
def test_variables_that_follow_a_force_are_where_they_should_be(method: str, size: int) -> None:
    """Rates from 1 to a million, uneven instants of output, not from zero: every state is the closed solution."""
    found = integrate(forced(size), np.full(size, 2.0), TIMES, method, 1e-9, 1e-11)
    assert found.reached
    assert found.reason == ""
    np.testing.assert_array_equal(found.times, TIMES)
    np.testing.assert_array_equal(found.states[0], 2.0)
    np.testing.assert_allclose(found.states, forced_solution(size, TIMES, 2.0), atol=1e-6)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("method", METHODS)
def test_variables_under_constraints_are_where_they_should_be(method: str, size: int) -> None:
    """The constraints are solved for in every evaluation: what moves is the closed solution, what is fixed is exact."""
    start = np.concatenate([np.full(size, 2.0), np.full(size, 77.0)])  # what is fixed need not be given
    found = integrate(constrained(size), start, TIMES, method, 1e-9, 1e-11)
    assert found.reached
    np.testing.assert_allclose(found.states[:, :size], forced_solution(size, TIMES, 2.0), atol=1e-6)
    np.testing.assert_allclose(found.states[:, size:] - np.cos(TIMES)[:, None], 0.0, atol=1e-14)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("method", METHODS)
def test_heat_decays_at_its_rate(method: str, size: int) -> None:
    """A slow mode of the diffusion, kept to the tolerance although fast ones are 1e4 times as stiff."""
    shape, rate = diffusion_mode(size, 2)
    times = np.linspace(0.0, 1.0 / rate, 4)
    found = integrate(diffusion(size), shape, times, method, 1e-8, 1e-10)
    np.testing.assert_allclose(found.states, np.exp(-rate * times)[:, None] * shape, atol=2e-6)


@pytest.mark.parametrize("method", METHODS)
def test_robertsons_chemistry_reaches_its_known_state(method: str) -> None:
    """Eleven decades of time; atol of each entry counts, for one is a million times smaller than the next."""
    atol = np.array([1e-16, 1e-22, 1e-12])
    found = integrate(robertson(), np.array([1.0, 0.0, 0.0]), np.array([0.0, ROBERTSON_END]), method, 1e-9, atol)
    np.testing.assert_allclose(found.states[-1], ROBERTSON, rtol=2e-5)


@pytest.mark.parametrize("method", ["cvode", slow("radau"), slow("bdf"), "lsoda"])
def test_van_der_pols_oscillator_reaches_its_known_state(method: str) -> None:
    """With fast jumps on the way."""
    found = integrate(van_der_pol(), np.array([2.0, 0.0]), np.array([0.0, 2.0]), method, 1e-9, 1e-9)
    np.testing.assert_allclose(found.states[-1], VAN_DER_POL, rtol=1e-5)


@pytest.mark.parametrize("method", METHODS)
def test_the_error_follows_the_tolerance(method: str) -> None:
    """Three decades of tolerance give at least two of accuracy, twice over."""
    times = np.array([0.0, 2.0])
    errors = []
    for rtol in (1e-4, 1e-7, 1e-10):
        found = integrate(forced(7), np.zeros(7), times, method, rtol, rtol / 10)
        errors.append(np.abs(found.states[-1] - forced_solution(7, times, 0.0)[-1]).max())
    assert errors[1] < 1e-2 * errors[0]
    assert errors[2] < 1e-2 * errors[1]
    assert errors[2] < 1e-8


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("method", METHODS)
def test_the_solution_does_not_depend_on_how_often_it_is_looked_at(method: str, size: int) -> None:
    """Two instants of output or two hundred: the same end within the tolerance, at the same cost within a quarter."""
    few = integrate(forced(size), np.ones(size), np.array([0.0, 2.0]), method, 1e-8, 1e-10)
    many = integrate(forced(size), np.ones(size), np.linspace(0.0, 2.0, 201), method, 1e-8, 1e-10)
    np.testing.assert_allclose(few.states[-1], many.states[-1], atol=1e-8)
    assert abs(many.rates - few.rates) <= 0.25 * few.rates


@pytest.mark.parametrize("method", [slow("radau"), "bdf", "lsoda"])
def test_a_tolerance_below_round_off_is_taken_without_a_warning(method: str) -> None:
    """As the smallest that the method knows."""
    found = integrate(forced(7), np.zeros(7), np.array([0.0, 0.5]), method, 1e-16, 1e-14)
    assert found.reached


@pytest.mark.parametrize("method", METHODS)
def test_nothing_outside_the_time_span_is_asked_for(method: str) -> None:
    """A load may be undefined after the end of a scene: sqrt(end - t)."""
    problem = forced(7)
    integrate(problem, np.ones(7), np.linspace(0.0, 1.0, 11), method, 1e-6, 1e-8)
    assert min(problem.instants) >= 0.0
    assert max(problem.instants) <= 1.0


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("method", METHODS)
def test_the_exact_jacobian_is_used_and_used_again(method: str, size: int) -> None:
    """Far fewer Jacobians than steps, none of them by differences, and the counts are those of the kernel."""
    problem = forced(size)
    found = integrate(problem, np.ones(size), np.array([0.0, 2.0]), method, 1e-8, 1e-10)
    assert 0 < found.jacobians == problem.jacobians < 0.3 * found.steps
    assert found.steps <= found.rates
    assert len(problem.instants) - 1 <= found.rates <= len(problem.instants)  # but for a look at the start
    assert found.rates < 10 * found.steps


@pytest.mark.parametrize("method", METHODS)
def test_progress_grows_to_one_and_every_frame_is_told(method: str) -> None:
    """Fractions never fall; each instant of output is handed on once, in order, with its state."""
    told: list[tuple[float, int]] = []
    frames: list[tuple[int, Array]] = []
    times = np.linspace(1.0, 2.0, 6)
    found = integrate(
        forced(7), np.ones(7), times, method, progress=lambda *now: told.append(now),
        frame=lambda number, state, _: frames.append((number, state.copy())),
    )  # fmt: skip
    fractions, steps = np.array(told).T
    assert np.all(np.diff(fractions) >= 0)
    assert fractions[-1] == pytest.approx(1.0)
    assert np.all(np.diff(steps) >= 0)
    assert [number for number, _ in frames] == [1, 2, 3, 4, 5]
    np.testing.assert_array_equal([state for _, state in frames], found.states[1:])


def test_the_start_is_left_as_it_was() -> None:
    """Integrators work on copies."""
    for method in METHODS:
        start, times = np.ones(7), np.linspace(0.0, 1.0, 3)
        integrate(forced(7), start, times, method)
        np.testing.assert_array_equal(start, 1.0)
        np.testing.assert_array_equal(times, [0.0, 0.5, 1.0])


def test_an_unknown_method_is_refused_with_the_known_ones() -> None:
    """The message lists them."""
    with pytest.raises(ValueError, match="a method out of cvode, radau, bdf, lsoda, safe, midpoint, found 'euler'"):
        integrate(forced(7), np.ones(7), TIMES, "euler")


def test_a_start_that_is_not_finite_is_refused() -> None:
    """Before anything is integrated."""
    with pytest.raises(ValueError, match="expected a finite initial state, found infinities or NaN"):
        integrate(forced(7), np.array([1.0] * 6 + [np.nan]), TIMES)
