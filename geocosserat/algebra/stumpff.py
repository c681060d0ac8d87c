"""Stumpff functions c_k(s) = sum over n of (-s)^n / (2n + k)!, entire in s, numerically.

With s = theta^2 they replace cos theta, sin theta / theta, (1 - cos theta) / theta^2, ... with no singularity
at zero, and they are closed under differentiation: c_k' = (k c_{k+2} - c_{k+1}) / 2.
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[Any]


def stumpff(k: int, s: ArrayLike) -> Array:
    """c_k(s) of any real s (dimensionless, any shape): the same shape, to a relative error of about 1e-15.

    Below |s| = (k+1)(k+2)/2 by the nested series, whose terms then fall from the first on; beyond it by
    c_{k+2} = (1/k! - c_k)/s from the circular or hyperbolic functions, where nothing cancels any more.
    Overflows to inf for s below about -5e5. Raises ValueError for k < 0.
    """
    if k < 0:
        raise ValueError(f"k: expected an integer >= 0, found {k}; Stumpff functions start at c_0")
    s = np.asarray(s, dtype=np.float64)
    near = np.abs(s) <= _switch(k)
    if np.all(near):
        return _series(k, s)
    if not np.any(near):
        return _closed(k, s)
    out = np.empty_like(s)
    out[near] = _series(k, s[near])
    out[~near] = _closed(k, s[~near])
    return out


def stumpff_derivative(k: int, s: ArrayLike) -> Array:
    """Derivative of c_k with respect to s, from c_k' = (k c_{k+2} - c_{k+1}) / 2; the shape of s."""
    lower = stumpff(k + 1, s)
    return 0.5 * (k * stumpff(k + 2, s) - lower) if k else -0.5 * lower


def _switch(k: int) -> float:
    return 0.5 * (k + 1) * (k + 2)


@lru_cache(maxsize=64)
def _terms(k: int) -> int:
    """Number of series terms that reach 1e-18 of the first at the switch."""
    n, term = 0, 1.0
    while term > 1e-18:
        n += 1
        term *= _switch(k) / ((2 * n + k - 1) * (2 * n + k))
    return n


def _series(k: int, s: Array) -> Array:
    total = np.ones_like(s)
    for n in range(_terms(k), 0, -1):
        total = 1.0 - s * total / ((2 * n + k - 1) * (2 * n + k))
    return total / factorial(k)


def _closed(k: int, s: Array) -> Array:
    if k == 2:  # 1 - cos cancels at full turns; its half-angle form does not
        return 0.5 * stumpff(1, 0.25 * s) ** 2
    if k > 2:
        return (1.0 / factorial(k - 2) - stumpff(k - 2, s)) / s
    theta, error = _root(np.abs(s))
    # the first-order correction by the rounding error of the root keeps full accuracy at large s
    with np.errstate(over="ignore"):
        if k == 0:
            circular = np.cos(theta) - error * np.sin(theta)
            hyperbolic = np.cosh(theta) * (1.0 + error * np.tanh(theta))
        else:
            circular = (np.sin(theta) + error * np.cos(theta)) / (theta + error)
            hyperbolic = np.sinh(theta) * (1.0 + error / np.tanh(theta)) / (theta + error)
    return np.where(s > 0, circular, hyperbolic)


def _root(x: Array) -> tuple[Array, Array]:
    """Square root of x > 0 and what its rounding left out (the square is taken exactly, after Dekker)."""
    root = np.sqrt(x)
    high = root * 134217729.0
    high = high - (high - root)
    low = root - high
    square_error = ((x - high * high) - 2.0 * high * low) - low * low
    return root, square_error / (2.0 * root)
