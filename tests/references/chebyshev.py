"""Chebyshev collocation on [0, length]: the second method that several references are checked against.

Source: L. N. Trefethen, *Spectral Methods in MATLAB*, chapter 6 (`cheb`), mapped and put in increasing order.
"""

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def points(degree: int, length: float) -> Array:
    """Chebyshev-Lobatto points in [0, length], increasing, shape (degree + 1,), length."""
    return np.asarray(length * np.sin(0.5 * np.pi * np.arange(degree + 1) / degree) ** 2)


def derivative(degree: int, length: float) -> Array:
    """Matrix that differentiates the interpolant at `points`, shape (degree + 1, degree + 1), 1 / length."""
    x = points(degree, length)
    weight = np.ones(degree + 1)
    weight[[0, -1]] = 2.0
    weight *= (-1.0) ** np.arange(degree + 1)
    matrix = np.outer(weight, 1.0 / weight) / (x[:, None] - x[None, :] + np.eye(degree + 1))
    matrix -= np.diag(matrix.sum(axis=1))  # rows annihilate constants: more accurate than the closed diagonal
    return np.asarray(matrix)


def integral(degree: int, length: float, fixed: int) -> Array:
    """Matrix of the antiderivative that vanishes at point number `fixed` (0 or -1); same shape, length."""
    keep = np.arange(degree + 1) != (fixed % (degree + 1))
    result = np.zeros((degree + 1, degree + 1))
    # y of degree N has a slope of degree N - 1, which the N other points determine: the integrand's value at
    # the fixed point is not used
    result[keep, :] = np.linalg.solve(
        derivative(degree, length)[np.ix_(keep, keep)], np.eye(degree + 1)[keep]
    )
    return result
