"""The simulation that a scene asks for: at its own setting, or at the one that a plan finds for its accuracy."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

import numpy as np

from geocosserat.conductor.simulate import (
    Attempt,
    Simulator,
    chosen_setting,
    drift,
    growth,
    misplaced,
    turned,
    unbalanced,
)
from geocosserat.conductor.undetermined import undetermined, yielded
from geocosserat.discretisation.mesh import Array, Mesh
from geocosserat.discretisation.sampling import frictionless, left_of_friction
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.model.errors import InputError
from geocosserat.model.records import Scene
from geocosserat.planning.gap import position_gap
from geocosserat.planning.plan import Choice, Errors, Level, Verdict, plan
from geocosserat.planning.resolution import Resolution
from geocosserat.planning.settings import (
    DEFAULT_ACCURACY,
    HABITS,
    LARGEST_DENSE,
    ROUND_OFF,
    SIZES,
    Setting,
    most_decades,
    predicted,
    tolerance,
)
from geocosserat.results.checkpoint import Keeper
from geocosserat.solver.integrate import LAST_RESORTS

LEDGER = 10.0
"""What the balance of energy may lack, in units of the accuracy."""


LONGEST_TURN = 1.0
"""By how many radians a rod may turn in a step that is loose: what turns with it or stays behind may be passed over,
and two runs whose steps pass over it agree."""

FASTEST = 5.0
"""What may grow in a loose run where it ends, as a power of e over its time: long steps stay in an unstable state."""

CLOSE, CLOSEST = 1e-6, 1e-8
"""Tolerances that are not loose where they are below the accuracy too: for what turns, and for what grows."""

YIELD = 0.1
"""Of the accuracy, or of the default one if that is less: what goes aside by more, by what frozen modes yield, carries
a stress that the yielding determines, if nothing else does."""

BLIND = 0.1
"""A mesh that misses so large a part of something that varies along the rod has not seen it: no run on it counts."""


@dataclass(frozen=True, eq=False)
class Found:
    """The attempt to report; the estimate of its error relative to the length, None where nothing is known of it;
    whether that is small enough, and if not, why; how each run of the plan was made, in their order."""

    attempt: Attempt
    estimate: float | None
    reached: bool
    reason: str
    plan: tuple[Mapping[str, Any], ...]


@dataclass(frozen=True, eq=False)
class Outcome:
    """What a plan compares: the rod at the end, positions (nodes, space), empty if the run did not come to its end; how
    far a held end strayed, or nodes from where strains put them, a length; what the balance of energy lacks, relative
    to its largest term."""

    mesh: Mesh
    positions: Array
    strayed: float
    unbalanced: float


def search(simulate: Simulator, keeper: Keeper) -> Found:
    """Simulates the scene; spends less on finding out how than on doing it, as far as orders can foretell."""
    scene, seconds = simulate.scene, simulate.clock.seconds
    chosen = chosen_setting(scene)
    if chosen is not None:
        attempt = simulate(chosen, scene.run.frames, partial(keeper.begin, 0), keeper.keep)
        seconds["solve"] = attempt.seconds
        return Found(attempt, None, attempt.trajectory.reached, attempt.trajectory.reason, ())
    found = planned(simulate, keeper, scene.run.accuracy or DEFAULT_ACCURACY)
    seconds["solve"] = found.attempt.seconds
    seconds["plan"] = sum(run["seconds"] for run in found.plan) - found.attempt.seconds
    return found


def planned(simulate: Simulator, keeper: Keeper, accuracy: float) -> Found:
    """The simulation that a plan finds for an accuracy, whatever the scene says of it."""
    return _Search(simulate, keeper, accuracy).found()


class _Search:
    def __init__(self, simulate: Simulator, keeper: Keeper, accuracy: float) -> None:
        self.simulate, self.keeper, self.accuracy = simulate, keeper, accuracy
        self.scene = simulate.scene
        self.resolution = Resolution(self.scene)
        self.first = self._first()
        self.outcomes: list[Outcome] = []
        self.settings: list[Setting] = []
        self.runs: list[dict[str, Any]] = []

    def found(self) -> Found:
        # of the model itself: rotations without friction keep a little of it
        modelled = left_of_friction(self.scene.run) if frictionless(self.scene.model) else 0.0
        points = tuple(elements * degree for elements, degree in SIZES)
        choice = Choice(
            points, lambda size: most_decades(self._method(size), self.accuracy), self._method, self._lands
        )
        wanted = self.accuracy - modelled if self.accuracy > 1.05 * modelled else modelled
        steps = plan(wanted, choice, Errors(self._gap, self._strayed, self._unbalanced), self.first)
        request = next(steps)
        whole: dict[int, Attempt] = {}  # the last two that may be kept
        while True:
            number, attempt = len(self.outcomes), self._run(request.level, request.whole)
            if request.whole and attempt is not None:
                whole[number] = attempt
                for old in list(whole)[:-2]:
                    del whole[old]
            try:
                request = steps.send(bool(self.outcomes[-1].positions.size))
            except StopIteration as end:
                verdict: Verdict = end.value
                break
        kept = whole.get(verdict.kept)
        if kept is None:  # its states were given up before an interruption
            kept = self.simulate(self.settings[verdict.kept], self.scene.run.frames)
        estimate = None if verdict.estimate is None else max(verdict.estimate + modelled, ROUND_OFF)
        setting, part = kept.setting, max(BLIND, self.accuracy**0.5)
        blind = not self.resolution.sees_all(setting.elements, setting.degree, self.accuracy, part)
        reached = verdict.reached and not blind and estimate is not None and estimate <= self.accuracy
        if reached and yielded(kept) > YIELD * min(self.accuracy, DEFAULT_ACCURACY):
            reached = not undetermined(kept)
        last = next(reversed(whole.values()), kept)
        return Found(kept, estimate, reached, _reason(kept, last, estimate, reached, modelled, blind), tuple(self.runs))

    def _run(self, level: Level, whole: bool) -> Attempt | None:
        """One more run of the plan; None where no more is needed than what is known from before an interruption."""
        number, setting = len(self.outcomes), self._setting(level)
        known = self.keeper.ended(number)
        attempt = None
        if known is None or (whole and self.keeper.holds(number)):
            attempt = self._simulated(number, setting, whole)
        if known is None:
            assert attempt is not None
            known = _left(self.scene, attempt, self.accuracy)
            self.keeper.end(known)
        mesh = attempt.rod.mesh if attempt else discretise(self.scene, setting.elements, setting.degree).mesh
        if known.shape not in ((1, self.scene.model.group.space), (len(mesh.u) + 1, self.scene.model.group.space)):
            raise InputError(f"{len(mesh.u)} positions", f"{len(known) - 1}", "start without --resume", key="--resume")
        self.outcomes.append(Outcome(mesh, known[1:], float(known[0, 0]), float(known[0, 1])))
        self.settings.append(setting)
        taken = attempt.seconds if attempt else 0.0
        self.runs.append({**asdict(setting), "whole": whole, "seconds": taken, "predicted": self._predicted(setting)})
        return attempt

    def _simulated(self, number: int, setting: Setting, whole: bool) -> Attempt:
        if not whole:
            return self.simulate(setting, 2)
        return self.simulate(setting, self.scene.run.frames, partial(self.keeper.begin, number), self.keeper.keep)

    def _setting(self, level: Level) -> Setting:
        method = self._method(level.size)
        return Setting(*SIZES[level.size], tolerance(method, self.accuracy, level.decades), method)

    def _method(self, size: int) -> str:
        """The integrator that the scene names, or the one that takes least for a rod of that size."""
        if self.scene.run.method is not None:
            return self.scene.run.method
        elements, degree = SIZES[max(size, self.first + 1)]  # the first run is there to be compared with the second
        unknowns = elements * degree * (self.scene.model.group.dimension - len(self.scene.model.frozen))
        return "radau" if self.simulate.backend == "c" and unknowns <= LARGEST_DENSE else "cvode"

    def _lands(self, size: int) -> bool:
        """Whether frames between the first and the last end steps of the integrator, which others interpolate."""
        return self._method(size) in LAST_RESORTS and self.scene.run.frames > 2

    def _predicted(self, setting: Setting) -> float | None:
        """Seconds that a run at a setting should take, by the last one that the same method has made."""
        for run in reversed(self.runs):
            if run["method"] == setting.method and run["seconds"]:
                other = Setting(run["elements"], run["degree"], run["rtol"], run["method"])
                return predicted(setting, other, run["seconds"])
        return None

    def _first(self) -> int:
        """The first size that notices everything the scene varies along the rod; but not the last one of all."""
        sizes = range(len(SIZES) - 2)
        return next((k for k in sizes if self.resolution.sees_all(*SIZES[k], self.accuracy)), len(SIZES) - 2)

    def _gap(self, coarse: int, fine: int) -> float:
        one, other = self.outcomes[coarse], self.outcomes[fine]
        return position_gap(one.mesh, one.positions, other.mesh, other.positions) / self.scene.model.length

    def _strayed(self, number: int) -> float:
        return self.outcomes[number].strayed / self.scene.model.length

    def _unbalanced(self, number: int) -> float:
        """An error in time: rods that settle forget theirs, and the energies that led there do not."""
        return self.outcomes[number].unbalanced / LEDGER


def _left(scene: Scene, attempt: Attempt, accuracy: float) -> Array:
    """Where a run left the rod, as one array: how far it strayed and what the balance of energy lacks, in a row of
    their own, then positions (nodes, space), if any. A balance that steps have passed over lacks all."""
    rod, trajectory = attempt.rod, attempt.trajectory
    space = rod.structure.group.space
    if not trajectory.reached:
        return np.zeros((1, space))
    positions = rod.poses(trajectory.states[-1], trajectory.times[-1]).position
    first = np.zeros((1, space))
    astray = max(drift(rod, trajectory), misplaced(rod, trajectory))
    first[0, :2] = astray, LEDGER if _passed_over(attempt, accuracy) else unbalanced(scene, attempt)
    return np.concatenate([first, positions])


def _passed_over(attempt: Attempt, accuracy: float) -> bool:
    """Whether steps may have passed over something, of a method that makes long ones, whatever two such runs agree on:
    of any but CVODE, whose steps are so short at the tolerances it begins with that they see what grows."""
    setting = attempt.setting
    if setting.method == "cvode":
        return False
    if setting.method == "radau" and setting.rtol > min(CLOSE, accuracy) and turned(attempt) > LONGEST_TURN:
        return True
    return setting.rtol > min(CLOSEST, accuracy) and growth(attempt) > FASTEST


def _reason(
    kept: Attempt, last: Attempt, estimate: float | None, reached: bool, modelled: float, blind: bool
) -> str:
    """Why the accuracy was not reached; last: the last run that might have had it; modelled: what no run can have;
    blind: whether there is something that the run did not see."""
    if reached:
        return ""
    if blind and kept.trajectory.reached:
        return "something that varies along the rod is too narrow for the finest mesh; see run.elements"
    free = undetermined(kept)
    if not kept.trajectory.reached:
        return "; ".join(filter(None, (kept.trajectory.reason, free)))
    if not last.trajectory.reached:
        why = f"a finer run, for the accuracy asked for, did not come to its end: {last.trajectory.reason}"
        return "; ".join(filter(None, (why, free)))
    if free:
        return free
    if estimate is not None and modelled > 0.3 * estimate:
        return f"rotations without friction are a limit, of which {modelled:.1g} is left; ask for a larger error"
    if estimate is not None and kept.setting.rtol <= HABITS[kept.setting.method].least:
        return f"the accuracy asked for is below round-off: at the least tolerance, about {estimate:.1g} is left"
    return "the accuracy asked for was not reached by refinement"
