"""Random elements of both algebras, and a 40-digit exponential to compare with."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
from numpy.typing import NDArray

from geocosserat.algebra.groups import SE2, SE3, Group

Array = NDArray[Any]
GROUPS = (SE2, SE3)
ANGLES = (0.0, 1e-300, 1e-12, 1e-8, 1e-4, 0.1, 1.0, 2.5, np.pi - 1e-9, np.pi - 1e-13)


def components(group: Group, seed: int, batch: tuple[int, ...] = ()) -> Array:
    """Normal components of unit variance, (*batch, d)."""
    return np.random.default_rng(seed).normal(size=(*batch, group.dimension))


def with_angle(group: Group, angle: float, seed: int, batch: tuple[int, ...] = ()) -> Array:
    """Random components whose rotation part has this length."""
    X = components(group, seed, batch)
    w = X[..., group.translations :]
    X[..., group.translations :] = w * (angle / np.linalg.norm(w, axis=-1, keepdims=True))
    return X


def exact_exp(group: Group, X: Array) -> mp.matrix:
    """exp(X) by its power series in the current mpmath precision."""
    M = mp.matrix(group.size)
    for a, x in enumerate(X):
        M += mp.mpf(x) * mp.matrix(group.basis[a].tolist())
    return mp.expm(M, method="taylor")


def floats(M: mp.matrix) -> Array:
    """A numpy copy of an mpmath matrix."""
    return np.array(M.tolist(), dtype=float)
