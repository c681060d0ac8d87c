"""How finely to compute, and by which method: what a plan chooses from, and what it may cost."""

import math
from dataclasses import dataclass

DEFAULT_ACCURACY = 1e-6

SIZES = ((1, 8), (1, 12), (1, 16), (2, 16), (4, 16), (8, 16), (16, 16), (32, 16))
"""Meshes by growing size, elements and their degree: few degrees, since each has a kernel to compile."""

LARGEST_DENSE = 60
"""Unknowns, less those that constraints fix, up to which Radau's few steps with dense matrices are the cheaper way."""

LOOSEST = 0.1
FIRST = {"radau": 1e5, "cvode": 0.3, "bdf": 0.3, "lsoda": 0.3}
LEAST = {"radau": 1e-9, "cvode": 1e-13, "bdf": 1e-13, "lsoda": 1e-13}
"""Tolerance of the first run in units of the accuracy, and the least one, below which is round-off: at the same
tolerance Radau is some ten thousand times as accurate as the others (measured on the examples)."""

ROUND_OFF = 1e-13
"""What no error is less than, relative to the length."""

STEPS = {"radau": 0.1, "cvode": 0.2, "bdf": 0.2, "lsoda": 0.15}
GROWTH = {"radau": 1.5, "cvode": 1.0, "bdf": 1.0, "lsoda": 1.5}
"""Powers by which the steps grow with one over the tolerance, and the seconds of one with the number of points."""


@dataclass(frozen=True)
class Setting:
    """Elements, their degree, the relative tolerance in time, and the integrator."""

    elements: int
    degree: int
    rtol: float
    method: str = "cvode"


def tolerance(method: str, accuracy: float, decades: float) -> float:
    """Relative tolerance of a method, so many decades below the one to begin with."""
    return float(max(LEAST[method], min(LOOSEST, FIRST[method] * accuracy) * 10.0**-decades))


def most_decades(method: str, accuracy: float) -> float:
    """Decades from the first tolerance down to the least."""
    return max(0.0, math.log10(tolerance(method, accuracy, 0.0) / LEAST[method]))


def predicted(setting: Setting, other: Setting, seconds: float) -> float:
    """Seconds that a run takes at a setting, where one by the same method at another one took so many."""
    steps: float = (other.rtol / setting.rtol) ** STEPS[setting.method]
    size = setting.elements * setting.degree / (other.elements * other.degree)
    return float(seconds * steps * size ** GROWTH[setting.method])
