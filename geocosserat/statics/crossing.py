"""Where on a path of states of rest small motions begin to grow."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import toms748

from geocosserat.kernel.contract import Array
from geocosserat.statics.path import Family, Place, advance, begin, distance, follow
from geocosserat.statics.pencil import Complex

EXACT = 1e-13
"""To which a crossing is found along the path, in units of its length."""

OSCILLATES = 1e-6
"""Frequency relative to the rate of the rod above which a motion is an oscillation."""

SAME = 1e-6
"""Crossings nearer than this, of the interval, are those of a pair."""

Spectrum = Callable[[Place], tuple[Complex, Complex]]


@dataclass(frozen=True, eq=False)
class Spot:
    """A place, the growth rates there, the fastest growing first, and their motions (n, k)."""

    place: Place
    growth: Complex
    motions: Complex

    @property
    def unstable(self) -> int:
        """How many motions grow."""
        return int((self.growth.real > 0).sum())


@dataclass(frozen=True, eq=False)
class Crossing:
    """Where a growth rate passes zero, the one of that number (0: the leading one). before: the place from which the
    path leads there. gains: it becomes positive. frequency (1 / time, radians): 0 of a divergence. fold: the path turns
    back there."""

    spot: Spot
    before: Place
    number: int
    gains: bool
    frequency: float
    fold: bool

    @property
    def kind(self) -> str:
        return "flutter" if self.frequency else "divergence"


class Looked:
    """A family looked at: the growth rates at its places. neutral: how many of them vanish along the whole path, by
    motions that nothing resists; they are left out. rate: about how fast the rod relaxes (1 / time)."""

    def __init__(self, family: Family, spectrum: Spectrum, rate: float, neutral: int = 0) -> None:
        self.family, self.spectrum, self.rate, self.neutral = family, spectrum, rate, neutral

    def at(self, place: Place) -> Spot:
        growth, motions = self.spectrum(place)
        kept = np.sort(np.argsort(np.abs(growth), kind="stable")[self.neutral :])
        return Spot(place, growth[kept], motions[:, kept])

    def path(self, x: Array, p: float, sign: float = 1.0, low: float = 0.0, high: float = 1.0) -> Iterator[Spot]:
        """The path from a state of rest on, and the rates along it.

        Raises NotAtRest where it cannot be followed.
        """
        place = begin(self.family, x, p, sign)
        yield self.at(place)
        yield from self.switched(place, low, high)

    def switched(self, place: Place, low: float = 0.0, high: float = 1.0) -> Iterator[Spot]:
        """The same from a place with its direction, without that one."""
        for next_place in follow(self.family, place, low, high):
            yield self.at(next_place)

    def crossings(self, spots: list[Spot]) -> Iterator[tuple[int, Crossing]]:
        """Where growth rates change their sign between neighbours, and the number of the first of them; a pair that
        oscillates is one."""
        for index, (one, other) in enumerate(pairwise(spots)):
            numbers = list(range(*sorted((one.unstable, other.unstable))))
            if one.unstable > other.unstable:
                numbers.reverse()
            found: list[Crossing] = []
            for number in numbers:
                crossing = self._between(one, other, number)
                pair = found and found[-1].frequency and crossing.frequency
                if not (pair and abs(found[-1].spot.place.p - crossing.spot.place.p) < SAME):
                    found.append(crossing)
            yield from ((index, crossing) for crossing in found)

    def _between(self, one: Spot, other: Spot, number: int) -> Crossing:
        """The crossing of the rate of that number, bracketed along the path."""
        length = distance(one.place, other.place)
        reached: dict[float, Spot] = {0.0: one, length: other}

        def rate(part: float) -> float:
            if part not in reached:
                reached[part] = self.at(advance(self.family, one.place, part)[0])
            return float(reached[part].growth[number].real)

        toms748(rate, 0.0, length, xtol=EXACT, rtol=4 * np.finfo(float).eps)
        spot = min(reached.values(), key=lambda spot: abs(spot.growth[number].real))
        frequency = abs(float(spot.growth[number].imag))
        oscillates = frequency > OSCILLATES * self.rate
        fold = (one.place.onward > 0) != (other.place.onward > 0)
        return Crossing(
            spot=spot,
            before=one.place,
            number=number,
            gains=other.unstable > one.unstable,
            frequency=frequency if oscillates else 0.0,
            fold=fold and not oscillates,
        )


def branches(crossing: Crossing) -> tuple[Place, Place]:
    """Where the two paths set out that leave a divergence sideways."""
    place, motion = crossing.spot.place, crossing.spot.motions[:, crossing.number].real
    length = float(np.sqrt(motion @ motion / len(motion)))
    one, other = (Place(place.x, place.p, sign * motion / length, 0.0) for sign in (1.0, -1.0))
    return one, other
