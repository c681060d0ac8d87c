"""A kernel with constraints as one without: the constraints are solved for in every evaluation.

For the integrators that know ordinary differential equations only.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from geocosserat.kernel.contract import Array, Kernel
from geocosserat.solver.consistent import consistent
from geocosserat.solver.trajectory import Frame, Progress, Trajectory

Integrator: TypeAlias = Callable[[Kernel, Array, Array, float, Array, Progress, Frame], Trajectory]


def reduced(integrator: Integrator) -> Integrator:
    """The integrator of ordinary differential equations, for kernels with constraints too."""

    def integrate(
        kernel: Kernel, start: Array, times: Array, rtol: float, atol: Array, progress: Progress, frame: Frame
    ) -> Trajectory:
        small = Reduced(kernel, start)
        whole = np.empty((len(times), kernel.size))
        whole[0] = small.whole(float(times[0]), start[small.moving])

        def note(i: int, x: Array, steps: int) -> bool:
            whole[i] = small.whole(float(times[i]), x)
            return frame(i, whole[i], steps)

        found = integrator(small, start[small.moving], times, rtol, atol[small.moving], progress, note)
        return replace(found, states=whole[: len(found.states)])

    return integrate


class Reduced:
    """The differential part of a kernel's state; the rest is found anew for each state."""

    def __init__(self, kernel: Kernel, y: Array) -> None:
        self.kernel, self.backend, self.quadratures = kernel, kernel.backend, kernel.quadratures
        self.fixed = np.flatnonzero(kernel.algebraic)
        self.moving = np.flatnonzero(kernel.algebraic == 0.0)
        self.size = len(self.moving)
        self.algebraic = np.zeros(self.size)
        self._last = y.copy()

    def whole(self, t: float, x: Array) -> Array:
        """The state of the kernel for the differential part `x`."""
        self._last[self.moving] = x
        self._last = consistent(self.kernel, t, self._last)
        return self._last

    def rate(self, t: float, x: Array, out: Array) -> None:
        """See Kernel.rate."""
        rate = np.empty(len(self._last))
        self.kernel.rate(t, self.whole(t, x), rate)
        out[:] = rate[self.moving]

    def jacobian(self, t: float, x: Array) -> Array:
        """See Kernel.jacobian: the constraints' part is eliminated."""
        J = self.kernel.jacobian(t, self.whole(t, x))
        a, b = self.moving, self.fixed
        inner = np.linalg.solve(J[np.ix_(b, b)], J[np.ix_(b, a)])
        reduced: Array = J[np.ix_(a, a)] - J[np.ix_(a, b)] @ inner
        return reduced

    def prepare(self, t: float, x: Array) -> None:
        """See Kernel.prepare."""
        self.kernel.prepare(t, self.whole(t, x))

    def factor(self, gamma: float) -> None:
        """See Kernel.factor."""
        self.kernel.factor(gamma)

    def solve(self, b: Array, out: Array) -> None:
        """See Kernel.solve."""
        padded, x = np.zeros(len(self._last)), np.empty(len(self._last))
        padded[self.moving] = b
        self.kernel.solve(padded, x)
        out[:] = x[self.moving]
