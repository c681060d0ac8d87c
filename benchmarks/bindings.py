"""What a call across a binding costs, in nanoseconds: why kernels are called through cffi, and CVODE directly.

The kernel does nothing; only the way to it is timed. For the two ways into CVODE a whole integration of a small linear
system is timed and divided by the evaluations of its rate.
"""

import ctypes
import statistics
import subprocess
import tempfile
import time
import timeit
from collections.abc import Callable
from pathlib import Path

import cffi
import numpy as np

import geocosserat.solver.integrate as door
from geocosserat.codegen.source import generate
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.compile import FLAGS, compile_c, compiler
from geocosserat.kernel.native import NativeRod
from geocosserat.model.scene import load_scene

NOTHING = "int nothing(double t, const double *y, double *dy) { (void)t; (void)y; (void)dy; return 0; }\n"
SCENE = {
    "rod": {"motion": "planar", "length": 1.0, "stiffness": [1e4, 1e4, 1.0], "friction": [1.0, 1.0, 0.01]},
    "start": {"strain": ["1", "0", "3*(1-u)**2*(1+2*u)"]},
    "run": {"until": 0.05},
}


def _nanoseconds(call: Callable[[], object], number: int = 100_000) -> list[float]:
    return [1e9 * t / number for t in timeit.repeat(call, number=number, repeat=7)]


def calls() -> dict[str, list[float]]:
    """One call with two arrays of 24 numbers."""
    tool = compiler()
    if tool is None:
        raise SystemExit("expected a C compiler, found none; this benchmark calls compiled code")
    with tempfile.TemporaryDirectory() as name:
        source, library = Path(name) / "nothing.c", Path(name) / "nothing.so"
        source.write_text(NOTHING)
        subprocess.run([tool, *FLAGS, str(source), "-o", str(library)], check=True)
        y, dy = np.zeros(24), np.zeros(24)
        by_ctypes = ctypes.CDLL(str(library)).nothing
        by_ctypes.argtypes = [ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p]
        ffi = cffi.FFI()
        ffi.cdef("int nothing(double t, const double *y, double *dy);")
        by_cffi, at, kind = ffi.dlopen(str(library)).nothing, ffi.from_buffer, ffi.typeof("double[]")
        return {
            "ctypes, array.ctypes.data": _nanoseconds(lambda: by_ctypes(0.0, y.ctypes.data, dy.ctypes.data)),
            "cffi, from_buffer": _nanoseconds(lambda: by_cffi(0.0, at(kind, y), at(kind, dy))),
        }


def integrations(rounds: int = 7) -> dict[str, list[float]]:
    """An integration of 24 unknowns, per evaluation of the rate: through Python callbacks, and without Python."""
    scene = load_scene(SCENE)
    rod = discretise(scene, 1, 8)
    kernel = NativeRod(compile_c(generate(rod.structure).c, 8), rod)
    times = np.array([0.0, 0.05])
    found: dict[str, list[float]] = {"CVODE through scikit-sundae": [], "CVODE called directly": []}
    native = door.sundials
    for _ in range(rounds):
        for name, library in (("CVODE through scikit-sundae", lambda _: None), ("CVODE called directly", native)):
            door.sundials = library  # type: ignore[assignment]
            start = time.perf_counter()
            done = door.integrate(kernel, rod.state, times, "cvode", 1e-8, 1e-8)
            found[name].append(1e9 * (time.perf_counter() - start) / done.rates)
    door.sundials = native
    return found


def table() -> str:
    """Markdown: nanoseconds, minimum and median."""
    rows = {**calls(), **integrations()}
    lines = [f"| {name} | {min(t):.0f} | {statistics.median(t):.0f} |" for name, t in rows.items()]
    return "\n".join(["| binding | ns a call, min | median |", "|---|---|---|", *lines]) + "\n"


if __name__ == "__main__":
    print(table())
