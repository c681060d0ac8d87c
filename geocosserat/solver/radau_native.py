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

SOURCES = ("shifted.c", "radau.c")
"""One text in C, in this order."""

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
typedef struct progress {
    int code, done;
    long steps, rates, jacobians;
    double t;
} progress;
/* Pointers that are known as numbers are passed as such. */
void *radau_start(const void *method, int size, int quadratures, const double *constrained, uintptr_t data,
                  uintptr_t rate, uintptr_t rates, uintptr_t jacobian, double rtol, const double *atol,
                  const double *start, const double *times, int count, double *states, progress *p);
void radau_go(void *memory, const double *times, int count, double *states, progress *p);
void radau_free(void *memory);
"""
PAUSED, NO_ROOM = 1, -5
REASONS = {
    -1: f"the error test failed however small the step; {SINGULAR}",
    -2: f"Newton's method failed however small the step; {SINGULAR}",
    -3: f"the rate is not finite however small the step; {SINGULAR}",
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
    made["row"][0, :stages] = rows[kept[0]].real + 1j * values[kept[0]].real * differs  # see radau.c
    made["column"][: len(kept), :stages] = (twice * columns[:, kept]).T
    return made


@lru_cache(maxsize=1)
def _library() -> tuple[cffi.FFI, Any, Any]:
    """The interface, the library, and the type by which C takes arrays."""
    ffi = cffi.FFI()
    ffi.cdef(DECLARATIONS)
    source = "".join(Path(__file__).with_name(name).read_text() for name in SOURCES)
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
    at = ffi.from_buffer
    functions = cast(NativeKernel, kernel).functions()
    count, size = len(times), kernel.size
    states = np.empty((count, size))
    place = at(numbers, np.ascontiguousarray(times)), count, at(numbers, states), ffi.new("progress *")
    now = place[3]
    memory = lib.radau_start(_method_at(stages_for(rtol)), size, functions.quadratures, at(numbers, kernel.algebraic),
                             functions.data, functions.rate, functions.rates, functions.jacobian, max(rtol, LEAST_RTOL),
                             at(numbers, atol), at(numbers, np.ascontiguousarray(start)), *place)  # fmt: skip
    if now.code in AT_START and not now.done:
        return Trajectory(times[:1].copy(), start[None].copy(), 1, 0, 0, False, AT_START[now.code])
    if now.code == NO_ROOM:
        raise MemoryError(f"no room for dense matrices of {size} unknowns")
    try:
        done, reason = _through(lib, memory, place, times, states, progress, frame)
    finally:
        if memory != ffi.NULL:
            lib.radau_free(memory)
    if done == count:
        return Trajectory(times.copy(), states, now.rates, now.jacobians, now.steps, True, reason)
    return Trajectory(times[:done].copy(), states[:done], now.rates, now.jacobians, now.steps, False, reason)


def _through(
    lib: Any, memory: Any, place: tuple[Any, ...], times: Array, states: Array, progress: Progress, frame: Frame
) -> tuple[int, str]:
    """Goes on until the end, or a frame that wants a pause, telling what is reached. Returns how many states there are,
    without those after a pause, and why it stopped before; empty if it did not."""
    now, instants, done, hope = place[3], times.tolist(), 1, None
    first, last = instants[0], instants[-1]
    while True:
        steps, reached = now.steps, now.done
        while done < reached:
            progress((instants[done] - first) / (last - first), steps)
            done += 1
            if frame(done - 1, states[done - 1], steps):
                return done, ""
        if now.code < 0:
            return done, f"Radau stopped at t = {now.t:.6g} after {now.steps} steps: {REASONS[now.code]}"
        if now.code != PAUSED:
            return done, ""
        fraction, hope = (now.t - first) / (last - first), hope or Hope(SOON, FAR)
        if hope.lost(now.steps, fraction):
            return done, f"Radau stopped at t = {now.t:.6g}: {now.steps} steps did not reach the end; {SINGULAR}"
        progress(fraction, now.steps)
        lib.radau_go(memory, *place)
