"""A stiff straight planar rod, magnetised along its axis, in a rotating field: when it follows, and how it lags.

A rod with the magnetic moment mu e_1 per length in the field B (cos(spin t + phase), sin(spin t + phase)) feels the
couple density mu B sin(spin t + phase - theta) and no force. A rigid rod on its straight line turns about its middle if
free, about the pin if pinned at an end, with v2 = Omega s at the distance s, so

    drag theta_t = mu B L sin(spin t + phase - theta),   drag = friction3 L + friction2 times the integral of s^2

and the lag delta = spin t + phase - theta obeys delta_t = spin - critical sin(delta), critical = mu B L / drag.

* |spin| <= critical: the rod follows with sin(delta) = spin / critical.
* |spin| > critical: it slips; on average it turns with sign(spin) (|spin| - sqrt(spin^2 - critical^2)).

At all times, from any start: the half lag is the direction of a vector carried by a constant matrix, see `director`.
The rod must be stiff: it carries F2 and M, and bends by their share of k2 and k3. Source: R. Adler, Proc. IRE 34
(1946) 351 (the equation of the lag).

Dimensions: moment times field, mu B, force; friction2 force x time / length^2; friction3 force x time; spin radians
/ time.
"""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from tests.references import director

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Rotor:
    """The rod and the field; `about` is what it turns about; `phase` the angle of the field at t = 0."""

    length: float
    friction2: float
    friction3: float
    torque: float  # mu B, couple per length when the rod is across the field
    spin: float
    phase: float = 0.0
    about: Literal["middle", "end"] = "middle"

    @property
    def drag(self) -> float:
        """Torque per angular velocity, force x length x time."""
        return self.friction3 * self.length + self.friction2 * self.length**3 / (
            12.0 if self.about == "middle" else 3.0
        )

    @property
    def critical(self) -> float:
        """The spin (radians / time) up to which the rod follows the field."""
        return self.torque * self.length / self.drag


def lag(rotor: Rotor) -> float:
    """The lag (radians) of the rod that follows. Raises ValueError above the critical spin."""
    if abs(rotor.spin) > rotor.critical:
        raise ValueError(f"expected a spin of at most {rotor.critical}, found {rotor.spin}: the rod does not follow")
    return math.asin(rotor.spin / rotor.critical)


def mean_velocity(rotor: Rotor) -> float:
    """The angular velocity (radians / time) of the rod, averaged over a long time."""
    slip = math.sqrt(max(0.0, rotor.spin**2 - rotor.critical**2))
    return math.copysign(abs(rotor.spin) - slip, rotor.spin)


def slip_period(rotor: Rotor) -> float:
    """The time in which a rod that does not follow loses one turn against the field."""
    return 2.0 * math.pi / math.sqrt(rotor.spin**2 - rotor.critical**2)


def angle(rotor: Rotor, start: float, t: float) -> float:
    """theta (radians, unwrapped) at t of the rod that was at `start`."""
    matrix = 0.5 * np.array([[rotor.critical, -rotor.spin], [rotor.spin, -rotor.critical]])
    change = 2.0 * director.turned(matrix, 0.5 * (rotor.phase - start), t)
    return start + rotor.spin * t - change


def stress(rotor: Rotor, u: npt.ArrayLike, lag: float) -> Array:
    """(F1, F2, M) at u, (points, 3), that the rigid rod carries at the lag.

    F2' = friction2 v2 and M' = -F2 + friction3 Omega - couple, from nothing at u = L; a pin is at u = 0.
    """
    at = np.asarray(u, dtype=float)
    turning = rotor.critical * math.sin(lag)
    middle = 0.5 * rotor.length if rotor.about == "middle" else 0.0
    s, end = at - middle, rotor.length - middle
    force = 0.5 * rotor.friction2 * turning * (s**2 - end**2)
    couple = rotor.friction3 * turning - rotor.torque * math.sin(lag)
    moment = couple * (s - end) - 0.5 * rotor.friction2 * turning * ((s**3 - end**3) / 3.0 - end**2 * (s - end))
    return np.stack([np.zeros_like(at), force, moment], axis=1)
