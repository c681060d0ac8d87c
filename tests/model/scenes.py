"""Small scenes for the tests, as mappings: change one entry, and see what is said."""

from __future__ import annotations

import copy
from typing import Any

PLANAR: dict[str, Any] = {
    "parameters": {"kappa": 1e4, "load": 2.0},
    "rod": {
        "motion": "planar",
        "length": 1.0,
        "stiffness": ["kappa", "kappa", 1.0],
        "friction": [1.0, 2.0, 0.01],
    },
    "ends": {"right": {"force": [0.0, "-load"], "torque": 0.5, "frame": "world"}},
    "effects": [{"kind": "weight", "force": [0.0, -1.0]}],
    "run": {"until": 1.0},
}
SPATIAL: dict[str, Any] = {
    "parameters": {"kappa": 1e4, "load": 2.0},
    "rod": {
        "motion": "spatial",
        "length": 2.0,
        "stiffness": ["kappa", "kappa", 1e3, 1.0, 2.0, 3.0],
        "friction": [1.0, 2.0, 3.0, 0.01, 0.02, 0.03],
    },
    "ends": {"right": {"force": [0.0, "-load", 0.0], "torque": [0.0, 0.0, 1.0]}},
    "effects": [{"kind": "weight", "force": [0.0, 0.0, -1.0]}],
    "run": {"until": 1.0},
}
MISSING = object()


def changed(scene: dict[str, Any], path: str, value: Any) -> dict[str, Any]:
    """A copy of the scene with the entry at a dotted path set, or removed if the value is MISSING."""
    result = copy.deepcopy(scene)
    *tables, last = path.split(".")
    target: Any = result
    for step in tables:
        target = target[int(step)] if isinstance(target, list) else target.setdefault(step, {})
    if value is MISSING:
        del target[last]
    elif isinstance(target, list):
        target[int(last)] = value
    else:
        target[last] = value
    return result
