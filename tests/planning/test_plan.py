"""A plan finds an accuracy with few runs, on errors that are made up: known, and as ill-behaved as those of rods."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import pytest

from geocosserat.planning.plan import LOST, Choice, Errors, Level, Request, Verdict, plan

POINTS = (8, 12, 16, 24, 32, 48, 64, 96, 128)
NOISE = 2.0
"""Factor by which an error may be more or less than its law."""


@dataclass
class Problem:
    """Errors in space that fall as `ratio` to the number of points, in time as the tolerance to the power `order`.

    Each points in a direction of its own, and is off its law by up to NOISE.
    """

    seed: int
    space: float = 1.0
    ratio: float = 0.5
    time: float = 1e-2
    order: float = 1.0
    noise: float = NOISE
    switch: int = len(POINTS)
    stops: tuple[int, ...] = ()
    strayed: float = 0.0
    unbalanced: float = 0.0
    blind: int = 0
    """Sizes below this one miss the motion: they are far off, and whatever the steps."""
    lost: float = 0.0
    """Decades up to which steps pass over the motion: they are off by `time`, and finer ones by less from there."""
    landed: float | None = None
    """What frames leave of most of the error in time of a run that keeps many, where that is less."""
    told: bool = True
    """Whether the plan is told that steps end at frames."""
    runs: list[Request] = field(default_factory=list)
    vectors: list[np.ndarray] = field(default_factory=list)

    def method(self, size: int) -> str:
        return "small" if size < self.switch else "large"

    def error(self, level: Level, whole: bool = False) -> np.ndarray:
        """The same for the same request, as a program's would be."""
        which = [self.seed, level.size]
        if level.size < self.blind:
            return self._off(np.random.default_rng(which), 1.0)
        in_space = np.random.default_rng(which)
        in_time = np.random.default_rng([*which, round(1000 * level.decades), level.size >= self.switch])
        space, time = self.space * self.ratio ** POINTS[level.size], self.time * 10.0 ** (-self.order * level.decades)
        if self.lost:
            time = self.time * 10.0 ** (-self.order * max(0.0, level.decades - self.lost))
            return self._off(in_space, space) + time * np.array([1.0, 0.0, 0.0, 0.0])
        if self.landed is not None:
            late = min(0.8 * time, self.landed) if whole else 0.8 * time
            return self._off(in_space, space) + self._off(in_time, 0.2 * time) + late * np.array([1.0, 0.0, 0.0, 0.0])
        return self._off(in_space, space) + self._off(in_time, time)

    def _in_time(self, decades: float) -> float:
        return LOST if decades < self.lost else self.unbalanced * 10.0**-decades

    def _off(self, chance: np.random.Generator, size: float) -> np.ndarray:
        direction = chance.normal(size=4)
        scaled: np.ndarray = size * self.noise ** chance.uniform(-1.0, 1.0) * direction / np.linalg.norm(direction)
        return scaled

    def solve(self, accuracy: float, finest: float = 12.0, first: int = 0) -> Verdict:
        """Runs the plan."""
        lands = self.told and self.landed is not None
        choice = Choice(POINTS, lambda _: finest, self.method, lambda _: lands)
        errors = Errors(
            lambda i, j: float(np.linalg.norm(self.vectors[i] - self.vectors[j])),
            lambda _: self.strayed,
            lambda i: self._in_time(self.runs[i].level.decades),
        )
        steps = plan(accuracy, choice, errors, first)
        request = next(steps)
        while True:
            self.runs.append(request)
            self.vectors.append(self.error(request.level, request.whole))
            try:
                request = steps.send(len(self.runs) - 1 not in self.stops)
            except StopIteration as end:
                verdict: Verdict = end.value
                return verdict

    def truth(self, verdict: Verdict) -> float:
        return float(np.linalg.norm(self.vectors[verdict.kept]))


