"""IDA calling a compiled kernel directly: variable-order BDF for systems with constraints, without Python inside.

Source: A. C. Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005) 363.
"""

from typing import Any

import numpy as np

from geocosserat.kernel.contract import Array, Kernel
from geocosserat.solver.consistent import consistent
from geocosserat.solver.session import NORMAL, Session
from geocosserat.solver.sundials import Sundials
from geocosserat.solver.trajectory import Frame, Progress, Trajectory


def ida_native(
    library: Sundials,
    kernel: Kernel,
    start: Array,
    times: Array,
    rtol: float,
    atol: Array,
    progress: Progress,
    frame: Frame,
) -> Trajectory:
    """Integrates a NativeKernel with constraints from times[0] through all of `times`; see `integrate`."""
    t = float(times[0])
    begun = consistent(kernel, t, start, blocks=True)  # anew, for constraints may switch
    with _Ida(library, kernel, begun, t, rtol, atol) as session:
        return session.integrate(times, progress, frame)


class _Ida(Session):
    name = "IDA"
    rate_count, system_setter, current = "ResEvals", "SetJacFn", "IDAGetCurrentCj"

    def create(self, t: float) -> Any:
        return self.lib.IDACreate(self.context)

    def begin(self, t: float) -> None:
        self.slope = np.empty_like(self.y)
        self.kernel.rate(t, self.y, self.slope)
        differential = 1.0 - self.kernel.algebraic
        self.slope *= differential
        slope, moves = self.vector(self.slope), self.vector(differential)
        self.slopes = slope
        residual = self.pointer(self.callbacks.residual)
        self._check(self.lib.IDAInit(self.memory, residual, t, self.state, slope))
        self._check(self.lib.IDASetId(self.memory, moves))
        # the steps are chosen for what moves; stresses that hold a constraint follow from it
        self._check(self.lib.IDASetSuppressAlg(self.memory, 1))

    def linear(self) -> tuple[int, int]:
        return self.callbacks.residual_system, self.callbacks.residual_solve

    def advance(self, until: float, reached: Any) -> int:
        return int(self.lib.IDASolve(self.memory, until, reached, self.state, self.slopes, NORMAL))
