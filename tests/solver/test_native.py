"""CVODE calling a compiled problem directly: the same answers as through Python, also when the problem fails."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from geocosserat.kernel.contract import NativeKernel
from geocosserat.solver import integrate as door
from geocosserat.solver.integrate import integrate
from geocosserat.solver.sundials import sundials
from tests.solver.native_problem import NativeConstrained, NativeForced, build
from tests.solver.problems import forced, forced_solution

SIZES = (7, 30)
TIMES = np.array([0.0, 1e-6, 0.1, 0.4, 1.0, 2.0])


@pytest.fixture(scope="module")
def library(c_compiler: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The compiled problem."""
    return build(c_compiler, tmp_path_factory.mktemp("forced"))


@pytest.fixture(autouse=True)
def _needs_sundials() -> None:
    if sundials("CVode") is None or sundials("IDA") is None:
        pytest.skip("the SUNDIALS that came with scikit-sundae cannot be called directly")


@pytest.mark.parametrize("size", SIZES)
def test_a_compiled_problem_is_integrated_without_python(library: Path, size: int) -> None:
    """To the closed solution; its Python rate is called once at most, to look at the start."""
    problem = NativeForced(library, size)
    assert isinstance(problem, NativeKernel)
    found = integrate(problem, np.full(size, 2.0), TIMES, "cvode", 1e-9, 1e-11)
    assert found.reached
    np.testing.assert_allclose(found.states, forced_solution(size, TIMES, 2.0), atol=1e-6)
    assert found.rates == problem.problem.calls
    assert 0 < found.jacobians < 0.3 * found.steps


@pytest.mark.parametrize("size", SIZES)
def test_both_ways_into_cvode_take_about_the_same_steps(library: Path, size: int) -> None:
    """The same method with the same tolerances, though Newton's method and the linear algebra differ."""
    native = integrate(NativeForced(library, size), np.ones(size), TIMES, "cvode", 1e-8, 1e-10)
    python = integrate(forced(size), np.ones(size), TIMES, "cvode", 1e-8, 1e-10)
    np.testing.assert_allclose(native.states, python.states, rtol=0, atol=1e-7)
    assert abs(native.steps - python.steps) <= 0.2 * native.steps


