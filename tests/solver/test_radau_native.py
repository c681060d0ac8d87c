"""Radau IIA around a compiled problem: the method by its defining laws, the integrator by closed solutions."""

from __future__ import annotations

import resource
import subprocess
from pathlib import Path

import numpy as np
import pytest

from geocosserat.kernel.contract import NativeKernel
from geocosserat.solver import radau_native as module
from geocosserat.solver.integrate import integrate
from geocosserat.solver.radau_native import method, radau_native, stages_for, tableau
from geocosserat.solver.trajectory import Trajectory
from tests.solver.native_problem import NativeConstrained, NativeForced, build
from tests.solver.problems import Array, forced_solution

STAGES = (3, 5, 7)
TIMES = np.array([0.0, 1e-6, 0.1, 0.4, 1.0, 2.0])


@pytest.fixture(scope="module")
def library(c_compiler: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The compiled problem."""
    return build(c_compiler, tmp_path_factory.mktemp("forced"))


def test_the_integrator_compiles_without_a_warning(c_compiler: str, tmp_path: Path) -> None:
    """C99 and the vectors of gcc and clang, -Wall -Wextra -Werror."""
    folder = Path(module.__file__).parent
    (tmp_path / "radau.c").write_text("".join((folder / name).read_text() for name in module.SOURCES))
    check = [c_compiler, "-std=c99", "-Wall", "-Wextra", "-Werror", "-Wno-psabi", "-O1", "-c", "radau.c", "-o", "r.o"]
    done = subprocess.run(check, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[:500]


def test_three_stages_are_the_published_ones() -> None:
    """Abscissae and weights of order 5 in closed form: Hairer and Wanner, table IV.5.6."""
    c, weight = tableau(3)
    root = np.sqrt(6.0)
    np.testing.assert_allclose(c, [(4 - root) / 10, (4 + root) / 10, 1.0], atol=1e-15)
    np.testing.assert_allclose(weight[0], [(88 - 7 * root) / 360, (296 - 169 * root) / 1800, (3 * root - 2) / 225],
                               atol=1e-15)  # fmt: skip
    np.testing.assert_allclose(weight[2], [(16 - root) / 36, (16 + root) / 36, 1 / 9], atol=1e-15)


@pytest.mark.parametrize("stages", STAGES)
def test_stages_are_exact_to_their_order(stages: int) -> None:
    """The last one integrates powers below 2 s - 1, all of them those below s; it stands at the end of the step."""
    c, weight = tableau(stages)
    assert c[-1] == 1.0
    for k in range(2 * stages - 1):
        assert weight[-1] @ c**k == pytest.approx(1 / (k + 1), abs=1e-14)
    assert weight[-1] @ c ** (2 * stages - 1) != pytest.approx(1 / (2 * stages), abs=1e-9)
    for k in range(stages):
        np.testing.assert_allclose(weight @ c**k, c ** (k + 1) / (k + 1), atol=1e-14)


@pytest.mark.parametrize("stages", STAGES)
def test_the_parts_of_newtons_matrix_add_up_to_it(stages: int) -> None:
    """One real eigenvalue and pairs, each counted once, give back the inverse of the weights."""
    m = method(stages)
    parts = np.einsum("ks,k,kr->sr", m["column"], m["value"], m["row"]).real
    np.testing.assert_allclose(parts[:stages, :stages], np.linalg.inv(tableau(stages)[1]), atol=1e-11)
    assert m["value"][0].imag == 0.0


@pytest.mark.parametrize("stages", STAGES)
def test_the_embedded_formula_is_of_lower_order(stages: int) -> None:
    """What it differs by vanishes for powers below s, the rate at the start included, and not for the next one."""
    c, weight = tableau(stages)
    m = method(stages)
    differs = m["error"][:stages] @ weight
    start = 1.0 / m["value"][0].real
    assert differs.sum() == pytest.approx(-start, abs=1e-13)
    for k in range(1, stages):
        assert differs @ c**k == pytest.approx(0.0, abs=1e-13)
    assert abs(differs @ c**stages) > 1e-4 * start


@pytest.mark.parametrize(("rtol", "most"), [(1e-3, 1e-4), (1e-6, 1e-8), (1e-10, 1e-11)])
@pytest.mark.parametrize("size", [1, 7, 30])
def test_a_stiff_problem_is_solved_to_its_tolerance(library: Path, size: int, rtol: float, most: float) -> None:
    """With each number of stages: to the closed solution, at the ends of steps and between them."""
    problem = NativeForced(library, size)
    assert isinstance(problem, NativeKernel)
    found = integrate(problem, np.full(size, 2.0), TIMES, "radau", rtol, rtol)
    assert found.reached
    np.testing.assert_allclose(found.states[-1], forced_solution(size, TIMES, 2.0)[-1], atol=most)
    np.testing.assert_allclose(found.states, forced_solution(size, TIMES, 2.0), atol=10 * rtol)
    assert found.rates == problem.problem.calls
    assert 0 < found.jacobians < found.steps


@pytest.mark.parametrize("rtol", [1e-3, 1e-6, 1e-10])
def test_a_problem_with_constraints_is_solved_to_its_tolerance(library: Path, rtol: float) -> None:
    """What moves to the closed solution, what is fixed to its constraint."""
    size = 7
    problem = NativeConstrained(library, size)
    start = np.concatenate([np.full(size, 2.0), np.full(size, 77.0)])  # what is fixed need not be given
    found = integrate(problem, start, TIMES, "radau", rtol, rtol)
    assert found.reached
    np.testing.assert_allclose(found.states[:, :size], forced_solution(size, TIMES, 2.0), atol=10 * rtol)
    np.testing.assert_allclose(found.states[1:, size:] - np.cos(TIMES[1:])[:, None], 0.0, atol=10 * rtol)


def test_a_jacobian_that_cannot_be_foreseen_is_taken_where_it_is_known(library: Path) -> None:
    """The middle of a step may lie where there is none; the start of the step serves as well."""
    problem = NativeForced(library, 7)
    problem.problem.wrong = 1.3  # else one Jacobian would do for the whole run
    found = integrate(problem, np.full(7, 2.0), TIMES, "radau", 1e-6, 1e-6)
    assert found.reached
    assert found.jacobians > 0.2 * found.steps
    np.testing.assert_allclose(found.states, forced_solution(7, TIMES, 2.0), atol=1e-5)


def test_more_stages_take_fewer_steps(library: Path) -> None:
    """At a tight tolerance; that is what they are for."""

    def steps(stages: int) -> int:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(module, "stages_for", lambda _: stages)
            return integrate(NativeForced(library, 7), np.ones(7), TIMES, "radau", 1e-9, 1e-9).steps

    three, five, seven = map(steps, STAGES)
    assert three > 2 * five > 2 * seven
    assert [stages_for(rtol) for rtol in (1e-1, 1e-3, 1e-7)] == [3, 5, 7]


def test_a_rate_that_cannot_be_evaluated_ends_the_run_there(library: Path) -> None:
    """What was good is kept, and the reason says when."""
    for problem, start in ((NativeForced(library, 7, bad=0.5), 7), (NativeConstrained(library, 7, bad=0.5), 14)):
        found = integrate(problem, np.ones(start), TIMES, "radau", 1e-8, 1e-10)
        assert not found.reached
        assert "Radau stopped at t = 0.5" in found.reason
        assert "the rate is not finite" in found.reason
        np.testing.assert_array_equal(found.times, TIMES[:4])
        assert problem.problem.calls < 20_000


def test_nothing_after_the_end_is_asked_for(library: Path) -> None:
    """A load may be undefined there."""
    problem = NativeForced(library, 7)
    assert integrate(problem, np.ones(7), TIMES, "radau").reached
    assert problem.problem.latest == TIMES[-1]


def test_a_problem_at_rest_takes_few_steps(library: Path) -> None:
    """Where the rate vanishes at the start, the first step is neither lost nor endless; later ones grow."""
    short, long = (
        integrate(NativeForced(library, 3), np.ones(3), np.array([0.0, until]), "radau", 1e-3, 1e-3).steps
        for until in (1e-12, 1.0)
    )
    assert 1 <= short < 10
    assert 1 <= long < 20


def test_large_or_uncompiled_problems_are_left_to_scipy(library: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its matrices are dense as well, but it needs no compiled rate."""
    called = []

    def spy(*arguments: object) -> Trajectory:
        called.append(arguments)
        return radau_native(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr("geocosserat.solver.integrate.radau_native", spy)
    integrate(NativeForced(library, 3), np.ones(3), TIMES, "radau")
    assert len(called) == 1
    monkeypatch.setattr("geocosserat.solver.integrate.LARGEST", 2)
    with pytest.raises(AttributeError, match="jacobian"):  # which scipy asks for
        integrate(NativeForced(library, 3), np.ones(3), TIMES, "radau")
    assert len(called) == 1


def test_frames_and_progress_are_told(library: Path) -> None:
    """Every instant of output once, in order, with the fraction of time done."""
    told: list[float] = []
    frames: list[tuple[int, Array]] = []
    found = integrate(NativeForced(library, 7), np.ones(7), TIMES, "radau",
                      progress=lambda fraction, steps: told.append(fraction),
                      frame=lambda number, state, _: frames.append((number, state.copy())))  # fmt: skip
    assert told == sorted(told)
    assert told[-1] == pytest.approx(1.0)
    assert [number for number, _ in frames] == [1, 2, 3, 4, 5]
    np.testing.assert_array_equal([state for _, state in frames], found.states[1:])


def test_integrations_leave_no_memory_behind(library: Path) -> None:
    """The process is no larger after a thousand more of them."""

    def used() -> int:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    problem, start = NativeForced(library, 30), np.ones(30)
    for _ in range(200):
        integrate(problem, start, TIMES, "radau")
    before = used()
    for _ in range(1000):
        integrate(problem, start, TIMES, "radau")
    assert used() - before < 4000  # kilobytes
