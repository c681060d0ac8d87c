"""Whether the error asked for is the error got: python -m benchmarks.honesty [accuracies].

The examples, and random rods (stiffness, friction, frozen modes, ends, effects, start), each at several accuracies: the
true error of the whole rod at the end, from a rod on a mesh that is several times as fine, over the one asked for; the
estimate over the true error; the time that planning took over that of the run that was kept.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Row:
    """A scene at an accuracy: what came of it (COMPUTED, NOT_REACHED, REFUSED or LEFT_OUT), and how or why.

    error: over the accuracy; estimate: over the error; planning: over the run. None where there is none.
    """

    scene: str
    accuracy: float
    came: str
    how: str
    error: float | None = None
    estimate: float | None = None
    planning: float | None = None


COMPUTED, NOT_REACHED, REFUSED, LEFT_OUT = OUTCOMES = ("computed", "not reached", "refused", "left out")


def measure(accuracies: Sequence[float]) -> Iterator[Row]:
    """Every scene at every accuracy: none is left out without a row that says why."""
    for name, scene in scenes():
        try:
            fine, finer = at(scene, *FINE), at(scene, *FINER)
        except InputError as error:
            yield from (Row(name, accuracy, REFUSED, str(error)) for accuracy in accuracies)
            continue
        if fine is None or finer is None:
            yield from (Row(name, x, LEFT_OUT, "a fine rod did not reach its end") for x in accuracies)
            continue
        known = position_gap(*fine, *finer) / scene.model.length
        for accuracy in accuracies:
            if accuracy < TOLD * known:
                yield Row(name, accuracy, LEFT_OUT, f"exact to {known:.0e} only")
                continue
            yield _row(name, scene, accuracy, finer)


def _row(name: str, scene: Scene, accuracy: float, exact: tuple[Mesh, np.ndarray]) -> Row:
    try:
        run = geocosserat.run(scene, accuracy=accuracy)
    except InputError as error:
        return Row(name, accuracy, REFUSED, str(error))
    found = run.solution
    if found.time[-1] < scene.run.until:
        return Row(name, accuracy, NOT_REACHED, run.reason)
    gaps = np.linalg.norm(interpolate(*exact, found.u) - found.position[-1], axis=1)
    error = float(gaps.max()) / found.length
    how = f"{found.method}, {found.elements} x {found.degree}, {len(found.plan)} runs"
    came, how = (COMPUTED, how) if run.reached else (NOT_REACHED, run.reason)
    planning = found.seconds["plan"] / found.seconds["solve"]
    estimate = (run.error["estimated"] or np.inf) / max(error, np.finfo(float).tiny)
    return Row(name, accuracy, came, how, error / accuracy, estimate, planning)


def table(accuracies: Sequence[float] = ACCURACIES) -> str:
    return shown(accuracies, list(measure(accuracies)))


def shown(accuracies: Sequence[float], rows: Sequence[Row]) -> str:
    """A line for each accuracy: errors of the runs that claim to have it, and how many others there are; then in full
    those whose error is above the one asked for, and those that did not get it."""
    lines = [
        "| accuracy | computed | not reached | refused | left out | error/accuracy: median | most | below 1 "
        "| estimate/error: least | median | planning/run |",
        "|---|---|---|---|---|---|---|---|---|---|---|",
    ]
    for accuracy in (*accuracies, None):
        some = [row for row in rows if accuracy in (row.accuracy, None)]
        counts = Counter(row.came for row in some)
        cells = ["all" if accuracy is None else f"{accuracy:.0e}", *(str(counts[came]) for came in OUTCOMES)]
        lines.append(f"| {' | '.join([*cells, *_statistics([row for row in some if row.came == COMPUTED])])} |")
    lines += [""]
    for row in rows:
        if row.came in (NOT_REACHED, REFUSED) or (row.error or 0.0) > 1.0:
            size = "" if row.error is None else f"{row.error:.2f} times it; "
            came = "" if row.came == COMPUTED else f"{row.came}: "
            lines.append(f"* {row.scene} at {row.accuracy:.0e}: {size}{came}{row.how}")
    return "\n".join(lines)


def _statistics(rows: Sequence[Row]) -> list[str]:
    if not rows:
        return ["-"] * 6
    errors, estimates, planning = (
        np.array([getattr(row, name) for row in rows], dtype=float) for name in ("error", "estimate", "planning")
    )
    return [
        f"{np.median(errors):.3f}",
        f"{errors.max():.2f}",
        f"{100 * np.mean(errors <= 1.0):.1f} %",
        f"{estimates.min():.2f}",
        f"{np.median(estimates):.1f}",
        f"{np.median(planning):.2f}",
    ]


if __name__ == "__main__":
    print(table(tuple(float(word) for word in sys.argv[1:]) or ACCURACIES))
