"""Where a formula varies in one variable: intervals on which it hardly does, however narrow its features are."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocosserat.model.bounds import Array, bounds
from geocosserat.model.evaluation import evaluate
from geocosserat.model.tree import Expression

FLAT = 0.1
"""Of the range of a formula, what it may vary by on an interval that is not cut further."""

MOST_CUTS, MOST_LEAVES = 40, 2**14
"""Halvings of the whole; intervals after which no more are cut: what varies so much everywhere is noticed anyway."""

SHORT, MOST_PULSES = 1 / 16, 64
"""Beside the intervals in which the formula lies half of the time, those of a pulse; how many pulses are told apart."""


def leaves(e: Expression, variable: str, most: float, values: Mapping[str, float]) -> Array:
    """Edges of intervals of [0, most] on each of which `e` varies little, by bounds and not by samples alone.

    values: of the other names.
    """
    edges = np.linspace(0.0, most, 9)
    flat = np.zeros(0)  # left ends of intervals that need no more cuts
    low, high = edges[:-1], edges[1:]
    seen = _at(e, variable, edges, values)
    least, largest = np.nanmin(seen, initial=np.inf), np.nanmax(seen, initial=-np.inf)
    for _ in range(MOST_CUTS):
        below, above = bounds(e, {**values, variable: (low, high)})
        scale = max(largest - least, 1e-9 * max(abs(largest), abs(least)))
        with np.errstate(invalid="ignore"):
            cut = np.broadcast_to(~(above - below <= FLAT * scale), low.shape)
        if not cut.any() or len(flat) + len(low) + np.count_nonzero(cut) > MOST_LEAVES:
            break
        flat = np.concatenate([flat, low[~cut]])
        middle = (low[cut] + high[cut]) / 2
        seen = _at(e, variable, middle, values)
        least, largest = np.nanmin(seen, initial=least), np.nanmax(seen, initial=largest)
        low, high = np.concatenate([low[cut], middle]), np.concatenate([middle, high[cut]])
    return np.append(np.sort(np.concatenate([flat, low])), most)


def pulses(e: Expression, variable: str, most: float, values: Mapping[str, float]) -> tuple[float, ...]:
    """Places inside (0, most) where `e` has a peak that is short beside how it varies elsewhere, and ends as it began.

    None where there are very many: steps that follow one of them see the next.
    """
    edges = leaves(e, variable, most, values)
    sizes = np.diff(edges)
    order = np.argsort(sizes)
    typical = sizes[order[np.searchsorted(np.cumsum(sizes[order]), most / 2)]]  # half of the whole lies in longer ones
    short = np.concatenate([[False], sizes < SHORT * typical, [False]])
    starts, ends = np.flatnonzero(~short[:-1] & short[1:]), np.flatnonzero(short[:-1] & ~short[1:])
    if len(starts) > MOST_PULSES:
        return ()
    found = []
    for i, j in zip(starts, ends, strict=True):
        places = np.sort(np.concatenate([edges[i : j + 1], (edges[i:j] + edges[i + 1 : j + 1]) / 2]))
        f = _at(e, variable, places, values)
        away = np.nan_to_num(np.abs(f - f[0]), nan=0.0)
        peak = int(np.argmax(away))
        if away[peak] > 2.0 * away[-1]:
            lower = np.flatnonzero(away[peak:] < (1.0 - FLAT) * away[peak])  # it may be flat on top
            found.append(float(places[peak] + places[peak + lower[0] - 1]) / 2)
    return tuple(found)


def _at(e: Expression, variable: str, places: Array, values: Mapping[str, float]) -> Array:
    found: Array = np.broadcast_to(evaluate(e, {**values, variable: places}), places.shape)
    return np.where(np.isfinite(found), found, np.nan)
