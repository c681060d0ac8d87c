"""Poses of a rod of uniform turn E: phi(u) = phi(0) exp(u E), an arc in the plane and a helix in space.

Configuration matrices are [[1, 0], [r, R]]. The turn is (h1, h2, Pi) or (h1, h2, h3, Pi1, Pi2, Pi3), with r'
= R h and R' = R Pi^. Two methods: `pose` by the matrix exponential, `closed_pose` by Rodrigues' formula. Also
the geometry of the helix, and the uniform stress that holds a uniform turn in balance. Source: R. M. Murray,
Z. Li, S. S. Sastry, *A Mathematical Introduction to Robotic Manipulation*, chapter 2.

Dimensions: h none, Pi 1 / length, u and positions length, F force, M force x length.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm

Array = npt.NDArray[np.float64]


def hat(turn: npt.ArrayLike) -> Array:
    """The matrix of a turn of 3 (planar) or 6 (spatial) components, shape (3, 3) or (4, 4)."""
    e = np.asarray(turn, dtype=float)
    if e.size == 3:
        return np.array([[0.0, 0.0, 0.0], [e[0], 0.0, -e[2]], [e[1], e[2], 0.0]])
    return np.array(
        [
            [0.0, 0.0, 0.0, 0.0],
            [e[0], 0.0, -e[5], e[4]],
            [e[1], e[5], 0.0, -e[3]],
            [e[2], -e[4], e[3], 0.0],
        ]
    )


def pose(turn: npt.ArrayLike, u: npt.ArrayLike, base: npt.ArrayLike | None = None) -> Array:
    """Configurations at u by `scipy.linalg.expm`, shape (points, 3, 3) or (points, 4, 4).

    `base` is the configuration at u = 0, by default the identity.
    """
    matrix = hat(turn)
    start = np.eye(len(matrix)) if base is None else np.asarray(base, dtype=float)
    return np.stack([start @ expm(float(x) * matrix) for x in np.atleast_1d(np.asarray(u, dtype=float))])


def closed_pose(turn: npt.ArrayLike, u: npt.ArrayLike, base: npt.ArrayLike | None = None) -> Array:
    """The same by Rodrigues' formula: I + x A + c2 (x A)^2 + c3 (x A)^3, as A^4 = -|Pi|^2 A^2 for every turn.

    With s = (x |Pi|)^2: c2 = (1 - cos) / s, c3 = (x |Pi| - sin) / (x |Pi|)^3, by series where s is small.
    """
    matrix = hat(turn)
    start = np.eye(len(matrix)) if base is None else np.asarray(base, dtype=float)
    size = float(np.linalg.norm(np.asarray(turn, dtype=float)[-1 if len(matrix) == 3 else 3 :]))
    result = []
    for x in np.atleast_1d(np.asarray(u, dtype=float)):
        s = (x * size) ** 2
        if s < 1.0:
            c2, c3 = (sum((-s) ** n / math.factorial(2 * n + k) for n in range(10)) for k in (2, 3))
        else:
            root = math.sqrt(s)
            c2, c3 = 2.0 * math.sin(0.5 * root) ** 2 / s, (root - math.sin(root)) / (root * s)
        step = x * matrix
        result.append(start @ (np.eye(len(matrix)) + step + c2 * step @ step + c3 * step @ step @ step))
    return np.stack(result)


@dataclass(frozen=True)
class Geometry:
    """Radius (length), signed pitch (length, advance along the axis in one turn), unit axis, a point on it.

    Axis and point are in the frame of the base configuration.
    """

    radius: float
    pitch: float
    axis: Array
    point: Array


def geometry(turn: npt.ArrayLike) -> Geometry:
    """The helix of a spatial turn with Pi != 0 (Chasles): axis along Pi through Pi x h / |Pi|^2."""
    e = np.asarray(turn, dtype=float)
    h, rotation = e[:3], e[3:]
    size = float(np.linalg.norm(rotation))
    axis = rotation / size
    point = np.cross(rotation, h) / size**2
    return Geometry(float(np.linalg.norm(point)), 2.0 * np.pi * float(h @ axis) / size, axis, point)


def uniform_stress(turn: npt.ArrayLike, force: float, moment: float) -> Array:
    """A uniform stress (6,) that balances a uniform spatial turn: F = force Pi, M = force h + moment Pi.

    Then Pi x F = 0 and Pi x M + h x F = force (Pi x h + h x Pi) = 0. `force` has dimension force x length,
    `moment` force x length^2. Both ends must carry it; the reference that makes it elastic is E - K^-1 Sigma.
    """
    e = np.asarray(turn, dtype=float)
    return np.concatenate([force * e[3:], force * e[:3] + moment * e[3:]])
