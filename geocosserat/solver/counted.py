"""A kernel with its calls counted."""

import numpy as np

from geocosserat.kernel.contract import Array, Kernel


class Counted:
    """Counts what an integrator asks of a kernel.

    instants: times at which the rate was asked for, one after the other different: the steps tried.
    """

    def __init__(self, kernel: Kernel) -> None:
        self.kernel = kernel
        self.rates = 0
        self.jacobians = 0
        self.instants = 0
        self._last = float("nan")

    def rate(self, t: float, y: Array, out: Array) -> None:
        """See Kernel.rate."""
        self.rates += 1
        if t != self._last:
            self.instants += 1
            self._last = t
        self.kernel.rate(t, y, out)

    def jacobian(self, t: float, y: Array) -> Array:
        """See Kernel.jacobian.

        Raises FloatingPointError if it is not finite, which no integrator looks for.
        """
        self.jacobians += 1
        J = self.kernel.jacobian(t, y)
        if not np.all(np.isfinite(J)):
            raise FloatingPointError(f"the Jacobian is not finite at t = {t:.6g}")
        return J

    def prepare(self, t: float, y: Array) -> None:
        """See Kernel.prepare."""
        self.jacobians += 1
        self.kernel.prepare(t, y)
