"""The unknowns that constraints fix, at one instant: a linear system, since stresses enter twists linearly."""

import numpy as np

from geocosserat.kernel.contract import Array, Kernel

SOLVED, SETTLED = 1e-6, 1e-9
"""Of what constraints were violated by, and of the unknowns themselves by which they changed; where more is left, the
kernel's elimination was too inaccurate."""


def consistent(kernel: Kernel, t: float, y: Array, blocks: bool = False) -> Array:
    """`y` with its algebraic entries such that the constraints hold at t.

    blocks: the kernel's elimination may be used, which forgets what it was last prepared and factored for.

    Raises numpy.linalg.LinAlgError if they have no solution.
    """
    fixed = np.flatnonzero(kernel.algebraic)
    y = y.copy()
    if not fixed.size:
        return y
    gap = np.empty_like(y)
    kernel.rate(t, y, gap)
    if blocks:
        found, left, change = y.copy(), np.empty_like(y), np.empty_like(y)
        kernel.prepare(t, y)
        kernel.factor(0.0)  # leaves what moves as it is
        kernel.solve(gap * kernel.algebraic, change)
        found[fixed] -= change[fixed]
        kernel.rate(t, found, left)
        solved = np.abs(left[fixed]).max() <= SOLVED * np.abs(gap[fixed]).max()
        if solved or np.abs(change[fixed]).max() <= SETTLED * np.abs(found[fixed]).max():
            return found
    y[fixed] -= np.linalg.solve(kernel.jacobian(t, y)[np.ix_(fixed, fixed)], gap[fixed])
    return y
