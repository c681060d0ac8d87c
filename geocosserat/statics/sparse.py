"""The same linear algebra where matrices would be too large: by the kernel's elimination, linear in its elements."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigs

from geocosserat.kernel.contract import Array, Kernel
from geocosserat.statics.pencil import Complex

COUNT = 12
"""Growth rates that are looked for, those nearest to the slowest one."""

LONG = 1e8
"""A step of the implicit Euler method so long, times the rate of the rod, is one of Newton's."""


class Sparse:
    """M z' = J z at a state y (size,) of a kernel, as `Linear`; J is never written down. kept, scale (n,): the entries
    that matter, and their natural sizes; rate: about how fast the rod relaxes (1 / time)."""

    def __init__(self, kernel: Kernel, y: Array, kept: NDArray[np.intp], scale: Array, rate: float) -> None:
        self.kernel, self.kept, self.scale, self.rate = kernel, kept, scale, rate
        self.moves = kernel.algebraic[kept] == 0.0
        self._whole, self._found = np.zeros_like(y), np.zeros_like(y)
        self._factored: float | None = None
        kernel.prepare(0.0, y)

    def step(self, f: Array, rate: float = 0.0) -> Array:
        """(n,) the step d with (rate M - J) d = f."""
        time = 1.0 / max(rate, self.rate / LONG)
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
        if self._factored != time:
            self.kernel.factor(time)
            self._factored = time
        self._whole[self.kept] = b * self.scale
        self.kernel.solve(self._whole, self._found)
        found: Array = self._found[self.kept] / self.scale
        return found
