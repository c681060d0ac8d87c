"""Whether a motion recurs: the period of a limit cycle or of a driven rod, read off the frames of a run.

The rod is looked at in three ways: its shape, as its left end sees it; should that not recur, or rest, how it is
turned in the world; and then where it is. The first that recurs tells the period: the shortest lag at which the
last period is like the one before. Polynomials join the frames by values and rates, so that a period is found to
far less than their spacing. Rates also say whether frames are dense enough: where the motion is faster than its
frames, values may seem to belong to a slow motion, but never values and rates together.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geocosserat.results.solution import Solution

Array = NDArray[np.float64]

TOLERANCE = 1e-2  # a period recurs if it differs from the one before by less, relative to the excursion
LEAST = 8  # frames in a period
_CLOSE = 1e-4  # two periods that differ by less are enough; if by more, the difference must be dying out
_LEFT = 0.02  # and what is still to come, were it to go on dying out so, is less than this
_DENSE = 0.05  # by how much rates may differ from those that the values at frames foretell, relative
_BLUR = 0.1  # part of that disagreement that polynomials between frames may err by
_ROUND_OFF = 1e-9  # of the length: an excursion that is worth a look, of a run without an accuracy
_NODES, _FRAMES, _BOTH = 9, 600, 2**16  # looked at, at most; a longer run is looked at again with frames left out
_WIDTH = 6  # frames that a polynomial goes through
_FINE = 64  # places of the last period where an amplitude is taken


@dataclass(frozen=True)
class Recurrence:
    """A motion that recurs. The excursion is that of places and, times the length, of frame vectors (see `error`).

    period     a time, the shortest
    amplitude  the largest distance of a node from its mean place, over the last period and all nodes, a length;
               each node's drift is taken out
    start      the time from which on every instant is like the one a period before, to TOLERANCE
    error      difference of the last period from the one before, relative to the excursion about the mean over the
               last period; both root mean squares over period and rod
    drift      None if places recur as the shape does; else what one period adds: (displacement of the rod's mean
               place, a length, (axis,); rotation of the left end, an angle: in the plane with its sign and all
               turns, in space between 0 and pi)
    """

    period: float
    amplitude: float
    start: float
    error: float
    drift: tuple[Array, float] | None

    def fields(self) -> dict[str, Any]:
        """As ``run --json`` has it."""
        drift = None if self.drift is None else {"displacement": self.drift[0].tolist(), "angle": self.drift[1]}
        return {"period": self.period, "amplitude": self.amplitude, "from": self.start, "error": self.error,
                "drift": drift}


def recurrence(solution: Solution) -> Recurrence | None:
    """The period of a motion, its amplitude and more; None if the frames do not show that it recurs.

    Shown are two periods that differ by less than 1e-4 (or the accuracy of the run), or four of which the last
    differ by less than TOLERANCE, and ever less. Frames must be equally spaced (but for the last one), at least
    LEAST a period, and dense enough for what the motion does.
    """
    steps = np.diff(solution.time)
    if len(steps) < 2 * LEAST or not np.allclose(steps[:-1], steps[0], rtol=1e-6, atol=0.0):
        return None
    count = len(steps) + bool(np.isclose(steps[-1], steps[0], rtol=1e-6, atol=0.0))  # a run may end between frames
    step = float(solution.time[count - 1] - solution.time[0]) / (count - 1)
    arrays = (solution.position, solution.rotation, solution.twist)
    if not all(np.isfinite(array[:count]).all() and np.abs(array).max() < 1e100 for array in arrays):
        return None
    accuracy = solution.length * max(solution.requested or 0.0, _ROUND_OFF * TOLERANCE)
    for x, rate in _views(solution, count, step):
        found = _shortest(x, rate, accuracy)
        if found is None:
            continue
        period, error, excursion = found
        if period < LEAST:
            return None  # nor is any of its multiples the period
        tail = slice(max(0, count - _WIDTH - int(period)), count)
        amplitude, strayed, added = _travel(solution, tail, step, period)
        return Recurrence(
            period=float(period) * step,
            amplitude=amplitude if amplitude > 1e-12 * solution.length else 0.0,
            start=float(solution.time[_first(x, rate, period, excursion)]),
            error=error,
            drift=added if strayed > max(5 * error * excursion, accuracy) else None,
        )
    return None


def _views(solution: Solution, count: int, step: float) -> Iterator[tuple[Array, Array]]:
    """Configurations as seen from a base, and what their rates add in the time of a frame, both (count, numbers).

    Base B with twist W sees configuration Q = B^-1 G of a node with twist V, and Q' = Q V - W Q. Numbers are
    lengths, scaled to give root mean squares over nodes.
    """
    group = solution.group
    some = np.unique(np.linspace(0, len(solution.u) - 1, max(3, min(_NODES, _BOTH // count))).astype(int))
    pose = group.pose(solution.position[:count, some], solution.rotation[:count, some])
    twist = group.hat(solution.twist[:count, some])
    units = np.append(1.0, np.full(group.space, solution.length)) / np.sqrt(len(some))
    left, left_twist = pose[:, :1], twist[:, :1]
    beside = group.pose(group.position(left), np.eye(group.space))  # goes with the left end, and does not turn
    sliding = np.zeros_like(left_twist)
    sliding[..., 1:, 0] = (left @ left_twist)[..., 1:, 0]
    still = np.zeros_like(left_twist)
    for base, drawn in ((left, left_twist), (beside, sliding), (still + group.identity(), still)):
        seen = group.inverse(base) @ pose
        moved = step * (seen @ twist - drawn @ seen)
        yield (seen[..., 1:, :] * units).reshape(count, -1), (moved[..., 1:, :] * units).reshape(count, -1)


def _shortest(x: Array, rate: Array, accuracy: float) -> tuple[float, float, float] | None:
    """The shortest period in frames, its error and excursion. Of a long run its end, then ever fewer frames of more."""
    stride, first = 1, 3
    while True:
        thin = slice((len(x) - 1) % stride, None, stride)
        values, rates = x[thin][-_FRAMES:], stride * rate[thin][-_FRAMES:]
        for lag in range(first, (len(values) - 1) // 2 + 1):
            found = _near(values, rates, lag, accuracy)
            if found is not None:
                return found[0] * stride, found[1], found[2]
        if len(values) * stride >= len(x) - stride:
            return None
        stride, first = 2 * stride, _FRAMES // 8 - 2  # of shorter periods four have been seen


def _near(x: Array, rate: Array, lag: int, accuracy: float) -> tuple[float, float, float] | None:
    """The period within a frame of a lag, 0 if frames are too few to tell, its error and excursion; None if none."""
    last, moved = x[-lag:], rate[-lag:]
    excursion = _size(last - last.mean(axis=0))
    # half a frame away the motion has gone on by half of what it does in a frame
    near = 0.6 * _size(moved) + TOLERANCE * excursion
    if excursion * TOLERANCE < accuracy or _size(last - x[-2 * lag : -lag]) > near:
        return None
    period, gap = _fitted(x, rate, np.arange(len(x) - lag, len(x)), lag)
    error = _size(gap) / excursion
    if abs(period - lag) > 1.0 or 2 * period > len(x) - 1 + 1e-6 or error > TOLERANCE:
        return None
    coarse = _coarseness(x, rate, lag)
    if coarse > _DENSE:
        return 0.0, error, excursion
    if error > max(_CLOSE, accuracy / excursion, coarse * _BLUR) and not _settles(x, rate, lag, excursion):
        return None
    return period, error, excursion


def _fitted(x: Array, rate: Array, frames: NDArray[np.intp], lag: int) -> tuple[float, Array]:
    """The period about a lag that some frames and those before them tell, and by how much they then differ."""
    period, moved = float(lag), rate[frames]
    for _ in range(8):
        gap = _gap(x, rate, frames, period)
        # it is to have no part along the motion
        change = float(np.vdot(gap, moved)) / max(float(np.vdot(moved, moved)), 1e-300)
        period -= change
        if abs(change) < 1e-11 * lag or abs(period - lag) > 1.5:
            break
    return period, gap


def _settles(x: Array, rate: Array, lag: int, excursion: float) -> bool:
    """Whether the last of at least four periods differ less and less, so that hardly anything is left to come.

    A difference counts as less if there was more of it, of that very kind, a period before: starts that are soon
    forgotten may hide a slow decay, and beats shrink by chance, but these are other kinds. What is left of a motion
    that comes to rest is all of it.
    """
    if len(x) < 4 * lag + 2:  # three would do for the sums, and be too few to trust them
        return False
    last, before = (_fitted(x, rate, np.arange(len(x) - k * lag, len(x) - (k - 1) * lag), lag)[1] for k in (1, 2))
    growth = np.vdot(last, before) / np.vdot(last, last) - 1
    return bool(np.linalg.norm(last) <= _LEFT * growth * excursion * np.sqrt(lag))


def _coarseness(x: Array, rate: Array, lag: int) -> float:
    """How far values and rates of the last period disagree, relative; of a motion faster than its frames, about 1."""
    i = np.arange(len(x) - lag - 2, len(x) - 2)
    told = (rate[i - 1] + 3 * rate[i] + rate[i + 1]) / 3  # the compact difference of sixth order
    seen = 7 / 9 * (x[i + 1] - x[i - 1]) + (x[i + 2] - x[i - 2]) / 36
    return _size(seen - told) / max(_size(told), 1e-300)


def _between(x: Array, rate: Array, places: Array) -> Array:
    """Values (T, ...) at places (P,) between frames: the polynomial with values and rates of the six about each."""
    first = np.clip(np.floor(places).astype(int) - _WIDTH // 2 + 1, 0, len(x) - _WIDTH)
    away = places - first - np.arange(_WIDTH)[:, None]
    values, rates = np.empty_like(away), np.empty_like(away)
    for i in range(_WIDTH):
        others = [k for k in range(_WIDTH) if k != i]
        square = np.prod([away[k] / (i - k) for k in others], axis=0) ** 2
        values[i] = (1 - 2 * away[i] * sum(1 / (i - k) for k in others)) * square
        rates[i] = away[i] * square
    around = first + np.arange(_WIDTH)[:, None]
    result: Array = np.einsum("ip,ip...->p...", values, x[around]) + np.einsum("ip,ip...->p...", rates, rate[around])
    return result


def _gap(x: Array, rate: Array, frames: NDArray[np.intp], period: float) -> Array:
    """Differences (P, ...) between frames and the instants a period before."""
    result: Array = x[frames] - _between(x, rate, frames - np.float64(period))
    return result


def _size(differences: Array) -> float:
    """Root mean square over frames of the norm over nodes."""
    return float(np.sqrt(np.vdot(differences, differences) / len(differences)))


def _first(x: Array, rate: Array, period: float, excursion: float) -> int:
    """The frame from which on every instant is like the one a period before."""
    frames = np.unique(np.linspace(np.ceil(period), len(x) - 1, _FRAMES).astype(int))
    apart = np.linalg.norm(_gap(x, rate, frames, period), axis=1) > TOLERANCE * excursion
    apart[frames > len(x) - 1 - period] = False  # which recurs, on the whole
    since = frames[np.flatnonzero(apart)[-1]] if apart.any() else frames[0]
    return max(0, int(np.ceil(since - period)))


def _travel(solution: Solution, tail: slice, step: float, period: float) -> tuple[float, float, tuple[Array, float]]:
    """Of the last period: the amplitude, how far it takes the left end, turns times the length, and what it adds."""
    position, rotation, twist = solution.position[tail], solution.rotation[tail], solution.twist[tail]
    space, end = solution.group.space, len(position) - 1
    part = np.linspace(-1.0, 0.0, _FINE + 1)
    path = _between(position, step * (rotation @ twist[..., :space, None])[..., 0], end + part * period)
    gone = path[-1] - path[0]
    path = (path - part[:, None, None] * gone)[:-1]
    amplitude = float(np.linalg.norm(path - path.mean(axis=0), axis=-1).max())
    displacement = np.diff(solution.u) @ (gone[1:] + gone[:-1]) / (2 * solution.length)
    before = np.array([end - period])
    if solution.angle is not None:
        angle = solution.angle[tail, 0]
        turned = float(angle[-1] - _between(angle, step * twist[:, 0, space], before)[0])
    else:
        left = rotation[:, 0]
        spin = left @ solution.group.hat(twist[:, 0])[:, 1:, 1:]
        added = left[-1] @ _between(left, step * spin, before)[0].T
        sine = np.linalg.norm(added - added.T) / np.sqrt(8)
        turned = float(np.arctan2(sine, (np.trace(added) - 1) / 2))
    strayed = np.hypot(np.linalg.norm(gone[0]), 2 * solution.length * np.sin(turned / 2))
    return amplitude, float(strayed), (displacement, turned)
