"""Variable-order BDF from SUNDIALS, through scikit-sundae: kernels in Python.

Small systems use dense Newton matrices. Large ones use GMRES whose preconditioner is the kernel's own block
elimination of the exact Jacobian: one or two Krylov vectors a Newton step, and memory linear in the length of the
rod. (The banded matrices of the binding would be stored in full.)

Source: A. C. Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005) 363.
"""

from typing import Any

import numpy as np
from sksundae.cvode import CVODE, CVODEPrecond

from geocosserat.kernel.contract import Array, Kernel
from geocosserat.solver.counted import Counted
from geocosserat.solver.settings import DENSE_LIMIT, KRYLOV, STEP_LIMIT
from geocosserat.solver.trajectory import Frame, Progress, Trajectory


def cvode(
    kernel: Kernel, start: Array, times: Array, rtol: float, atol: Array, progress: Progress, frame: Frame
) -> Trajectory:
    """Integrates from times[0] through all of `times`; see `integrate`.

    The binding tells no step counts: distinct instants of the rate stand for the steps tried.
    """
    counted = Counted(kernel)
    options: dict[str, Any] = {"rtol": rtol, "atol": atol, "max_num_steps": STEP_LIMIT}
    if kernel.size <= DENSE_LIMIT:
        options |= {"linsolver": "dense", "jacfn": _dense(counted)}
    else:
        options |= {"linsolver": "gmres", "precond": _precondition(counted), "krylov_dim": KRYLOV}
    solver = CVODE(counted.rate, **options)
    states = np.empty((len(times), kernel.size))
    states[0] = start
    solver.init_step(times[0], start)
    done, reason = 1, ""
    for i in range(1, len(times)):
        # the last instant is a hard stop: nothing behind it is ever evaluated
        result = solver.step(times[i], method="normal", tstop=float(times[-1]))
        if not result.success:
            reason = f"CVODE stopped at t = {float(np.ravel(result.t)[-1]):.6g}: {result.message}"
            break
        states[i] = result.y
        done = i + 1
        frame(i, states[i])
        progress((times[i] - times[0]) / (times[-1] - times[0]), counted.instants)
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
    kernel = counted.kernel

    def setup(t: float, y: Array, rate: Array, usable: bool, renewed: list[int], gamma: float) -> None:
        if not usable:
            counted.prepare(t, y)
        renewed[0] = int(not usable)
        kernel.factor(gamma)

    def solve(t: float, y: Array, rate: Array, b: Array, x: Array, gamma: float, tolerance: float, side: int) -> None:
        kernel.solve(b, x)

    return CVODEPrecond(setup, solve, side="left")
