"""One door to all integrators, chosen by name. Nothing here knows what a rod is."""

import warnings
from collections.abc import Sequence
from functools import partial
from importlib import import_module
from math import isfinite

import numpy as np

from geocosserat.kernel.contract import Array, Balance, Kernel, is_native
from geocosserat.solver.consistent import consistent
from geocosserat.solver.cvode_native import cvode_native
from geocosserat.solver.diagonal import GAMMAS, diagonal
from geocosserat.solver.ida_native import ida_native
from geocosserat.solver.pieces import in_pieces
from geocosserat.solver.radau_native import LARGEST, radau_native
from geocosserat.solver.reduced import Integrator, reduced
from geocosserat.solver.sundials import sundials
from geocosserat.solver.trajectory import Frame, Progress, Trajectory

METHODS = ("cvode", "radau", "bdf", "lsoda")
LAST_RESORTS = tuple(GAMMAS)
"""Methods that are slow, for what the others cannot do; see diagonal.py."""


def _silent(*_: object) -> None:
    pass


def _onwards(*_: object) -> bool:
    return False


def integrate(
    kernel: Kernel,
    start: Array,
    times: Array,
    method: str = "cvode",
    rtol: float = 1e-6,
    atol: float | Array = 1e-9,
    progress: Progress = _silent,
    frame: Frame = _onwards,
    switches: Sequence[float] = (),
    balance: Balance | None = None,
) -> Trajectory:
    """Integrates y' = f(t, y) from `start` (size,) at times[0]; states at all of `times` (T >= 2, increasing).

    rtol, and atol for all or for each state entry (in its own unit), bound the local error of a step. A run that
    cannot go on returns what it has, with the reason; it never raises for numerical trouble. switches: instants at
    which the rate jumps; no step reaches over one. Entries that constraints fix need no value at the start. balance:
    that of an energy which is no square; the last resorts keep it.

    Raises ValueError for an unknown method, or a start that is not finite.
    """
    known = (*METHODS, *LAST_RESORTS)
    if method not in known:
        raise ValueError(f"expected a method out of {', '.join(known)}, found {method!r}")
    with np.errstate(over="ignore"):
        quick = start.dot(start)  # may overflow
    if not isfinite(quick) and not np.isfinite(start).all():
        raise ValueError("expected a finite initial state, found infinities or NaN; check the start of the scene")
    tolerance = np.empty(start.shape)
    if isinstance(atol, float):
        tolerance.fill(atol)  # several times as fast as what follows
    else:
        tolerance[:] = atol
    chosen = _chosen(method, kernel, balance)

    def piece(y: Array, instants: Array, told: Progress, noted: Frame) -> Trajectory:
        return chosen(kernel, y, instants, rtol, tolerance, told, noted)

    if chosen is radau_native:  # begins where the constraints hold by itself, and warns of nothing
        return in_pieces(piece, start, times, switches, progress, frame)
    with np.errstate(all="ignore"):  # what goes wrong becomes the reason of the trajectory
        begun = _begun(kernel, float(times[0]), start)
        if isinstance(begun, str):
            return Trajectory(times[:1].copy(), start[None].copy(), 1, 0, 0, False, begun)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            return in_pieces(piece, begun, times, switches, progress, frame)


def _begun(kernel: Kernel, t: float, start: Array) -> Array | str:
    """The start as the constraints have it, or why there is none."""
    rate = np.empty_like(start)
    kernel.rate(t, start, rate)
    if not np.isfinite(rate).all():
        return "the rate is not finite at the start"
    try:
        return consistent(kernel, t, start, blocks=True, gap=rate)
    except np.linalg.LinAlgError:
        return "the constraints have no solution"


def _chosen(method: str, kernel: Kernel, balance: Balance | None) -> Integrator:
    """The integrator of that name. SUNDIALS is called directly where kernel and installation allow it: CVODE, or IDA
    where there are constraints. Radau is our own for compiled kernels, scipy's for others."""
    native = is_native(type(kernel))
    if method == "radau" and native and kernel.size <= LARGEST:
        return radau_native
    constrained = bool(kernel.algebraic.any())
    if method == "cvode" and native:
        library = sundials("IDA" if constrained else "CVode")
        if library is not None:
            return partial(ida_native if constrained else cvode_native, library)
    if method in GAMMAS:  # takes constraints as they are
        return diagonal(method, balance)
    found = _integrator("cvode", "cvode") if method == "cvode" else _integrator("scipy_methods", method)
    return reduced(found) if constrained else found


def _integrator(module: str, name: str) -> Integrator:
    """An integrator, imported when it is first asked for: scipy and scikit-sundae start slowly."""
    found: Integrator = getattr(import_module(f"geocosserat.solver.{module}"), name)
    return found
