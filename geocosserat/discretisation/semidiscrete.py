"""The semi-discrete rod: a structure, a mesh, and the numbers that a kernel takes."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geocosserat.algebra.exponential import rotation_from_vector
from geocosserat.discretisation.mesh import Array, Mesh, make_mesh
from geocosserat.discretisation.pose import Poses, cross_matrix, joined, march, plane_rotation
from geocosserat.discretisation.structure import Coefficient, RodStructure, structure_of
from geocosserat.model.expressions import Expression, evaluate, jump_positions
from geocosserat.model.records import RodModel, Scene

BATCH = 2**22
"""Numbers that the linear systems of a march may take at once."""


@dataclass(frozen=True, eq=False)
class SemiDiscrete:
    """Everything a kernel needs besides its code.

    uniform (.,), point (., points) and node (., nodes): coefficients in the order of the structure.
    base: orientation that poses are marched from: (1,) an angle or (9,) a rotation matrix by rows.
    state (size,): the initial state; turn by component, carried pose, two energies.
    anchor: position and orientation of the end that poses are marched from, at the start.
    """

    structure: RodStructure
    mesh: Mesh
    tables: Array
    uniform: Array
    point: Array
    node: Array
    base: Array
    state: Array
    anchor: Poses

    @property
    def unknowns(self) -> int:
        """Turn components at all Gauss points, plus a carried pose."""
        return self.structure.group.dimension * self.mesh.elements * self.mesh.degree + self.structure.carried

    def turn(self, states: Array) -> Array:
        """The turn (..., d, points) in states (..., size)."""
        d, Q = self.structure.group.dimension, self.mesh.elements * self.mesh.degree
        return states[..., : d * Q].reshape(*states.shape[:-1], d, Q)

    def poses(self, states: Array) -> Poses:
        """Poses at the nodes for states (frames, size) or (size,), marched from the held or the carried end."""
        if states.ndim == 2:  # in batches: the systems of the march take much more room than their solutions
            p = self.mesh.degree
            batch = max(1, BATCH // (9 * self.mesh.elements * p * (p + 1)))
            return joined([self._poses(states[i : i + batch]) for i in range(0, len(states), batch)])
        return self._poses(states)

    def _poses(self, states: Array) -> Poses:
        position, rotation, angle = self.anchor.position, self.anchor.rotation, self.anchor.angle
        if self.structure.base == "carried":
            position, rotation, angle = self._carried(states)
        end = "right" if self.structure.base == "right" else "left"
        return march(self.mesh, self.turn(states), position, rotation, angle, end)

    def _carried(self, states: Array) -> tuple[Array, Array, Array | None]:
        """Pose of the left end: its start, then the carried relative pose."""
        start, count = self.anchor, self.structure.carried
        pose = states[..., -2 - count : -2]
        if start.angle is not None:
            angle = start.angle + pose[..., 2]
            return start.position + pose[..., :2] @ start.rotation.T, plane_rotation(angle), angle
        a, v = pose[..., 3, None, None], pose[..., 4:]
        hat = cross_matrix(v)
        norm = a * a + np.sum(v * v, axis=-1)[..., None, None]
        turned = np.eye(3) + 2 / norm * (a * hat + hat @ hat)
        return start.position + pose[..., :3] @ start.rotation.T, start.rotation @ turned, None


def _field(e: Expression, parameters: Mapping[str, float], u: Array) -> Array:
    return np.broadcast_to(np.asarray(evaluate(e, {**parameters, "u": u}), dtype=float), u.shape)


def _mobility(model: RodModel, mesh: Mesh) -> Array:
    """(nodes, d, d) inverse of the friction; at a step, of the friction averaged over both sides by mass."""
    u = mesh.local_nodes()
    d = len(model.friction)
    friction = np.empty((*u.shape, d, d))
    for i in range(d):
        for j in range(d):
            friction[..., i, j] = _field(model.friction[i][j], model.parameters, u)
    weighted = friction * mesh.reference.masses[:, None, None]
    return np.asarray(np.linalg.inv(mesh.gather(weighted) / mesh.mass[:, None, None]), dtype=np.float64)


def _sample(structure: RodStructure, model: RodModel, mesh: Mesh) -> tuple[Array, Array, Array]:
    u, u_point = mesh.u, mesh.u_point
    inverse = _mobility(model, mesh)

    def mobility_of(c: Coefficient) -> Array:
        i, j = (int(k) - 1 for k in c.name.split("_")[1:])
        return inverse[:, i, j]

    def node_values(c: Coefficient) -> Array:
        if c.expression is None:
            return mobility_of(c)
        local = _field(c.expression, model.parameters, mesh.local_nodes())
        return mesh.gather(local * mesh.reference.masses) / mesh.mass

    def uniform_value(c: Coefficient) -> float:
        return float(mobility_of(c)[0] if c.expression is None else evaluate(c.expression, model.parameters))

    point = [_field(c.expression, model.parameters, u_point) for c in structure.at("point") if c.expression is not None]
    node = [node_values(c) for c in structure.at("node")]
    return (
        np.array([uniform_value(c) for c in structure.at("uniform")]),
        np.array(point).reshape(-1, len(u_point)),
        np.array(node).reshape(-1, len(u)),
    )


def _steps(scene: Scene) -> list[float]:
    """Where coefficients jump: elements must end there."""
    model = scene.model
    expressions: list[Expression] = [*model.reference, *scene.start.strain]
    for row in (*model.stiffness, *model.friction):
        expressions.extend(row)
    for effect in model.effects:
        expressions.extend(effect.force)
    return [x for e in expressions for x in jump_positions(e, model.length, model.parameters)]


def discretise(scene: Scene, elements: int, degree: int) -> SemiDiscrete:
    """The semi-discrete rod of a scene with at least `elements` elements of this degree."""
    model = scene.model
    structure = structure_of(model)
    mesh = make_mesh(model.length, elements, degree, _steps(scene))
    table = mesh.reference
    uniform, point, node = _sample(structure, model, mesh)
    turn = np.array([_field(e, model.parameters, mesh.u_point) for e in scene.start.strain])
    planar = structure.motion == "planar"
    if planar:
        angle = np.asarray(scene.start.rotation[0])
        rotation = plane_rotation(angle)
    else:
        angle = None
        rotation = rotation_from_vector(np.asarray(scene.start.rotation, dtype=float))
    position = np.asarray(scene.start.position, dtype=float)
    anchor = Poses(position, rotation, angle)
    if structure.base == "right":
        placed = march(mesh, turn, position, rotation, angle)
        anchor = Poses(
            placed.position[-1], placed.rotation[-1], None if placed.angle is None else np.asarray(placed.angle[-1])
        )
    carried = np.zeros(structure.carried)
    if structure.carried == 7:
        carried[3] = 1.0  # the quaternion of no rotation
    base = np.atleast_1d(anchor.angle) if anchor.angle is not None else anchor.rotation.ravel()
    tables = [
        table.values.T,
        table.slopes.T,
        table.weights[:, None] * table.values,
        table.weights[:, None] * table.slopes,
        table.running.T,
    ]
    return SemiDiscrete(
        structure=structure,
        mesh=mesh,
        tables=np.concatenate([t.ravel() for t in tables]),
        uniform=uniform,
        point=point,
        node=node,
        base=np.ascontiguousarray(base, dtype=float),
        state=np.concatenate([turn.ravel(), carried, [0.0, 0.0]]),
        anchor=anchor,
    )
