"""From an accuracy to a run that has it: two runs that differ in space and time, and more where they disagree.

The first run is rough, the second one a size, and one and a half decades of tolerance, finer. Their gap is the error
of the first; by how much less that of the second is, orders foretell, cautiously. Where that is not enough, a third
one, with the mesh of the first and the tolerance of the second, tells the error in space from that in time, and only
what needs it is refined. Methods that end a step at each frame are asked for one more run wherever the tolerance is
refined, without the frames: two runs whose steps are those of their frames agree, and may both be wrong.

Nothing here depends on a clock: a scene is computed with the same settings on every machine.
"""

import math
from collections.abc import Callable, Generator
from dataclasses import dataclass

SHARE = 0.4
"""Of the accuracy, for what is refined: half for space and half for time, less a margin."""

ROUGH = 0.1
"""Of the length: a mesh that errs by more than that has missed the motion."""

LOST = 1.0
"""An error in time, known of a run by itself, that no ledger lacks: its steps passed over the motion."""

FIRST_DECADES, MOST_DECADES, MOST_GROWTH, MOST_RUNS = 1.5, 4.0, 4.0, 12


@dataclass(frozen=True)
class Level:
    """How fine: which size, by its number, and decades of tolerance below the first."""

    size: int
    decades: float


@dataclass(frozen=True)
class Request:
    """A run that is wanted. whole: it may be the one that is kept, not only compared with."""

    level: Level
    whole: bool


@dataclass(frozen=True)
class Verdict:
    """The run that is kept, by its number; its error, None where nothing is known of it; if that is small enough."""

    kept: int
    estimate: float | None
    reached: bool


@dataclass(frozen=True)
class Choice:
    """What there is to choose from. points: of each size. finest (decades), method: of a size; the errors of two
    methods say nothing of each other. lands: whether the method of a size makes a step end at each frame, of which
    runs that are kept have many: where these shorten its steps, its errors do not fall with the tolerance."""

    points: tuple[int, ...]
    finest: Callable[[int], float]
    method: Callable[[int], str]
    lands: Callable[[int], bool] = lambda _: False

    def growth(self, old: Level, new: Level) -> float:
        """How many times as many points the new level has."""
        return self.points[new.size] / self.points[old.size]


@dataclass(frozen=True)
class Errors:
    """What runs tell by their numbers, from 0. gap: between a coarser one and a finer one. in_space, in_time: what is
    known of one by itself."""

    gap: Callable[[int, int], float]
    in_space: Callable[[int], float]
    in_time: Callable[[int], float]


@dataclass(frozen=True)
class Guess:
    """An error of the last run: what is claimed of it, and what it should be if errors fall as they use to."""

    cautious: float = math.inf
    likely: float = math.inf

    @property
    def known(self) -> bool:
        return self.cautious < math.inf

    def at_least(self, error: float) -> "Guess":
        return Guess(max(self.cautious, error), max(self.likely, error))


