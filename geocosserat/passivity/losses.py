"""Where a property of the tangent is lost first: along straight ways out from the reference, and the worst point."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np

from geocosserat.passivity.tangent import Floats, Tangent

Measure: TypeAlias = Callable[[Floats], Floats]
"""Of points (N, n): (N,), positive where the property holds, not a number where it has no value."""

_COARSE: Final = 65
_FINE: Final = 17
_ROUNDS: Final = 7  # brackets of 1/64 of the way become narrower than 1e-10 of it
_OBLIQUE: Final = 16


@dataclass(frozen=True)
class Loss:
    """Where a property is lost first in a direction.

    ``what``: "definite" or "parabolic". ``where``: the strains there. ``direction``: "reference", an axis ("h2 +") or
    "oblique". ``value``: the share of the way from the reference to the edge of the domain, 0 to 1.
    """

    what: str
    where: Mapping[str, float]
    direction: str
    value: float


def losses(what: str, measure: Measure, tangent: Tangent, points: Floats, values: Floats) -> tuple[Loss, ...]:
    """First losses along all axes, and on the way to those of the sampled points where it is lost; the nearest first.

    ``points`` (N, n), ``values`` (N,): the sample. Located to 1e-10 of the way, if signs change no more than once
    within a 64th of the way.
    """
    rest, names = tangent.rest, [r.name for r in tangent.ranges]
    at_rest = measure(rest[None])[0]
    if np.isnan(at_rest):
        return ()
    if at_rest <= 0:
        return (Loss(what, _named(names, rest), "reference", 0.0),)
    ends, directions = [], []
    for i, r in enumerate(tangent.ranges):
        for mark, end in (("-", r.low), ("+", r.high)):
            if r.name in tangent.variables and end != r.rest:
                ends.append(np.where(np.arange(len(rest)) == i, end, rest))
                directions.append(f"{r.name} {mark}")
    lost = points[values <= 0]
    nearest = lost[np.argsort(_share(tangent, lost), kind="stable")[:_OBLIQUE]]
    ends += list(nearest)
    directions += ["oblique"] * len(nearest)
    if not ends:
        return ()
    ways = np.array(ends) - rest
    shares = _first(measure, rest, ways)
    found = []
    for way, share, direction in zip(ways, shares, directions, strict=True):
        if np.isfinite(share):
            where = rest + share * way
            found.append(Loss(what, _named(names, where), direction, float(_share(tangent, where[None])[0])))
    return tuple(_nearest(found))


def _nearest(found: list[Loss]) -> list[Loss]:
    """Every axis, and of the oblique ways the nearest, if it is nearer than the axes."""
    axes = sorted((loss for loss in found if loss.direction != "oblique"), key=lambda loss: loss.value)
    oblique = min((loss for loss in found if loss.direction == "oblique"), key=lambda loss: loss.value, default=None)
    if oblique is None or (axes and axes[0].value <= oblique.value):
        return axes
    return [oblique, *axes]


def _first(measure: Measure, rest: Floats, ways: Floats) -> Floats:
    """The least share s of each way at which the measure is not positive: (R,), not a number where there is none."""
    low, high = np.zeros(len(ways)), np.ones(len(ways))
    active = np.arange(len(ways))
    out = np.full(len(ways), np.nan)
    for round_ in range(1 + _ROUNDS):
        n = _FINE if round_ else _COARSE
        shares = low[active, None] + (high - low)[active, None] * np.linspace(0.0, 1.0, n)
        points = rest + shares[..., None] * ways[active, None]
        values = measure(points.reshape(-1, len(rest))).reshape(shares.shape)
        # ways end where the tangent has no value
        bad = ~(values > 0)
        first = np.where(bad.any(axis=1), bad.argmax(axis=1), n)
        kept = [k for k, f in enumerate(first) if 0 < f < n and not np.isnan(values[k, f])]
        if not round_:
            active, shares, first = active[kept], shares[kept], first[kept]
        else:  # the bracket stays where rounding blurs its ends
            first = np.clip(first, 1, n - 1)
        rows = np.arange(len(active))
        low[active], high[active] = shares[rows, first - 1], shares[rows, first]
    out[active] = (low[active] + high[active]) / 2
    return out


def worst(measure: Measure, tangent: Tangent, points: Floats, values: Floats) -> tuple[Floats, float]:
    """The point where the measure is least, and its value there: of the sample, then by pattern search (n,).

    Not a number if the tangent has a value nowhere.
    """
    if np.isnan(values).all():
        return tangent.rest, float("nan")
    best = int(np.nanargmin(values))
    point, value = points[best], float(values[best])
    used = [i for i, r in enumerate(tangent.ranges) if r.name in tangent.variables]
    step = (tangent.high - tangent.low) / 8
    for _ in range(24):
        if not used:
            break
        moves = np.array([np.eye(len(point))[i] * sign * step[i] for i in used for sign in (1, -1)])
        near = np.clip(point + moves, tangent.low, tangent.high)
        at = measure(near)
        if not np.isnan(at).all() and np.nanmin(at) < value:
            point, value = near[int(np.nanargmin(at))], float(np.nanmin(at))
        else:
            step = step / 2
    return point, value


def _share(tangent: Tangent, points: Floats) -> Floats:
    """How far points are on the way to the edge of the domain, by the component that is farthest: (N, n) -> (N,)."""
    away = points - tangent.rest
    reach = np.where(away >= 0, tangent.high - tangent.rest, tangent.rest - tangent.low)
    return np.asarray(np.abs(away / np.where(reach > 0, reach, np.inf)).max(axis=1, initial=0.0))


def _named(names: list[str], point: Floats) -> dict[str, float]:
    return {name: float(x) for name, x in zip(names, point, strict=True)}
