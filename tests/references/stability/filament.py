"""Filaments pushed by forces that turn with them, in Stokes drag: a clamped one flutters.

The force P at the tip points along the rod towards its base, whatever its direction: T = -P and at the tip Q = T theta.
Or a density f does so all along: T = -f (L - u), the tip is free. The problem of `straight` without stretch, shear and
drag of rotation is, T being the tension,

    friction2 growth y = -k3 y'''' + T y'',   y = y' = 0 at the base,   y'' = y''' = 0 at the tip

(of a density, too, only T y'' is left: T' y' and the force f y' across cancel). With a force at the tip the solutions
are exponentials, and the determinant is Beck's,

    p^2 + 2 s + p sqrt(s) sin(a) sinh(b) + 2 s cos(a) cosh(b) = 0,   a^2, b^2 = sqrt(p^2 / 4 + s) +- p / 2

with p = P L^2 / k3, s = -growth friction2 L^4 / k3. Beck's column with inertia has -growth^2 for growth, and flutters
when two s meet, at p = 20.05; in drag those s then part into the complex plane and the rod flutters only when their
real part has gone through zero. Directions across the rod do not mix if it is not twisted: in space a rod flutters at
the smaller one of the loads of its two planes, and if they are equal, in both at once.

Source: M. Beck, ZAMP 3 (1952) 225; G. De Canio, E. Lauga, R. E. Goldstein, J. R. Soc. Interface 14 (2017) 20170491; F.
Ling, H. Guo, E. Kanso, J. R. Soc. Interface 15 (2018) 20180594 (in space); V. V. Bolotin, *Nonconservative Problems of
the Theory of Elastic Stability*.

Dimensions: P force; f force / length.
"""

from typing import Any

import mpmath

from tests.references.stability.linear import Problem
from tests.references.stability.straight import Rod, State, problem, stretched


def pushed_at_tip(rod: Rod, load: Any) -> Problem:
    """The filament near its straight state, with the force at its tip."""
    return problem(rod, State(tension=[-load], stretch=stretched(rod, [-load])), "clamped", "follower")


def pushed_along(rod: Rod, density: Any) -> Problem:
    """The filament near its straight state, with the force all along."""
    tension = [-density * rod.length, density]
    state = State(tension=tension, stretch=stretched(rod, tension), follower=-density)
    return problem(rod, state, "clamped", "dead")


def beck(load: Any, growth: Any) -> Any:
    """Beck's determinant, for L = k3 = friction2 = 1; not zero at once for s = p = 0 only."""
    p, s = mpmath.mpf(load), -mpmath.mpmathify(growth)
    root = mpmath.sqrt(p * p / 4 + s)
    a, b = mpmath.sqrt(root + p / 2), mpmath.sqrt(root - p / 2)
    return p * p + 2 * s + p * mpmath.sqrt(s) * mpmath.sin(a) * mpmath.sinh(b) + 2 * s * mpmath.cos(a) * mpmath.cosh(b)


def beck_flutter(value: float, frequency: float) -> tuple[float, float]:
    """Load and frequency of flutter next to an estimate, from Beck's determinant."""
    with mpmath.workdps(30):

        def condition(p: Any, w: Any) -> list[Any]:
            d = beck(p, mpmath.mpc(0, w)) / 1e6
            return [mpmath.re(d), mpmath.im(d)]

        found = mpmath.findroot(condition, (value, frequency), tol=1e-40)
        return float(found[0]), float(found[1])


def beck_meeting() -> float:
    """P L^2 / k3 at which the first two s meet: the load of Beck's column."""
    with mpmath.workdps(30):
        found = mpmath.findroot(
            lambda p, s: [beck(p, -s), mpmath.diff(lambda x: beck(p, -x), s)],
            (mpmath.mpf(20), mpmath.mpf(121)),
            tol=1e-20,
        )
        return float(found[0])
