"""The same linear algebra where matrices would be too large: by the kernel's elimination, linear in its elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigs

from geocosserat.kernel.contract import Array
from geocosserat.statics.pencil import Complex

if TYPE_CHECKING:
    from geocosserat.statics.system import System

COUNT = 12
"""Growth rates that are looked for, those nearest to the slowest one."""

LONG = 1e8
"""A step of the implicit Euler method so long, times the rate of the rod, is one of Newton's."""


class Sparse:
    """M z' = J z at a state x of a system, as `Linear`; J is never written down."""

    def __init__(self, system: System, x: Array) -> None:
        self.system, self.kernel = system, system.kernel
        self.moves = system.kernel.algebraic[system.kept] == 0.0
        self.kernel.prepare(0.0, system.state(x))
        self._factored: float | None = None

    def step(self, f: Array, rate: float = 0.0) -> Array:
        """(n,) the step d with (rate M - J) d = f."""
        time = 1.0 / max(rate, self.system.rate / LONG)
        return self._solve(np.where(self.moves, time * f, -f), time)

    def unmet(self, f: Array, step: Array) -> Array:
        """Nothing: what nothing resists is taken to drift, not to be left."""
        return np.zeros_like(f)

    def bordered(self, column: Array, row: Array, corner: float, f: Array, g: float) -> tuple[Array, float]:
        """(d, e) with -J d - column e = f and row d + corner e = g, by elimination of d."""
        by_f, by_e = self.step(f), self.step(column)
        e = (g - float(row @ by_f)) / (corner + float(row @ by_e))
        return by_f + e * by_e, e

    def spectrum(self, rate: float) -> tuple[Complex, Complex]:
        """Growth rates (k,) nearest to a slow one, the fastest growing first, and the motions (n, k)."""
        n, time = len(self.moves), 1.0 / rate

        def inverse(z: Array) -> Array:
            return self._solve(np.where(self.moves, z.ravel(), 0.0), time)

        operator = LinearOperator((n, n), matvec=inverse, dtype=float)
        start = np.cos(np.arange(n) ** 1.5)  # the same at every call, and like no motion
        try:
            found, vectors = eigs(operator, k=COUNT, which="LM", v0=start)
        except ArpackNoConvergence as error:
            found, vectors = error.eigenvalues, error.eigenvectors
        growth = (1.0 - 1.0 / found) / time
        order = np.lexsort((-growth.imag, -growth.real))
        return growth[order], vectors[:, order]

    def _solve(self, b: Array, time: float) -> Array:
        """M - time J, the rows of constraints as they are in J."""
        system = self.system
        if self._factored != time:
            self.kernel.factor(time)
            self._factored = time
        whole, out = np.zeros_like(system.start), np.zeros_like(system.start)
        whole[system.kept] = b * system.scale
        self.kernel.solve(whole, out)
        found: Array = out[system.kept] / system.scale
        return found
