"""The numbers that a kernel takes for a structure: coefficients sampled on a mesh."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geocosserat.discretisation.mesh import Array, Mesh
from geocosserat.discretisation.pose import Poses
from geocosserat.discretisation.structure import Coefficient, RodStructure
from geocosserat.model.expressions import Expression, Number, evaluate
from geocosserat.model.records import RodModel, RunSettings, Scene

SLACK = 1e-12
"""How much frozen modes yield where both ends are held, relative to what friction lets them: enough to be unique."""

PULL = 1e5
PULL_AT_REST = 1e3
"""How fast an end that strayed returns home, relative to how fast the rod relaxes: ahead of a rod that moves; of one
that is to rest no faster than it must, for it makes round-off in the place of the end a force."""

QUASI_STATIC = (1e-10, 1e-8)
"""Friction of a rotation that has none, relative to what the other motions of a rod of this length feel.

A balance without friction is the limit of one with ever less; what is left of it shows in the answer as an error of
about this size (docs/method.md), and lets the same kernels serve. Round-off shows the more the less is left: so it is a
tenth of the accuracy asked for, within these bounds.
"""


def frictionless(model: RodModel) -> list[int]:
    """The rotations that have no friction, as numbers of components of the twist."""
    rotations = range(model.group.translations, model.group.dimension)
    return [i for i in rotations if set(model.friction[i]) <= {Number(0.0)}]


def left_of_friction(run: RunSettings) -> float:
    """What is left of the friction of a rotation that has none, for a run with these settings."""
    asked = [x for x in (run.accuracy, run.rtol) if x is not None]
    least, most = QUASI_STATIC
    return min(max(least, 0.1 * min(asked, default=1.0)), most)


def along(e: Expression, parameters: Mapping[str, float], u: Array) -> Array:
    return np.broadcast_to(np.asarray(evaluate(e, {**parameters, "u": u}), dtype=float), u.shape)


def friction_of(model: RodModel, mesh: Mesh, left: float) -> Array:
    """(nodes, d, d) friction; at a step, averaged over both sides by mass. left: of that of a rotation without any."""
    u = mesh.local_nodes()
    d = len(model.friction)
    friction = np.empty((*u.shape, d, d))
    for i in range(d):
        for j in range(d):
            friction[..., i, j] = evaluate(model.friction[i][j], {**model.parameters, "u": u})
    weighted = friction * mesh.reference.masses[:, None, None]
    mean = mesh.gather(weighted) / mesh.mass[:, None, None]
    for i in frictionless(model):
        mean[:, i, i] = left * model.length**2 * mean[:, 0, 0]
    return mean


def sample(
    structure: RodStructure, scene: Scene, mesh: Mesh, start: Poses, pull: float = PULL
) -> tuple[Array, Array, Array]:
    model, u, u_point = scene.model, mesh.u, mesh.u_point
    friction = friction_of(model, mesh, left_of_friction(scene.run))
    turns = slice(model.group.translations, None)
    matrices = {
        "mobility": np.linalg.inv(friction),
        "left_friction": friction[:1],
        "right_friction": friction[-1:],
        "left_mobility": _padded(np.linalg.inv(friction[:1, turns, turns])),
        "right_mobility": _padded(np.linalg.inv(friction[-1:, turns, turns])),
    }

    homes = {f"{side}_{name}": x for side, n in (("left", 0), ("right", -1)) for name, x in _home(start, n).items()}
    # between two nodes nothing strays: the turn follows what is prescribed to both, and nothing else
    homes["left_pull"] = homes["right_pull"] = pull * slowest(model, friction) if len(u) > 2 else 0.0

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
        local = along(c.expression, model.parameters, mesh.local_nodes())
        return mesh.gather(local * mesh.reference.masses) / mesh.mass

    def uniform_value(c: Coefficient) -> float:
        return float(entry(c)[0] if c.expression is None else evaluate(c.expression, model.parameters))

    point = [along(c.expression, model.parameters, u_point) for c in structure.at("point") if c.expression is not None]
    node = [node_values(c) for c in structure.at("node")]
    return (
        np.array([uniform_value(c) for c in structure.at("uniform")]),
        np.array(point).reshape(-1, len(u_point)),
        np.array(node).reshape(-1, len(u)),
    )


def stiffnesses(model: RodModel) -> list[float]:
    """About how stiff each mode is, in the middle of the rod: positive, whatever its law does at the reference."""
    middle = {**model.parameters, "u": model.length / 2}
    found = [abs(float(evaluate(row[i], middle))) for i, row in enumerate(model.stiffness)]
    return [x or max(found) or 1.0 for x in found]


def _slack(model: RodModel, friction: Array, stress: str) -> float:
    """How much a frozen mode yields to its stress where both ends are held (1 / time / stress).

    A straight rod held at both ends may carry any tension. The least one is taken: that of a rod that yields by SLACK
    of what friction lets it.
    """
    order = 2 if stress.startswith("F") else 4
    return SLACK / (float(friction[:, 0, 0].max()) * model.length**order)


def _home(start: Poses, n: int) -> dict[str, float]:
    """Where node n is at the start, by the names of the coefficients that say so."""
    rotation, axes = start.rotation[n], "xyz"[: start.position.shape[-1]]
    found = {f"home_{axis}": float(x) for axis, x in zip(axes, start.position[n], strict=True)}
    found |= {f"home_{i + 1}{axis}": float(rotation[k, i]) for k, axis in enumerate(axes) for i in range(len(axes))}
    return found | {"home_cos": float(rotation[0, 0]), "home_sin": float(rotation[1, 0])}


def slowest(model: RodModel, friction: Array) -> float:
    """About how fast the softest mode of the rod relaxes (1 / time)."""
    soft = min(stiffnesses(model)[model.group.translations :])
    return soft / (float(friction[:, 0, 0].max()) * model.length**4)


def _padded(turns: NDArray[np.floating[Any]]) -> Array:
    """Matrices for rotations as matrices for all motions: translations, of which there are 2 or 3, come first."""
    before = 2 if turns.shape[-1] == 1 else 3
    return np.pad(turns, ((0, 0), (before, 0), (before, 0))).astype(np.float64)
