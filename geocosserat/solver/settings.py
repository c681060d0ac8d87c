"""Numbers that several integrators share."""

import sys

DENSE_LIMIT = 150
"""Largest state of a kernel in numpy that is solved with dense matrices (benchmarks/linear_solvers.py)."""

KRYLOV = 10
"""Krylov vectors that GMRES may keep; with the exact preconditioner it needs one or two."""

NEWTON = 0.02
"""Share of the error test that is left to Newton's method. SUNDIALS' own 0.1 and 0.33 take as many rates on the whole,
more steps, and leave the ledger and the poses less accurate (measured on the examples)."""

STEP_LIMIT, LONGEST = 1_000_000, 100_000_000
"""Steps after which a run gives up, unless at this pace the rest takes no more than the longest may."""

BREATH = 500
"""Steps of CVODE between two looks at the world outside: progress, a user's interrupt, and whether it gets anywhere."""

STANDSTILL = 8 * sys.float_info.epsilon
"""Steps that are shorter, relative to the time, go nowhere: some integrators go on with them for ever."""

LEAST_RTOL = 100 * sys.float_info.epsilon
"""The least relative tolerance that Radau IIA takes, scipy's or our own; below it is round-off."""

SINGULAR = "the motion may be singular here"


def stands_still(before: float, now: float, steps: int = 1) -> bool:
    """Whether so many steps hardly moved the time: the motion is singular here."""
    return now - before <= steps * STANDSTILL * abs(now)


class Hope:
    """Whether a run will ever end, judged by the pace of its last steps: since their number was half of what it is.

    soon: steps before which nothing is judged, by default STEP_LIMIT; far: steps ahead that are too many, LONGEST.
    """

    def __init__(self, soon: int | None = None, far: int | None = None) -> None:
        self.soon, self.far = soon or STEP_LIMIT, far or LONGEST
        self.steps, self.fraction, self.ahead = 0, 0.0, 0.0

    def lost(self, steps: int, fraction: float) -> bool:
        """Where so many steps led to that fraction of the run."""
        if steps >= 2 * self.steps:
            made = max(fraction - self.fraction, sys.float_info.min)
            self.ahead = (1.0 - fraction) * (steps - self.steps) / made
            self.steps, self.fraction = steps, fraction
        return steps >= self.soon and self.ahead > self.far
