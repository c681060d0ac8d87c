"""The reference element [-1, 1]: Gauss-Lobatto nodes, Gauss points and the maps between them.

Interpolation uses barycentric weights and integration the discrete orthogonality of the Legendre
polynomials; both stay accurate to round-off up to the largest degree offered (64).

Sources: C. Canuto et al., "Spectral Methods: Fundamentals in Single Domains" (2006), section 2.3;
J.-P. Berrut and L. N. Trefethen, SIAM Review 46 (2004) 501, section 9 (slopes).
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ReferenceElement:
    """Tables of one degree p on [-1, 1]; all dimensionless.

    nodes (p+1,), masses (p+1,)   Gauss-Lobatto nodes and weights (the lumped masses)
    points (p,), weights (p,)     Gauss points and weights
    values (p, p+1)               interpolation from nodes to points, B
    slopes (p, p+1)               derivative of the interpolant at the points, D
    running (p+1, p)              integral from -1 to each node of the interpolant on the points
    inner (p, p)                  the same up to each point
    """

    degree: int
    nodes: Array
    masses: Array
    points: Array
    weights: Array
    values: Array
    slopes: Array
    running: Array
    inner: Array

    def from_points(self, other: "ReferenceElement") -> Array:
        """(p, points of the other): values here of the polynomial through values at the Gauss points of the other."""
        q = other.degree - 1
        share = (2 * np.arange(q + 1) + 1) / 2  # of Legendre polynomials, one over their squares
        return _vandermonde(self.points, q) @ (share[:, None] * _vandermonde(other.points, q).T * other.weights)


def _vandermonde(x: Array, degree: int) -> Array:
    return np.asarray(legendre.legvander(x, degree), dtype=np.float64)


def _lobatto(degree: int) -> tuple[Array, Array]:
    """Nodes: the ends and the zeros of P_p'; masses 2 / (p (p+1) P_p(x)^2)."""
    highest = np.eye(degree + 1)[degree]
    inside = legendre.legroots(legendre.legder(highest)) if degree > 1 else np.empty(0)
    slope, curvature = legendre.legder(highest), legendre.legder(highest, 2)
    for _ in range(2):  # polish the eigenvalue solver's roots
        inside = inside - legendre.legval(inside, slope) / legendre.legval(inside, curvature)
    inside = (inside - inside[::-1]) / 2  # exactly symmetric
    nodes: Array = np.concatenate(([-1.0], inside, [1.0]))
    masses: Array = 2 / (degree * (degree + 1) * legendre.legval(nodes, highest) ** 2)
    return nodes, masses


def _integrals(x: Array, degree: int) -> Array:
    """(len(x), degree): integral from -1 to x of P_k, k < degree."""
    P = _vandermonde(x, degree)
    columns = [x + 1] + [(P[:, k + 1] - P[:, k - 1]) / (2 * k + 1) for k in range(1, degree)]
    return np.stack(columns, axis=1)


def _interpolation(nodes: Array, masses: Array, points: Array) -> tuple[Array, Array]:
    """Values and slopes at the points of the Lagrange polynomials of the nodes (barycentric form)."""
    signs = (-1.0) ** np.arange(len(nodes))
    gaps = points[:, None] - nodes[None, :]
    terms = signs * np.sqrt(masses) / gaps
    total = terms.sum(axis=1, keepdims=True)
    values: Array = terms / total
    slopes: Array = values * ((terms / gaps).sum(axis=1, keepdims=True) / total - 1 / gaps)
    # a constant has slope zero to round-off: the entry of the nearest node balances the rest
    rows, nearest = np.arange(len(points)), np.abs(gaps).argmin(axis=1)
    slopes[rows, nearest] = 0.0
    slopes[rows, nearest] = -slopes.sum(axis=1)
    return values, slopes


@lru_cache(maxsize=32)
def reference_element(degree: int) -> ReferenceElement:
    """The tables of `degree` p >= 1.

    Raises ValueError for a degree below 1.
    """
    if degree < 1:
        raise ValueError(f"expected a degree of at least 1, found {degree}")
    nodes, masses = _lobatto(degree)
    points, weights = legendre.leggauss(degree)
    # modal coefficients of values at the Gauss points
    gauss = (_vandermonde(points, degree - 1) * weights[:, None]).T * (np.arange(degree) + 0.5)[:, None]
    values, slopes = _interpolation(nodes, masses, points)
    return ReferenceElement(
        degree=degree,
        nodes=nodes,
        masses=masses,
        points=points,
        weights=weights,
        values=values,
        slopes=slopes,
        running=_integrals(nodes, degree) @ gauss,
        inner=_integrals(points, degree) @ gauss,
    )
