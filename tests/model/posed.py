"""Effects at a pose: numbers in the place of the symbols of frame and place, and one entry of a scene for each kind."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from geocosserat.algebra.exponential import exp
from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.model.effects.effect import Effect
from geocosserat.model.expressions import Expression, Number, evaluate
from geocosserat.model.scene import load_scene
from geocosserat.model.seen import Vector, seen
from tests.model.scenes import PLANAR, SPATIAL, changed

Array = NDArray[np.float64]
GROUPS = {2: SE2, 3: SE3}
SCENES = {2: PLANAR, 3: SPATIAL}
ENTRIES: dict[tuple[str, int], dict[str, Any]] = {
    ("weight", 2): {"force": ["1 + u", "-2*t"]},
    ("weight", 3): {"force": ["1 + u", "-2*t", "load*sin(t)"]},
    ("follower", 2): {"force": ["sin(u - t)", 0.5]},
    ("follower", 3): {"force": ["sin(u - t)", 0.5, "load"]},
    ("couple", 2): {"torque": "u*cos(t)"},
    ("couple", 3): {"torque": ["u*cos(t)", 0.3, -1]},
    ("field", 2): {"moment": ["1 + t", "u"], "field": ["3*cos(t)", "load"]},
    ("field", 3): {"moment": ["1 + t", "u", -0.4], "field": ["3*cos(t)", "load", 0.7]},
    ("flow", 2): {"gradient": [["t", 2], [-0.5, "load"]], "velocity": ["sin(t)", 1]},
    ("flow", 3): {"gradient": [["t", 2, 1], [-0.5, "load", 0.2], [3, -1, 0.1]], "velocity": ["sin(t)", 1, -2]},
    ("trap", 2): {"stiffness": "2 + u*t", "centre": ["cos(t)", 0.2]},
    ("trap", 3): {"stiffness": "2 + u*t", "centre": ["cos(t)", 0.2, "-load"]},
}
KINDS = sorted({kind for kind, _ in ENTRIES})


def scene_with(kind: str, space: int, values: dict[str, Any] | None = None) -> dict[str, Any]:
    """A scene with this effect alone."""
    entry = {"kind": kind, **(ENTRIES[kind, space] if values is None else values)}
    return changed(SCENES[space], "effects", [entry])


def read(kind: str, space: int, values: dict[str, Any] | None = None) -> Effect:
    """An effect, read from a scene."""
    (effect,) = load_scene(scene_with(kind, space, values)).model.effects
    return effect


def pose(space: int, seed: int) -> Array:
    """Some configuration, turned by any angle."""
    group: Group = GROUPS[space]
    return np.asarray(exp(group, np.random.default_rng(seed).uniform(-2, 2, group.dimension)))


def values_at(g: Array, u: float = 0.4, t: float = 0.7) -> dict[str, float | Array]:
    """The values of all symbols of a pose, and of u, t and the parameters."""
    space = len(g) - 1
    r, R = g[1:, 0], g[1:, 1:]
    values: dict[str, float | Array] = {"u": u, "t": t, "kappa": 1e4, "load": 2.0}
    values |= {f"place.{axis}": float(x) for axis, x in zip("xyz", r, strict=False)}
    if space == 2:
        return values | {"frame.cos": float(R[0, 0]), "frame.sin": float(R[1, 0])}
    return values | {f"frame.{i + 1}{axis}": float(R[w, i]) for w, axis in enumerate("xyz") for i in range(3)}


def number(e: Expression, values: dict[str, float | Array]) -> float:
    """The value of one expression."""
    return float(evaluate(e, values))


def numbers(pair: tuple[Vector, Vector], values: dict[str, float | Array]) -> Array:
    """The components for translations and rotations, together."""
    return np.array([number(e, values) for part in pair for e in part])


def wrench(effect: Effect, g: Array, u: float = 0.4, t: float = 0.7) -> Array:
    """The wrench of an effect at a pose."""
    return numbers(effect.wrench(seen(len(g) - 1)), values_at(g, u, t))


def medium(effect: Effect, g: Array, u: float = 0.4, t: float = 0.7) -> Array:
    """Velocity and spin of the medium of an effect at a pose."""
    return numbers(effect.medium(seen(len(g) - 1)), values_at(g, u, t))


def potential(effect: Effect, g: Array, u: float = 0.4, t: float = 0.7) -> float:
    """The potential of an effect at a pose."""
    energy = effect.potential(seen(len(g) - 1))
    assert energy is not None
    return number(energy, values_at(g, u, t))


def plain(effect: Effect, u: float = 0.4, t: float = 0.7) -> dict[str, Array]:
    """The values of an effect as numbers."""
    space = values_at(np.eye(3), u, t)
    return {key: np.array([number(e, space) for e in vector]) for key, vector in effect.values().items()}


def of_numbers(kind: type[Effect], values: dict[str, Array]) -> Effect:
    """An effect of these numbers."""
    return kind(**{key: tuple(Number(float(x)) for x in vector.ravel()) for key, vector in values.items()})


def slope(f: Any, h: float = 2e-3) -> float:
    """The derivative of a function of one number at 0, to about ten digits."""
    weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
    return float(sum(w * (f(k * h) - f(-k * h)) for k, w in weights.items()) / h)
