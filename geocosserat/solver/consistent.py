"""The unknowns that constraints fix, at one instant: a linear system, since stresses enter twists linearly."""

import numpy as np

from geocosserat.kernel.contract import Array, Kernel

DENSE = 600
"""Up to so many of them they are found with dense matrices."""


def consistent(kernel: Kernel, t: float, y: Array) -> Array:
    """`y` with its algebraic entries such that the constraints hold at t."""
    fixed = np.flatnonzero(kernel.algebraic)
    y = y.copy()
    if not fixed.size:
        return y
    gap, change = np.empty_like(y), np.empty_like(y)
    kernel.rate(t, y, gap)
    if fixed.size <= DENSE:
        y[fixed] -= np.linalg.solve(kernel.jacobian(t, y)[np.ix_(fixed, fixed)], gap[fixed])
    else:
        kernel.prepare(t, y)
        kernel.factor(0.0)  # leaves what moves as it is
        kernel.solve(gap * kernel.algebraic, change)
        y[fixed] -= change[fixed]
    return y
