"""Columns of Euler, Engesser and Haringx: at which load a straight planar rod buckles, with finite stretch and shear.

The load P makes the tension -P all along; with eta = h1 + P / k2 the problem of `straight` has no growth where

    k3 theta'' + eta P theta = -eta Q,     y' = eta theta + Q / k2,     Q constant.

* *Clamped-free, dead load*: Q = 0, theta = sin(pi u / 2 L), and h1 = 1 - P / k1:

      P (1 - P / k1 + P / k2) = k3 (pi / 2 L)^2.

* *Both ends in place*, as far apart as the rod is long at h1 = 1, and a reference stretch g > 1 (growth, heat): h1 = 1
  whatever g is, P = k1 (g - 1), and

      P (1 + P / k2) = k3 (pi / L)^2 between pins,    k3 (2 pi / L)^2 between clamps.

  Q = 0 in these modes. Those with Q: between pins none; between clamps tan(x) = x (1 - P / (eta k2)), x > pi, later.

This is Haringx's load, for the shear force of this rod is the one in its section. Were it the one across the bent axis,
it would be Engesser's, P = P_E / (1 + P_E / k2). Without stretch and shear both are Euler's, P_E.

Source: S. P. Timoshenko, J. M. Gere, *Theory of Elastic Stability*, article 2.17; J. A. Haringx, Philips Res. Rep. 3
(1948) 401; A. Magnusson, M. Ristinmaa, C. Ljung, Int. J. Solids Struct. 38 (2001) 8441 (with stretch).

Dimensions: P, k1, k2 force; k3 force x length^2; g none.
"""

import math
from typing import Any, Literal

from tests.references.stability.linear import Problem
from tests.references.stability.straight import Rod, State, problem, stretched

Ends = Literal["pinned", "clamped"]
WAVES: dict[Ends, int] = {"pinned": 1, "clamped": 2}


def _smallest(compliance: float, euler: float) -> float:
    """The P that grows from `euler` in P (1 + compliance P) = euler; none if it buckles at no load."""
    under = 1.0 + 4.0 * compliance * euler
    if under < 0.0:
        raise ValueError("expected a column that buckles, found one that is shortened too fast by its load")
    return 2.0 * euler / (1.0 + math.sqrt(under))


def dead_load(rod: Rod) -> float:
    """The dead load (force) on the free end at which the clamped-free rod buckles."""
    return _smallest(1.0 / rod.k2 - 1.0 / rod.k1, rod.bend * (math.pi / (2.0 * rod.length)) ** 2)


def growth(rod: Rod, ends: Ends) -> float:
    """The reference stretch g at which the rod with both ends in place buckles."""
    load = _smallest(1.0 / rod.k2, rod.bend * (WAVES[ends] * math.pi / rod.length) ** 2)
    return 1.0 + load / rod.k1


def loaded(rod: Rod, load: Any) -> Problem:
    """The clamped-free rod under a dead load, near its straight state."""
    return problem(rod, State(tension=[-load], stretch=stretched(rod, [-load])), "clamped", "dead")


def grown(rod: Rod, stretch: Any, ends: Ends) -> Problem:
    """The rod between its fixed ends, near its straight state, at the reference stretch."""
    return problem(rod, State(tension=[rod.k1 * (1 - stretch)]), ends, ends)
