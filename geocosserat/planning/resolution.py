"""Whether a mesh, or the steps in time, notice all that a scene varies."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from geocosserat.algebra.groups import Group
from geocosserat.discretisation.mesh import Array, Mesh, make_mesh
from geocosserat.model.expressions import Expression, Number, evaluate, jump_positions, switch_times, symbols
from geocosserat.model.features import leaves, pulses
from geocosserat.model.formulas import formulas, stepping
from geocosserat.model.law import pose_names, rates
from geocosserat.model.records import Scene

PLACES = (0.21, 0.5, 0.83)
"""Of the rod, where formulas are followed in time."""

FINE = 8
"""Gauss points on each interval on which a formula hardly varies."""


@dataclass(frozen=True, eq=False)
class Feature:
    """A formula along the rod at one instant. scale: its largest value. exact: its integral and that of its square;
    spread, size: what these are made of, that of the distance from the mean and that of the absolute value."""

    formula: Expression
    values: Mapping[str, float]
    scale: float
    exact: Array
    spread: Array
    size: Array

    def sampled(self, u: Array) -> Array:
        """It and its square, (2, points), in units of the scale."""
        f = np.broadcast_to(evaluate(self.formula, {**self.values, "u": u}), u.shape) / self.scale
        return np.stack([f, f**2])

    def missed(self, mesh: Mesh, part: float, accuracy: float) -> bool:
        """Whether the Gauss points of a mesh are wrong about the integrals by more than that part of how the formula
        varies, and more than the accuracy."""
        error = np.abs(self.sampled(mesh.u_point) @ mesh.weight - self.exact)
        return bool(np.any(error > np.maximum(part * self.spread, accuracy * self.size)))


class Resolution:
    """What a scene varies, to be asked of many meshes.

    Two coarse runs that both miss a narrow feature agree with each other. So integrals of every formula are compared
    with exact ones, for which bounds find where it varies: no feature is too narrow for them.
    """

    def __init__(self, scene: Scene) -> None:
        model = scene.model
        self.length = model.length
        self.steps = [x for e in stepping(scene, "u") for x in jump_positions(e, model.length, model.parameters)]
        self.features = [feature for e in _along(scene) for feature in _features(e, scene)]

    def sees_all(self, elements: int, degree: int, accuracy: float, part: float | None = None) -> bool:
        """Whether the Gauss points of a mesh notice everything, to so large a part of each feature (by default the
        root of the accuracy)."""
        mesh = make_mesh(self.length, elements, degree, self.steps)
        part = float(np.sqrt(accuracy)) if part is None else part
        return not any(feature.missed(mesh, part, accuracy) for feature in self.features)


def instants(scene: Scene) -> tuple[float, ...]:
    """Those at which something of the scene switches, and those of pulses, which long steps might pass over."""
    model, until = scene.model, scene.run.until
    found = {t for e in stepping(scene, "t") for t in switch_times(e, until, model.parameters)}
    for e in formulas(scene):
        if "t" in symbols(e):
            found |= _pulses(e, scene)
    return tuple(sorted(found))


def _pulses(e: Expression, scene: Scene) -> set[float]:
    model = scene.model
    places = [x * model.length for x in PLACES] if "u" in symbols(e) else [0.0]
    others = {**_some_state(model.group, model.length), **model.parameters}
    return {t for u in places for t in pulses(e, "t", scene.run.until, {**others, "u": u})}


def _along(scene: Scene) -> Iterator[Expression]:
    """What varies along the rod; of stiffness and friction the inverse too, for the rod goes where it is soft."""
    model = scene.model
    inverses = (Number(1.0) / matrix[i][i] for matrix in (model.stiffness, model.friction) for i in range(len(matrix)))
    yield from dict.fromkeys(e for some in (formulas(scene), inverses) for e in some if "u" in symbols(e))


def _features(e: Expression, scene: Scene) -> Iterator[Feature]:
    model, until = scene.model, scene.run.until
    when = {0.0, 0.37 * until, until, *_pulses(e, scene)} if "t" in symbols(e) else {0.0}
    for t in sorted(when):
        values = {**_some_state(model.group, model.length), **model.parameters, "t": t}
        fine = make_mesh(model.length, 1, FINE, leaves(e, "u", model.length, values))
        f = np.broadcast_to(evaluate(e, {**values, "u": fine.u_point}), fine.u_point.shape)
        scale = float(np.abs(f).max())
        if not 0.0 < scale < np.inf:
            continue
        g = np.stack([f / scale, (f / scale) ** 2])
        exact, size = g @ fine.weight, np.abs(g) @ fine.weight
        spread = np.abs(g - exact[:, None] / model.length) @ fine.weight
        yield Feature(e, values, scale, exact, spread, size)


def _some_state(group: Group, length: float) -> Mapping[str, float]:
    """Numbers for what a law sees: a turn, its rates and a pose with nothing special about them."""
    turn = [1.1, 0.07, -0.05][: group.translations] + [0.3 / length, 0.4 / length, -0.2 / length][: group.rotations]
    names = zip((*group.strain, *rates(group)), (*turn, *turn), strict=True)
    return {**dict.fromkeys(pose_names(group), 0.3), **dict(names)}
