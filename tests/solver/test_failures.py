"""Kernels that fail: every integrator stops in time, says why, keeps what was good, and never hands on NaN."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from geocosserat.solver import settings
from geocosserat.solver.integrate import METHODS, integrate
from geocosserat.solver.trajectory import Trajectory
from tests.solver.problems import Array, Problem, forced, forced_solution

SIZES = (7, 30)
TIMES = np.linspace(0.0, 2.0, 21)
BAD = 0.5
"""Until this instant all is well."""


def _run(problem: Problem, method: str, start: float = 1.0) -> Trajectory:
    return integrate(problem, np.full(problem.size, start), TIMES, method, 1e-7, 1e-9)


def _stopped(found: Trajectory, method: str) -> None:
    """A reason, times and states up to the last good instant of output, all finite."""
    assert not found.reached
    assert found.reason
    assert "\n" not in found.reason
    assert len(found.times) == len(found.states)
    np.testing.assert_array_equal(found.times, TIMES[: len(found.times)])
    assert np.all(np.isfinite(found.states)), f"{method} handed on values that are not finite"


def _after(problem: Problem, value: float, entry: slice) -> Problem:
    """The rate of some entries is `value` after BAD."""

    def f(t: float, y: Array) -> Array:
        rate = problem.f(t, y)
        if t > BAD:
            rate[entry] = value
        return rate

    return replace(problem, f=f)


@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")  # in the kernel's own arithmetic
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("value", "entry"), [(np.nan, slice(None)), (np.inf, slice(None)), (np.nan, slice(0, 1))])
def test_a_rate_that_becomes_nan_ends_the_run_there(method: str, size: int, value: float, entry: slice) -> None:
    """In all entries or in one: the run stops close to that instant and what was before it is right."""
    found = _run(_after(forced(size), value, entry), method)
    _stopped(found, method)
    assert BAD - 0.11 < found.times[-1] <= BAD
    np.testing.assert_allclose(found.states, forced_solution(size, found.times), atol=1e-4)
    assert found.rates < 20_000


@pytest.mark.filterwarnings("ignore:overflow:RuntimeWarning")
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("method", METHODS)
def test_a_solution_that_grows_without_bound_ends_the_run(method: str, size: int) -> None:
    """y' = y^2 from 1 is 1 / (1 - t): it is followed to t = 0.9 at least, and no further than 1."""
    found = _run(Problem(size, lambda t, y: y**2, lambda t, y: np.diag(2 * y)), method)
    _stopped(found, method)
    assert 0.89 < found.times[-1] < 1.01
    before = found.times < 0.95
    np.testing.assert_allclose(found.states[before, 0], 1 / (1 - found.times[before]), rtol=1e-4)
    assert found.rates < 50_000


@pytest.mark.parametrize("method", METHODS)
def test_a_rate_that_is_nan_from_the_start_is_said_to_be(method: str) -> None:
    """Only the start itself is returned."""
    found = _run(Problem(7, lambda t, y: y * np.nan, lambda t, y: -np.eye(7)), method)
    _stopped(found, method)
    assert "not finite at the start" in found.reason
    np.testing.assert_array_equal(found.states, np.ones((1, 7)))


@pytest.mark.parametrize("method", METHODS)
def test_a_jacobian_that_is_not_finite_ends_the_run(method: str) -> None:
    """With a reason instead of an error from some linear algebra."""
    _stopped(_run(replace(forced(7), J=lambda t, y: np.full((7, 7), np.nan)), method), method)


@pytest.mark.parametrize("method", METHODS)
def test_a_jacobian_that_cannot_be_formed_ends_the_run(method: str) -> None:
    """LinAlgError counts as numerical trouble, and its words are the reason."""

    def J(t: float, y: Array) -> Array:
        raise np.linalg.LinAlgError("block 3 is singular")

    found = _run(replace(forced(7), J=J), method)
    _stopped(found, method)
    assert "block 3 is singular" in found.reason


class _Balky(Problem):
    """Its elimination fails, or gives NaN, but for a few times."""

    nan = False
    fail: Callable[[float], bool] = staticmethod(lambda gamma: False)

    def factor(self, gamma: float) -> None:
        if self.fail(gamma):
            raise np.linalg.LinAlgError("the linear system of element 0 is singular")
        super().factor(gamma)

    def solve(self, b: Array, out: Array) -> None:
        super().solve(b, out)
        if self.nan:
            out[:] = np.nan


def _balky() -> _Balky:
    healthy = forced(SIZES[1])
    return _Balky(healthy.size, healthy.f, healthy.J)


def test_an_elimination_that_fails_for_large_steps_costs_only_steps() -> None:
    """CVODE is told to try a smaller step, and gets to the end."""
    problem = _balky()
    problem.fail = lambda gamma: gamma > 0.01
    found = _run(problem, "cvode")
    assert found.reached
    np.testing.assert_allclose(found.states, forced_solution(SIZES[1], TIMES), atol=1e-4)


@pytest.mark.parametrize("nan", [True, False])
def test_an_elimination_that_always_fails_does_no_harm(nan: bool) -> None:
    """CVODE then does without: the run ends, at the right values or with a reason."""
    problem = _balky()
    problem.nan, problem.fail = nan, lambda gamma: not nan
    found = _run(problem, "cvode")
    if not found.reached:
        _stopped(found, "cvode")
    np.testing.assert_allclose(found.states, forced_solution(SIZES[1], found.times), atol=1e-4)


@pytest.mark.parametrize("error", [RuntimeError("a bug"), KeyboardInterrupt()])
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("method", METHODS)
def test_an_error_inside_a_kernel_comes_out_as_it_is(method: str, size: int, error: BaseException) -> None:
    """A bug, or a user's Ctrl-C, is never taken for numerical trouble."""
    healthy = forced(size)

    def f(t: float, y: Array) -> Array:
        if t > BAD:
            raise error
        return healthy.f(t, y)

    with pytest.raises(type(error)):
        _run(replace(healthy, f=f), method)


@pytest.mark.parametrize("method", METHODS)
def test_failing_prints_nothing(method: str, capfd: pytest.CaptureFixture[str]) -> None:
    """Standard output belongs to results and standard error to the one message: libraries below must keep quiet."""
    _run(_after(forced(7), np.nan, slice(None)), method)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("method", METHODS)
def test_a_run_may_take_long_if_it_gets_on_but_not_for_ever(method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """After so many steps it goes on as long as at this pace all of it takes no more than the longest may."""
    monkeypatch.setattr(settings, "STEP_LIMIT", 600)
    for longest, reached in ((10**6, True), (1000, False)):
        monkeypatch.setattr(settings, "LONGEST", longest)
        found = integrate(forced(7), np.ones(7), np.array([0.0, 200.0]), method, 1e-7, 1e-9)
        assert found.reached == reached
        assert found.steps > (1000 if reached else 599)
        assert reached or "steps did not reach the end" in found.reason
