"""States of rest followed while one number p changes, past folds as well.

Steps are measured along the curve (x, p), not in p, so that the curve may turn back: Keller's pseudo-arclength
("Numerical solution of bifurcation and nonlinear eigenvalue problems", 1977).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from geocosserat.kernel.contract import Array
from geocosserat.statics.linear import Linear
from geocosserat.statics.newton import NotAtRest, size
from geocosserat.statics.sparse import Sparse
from geocosserat.statics.system import System

FIRST, LONGEST, SHORTEST = 0.02, 0.08, 1e-7
"""Steps along the curve, in units of the interval of p and of natural sizes together."""

EXACT, ROUNDS = 1e-9, 8

STEEP = 0.9
"""Of the direction of a path, the part in p from which on its states are told apart by p, which is then a given number
for which one rod is looked at."""

FAINT = 1e-5
"""Steps below this that no longer make the residual less are round-off: where a branch leaves the path, the equations
leave open how far the state lies to that side."""


class Family(Protocol):
    """Systems that depend on a number p in [0, 1]."""

    def residual(self, x: Array, p: float) -> Array: ...

    def linear(self, x: Array, p: float) -> Linear | Sparse: ...

    def slope(self, x: Array, p: float) -> Array:
        """How the residual changes with p."""

    def moved(self, x: Array, step: Array) -> Array: ...


@dataclass(frozen=True, eq=False)
class Place:
    """A point of a path: state, number, and the direction (along, onward) in which the path goes on; of length one,
    where a length is the mean square of the entries of x, and p."""

    x: Array
    p: float
    along: Array
    onward: float


@dataclass(frozen=True, eq=False)
class Eased:
    """A system whose forces at the start are balanced from outside, by p = 1 less and less."""

    system: System
    held: Array

    def residual(self, x: Array, p: float) -> Array:
        return self.system.residual(x) - (1.0 - p) * self.held

    def linear(self, x: Array, p: float) -> Linear | Sparse:
        return self.system.linear(x)

    def slope(self, x: Array, p: float) -> Array:
        return self.held

    def moved(self, x: Array, step: Array) -> Array:
        return self.system.moved(x, step)


def begin(family: Family, x: Array, p: float, sign: float) -> Place:
    """The place of a state of rest, from which p grows (sign 1) or falls (-1)."""
    return _directed(family.linear(x, p), x, p, family.slope(x, p), np.zeros_like(x), sign)


def follow(family: Family, place: Place, low: float = 0.0, high: float = 1.0, most: int = 1000) -> Iterator[Place]:
    """The path of states of rest from a place on, without that one, until p leaves the interval from `low` to `high`.

    Raises NotAtRest if it cannot be followed further.
    """
    length = FIRST
    for _ in range(most):
        try:
            further, rounds = advance(family, place, length)
            if not low <= further.p <= high:  # the last step ends at the end
                yield _landed(family, place, further, min(max(further.p, low), high))
                return
        except NotAtRest as error:
            length /= 2
            if length < SHORTEST:
                raise NotAtRest(f"the path of states ends at {place.p:.6g} of the interval: {error}") from error
            continue
        place = further
        yield place
        length = min(LONGEST, length * (1.5 if rounds <= 3 else 0.7 if rounds > 5 else 1.0))
    raise NotAtRest(f"the path of states is longer than {most} steps")


def advance(family: Family, place: Place, length: float) -> tuple[Place, int]:
    """The place so much further, and after how many rounds of Newton's method on the plane across the path.

    Raises NotAtRest if it does not converge there.
    """
    x, p = family.moved(place.x, length * place.along), place.p + length * place.onward
    row, corner = _across(place)
    last, before = np.inf, np.inf
    try:
        slope = family.slope(x, p)
        for rounds in range(1, ROUNDS + 1):
            short = length - float(row @ (x - place.x)) - corner * (p - place.p)
            residual, linear = family.residual(x, p), family.linear(x, p)
            step, more = linear.bordered(slope, row, corner, residual, short)
            more = 0.0 if _steep(place) else more  # not a change in the last digit, for which all is read again
            x, p = family.moved(x, step), p + more
            now, left = max(size(step), abs(more)), size(residual)
            if now < EXACT or (now < FAINT and left > 0.5 * before):
                return _directed(linear, x, p, slope, place.along, place.onward), rounds
            if not now < max(0.5 * last, 1e-3):
                break
            last, before = now, left
    except np.linalg.LinAlgError as error:
        raise NotAtRest(str(error)) from error
    raise NotAtRest("Newton's method does not converge across the path")


def distance(one: Place, other: Place) -> float:
    """How much further another place is, as `advance` counts it."""
    row, corner = _across(one)
    return float(row @ (other.x - one.x)) + corner * (other.p - one.p)


def _steep(place: Place) -> bool:
    return abs(place.onward) > STEEP


def _across(place: Place) -> tuple[Array, float]:
    """(row, corner) of the plane on which the next state is looked for: where row x + corner p is given."""
    if _steep(place):
        return np.zeros_like(place.x), 1.0 / place.onward
    return place.along / len(place.x), place.onward


def _landed(family: Family, one: Place, other: Place, p: float) -> Place:
    """The place at p between two places."""
    part = (p - one.p) / (other.p - one.p)
    x = family.moved(one.x, part * (other.x - one.x))
    for _ in range(ROUNDS):
        linear = family.linear(x, p)
        step = linear.step(family.residual(x, p))
        x = family.moved(x, step)
        if size(step) < EXACT:
            return _directed(linear, x, p, family.slope(x, p), one.along, one.onward)
    raise NotAtRest("Newton's method does not converge at the end of the interval")


def _directed(linear: Linear | Sparse, x: Array, p: float, slope: Array, along: Array, onward: float) -> Place:
    """The place with its direction, on the side of the one that led there. linear, and slope, how the residual changes
    with p: there or nearby, for the direction only says where to look next."""
    row = along / len(x)
    d, e = linear.bordered(slope, row, onward, np.zeros_like(slope), 1.0)
    length = float(np.sqrt(d @ d / len(x) + e * e))
    return Place(x, p, d / length, e / length)
