"""The height at which a column buckles under its own weight, clamped at its foot.

The weight q per length makes the tension -q (L - u), and h1 = 1 - q (L - u) / k1. No force acts across: Q = 0, and the
problem of `straight` without growth is k3 theta'' = T eta theta with eta = h1 - T / k2. Without stretch and shear

    k3 theta'' + q (L - u) theta = 0,   theta = sqrt(L - u) J_(-1/3)(2/3 sqrt(q / k3) (L - u)^(3/2)),

which has no slope at the top and vanishes at the foot when q L^3 / k3 = (3 j / 2)^2 with j = 1.866... the first zero
of J_(-1/3): 7.8373474... With stretch and shear the problem is solved by its power series.

Source: A. G. Greenhill, Proc. Camb. Phil. Soc. 4 (1881) 65; Timoshenko and Gere, *Theory of Elastic Stability*, 2.12.

Dimensions: q force / length.
"""

from typing import Any

import mpmath

from tests.references.stability.linear import Problem
from tests.references.stability.straight import Rod, State, problem, stretched


def classical() -> float:
    """q L^3 / k3 at which the rod without stretch and shear buckles."""
    with mpmath.workdps(30):
        zero = mpmath.findroot(lambda x: mpmath.besselj(-mpmath.mpf(1) / 3, x), mpmath.mpf("1.87"))
        return float((3 * zero / 2) ** 2)


def standing(rod: Rod, weight: Any) -> Problem:
    """The column near its straight state, under its weight (force / length)."""
    tension = [-weight * rod.length, weight]
    return problem(rod, State(tension=tension, stretch=stretched(rod, tension)), "clamped", "dead")
