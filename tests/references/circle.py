"""Planar rod with a couple at its free end: an arc of a circle.

Rest state h1 = 1, h2 = 0 and a uniform curvature (by default none); clamped at the origin along x. No force
acts, so F1 = F2 = 0, the moment balance leaves M' = 0, and M = torque along the whole rod:
Pi = reference + torque / k3, whatever k1 and k2. A planar couple is the same in the body and in the world.
Source: direct integration.

Dimensions: torque force x length; k3 force x length^2; curvature 1 / length; angle in radians, unwrapped.
"""

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def curvature(torque: float, k3: float, reference: float = 0.0) -> float:
    """The uniform curvature Pi (1 / length) under an end couple."""
    return reference + torque / k3


def strain(u: npt.ArrayLike, torque: float, k3: float, reference: float = 0.0) -> Array:
    """(h1, h2, Pi) at u, shape (points, 3)."""
    return np.tile([1.0, 0.0, curvature(torque, k3, reference)], (np.size(u), 1))


def angle(u: npt.ArrayLike, torque: float, k3: float, reference: float = 0.0) -> Array:
    """Unwrapped angle of the section at u, shape (points,)."""
    return np.asarray(curvature(torque, k3, reference) * np.atleast_1d(np.asarray(u, dtype=float)))


def position(u: npt.ArrayLike, torque: float, k3: float, reference: float = 0.0) -> Array:
    """Centreline (length) at u, shape (points, 2): the chord u sinc(angle / 2), along half the angle."""
    half = 0.5 * angle(u, torque, k3, reference)
    chord = np.atleast_1d(np.asarray(u, dtype=float)) * np.sinc(half / np.pi)
    return np.stack([chord * np.cos(half), chord * np.sin(half)], axis=1)


def energy(length: float, torque: float, k3: float) -> float:
    """Stored energy (force x length) of the bent rod: torque^2 length / (2 k3)."""
    return 0.5 * torque**2 * length / k3