def plan(accuracy: float, choice: Choice, errors: Errors, first: int = 0) -> Generator[Request, bool, Verdict]:
    """Asks for runs, the first one of size `first`, until one has the accuracy; is told whether each reached its end.

    accuracy, errors and the estimate: relative to the length.
    """
    old, kept, asked = Level(first, 0.0), 0, 1
    comparable = yield Request(old, whole=False)
    in_space, in_time = Guess(), Guess()
    estimate: float | None = None
    whole = False
    while asked < MOST_RUNS:
        size = _next_size(choice, old.size, SHARE * accuracy, in_space)
        if choice.method(size) != choice.method(old.size):  # begin again with that one
            comparable, new, in_space, in_time = False, Level(size, 0.0), Guess(), Guess()
        else:
            new = Level(size, min(old.decades + _more_decades(SHARE * accuracy, in_time), choice.finest(size)))
        if new == old:
            break
        before, kept, asked = kept, asked, asked + 1
        if not (yield Request(new, whole=True)):  # then the one before, if it was whole
            return Verdict(kept if estimate is None else before, estimate, False)
        if comparable:
            decades, growth = new.decades - old.decades, choice.growth(old, new)
            if decades > 0.0 and whole and choice.lands(new.size):
                asked += 1
                if (yield Request(old, whole=False)):
                    before = asked - 1
            gap = errors.gap(before, kept)
            coarse = 0.0 if growth == 1.0 else gap  # the error in space of the mesh before
            if growth == 1.0:
                in_time = _finer_in_time(gap, decades)
                in_space = in_space if in_space.known else Guess(gap, gap)  # no finer mesh exists
            elif decades == 0.0:
                in_space = _finer_in_space(gap, growth)
                in_time = in_time if in_time.known else Guess(gap, gap)  # no finer tolerance exists
            else:
                told, of_time = in_time.known, _part(in_time, in_space) * gap
                in_time, in_space = _finer_in_time(of_time, decades), _finer_in_space(gap - of_time, growth)
                if not told and in_space.cautious + in_time.cautious > accuracy:
                    asked += 1
                    if (yield Request(Level(old.size, new.decades), whole=False)):
                        in_time = _finer_in_time(errors.gap(before, asked - 1), decades)
                        coarse = errors.gap(asked - 1, kept)
                        in_space = _finer_in_space(coarse, growth, in_time.cautious)
            if coarse > ROUGH and new.decades < choice.finest(size):
                in_time = Guess()  # steps on a mesh that misses the motion tell nothing of those on one that does not
            elif decades > 0.0 and errors.in_time(before) >= LOST:  # nor do steps that pass over it of shorter ones
                in_time = in_time.at_least(gap)
            in_space, in_time = in_space.at_least(errors.in_space(kept)), in_time.at_least(errors.in_time(kept))
            estimate = in_space.cautious + in_time.cautious
            if estimate <= accuracy:
                return Verdict(kept, estimate, True)
        old, comparable, whole = new, True, True
    return Verdict(kept, estimate, False)


def _part(error: Guess, other: Guess) -> float:
    """The part of one error in the sum of two, as far as is known; not less than a tenth."""
    return min(0.9, max(0.1, error.likely / (error.likely + other.likely))) if error.known and other.known else 0.5


def _left(gap: float, ratio: float) -> float:
    """The error of the finer of two runs, where it is so much of that of the coarser one; the gap at most."""
    return gap * ratio / (1.0 - ratio) if ratio < 0.5 else gap


def _finer_in_time(gap: float, decades: float) -> Guess:
    """The error in time of a run so many decades finer than one that lies so far from it."""
    return Guess(_left(gap, 10.0 ** (0.2 - 0.7 * decades)), gap * 10.0 ** (-0.95 * decades))


def _finer_in_space(gap: float, growth: float, in_time: float = 0.0) -> Guess:
    """The error in space of a run with so many times the points. in_time: part of the gap that may be of another kind.

    On a mesh that resolves the rod, errors are powers of one number by the number of points; nothing but a modest order
    can be relied upon.
    """
    cautious = _left(gap, growth**-2.5)
    likely = cautious if gap > 0.1 else gap**growth
    return Guess(cautious, likely if gap > 2.0 * in_time else 0.0)


def _next_size(choice: Choice, now: int, wanted: float, error: Guess) -> int:
    """The size to go on with: this one if its error is what is wanted, or one that should be large enough."""
    last = len(choice.points) - 1
    if error.cautious <= wanted or now == last:
        return now
    size = now + 1
    if error.known and error.likely > wanted:
        growth = MOST_GROWTH if error.likely > 0.1 else min(MOST_GROWTH, math.log(wanted) / math.log(error.likely))
        while size < last and choice.points[size] < growth * choice.points[now]:
            size += 1
    return size


def _more_decades(wanted: float, error: Guess) -> float:
    """How much finer a tolerance to go on with."""
    if error.cautious <= wanted:
        return 0.0
    if not error.known:
        return FIRST_DECADES
    return max(1.0, min(MOST_DECADES, (math.log10(max(1.0, error.likely / wanted)) + 0.2) / 0.7))
