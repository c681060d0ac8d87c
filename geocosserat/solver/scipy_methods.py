"""The stiff integrators of scipy: Radau IIA of order 5, BDF, and LSODA.

Source: E. Hairer and G. Wanner, "Solving Ordinary Differential Equations II" (1996); L. Petzold,
SIAM J. Sci. Stat. Comput. 4 (1983) 136.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.integrate import BDF, LSODA, OdeSolver, Radau

from geocosserat.kernel.contract import Array, Kernel
from geocosserat.solver.counted import Counted
from geocosserat.solver.settings import LEAST_RTOL, Hope, stands_still
from geocosserat.solver.trajectory import Frame, Progress, Trajectory


def _integrate(
    method: type[OdeSolver],
    kernel: Kernel,
    start: Array,
    times: Array,
    rtol: float,
    atol: Array,
    progress: Progress,
    frame: Frame,
) -> Trajectory:
    """Integrates from times[0] through all of `times`; see `integrate`."""
    counted = Counted(kernel)
    states = np.empty((len(times), kernel.size))
    states[0] = start
    done, steps, reason, hope, paused = 1, 0, "", Hope(), False
    try:
        solver = method(
            _fresh(counted),
            times[0],
            start.copy(),
            times[-1],
            rtol=max(rtol, LEAST_RTOL),
            atol=atol,
            jac=counted.jacobian,
        )
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        return Trajectory(times[:1].copy(), states[:1], counted.rates, counted.jacobians, 0, False, str(error))
    while solver.status == "running" and done < len(times) and not paused:
        if hope.lost(steps, (solver.t - times[0]) / (times[-1] - times[0])):
            reason = f"{method.__name__} stopped at t = {solver.t:.6g}: {steps} steps did not reach the end"
            break
        try:
            message = solver.step()
        except (ArithmeticError, np.linalg.LinAlgError) as error:
            reason = f"{method.__name__} stopped at t = {solver.t:.6g}: {error}"
            break
        steps += 1
        if solver.status == "failed":
            reason = f"{method.__name__} stopped at t = {solver.t:.6g}: {message}"
            break
        # LSODA looks for neither
        if not np.all(np.isfinite(solver.y)):
            reason = f"{method.__name__} returned values that are not finite at t = {solver.t:.6g}"
            break
        if solver.status == "running" and stands_still(solver.t_old, solver.t):
            reason = f"{method.__name__} stopped at t = {solver.t:.6g}: its steps go nowhere"
            break
        interpolant = None
        while done < len(times) and times[done] <= solver.t and not paused:
            if times[done] == solver.t:
                states[done] = solver.y
            else:
                interpolant = interpolant or solver.dense_output()
                states[done] = interpolant(times[done])
            paused = bool(frame(done, states[done], steps))
            done += 1
        progress((solver.t - times[0]) / (times[-1] - times[0]), steps)
    return Trajectory(
        times[:done].copy(), states[:done], counted.rates, counted.jacobians, steps, done == len(times), reason
    )


def _fresh(counted: Counted) -> Callable[[float, Array], Array]:
    """scipy keeps the arrays it is given, so each call gets a new one."""

    def rate(t: float, y: Array) -> Array:
        out = np.empty_like(y)
        counted.rate(t, np.ascontiguousarray(y), out)
        return out

    return rate


radau, bdf, lsoda = (partial(_integrate, method) for method in (Radau, BDF, LSODA))
