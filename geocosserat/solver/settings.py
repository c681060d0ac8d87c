"""Numbers that several integrators share."""

import sys

DENSE_LIMIT = 300
"""Largest state of a kernel in numpy that is solved with dense matrices (benchmarks/linear_solvers.py)."""

KRYLOV = 10
"""Krylov vectors that GMRES may keep; with the exact preconditioner it needs one or two."""

STEP_LIMIT = 1_000_000
"""Steps after which a run gives up."""

BREATH = 500
"""Steps of CVODE between two looks at the world outside: progress, a user's interrupt, and whether it gets anywhere."""

STANDSTILL = 8 * sys.float_info.epsilon
"""Steps that are shorter, relative to the time, go nowhere: some integrators go on with them for ever."""


def stands_still(before: float, now: float, steps: int = 1) -> bool:
    """Whether so many steps hardly moved the time: the motion is singular here."""
    return now - before <= steps * STANDSTILL * abs(now)
