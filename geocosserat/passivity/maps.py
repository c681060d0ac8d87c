"""The least eigenvalues of a tangent in floats: at points, and over a plane of two strains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from geocosserat.passivity.losses import Loss
from geocosserat.passivity.tangent import Floats, Tangent, least_definite, least_rate

_GRID: Final = 41


@dataclass(frozen=True)
class StabilityMap:
    """Over two strain components, the others at the reference: axes ``x`` (m,), ``y`` (n,); ``definite``: the least
    eigenvalue of sym T, scaled; ``parabolic``: the least real part of those of friction^-1 T; both (n, m)."""

    names: tuple[str, str]
    x: Floats
    y: Floats
    definite: Floats
    parabolic: Floats


@dataclass(frozen=True)
class Sampled:
    """The two measures of a tangent, in floats. ``scale``: factors of rows and columns of sym T, (d,)."""

    tangent: Tangent
    scale: Floats

    def definite(self, points: Floats) -> Floats:
        """The least eigenvalue of the scaled sym T: (N, n) -> (N,)."""
        return least_definite(self.tangent.values(self.tangent.matrix, points), self.scale)

    def rates(self, points: Floats) -> tuple[Floats, Floats]:
        """The least real part of the eigenvalues of friction^-1 T, and how complex they are: (N, n) -> (N,), (N,)."""
        t, f = (self.tangent.values(m, points) for m in (self.tangent.matrix, self.tangent.friction))
        return least_rate(t, f)

    def rate(self, points: Floats) -> Floats:
        """The first of these."""
        return self.rates(points)[0]


def scale_of(at_rest: Floats) -> Floats:
    """Factors that give the tangent a unit diagonal at the reference, where that is positive: (d,)."""
    diagonal = np.diag(at_rest)
    good = np.isfinite(diagonal) & (diagonal > 0)
    usual = float(np.median(diagonal[good])) if good.any() else 1.0
    return 1 / np.sqrt(np.where(good, diagonal, usual))


def weights_of(sampled: Sampled) -> Floats:
    """How much the scaled tangent varies along each axis of the domain: (n,)."""
    t = sampled.tangent
    out = np.zeros(len(t.ranges))
    for i, r in enumerate(t.ranges):
        points = np.repeat(t.rest[None], 9, axis=0)
        points[:, i] = np.linspace(r.low, r.high, 9)
        values = t.values(t.matrix, points) * sampled.scale[:, None] * sampled.scale
        spread = np.ptp(values, axis=0)
        out[i] = np.max(spread[np.isfinite(spread)], initial=0.0)
    return np.asarray(out + 1e-3 * max(float(out.max()), 1e-300), dtype=np.float64)


def map_of(sampled: Sampled, lost: tuple[Loss, ...]) -> StabilityMap | None:
    """Over the two strains along which it is lost first, or T varies most; None if T is constant."""
    t = sampled.tangent
    strains = [i for i, name in enumerate(t.group.strain) if name in t.variables]
    if not strains:
        return None
    weights = weights_of(sampled)
    order = sorted(strains, key=lambda i: -weights[i])
    order += [i for i in range(t.group.dimension) if i not in strains]
    nearest = min((loss for loss in lost if loss.value > 0), key=lambda loss: loss.value, default=None)
    if nearest is not None:
        # those that have gone farthest where it is lost first
        away = [abs(nearest.where[r.name] - r.rest) / (r.high - r.low) for r in t.ranges]
        order.sort(key=lambda i: -away[i])
    i, j = sorted(order[:2])
    x, y = (np.linspace(t.ranges[k].low, t.ranges[k].high, _GRID) for k in (i, j))
    points = np.repeat(t.rest[None], _GRID**2, axis=0)
    points[:, i], points[:, j] = (a.ravel() for a in np.meshgrid(x, y))
    shape = (_GRID, _GRID)
    names = (t.ranges[i].name, t.ranges[j].name)
    return StabilityMap(names, x, y, sampled.definite(points).reshape(shape), sampled.rate(points).reshape(shape))
