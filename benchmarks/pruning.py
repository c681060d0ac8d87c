"""What each mode and each effect costs: python -m benchmarks.pruning.

The same motion, a rod that relaxes in its plane, by models with ever less in them; then one effect at a time on top of
the planar and of the spatial rod. Seconds are those of the integration at the cheapest of a set of settings (degree,
method, tolerance) whose tip is within 1e-6 of the length of that model's own converged tip. For the smallest and the
largest model of the heavy rod also at other accuracies.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

import numpy as np

from benchmarks.warm import warm
from geocosserat.conductor.kernels import kernel_text
from geocosserat.conductor.simulate import tolerances
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.load import load
from geocosserat.model.records import Scene
from geocosserat.model.scene import load_scene
from geocosserat.planning.settings import Setting
from geocosserat.solver.integrate import integrate
from geocosserat.solver.trajectory import Trajectory

WANTED, REPEATS = 1e-6, 5
ACCURACIES = tuple(10.0**-k for k in range(4, 11))
METHODS = ("cvode", "radau")
How = tuple[str, Setting]
SETTINGS: list[How] = [
    (method, Setting(1, p, 10.0 ** (-k / 2)))
    for method, p, k in product(METHODS, (5, 6, 7, 8, 9, 10, 12), range(2, 17))
]
MORE: list[How] = [
    (method, Setting(1, p, 10.0 ** (-k / 2)))
    for method, p, k in product(METHODS, (5, 6, 7, 8, 9, 10, 12, 14, 16), range(2, 23))
]
FINE: How = ("radau", Setting(1, 20, 1e-12))
BEND = "3*(1 - u)**2*(1 + 2*u)"


def scene(motion: str, **changes: Any) -> Scene:
    """A clamped rod, bent at the start, 1e4 times stiffer against stretch and shear than against bending."""
    planar = motion == "planar"
    rod: dict[str, Any] = {
        "motion": motion,
        "length": 1.0,
        "stiffness": [1e4, 1e4, 1.0] if planar else [1e4, 1e4, 1e4, 1.0, 1.0, 1.0],
        "friction": [1.0, 1.0, 0.01] if planar else [1.0, 1.0, 1.0, 0.01, 0.01, 0.01],
        **changes.pop("rod", {}),
    }
    strain = ["1", "0", BEND] if planar else ["1", "0", "0", "0", "0", BEND]
    values = {"rod": rod, "start": {"strain": changes.pop("strain", strain)}, "run": {"until": 0.05}, **changes}
    return load_scene(values)


def heavy() -> Iterator[tuple[str, Scene]]:
    """The same rod in its plane under its weight, by models with ever more in them."""
    for name, motion, frozen in (
        ("planar, inextensible and unshearable", "planar", ["h1", "h2"]),
        ("planar Cosserat", "planar", []),
        ("Kirchhoff", "spatial", ["h1", "h2", "h3"]),
        ("spatial Cosserat", "spatial", []),
    ):
        force = [5.0, -30.0, 0.0][: 2 if motion == "planar" else 3]
        yield name, scene(motion, rod={"frozen": frozen}, effects=[{"kind": "weight", "force": force}])


def models() -> Iterator[tuple[str, Scene]]:
    """From the smallest to the largest."""
    twist = ["1", "0", "0", BEND, "0", "0"]
    rest = ["h1", "h2", "h3", "Pi2", "Pi3"]
    yield "pure twist", scene("spatial", rod={"frozen": rest}, strain=twist)
    yield "planar, inextensible and unshearable", scene("planar", rod={"frozen": ["h1", "h2"]})
    yield "planar Cosserat", scene("planar")
    yield "Kirchhoff", scene("spatial", rod={"frozen": ["h1", "h2", "h3"]})
    yield "spatial Cosserat", scene("spatial")


def effects(motion: str) -> Mapping[str, dict[str, Any]]:
    """One of each kind."""
    size = 2 if motion == "planar" else 3
    vector = [0.3, -0.5, 0.2][:size]
    return {
        "weight": {"kind": "weight", "force": vector},
        "follower": {"kind": "follower", "force": vector},
        "couple": {"kind": "couple", "torque": 0.1 if size == 2 else [0.1, 0.1, 0.1]},
        "field": {"kind": "field", "moment": vector, "field": vector[::-1]},
        "flow": {"kind": "flow", "gradient": np.diag(vector).tolist(), "velocity": vector},
        "trap": {"kind": "trap", "stiffness": 2.0, "centre": vector},
    }


def solve(which: Scene, how: How) -> tuple[np.ndarray, float, int, int]:
    """Position of the tip, seconds of the integration, unknowns, and operations of a rate at a point and a node."""
    method, setting = how
    rod = discretise(which, setting.elements, setting.degree)
    text = kernel_text(rod.structure)
    kernel = load(text, rod, "c")
    atol = tolerances(rod, setting.rtol, None, 1.0)
    times = np.array([0.0, which.run.until])

    def run() -> tuple[Trajectory, float]:
        start = time.perf_counter()
        done = integrate(kernel, rod.state, times, method, setting.rtol, atol)
        return done, time.perf_counter() - start

    found, seconds = warm(run)
    poses = rod.poses(found.states[-1], times[-1])
    operations = sum(count for name, count in text.signature["operations"].items() if name != "tangent")
    return np.append(poses.position[-1], poses.rotation[-1]), seconds, rod.unknowns, operations


def tried(which: Scene, settings: list[How]) -> list[tuple[float, float, How]]:
    """Error, seconds (the better of two) and setting of each one."""
    exact = solve(which, FINE)[0]
    found = []
    for how in settings:
        runs = [solve(which, how) for _ in range(2)]
        found.append((float(np.abs(runs[0][0] - exact).max()), min(run[1] for run in runs), how))
    return found


def cheapest(which: Scene) -> tuple[How, float, float, int, int]:
    """The setting, its least and median seconds, unknowns and operations."""
    good = [(seconds, how) for error, seconds, how in tried(which, SETTINGS) if error <= WANTED]
    how = min(good, key=lambda pair: pair[0])[1]
    runs = [solve(which, how) for _ in range(REPEATS)]
    seconds = [run[1] for run in runs]
    return how, min(seconds), float(np.median(seconds)), runs[0][2], runs[0][3]


def by_accuracy() -> list[str]:
    """Lines of a table: the smallest and the largest model of the heavy rod, by the cheapest way to an accuracy."""
    scenes = dict(heavy())
    names = ("planar, inextensible and unshearable", "spatial Cosserat")
    small, large = (tried(scenes[name], MORE) for name in names)
    lines = [f"| accuracy | ms, how: {' | '.join(names)} | ratio |", "|---|---|---|---|"]
    for accuracy in ACCURACIES:
        reached = [[run for run in runs if run[0] <= accuracy] for runs in (small, large)]
        if not all(reached):
            break
        best = [min(runs, key=lambda run: run[1]) for runs in reached]
        cells = [f"{1e3 * s:.2f}, {method}, degree {at.degree}, rtol {at.rtol:.0e}" for _, s, (method, at) in best]
        lines.append(f"| {accuracy:.0e} | {' | '.join(cells)} | {best[1][1] / best[0][1]:.1f} |")
    return lines


def table(rows: Iterator[tuple[str, Scene]], against: str) -> list[str]:
    """Lines of a table, times relative to the row called `against`."""
    found = {name: cheapest(which) for name, which in rows}
    unit = found[against][1]
    lines = [
        f"| | method, degree | unknowns | operations | ms, min (median) | to {against} |",
        "|---|---|---|---|---|---|",
    ]
    for name, ((method, setting), least, median, unknowns, operations) in found.items():
        cells = name, f"{method}, {setting.degree}", unknowns, operations, f"{1e3 * least:.2f} ({1e3 * median:.2f})"
        lines.append(f"| {' | '.join(map(str, cells))} | {least / unit:.2f} |")
    return lines


def with_effects(motion: str) -> Iterator[tuple[str, Scene]]:
    yield f"{motion} rod", scene(motion)
    for name, effect in effects(motion).items():
        yield f"with {name}", scene(motion, effects=[effect])


def report() -> str:
    """The tables as Markdown."""
    lines = ["Models of the same rod (operations: of a rate, at a Gauss point and a node)", ""]
    lines += table(models(), "planar, inextensible and unshearable")
    lines += ["", "The same under its weight, which makes the rod see the world", ""]
    lines += table(heavy(), "planar, inextensible and unshearable")
    lines += ["", "The heavy rod at other accuracies", "", *by_accuracy()]
    for motion in ("planar", "spatial"):
        lines += ["", f"Effects, one at a time, {motion}", "", *table(with_effects(motion), f"{motion} rod")]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(report())