def problems(count: int) -> list[Problem]:
    """Easy and hard in space, in time, in both; tolerances that act more or less than they should."""
    chance = np.random.default_rng(7)
    return [
        Problem(
            seed=seed,
            space=10.0 ** chance.uniform(-3, 1),
            ratio=math.exp(-(10.0 ** chance.uniform(-1, 0.3))),
            time=10.0 ** chance.uniform(-8, 0),
            order=chance.uniform(0.7, 1.3),
        )
        for seed in range(count)
    ]


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-9])
def test_what_is_asked_for_is_what_is_got(accuracy: float) -> None:
    """On two hundred problems: never more than three times the error, and that in less than one of twenty."""
    ratios = []
    for problem in problems(200):
        verdict = problem.solve(accuracy)
        if verdict.reached:
            assert verdict.estimate is not None
            assert verdict.estimate <= accuracy
            ratios.append(problem.truth(verdict) / accuracy)
    assert len(ratios) > 140  # the others end at the finest mesh
    assert max(ratios) < 3.0
    assert np.mean(np.array(ratios) > 1.0) < 0.05


def test_a_problem_as_foreseen_takes_two_runs() -> None:
    """One to compare with, and the one that is kept, a size and one and a half decades finer."""
    problem = Problem(seed=1, ratio=0.2, time=1e-6)
    verdict = problem.solve(1e-6, first=2)
    assert verdict.reached
    assert problem.runs == [Request(Level(2, 0.0), whole=False), Request(Level(3, 1.5), whole=True)]


def test_only_what_needs_it_is_refined() -> None:
    """Errors in time hardly touch the mesh, though gaps of two show them too; those in space leave the tolerance."""
    late = Problem(seed=2, space=1e-12, time=1e-2)
    verdict = late.solve(1e-6)
    assert verdict.reached
    assert late.runs[verdict.kept].level.size <= 3
    assert late.runs[verdict.kept].level.decades > 3
    rough = Problem(seed=3, ratio=0.75, time=1e-12)
    verdict = rough.solve(1e-6)
    assert verdict.reached
    assert rough.runs[verdict.kept].level.size > 3
    assert rough.runs[verdict.kept].level.decades == 1.5


def test_planning_takes_less_than_what_is_planned_where_orders_hold() -> None:
    """By a model of cost (points, and a fifth power of the tolerance): in the median less, and seldom twice as much."""
    shares = []
    for problem in problems(200):
        problem.noise = 1.0
        verdict = problem.solve(1e-6)
        cost = [POINTS[run.level.size] * 10.0 ** (run.level.decades / 5) for run in problem.runs]
        shares.append((sum(cost) - cost[verdict.kept]) / cost[verdict.kept])
    assert np.median(shares) < 1.0
    assert np.mean(np.array(shares) > 2.5) < 0.05


def test_another_method_is_compared_with_itself_only() -> None:
    """Where the size calls for one, its first run is compared with nothing, and its tolerance begins anew."""
    problem = Problem(seed=4, ratio=0.75, time=1e-7, switch=3)
    verdict = problem.solve(1e-6)
    assert verdict.reached
    large = [run.level for run in problem.runs if problem.method(run.level.size) == "large"]
    assert large[0].decades == 0.0
    assert large[1].decades > 0.0
    assert problem.truth(verdict) < 1e-6


def test_a_rough_run_that_fails_is_made_up_for() -> None:
    """The next one has nothing to be compared with; the one after that has."""
    problem = Problem(seed=5, ratio=0.2, time=1e-6, stops=(0,))
    verdict = problem.solve(1e-4)
    assert verdict.reached
    assert verdict.kept == 2


def test_a_run_that_stops_ends_the_plan() -> None:
    """What it left is kept, and nothing is claimed."""
    assert Problem(seed=6, stops=(1,)).solve(1e-6) == Verdict(1, None, False)
    assert Problem(seed=6, stops=(0, 1)).solve(1e-6) == Verdict(1, None, False)


