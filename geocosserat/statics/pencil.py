"""Growth rates: K z = lambda M z, where M may be singular."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eig, lapack

from geocosserat.kernel.contract import Array

Complex = NDArray[np.complex128]

FASTEST = 1e-13
"""Slowest rate relative to those rates that are told from infinite ones."""


def growth(K: Array, M: Array, rate: float) -> tuple[Complex, Complex]:
    """Finite eigenvalues (k,) of K z = lambda M z, those of largest real part first, and their z (n, k).

    They are found from (rate M - K)^-1 M, as exactly as round-off allows where they are near `rate`: about that of the
    slowest motion. Infinite ones, of the null space of M, are zero there.

    Raises numpy.linalg.LinAlgError if an entry is not finite.
    """
    A = rate * M - K
    if not np.isfinite(A).all():
        raise np.linalg.LinAlgError("the equations are not finite")
    rows = np.abs(A).max(axis=1)
    rows[rows == 0.0] = 1.0
    acts = np.abs(M).max(axis=0) > 0.0
    lu, pivots, _ = lapack.dgetrf(A / rows[:, None])
    # of a matrix that is singular to round-off, the solution along its null vector is that large
    S = lapack.dgetrs(lu, pivots, M[:, acts] / rows[:, None])[0]
    mu, vectors = eig(S[acts])
    slow = np.abs(mu) > FASTEST * np.abs(mu).max(initial=0.0)
    found = rate - 1.0 / mu[slow]
    order = np.lexsort((-found.imag, -found.real))
    return found[order], (S @ vectors[:, slow])[:, order]
