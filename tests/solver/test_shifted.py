"""Systems with one matrix and several shifts, beside numpy's."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import cffi
import numpy as np
import pytest

import geocosserat.solver
from geocosserat.kernel.compile import FLAGS
from tests.solver.problems import Array

LANES = 4
DECLARATION = "int solve(int n, const double *A, const double *g, const double *b, double *x);"
WRAPPER = r"""
#include <stdlib.h>

static void *room(size_t count, size_t bytes)
{
    return calloc(count + 1, bytes);
}

/* A by columns, g [2][LANES], b and x [n][2][LANES]: real parts, then imaginary ones. */
int solve(int n, const double *A, const double *g, const double *b, double *x)
{
    const size_t w = padded_rows(n), all = n;
    shifted s = {n, (int)w, room(all, sizeof(int)), room(all * w, sizeof(double)), room(all * w, sizeof(double)),
                 room(w, sizeof(double)), room(all * (all + 1) / 2, sizeof(number)), room(all, sizeof(number)),
                 room(all, sizeof(number)), room(all, sizeof(choice))};
    number shifts, *y = room(all, sizeof(number));
    for (int j = 0; j < n; ++j)
        memcpy(s.H + j * w, A + j * n, n * sizeof *A);
    reduce(&s);
    memcpy(&shifts, g, sizeof shifts);
    const int failed = shift(&s, shifts);
    for (int i = 0; i < n; ++i)
        memcpy(y + i, b + 2 * LANES * s.order[i], sizeof *y);
    solve_shifted(&s, y);
    for (int i = 0; i < n; ++i)
        memcpy(x + 2 * LANES * s.order[i], y + i, sizeof *y);
    void *rooms[] = {s.order, s.H, s.lower, s.y, s.upper, s.factor, s.row, s.exchanged, y};
    for (size_t k = 0; k < sizeof rooms / sizeof *rooms; ++k)
        free(rooms[k]);
    return failed;
}
"""


class Systems:
    """What stands in shifted.c, with arrays of numpy around it."""

    def __init__(self, compiler: str, folder: Path) -> None:
        source, library = folder / "systems.c", folder / "systems.so"
        source.write_text((Path(geocosserat.solver.__path__[0]) / "shifted.c").read_text() + WRAPPER)
        subprocess.run([compiler, *FLAGS, str(source), "-o", str(library), "-lm"], check=True)
        self._ffi = cffi.FFI()
        self._ffi.cdef(DECLARATION)
        self._lib: Any = self._ffi.dlopen(str(library))

    def solve(self, A: Array, g: np.ndarray, b: np.ndarray) -> tuple[bool, np.ndarray]:
        """Whether 1 - g A is regular for all g (LANES,), and solutions (n, LANES) for right-hand sides like them."""
        n = len(A)
        x = np.empty((n, 2, LANES))
        arrays = (
            np.ascontiguousarray(A.T),
            np.stack([g.real, g.imag]),
            np.ascontiguousarray(np.stack([b.real, b.imag], axis=1)),
            x,
        )
        failed = self._lib.solve(n, *(self._ffi.from_buffer("double[]", a) for a in arrays))
        return not failed, x[:, 0] + 1j * x[:, 1]


@pytest.fixture(scope="module")
def systems(c_compiler: str, tmp_path_factory: pytest.TempPathFactory) -> Systems:
    """Compiled as it is beside Radau's own C."""
    return Systems(c_compiler, tmp_path_factory.mktemp("systems"))


def _numbers(seed: int, *shape: int) -> np.ndarray:
    draw = np.random.default_rng(seed)
    return draw.normal(size=shape) + 1j * draw.normal(size=shape)


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 8, 13, 24, 41])
def test_each_lane_has_its_own_shift(systems: Systems, n: int) -> None:
    """Solutions are those of numpy, whether or not the size fills what rows are padded to."""
    A, g, b = _numbers(n, n, n).real, _numbers(n + 1, LANES), _numbers(n + 2, n, LANES)
    regular, x = systems.solve(A, g, b)
    assert regular
    for lane in range(LANES):
        wanted = np.linalg.solve(np.eye(n) - g[lane] * A, b[:, lane])
        np.testing.assert_allclose(x[:, lane], wanted, rtol=1e-9, atol=1e-9)


def test_scales_may_differ_by_decades(systems: Systems) -> None:
    """As those of stretching and bending do: what is left is small beside what stands in each row."""
    n = 12
    A = -np.diag(10.0 ** np.arange(n)) @ (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    g, b = np.array([1.0, 0.1 + 0.2j, 1e-3j, 1e-6]), _numbers(3, n, LANES)
    regular, x = systems.solve(A, g, b)
    assert regular
    for lane in range(LANES):
        M = np.eye(n) - g[lane] * A
        left = np.abs(M @ x[:, lane] - b[:, lane])
        assert np.all(left <= 1e-12 * (np.abs(M) @ np.abs(x[:, lane]) + np.abs(b[:, lane])))


def test_a_matrix_that_falls_apart_needs_no_elimination(systems: Systems) -> None:
    """Where all that could be eliminated is zero; and where rows have to be exchanged."""
    n, b = 6, _numbers(5, 6, LANES)
    g = np.array([1.0, 2.0, 1j, 0.0])
    for A in (np.zeros((n, n)), np.eye(n, k=1), np.eye(n)[::-1] + np.eye(n), np.diag(np.arange(-1.0, -7.0, -1.0))):
        regular, x = systems.solve(A, 0.7 * g, b)
        assert regular
        for lane in range(LANES):
            np.testing.assert_allclose((np.eye(n) - 0.7 * g[lane] * A) @ x[:, lane], b[:, lane], atol=1e-12)


@pytest.mark.parametrize("lane", range(LANES))
def test_a_singular_lane_is_told(systems: Systems, lane: int) -> None:
    """One over an eigenvalue, in any of them; and a matrix that is not finite."""
    g, b = np.full(LANES, 0.3 + 0.0j), _numbers(7, 2, LANES)
    A = np.array([[2.0, 0.0], [0.0, 5.0]])
    assert systems.solve(A, g, b)[0]
    g[lane] = 0.5
    assert not systems.solve(A, g, b)[0]
    assert not systems.solve(np.full((2, 2), np.nan), np.full(LANES, 0.3 + 0.0j), b)[0]
