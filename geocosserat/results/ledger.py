"""The energy ledger: what was stored, what friction took and what was put in must balance."""

from __future__ import annotations

import sys
from dataclasses import dataclass

from geocosserat.results.solution import Solution


@dataclass(frozen=True)
class Ledger:
    """Energies in units of force x length, from the first frame to the last.

    stored       change of the elastic energy
    dissipated   energy taken by friction
    work         work done on the rod by its ends and by the effects
    residual     |stored + dissipated - work| relative to the largest of the three; 0 when all are 0
    """

    stored: float
    dissipated: float
    work: float
    residual: float


def ledger(solution: Solution) -> Ledger:
    """Balance the work-energy identity, stored + dissipated = work, over the whole of the solution."""
    stored, dissipated, work = (
        float(series[-1] - series[0]) for series in (solution.energy, solution.dissipated, solution.work)
    )
    scale = max(abs(stored), abs(dissipated), abs(work), sys.float_info.min)
    return Ledger(stored, dissipated, work, abs(stored + dissipated - work) / scale)
