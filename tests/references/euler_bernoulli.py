"""Decay of the straight inextensible, unshearable planar rod, with rotary friction: characteristic equations.

With theta = y', the balances F2' = friction2 y_t and M' + F2 = friction3 theta_t leave

    friction2 y_t - friction3 y_t'' = -k3 y''''

A mode y = Y(u) exp(-rate t) obeys k3 Y'''' + rate friction3 Y'' - rate friction2 Y = 0, so Y is made of cosh(a u),
sinh(a u), cos(b u), sin(b u) with a^2 b^2 = rate friction2 / k3 and b^2 - a^2 = rate friction3 / k3, that is

    a^2 = b^2 / (1 + b^2 friction3 / friction2),   rate = k3 b^4 / (friction2 + friction3 b^2).

Ends: clamped Y = Y' = 0; pinned Y = Y'' = 0; free Y'' = 0 and F2 = -(k3 Y''' + rate friction3 Y') = 0. The operator in
the last turns cosh(a u) into a b^2 sinh(a u) and sin(b u) into -a^2 b cos(b u). The determinants of the two
conditions at L are written out in `characteristic`; friction3 = 0 makes a = b = beta / L and leaves the tables'
cos(beta) cosh(beta) = -1 (clamped-free), 1 (both ends alike), tan(beta) = tanh(beta) (pinned and another). Source:
separation of variables; S. Timoshenko, *Vibration Problems in Engineering*, chapter V.

Dimensions: k3 force x length^2; friction2 force x time / length^2; friction3 force x time; rates 1 / time.
"""

import math
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

Array = npt.NDArray[np.float64]
Ends = Literal["clamped-clamped", "clamped-pinned", "clamped-free", "pinned-pinned", "pinned-free", "free-free"]
STEP = 0.02  # of b L, in which a root is looked for; they lie about pi apart


def rate_of(b: float, k3: float, friction2: float, friction3: float) -> float:
    """The rate (1 / time) of the wave number b (1 / length)."""
    return k3 * b**4 / (friction2 + friction3 * b**2)


def characteristic(b: float, rotary: float, ends: Ends) -> float:
    """What vanishes at the wave numbers b of the modes; lengths in units of L, rotary = friction3 / (friction2 L^2)."""
    a = b / math.sqrt(1.0 + rotary * b * b)
    shrink, grown, c, s = 1.0 / math.cosh(a), math.tanh(a), math.cos(b), math.sin(b)
    if ends == "clamped-clamped":
        return 2.0 * a * b * (shrink - c) + (a**2 - b**2) * grown * s
    if ends == "free-free":
        return 2.0 * a**3 * b**3 * (shrink - c) + (b**6 - a**6) * grown * s
    if ends == "clamped-free":
        return 2.0 * a**2 * b**2 * shrink + (a**4 + b**4) * c + a * b * (a**2 - b**2) * grown * s
    if ends == "clamped-pinned":
        return a * s - b * grown * c
    if ends == "pinned-free":
        return b**3 * s - a**3 * grown * c
    return s


def decay_rates(length: float, k3: float, friction2: float, friction3: float, ends: Ends, number: int) -> Array:
    """The `number` slowest rates above zero (1 / time), increasing, shape (number,): rigid motions are left out."""
    rotary = friction3 / (friction2 * length**2)
    found: list[float] = []
    low = 1.0  # every mode has b L > pi / 2
    while len(found) < number:
        high = low + STEP
        if characteristic(low, rotary, ends) * characteristic(high, rotary, ends) <= 0.0:
            found.append(brentq(characteristic, low, high, args=(rotary, ends), xtol=1e-15, rtol=1e-15))
        low = high
    return np.array([rate_of(b / length, k3, friction2, friction3) for b in found])
