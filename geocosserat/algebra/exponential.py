"""Exponential, logarithm and the differential of the exponential, for both groups by the same polynomials.

Both algebras satisfy X^2 (X^2 + theta^2) = 0 as matrices and ad (ad^2 + theta^2)^2 = 0, so every entire
function of X is a polynomial in it, with Stumpff functions of s = theta^2 for coefficients: no cases, and
no singularity at zero. Pass another `c` (see `symbolic`) to get the same formulas for symbolic components.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from geocosserat.algebra.groups import SE2, SE3, Array, Group
from geocosserat.algebra.stumpff import stumpff

Stumpff = Callable[[int, Any], Any]


def exp(group: Group, X: Array, c: Stumpff = stumpff) -> Array:
    """Configuration exp(X): components (..., d), rotations in radians -> (..., size, size)."""
    X = np.asarray(X)
    s = _square(group, X)
    M = group.hat(X)
    M2 = M @ M
    out: Array = _eye(group.size, X) + M + _scale(c(2, s)) * M2 + _scale(c(3, s)) * (M2 @ M)
    return out


def log(group: Group, g: Array) -> Array:
    """Components X with exp(X) = g and rotation angle at most pi: (..., size, size) floats -> (..., d).

    Accurate at every angle, pi included; there, of the two answers, see `vector_from_rotation`.
    """
    w = vector_from_rotation(group.rotation(g))
    r = group.position(g)
    embedded = np.concatenate([np.zeros_like(r), w], axis=-1)
    W = group.rotation(group.hat(embedded))
    lam = _scale(_cotangent(_square(group, embedded), stumpff))
    Wr = W @ r[..., None]
    h = (r[..., None] - 0.5 * Wr + lam * (W @ Wr))[..., 0]
    return np.concatenate([h, w], axis=-1)


def dexp(group: Group, X: Array, c: Stumpff = stumpff) -> Array:
    """Left-trivialised differential: exp(X)^-1 d exp(X) = dexp(X) dX, so dexp(X) = (1 - e^{-ad X}) / ad X.

    (..., d) -> (..., d, d). The right-trivialised one, d exp(X) exp(X)^-1, is dexp(-X).
    """
    X = np.asarray(X)
    s = _square(group, X)
    A = group.ad(X)
    A2 = A @ A
    c2, c3, c4, c5 = (c(k, s) for k in (2, 3, 4, 5))
    even, odd = (c4 - 3 * c5) / 2, (c3 - 2 * c4) / 2
    out: Array = (
        _eye(group.dimension, X)
        - _scale(c2 + s * odd) * A
        + _scale(c3 + s * even) * A2
        - _scale(odd) * (A2 @ A)
        + _scale(even) * (A2 @ A2)
    )
    return out


def dexp_inverse(group: Group, X: Array, c: Stumpff = stumpff) -> Array:
    """Inverse of `dexp`, (ad X) / (1 - e^{-ad X}): (..., d) -> (..., d, d).

    Singular at a rotation of 2 pi.
    """
    X = np.asarray(X)
    s = _square(group, X)
    A = group.ad(X)
    A2 = A @ A
    lam, slope = _cotangent(s, c), _cotangent_slope(s, c)
    out: Array = _eye(group.dimension, X) + A / 2 + _scale(lam + s * slope) * A2 + _scale(slope) * (A2 @ A2)
    return out


def rotation_from_vector(v: Array, c: Stumpff = stumpff) -> Array:
    """Rotation matrix of a rotation vector in radians: (..., 1) -> (..., 2, 2) or (..., 3) -> (..., 3, 3)."""
    v = np.asarray(v)
    group = _group_by(v.shape[-1], {1: SE2, 3: SE3}, "a rotation vector with 1 or 3 components")
    padding = np.zeros((*v.shape[:-1], group.space), dtype=v.dtype)
    return group.rotation(exp(group, np.concatenate([padding, v], axis=-1), c))


def vector_from_rotation(R: Array) -> Array:
    """Rotation vector in radians, of length at most pi: (..., 2, 2) -> (..., 1) or (..., 3, 3) -> (..., 3).

    At exactly pi the two answers are opposite: in space, the one whose first non-zero component is positive.
    Through the unit quaternion, from the largest row of q q^T, so that nothing cancels at 0 or at pi.
    """
    R = np.asarray(R, dtype=np.float64)
    if _group_by(R.shape[-1], {2: SE2, 3: SE3}, "a rotation matrix of 2 or 3 rows") is SE2:
        return np.arctan2(R[..., 1, 0], R[..., 0, 0])[..., None]
    diagonal = np.einsum("...ii->...i", R)
    trace = diagonal.sum(axis=-1)
    Q = np.empty((*R.shape[:-2], 4, 4))  # 4 q q^T, real part first
    Q[..., 1:, 1:] = R + np.swapaxes(R, -1, -2)
    Q[..., 0, 0] = 1.0 + trace
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        Q[..., 1 + i, 1 + i] = 1.0 + 2.0 * diagonal[..., i] - trace
        Q[..., 0, 1 + i] = Q[..., 1 + i, 0] = R[..., k, j] - R[..., j, k]
    largest = np.einsum("...ii->...i", Q).argmax(axis=-1)
    q = np.take_along_axis(Q, largest[..., None, None], axis=-2)[..., 0, :]
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    first = np.take_along_axis(q, (q != 0.0).argmax(axis=-1)[..., None], axis=-1)
    q = np.where(first < 0.0, -q, q)
    imaginary = np.hypot.reduce(q[..., 1:], axis=-1)
    small = imaginary < 1e-300
    ratio = np.where(small, 2.0, 2.0 * np.arctan2(imaginary, q[..., 0]) / np.where(small, 1.0, imaginary))
    vector: Array = ratio[..., None] * q[..., 1:]
    return vector


def _square(group: Group, X: Array) -> Any:
    """Squared rotation angle of the components X."""
    w = X[..., group.translations :]
    return (w * w).sum(axis=-1)


def _cotangent(s: Any, c: Stumpff) -> Any:
    """(1 - (theta/2) cot(theta/2)) / theta^2 as a function of s = theta^2, regular at zero."""
    x = s / 4
    return (c(2, x) - c(3, x)) / (4 * c(1, x))


def _cotangent_slope(s: Any, c: Stumpff) -> Any:
    """Minus the derivative of `_cotangent` with respect to s (the same function seen from -theta^2)."""
    x = s / 4
    c1, c2, c3, c4, c5 = (c(k, x) for k in (1, 2, 3, 4, 5))
    return -((3 * c4 - c3 - 3 * c5) * c1 + (c2 - c3) ** 2) / (32 * c1**2)


def _scale(x: Any) -> Array:
    return np.asarray(x)[..., None, None]


def _eye(n: int, X: Array) -> Array:
    return np.eye(n, dtype=np.int64).astype(object) if X.dtype == object else np.eye(n)


def _group_by(found: int, table: dict[int, Group], expected: str) -> Group:
    if found not in table:
        raise ValueError(f"expected {expected}, found {found}; pass the last axis of one of these lengths")
    return table[found]
