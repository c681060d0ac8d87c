"""The same rod told in another way: reversed, lifted into space, or turned together with all the world does to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geocosserat.algebra.exponential import rotation_from_vector, vector_from_rotation
from geocosserat.algebra.groups import SE3
from geocosserat.discretisation.pose import plane_rotation
from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.model.effects.weight import Weight
from geocosserat.model.expressions import Binary, Expression, Negate, Number, Symbol, constant, substitute
from geocosserat.model.records import End, RodModel, Scene, Start

Array = NDArray[np.float64]
Vector = tuple[Expression, ...]


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


def reversed_scene(scene: Scene, rod: SemiDiscrete, state: Array) -> Scene:
    """The scene with u counted from the other end, in the same place of the world when `rod` is in `state`."""
    model, planar = scene.model, scene.model.group.rotations == 1
    strain, twist = signs(planar)

    def back(e: Expression) -> Expression:
        return substitute(e, {"u": Binary("-", Number(model.length), Symbol("u"))})

    def vector(entries: Sequence[Expression], by: Array) -> Vector:
        return tuple(_times(s, back(e)) for s, e in zip(by, entries, strict=True))

    def matrix(rows: Sequence[Sequence[Expression]], by: Array) -> tuple[Vector, ...]:
        return tuple(vector(row, s * by) for s, row in zip(by, rows, strict=True))

    def end(e: End) -> End:
        if e.frame == "world":
            return e
        d = model.group.translations
        force = None if e.force is None else vector(e.force, twist[:d])
        return replace(e, force=force, torque=None if e.torque is None else vector(e.torque, twist[d:]))

    poses = rod.poses(state)
    if poses.angle is not None:
        rotation: tuple[float, ...] = (float(poses.angle[-1]) + np.pi,)
    else:
        rotation = tuple(float(x) for x in vector_from_rotation(poses.rotation[-1] @ about_turn(planar)))
    there = replace(
        model,
        stiffness=matrix(model.stiffness, strain),
        friction=matrix(model.friction, twist),
        reference=vector(model.reference, strain),
        left=end(model.right),
        right=end(model.left),
        effects=tuple(Weight(tuple(back(e) for e in effect.force)) for effect in model.effects),
    )
    start = Start(vector(scene.start.strain, strain), tuple(float(x) for x in poses.position[-1]), rotation)
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
        return replace(e, force=force, torque=None if e.torque is None else (ZERO, ZERO, *e.torque))

    there = RodModel(
        group=SE3,
        length=model.length,
        stiffness=matrix(model.stiffness),
        friction=matrix(model.friction),
        reference=vector(model.reference),
        left=end(model.left),
        right=end(model.right),
        effects=tuple(Weight((*effect.force, ZERO)) for effect in model.effects),
        parameters=model.parameters,
    )
    start = Start(
        vector(scene.start.strain), (*scene.start.position, 0.0), (0.0, 0.0, *(float(x) for x in scene.start.rotation))
    )
    return replace(scene, model=there, start=start)


def turned(scene: Scene, by: Sequence[float], moved: Sequence[float]) -> Scene:
    """The scene in a world that is turned (an angle, or a rotation vector) and then moved; nothing inside changes."""
    model, planar = scene.model, scene.model.group.rotations == 1
    G = plane_rotation(np.asarray(by[0])) if planar else rotation_from_vector(np.asarray(by, dtype=float))

    def rotate(entries: Vector | None) -> Vector | None:
        if entries is None:
            return None
        out = []
        for row in G:
            total: Any = None
            for g, e in zip(row, entries, strict=True):
                if constant(e) == 0.0:
                    continue
                term = Binary("*", Number(float(g)), e)
                total = term if total is None else Binary("+", total, term)
            out.append(ZERO if total is None else total)
        return tuple(out)

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
    effects = tuple(Weight(rotate(effect.force) or ()) for effect in model.effects)
    there = replace(model, left=end(model.left), right=end(model.right), effects=effects)
    return replace(scene, model=there, start=replace(start, position=position, rotation=rotation))
