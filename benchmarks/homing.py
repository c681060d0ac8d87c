"""How far a rod forgets where its far end is held, with and without being drawn back: python -m benchmarks.homing.

A curled rod in space, clamped at both ends and stirred by a force that turns with it, on the coarse grid of degree 1.
"""

from __future__ import annotations

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
PERIODS = (30, 300)


def strayed(periods: int, pull: float) -> float:
    """Distance of the right end from its place after so many periods, relative to the length."""
    before, sampling.PULL = sampling.PULL, pull
    try:
        run = geocosserat.run(SCENE, settings=[f"run.until={periods * 2 * np.pi / 60!r}"])
    finally:
        sampling.PULL = before
    return float(np.linalg.norm(run.solution.position[-1, -1] - run.solution.position[0, -1]))


def table() -> str:
    """Both ways, in Markdown."""
    lines = ["| periods | drawn back | left to itself |", "|---|---|---|"]
    lines += [f"| {n} | {strayed(n, sampling.PULL):.1e} | {strayed(n, 0.0):.1e} |" for n in PERIODS]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(table())
