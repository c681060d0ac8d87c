"""The unknowns that constraints fix, at one instant: a linear system, since stresses enter twists linearly."""

import numpy as np

from geocosserat.kernel.contract import Array, Kernel

SOLVED, SETTLED = 1e-6, 1e-9
"""Of what constraints were violated by, and of the unknowns themselves by which they changed; where more is left, the
kernel's elimination was too inaccurate."""


def consistent(kernel: Kernel, t: float, y: Array, blocks: bool = False, gap: Array | None = None) -> Array:
    """`y` with its algebraic entries such that the constraints hold at t.

    blocks: the kernel's elimination may be used, which forgets what it was last prepared and factored for. gap: the
    rate there, where it is known.

    Raises numpy.linalg.LinAlgError if they have no solution.
    """
    fixes = kernel.algebraic
    y = y.copy()
    if not fixes.any():
        return y
    if gap is None:
        gap = np.empty_like(y)
        kernel.rate(t, y, gap)
    if blocks:
        found = _by_blocks(kernel, t, y, gap * fixes)
        if found is not None:
            return found
    fixed = np.flatnonzero(fixes)
    y[fixed] -= np.linalg.solve(kernel.jacobian(t, y)[np.ix_(fixed, fixed)], gap[fixed])
    return y


def _by_blocks(kernel: Kernel, t: float, y: Array, gap: Array) -> Array | None:
    """The same by the kernel's elimination, or None if that was too inaccurate; gap: 0 but where constraints are."""
    change, left = np.empty_like(y), np.empty_like(y)
    kernel.prepare(t, y)
    kernel.factor(0.0)  # leaves what moves as it is
    kernel.solve(gap, change)
    change *= kernel.algebraic
    found = y - change
    kernel.rate(t, found, left)
    left *= kernel.algebraic
    if _largest(left) <= SOLVED * _largest(gap):
        return found
    return found if _largest(change) <= SETTLED * _largest(found * kernel.algebraic) else None


def _largest(x: Array) -> float:
    return float(np.maximum.reduce(np.abs(x)))
