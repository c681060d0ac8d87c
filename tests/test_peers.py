"""The solvers that this project is timed against are right: their errors fall with their order."""

import numpy as np
import pytest

from benchmarks.peers import by_hand, lines, ours, statics
from benchmarks.peers.problems import planar, reference_error, spatial
from benchmarks.peers.search import Found, Solver, extrapolated
from benchmarks.peers.writing import plain, table

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("c_compiler")]
PROBLEMS = pytest.mark.parametrize("problem", [planar(1e4), spatial()], ids=lambda p: p.motion)


def orders(errors):
    """Orders of convergence of errors on grids that are halved."""
    return np.log2(np.divide(errors[:-1], errors[1:]))


@PROBLEMS
def test_the_reference_is_converged(problem):
    assert reference_error(problem) < 1e-11


@PROBLEMS
def test_ours_is_spectral(problem):
    errors = [ours.solve(problem, 1, degree, "radau", 1e-10)[0] for degree in (4, 8)]
    assert errors[1] < errors[0] / 1000


@PROBLEMS
def test_by_hand_is_of_second_order_in_space(problem):
    errors = [by_hand.solve(problem, cells, 1e-9)[0] for cells in (16, 32, 64, 128)]
    assert orders(errors) == pytest.approx(2.0, abs=0.15)


@PROBLEMS
def test_by_hand_is_of_fourth_order_in_time(problem):
    exact, _, _ = by_hand.run(problem, 16, 1e-12)
    runs = [by_hand.run(problem, 16, rtol) for rtol in (1e-6, 1e-9)]
    coarse, fine = (np.abs(strains - exact).max() for strains, _, _ in runs)
    assert np.log(coarse / fine) / np.log(runs[1][2] / runs[0][2]) == pytest.approx(4.0, abs=0.8)


@PROBLEMS
@pytest.mark.parametrize("method", lines.METHODS)
def test_lines_are_of_second_order(problem, method):
    errors = [lines.solve(problem, cells, method, 1e-7)[0] for cells in (8, 16, 32)]
    assert orders(errors)[-1] == pytest.approx(2.0, abs=0.2)


@PROBLEMS
class TestCompiledLines:
    @pytest.fixture(autouse=True)
    def _module(self):
        pytest.importorskip("numba", reason="numba is in the extra `bench`")
        from benchmarks.peers import compiled_lines

        self.compiled = compiled_lines

    def state(self, problem):
        y = lines.begin(problem, 5)
        return y + 0.1 * np.random.default_rng(1).standard_normal(y.shape)

    def test_the_rate_is_that_of_numpy(self, problem):
        y = self.state(problem)
        rate, _, stiffness, friction = self.compiled.functions(problem)
        found = np.empty_like(y)
        rate(y, found, stiffness, friction)
        plain_rate = lines.planar_rate if problem.motion == "planar" else lines.spatial_rate
        expected = plain_rate(problem, 5)(y)
        assert found == pytest.approx(expected, rel=1e-12, abs=1e-12 * np.abs(expected).max())

    def test_the_jacobian_is_that_of_differences(self, problem):
        y = self.state(problem)
        rate, jacobian, stiffness, friction = self.compiled.functions(problem)
        J, differences, step = np.zeros((len(y), len(y))), np.zeros((len(y), len(y))), 1e-6
        jacobian(y, J, stiffness, friction)
        for i, e in enumerate(step * np.eye(len(y))):
            above, below = np.empty_like(y), np.empty_like(y)
            rate(y + e, above, stiffness, friction)
            rate(y - e, below, stiffness, friction)
            differences[:, i] = (above - below) / (2 * step)
        assert pytest.approx(differences, abs=1e-9 * np.abs(J).max()) == J

    def test_it_is_of_second_order(self, problem):
        errors = [self.compiled.solve(problem, cells, "exact", 1e-9)[0] for cells in (16, 32, 64)]
        assert orders(errors) == pytest.approx(2.0, abs=0.2)


def test_the_cantilever_agrees_with_shooting():
    assert ours.settle(12, "radau", 4.0, 1e-11)[0] < 1e-10


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(("shifted", "order"), [(False, 1.0), (True, 2.0)])
def test_elastica_is_of_the_order_of_its_clamp(shifted, order):
    pytest.importorskip("elastica", reason="pyelastica is in the extra `bench`")
    from benchmarks.peers import elastica

    def error(elements):
        step = elastica.SHARES[-1] * elastica.longest_step(elements)
        steps = int(3.0 / step)
        tips, _ = elastica._run(elements, shifted, elastica.DAMPINGS[1], step, steps, steps)
        return float(np.linalg.norm(tips[-1] - statics.tip()))

    assert order - 0.1 < np.log2(error(8) / error(16)) < order + 0.5


class TestExudyn:
    @pytest.fixture(autouse=True)
    def _module(self):
        pytest.importorskip("exudyn", reason="exudyn is in the extra `bench`")
        from benchmarks.peers import multibody

        self.exudyn = multibody

    @pytest.mark.parametrize(("nodes", "order"), [(2, 2.0), (3, 4.0)])
    def test_statics_are_of_the_order_of_the_elements(self, nodes, order):
        errors = [self.exudyn.settle(elements, nodes, 1)[0] for elements in (4, 8)]
        assert orders(errors)[0] == pytest.approx(order, abs=0.25)

    def test_motions_are_of_first_order(self):
        errors = [self.exudyn.relax(planar(1e4), 8, steps)[0] for steps in (50, 100, 200)]
        assert orders(errors) == pytest.approx(1.0, abs=0.15)


def test_the_search_finds_the_cheapest():
    def solve(cells, rtol):
        return 1 / cells**2 + rtol, cells * rtol**-0.25, 0

    solver = Solver(solve, [[(n,) for n in (4, 8, 16, 32, 64, 128)]], [10.0**-k for k in range(1, 9)])
    found = solver.cheapest(2e-3, 3)
    assert found.setting == (32, 1e-3)
    assert found.error <= 2e-3
    assert solver.cheapest(1e-12, 3) is None


def test_extrapolation_follows_the_order():
    found = extrapolated(Found(1e-6, 10.0, 11.0, ()), 3, 2.0)
    assert (found.error, found.least, found.median) == pytest.approx((1e-9, 10.0 * 10**1.5, 11.0 * 10**1.5))
    assert found.extrapolated


def test_the_table_says_what_is_missing():
    rows = {"ours": {1e-3: Found(1e-4, 1e-3, 2e-3, (1, 4))}, "theirs": "not measured: numba is not installed"}
    assert "| theirs | not measured: numba is not installed |" in table(rows, (1e-3,))
    assert plain(rows)["theirs"] == rows["theirs"]
