"""The semi-discrete rod: a structure, a mesh, and the numbers that a kernel takes."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geocosserat.algebra.exponential import rotation_from_vector
from geocosserat.discretisation.mesh import Array, Mesh, make_mesh
from geocosserat.discretisation.pose import Poses, cross_matrix, joined, march, plane_rotation
from geocosserat.discretisation.structure import Coefficient, RodStructure
from geocosserat.discretisation.structuring import structure_of
from geocosserat.model.expressions import Expression, Number, evaluate, jump_positions
from geocosserat.model.records import RodModel, Scene

BATCH = 2**22
"""Numbers that the linear systems of a march may take at once."""


@dataclass(frozen=True, eq=False)
class SemiDiscrete:
    """Everything a kernel needs besides its code.

    uniform (.,), point (., points) and node (., nodes): coefficients in the order of the structure.
    base: pose that poses are marched from, the angle or the rotation matrix by rows, then the position.
    state (size,): the initial state; turn by component (of frozen modes the stress), carried pose, two energies.
    anchor: position and orientation of the end that poses are marched from, at the start.
    rest: the turn at rest, d expressions of u and t, and parameters: their parameters; what frozen modes are held at.
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
    rest: tuple[Expression, ...]
    parameters: Mapping[str, float]

    @property
    def unknowns(self) -> int:
        """Turn or stress components at all Gauss points, plus a carried pose."""
        return self.structure.group.dimension * self.mesh.elements * self.mesh.degree + self.structure.carried

    @property
    def algebraic(self) -> Array:
        """(size,) 1 for entries of the state that are fixed by a constraint, stresses of frozen modes; else 0."""
        d, Q = self.structure.group.dimension, self.mesh.elements * self.mesh.degree
        mask = np.zeros(len(self.state))
        mask[: d * Q] = np.repeat([float(held) for held in self.structure.frozen], Q)
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
            return joined(
                [self._poses(states[i : i + batch], t[i : i + batch]) for i in range(0, len(states), batch)]
            )
        return self._poses(states, times)

    def _poses(self, states: Array, times: Array | float) -> Poses:
        position, rotation, angle = self.anchor.position, self.anchor.rotation, self.anchor.angle
        if self.structure.moving_base:
            position, rotation, angle = self._carried(states)
        return march(self.mesh, self.turn(states, times), position, rotation, angle, self.structure.base)

    def _carried(self, states: Array) -> tuple[Array, Array, Array | None]:
        """Pose of the base: its start, then the carried relative pose."""
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


SLACK, PULL = 1e-12, 1e5

QUASI_STATIC = 1e-10
"""Friction of a rotation that has none, relative to what the other motions of a rod of this length feel.

A balance without friction is the limit of one with ever less; what is left of it shows in the answer as an error of
this size (docs/method.md), and lets the same kernels serve.
"""


def _field(e: Expression, parameters: Mapping[str, float], u: Array) -> Array:
    return np.broadcast_to(np.asarray(evaluate(e, {**parameters, "u": u}), dtype=float), u.shape)


def _friction(model: RodModel, mesh: Mesh) -> Array:
    """(nodes, d, d) friction; at a step, averaged over both sides by mass."""
    u = mesh.local_nodes()
    d = len(model.friction)
    friction = np.empty((*u.shape, d, d))
    for i in range(d):
        for j in range(d):
            friction[..., i, j] = _field(model.friction[i][j], model.parameters, u)
    weighted = friction * mesh.reference.masses[:, None, None]
    mean = mesh.gather(weighted) / mesh.mass[:, None, None]
    for i in range(model.group.translations, d):
        if all(model.friction[i][j] == Number(0.0) for j in range(d)):
            mean[:, i, i] = QUASI_STATIC * model.length**2 * mean[:, 0, 0]
    return mean


