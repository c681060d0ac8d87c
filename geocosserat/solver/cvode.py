"""Variable-order BDF from SUNDIALS, through scikit-sundae: kernels in Python.

Small systems use dense Newton matrices. Large ones use GMRES whose preconditioner is the kernel's own block
elimination of the exact Jacobian: one or two Krylov vectors a Newton step, and memory linear in the length of the
rod. (The banded matrices of the binding would be stored in full.)

Source: A. C. Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005) 363.
"""

import os
from contextlib import redirect_stdout
from io import StringIO
from typing import Any

import numpy as np
from sksundae.cvode import CVODE, CVODEPrecond

from geocosserat.kernel.contract import Array, Kernel
from geocosserat.solver.counted import Counted
from geocosserat.solver.settings import BREATH, DENSE_LIMIT, KRYLOV, Hope, stands_still
from geocosserat.solver.trajectory import Frame, Progress, Trajectory

TOO_MUCH_WORK = -1

# SUNDIALS warns on standard error; what matters of it becomes the reason of the trajectory
os.environ.setdefault("SUNLOGGER_WARNING_FILENAME", os.devnull)


def cvode(
    kernel: Kernel, start: Array, times: Array, rtol: float, atol: Array, progress: Progress, frame: Frame
) -> Trajectory:
    """Integrates from times[0] through all of `times`; see `integrate`.

    The binding tells no step counts: distinct instants of the rate stand for the steps tried.
    """
    counted = Counted(kernel)
    options: dict[str, Any] = {"rtol": rtol, "atol": atol, "max_num_steps": BREATH}
    if kernel.size <= DENSE_LIMIT:
        options |= {"linsolver": "dense", "jacfn": _dense(counted)}
    else:
        options |= {"linsolver": "gmres", "precond": _precondition(counted), "krylov_dim": KRYLOV}
    solver = CVODE(counted.rate, **options)
    states = np.empty((len(times), kernel.size))
    states[0] = start
    solver.init_step(times[0], start)
    done, reason, t, breaths, hope = 1, "", float(times[0]), 0, Hope()
    while done < len(times):
        before = t
        try:
            with redirect_stdout(StringIO()):  # the binding prints what it also returns
                # the last instant is a hard stop: nothing behind it is ever evaluated
                result = solver.step(times[done], method="normal", tstop=float(times[-1]))
        except (ArithmeticError, np.linalg.LinAlgError) as error:
            reason = f"CVODE stopped after t = {before:.6g}: {error}"
            break
        t = float(np.ravel(result.t)[-1])
        if result.status == TOO_MUCH_WORK:
            progress((t - times[0]) / (times[-1] - times[0]), counted.instants)
            breaths += 1
            fraction = (t - times[0]) / (times[-1] - times[0])
            if stands_still(before, t, BREATH):
                reason = f"CVODE stopped at t = {t:.6g}: its steps go nowhere; the motion may be singular here"
                break
            if not hope.lost(breaths * BREATH, fraction):
                continue
            reason = f"CVODE stopped at t = {t:.6g}: {breaths * BREATH} steps did not reach the end"
            break
        if not result.success:
            reason = f"CVODE stopped at t = {t:.6g}: {result.message}"
            break
        if not np.all(np.isfinite(result.y)):
            reason = f"CVODE returned values that are not finite at t = {t:.6g}"
            break
        states[done] = result.y
        done += 1
        progress((t - times[0]) / (times[-1] - times[0]), counted.instants)
        if frame(done - 1, states[done - 1], counted.instants):
            break
    return Trajectory(
        times=times[:done].copy(),
        states=states[:done],
        rates=counted.rates,
        jacobians=counted.jacobians,
        steps=counted.instants,
        reached=done == len(times),
        reason=reason,
    )


def _dense(counted: Counted) -> Any:
    def fill(t: float, y: Array, rate: Array, J: Array) -> None:
        J[:] = counted.jacobian(t, y)

    return fill


def _precondition(counted: Counted) -> CVODEPrecond:
    """The kernel's elimination; where that fails, none: GMRES then gives up, and CVODE tries a smaller step."""
    kernel, sound = counted.kernel, True

    def setup(t: float, y: Array, rate: Array, usable: bool, renewed: list[int], gamma: float) -> None:
        nonlocal sound
        if not usable:
            counted.prepare(t, y)
        renewed[0] = int(not usable)
        try:
            kernel.factor(gamma)
            sound = True
        except np.linalg.LinAlgError:
            sound = False

    def solve(t: float, y: Array, rate: Array, b: Array, x: Array, gamma: float, tolerance: float, side: int) -> None:
        if sound:
            kernel.solve(b, x)
        if not sound or not np.all(np.isfinite(x)):
            x[:] = b

    return CVODEPrecond(setup, solve, side="left")
