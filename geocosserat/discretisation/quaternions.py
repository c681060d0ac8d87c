"""Quaternions, real part first, on the first axis of arrays: (4, ...)."""

import numpy as np
from numpy.typing import NDArray

from geocosserat.algebra.exponential import vector_from_rotation

Array = NDArray[np.float64]


def product(p: Array, q: Array) -> Array:
    """Their product."""
    a, b, c, d = p
    e, f, g, h = q
    return np.stack(
        [
            a * e - b * f - c * g - d * h,
            a * f + b * e + c * h - d * g,
            a * g - b * h + c * e + d * f,
            a * h + b * g - c * f + d * e,
        ]
    )


def spun(q: Array, spin: Array) -> Array:
    """Their products with vectors (3, ...), which are quaternions without a real part."""
    a, b, c, d = q
    x, y, z = spin
    out = np.empty_like(q)
    out[0] = -b * x - c * y - d * z
    out[1] = a * x + c * z - d * y
    out[2] = a * y + d * x - b * z
    out[3] = a * z + b * y - c * x
    return out


def turn(q: Array, vector: Array) -> Array:
    """Vectors (3, ...) turned by quaternions (4, ...) of any norm."""
    a, v = q[0], q[1:]
    twice = 2 * _cross(v, vector) / np.sum(q * q, axis=0)
    out: Array = vector + a * twice + _cross(v, twice)
    return out


def _cross(v: Array, w: Array) -> Array:
    return np.stack([v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]])


def of_rotation(rotation: Array) -> Array:
    """(4,) one of the two of a rotation matrix (3, 3)."""
    vector = vector_from_rotation(rotation)
    half = np.linalg.norm(vector) / 2
    return np.concatenate([[np.cos(half)], np.sinc(half / np.pi) * vector / 2])


def of_unit_norm(q: Array) -> Array:
    """The same directions, with norm one."""
    out: Array = q / np.linalg.norm(q, axis=0)
    return out
