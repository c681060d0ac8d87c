"""Closed loops of configurations on which a wrench does net work: found in floats, certified in balls."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from itertools import combinations
from typing import Any, Final

import numpy as np
from flint import acb, arb
from numpy.typing import NDArray
from scipy.optimize import minimize

from geocosserat.algebra.groups import Group
from geocosserat.model.describe import number_text
from geocosserat.model.expressions import Expression, evaluate, symbols
from geocosserat.passivity.balls import ball_of, complex_ball, precision
from geocosserat.passivity.configuration import ConfigurationLoop, Swing

_SAMPLES, _FINE = 240, 1920
_CLEAR, _SEEN = 1e-2, 1e-9
_PRECISIONS: Final = (64, 128, 256, 512)
_EVALUATIONS: Final = 2_000
_FAILURES: Final = 3
_FAR: Final = 1e30
_DESCENT: Final = {"maxiter": 600, "xatol": 1e-9, "fatol": 1e-14}

Floats = NDArray[np.float64]
Values = Mapping[str, float]


def names_of(group: Group) -> tuple[str, ...]:
    """Names of the coordinates of a loop: x, y, theta, or x, y, z, alpha, beta, gamma."""
    return ("x", "y", "theta") if group.rotations == 1 else ("x", "y", "z", "alpha", "beta", "gamma")


def loops(group: Group, centre: Sequence[float], size: float = 1.0) -> Iterator[ConfigurationLoop]:
    """Simple loops about a configuration, the simplest first.

    Full turns at a place; circles in two coordinates of the place; circles while the frame makes a full turn with
    them; a swing of a coordinate and, a quarter of a period later, of an angle; of two angles. ``size``: radius of the
    circles (length) and amplitude of the swings (radians).
    """
    n, d = group.space, group.dimension
    names = names_of(group)

    def loop(moving: Mapping[int, Swing], words: str) -> ConfigurationLoop:
        swings = [moving.get(k, Swing(c)) for k, c in enumerate(centre)]
        rest = [
            f"{name} = {number_text(c)}" for k, (name, c) in enumerate(zip(names, centre, strict=True))
            if k not in moving and c
        ]
        return ConfigurationLoop(group, tuple(swings), words + (f", at {', '.join(rest)}" if rest else ""))

    def there(*which: int) -> str:
        return ", ".join(f"{names[k]} = {number_text(centre[k])}" for k in which)

    for k in range(n, d):
        about = "in the plane" if n == 2 else f"of {names[k]}, about an axis of the world or of the frame"
        yield loop({k: Swing(centre[k], turns=1)}, f"one full turn {about}")
    pairs = list(combinations(range(n), 2))
    for i, j in pairs:
        circle = {i: Swing(centre[i], cosine=size), j: Swing(centre[j], sine=size)}
        where = f"a circle of radius {number_text(size)} in {names[i]} and {names[j]} about {there(i, j)}"
        yield loop(circle, where)
    for i, j in pairs:
        circle = {i: Swing(centre[i], cosine=size), j: Swing(centre[j], sine=size)}
        where = f"a circle of radius {number_text(size)} in {names[i]} and {names[j]} about {there(i, j)}"
        for k in range(n, d):
            turned = {**circle, k: Swing(centre[k], turns=1)}
            yield loop(turned, f"{where}, while {names[k]} makes one full turn")
    for i, j in combinations(range(d), 2):
        if j < n:
            continue
        swing = {i: Swing(centre[i], cosine=size), j: Swing(centre[j], sine=size)}
        yield loop(
            swing,
            f"a swing of {names[i]} and, a quarter of a period later, of {names[j]}, by {number_text(size)} "
            f"to either side of {there(i, j)}",
        )


@lru_cache(maxsize=4096)
def _path(loop: ConfigurationLoop) -> tuple[dict[str, Expression], tuple[Expression, ...]]:
    return loop.pose, loop.twist


class Worker:
    """A wrench with values for all of its names but those of the configuration and, if it is timed, of t.

    ``uncertain``: the largest share of net work that the last search saw in floats and could not certify.
    """

    def __init__(self, wrench: Sequence[Expression], parameters: Values, timed: bool) -> None:
        self.wrench, self.parameters, self.timed = tuple(wrench), dict(parameters), timed
        self.names = frozenset().union(*(symbols(e) for e in wrench))
        self.uncertain = 0.0

    def share(self, loop: ConfigurationLoop, values: Values) -> float:
        """Net work over the integral of |j| |V|, in floats: 0 if that is noise or not defined."""
        net, gross = self.estimate(loop, values, _SAMPLES)
        if not (math.isfinite(gross) and abs(net) > _SEEN * gross):
            return 0.0
        # the rule is exact up to rounding for smooth laws; poles nearby and steps show where it is refined
        fine, gross = self.estimate(loop, values, _FINE)
        return fine / gross if abs(fine) > _SEEN * gross and abs(fine - net) < 0.1 * abs(fine) else 0.0

    def estimate(self, loop: ConfigurationLoop, values: Values, samples: int) -> tuple[float, float]:
        """Net work, and the integral of |j| |V|: in floats; not a number where it is not defined."""
        times = np.arange(samples) / samples
        pose, twist = _sampled(loop, samples)
        env: dict[str, Any] = {"t": times if self.timed else 0.0, **self.parameters, **values, **pose}
        power, wrenches, speeds = np.zeros((3, samples))
        with np.errstate(all="ignore"):
            for force, speed in zip(self.wrench, twist, strict=True):
                value = np.asarray(evaluate(force, env))
                power, wrenches, speeds = power + value * speed, wrenches + value**2, speeds + speed**2
            return float(power.mean()), float(np.sqrt(wrenches * speeds).mean())

    def certify(self, loop: ConfigurationLoop, values: Values, bits: Sequence[int] = _PRECISIONS) -> arb | None:
        """An enclosure of the net work that does not hold zero, if one is found."""
        pose, twist = _path(loop)
        known = {"t": 0.0, **self.parameters, **values}
        for precise in bits:
            with precision(precise):
                numbers = {name: acb(ball_of(value)) for name, value in known.items()}

                def power(s: acb, analytic: bool, numbers: dict[str, acb] = numbers) -> acb:
                    now = {"t": s}
                    here = {k: complex_ball(e, now, analytic) for k, e in pose.items() if k in self.names} | numbers
                    if self.timed:
                        here["t"] = s
                    total = acb(0)
                    for force, speed in zip(self.wrench, twist, strict=True):
                        total += complex_ball(force, here, analytic) * complex_ball(speed, now, analytic)
                    return total

                work = acb.integral(power, acb(0), acb(1), eval_limit=_EVALUATIONS).real
                if not work.is_finite():
                    return None
                if not work.contains(0):
                    return work
        return None

    def certified(
        self, loop: ConfigurationLoop, values: Values, bits: Sequence[int] = _PRECISIONS
    ) -> ConfigurationLoop | None:
        """The loop, in the sense in which the body gains work, with certified bounds; None if that is not proved."""
        work = self.certify(loop, values, bits)
        if work is None:
            return None
        if work < 0 and not self.timed:
            loop = replace(loop, swings=tuple(s.backwards for s in loop.swings))
            work = -work
        elif work < 0:
            # time does not run backwards: the other way round, or half a period later
            for other in _otherwise(loop):
                again = self.certify(other, values, bits)
                if again is not None and again > 0:
                    loop, work = other, again
                    break
            else:
                return None
        shown = {name: x for name, x in values.items() if name in self.names}
        low, high = outward(work)
        return replace(loop, work=float(work.mid()), low=low, high=high, values=shown, timed=self.timed)

    def search(
        self,
        group: Group,
        tries: Sequence[Values],
        centres: Sequence[Sequence[float]],
        last: bool = True,
        turns: bool = True,
    ) -> ConfigurationLoop | None:
        """The simplest loop that clearly does work, else the one that does most for its power; certified.

        ``last``: whether to try in many digits where floats see nothing. ``turns``: whether full turns are closed.
        """
        seen: list[tuple[float, ConfigurationLoop, Values]] = []
        failures = 0
        for values in tries:
            for k, centre in enumerate(centres):
                for size in (1.0, 0.5) if k == 0 else (0.5, 0.1):
                    for loop in loops(group, centre, size):
                        if not turns and any(s.turns for s in loop.swings):
                            continue
                        share = abs(self.share(loop, values))
                        if share > _CLEAR and failures < _FAILURES:
                            if found := self.certified(loop, values):
                                return found
                            failures += 1
                        if share:
                            seen.append((share, loop, values))
        self.uncertain = max((share for share, _, _ in seen), default=0.0)
        for _, loop, values in sorted(seen, key=lambda item: -item[0])[: _FAILURES - failures]:
            if found := self.certified(loop, values):
                return found
        if last and not seen:
            for values in tries[-1:]:
                for centre in centres[-2:]:
                    for loop in loops(group, centre, 0.5):
                        if found := self.certified(loop, values, (256,)):
                            return found
        return None


def _otherwise(loop: ConfigurationLoop) -> Iterator[ConfigurationLoop]:
    later = tuple(s.later for s in loop.swings)
    for swings in (tuple(s.backwards for s in loop.swings), later, tuple(s.backwards for s in later)):
        yield replace(loop, swings=swings)


@lru_cache(maxsize=2048)
def _sampled(loop: ConfigurationLoop, samples: int) -> tuple[dict[str, Any], tuple[Any, ...]]:
    times = np.arange(samples) / samples
    pose, twist = _path(loop)
    return (
        {name: np.asarray(evaluate(e, {"t": times})) for name, e in pose.items()},
        tuple(np.asarray(evaluate(e, {"t": times})) for e in twist),
    )


def outward(x: arb) -> tuple[float, float]:
    """Floats below and above all of a ball."""
    return (
        math.nextafter(float(x.lower()), -math.inf),
        math.nextafter(float(x.upper()), math.inf),
    )


def coordinates_at(group: Group, point: Mapping[str, Fraction], rotation: Any) -> tuple[float, ...]:
    """Coordinates of a loop's centre near a configuration: rounded to thousandths. ``rotation``: (3, 3), or None."""
    place = [float(point.get(axis, Fraction(0))) for axis in "xyz"[: group.space]]
    if group.rotations == 1:
        angles = [float(point.get("theta", Fraction(0)))]
    else:
        r = np.asarray(rotation, dtype=float)
        # R = R_x(alpha) R_y(beta) R_z(gamma)
        angles = [
            math.atan2(-r[1, 2], r[2, 2]), math.asin(max(-1.0, min(1.0, r[0, 2]))), math.atan2(-r[0, 1], r[0, 0])
        ]
    return tuple(round(x, 3) + 0.0 for x in (*place, *angles))


def near_zero(group: Group, e: Expression, others: Values) -> tuple[float, ...] | None:
    """Coordinates where ``e`` vanishes, found by descent over places and, in the plane, the angle; None if none was."""
    moved = ("x", "y", "theta") if group.rotations == 1 else ("x", "y", "z")
    frame = {f"e{i}{a}": float(i - 1 == k) for i in (1, 2, 3) for k, a in enumerate("xyz")}

    def height(place: Floats) -> float:
        value = evaluate(e, {**frame, **others, **dict(zip(moved, place, strict=True))})
        return float(np.abs(value)) if np.isfinite(value) else _FAR

    found = minimize(height, np.array([0.31, 0.17, 0.05]), method="Nelder-Mead", options=_DESCENT)
    if not found.fun < 1e-6:
        return None
    rest = (0.0,) * (group.dimension - 3)
    return (*(round(float(x), 4) + 0.0 for x in found.x), *rest)
