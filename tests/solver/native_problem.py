"""The forced variables of `problems` as a compiled kernel that is no rod, for integrations that never leave C."""

from __future__ import annotations

import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import cffi
import numpy as np

from geocosserat.kernel.contract import LANES, Callbacks, Functions
from tests.solver.problems import Array, constrained, forced_rates

MOST = 256
"""Entries of the largest state."""

STRUCT = """
typedef struct {
    void *memory;
    int size, calls;
    double bad, latest, gamma, wrong, last, *rates, *at, *matrix;
    double *(*vector)(void *);
} problem;
"""
SOURCE = rf"""
#include <math.h>
{STRUCT}
/* What Radau IIA takes: the rate and the Jacobian by rows, which stands in `matrix`. Where it is to be
 * wrong by a factor, it also is NaN at other instants than the last one of a rate. */
int slope(void *data, double t, const double *x, double *r)
{{
    problem *p = data;
    for (int i = 0; i < p->size; ++i)
        r[i] = -p->rates[i] * (x[i] - cos(t));
    p->calls += 1;
    p->latest = fmax(p->latest, t);
    p->last = t;
    if (t > p->bad)
        r[p->size - 1] = NAN;
    return 0;
}}
/* The same of up to LANES states side by side, by any such function. */
static int side_by_side(int (*one)(void *, double, const double *, double *), problem *p, int count, const double *t,
                        const double *x, double *r)
{{
    double at[{MOST}], rate[{MOST}];
    for (int l = 0; l < count; ++l) {{
        for (int i = 0; i < p->size; ++i)
            at[i] = x[{LANES} * i + l];
        one(p, t[l], at, rate);
        for (int i = 0; i < p->size; ++i)
            r[{LANES} * i + l] = rate[i];
    }}
    return 0;
}}
int slopes(void *data, int count, const double *t, const double *x, double *r)
{{
    return side_by_side(slope, data, count, t, x, r);
}}
const double *matrix(void *data, double t, const double *x)
{{
    problem *p = data;
    const double factor = p->wrong == 0.0 ? 1.0 : t == p->last ? p->wrong : NAN;
    for (int i = 0; i < p->size * p->size; ++i)
        p->matrix[i] = i % (p->size + 1) ? 0.0 : -factor * p->rates[i / p->size];
    return p->matrix;
}}
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
int system(double t, void *y, void *r, void *none, int usable, int *renewed, double gamma, void *data,
           void *a, void *b, void *c)
{{
    ((problem *)data)->gamma = gamma;
    *renewed = !usable;
    return 0;
}}
int solve(void *solver, void *none, void *x, void *b, double tolerance)
{{
    problem *p = *(problem **)solver;
    for (int i = 0; i < p->size; ++i)
        p->vector(x)[i] = p->vector(b)[i] / (1.0 + p->gamma * p->rates[i]);
    return 0;
}}
"""
CONSTRAINED = r"""
/* The same variables x, which follow not cos t but a z that a constraint makes so: (1 + x^2) (z - cos t) = 0. */
int residual(double t, void *y, void *yp, void *out, void *data)
{
    problem *p = data;
    const int m = p->size / 2;
    double *r = p->vector(out), *x = p->vector(y), *slope = p->vector(yp);
    for (int i = 0; i < m; ++i) {
        r[i] = slope[i] + p->rates[i] * (x[i] - x[m + i]);
        r[m + i] = (1.0 + x[i] * x[i]) * (x[m + i] - cos(t));
    }
    p->calls += 1;
    p->latest = fmax(p->latest, t);
    return t <= p->bad ? 0 : 1;
}
int constrained_slope(void *data, double t, const double *x, double *r)
{
    problem *p = data;
    const int m = p->size / 2;
    for (int i = 0; i < m; ++i) {
        r[i] = -p->rates[i] * (x[i] - x[m + i]);
        r[m + i] = (1.0 + x[i] * x[i]) * (x[m + i] - cos(t)) + (t > p->bad ? NAN : 0.0);
    }
    p->calls += 1;
    p->latest = fmax(p->latest, t);
    return 0;
}
int constrained_slopes(void *data, int count, const double *t, const double *x, double *r)
{
    return side_by_side(constrained_slope, data, count, t, x, r);
}
const double *constrained_matrix(void *data, double t, const double *x)
{
    problem *p = data;
    const int n = p->size, m = n / 2;
    for (int i = 0; i < n * n; ++i)
        p->matrix[i] = 0.0;
    for (int i = 0; i < m; ++i) {
        p->matrix[i * n + i] = -p->rates[i];
        p->matrix[i * n + m + i] = p->rates[i];
        p->matrix[(m + i) * n + i] = 2.0 * x[i] * (x[m + i] - cos(t));
        p->matrix[(m + i) * n + m + i] = 1.0 + x[i] * x[i];
    }
    return p->matrix;
}
int residual_system(double t, double c, void *y, void *yp, void *r, void *none, void *data,
                    void *a1, void *a2, void *a3)
{
    problem *p = data;
    for (int i = 0; i < p->size / 2; ++i)
        p->at[i] = p->vector(y)[i];
    p->gamma = c;
    return 0;
}
int residual_solve(void *solver, void *none, void *z, void *b, double tolerance)
{
    problem *p = *(problem **)solver;
    const int m = p->size / 2;
    double *x = p->at, *right = p->vector(b), *out = p->vector(z);
    for (int i = 0; i < m; ++i) {
        out[m + i] = right[m + i] / (1.0 + x[i] * x[i]);
        out[i] = (right[i] + p->rates[i] * out[m + i]) / (p->gamma + p->rates[i]);
    }
    return 0;
}
"""
DECLARATIONS = f"""
{STRUCT}int rate(double, void *, void *, void *);
int system(double, void *, void *, void *, int, int *, double, void *, void *, void *, void *);
int solve(void *, void *, void *, void *, double);
int slope(void *, double, const double *, double *);
int slopes(void *, int, const double *, const double *, double *);
const double *matrix(void *, double, const double *);
int constrained_slopes(void *, int, const double *, const double *, double *);
int constrained_slope(void *, double, const double *, double *);
const double *constrained_matrix(void *, double, const double *);
int residual(double, void *, void *, void *, void *);
int residual_system(double, double, void *, void *, void *, void *, void *, void *, void *, void *);
int residual_solve(void *, void *, void *, void *, double);
"""


