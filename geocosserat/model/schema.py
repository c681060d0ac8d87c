"""Every key and word that a scene may hold; the readers and the settings share this one table."""

from __future__ import annotations

from typing import Final

SCENE_KEYS: Final = ("title", "parameters", "rod", "start", "ends", "effects", "run")
ROD_KEYS: Final = ("motion", "length", "stiffness", "friction", "reference", "frozen", "law")
START_KEYS: Final = ("strain", "position", "angle", "rotation")
ENDS_KEYS: Final = ("left", "right", "joined")
SIDES: Final = ("left", "right")
END_KEYS: Final = ("kind", "force", "torque", "frame", "twist")
RUN_KEYS: Final = (
    "until", "frames", "accuracy", "elements", "degree", "method", "rtol", "atol", "backend",
)  # fmt: skip
MOTIONS: Final = ("planar", "spatial")
END_KINDS: Final = ("clamped", "free", "pinned", "driven")
FRAMES: Final = ("body", "world")
METHODS: Final = ("cvode", "radau", "bdf", "lsoda", "safe", "midpoint")
BACKENDS: Final = ("auto", "c", "numpy")

MAX_PARAMETERS: Final = 1_000
MAX_EFFECTS: Final = 100
MAX_FRAMES: Final = 100_000
MAX_ELEMENTS: Final = 100_000
MAX_DEGREE: Final = 64
LENGTHS: Final = (1e-30, 1e30)
LEAST_ACCURACY: Final = 1e-15
DEFAULT_ACCURACY: Final = 1e-6
DEFAULT_FRAMES: Final = 51


def scene_paths() -> tuple[str, ...]:
    """Every dotted path that can be set whatever the scene holds: ``title``, ``rod.length`` ..."""
    tables = {"rod": ROD_KEYS, "start": START_KEYS, "run": RUN_KEYS}
    ends = ["ends.joined", *(f"ends.{side}.{key}" for side in SIDES for key in END_KEYS)]
    return ("title", *(f"{table}.{key}" for table, keys in tables.items() for key in keys), *ends)
