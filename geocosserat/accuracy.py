"""From an accuracy asked for to a solution that has it: refine until two successive answers agree."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from geocosserat.discretisation.mesh import Array, Mesh

ROUND_OFF = 1e-13
"""Tolerances below this only add round-off."""

DEFAULT_ACCURACY = 1e-6


@dataclass(frozen=True)
class Setting:
    """How finely to compute: elements, their degree, and the relative tolerance in time."""

    elements: int
    degree: int
    rtol: float


def ladder(accuracy: float) -> Iterator[Setting]:
    """Settings of growing cost: first the degree, then the elements; tolerances tighten along."""
    settings = [(1, 8), (1, 16), (2, 16), (4, 16), (8, 16), (16, 16), (32, 16)]
    for step, (elements, degree) in enumerate(settings):
        yield Setting(elements, degree, max(ROUND_OFF, accuracy * 10.0 ** -(1 + 0.5 * step)))


def position_gap(coarse: Mesh, positions: Array, fine: Mesh, finer: Array) -> float:
    """Largest distance between two rods, (nodes, space) each, at the nodes of the coarse one; a length.

    The fine rod is interpolated in its elements: it bounds the error of the coarse one.
    """
    return float(np.linalg.norm(interpolate(fine, finer, coarse.u) - positions, axis=1).max())


def interpolate(mesh: Mesh, values: Array, u: Array) -> Array:
    """Nodal values (nodes, ...) as polynomials in each element, at coordinates u (m,) in [0, length]."""
    n, p = mesh.elements, mesh.degree
    element = np.clip(np.searchsorted(mesh.edges, u, side="right") - 1, 0, n - 1)
    nodes, masses = mesh.reference.nodes, mesh.reference.masses
    x = (u - (mesh.edges[element] + mesh.half[element])) / mesh.half[element]
    gaps = x[:, None] - nodes
    hit = np.abs(gaps) < 1e-13
    terms = (-1.0) ** np.arange(p + 1) * np.sqrt(masses) / np.where(hit, 1.0, gaps)
    weights = np.where(hit.any(axis=1, keepdims=True), hit, terms / terms.sum(axis=1, keepdims=True))
    local = values[element[:, None] * p + np.arange(p + 1)]
    result: Array = np.einsum("mn,mn...->m...", weights, local)
    return result
