"""The linear algebra of a kernel: blocks, factors and solves are those of the exact Jacobian."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.load import load
from geocosserat.kernel.native import NativeRod
from tests.discretisation.rods import WORLD, random_state, scene
from tests.kernel.kernels import Case, T, cases, eliminated, implicit, kernel, state, turns

Array = NDArray[np.float64]
ids = pytest.mark.parametrize("case", cases(), ids=str)


@ids
@pytest.mark.parametrize("gamma", [1e-4, 0.3, -0.2, 10.0])
def test_a_block_solve_is_the_dense_solve(case: Case, gamma: float) -> None:
    """For any step, at a random state, where the matrix is decently conditioned; rings and carried poses too."""
    k, y, b = kernel(case), state(case, 1), state(case, 2)
    matrix = implicit(case, k.jacobian(T, y), gamma)
    out = np.full_like(b, np.nan)
    k.prepare(T, y)
    k.factor(gamma)
    k.solve(b, out)
    wanted = np.linalg.solve(matrix, b)
    condition = np.linalg.cond(matrix)
    assert condition < 1e7
    np.testing.assert_allclose(out, wanted, rtol=0, atol=max(1e-11, 1e-16 * condition) * np.abs(wanted).max())
    np.testing.assert_array_equal(out[-2:], b[-2:])


@pytest.mark.parametrize("case", [c for c in cases() if c.name.endswith(("everything", "reeled", "ring"))], ids=str)
def test_factors_may_be_made_again_from_the_same_blocks_and_used_often(case: Case) -> None:
    """prepare, then factor with one step after another, then solve with any number of right-hand sides."""
    k, y = kernel(case), state(case, 1)
    J = k.jacobian(T, y)
    k.prepare(T, y)
    for gamma in (0.1, 0.01, 0.1):
        k.factor(gamma)
        for seed in (3, 4):
            b, out = state(case, seed), np.empty(len(y))
            k.solve(b, out)
            np.testing.assert_allclose(implicit(case, J, gamma) @ out, b, rtol=0, atol=1e-11)


@ids
def test_the_blocks_are_the_jacobian_once_poses_are_eliminated(case: Case) -> None:
    """Block-tridiagonal, entry q d + c of a block being component c at point q; rings have two blocks more, and rods
    that see the world rows for the pose of each element's left end."""
    k, y, m = kernel(case), state(case, 5), turns(case)
    J = k.jacobian(T, y)[:m, :m]
    found = eliminated(case, k.blocks(T, y))
    np.testing.assert_allclose(found, J, rtol=0, atol=(1e-13 if case.name in WORLD else 1e-14) * np.abs(J).max())


@pytest.mark.parametrize("case", cases(("c",)), ids=str)
def test_the_blocks_of_c_and_numpy_agree(case: Case) -> None:
    """All three diagonals, with the rows of orientations where there are some."""
    y = state(case, 6)
    for found, wanted in zip(
        kernel(case).blocks(T, y), kernel(case._replace(backend="numpy")).blocks(T, y), strict=True
    ):
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-13 * (1 + np.abs(wanted).max()))


def test_a_long_rod_is_solved_as_accurately_as_a_short_one() -> None:
    """400 elements under a dead load: elimination from one end to the other loses nothing."""
    r = discretise(scene("spatial hung"), 400, 1)
    k = load(kernel_text(r.structure), r, "numpy")
    y, b = random_state(r, 1, size=0.05), np.random.default_rng(2).normal(size=len(r.state))
    J, out = k.jacobian(T, y), np.empty_like(b)
    k.prepare(T, y)
    k.factor(1e-2)
    k.solve(b, out)
    residual = out - 1e-2 * J @ out - b
    assert np.abs(residual[:-2]).max() < 1e-11


@pytest.mark.parametrize("case", [c for c in cases(("c",)) if c.name == "spatial everything"], ids=str)
def test_a_system_without_a_solution_is_said_to_be_singular(case: Case) -> None:
    """A state that is not a number leaves no pivot; the element is named."""
    k, y = kernel(case), state(case, 1)
    assert isinstance(k, NativeRod)
    y[0] = np.nan
    k.prepare(T, y)
    with pytest.raises(np.linalg.LinAlgError, match="the linear system of element 0 is singular"):
        k.factor(0.1)
