"""Whether the error asked for is the error got: python -m benchmarks.honesty [accuracies].

The examples, and random rods (stiffness, friction, frozen modes, ends, effects, start), each at several accuracies: the
true error of the whole rod at the end, from a rod on a mesh that is several times as fine, over the one asked for; the
estimate over the true error; the time that planning took over that of the run that was kept.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import geocosserat
from geocosserat.conductor.scene import load_any
from geocosserat.discretisation.mesh import Mesh
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.model.errors import InputError
from geocosserat.model.records import Scene
from geocosserat.planning.gap import interpolate, position_gap

ACCURACIES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
EXAMPLES = sorted((Path(__file__).parent.parent / "examples").glob("*.toml"))
RANDOM = 20
FINE, FINER = (6, 16, 1e-8), (8, 16, 3e-9)
"""Elements, degree, and tolerance of Radau IIA for what counts as exact (the finer), and for how exact it is."""

TOLD = 20.0
"""Accuracies are measured that are so many times larger than what the two differ by."""


def random_scene(seed: int) -> dict[str, Any]:
    """A rod that relaxes, is loaded, and moves for about as long as it takes to."""
    chance = np.random.default_rng(seed)
    planar = bool(chance.random() < 0.5)
    space, d = (2, 3) if planar else (3, 6)
    turns = d - space

    def between(low: float, high: float, count: int) -> list[float]:
        return [float(x) for x in 10.0 ** chance.uniform(low, high, count)]

    def vector(size: float, count: int = space) -> list[float]:
        return [float(x) for x in size * chance.normal(size=count)]

    bent = [f"{a:.3f}*sin({k:.3f}*u) + {b:.3f}*u**2" for a, k, b in 2.0 * chance.normal(size=(turns, 3))]
    turning = [f"{a:.3f}*cos({10 * b:.3f}*t)" for a, b in chance.normal(size=(space, 2))]
    effects = [
        {"kind": "weight", "force": vector(10.0)},
        {"kind": "follower", "force": vector(5.0)},
        {"kind": "couple", "torque": float(chance.normal()) if planar else vector(1.0)},
        {"kind": "field", "moment": vector(2.0), "field": turning},
        {"kind": "flow", "gradient": [vector(5.0) for _ in range(space)], "velocity": vector(1.0)},
        {"kind": "trap", "stiffness": float(10.0 ** chance.uniform(-1, 2)), "centre": vector(0.5)},
    ]
    rod: dict[str, Any] = {
        "motion": "planar" if planar else "spatial",
        "length": 1.0,
        "stiffness": [*between(1, 4, space), *between(-0.5, 0.5, turns)],
        "friction": [*between(-0.3, 0.3, space), *between(-3, -1, turns)],
    }
    if chance.random() < 0.3:
        rod["frozen"] = ["h1", "h2"] if planar else ["h1", "h2", "h3"]
    far = {"kind": "free"} if chance.random() < 0.8 else {"kind": "pinned"}
    if far["kind"] == "free" and chance.random() < 0.5:
        far |= {"force": vector(5.0), "frame": str(chance.choice(["body", "world"]))}
    return {
        "title": f"random {seed}",
        "rod": rod,
        "start": {"strain": [*(["1"] + ["0"] * (space - 1)), *bent]},
        "ends": {"left": {"kind": str(chance.choice(["clamped", "free"]))}, "right": far},
        "effects": [effects[i] for i in chance.choice(6, size=int(chance.integers(0, 3)), replace=False)],
        "run": {"until": float(10.0 ** chance.uniform(-2, -0.5)), "frames": 2},
    }


def scenes() -> Iterator[tuple[str, Scene]]:
    """Those that can be computed finely."""
    for path in EXAMPLES:
        yield path.stem, load_any(path, ["run.frames=2"])
    made, seed = 0, 0
    while made < RANDOM:
        seed += 1
        try:
            yield f"random {seed}", load_any(random_scene(seed))
            made += 1
        except InputError:  # ends and effects that do not go together
            continue


def at(scene: Scene, elements: int, degree: int, rtol: float) -> tuple[Mesh, np.ndarray] | None:
    """Mesh and positions at the end of a fine rod, if it gets there."""
    settings = [f"run.elements={elements}", f"run.degree={degree}", f"run.rtol={rtol}", "run.method=radau"]
    run = geocosserat.run(scene, settings=settings)
    return (discretise(scene, elements, degree).mesh, run.solution.position[-1]) if run.reached else None


def measure(accuracies: tuple[float, ...]) -> Iterator[tuple[str, float, float, float, float, str]]:
    """Scene, accuracy, error over that, estimate over the error, planning over the run, and how it was computed."""
    for name, scene in scenes():
        fine, finer = at(scene, *FINE), at(scene, *FINER)
        if fine is None or finer is None:
            print(f"{name}: a fine rod did not reach its end; left out", file=sys.stderr)
            continue
        known = position_gap(*fine, *finer) / scene.model.length
        for accuracy in accuracies:
            if accuracy < TOLD * known:
                print(f"{name}: exact to {known:.0e} only; {accuracy:.0e} is left out", file=sys.stderr)
                continue
            run = geocosserat.run(scene, accuracy=accuracy)
            found = run.solution
            gaps = np.linalg.norm(interpolate(*finer, found.u) - found.position[-1], axis=1)
            error = float(gaps.max()) / found.length
            how = f"{found.method}, {found.elements} x {found.degree}, {len(found.plan)} runs"
            how = how if run.reached else f"not reached: {run.reason}"
            seconds = found.seconds["plan"] / found.seconds["solve"]
            estimate = (run.error["estimated"] or np.inf) / error
            yield name, accuracy, error / accuracy, estimate, seconds, how


def table(accuracies: tuple[float, ...] = ACCURACIES) -> str:
    """A line for each accuracy, and those runs in full whose error is above the one asked for."""
    rows = list(measure(accuracies))
    lines = [
        "| accuracy | runs | error/accuracy: median | most | below 1 | estimate/error: least | median | planning/run |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for accuracy in (*accuracies, None):
        some = [row for row in rows if accuracy in (row[1], None) and not row[5].startswith("not")]
        errors, estimates, seconds = (np.array([row[i] for row in some]) for i in (2, 3, 4))
        cells = [
            "all" if accuracy is None else f"{accuracy:.0e}",
            str(len(some)),
            f"{np.median(errors):.3f}",
            f"{errors.max():.2f}",
            f"{100 * np.mean(errors <= 1.0):.1f} %",
            f"{estimates.min():.2f}",
            f"{np.median(estimates):.1f}",
            f"{np.median(seconds):.2f}",
        ]
        lines.append(f"| {' | '.join(cells)} |")
    lines += [""]
    for name, accuracy, error, _, _, how in rows:
        if error > 1.0 or how.startswith("not"):
            lines.append(f"* {name} at {accuracy:.0e}: {error:.2f} times it; {how}")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table(tuple(float(word) for word in sys.argv[1:]) or ACCURACIES))
