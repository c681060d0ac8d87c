"""Linear algebra of a rod near a state: steps towards rest, along a path, and the growth of small motions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack, lstsq

from geocosserat.kernel.contract import Array
from geocosserat.statics.pencil import Complex, growth

SINGULAR = 1e-11
"""Reciprocal condition number below which equations leave motions open; of all solutions the smallest is taken."""


@dataclass(frozen=True, eq=False)
class Linear:
    """M z' = J z, where M is the identity on what moves and zero on what constraints fix.

    J (m, m), a rate (1 / time); moves (m,); basis (n, m): orthonormal columns, the motions in coordinates of a System.
    closing (k, n), and lost (m, k): how the gap of a closed rod changes, which is to vanish beside the rates; and what
    of the rates is zero whatever the rod does, since it stays closed.
    """

    J: Array
    moves: NDArray[np.bool_]
    basis: Array
    closing: Array
    lost: Array

    def step(self, f: Array, rate: float = 0.0) -> Array:
        """(n,) the step d with (rate M - J) d = f: of Newton's method, or with a rate that of an implicit Euler method
        whose step in time is one over it. f (n + k,): rates, and the gap."""
        J = self._whole()
        J[: len(self.J)] -= rate * np.diag(self.moves.astype(float))
        return self.basis @ _solved(-J, self._rows(f))

    def unmet(self, f: Array, step: Array) -> Array:
        """(m + k,) what of f the step of Newton's method does not take away."""
        return self._rows(f) + self._whole() @ (self.basis.T @ step)

    def bordered(self, column: Array, row: Array, corner: float, f: Array, g: float) -> tuple[Array, float]:
        """(d, e) with -J d - column e = f and row d + corner e = g; column and f are (n + k,), row and d (n,)."""
        A = np.block([[-self._whole(), -self._rows(column)[:, None]], [(row @ self.basis)[None], np.array([[corner]])]])
        found = _solved(A, np.append(self._rows(f), g))
        return self.basis @ found[:-1], float(found[-1])

    def spectrum(self, rate: float) -> tuple[Complex, Complex]:
        """Growth rates (k,) of small motions, the fastest growing first, and the motions (n, k). rate: about that of
        the slowest one."""
        m, k = self.lost.shape
        M = np.diag(np.append(self.moves, np.zeros(k)).astype(float))
        # what is lost has no rate of its own: a multiplier takes its place
        K = np.block([[self.J, self.lost], [self.lost.T * self.moves, np.zeros((k, k))]])
        found, vectors = growth(K, M, rate)
        return found, self.basis @ vectors[:m]

    def _whole(self) -> Array:
        return np.concatenate([self.J, self.closing @ self.basis])

    def _rows(self, f: Array) -> Array:
        n = len(self.basis)
        return np.concatenate([self.basis.T @ f[:n], f[n:]])


def _solved(A: Array, b: Array) -> Array:
    """A solution of A x = b, the least one if there are many.

    Raises numpy.linalg.LinAlgError if an entry is not finite.
    """
    if not (np.isfinite(A).all() and np.isfinite(b).all()):
        raise np.linalg.LinAlgError("the equations are not finite")
    rows = np.abs(A).max(axis=1)
    rows[rows == 0.0] = 1.0
    A, b = A / rows[:, None], b / rows
    if len(A) == A.shape[1]:
        lu, pivots, failed = lapack.dgetrf(A)
        if not failed and lapack.dgecon(lu, np.abs(A).sum(axis=0).max())[0] > SINGULAR:
            x: Array = lapack.dgetrs(lu, pivots, b)[0]
            return x
    least: Array = lstsq(A, b, cond=SINGULAR)[0]
    return least
