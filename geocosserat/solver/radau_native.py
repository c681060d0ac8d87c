"""Radau IIA of order 5, 9 or 13 around a compiled kernel: few long steps, for small systems; see radau.c.

Source: E. Hairer and G. Wanner, J. Comput. Appl. Math. 111 (1999) 93.
"""

from functools import lru_cache
from pathlib import Path
from typing import Any, cast

import cffi
import numpy as np

from geocosserat.kernel.compile import opened
from geocosserat.kernel.contract import Array, Kernel, NativeKernel
from geocosserat.solver.settings import LEAST_RTOL, SINGULAR, Hope
from geocosserat.solver.trajectory import Frame, Progress, Trajectory

LARGEST = 1000
"""Entries of the largest state it is meant for: its matrices are dense."""

SOON, FAR = 20_000, 10_000_000
"""Its steps are long: after so many, a run whose end is so many more away at their pace will never get there."""

MOST_STAGES, PARTS = 7, 4
METHOD = np.dtype(
    [
        ("stages", np.intc),
        ("node", float, MOST_STAGES),
        ("weight", float, (MOST_STAGES, MOST_STAGES)),
        ("error", float, MOST_STAGES),
        ("value", complex, PARTS),
        ("row", complex, (PARTS, MOST_STAGES)),
        ("column", complex, (PARTS, MOST_STAGES)),
    ],
    align=True,
)
"""`struct method` of radau.c."""

DECLARATIONS = """
/* Pointers that are known as numbers are passed as such. */
void *radau_new(const void *method, int size, int quadratures, const double *constrained, uintptr_t data,
                uintptr_t rate, uintptr_t jacobian, double t, const double *y, double rtol, const double *atol);
int radau_begin(void *memory, double *out);
void radau_free(void *memory);
int radau_advance(void *memory, const double *times, int count, int *done, double *states);
double radau_state(const void *memory, long *counts);
"""
PAUSED = 1
REASONS = {
    -1: f"the error test failed however small the step; {SINGULAR}",
    -2: f"Newton's method failed however small the step; {SINGULAR}",
    -3: "the rate is not finite however small the step",
    -4: "the constraints have no solution",
}
AT_START = {-3: "the rate is not finite at the start", -4: REASONS[-4]}


def stages_for(rtol: float) -> int:
    """How many stages, 3, 5 or 7: the tighter the tolerance, the more their higher order pays.

    At 1e-2 five take some time more than three and are ten times as accurate, at 1e-7 seven take as long as five with
    half the steps: measured on the examples.
    """
    return 3 if rtol > 3e-2 else 5 if rtol > 1e-6 else 7


def tableau(stages: int) -> tuple[Array, Array]:
    """Abscissae (stages,) in (0, 1] and weights (stages, stages) of the Radau IIA method of order 2 stages - 1."""
    last = np.polynomial.Legendre.basis(stages) - np.polynomial.Legendre.basis(stages - 1)
    x = np.sort(last.roots().real)
    x[-1] = 1.0
    for _ in range(3):  # roots of a companion matrix lack a few digits
        x[:-1] -= last(x[:-1]) / last.deriv()(x[:-1])
    powers = np.arange(stages)
    slopes = np.polynomial.legendre.legvander(x, stages - 1)
    # (P_{k+1} - P_{k-1}) / (2 k + 1) is the integral of P_k from -1
    higher = np.polynomial.legendre.legvander(x, stages)
    integrals = np.column_stack([x + 1.0, *((higher[:, k + 1] - higher[:, k - 1]) / (2 * k + 1) for k in powers[1:])])
    return (1.0 + x) / 2.0, 0.5 * integrals @ np.linalg.inv(slopes)


