"""The safe method in place of one that failed."""

from collections.abc import Callable
from dataclasses import dataclass, replace

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
    failed: Trajectory, method: str, integrate: Callable[[Trajectory], Trajectory]
) -> tuple[Trajectory, FellBack | None]:
    """What another integration makes of one that did not reach the end, from its last good state on, or the same as
    before if it adds nothing. integrate: goes on from what there is."""
    whole = integrate(replace(failed, reason=""))
    if len(whole.times) == len(failed.times):
        return replace(whole, reason=f"{failed.reason}; {whole.reason}"), None
    return whole, FellBack(method, float(failed.times[-1]), failed.reason)
