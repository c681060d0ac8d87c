"""How far ends stray from where they belong in many periods: python -m benchmarks.homing [PERIODS ...].

A curled rod in space, clamped at both ends and stirred by a force that turns with it, with and without its far end
being drawn back; one that is driven at both ends; and heavy ones, in space and in the plane, whose base is driven to
and fro. All on the coarse grid of degree 1.
"""

from __future__ import annotations

import sys

import numpy as np

import geocosserat
from geocosserat.discretisation import sampling

SCENE = {
    "title": "stirred between two clamps",
    "rod": {
        "motion": "spatial",
        "length": 1.0,
        "stiffness": [900, 400, 400, 0.7, 1, 1],
        "friction": [1, 2, 2, 0.01, 0.01, 0.01],
        "reference": [1, 0, 0, 1, 0, 2],
    },
    "ends": {"left": {"kind": "clamped"}, "right": {"kind": "clamped"}},
    "effects": [{"kind": "follower", "force": ["0", "20*sin(60*t)", "20*cos(60*t)"]}],
    "run": {"until": 1.0, "frames": 2, "elements": 16, "degree": 1, "rtol": 1e-6},
}
SHAKEN = {
    **SCENE,
    "title": "shaken under its weight",
    "ends": {
        "left": {"kind": "driven", "twist": ["0", "0", "24*cos(60*t)", "0", "0", "0"]},
        "right": {"kind": "free"},
    },
    "effects": [{"kind": "weight", "force": [0, 1, -4]}],
}
ROCKED = {
    **SHAKEN,
    "title": "rocked under its weight",
    "rod": {"motion": "planar", "length": 1.0, "stiffness": [900, 400, 1], "friction": [1, 2, 0.01]},
    "ends": {
        "left": {"kind": "driven", "twist": ["0", "24*cos(60*t)", "30*cos(60*t)"]},
        "right": {"kind": "free"},
    },
    "effects": [{"kind": "weight", "force": [1, -4]}],
}
WAVED = {**SHAKEN, "title": "driven at both ends"}
WAVED["ends"] = {
    "left": SHAKEN["ends"]["left"],  # type: ignore[index]
    "right": {"kind": "driven", "twist": ["0", "0", "12*cos(60*t)", "0", "30*cos(60*t)", "0"]},
}
PERIODS = (30, 300)


def strayed(scene: dict[str, object], node: int, periods: int, pull: float = sampling.PULL) -> float:
    """Distance of an end from its place after so many periods, relative to the length."""
    before, sampling.PULL = sampling.PULL, pull
    try:
        run = geocosserat.run(scene, settings=[f"run.until={periods * 2 * np.pi / 60!r}"])
    finally:
        sampling.PULL = before
    return float(np.linalg.norm(run.solution.position[-1, node] - run.solution.position[0, node]))


def table(periods: tuple[int, ...] = PERIODS) -> str:
    """All of them, in Markdown."""
    heading = "| periods | far end drawn back | left to itself | both driven, far end | driven base | in the plane |"
    lines = [heading, "|---|---|---|---|---|---|"]
    for n in periods:
        held = strayed(SCENE, -1, n), strayed(SCENE, -1, n, 0.0)
        found = *held, strayed(WAVED, -1, n), strayed(SHAKEN, 0, n), strayed(ROCKED, 0, n)
        lines.append(f"| {n} | {' | '.join(f'{x:.1e}' for x in found)} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(table(tuple(map(int, sys.argv[1:])) or PERIODS))
