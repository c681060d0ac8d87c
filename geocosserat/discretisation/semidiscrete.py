"""The semi-discrete rod: a structure, a mesh, and the numbers that a kernel takes."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from geocosserat.algebra.exponential import rotation_from_vector
from geocosserat.discretisation.course import Course, course_of
from geocosserat.discretisation.feasible import check_feasible
from geocosserat.discretisation.mesh import Array, Mesh, make_mesh
from geocosserat.discretisation.pose import Poses, cross_matrix, joined, march, plane_rotation
from geocosserat.discretisation.quadrature import reference_element
from geocosserat.discretisation.sampling import PULL, PULL_AT_REST, along, frictionless, sample
from geocosserat.discretisation.structure import RodStructure
from geocosserat.discretisation.structuring import structure_of
from geocosserat.model.expressions import Expression, evaluate, jump_positions
from geocosserat.model.formulas import stepping
from geocosserat.model.records import End, Scene

BATCH = 2**22
"""Numbers that the linear systems of a march may take at once."""


@dataclass(frozen=True, eq=False)
class SemiDiscrete:
    """Everything a kernel needs besides its code.

    uniform (.,), point (., points) and node (., nodes): coefficients in the order of the structure.
    base: pose that poses are marched from, at the start, the angle or the rotation matrix by rows, then the position;
    if it is driven and the kernel has to know, then its course as a table, and that of the other end if guided.
    state (size,): the initial state; turn by component (of frozen modes the stress), stress of viscous modes, carried
    pose, two energies.
    anchor: position and orientation of the end that poses are marched from, at the start. course: its poses relative
    to that, if it is driven. guide: the poses at which the other end belongs, if it is driven as well.
    rest: the turn at rest, d expressions of u and t, and parameters: their parameters; what frozen modes are held at.
    quasi_static: whether a rotation has next to no friction, in place of none.
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
    course: Course | None
    guide: Course | None
    rest: tuple[Expression, ...]
    parameters: Mapping[str, float]
    quasi_static: bool

    @property
    def unknowns(self) -> int:
        """Turn and stress components at all Gauss points, plus a carried pose."""
        return len(self.structure.state_names) * self.mesh.elements * self.mesh.degree + self.structure.carried

    @property
    def algebraic(self) -> Array:
        """(size,) 1 for entries of the state that are fixed by a constraint, stresses of frozen and viscous modes; else
        0."""
        rows = np.repeat([float(fixed) for fixed in self.structure.constrained], self.mesh.elements * self.mesh.degree)
        mask = np.zeros(len(self.state))
        mask[: len(rows)] = rows
        return mask

    def turn(self, states: Array, times: Array | float = 0.0) -> Array:
        """The turn (..., d, points) in states (..., size) at their times (...)."""
        d, Q = self.structure.group.dimension, self.mesh.elements * self.mesh.degree
        turn = states[..., : d * Q].reshape(*states.shape[:-1], d, Q)
        if not any(self.structure.frozen):
            return turn
        turn = turn.copy()
        t = np.asarray(times, dtype=float)[..., None]
        for i, held in enumerate(self.structure.frozen):
            if held:
                turn[..., i, :] = evaluate(self.rest[i], {**self.parameters, "u": self.mesh.u_point, "t": t})
        return turn

    def poses(self, states: Array, times: Array | float = 0.0) -> Poses:
        """Poses at the nodes for states (frames, size) or (size,) at their times, marched from the base."""
        if states.ndim == 2:  # in batches: the systems of the march take much more room than their solutions
            p = self.mesh.degree
            batch = max(1, BATCH // (9 * self.mesh.elements * p * (p + 1)))
            t = np.broadcast_to(np.asarray(times, dtype=float), states.shape[:1])
            return joined([self._poses(states[i : i + batch], t[i : i + batch]) for i in range(0, len(states), batch)])
        return self._poses(states, times)

    def _poses(self, states: Array, times: Array | float) -> Poses:
        return march(self.mesh, self.turn(states, times), *self._anchored(states, times), self.structure.base)

    def _anchored(self, states: Array, times: Array | float) -> tuple[Array, Array, Array | None]:
        """Position, rotation and angle of the end that poses are marched from."""
        if self.course is not None:
            return self._moved(self.course.at(times))
        if self.structure.carried:
            return self._moved(states[..., -2 - self.structure.carried : -2])
        return self.anchor.position, self.anchor.rotation, self.anchor.angle

    def finer_poses(self, state: Array, t: float) -> tuple[Mesh, Poses]:
        """Poses of a state (size,), whose strains are polynomials in each element, marched with twice as many points;
        and the mesh of these."""
        mesh, p = self.mesh, self.mesh.degree
        fine = replace(mesh, reference=reference_element(2 * p))
        refined = fine.reference.from_points(mesh.reference)
        turn = self.turn(state, t).reshape(-1, mesh.elements, p) @ refined.T
        return fine, march(fine, turn.reshape(len(turn), -1), *self._anchored(state, t), self.structure.base)

    def _moved(self, pose: Array) -> tuple[Array, Array, Array | None]:
        """Pose of the base: its start, then this relative pose, position and angle or quaternion."""
        start = self.anchor
        if start.angle is not None:
            angle = start.angle + pose[..., 2]
            return start.position + pose[..., :2] @ start.rotation.T, plane_rotation(angle), angle
        a, v = pose[..., 3, None, None], pose[..., 4:]
        hat = cross_matrix(v)
        norm = a * a + np.sum(v * v, axis=-1)[..., None, None]
        turned = np.eye(3) + 2 / norm * (a * hat + hat @ hat)
        return start.position + pose[..., :3] @ start.rotation.T, start.rotation @ turned, None


def _steps(scene: Scene) -> list[float]:
    """Where coefficients jump: elements must end there."""
    model = scene.model
    return [x for e in stepping(scene, "u") for x in jump_positions(e, model.length, model.parameters)]


def _course(end: End, scene: Scene) -> Course | None:
    """The course of an end, if it is driven."""
    if end.twist is None:
        return None
    return course_of(end.twist, tuple(scene.model.parameters.items()), scene.run.until, scene.model.length)


def discretise(scene: Scene, elements: int, degree: int, anchored: bool = False) -> SemiDiscrete:
    """The semi-discrete rod of a scene with at least `elements` elements of this degree. anchored: see
    `structure_of`; for a rod that is to rest."""
    model = scene.model
    structure = structure_of(model, anchored)
    mesh = make_mesh(model.length, elements, degree, _steps(scene), joined=model.joined)
    table = mesh.reference
    turn = np.array([along(e, model.parameters, mesh.u_point) for e in scene.start.strain])
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
    placed = march(mesh, turn, anchor.position, anchor.rotation, anchor.angle, structure.base)
    check_feasible(model, mesh, placed)
    uniform, point, node = sample(structure, scene, mesh, placed, PULL_AT_REST if anchored else PULL)
    carried = np.zeros(structure.carried)
    if structure.carried == 7:
        carried[3] = 1.0  # the quaternion of no rotation
    orientation = np.atleast_1d(anchor.angle) if anchor.angle is not None else anchor.rotation.ravel()
    base = np.concatenate([orientation, anchor.position])
    ends = (model.left, model.right) if structure.base == "left" else (model.right, model.left)
    course, guide = (_course(end, scene) for end in ends)
    if course is not None and structure.increments:
        base = np.concatenate([base, course.table])
    if guide is not None:
        far = -1 if structure.base == "left" else 0
        guide = guide.placed(
            placed.position[far], placed.rotation[far], None if placed.angle is None else placed.angle[far]
        )
        base = np.concatenate([base, guide.table])
    tables = [
        table.values.T,
        table.slopes.T,
        table.weights[:, None] * table.values,
        table.weights[:, None] * table.slopes,
        table.running.T,
        table.inner.T,
    ]
    # stresses that constraints fix are found, not given
    unknown = np.where(np.array(structure.frozen)[:, None], 0.0, turn)
    viscous = np.zeros(sum(structure.viscous) * len(mesh.u_point))
    return SemiDiscrete(
        structure=structure,
        mesh=mesh,
        tables=np.concatenate([t.ravel() for t in tables]),
        uniform=uniform,
        point=point,
        node=node,
        base=base,
        state=np.concatenate([unknown.ravel(), viscous, carried, [0.0, 0.0]]),
        anchor=anchor,
        course=course,
        guide=guide,
        rest=model.reference,
        parameters=model.parameters,
        quasi_static=bool(frictionless(model)),
    )
