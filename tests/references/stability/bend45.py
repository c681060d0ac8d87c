"""The 45 degree bend of Bathe and Bolourchi: an arc in a plane, clamped, with a dead force across the plane at its end.

Radius 100, a section of 1 x 1, E = 1e7, no Poisson effect: EA = 1e7, GA = 5e6, EI = 1e7 / 12; forces of 300, 450 and
600. Here the arc leaves the origin along x and bends to y, the force is along z; the tip is at (70.711, 29.289, 0) at
first. It is the spatial rod of `static_rod`, solved by shooting.

Published places of the tip, in these axes, each with 8 elements:

                                       300                  450                  600
    Bathe, Bolourchi 1979                                                        47.2  15.9  53.4
    Simo, Vu-Quoc 1986         58.84 22.33 40.08    52.32 18.62 48.39    47.23 15.79 53.37
    Cardona, Geradin 1988      58.64 22.14 40.35    52.11 18.38 48.59    47.04 15.55 53.50
    Crisfield 1990             58.53 22.16 40.53    51.93 18.43 48.79    46.84 15.61 53.71
    Ibrahimbegovic 1995                                                  46.90 15.56 53.61

They scatter for two reasons, which the exact solutions tell apart. First, the twisting stiffness: G J is 702 885 for a
square of this size if J is Saint-Venant's (0.14058), and 833 333 if it is I2 + I3; that alone moves the tip by 0.26,
0.13 and 0.13 at 600 (47.150 15.685 53.475 against 46.892 15.558 53.607). The first two rows lie near the polar one, the
last two near Saint-Venant's. Second, all but the last row replace the arc by 8 chords and what happens in each by a
polynomial, which is worth about 0.1. The shear area, 1 or 5/6, matters by less than 0.001.

A parabola in place of the arc, y = a x + b x^2 through its ends and its middle, with the stiffnesses `STIFFNESS`,
is what two programs with spectral elements compute under the name of this bend; they agree to 14 digits: `PUBLISHED`.

Source: K.-J. Bathe, S. Bolourchi, Int. J. Numer. Methods Eng. 14 (1979) 961; J. C. Simo, L. Vu-Quoc, Comput. Methods
Appl. Mech. Eng. 58 (1986) 79; A. Cardona, M. Geradin, Int. J. Numer. Methods Eng. 26 (1988) 2403; M. A. Crisfield,
Comput. Methods Appl. Mech. Eng. 81 (1990) 131; A. Ibrahimbegovic, Comput. Methods Appl. Mech. Eng. 122 (1995) 11.

Dimensions: as the source's, inches and pounds.
"""

import math

import numpy as np
import numpy.typing as npt

from tests.references import static_rod
from tests.references.stability.bent import State

Array = npt.NDArray[np.float64]

LENGTH = 25.0 * math.pi
LOADS = (300.0, 450.0, 600.0)
SAINT_VENANT = 702885.0  # GJ of a unit square, G = 5e6
POLAR = 5e6 / 6.0  # G (I2 + I3)
FRICTION = (1.0, 2.0, 2.0, 0.5, 0.5, 0.5)  # of the scene; none in the source
# the parabola of BeamDyn and Kynema: points, stiffness, displacement of its tip under 600 (their documentation)
POINTS = ((0.0, 0.0), (38.2683, 7.61205), (70.7107, 29.2893))
STIFFNESS = (1e7, 41.6667e5, 41.6667e5, 8.333e5, 8.333e5, 8.333e5)
PUBLISHED = (-23.6459716009048, -13.7208006040058, 53.5776450626989)


def stiffness(torsion: float, shear_area: float = 1.0) -> Array:
    """The diagonal of K."""
    return np.array([1e7, 5e6 * shear_area, 5e6 * shear_area, torsion, 1e7 / 12.0, 1e7 / 12.0])


def rest() -> Array:
    """E at rest."""
    return np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.01])


def solve(load: float, torsion: float, shear_area: float = 1.0) -> static_rod.Equilibrium:
    """The bend under the load (force) along z."""
    return static_rod.solve(
        static_rod.Rod(
            length=LENGTH,
            stiffness=stiffness(torsion, shear_area),
            reference=rest(),
            tip_force=(0.0, 0.0, load),
        )
    )


def parabola(load: float) -> static_rod.Equilibrium:
    """The parabola that is published as this bend, under the load (force) along z."""
    (x1, y1), (x2, y2) = POINTS[1:]
    b = (y2 / x2 - y1 / x1) / (x2 - x1)
    a = y1 / x1 - b * x1

    def speed(x: float) -> float:
        return math.hypot(1.0, a + 2.0 * b * x)

    def along(x: float) -> float:
        """Length from the clamp, the integral of the speed in closed form."""
        before, after = a, a + 2.0 * b * x
        return sum(sign * (t * math.hypot(1.0, t) + math.asinh(t)) for sign, t in ((1.0, after), (-1.0, before))) / (
            4.0 * b
        )

    def bend(u: float) -> list[float]:
        x = u
        for _ in range(50):
            step = (along(x) - u) / speed(x)
            x -= step
            if abs(step) < 1e-13:
                break
        return [1.0, 0.0, 0.0, 0.0, 0.0, 2.0 * b / speed(x) ** 3]

    cosine, sine = 1.0 / speed(0.0), a / speed(0.0)
    base = ((cosine, -sine, 0.0), (sine, cosine, 0.0), (0.0, 0.0, 1.0))
    return static_rod.solve(static_rod.Rod(along(x2), STIFFNESS, bend, tip_force=(0.0, 0.0, load), base_rotation=base))


def state(found: static_rod.Equilibrium, torsion: float) -> State:
    """The loaded bend as a state whose growths can be asked for."""
    return State(LENGTH, stiffness(torsion), FRICTION, rest(), found.base_stress)
