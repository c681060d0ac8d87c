"""Linear algebra of a rod near a state: steps towards rest, and how small motions grow or decay."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eig, eigvals, lapack, lstsq, solve

from geocosserat.kernel.contract import Array

Complex = NDArray[np.complex128]

SINGULAR = 1e-11
"""Reciprocal condition number below which equations leave motions open; of all solutions the smallest is taken."""

FASTEST = 1e-12
"""Slowest rate relative to those rates that shift and inversion still tells from infinite ones."""


@dataclass(frozen=True, eq=False)
class Linear:
    """M z' = J z, where M is the identity on what moves and zero on what constraints fix.

    J (m, m), a rate (1 / time); moves (m,); basis (n, m): orthonormal columns, the motions in coordinates of a System.
    """

    J: Array
    moves: NDArray[np.bool_]
    basis: Array

    def step(self, f: Array, rate: float = 0.0) -> Array:
        """(n,) the step d with (rate M - J) d = f: of Newton's method, or with a rate that of an implicit Euler method
        whose step in time is one over it."""
        A = rate * np.diag(self.moves.astype(float)) - self.J
        return self.basis @ _solved(A, self.basis.T @ f)

    def bordered(self, column: Array, row: Array, corner: float, f: Array, g: float) -> tuple[Array, float]:
        """(d, e) with -J d - column e = f and row d + corner e = g; column, row, f and d are (n,)."""
        B = self.basis
        A = np.block([[-self.J, -(B.T @ column)[:, None]], [(row @ B)[None], np.array([[corner]])]])
        found = _solved(A, np.append(B.T @ f, g))
        return B @ found[:-1], float(found[-1])

    def spectrum(self, rate: float) -> tuple[Complex, Complex]:
        """Growth rates (k,) of small motions, the fastest growing first, and the motions (n, k), of greatest entry 1.

        rate: about how slow the slowest motion is. Rates are as exact as round-off allows near it, since they are found
        from the inverse; those too fast for that are found without it, but only if they grow.
        """
        A = rate * np.diag(self.moves.astype(float)) - self.J
        rows = np.abs(A).max(axis=1)
        S = solve(A / rows[:, None], np.eye(len(A))[:, self.moves] / rows[:, None])
        mu, vectors = eig(S[self.moves])
        slow = np.abs(mu) > FASTEST * np.abs(mu).max()
        growth = rate - 1.0 / mu[slow]
        motions = S @ vectors[:, slow]
        fast, theirs = self._fast_growth(np.abs(growth).max())
        growth, motions = np.concatenate([growth, fast]), np.concatenate([motions, theirs], axis=1)
        order = np.lexsort((-growth.imag, -growth.real))
        motions = self.basis @ motions[:, order]
        largest = motions[np.abs(motions).argmax(axis=0), np.arange(motions.shape[1])]
        return growth[order], motions / largest

    def _fast_growth(self, beyond: float) -> tuple[Complex, Complex]:
        """Rates of growth above `beyond` and their motions (m, k)."""
        m, fixed = self.moves, ~self.moves
        J = self.J[np.ix_(m, m)]
        follow = np.zeros((int(fixed.sum()), int(m.sum())))
        if fixed.any():
            follow = -solve(self.J[np.ix_(fixed, fixed)], self.J[np.ix_(fixed, m)])
            J = J + self.J[np.ix_(m, fixed)] @ follow
        if eigvals(J).real.max() <= beyond:
            return np.empty(0, dtype=complex), np.empty((len(m), 0), dtype=complex)
        growth, vectors = eig(J)
        chosen = growth.real > beyond
        motions = np.empty((len(m), int(chosen.sum())), dtype=complex)
        motions[m], motions[fixed] = vectors[:, chosen], follow @ vectors[:, chosen]
        return growth[chosen], motions


def _solved(A: Array, b: Array) -> Array:
    """A solution of A x = b, the least one if there are many.

    Raises numpy.linalg.LinAlgError if an entry is not finite.
    """
    if not (np.isfinite(A).all() and np.isfinite(b).all()):
        raise np.linalg.LinAlgError("the equations are not finite")
    rows = np.abs(A).max(axis=1)
    rows[rows == 0.0] = 1.0
    A, b = A / rows[:, None], b / rows
    lu, pivots, failed = lapack.dgetrf(A)
    if not failed and lapack.dgecon(lu, np.abs(A).sum(axis=0).max())[0] > SINGULAR:
        x: Array = lapack.dgetrs(lu, pivots, b)[0]
        return x
    least: Array = lstsq(A, b, cond=SINGULAR)[0]
    return least
