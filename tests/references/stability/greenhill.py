"""A straight rod twisted between clamps until it buckles out of line, with and without tension.

The far end has been turned by the angle L Pi1 about the axis and both are held: M1 = k4 Pi1, and a reference stretch g
makes the tension T = k1 (1 - g), h1 = 1. Without stretch and shear the problem of `straight` at no growth is

    bend xi'''' - i M1 xi''' - T xi'' = 0,   xi = 1, u, exp(2 i A u / L), exp(2 i B u / L),
    A, B = M1 L / (4 bend) +- sqrt((M1 L / (4 bend))^2 - T L^2 / (4 bend)),

and with xi = xi' = 0 at both ends there is a solution when

    cot(A) - 1 / A = cot(B) - 1 / B

(B = 0: tan(A) = A, M1 L / bend = 2 x 4.4934 = 8.9868). Between ball joints that pass on the moment it would be A - B =
pi, Greenhill's (M1 / (2 bend))^2 - T / bend = (pi / L)^2. The ends being held, the rod has an energy and its growths
are real.

Source: A. G. Greenhill, Proc. Inst. Mech. Eng. 34 (1883) 182; A. E. H. Love, *Mathematical Theory of Elasticity*,
article 272; H. Ziegler, *Principles of Structural Stability*, chapter 4 (which ends have an energy).

Dimensions: M1 force x length; k4 force x length^2; Pi1 1 / length; T force.
"""

import math
from typing import Any

import mpmath

from tests.references.stability.linear import Problem
from tests.references.stability.straight import Rod, State, problem


def classical(tension: float = 0.0) -> float:
    """M1 L / bend at which the rod without stretch and shear buckles, for T L^2 / bend = `tension`, not negative."""
    with mpmath.workdps(30):
        pull = mpmath.mpf(tension)
        if pull == 0:
            return 2.0 * float(mpmath.findroot(lambda x: mpmath.sin(x) - x * mpmath.cos(x), 4.5))

        def miss(m: Any) -> Any:
            half = mpmath.sqrt(m * m / 16 - pull / 4)
            a, b = m / 4 + half, m / 4 - half
            return (a - b) * mpmath.sin(a) * mpmath.sin(b) - a * b * mpmath.sin(a - b)

        # at A = B both sides vanish: start above
        low = 4.0 * math.sqrt(0.25 * tension) * (1 + 1e-6)
        low = max(low, 8.9)
        step = 0.05
        while miss(mpmath.mpf(low)) * miss(mpmath.mpf(low + step)) > 0:
            low += step
        return float(mpmath.findroot(miss, (low, low + step), solver="anderson", tol=1e-25, verify=False))


def twisted(rod: Rod, moment: Any, tension: Any = 0.0) -> Problem:
    """The rod between clamps near its straight state, with the twisting moment and the tension, h1 = 1."""
    return problem(rod, State(tension=[tension], moment=[moment]), "clamped", "clamped")
