"""Whether a mesh notices all that a scene varies along the rod."""

from collections.abc import Mapping

import numpy as np

from geocosserat.algebra.groups import Group
from geocosserat.discretisation.mesh import Array, Mesh, make_mesh
from geocosserat.model.expressions import Expression, evaluate, jump_positions, symbols
from geocosserat.model.formulas import formulas, stepping
from geocosserat.model.law import pose_names, rates
from geocosserat.model.records import Scene

MANY_ELEMENTS = 64
"""Elements of degree 16 on which a scene's coefficients count as known."""


def sees_all(scene: Scene, elements: int, degree: int, accuracy: float) -> bool:
    """Whether the Gauss points of a mesh notice all that the scene varies along the rod.

    Two coarse runs that both miss a narrow feature agree with each other. So the integrals of every coefficient and of
    its square are compared with those on a thousand points; they must agree to the square root of the accuracy.
    """
    model = scene.model
    varying = [e for e in formulas(scene) if "u" in symbols(e)]
    steps = [x for e in stepping(scene, "u") for x in jump_positions(e, model.length, model.parameters)]
    state = _some_state(model.group, model.length)
    coarse, fine = (
        make_mesh(model.length, n, p, steps) for n, p in ((elements, degree), (MANY_ELEMENTS, 16))
    )
    for e in varying:
        for t in (0.0, 0.37 * scene.run.until, scene.run.until) if "t" in symbols(e) else (0.0,):
            values = {**state, **model.parameters, "t": t}
            exact, found = (_moments(e, mesh, values) for mesh in (fine, coarse))
            if np.any(np.abs(found[:2] - exact[:2]) > np.sqrt(accuracy) * exact[2:]):
                return False
    return True


def _some_state(group: Group, length: float) -> Mapping[str, float]:
    """Numbers for what a law sees: a turn, its rates and a pose with nothing special about them."""
    turn = [1.1, 0.07, -0.05][: group.translations] + [0.3 / length, 0.4 / length, -0.2 / length][: group.rotations]
    names = zip((*group.strain, *rates(group)), (*turn, *turn), strict=True)
    return {**dict.fromkeys(pose_names(group), 0.3), **dict(names)}


def _moments(e: Expression, mesh: Mesh, values: Mapping[str, float]) -> Array:
    """Integrals of e and of its square along the rod, and the largest they could be for its greatest value."""
    f = np.broadcast_to(evaluate(e, {**values, "u": mesh.u_point}), mesh.u_point.shape)
    most = float(np.abs(f).max())
    return np.array([mesh.weight @ f, mesh.weight @ f**2, *(most**k * mesh.edges[-1] for k in (1, 2))])
