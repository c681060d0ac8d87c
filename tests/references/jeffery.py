"""A rigid straight free planar rod in a linear flow, u(r) = velocity + G r: Jeffery's orbit, and the stress carried.

The rod r = X + s e_1(theta), -L/2 <= s <= L/2, moves with v = X_t + s theta_t e_2. Force density and couple density on
it are those of the drag relative to the flow, which itself turns with half its vorticity, w = (G_21 - G_12) / 2:

    f1 = friction1 e_1 . (u - v),   f2 = friction2 e_2 . (u - v),   m = friction3 (w - theta_t)

No force in all: X_t = velocity + G X. No torque in all, with e_2 . G e_1 = w + e_2 . S e_1, S the symmetric part of G:

    theta_t = w + B e_2 . S e_1,   B = friction2 L^2 / 12 / (friction2 L^2 / 12 + friction3)

Jeffery's equation with the shape factor B; friction1 has no part in it. The director e_1 is the direction of a vector
that W + B S carries (W the antisymmetric part), see `director`. In the shear u = (g y, 0) this is theta_t =
-g / 2 (1 - B cos(2 theta)), and a full turn takes 4 pi / (g sqrt(1 - B^2)). The rod keeps its shape only if it carries
(F1' + f1 = 0 and so on)

    F1 = friction1 (e_1 . G e_1) (L^2 / 4 - s^2) / 2
    F2 = friction2 (e_2 . G e_1 - theta_t) (L^2 / 4 - s^2) / 2
    M  = friction2 (e_2 . G e_1 - theta_t) s (s^2 - L^2 / 4) / 6

so an elastic rod follows to first order in flow over stiffness. Source: G. B. Jeffery, Proc. R. Soc. A 102 (1922) 161;
F. P. Bretherton, J. Fluid Mech. 14 (1962) 284.

Dimensions: friction1, friction2 force x time / length^2; friction3 force x time; G 1 / time; angles unwrapped.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm

from tests.references import director

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Rod:
    """A rod in a flow; gradient is G (2, 2), with G_ij = d u_i / d x_j; velocity (2,) is that at the origin."""

    length: float
    friction1: float
    friction2: float
    friction3: float
    gradient: npt.ArrayLike
    velocity: npt.ArrayLike = (0.0, 0.0)

    @property
    def flow(self) -> Array:
        """G as an array."""
        return np.asarray(self.gradient, dtype=float)

    @property
    def vorticity(self) -> float:
        """Half the vorticity, 1 / time: the angular velocity w of the flow."""
        return 0.5 * float(self.flow[1, 0] - self.flow[0, 1])

    @property
    def shape(self) -> float:
        """Bretherton's number B, 0 to 1."""
        across = self.friction2 * self.length**2 / 12.0
        return across / (across + self.friction3)


def frame(theta: float) -> tuple[Array, Array]:
    """e_1 and e_2 at the angle theta."""
    c, s = math.cos(theta), math.sin(theta)
    return np.array([c, s]), np.array([-s, c])


def angular_velocity(rod: Rod, theta: float) -> float:
    """theta_t (radians / time) at theta."""
    e1, e2 = frame(theta)
    strain = 0.5 * (rod.flow + rod.flow.T)
    return rod.vorticity + rod.shape * float(e2 @ strain @ e1)


def angle(rod: Rod, start: float, t: float) -> float:
    """theta (radians) at t of the rod that was at `start`."""
    spin = 0.5 * (rod.flow - rod.flow.T)
    strain = 0.5 * (rod.flow + rod.flow.T)
    return start + director.turned(spin + rod.shape * strain, start, t)


def centre(rod: Rod, start: npt.ArrayLike, t: float) -> Array:
    """The middle of the rod, (2,), at t: it goes with the flow."""
    affine = np.zeros((3, 3))
    affine[:2, :2], affine[:2, 2] = rod.flow, rod.velocity
    return np.asarray((expm(affine * t) @ [*np.asarray(start, dtype=float), 1.0])[:2])


def position(rod: Rod, u: npt.ArrayLike, start: npt.ArrayLike, start_angle: float, t: float) -> Array:
    """The rod at u (0 to L), (points, 2), at t; `start` is its middle at t = 0."""
    s = np.asarray(u, dtype=float) - 0.5 * rod.length
    return centre(rod, start, t) + s[:, None] * frame(angle(rod, start_angle, t))[0]


def period_in_shear(rod: Rod) -> float:
    """The time of a full turn in a simple shear."""
    shear = max(abs(rod.flow[0, 1]), abs(rod.flow[1, 0]))
    return 4.0 * math.pi / (float(shear) * math.sqrt(1.0 - rod.shape**2))


def angle_in_shear(rod: Rod, start: float, t: float) -> float:
    """theta at t in the shear u = (g y, 0), by Jeffery's own formula.

    tan(theta) = c tan(phase), c^2 = (1 - B) / (1 + B), and the phase goes down at the rate g sqrt(1 - B^2) / 2.
    """
    c = math.sqrt((1.0 - rod.shape) / (1.0 + rod.shape))

    def mapped(x: float, ratio: float) -> float:
        """The angle whose tangent is ratio tan(x), in the same quarter of the same turn."""
        return x + math.atan2((ratio - 1.0) * math.sin(x) * math.cos(x), math.cos(x) ** 2 + ratio * math.sin(x) ** 2)

    rate = 0.5 * float(rod.flow[0, 1]) * math.sqrt(1.0 - rod.shape**2)
    return mapped(mapped(start, 1.0 / c) - rate * t, c)


def stress(rod: Rod, u: npt.ArrayLike, theta: float) -> Array:
    """(F1, F2, M) at u (0 to L), (points, 3), that the rigid rod carries at the angle theta."""
    s = np.asarray(u, dtype=float) - 0.5 * rod.length
    e1, e2 = frame(theta)
    along = rod.friction1 * float(e1 @ rod.flow @ e1)
    across = rod.friction2 * (float(e2 @ rod.flow @ e1) - angular_velocity(rod, theta))
    bulge = 0.25 * rod.length**2 - s**2
    return np.stack([0.5 * along * bulge, 0.5 * across * bulge, -across * s * bulge / 6.0], axis=1)