def test_without_the_library_python_takes_over(library: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another generation of SUNDIALS is no error: a kernel without Jacobian in Python would be asked for one."""
    monkeypatch.setattr(door, "sundials", lambda _: None)
    with pytest.raises(AttributeError, match="jacobian"):
        integrate(NativeForced(library, 7), np.ones(7), TIMES)
    assert integrate(forced(7), np.ones(7), TIMES).reached


@pytest.mark.parametrize("size", SIZES)
def test_a_rate_that_cannot_be_evaluated_ends_the_run_there(library: Path, size: int) -> None:
    """Not a hundred thousand steps later: what was good is kept, and the reason says when."""
    problem = NativeForced(library, size, bad=0.5)
    found = integrate(problem, np.ones(size), TIMES, "cvode", 1e-8, 1e-10)
    assert not found.reached
    assert "t = 0.5" in found.reason
    np.testing.assert_array_equal(found.times, TIMES[:4])
    np.testing.assert_allclose(found.states, forced_solution(size, found.times), atol=1e-5)
    assert problem.problem.calls < 20_000


@pytest.mark.parametrize("size", SIZES)
def test_a_rate_that_cannot_be_evaluated_at_the_start_is_said_so(library: Path, size: int) -> None:
    """The start comes back alone."""
    found = integrate(NativeForced(library, size, bad=-1.0), np.ones(size), TIMES)
    assert "not finite at the start" in found.reason
    assert found.times.tolist() == [0.0]


@pytest.mark.parametrize("size", SIZES)
def test_a_compiled_problem_with_constraints_is_integrated_without_python(library: Path, size: int) -> None:
    """By IDA: what moves to the closed solution, what is fixed to its constraint."""
    problem = NativeConstrained(library, size)
    start = np.concatenate([np.full(size, 2.0), np.full(size, 77.0)])  # what is fixed need not be given
    found = integrate(problem, start, TIMES, "cvode", 1e-9, 1e-11)
    assert found.reached
    np.testing.assert_allclose(found.states[:, :size], forced_solution(size, TIMES, 2.0), atol=1e-6)
    np.testing.assert_allclose(found.states[1:, size:] - np.cos(TIMES[1:])[:, None], 0.0, atol=1e-6)
    assert found.rates == problem.problem.calls
    assert 0 < found.jacobians < 0.5 * found.steps


@pytest.mark.parametrize("size", SIZES)
def test_a_constraint_that_cannot_be_evaluated_ends_the_run_there(library: Path, size: int) -> None:
    """What was good is kept, and the reason says when."""
    problem = NativeConstrained(library, size, bad=0.5)
    found = integrate(problem, np.ones(2 * size), TIMES, "cvode", 1e-8, 1e-10)
    assert not found.reached
    assert "IDA stopped at t = 0.5" in found.reason
    np.testing.assert_array_equal(found.times, TIMES[:4])


def test_nothing_after_the_end_is_asked_for(library: Path) -> None:
    """A load may be undefined there."""
    problem = NativeForced(library, 7)
    assert integrate(problem, np.ones(7), TIMES).reached
    assert problem.problem.latest == TIMES[-1]


def test_failing_prints_nothing(
    library: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """SUNDIALS warns on standard output unless it is kept from it."""
    monkeypatch.delenv("SUNLOGGER_WARNING_FILENAME", raising=False)  # the other way into it sets this
    integrate(NativeForced(library, 7, bad=0.5), np.ones(7), TIMES, "cvode", 1e-8, 1e-10)
    assert capfd.readouterr() == ("", "")


def test_progress_is_told_and_frames_are_handed_on(library: Path) -> None:
    """Fractions grow to one; every instant of output comes once."""
    told: list[float] = []
    frames: list[int] = []
    integrate(NativeForced(library, 7), np.ones(7), TIMES, progress=lambda fraction, steps: told.append(fraction),
              frame=lambda number, state, _: frames.append(number))  # fmt: skip
    assert told == sorted(told)
    assert told[-1] == pytest.approx(1.0)
    assert frames == [1, 2, 3, 4, 5]


def test_integrations_leave_no_memory_behind(library: Path) -> None:
    """The process is no larger after a thousand more of them."""
    if "libasan" in os.environ.get("LD_PRELOAD", ""):
        pytest.skip("the sanitiser keeps for a while what was given back, to see that it is not used")

    def used() -> int:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    problem, start = NativeForced(library, SIZES[1]), np.ones(SIZES[1])
    for _ in range(200):
        integrate(problem, start, TIMES)
    before = used()
    for _ in range(1000):
        integrate(problem, start, TIMES)
    assert used() - before < 4000  # kilobytes


def test_names_of_codes_are_given_back_to_whoever_gave_them(c_compiler: str) -> None:
    """Also where the program has another allocator than the C library's, as under a sanitiser: free knows its own."""
    asked = [c_compiler, "-print-file-name=libasan.so"]
    other = subprocess.run(asked, capture_output=True, text=True, check=False).stdout.strip()
    if not Path(other).is_absolute():
        pytest.skip("the compiler has no sanitiser whose allocator could be taken")
    program = (
        "from geocosserat.solver.sundials import sundials; "
        "print(*(sundials(name).meaning(-4) for name in ('CVode', 'IDA') for _ in range(100)))"
    )
    preloaded = {**os.environ, "LD_PRELOAD": other, "ASAN_OPTIONS": "detect_leaks=0"}
    done = subprocess.run([sys.executable, "-c", program], env=preloaded, capture_output=True, text=True, check=False)
    assert (done.stderr, done.returncode) == ("", 0)
    assert done.stdout.split() == ["CV_CONV_FAILURE"] * 100 + ["IDA_CONV_FAIL"] * 100
