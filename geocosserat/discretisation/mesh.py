"""The rod cut into elements."""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise
from math import ceil

import numpy as np
from numpy.typing import NDArray

from geocosserat.discretisation.quadrature import ReferenceElement, reference_element

Array = NDArray[np.float64]
ROUND_OFF = 16 * float(np.finfo(float).eps)
"""Relative to the length: steps nearer than this to each other, or to an end, are one and the same."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """Element edges (n+1,), a length, increasing; and the polynomial degree p in each element.

    Nodes (n p + 1,) are Gauss-Lobatto, shared between neighbours; points (n p,) are Gauss. joined: the first node and
    the last are one, which is listed twice.
    """

    edges: Array
    reference: ReferenceElement
    joined: bool = False

    @property
    def degree(self) -> int:
        return self.reference.degree

    @property
    def elements(self) -> int:
        return len(self.edges) - 1

    @property
    def half(self) -> Array:
        """(n,) half the length of each element."""
        return np.diff(self.edges) / 2

    @property
    def u_point(self) -> Array:
        """(n p,) material coordinate of the Gauss points."""
        return self._spread(self.reference.points).ravel()

    @property
    def u(self) -> Array:
        """(n p + 1,) material coordinate of the nodes; element edges exactly."""
        inner = self._spread(self.reference.nodes[:-1])
        inner[:, 0] = self.edges[:-1]
        return np.append(inner.ravel(), self.edges[-1])

    @property
    def mass(self) -> Array:
        """(n p + 1,) lumped mass of each node, a length: the Gauss-Lobatto weights, added up at shared nodes."""
        return self.gather(np.broadcast_to(self.reference.masses, (self.elements, self.degree + 1)))

    @property
    def weight(self) -> Array:
        """(n p,) Gauss weights, a length."""
        return np.outer(self.half, self.reference.weights).ravel()

    def gather(self, local: Array) -> Array:
        """Sum over elements of half length times a local nodal field, (n, p+1, ...) -> (n p + 1, ...)."""
        n, p = self.elements, self.degree
        scaled = local * self.half.reshape(-1, *[1] * (local.ndim - 1))
        total = np.zeros((n * p + 1, *local.shape[2:]))
        total[:-1] = scaled[:, :p].reshape(n * p, *local.shape[2:])
        total[p::p] += scaled[:, p]
        if self.joined:
            total[0] = total[-1] = total[0] + total[-1]
        return total

    def local_nodes(self) -> Array:
        """(n, p+1) coordinates of each element's own nodes, the outer ones a hair inside: one-sided values at steps."""
        places, hair = self._spread(self.reference.nodes), 4 * ROUND_OFF * self.edges[-1]
        places[:, 0], places[:, -1] = self.edges[:-1] + hair, self.edges[1:] - hair
        return places

    def _spread(self, x: Array) -> Array:
        middle = (self.edges[:-1] + self.edges[1:]) / 2
        return middle[:, None] + self.half[:, None] * x


def make_mesh(length: float, elements: int, degree: int, steps: Iterable[float] = (), joined: bool = False) -> Mesh:
    """A mesh of [0, length] with at least `elements` elements and an edge on every step inside.

    The pieces between steps are cut evenly, each into its share of the elements, rounded up.
    """
    gap = ROUND_OFF * length
    inside = sorted(float(x) for x in steps if gap < x < length - gap)
    breaks = [*(a for a, b in pairwise([0.0, *inside, length]) if b - a > gap), length]
    shares = [max(1, ceil(elements * (b - a) / length - 1e-9)) for a, b in pairwise(breaks)]
    pieces = [np.linspace(a, b, n + 1)[:-1] for (a, b), n in zip(pairwise(breaks), shares, strict=True)]
    edges = np.concatenate([*pieces, [length]])
    return Mesh(edges, reference_element(degree), joined)
