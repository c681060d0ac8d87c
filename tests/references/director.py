"""The direction of a plane vector that a constant matrix carries, d_t = A d: its angle in time, unwrapped.

The trace of A only stretches d. Without it A^2 = D I, so exp(t A) = C I + S A with C, S = cosh(s t), sinh(s t) / s
for D = s^2 > 0; 1, t for D = 0; cos(s t), sin(s t) / s for D = -s^2 < 0. In the last case d turns for ever, by half a
turn in each time pi / s and always the same way; in the others by less than half a turn in all. Source: the theorem of
Cayley and Hamilton.
"""

import math

import numpy as np
import numpy.typing as npt


def turned(matrix: npt.ArrayLike, angle: float, t: float) -> float:
    """The angle (radians) through which a vector that starts at `angle` has turned at t; matrix (2, 2), 1 / time."""
    a = np.asarray(matrix, dtype=float)
    a = a - 0.5 * np.trace(a) * np.eye(2)
    square = float(a[0, 0] ** 2 + a[0, 1] * a[1, 0])
    speed, halves = math.sqrt(abs(square)), 0
    if square < 0.0:
        halves = math.floor(speed * t / math.pi)
        rest = t - halves * math.pi / speed
        grown, share = math.cos(speed * rest), math.sin(speed * rest) / speed
    elif square > 0.0:
        # divided by cosh: only the direction counts
        grown, share = 1.0, math.tanh(speed * t) / speed
    else:
        grown, share = 1.0, t
    start = np.array([math.cos(angle), math.sin(angle)])
    end = grown * start + share * a @ start
    sense = math.copysign(1.0, a[1, 0] - a[0, 1])
    return sense * math.pi * halves + math.atan2(start[0] * end[1] - start[1] * end[0], float(start @ end))
