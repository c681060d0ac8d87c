"""Solver (d): the C that an expert writes for this one problem; see by_hand.c.

Compiled with the flags of this project's own kernels. Nothing of Python runs inside a solve; the strains go in and
come out, positions are marched afterwards and not timed (no more than they are for the others). First step: a tenth
of the time times the fourth root of the tolerance.
"""

import time
from functools import lru_cache
from pathlib import Path
from typing import Any

import cffi
import numpy as np

from benchmarks.peers.problems import UNTIL, Problem, error_of_strains, strain
from benchmarks.warm import warm
from geocosserat.discretisation.mesh import Array
from geocosserat.kernel.compile import opened

DECLARATION = """
int relax(int cells, double length, const double *stiffness, const double *friction, double *y, double until,
          double rtol, double first, long *counts);
"""


@lru_cache(maxsize=2)
def library(size: int) -> tuple[cffi.FFI, Any]:
    """The compiled solver for 3 or 6 strains."""
    ffi = cffi.FFI()
    ffi.cdef(DECLARATION)
    source = Path(__file__).with_name("by_hand.c").read_text()
    return ffi, opened(lambda path: ffi.dlopen(str(path)), source, size)


def run(problem: Problem, cells: int, rtol: float) -> tuple[Array, float, int]:
    """Strains (size, cells) at the end, seconds, and steps of a run on an even number of cells."""
    ffi, lib = library(problem.size)
    u = np.linspace(0.0, 1.0, cells + 1)
    start = np.ascontiguousarray(strain(problem, (u[1:] + u[:-1]) / 2))
    y = np.empty_like(start)
    stiffness, friction = ffi.new("double[]", problem.stiffness), ffi.new("double[]", problem.friction)
    counts, numbers = ffi.new("long[2]"), ffi.from_buffer("double[]", y, require_writable=True)
    first = 0.1 * UNTIL * rtol**0.25

    def once() -> tuple[int, float]:
        y[:] = start
        begin = time.perf_counter()
        failed = lib.relax(cells, 1.0, stiffness, friction, numbers, UNTIL, rtol, first, counts)
        return failed, time.perf_counter() - begin

    failed, seconds = warm(once)
    if failed:
        raise RuntimeError(f"by hand: gave up at {cells} cells, rtol {rtol:.0e}")
    return y, seconds, counts[0]


def solve(problem: Problem, cells: int, rtol: float) -> tuple[float, float, int]:
    """Error, seconds, and steps."""
    y, seconds, steps = run(problem, cells, rtol)
    return error_of_strains(problem, y, cells, 1), seconds, steps