def test_a_finer_run_that_stops_leaves_the_one_before() -> None:
    """Which came to its end, with its own error."""
    problem = Problem(seed=8, time=1e-2, stops=(3,))
    verdict = problem.solve(1e-9)
    assert (verdict.kept, verdict.reached) == (1, False)
    assert verdict.estimate is not None
    assert problem.truth(verdict) < verdict.estimate < 1e-1


def test_an_error_that_stays_is_reported() -> None:
    """Where neither finer meshes nor finer tolerances exist; the estimate says how far it went."""
    problem = Problem(seed=8, time=1e-2)
    verdict = problem.solve(1e-9, finest=3.0)
    assert not verdict.reached
    assert verdict.estimate is not None
    assert 1e-9 < verdict.estimate < 1e-3
    assert problem.runs[verdict.kept].level.decades == 3.0


def test_an_error_that_is_known_counts_whatever_runs_say_of_each_other() -> None:
    """Two runs that agree to all digits may both have lost the far end."""
    verdict = Problem(seed=9, strayed=2e-6, time=1e-9).solve(1e-6, first=3)
    assert not verdict.reached
    assert verdict.estimate is not None
    assert verdict.estimate >= 2e-6
    assert Problem(seed=9, strayed=5e-7, time=1e-9).solve(1e-6, first=3).reached


def test_energies_that_do_not_balance_tighten_the_tolerance() -> None:
    """A rod that has settled is where it belongs whatever its steps were; its energies are not."""
    settled = Problem(seed=11, space=1e-12, time=1e-12, unbalanced=1e-3)
    verdict = settled.solve(1e-6)
    assert verdict.reached
    assert settled.runs[verdict.kept].level.size == 1
    assert settled.runs[verdict.kept].level.decades > 2.5


def test_the_same_problem_is_planned_in_the_same_way() -> None:
    """No clock, no chance: a run that is taken up again goes the way it went."""
    first, second = Problem(seed=10, ratio=0.7), Problem(seed=10, ratio=0.7)
    assert first.solve(1e-7) == second.solve(1e-7)
    assert first.runs == second.runs


def test_steps_on_a_mesh_that_misses_the_motion_tell_nothing() -> None:
    """A rod that only a fine mesh lets become unstable: its error in time is found there, not where there is none."""
    for seed in range(20):
        problem = Problem(seed, space=1e-3, ratio=0.1, time=1.0, blind=2)
        verdict = problem.solve(1e-4)
        assert verdict.reached
        assert problem.truth(verdict) < 1e-4


def test_steps_that_pass_over_the_motion_tell_nothing_of_shorter_ones() -> None:
    """The gap from a run that stayed where it was is no more than what the next one may lack, however many decades
    finer that is."""
    for seed in range(20):
        problem = Problem(seed, space=1e-8, time=1e-2, order=0.7, lost=4.5)
        verdict = problem.solve(1e-4)
        assert verdict.reached
        assert problem.truth(verdict) < 1e-4


@pytest.mark.parametrize("told", [True, False])
def test_steps_that_frames_shorten_are_not_taken_for_accurate_ones(told: bool) -> None:
    """Two runs whose steps are those of their frames agree, whatever their tolerances, and may both be wrong."""
    missed = 0
    for seed in range(40):
        problem = Problem(seed, space=1e-8, time=1e-2, order=0.6, landed=1.5e-4, told=told)
        verdict = problem.solve(1e-4)
        assert verdict.reached
        missed += problem.truth(verdict) > 1.1e-4
    assert missed == 0 if told else missed > 20


def test_whole_runs_are_compared_with_others_only_where_steps_end_at_frames() -> None:
    """It costs a run for each that is refined."""
    plain = Problem(3, space=1e-8, time=1e-2, order=0.7)
    plain.solve(1e-5)
    lands = Problem(3, space=1e-8, time=1e-2, order=0.7, landed=1.0)
    lands.solve(1e-5)
    assert [run.whole for run in plain.runs] == [False, True, False, True, True]
    assert [run.whole for run in lands.runs] == [False, True, False, True, False, True, False]
    assert [run.level for run in lands.runs[4::2]] == [run.level for run in lands.runs[1:4:2]]
