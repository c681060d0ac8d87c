"""Straight planar or spatial rods that only stretch: weight along the rod, extensional flow, traps; closed forms.

A rod that stays straight along x has r = (x(u, t), 0), h1 = x', F1 = k1 (x' - 1), all else at rest, and

    friction1 x_t = k1 x'' + f

* weight f = w, one end held: k1 (x' - 1) = w (L - u). Both ends held L apart: w (L / 2 - u). Let go unstretched, the
  displacement approaches these as a sine series; a free rod falls with w / friction1, unstretched.
* flow of velocity e x along x, both ends free: f = friction1 e x, so k1 x'' = -friction1 e x with x' = 1 at both ends:
  x = sin(q s) / (q cos(q L / 2)), s = u - L / 2, q^2 = friction1 e / k1. There is such a state while q L < pi (beyond,
  the rod is drawn out for ever); for e < 0 sines are hyperbolic. Modes cos(n pi u / L) grow at the rates
  e - k1 / friction1 (n pi / L)^2, so the centre leaves at the rate e.
* trap to the point 0, f = -trap x: the flow with e = -trap / friction1, so the rod is compressed and its centre returns
  at trap / friction1. Displaced across, all sections feel the same force: the centre returns at trap / friction2 and
  the rod is not bent, whatever the distance.
* trap to the line of the rest shape, f = -trap (r - r0): a shift is the same for all sections and decays with trap /
  friction1 along and trap / friction2 across, unstretched.

Source: direct integration; separation of variables. Dimensions: k1 force; frictions force x time / length^2; weight
force / length; trap force / length^2; e 1 / time.
"""

import math
from typing import Literal

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Ends = Literal["held-free", "held-held"]


def hanging(u: npt.ArrayLike, weight: float, k1: float, length: float, ends: Ends) -> tuple[Array, Array]:
    """Position x (length) and stretch h1 at u, each (points,), of the rod at rest; `weight` acts towards +x."""
    at = np.asarray(u, dtype=float)
    carried = weight * ((length if ends == "held-free" else 0.5 * length) - at)
    shift = weight * at * ((length - 0.5 * at) if ends == "held-free" else 0.5 * (length - at))
    return at + shift / k1, 1.0 + carried / k1


def sagging(
    u: npt.ArrayLike,
    t: float,
    weight: float,
    k1: float,
    friction1: float,
    length: float,
    ends: Ends,
    number: int = 400,
) -> tuple[Array, Array]:
    """Position and stretch at u, each (points,), at the time t after weight began to act on the unstretched rod.

    Exact to rounding once exp(-rate t) of term `number` is, that is, not at very early times.
    """
    at = np.asarray(u, dtype=float)
    order = np.arange(1, number + 1)
    wave = (order - 0.5 if ends == "held-free" else order) * np.pi / length
    share = 2.0 * weight / (k1 * length * wave**3) * np.exp(-k1 / friction1 * wave**2 * t)
    if ends == "held-held":
        share = share * (1.0 - (-1.0) ** order)
    position, stretch = hanging(at, weight, k1, length, ends)
    phase = wave[:, None] * at
    return position - share @ np.sin(phase), stretch - (share * wave) @ np.cos(phase)


def falling(weight: float, friction: float) -> float:
    """Velocity (length / time) of a free straight rod along an axis of its section: weight / friction of that axis."""
    return weight / friction


def extended(u: npt.ArrayLike, extension: float, k1: float, friction1: float, length: float) -> tuple[Array, Array]:
    """Position x and stretch h1 at u, each (points,), at rest in the flow x_t = extension x, centre at x = 0.

    Raises ValueError at and above the `critical_extension`.
    """
    if extension >= critical_extension(k1, friction1, length):
        raise ValueError(f"expected an extension below {critical_extension(k1, friction1, length)}, found {extension}")
    s = np.asarray(u, dtype=float) - 0.5 * length
    q = np.emath.sqrt(friction1 * extension / k1 + 0j)
    if q == 0.0:
        return s, np.ones_like(s)
    edge = np.cos(0.5 * q * length)
    return (np.sin(q * s) / (q * edge)).real, (np.cos(q * s) / edge).real


def critical_extension(k1: float, friction1: float, length: float) -> float:
    """The extension (1 / time) from which on no stretch balances the flow."""
    return k1 / friction1 * (math.pi / length) ** 2


def carried(
    u: npt.ArrayLike,
    t: float,
    extension: float,
    centre: float,
    k1: float,
    friction1: float,
    length: float,
    number: int = 400,
) -> tuple[Array, Array]:
    """Position and stretch at u, each (points,), of the rod that is put unstretched at `centre` at t = 0.

    For a trap to the point 0: extension = -trap / friction1. Below the critical extension.
    """
    at = np.asarray(u, dtype=float)
    position, stretch = extended(at, extension, k1, friction1, length)
    wave = np.arange(1, number + 1, 2) * np.pi / length  # the odd ones: start and end are odd about the middle
    # cosine coefficients of s - x(s): both have unit slope at the ends, so only x'' = -e friction1 / k1 x differs
    square = friction1 * extension / k1
    start = -4.0 / (length * wave**2)  # of s
    final = start * wave**2 / (wave**2 - square)
    share = (start - final) * np.exp((extension - k1 / friction1 * wave**2) * t)
    phase = wave[:, None] * at
    shift = centre * math.exp(extension * t)
    return position + shift + share @ np.cos(phase), stretch - (share * wave) @ np.sin(phase)


def returning(displacement: npt.ArrayLike, t: float, trap: float, friction: npt.ArrayLike) -> Array:
    """Displacement at t of a straight free rod that a trap to its own line pulls back.

    One entry for each axis of the section. Across the rod it is also that of a trap to a point.
    """
    rate = trap / np.asarray(friction, dtype=float)
    return np.asarray(np.asarray(displacement, dtype=float) * np.exp(-rate * t))
