"""Whether a rod whose ends are joined is closed: its ends meet, and are turned alike."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from geocosserat.algebra.exponential import exp, vector_from_rotation
from geocosserat.algebra.groups import Group
from geocosserat.model.checks import Array
from geocosserat.model.expressions import evaluate, jump_positions
from geocosserat.model.fields import Names
from geocosserat.model.records import Vector

_FEWEST, _MOST = 2**7, 2**16  # steps
_AGREE = 1e-9  # of two numbers of steps


def gap(group: Group, strain: Vector, names: Names) -> tuple[float, float]:
    """How far apart the ends of the start are: distance relative to the length, and angle in radians (0 to pi).

    Full turns do not count. The frame is marched by a method of fourth order, with ever more steps until two agree.
    Neither is finite where the strains are too large for that.
    """
    with np.errstate(all="ignore"):
        distance, angle = _gap(group, strain, names)
    return (distance, angle) if math.isfinite(distance + angle) else (math.inf, math.inf)


def _gap(group: Group, strain: Vector, names: Names) -> tuple[float, float]:
    n, before = _FEWEST, _whole(group, strain, names, _FEWEST)
    while n < _MOST:
        n, now = 2 * n, _whole(group, strain, names, 2 * n)
        if np.all(np.abs(now - before) <= _AGREE):
            break
        before = now
    distance = np.linalg.norm(group.position(now))
    angle = np.linalg.norm(vector_from_rotation(group.rotation(now)))
    return float(distance), float(angle)


def _whole(group: Group, strain: Vector, names: Names, n: int) -> NDArray[np.float64]:
    """The pose of the right end seen from the left one, lengths relative to the rod's, by about n steps.

    No step lies across a jump.
    Magnus: over each step exp(h (A + B)/2 + sqrt(3)/12 h^2 [A, B]) with the strains A, B at its two Gauss points.
    """
    length = names.length
    jumps = sorted({place / length for e in strain for place in jump_positions(e, length, names.parameters)})
    each = n // (len(jumps) + 1) + 2
    edges = np.concatenate([np.linspace(a, b, each)[:-1] for a, b in zip([0.0, *jumps], [*jumps, 1.0], strict=True)])
    h = np.diff(edges, append=1.0)
    first, second = (_at(group, strain, names, edges + h * (0.5 + side * np.sqrt(3) / 6)) for side in (-1, 1))
    h = h[:, None]
    steps = exp(group, h / 2 * (first + second) + np.sqrt(3) / 12 * h**2 * group.bracket(first, second))
    while len(steps) > 1:
        if len(steps) % 2:
            steps = np.concatenate([steps, group.identity()[None]])
        steps = steps[0::2] @ steps[1::2]
    return np.asarray(steps[0])


def _at(group: Group, strain: Vector, names: Names, s: Array) -> Array:
    """The strains at places s, (points, d), per unit of s and in units of the length."""
    values: dict[str, float | Array] = {**names.parameters, "u": s * names.length, "t": 0.0}
    columns = np.stack([np.broadcast_to(evaluate(e, values), s.shape) for e in strain], axis=-1)
    columns[:, group.translations :] *= names.length
    return columns
