"""What an integrator returns, and what it may tell while it works."""

from collections.abc import Callable
from dataclasses import dataclass

from geocosserat.kernel.contract import Array

Progress = Callable[[float, int], None]
"""Called with the fraction of the time span done and the number of steps so far."""

Frame = Callable[[int, Array, int], bool]
"""Called with the number and the state (size,) of each instant of output that is reached, and the steps so far.
What it returns says whether to pause there."""


@dataclass(eq=False, slots=True)  # frozen, it would take a microsecond to make
class Trajectory:
    """States at the instants asked for.

    times (T,), states (T, size): up to the last instant that was reached. reached: whether that is the last one
    asked for; otherwise `reason` says why not, or is empty if it was told to pause. Counts: calls of the rate, of the
    Jacobian, steps tried.
    """

    times: Array
    states: Array
    rates: int
    jacobians: int
    steps: int
    reached: bool
    reason: str = ""
