"""The same rod told in another way: reversed, lifted into space, or turned together with all the world does to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from geocosserat.algebra.exponential import rotation_from_vector, vector_from_rotation
from geocosserat.algebra.groups import SE3
from geocosserat.discretisation.pose import plane_rotation
from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.model.effects.effect import Effect
from geocosserat.model.expressions import Binary, Expression, Negate, Number, Symbol, constant, substitute
from geocosserat.model.records import End, RodModel, Scene, Start

Array = NDArray[np.float64]
Vector = tuple[Expression, ...]
BODY = {"follower": ("force",), "couple": ("torque",), "field": ("moment",)}
"""Values of effects that are vectors in the moving frame; all others are in the world."""


def signs(planar: bool) -> tuple[Array, Array]:
    """Of turn and stress, and of twist and wrench, when the material coordinate runs the other way.

    The frame turns by pi about the normal of the plane, so that e_1 points along the rod again.
    """
    strain, twist = np.array([1.0, 1, -1, 1, 1, -1]), np.array([-1.0, -1, 1, -1, -1, 1])
    return (strain[[0, 1, 5]], twist[[0, 1, 5]]) if planar else (strain, twist)


def about_turn(planar: bool) -> Array:
    """The turn of the frame by pi that goes with it."""
    return plane_rotation(np.array(np.pi)).round() if planar else np.diag([-1.0, -1.0, 1.0])


def _times(sign: float, e: Expression) -> Expression:
    return e if sign > 0 else Negate(e)


def _new_start(rod: SemiDiscrete, state: Array, time: float) -> tuple[Array, Array]:
    """Where the last end must start to be where it is by then: there, if it is not told to move."""
    now, start = rod.poses(state, time), rod.poses(rod.state)
    position, turn = now.position[-1], now.rotation[-1]
    if rod.guide is None:
        return position, turn
    there = rod.guide.at(time)
    if len(there) == 3:
        gone = plane_rotation(there[2] - np.asarray(start.angle)[-1])
    else:
        gone = start.rotation[-1].T @ Rotation.from_quat(there[3:], scalar_first=True).as_matrix()
    way = start.rotation[-1].T @ (there[: len(position)] - start.position[-1])
    return position - turn @ gone.T @ way, turn @ gone.T


def reversed_scene(scene: Scene, rod: SemiDiscrete, state: Array, time: float = 0.0) -> Scene:
    """The scene with u counted from the other end, in the same place of the world when `rod` is in `state` by then."""
    model, planar = scene.model, scene.model.group.rotations == 1
    strain, twist = signs(planar)

    def back(e: Expression) -> Expression:
        return substitute(e, {"u": Binary("-", Number(model.length), Symbol("u"))})

    def vector(entries: Sequence[Expression], by: Array) -> Vector:
        return tuple(_times(s, back(e)) for s, e in zip(by, entries, strict=True))

    def matrix(rows: Sequence[Sequence[Expression]], by: Array) -> tuple[Vector, ...]:
        return tuple(vector(row, s * by) for s, row in zip(by, rows, strict=True))

    d = model.group.translations

    def end(e: End) -> End:
        if e.twist is not None:
            return replace(e, twist=vector(e.twist, twist))
        if e.frame == "world":
            return e
        force = None if e.force is None else vector(e.force, twist[:d])
        return replace(e, force=force, torque=None if e.torque is None else vector(e.torque, twist[d:]))

    def effect(e: Effect) -> Effect:
        new = {}
        for key, values in e.values().items():
            by = twist[d:] if key == "torque" else twist[:d] if key in BODY.get(e.kind, ()) else np.ones(len(values))
            new[key] = vector(values, by)
        return replace(e, **new)  # type: ignore[type-var]

    position, turn = _new_start(rod, state, time)
    if planar:
        rotation: tuple[float, ...] = (float(np.arctan2(turn[1, 0], turn[0, 0])) + np.pi,)
    else:
        rotation = tuple(float(x) for x in vector_from_rotation(turn @ about_turn(planar)))
    there = replace(
        model,
        stiffness=matrix(model.stiffness, strain),
        friction=matrix(model.friction, twist),
        reference=vector(model.reference, strain),
        left=end(model.right),
        right=end(model.left),
        effects=tuple(effect(e) for e in model.effects),
    )
    start = Start(vector(scene.start.strain, strain), tuple(float(x) for x in position), rotation)
    return replace(scene, model=there, start=start)


def reversed_turn(turn: Array) -> Array:
    """The turn (d, points), or its rate, of the reversed rod."""
    return signs(len(turn) == 3)[0][:, None] * turn[:, ::-1]


ZERO, ONE = Number(0.0), Number(1.0)


def lifted(scene: Scene) -> Scene:
    """A planar scene as one in space that stays in its plane."""
    model = scene.model

    def vector(entries: Sequence[Expression], rest: Expression = ZERO) -> Vector:
        x, y, normal = entries
        return (x, y, rest, rest, rest, normal)

    def matrix(rows: Sequence[Sequence[Expression]]) -> tuple[Vector, ...]:
        x, y, normal = (vector(row) for row in rows)
        between = (tuple(ONE if i == j else ZERO for j in range(6)) for i in (2, 3, 4))
        return (x, y, *between, normal)

    def end(e: End) -> End:
        force = None if e.force is None else (*e.force, ZERO)
        twist = None if e.twist is None else vector(e.twist)
        return replace(e, force=force, torque=None if e.torque is None else (ZERO, ZERO, *e.torque), twist=twist)

    def effect(e: Effect) -> Effect:
        new = {}
        for key, values in e.values().items():
            if key == "gradient":
                new[key] = (*values[:2], ZERO, *values[2:], *[ZERO] * 4)
            elif key == "torque":
                new[key] = (ZERO, ZERO, *values)
            else:
                new[key] = values if key == "stiffness" else (*values, ZERO)
        return replace(e, **new)  # type: ignore[type-var]

    there = RodModel(
        group=SE3,
        length=model.length,
        stiffness=matrix(model.stiffness),
        friction=matrix(model.friction),
        reference=vector(model.reference),
        left=end(model.left),
        right=end(model.right),
        frozen=tuple("Pi3" if name == "Pi" else name for name in model.frozen),
        effects=tuple(effect(e) for e in model.effects),
        joined=model.joined,
        parameters=model.parameters,
    )
    start = Start(
        vector(scene.start.strain), (*scene.start.position, 0.0), (0.0, 0.0, *(float(x) for x in scene.start.rotation))
    )
    return replace(scene, model=there, start=start)


def turned(scene: Scene, by: Sequence[float], moved: Sequence[float]) -> Scene:
    """The scene in a world that is turned (an angle, or a rotation vector) and then moved, with all that is in it."""
    model, planar = scene.model, scene.model.group.rotations == 1
    G = plane_rotation(np.asarray(by[0])) if planar else rotation_from_vector(np.asarray(by, dtype=float))

    def rotate(entries: Vector | None) -> Vector | None:
        return None if entries is None else applied(G, entries)

    def effect(e: Effect) -> Effect:
        new = {}
        for key, values in e.values().items():
            if key in BODY.get(e.kind, ()) or key == "stiffness":
                new[key] = values
            elif key == "gradient":  # G gradient G^T
                new[key] = applied(np.kron(G, G), values)
            else:
                new[key] = applied(G, values)
            if key == "centre":  # a place, which moves along
                new[key] = tuple(x + Number(float(m)) for x, m in zip(new[key], moved, strict=True))
        if "gradient" in new:  # the flow at a place that moved is what it was there
            n = len(moved)
            rows = [new["gradient"][n * i : n * i + n] for i in range(n)]
            past = [applied(np.array([moved]), row)[0] for row in rows]
            new["velocity"] = tuple(v - w for v, w in zip(new["velocity"], past, strict=True))
        return replace(e, **new)  # type: ignore[type-var]

    def end(e: End) -> End:
        if e.frame == "body":
            return e
        return replace(e, force=rotate(e.force), torque=e.torque if planar else rotate(e.torque))

    start = scene.start
    position = tuple(float(x) for x in G @ np.array(start.position) + np.array(moved))
    if planar:
        rotation: tuple[float, ...] = (start.rotation[0] + by[0],)
    else:
        R = G @ rotation_from_vector(np.array(start.rotation))
        rotation = tuple(float(x) for x in vector_from_rotation(R))
    effects = tuple(effect(e) for e in model.effects)
    there = replace(model, left=end(model.left), right=end(model.right), effects=effects)
    return replace(scene, model=there, start=replace(start, position=position, rotation=rotation))


def applied(matrix: Array, entries: Vector) -> Vector:
    """A matrix of numbers times a vector of expressions; zeros leave no term."""
    out = []
    for row in matrix:
        total: Any = None
        for g, e in zip(row, entries, strict=True):
            if constant(e) == 0.0 or g == 0.0:
                continue
            term = Binary("*", Number(float(g)), e)
            total = term if total is None else Binary("+", total, term)
        out.append(ZERO if total is None else total)
    return tuple(out)
