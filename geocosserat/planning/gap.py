"""How far two rods lie apart."""

import numpy as np

from geocosserat.discretisation.mesh import Array, Mesh


def position_gap(coarse: Mesh, positions: Array, fine: Mesh, finer: Array) -> float:
    """Largest distance between two rods, (nodes, space) each, at the nodes of the coarse one; a length.

    The fine rod is interpolated in its elements: the gap estimates the error of the coarse one.
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
