"""The safe method in place of one that failed."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from geocosserat.kernel.contract import Array
from geocosserat.solver.trajectory import Trajectory

SAFE = "safe"


@dataclass(frozen=True)
class FellBack:
    """Which method failed, at what time, and why; the safe one went on from the last state before."""

    method: str
    at: float
    reason: str

    @property
    def fields(self) -> dict[str, str | float]:
        return {"from": self.method, "at": self.at, "reason": self.reason}


def rescued(
    failed: Trajectory, method: str, times: Array, integrate: Callable[[Array, Array], Trajectory]
) -> tuple[Trajectory, FellBack | None]:
    """What another integration from the last good state adds to one that did not reach the end, or the same as before
    if it adds nothing. times (T,): all that were wanted; integrate: from a state, through these times.
    """
    good = len(failed.times)
    rest = integrate(failed.states[-1], times[good - 1 :])
    counts = {name: getattr(failed, name) + getattr(rest, name) for name in ("rates", "jacobians", "steps")}
    if len(rest.times) == 1 and not rest.reached:
        return replace(failed, reason=f"{failed.reason}; {rest.reason}", **counts), None
    states = np.concatenate([failed.states[:-1], rest.states])
    whole = replace(rest, times=times[: len(states)], states=states, **counts)
    return whole, FellBack(method, float(failed.times[-1]), failed.reason)
