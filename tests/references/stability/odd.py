"""A straight planar rod whose law couples stretch, shear and bend, in drag: what a law without an energy does to it.

With C the derivative of (F1, F2, M) by (h1, h2, Pi) at rest, a full matrix, the rod without loads, moved a little by
(x, y, theta) from rest at h1 = 1, obeys

    (x', y' - theta, theta') = C^-1 (F1, F2, M),    F1' = friction1 growth x,    F2' = friction2 growth y,
    M' = friction3 growth theta - F2,

clamped at u = 0 and free at u = L: six equations with constant coefficients. What is known without solving them:

* strains move by e_t = -X C e with X symmetric and positive, so while the symmetric part of C is positive the rod
  decays: an antisymmetric coupling, F2 = k2 h2 + a Pi, M = k3 Pi - a h2, never makes it grow, and a one-sided one, F2 =
  k2 h2 + a Pi, M = k3 Pi, not while a^2 < 4 k2 k3;
* X C and its transpose C^T X, which is like X C^T, have the same growths: it does not matter which side is coupled;
* of F1 = k1 (h1 - 1) + a Pi, M = k3 Pi the growths are those of a = 0: stretch does not act back on bending;
* no growth passes through zero while det C does not: at growth 0 all stress vanishes, from the tip on. So what a
  one-sided coupling brings about is flutter.

Source: C. Scheibner et al., Nature Physics 16 (2020) 475 (odd elasticity); K. Ishimoto, C. Moreau, K. Yasuda, PRX
Life 1 (2023) 023002 (odd filaments in drag). The equations are those of `linear_rod` with a full C.

Dimensions: C force, force x length and force x length^2; frictions as everywhere.
"""

from typing import Any

import numpy as np

from tests.references.stability.linear import Problem


def free(coupled: list[list[Any]], friction: tuple[float, float, float], length: float = 1.0) -> Problem:
    """The clamped-free rod near rest, Y = (x, y, theta, F1, F2, M); `coupled` is C."""
    compliance = np.linalg.inv(np.array(coupled, dtype=float))
    # once more by Newton's method, for the digits of extended precision
    exact = np.array(coupled, dtype=np.longdouble)
    compliance = compliance @ (2.0 * np.eye(3) - exact @ compliance)
    constant = np.zeros((6, 6), dtype=object)
    constant[:3, 3:] = compliance
    constant[1, 2] += 1.0
    constant[5, 4] = -1.0
    growing: Any = np.zeros((6, 6), dtype=object)
    growing[3:, :3] = np.diag(friction)
    rows = np.zeros((3, 6), dtype=object)
    rows[:, 3:] = np.eye(3)
    return Problem(length, (constant,), growing, (3, 4, 5), rows)
