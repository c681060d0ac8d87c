"""The static problem that everybody can do: a cantilever under a dead load at its tip, large deflection.

A round bar of length 1 and radius 0.02 with bending stiffness 1: stretch 1e4, shear 27/84 of that (what PyElastica
gives a bar without a Poisson ratio of its own), a force of 3 across the tip, which goes down by 0.6 of the length.
The error is the distance of the tip from where it belongs. That is found by shooting with an explicit method of
order 8 at 1e-13, from the balance of forces and moments alone: it shares nothing with any of the solvers.
"""

from functools import lru_cache

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from geocosserat.discretisation.mesh import Array

RADIUS, LOAD = 0.02, 3.0
STRETCH = 4.0 / RADIUS**2
STIFFNESS = (STRETCH, 27.0 / 84.0 * STRETCH, 1.0)
TARGETS = (1e-3, 1e-6)


def _slope(_: float, y: Array) -> Array:
    """Of x, y, angle, moment along the rod: the force is the load everywhere."""
    c, s = np.cos(y[2]), np.sin(y[2])
    f1, f2 = -LOAD * s, -LOAD * c
    h1, h2 = 1 + f1 / STIFFNESS[0], f2 / STIFFNESS[1]
    return np.array([h1 * c - h2 * s, h1 * s + h2 * c, y[3] / STIFFNESS[2], h2 * f1 - h1 * f2])


@lru_cache(maxsize=1)
def tip() -> Array:
    """Where the tip belongs (2,), a length."""

    def shot(moment: float) -> Array:
        return solve_ivp(_slope, (0.0, 1.0), [0.0, 0.0, 0.0, moment], "DOP853", rtol=1e-13, atol=1e-14).y[:, -1]

    return shot(brentq(lambda moment: shot(moment)[3], -1.2 * LOAD, -0.1 * LOAD, xtol=1e-14, rtol=1e-14))[:2]
