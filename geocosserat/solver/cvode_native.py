"""CVODE calling a compiled kernel directly. The same method and settings as `cvode`, without Python inside.

Source: A. C. Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005) 363.
"""

from typing import Any

from geocosserat.kernel.contract import Array, Kernel
from geocosserat.solver.session import NORMAL, Session
from geocosserat.solver.sundials import Sundials
from geocosserat.solver.trajectory import Frame, Progress, Trajectory

BDF = 2


def cvode_native(
    library: Sundials,
    kernel: Kernel,
    start: Array,
    times: Array,
    rtol: float,
    atol: Array,
    progress: Progress,
    frame: Frame,
) -> Trajectory:
    """Integrates a NativeKernel from times[0] through all of `times`; see `integrate`."""
    with _Cvode(library, kernel, start, float(times[0]), rtol, atol) as session:
        return session.integrate(times, progress, frame)


class _Cvode(Session):
    name = "CVODE"
    rate_count, system_setter, current = "RhsEvals", "SetLinSysFn", "CVodeGetCurrentGamma"

    def create(self, t: float) -> Any:
        return self.lib.CVodeCreate(BDF, self.context)

    def begin(self, t: float) -> None:
        self._check(self.lib.CVodeInit(self.memory, self.pointer(self.callbacks.rate), t, self.state))
        self._check(self.lib.CVodeSetMaxHnilWarns(self.memory, -1))  # nor do warnings appear on the terminal

    def linear(self) -> tuple[int, int]:
        return self.callbacks.system, self.callbacks.solve

    def advance(self, until: float, reached: Any) -> int:
        return int(self.lib.CVode(self.memory, until, self.state, reached, NORMAL))