def _sample(structure: RodStructure, model: RodModel, mesh: Mesh, start: Poses) -> tuple[Array, Array, Array]:
    u, u_point = mesh.u, mesh.u_point
    friction = _friction(model, mesh)
    turns = slice(model.group.translations, None)
    matrices = {
        "mobility": np.linalg.inv(friction),
        "left_friction": friction[:1],
        "right_friction": friction[-1:],
        "left_mobility": _padded(np.linalg.inv(friction[:1, turns, turns])),
        "right_mobility": _padded(np.linalg.inv(friction[-1:, turns, turns])),
    }

    homes = {f"{side}_{name}": x for side, n in (("left", 0), ("right", -1)) for name, x in _home(start, n).items()}
    homes["left_pull"] = homes["right_pull"] = _pull(model, friction)

    def entry(c: Coefficient) -> Array:
        if c.name in homes:
            return np.array([homes[c.name]])
        if c.name.startswith("slack_"):
            return np.array([_slack(model, friction, c.name.removeprefix("slack_"))])
        stem, i, j = c.name.rsplit("_", 2)
        return np.asarray(matrices[stem][:, int(i) - 1, int(j) - 1])

    def node_values(c: Coefficient) -> Array:
        if c.expression is None:
            return entry(c)
        local = _field(c.expression, model.parameters, mesh.local_nodes())
        return mesh.gather(local * mesh.reference.masses) / mesh.mass

    def uniform_value(c: Coefficient) -> float:
        return float(entry(c)[0] if c.expression is None else evaluate(c.expression, model.parameters))

    point = [_field(c.expression, model.parameters, u_point) for c in structure.at("point") if c.expression is not None]
    node = [node_values(c) for c in structure.at("node")]
    return (
        np.array([uniform_value(c) for c in structure.at("uniform")]),
        np.array(point).reshape(-1, len(u_point)),
        np.array(node).reshape(-1, len(u)),
    )


def _slack(model: RodModel, friction: Array, stress: str) -> float:
    """How much a frozen mode yields to its stress where both ends are held (1 / time / stress).

    A straight rod held at both ends may carry any tension. The least one is taken: that of a rod that yields by SLACK of
    what friction lets it.
    """
    order = 2 if stress.startswith("F") else 4
    return SLACK / (float(friction[:, 0, 0].max()) * model.length**order)


def _home(start: Poses, n: int) -> dict[str, float]:
    """Where node n is at the start, by the names of the coefficients that say so."""
    rotation, axes = start.rotation[n], "xyz"[: start.position.shape[-1]]
    found = {f"home_{axis}": float(x) for axis, x in zip(axes, start.position[n], strict=True)}
    found |= {f"home_{i + 1}{axis}": float(rotation[k, i]) for k, axis in enumerate(axes) for i in range(len(axes))}
    return found | {"home_cos": float(rotation[0, 0]), "home_sin": float(rotation[1, 0])}


def _pull(model: RodModel, friction: Array) -> float:
    """How fast an end that strayed returns (1 / time): PULL times as fast as the softest mode of the rod relaxes."""
    middle = {**model.parameters, "u": model.length / 2}
    turns = range(model.group.translations, model.group.dimension)
    soft = min(float(evaluate(model.stiffness[i][i], middle)) for i in turns)
    return PULL * soft / (float(friction[:, 0, 0].max()) * model.length**4)


def _padded(turns: NDArray[np.floating[Any]]) -> Array:
    """Matrices for rotations as matrices for all motions: translations, of which there are 2 or 3, come first."""
    before = 2 if turns.shape[-1] == 1 else 3
    return np.pad(turns, ((0, 0), (before, 0), (before, 0))).astype(np.float64)


def _steps(scene: Scene) -> list[float]:
    """Where coefficients jump: elements must end there."""
    model = scene.model
    expressions: list[Expression] = [*model.reference, *scene.start.strain]
    for row in (*model.stiffness, *model.friction):
        expressions.extend(row)
    for effect in model.effects:
        for values in effect.values().values():
            expressions.extend(values)
    return [x for e in expressions for x in jump_positions(e, model.length, model.parameters)]


def discretise(scene: Scene, elements: int, degree: int) -> SemiDiscrete:
    """The semi-discrete rod of a scene with at least `elements` elements of this degree."""
    model = scene.model
    structure = structure_of(model)
    mesh = make_mesh(model.length, elements, degree, _steps(scene), joined=model.joined)
    table = mesh.reference
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
    placed = march(mesh, turn, anchor.position, anchor.rotation, anchor.angle, structure.base)
    uniform, point, node = _sample(structure, model, mesh, placed)
    carried = np.zeros(structure.carried)
    if structure.carried == 7:
        carried[3] = 1.0  # the quaternion of no rotation
    orientation = np.atleast_1d(anchor.angle) if anchor.angle is not None else anchor.rotation.ravel()
    tables = [
        table.values.T,
        table.slopes.T,
        table.weights[:, None] * table.values,
        table.weights[:, None] * table.slopes,
        table.running.T,
        table.inner.T,
    ]
    unknown = np.where(np.array(structure.frozen)[:, None], 0.0, turn)  # multipliers are found, not given
    return SemiDiscrete(
        structure=structure,
        mesh=mesh,
        tables=np.concatenate([t.ravel() for t in tables]),
        uniform=uniform,
        point=point,
        node=node,
        base=np.concatenate([orientation, anchor.position]),
        state=np.concatenate([unknown.ravel(), carried, [0.0, 0.0]]),
        anchor=anchor,
        rest=model.reference,
        parameters=model.parameters,
    )
