"""From an accuracy asked for to a solution that has it: refine until two successive answers agree."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geocosserat.discretisation.mesh import Array, Mesh, make_mesh
from geocosserat.model.expressions import Expression, evaluate, jump_positions, symbols
from geocosserat.model.records import Scene

ROUND_OFF = 1e-13
"""Tolerances below this only add round-off."""

DEFAULT_ACCURACY = 1e-6

MANY_ELEMENTS = 64
"""Elements of degree 16 on which a scene's coefficients count as known."""


@dataclass(frozen=True)
class Setting:
    """How finely to compute: elements, their degree, and the relative tolerance in time."""

    elements: int
    degree: int
    rtol: float


def ladder(accuracy: float) -> tuple[Setting, ...]:
    """Settings of growing cost: first the degree, then the elements; tolerances tighten along."""
    sizes = [(1, 8), (1, 16), (2, 16), (4, 16), (8, 16), (16, 16), (32, 16)]
    return tuple(
        Setting(elements, degree, max(ROUND_OFF, accuracy * 10.0 ** -(2 + 0.5 * step)))
        for step, (elements, degree) in enumerate(sizes)
    )


def sees_all(scene: Scene, setting: Setting, accuracy: float) -> bool:
    """Whether the Gauss points of a setting notice all that the scene varies along the rod.

    Two coarse runs that both miss a narrow feature agree with each other. So the integrals of every coefficient and of
    its square are compared with those on a thousand points; they must agree to the square root of the accuracy.
    """
    model = scene.model
    coefficients = [*model.reference, *scene.start.strain]
    coefficients += [e for effect in model.effects for values in effect.values().values() for e in values]
    coefficients += [e for row in (*model.stiffness, *model.friction) for e in row]
    varying = [e for e in coefficients if "u" in symbols(e)]
    steps = [x for e in varying for x in jump_positions(e, model.length, model.parameters)]
    coarse, fine = (
        make_mesh(model.length, n, p, steps) for n, p in ((setting.elements, setting.degree), (MANY_ELEMENTS, 16))
    )
    for e in varying:
        for t in (0.0, 0.37 * scene.run.until, scene.run.until) if "t" in symbols(e) else (0.0,):
            values = {**model.parameters, "t": t}
            exact, found = (_moments(e, mesh, values) for mesh in (fine, coarse))
            if np.any(np.abs(found[:2] - exact[:2]) > np.sqrt(accuracy) * exact[2:]):
                return False
    return True


def _moments(e: Expression, mesh: Mesh, values: Mapping[str, float]) -> Array:
    """Integrals of e and of its square along the rod, and the largest they could be for its greatest value."""
    f = np.broadcast_to(evaluate(e, {**values, "u": mesh.u_point}), mesh.u_point.shape)
    most = float(np.abs(f).max())
    return np.array([mesh.weight @ f, mesh.weight @ f**2, *(most**k * mesh.edges[-1] for k in (1, 2))])


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
