"""A scene that should break a program, and what can be demanded of whoever computes it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from geocosserat.conductor.scene import load_any
from geocosserat.model.expressions import symbols
from geocosserat.model.law import Law
from geocosserat.model.records import Scene


@dataclass(frozen=True)
class Case:
    """A scene that is hard in one way. family: which."""

    name: str
    family: str
    scene: Mapping[str, Any]

    def read(self) -> Scene:
        """The scene as the program reads it. Raises InputError."""
        return load_any(self.scene)


def resting(scene: Scene) -> bool:
    """Whether nothing acts on the rod but its own elasticity and the medium: its energy may only fall."""
    model = scene.model
    held = all(end.kind != "driven" and not end.force and not end.torque for end in (model.left, model.right))
    still = not any("t" in symbols(e) for e in model.reference)
    return held and still and not model.effects and (model.law is None or _stores(model.law))


def _stores(law: Law) -> bool:
    """Whether all that a law's stress does at rest is stored: none of those here gives anything by its rates."""
    return law.energy is not None and not law.remainder and "t" not in symbols(law.energy)


def floating(scene: Scene) -> bool:
    """Whether no end is held and nothing acts on the rod: drag alone, whose sum must vanish."""
    model = scene.model
    return resting(scene) and not model.joined and model.left.kind == model.right.kind == "free"


def sees_world(scene: Scene) -> bool:
    """Whether something of the scene has a direction or a place of its own in the world."""
    model = scene.model
    framed = any(getattr(end, "frame", "body") == "world" and (end.force or end.torque) for end in
                 (model.left, model.right))  # fmt: skip
    return framed or any(effect.kind in ("weight", "field", "flow", "trap") for effect in model.effects)


def planar(**changes: Any) -> dict[str, Any]:
    """The planar rod of the paper, bent at the start, clamped on the left; changes by key with dots as `__`."""
    return _changed(
        {
            "rod": {
                "motion": "planar",
                "length": 1.0,
                "stiffness": [1e4, 1e4, 1.0],
                "friction": [1.0, 2.0, 0.01],
            },
            "start": {"strain": ["1", "0", "3*(1 - s)**2*(1 + 2*s)"]},
            "run": {"until": 0.05, "frames": 26, "accuracy": 1e-4},
        },
        changes,
    )


def spatial(**changes: Any) -> dict[str, Any]:
    """A spatial rod that relaxes from a shape with bends, twist and shear."""
    return _changed(
        {
            "rod": {
                "motion": "spatial",
                "length": 1.0,
                "stiffness": [1e4, 5e3, 5e3, 0.7, 1.0, 1.2],
                "friction": [1.0, 2.0, 2.0, 0.01, 0.01, 0.01],
            },
            "start": {"strain": ["1", "0", "0", "2*sin(pi*s)", "2*(1 - s)**2", "3*(1 - s)**2*(1 + 2*s)"]},
            "run": {"until": 0.05, "frames": 26, "accuracy": 1e-4},
        },
        changes,
    )


def _changed(scene: dict[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """The scene with values set by key: `rod__length=2`; None takes a key away."""
    changed: dict[str, Any] = json.loads(json.dumps(scene))
    for key, value in changes.items():
        *tables, last = key.split("__")
        table = changed
        for name in tables:
            table = table.setdefault(name, {})
        if value is None:
            table.pop(last, None)
        else:
            table[last] = value
    return changed