def build(compiler: str, folder: Path) -> Path:
    """The compiled library."""
    source, library = folder / "forced.c", folder / "forced.so"
    source.write_text(SOURCE + CONSTRAINED)
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
        self._at, self._matrix = np.empty(size), np.empty((2 * size) ** 2)
        self.problem.matrix = ffi.cast("double *", self._matrix.ctypes.data)
        self.problem.rates = ffi.cast("double *", self._rates.ctypes.data)
        self.problem.at = ffi.cast("double *", self._at.ctypes.data)

    def callbacks(self, vector: int, current: int) -> Callbacks:
        ffi = self._ffi
        self.problem.vector = ffi.cast("double *(*)(void *)", vector)

        def address(pointer: Any) -> int:
            return int(ffi.cast("uintptr_t", pointer))

        functions = (getattr(self._lib, name) for name in ("rate", "system", "solve"))
        return Callbacks(address(self.problem), *map(address, functions), keep=self)

    def functions(self) -> Functions:
        return self._functions("slope", "slopes", "matrix")

    def _functions(self, *names: str) -> Functions:
        things = (self.problem, *(getattr(self._lib, name) for name in names))
        data, slope, slopes, matrix = (int(self._ffi.cast("uintptr_t", thing)) for thing in things)
        return Functions(data, slope, slopes, matrix, quadratures=0, keep=self)

    @property
    def algebraic(self) -> Array:
        return np.zeros(self.size)

    def rate(self, t: float, y: Array, out: Array) -> None:
        out[:] = -self._rates * (y - np.cos(t)) if t <= self.problem.bad else np.nan


class NativeConstrained(NativeForced):
    """The same through a constraint (see `problems.constrained`), in C."""

    def __init__(self, library: Path, size: int, bad: float = np.inf) -> None:
        super().__init__(library, size, bad)
        self.size = self.problem.size = 2 * size
        self._python = constrained(size)

    @property
    def algebraic(self) -> Array:
        return self._python.algebraic

    def functions(self) -> Functions:
        return self._functions("constrained_slope", "constrained_slopes", "constrained_matrix")

    def callbacks(self, vector: int, current: int) -> Callbacks:
        names = ("residual", "residual_system", "residual_solve")
        found = {name: int(self._ffi.cast("uintptr_t", getattr(self._lib, name))) for name in names}
        return replace(super().callbacks(vector, current), **found)

    def rate(self, t: float, y: Array, out: Array) -> None:
        self._python.rate(t, y, out)
        out[:] += 0.0 if t <= self.problem.bad else np.nan

    def jacobian(self, t: float, y: Array) -> Array:
        return self._python.jacobian(t, y)

    def prepare(self, t: float, y: Array) -> None:
        self._python.prepare(t, y)

    def factor(self, gamma: float) -> None:
        self._python.factor(gamma)

    def solve(self, b: Array, out: Array) -> None:
        self._python.solve(b, out)
