"""One door to all integrators, chosen by name. Nothing here knows what a rod is."""

from importlib import import_module
from typing import Any

import numpy as np

from geocosserat.kernel.contract import Array, Kernel, NativeKernel
from geocosserat.solver.cvode_native import cvode_native
from geocosserat.solver.sundials import sundials
from geocosserat.solver.trajectory import Progress, Trajectory

METHODS = ("cvode", "radau", "bdf", "lsoda")


def _silent(fraction: float, steps: int) -> None:
    pass


def integrate(
    kernel: Kernel,
    start: Array,
    times: Array,
    method: str = "cvode",
    rtol: float = 1e-6,
    atol: float | Array = 1e-9,
    progress: Progress = _silent,
) -> Trajectory:
    """Integrates y' = f(t, y) from `start` (size,) at times[0]; states at all of `times` (T >= 2, increasing).

    rtol, and atol for all or for each state entry (in its own unit), bound the local error of a step. A run that
    cannot go on returns what it has, with the reason; it never raises for numerical trouble.

    Raises ValueError for an unknown method, or a start that is not finite.
    """
    if method not in METHODS:
        raise ValueError(f"expected a method out of {', '.join(METHODS)}, found {method!r}")
    if not np.all(np.isfinite(start)):
        raise ValueError("expected a finite initial state, found infinities or NaN; check the start of the scene")
    tolerance = np.broadcast_to(np.asarray(atol, dtype=float), start.shape).copy()
    if method != "cvode":
        return _module("scipy_methods").scipy_method(method, kernel, start, times, rtol, tolerance, progress)
    library = sundials() if isinstance(kernel, NativeKernel) else None
    if library is not None:
        return cvode_native(library, kernel, start, times, rtol, tolerance, progress)
    return _module("cvode").cvode(kernel, start, times, rtol, tolerance, progress)


def _module(name: str) -> Any:
    """An integrator's module, imported when it is first asked for: scipy and scikit-sundae start slowly."""
    return import_module(f"geocosserat.solver.{name}")
