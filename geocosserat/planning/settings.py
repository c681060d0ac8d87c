"""How finely to compute, and by which method: what a plan chooses from, and what it may cost."""

import math
from dataclasses import dataclass

DEFAULT_ACCURACY = 1e-6

SIZES = ((1, 8), (1, 12), (1, 16), (2, 16), (4, 16), (8, 16), (16, 16), (32, 16))
"""Meshes by growing size, elements and their degree: few degrees, since each has a kernel to compile."""

LARGEST_DENSE = 60
"""Unknowns, less those that constraints fix, up to which Radau's few steps with dense matrices are the cheaper way."""

LOOSEST = 0.1
"""Tolerance above which no run tells anything."""

ROUND_OFF = 1e-13
"""What no error is less than, relative to the length."""


@dataclass(frozen=True)
class Habits:
    """How an integrator behaves. first: its tolerance in the first run, in units of the accuracy; least: below it is
    round-off; steps, growth: powers by which steps grow with one over the tolerance, and the seconds of one with the
    number of points."""

    first: float
    least: float
    steps: float
    growth: float


HABITS = {
    "radau": Habits(first=1e5, least=1e-9, steps=0.1, growth=1.5),
    "cvode": Habits(first=0.3, least=1e-13, steps=0.2, growth=1.0),
    "bdf": Habits(first=0.3, least=1e-13, steps=0.2, growth=1.0),
    "lsoda": Habits(first=0.3, least=1e-13, steps=0.15, growth=1.5),
    "safe": Habits(first=30.0, least=1e-9, steps=0.35, growth=1.0),  # less would take for ever
    "midpoint": Habits(first=30.0, least=1e-9, steps=0.35, growth=1.0),
}
"""At the same tolerance Radau is some ten thousand times as accurate as the others (measured on the examples)."""


@dataclass(frozen=True)
class Setting:
    """Elements, their degree, the relative tolerance in time, and the integrator."""

    elements: int
    degree: int
    rtol: float
    method: str = "cvode"


def tolerance(method: str, accuracy: float, decades: float) -> float:
    """Relative tolerance of a method, so many decades below the one to begin with."""
    habits = HABITS[method]
    return float(max(habits.least, min(LOOSEST, habits.first * accuracy) * 10.0**-decades))


def most_decades(method: str, accuracy: float) -> float:
    """Decades from the first tolerance down to the least."""
    return max(0.0, math.log10(tolerance(method, accuracy, 0.0) / HABITS[method].least))


def predicted(setting: Setting, other: Setting, seconds: float) -> float:
    """Seconds that a run takes at a setting, where one by the same method at another one took so many."""
    habits = HABITS[setting.method]
    steps: float = (other.rtol / setting.rtol) ** habits.steps
    size = setting.elements * setting.degree / (other.elements * other.degree)
    return float(seconds * steps * size**habits.growth)
