"""The forced variables of `problems` as a compiled kernel that is no rod, for integrations that never leave C."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import cffi
import numpy as np

from geocosserat.kernel.contract import Callbacks
from tests.solver.problems import Array, forced_rates

STRUCT = """
typedef struct {
    int size, calls;
    double bad, latest, gamma, *rates;
    double *(*vector)(void *), *(*matrix)(void *);
} problem;
"""
SOURCE = rf"""
#include <math.h>
{STRUCT}
/* From the instant `bad` on the last rate is NaN, and said to be so. */
int rate(double t, void *y, void *out, void *data)
{{
    problem *p = data;
    double *r = p->vector(out), *x = p->vector(y);
    for (int i = 0; i < p->size; ++i)
        r[i] = -p->rates[i] * (x[i] - cos(t));
    p->calls += 1;
    p->latest = fmax(p->latest, t);
    if (t <= p->bad)
        return 0;
    r[p->size - 1] = NAN;
    return 1;
}}
int jacobian(double t, void *y, void *r, void *J, void *data, void *a, void *b, void *c)
{{
    problem *p = data;
    double *columns = p->matrix(J);
    for (int i = 0; i < p->size * p->size; ++i)
        columns[i] = 0.0;
    for (int i = 0; i < p->size; ++i)
        columns[i * p->size + i] = -p->rates[i];
    return 0;
}}
int setup(double t, void *y, void *r, int usable, int *renewed, double gamma, void *data)
{{
    ((problem *)data)->gamma = gamma;
    *renewed = !usable;
    return 0;
}}
int solve(double t, void *y, void *r, void *b, void *x, double gamma, double tolerance, int side, void *data)
{{
    problem *p = data;
    for (int i = 0; i < p->size; ++i)
        p->vector(x)[i] = p->vector(b)[i] / (1.0 + p->gamma * p->rates[i]);
    return 0;
}}
"""
DECLARATIONS = f"""
{STRUCT}int rate(double, void *, void *, void *);
int jacobian(double, void *, void *, void *, void *, void *, void *, void *);
int setup(double, void *, void *, int, int *, double, void *);
int solve(double, void *, void *, void *, void *, double, double, int, void *);
"""


def build(compiler: str, folder: Path) -> Path:
    """The compiled library."""
    source, library = folder / "forced.c", folder / "forced.so"
    source.write_text(SOURCE)
    subprocess.run([compiler, "-O1", "-shared", "-fPIC", str(source), "-o", str(library), "-lm"], check=True)
    return library


class NativeForced:
    """size variables that follow cos t, in C; from the instant `bad` on the rate cannot be evaluated."""

    backend = "c"

    def __init__(self, library: Path, size: int, bad: float = np.inf) -> None:
        self.size = size
        self._ffi = ffi = cffi.FFI()
        ffi.cdef(DECLARATIONS)
        self._lib: Any = ffi.dlopen(str(library))
        self._rates = forced_rates(size)
        self.problem = ffi.new("problem *")
        self.problem.size, self.problem.bad = size, bad
        self.problem.rates = ffi.cast("double *", self._rates.ctypes.data)

    def callbacks(self, vector: int, matrix: int, dense: bool) -> Callbacks:
        ffi = self._ffi
        self.problem.vector = ffi.cast("double *(*)(void *)", vector)
        self.problem.matrix = ffi.cast("double *(*)(void *)", matrix)

        def address(pointer: Any) -> int:
            return int(ffi.cast("uintptr_t", pointer))

        functions = (getattr(self._lib, name) for name in ("rate", "jacobian", "setup", "solve"))
        return Callbacks(address(self.problem), *map(address, functions), keep=self)

    def rate(self, t: float, y: Array, out: Array) -> None:
        out[:] = -self._rates * (y - np.cos(t)) if t <= self.problem.bad else np.nan