@lru_cache(maxsize=3)
def method(stages: int) -> np.ndarray[Any, np.dtype[np.void]]:
    """The method with an odd number of stages up to 7, as radau.c wants it."""
    c, weight = tableau(stages)
    inverse = np.linalg.inv(weight)
    values, columns = np.linalg.eig(inverse)
    rows = np.linalg.inv(columns)
    kept = [int(np.argmin(np.abs(values.imag))), *np.flatnonzero(values.imag > 1e-6)]
    twice = np.array([1.0] + [2.0] * (len(kept) - 1))  # a pair counts for both
    # the embedded formula also takes the rate at the start, by one over the real eigenvalue; its order is `stages`
    differs = np.linalg.solve(c ** np.arange(stages)[:, None], -np.eye(stages)[0] / values[kept[0]].real)
    made = np.zeros((), METHOD)
    made["stages"] = stages
    made["node"][:stages] = c
    made["weight"][:stages, :stages] = weight
    made["error"][:stages] = differs @ inverse
    made["value"][: len(kept)] = values[kept]
    made["row"][: len(kept), :stages] = rows[kept]
    made["column"][: len(kept), :stages] = (twice * columns[:, kept]).T
    return made


@lru_cache(maxsize=1)
def _library() -> tuple[cffi.FFI, Any, Any]:
    """The interface, the library, and the type by which C takes arrays."""
    ffi = cffi.FFI()
    ffi.cdef(DECLARATIONS)
    source = "".join(Path(__file__).with_name(name).read_text() for name in ("shifted.c", "radau.c"))
    return ffi, opened(lambda path: ffi.dlopen(str(path)), source), ffi.typeof("double[]")


@lru_cache(maxsize=3)
def _method_at(stages: int) -> Any:
    """The method as C takes it."""
    return _library()[0].from_buffer(method(stages))


def radau_native(
    kernel: Kernel, start: Array, times: Array, rtol: float, atol: Array, progress: Progress, frame: Frame
) -> Trajectory:
    """Integrates a NativeKernel from times[0] through all of `times`; see `integrate`.

    It begins where the constraints hold: the start needs no value for what they fix.
    """
    ffi, lib, numbers = _library()
    functions = cast(NativeKernel, kernel).functions()
    first, last, count = float(times[0]), float(times[-1]), len(times)
    states = np.empty((count, kernel.size))
    states[0] = start
    rows, instants = ffi.from_buffer(numbers, states), ffi.from_buffer(numbers, np.ascontiguousarray(times))
    memory = lib.radau_new(_method_at(stages_for(rtol)), kernel.size, functions.quadratures,
                           ffi.from_buffer(numbers, np.ascontiguousarray(kernel.algebraic)), functions.data,
                           functions.rate, functions.jacobian, first, rows, max(rtol, LEAST_RTOL),
                           ffi.from_buffer(numbers, atol))  # fmt: skip
    if memory == ffi.NULL:
        raise MemoryError(f"no room for dense matrices of {kernel.size} unknowns")
    reason, counts, reached, hope = "", ffi.new("long[3]"), ffi.new("int *", 1), Hope(SOON, FAR)
    try:
        code = lib.radau_begin(memory, rows)
        if code < 0:
            states[0] = start
            return Trajectory(times[:1].copy(), states[:1], 1, 0, 0, False, AT_START[code])
        done = 1
        while done < count and not reason:
            code = lib.radau_advance(memory, instants, count, reached, rows)
            now = lib.radau_state(memory, counts)
            for i in range(done, reached[0]):
                frame(i, states[i])
                progress((float(times[i]) - first) / (last - first), counts[0])
            done = reached[0]
            if code == PAUSED:
                fraction = (now - first) / (last - first)
                if hope.lost(counts[0], fraction):
                    reason = f"Radau stopped at t = {now:.6g}: {counts[0]} steps did not reach the end; {SINGULAR}"
                progress(fraction, counts[0])
            elif code < 0:
                reason = f"Radau stopped at t = {now:.6g} after {counts[0]} steps: {REASONS[code]}"
    finally:
        lib.radau_free(memory)
    return Trajectory(times[:done].copy(), states[:done], counts[1], counts[2], counts[0], not reason, reason)
