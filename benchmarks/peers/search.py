"""The cheapest setting of a solver that reaches an accuracy.

A solver is a function of (grid, rtol) with one or more families of grids, each from coarse to fine. For each grid,
tolerances run from loose to tight until the error stands still (the grid is then too coarse for more) or a run
takes longer than the best so far; finer grids are tried until even their loosest run takes longer. Grids that by
the last ones are far from fine enough are passed over. The best three are then timed again, in turns, and the
fastest of them counts. Errors are not monotone in the tolerance: every solver may profit from a lucky setting, ours
included.
"""

import math
import statistics
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass

STILL, DEARER, LONG, FINALISTS = 0.03, 1.3, 1.0, 3
HOPELESS, GAIN = 3.0, 0.6
Setting = tuple[Hashable, ...]
Solve = Callable[..., tuple[float, float, int]]


def _foreseen(floors: Sequence[float]) -> float:
    """The least error of the next grid if it gains what the last one did; 0 where nothing is known."""
    if len(floors) < 2 or not floors[-2] < math.inf:
        return 0.0
    return floors[-1] * min(GAIN, floors[-1] / floors[-2])


@dataclass(frozen=True)
class Found:
    """Error, least and median seconds, how, and whether the seconds are extrapolated."""

    error: float
    least: float
    median: float
    setting: Setting
    extrapolated: bool = False


class Solver:
    """One solver on one problem, remembering what it has run."""

    def __init__(
        self, solve: Solve, families: Sequence[Sequence[Setting]], rtols: Sequence[float], loosest: float = math.inf
    ) -> None:
        """loosest: tolerances above this, times the root of the error asked for, are passed over."""
        self._solve, self._families, self._rtols, self._loosest = solve, families, rtols, loosest
        self._known: dict[Setting, tuple[float, float] | None] = {}

    def cheapest(self, target: float, repeats: int) -> Found | None:
        """The fastest setting with an error of at most `target`; None if there is none among the grids."""
        good: list[tuple[float, Setting]] = []
        for family in self._families:
            floors: list[float] = []  # errors that the grids so far could not go below
            for grid in family:
                if (foreseen := _foreseen(floors)) > HOPELESS * target:
                    floors.append(foreseen)
                    continue
                errors, least = self._tried(grid, target, good)
                floors.append(min(errors, default=math.inf))
                if good and least > min(good)[0]:
                    break
        return self._timed(sorted(good)[:FINALISTS], repeats) if good else None

    def _tried(self, grid: Setting, target: float, good: list[tuple[float, Setting]]) -> tuple[list[float], float]:
        """Tries a grid with all tolerances that may be worth it: their errors, and the least of their seconds."""
        errors: list[float] = []
        least = math.inf
        for rtol in (r for r in self._rtols if r <= self._loosest * math.sqrt(target)):
            run = self._run((*grid, rtol))
            if run is None:
                errors.append(math.inf)
                continue
            error, seconds = run
            least = min(least, seconds)
            if error <= target:
                good.append((seconds, (*grid, rtol)))
            errors.append(error)
            still = len(errors) > 2 and max(abs(error - e) for e in errors[-3:]) < STILL * error
            if (good and seconds > DEARER * min(good)[0]) or (error > target and still):
                break
        return errors, least

    def _run(self, setting: Setting) -> tuple[float, float] | None:
        if setting not in self._known:
            try:
                error, seconds, _ = self._solve(*setting)
                if seconds < LONG:  # first calls are slow
                    seconds = min(seconds, self._solve(*setting)[1])
                self._known[setting] = error, seconds
            except (RuntimeError, ArithmeticError, MemoryError, Warning):
                self._known[setting] = None
        return self._known[setting]

    def _timed(self, finalists: Sequence[tuple[float, Setting]], repeats: int) -> Found:
        runs: dict[Setting, list[tuple[float, float, int]]] = {setting: [] for _, setting in finalists}
        for _ in range(repeats):  # in turns: what disturbs the machine disturbs all of them
            for setting, done in runs.items():
                done.append(self._solve(*setting))
        setting = min(runs, key=lambda s: min(run[1] for run in runs[s]))
        seconds = [run[1] for run in runs[setting]]
        return Found(runs[setting][0][0], min(seconds), statistics.median(seconds), setting)


def extrapolated(found: Found, decades: int, order: float) -> Found:
    """What an error so many decades smaller costs at least: the grid, or the steps, of an order grow as they must for
    it, and the other one of the two stays as it is."""
    factor = 10.0 ** (decades / order)
    return Found(found.error * 10.0**-decades, found.least * factor, found.median * factor, found.setting, True)
