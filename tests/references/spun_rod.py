"""A straight spatial rod whose base is spun about its axis: the twist in closed form, from the start on.

The rod stays straight, stretch and shear at rest, bend zero. About the axis phi_t = phi V and phi' = phi E give
Omega1 = psi_t and Pi1 = psi' for the angle psi(u, t) of the section, and the balance of moment about the axis

    friction4 psi_t = stiffness4 psi'',   psi(0, t) = spin t,   psi'(L) = 0,   psi(u, 0) = 0.

In the steady state the rod turns as one, and each section passes on the drag of those beyond it,

    Pi1 = -friction4 spin (L - u) / stiffness4,   psi = spin t - friction4 spin (L u - u^2 / 2) / stiffness4,

many turns if need be. The approach is a sine series. The base is given the torque -M1(0), in the end friction4 spin L,
which spends that times spin. The rod whirls above a certain spin: see `whirl`. Source: separation of variables.

Dimensions: stiffness4 force x length^2; friction4 force x time; spin radians / time; angles unwrapped.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Rod:
    """Length, twisting stiffness, friction of rotation about the axis, and the spin of the base from t = 0 on."""

    length: float
    stiffness4: float
    friction4: float
    spin: float

    def waves(self, number: int) -> Array:
        """Wave numbers (1 / length) of the modes sin(q u): held at the base, without stress at the tip."""
        return np.asarray((np.arange(1, number + 1) - 0.5) * np.pi / self.length)

    def rates(self, number: int) -> Array:
        """Rates (1 / time) at which the modes decay."""
        return np.asarray(self.stiffness4 / self.friction4 * self.waves(number) ** 2)


def steady_twist(rod: Rod, u: npt.ArrayLike) -> Array:
    """Pi1 (1 / length) at u, (points,), in the end."""
    return np.asarray(-rod.friction4 * rod.spin / rod.stiffness4 * (rod.length - np.asarray(u, dtype=float)))


def steady_lag(rod: Rod, u: npt.ArrayLike) -> Array:
    """psi - spin t (radians) at u, (points,), in the end."""
    at = np.asarray(u, dtype=float)
    return np.asarray(-rod.friction4 * rod.spin / rod.stiffness4 * at * (rod.length - 0.5 * at))


def angle(rod: Rod, u: npt.ArrayLike, t: float, number: int = 400) -> Array:
    """psi (radians) at u, (points,). The series is exact to rounding once exp(-rate t) of its last term is."""
    at, wave = np.asarray(u, dtype=float), rod.waves(number)
    share = 2.0 / (rod.length * wave**3) * np.exp(-rod.rates(number) * t)
    rest = rod.friction4 * rod.spin / rod.stiffness4 * (share @ np.sin(wave[:, None] * at))
    return np.asarray(rod.spin * t + steady_lag(rod, at) + rest)


def twist(rod: Rod, u: npt.ArrayLike, t: float, number: int = 400) -> Array:
    """Pi1 (1 / length) at u, (points,)."""
    at, wave = np.asarray(u, dtype=float), rod.waves(number)
    share = 2.0 / (rod.length * wave**2) * np.exp(-rod.rates(number) * t)
    rest = rod.friction4 * rod.spin / rod.stiffness4 * (share @ np.cos(wave[:, None] * at))
    return np.asarray(steady_twist(rod, at) + rest)


def base_torque(rod: Rod, t: float, number: int = 400) -> float:
    """The torque (force x length) that the base is given about the axis; its power is that times the spin."""
    return float(-rod.stiffness4 * twist(rod, [0.0], t, number)[0])


def steady_torque(rod: Rod) -> float:
    """The same in the end: the drag of the whole rod."""
    return rod.friction4 * rod.spin * rod.length


def stored_energy(rod: Rod) -> float:
    """Energy (force x length) of the steady twist: the integral of M1^2 / (2 stiffness4)."""
    return (rod.friction4 * rod.spin) ** 2 * rod.length**3 / (6.0 * rod.stiffness4)


def work_of_base(rod: Rod, t: float, number: int = 400) -> float:
    """What the base has spent (force x length) up to t: the spin times the integral of its torque."""
    wave, rate = rod.waves(number), rod.rates(number)
    late = np.sum(2.0 / (rod.length * wave**2) * np.expm1(-rate * t) / rate)
    return float(rod.friction4 * rod.spin**2 * (rod.length * t + late))
