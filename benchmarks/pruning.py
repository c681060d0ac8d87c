"""What each mode and each effect costs: python -m benchmarks.pruning.

The same motion, a rod that relaxes in its plane, by models with ever less in them; then one effect at a time on top of
the planar and of the spatial rod. Seconds are those of the integration at the cheapest of a set of settings whose tip
is within 1e-6 of the length of that model's own converged tip.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

import numpy as np

from geocosserat.accuracy import Setting
from geocosserat.conductor import kernel_text
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.load import load
from geocosserat.model.records import Scene
from geocosserat.model.scene import load_scene
from geocosserat.simulation import tolerances
from geocosserat.solver.integrate import integrate

WANTED, REPEATS = 1e-6, 5
SETTINGS = [Setting(1, p, rtol) for p, rtol in product((5, 6, 7, 8, 10, 12), (1e-5, 1e-6, 1e-7, 1e-8))]
FINE = Setting(1, 18, 1e-11)
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


def solve(which: Scene, setting: Setting) -> tuple[np.ndarray, float, int, int]:
    """Position of the tip, seconds of the integration, unknowns, and operations of a rate at a point and a node."""
    rod = discretise(which, setting.elements, setting.degree)
    text = kernel_text(rod.structure)
    kernel = load(text, rod, "c")
    atol = tolerances(rod, setting.rtol, None, 1.0)
    times = np.array([0.0, which.run.until])
    start = time.perf_counter()
    found = integrate(kernel, rod.state, times, rtol=setting.rtol, atol=atol)
    seconds = time.perf_counter() - start
    poses = rod.poses(found.states[-1], times[-1])
    operations = sum(count for name, count in text.signature["operations"].items() if name != "tangent")
    return np.append(poses.position[-1], poses.rotation[-1]), seconds, rod.unknowns, operations


def cheapest(which: Scene) -> tuple[Setting, float, float, int, int]:
    """The setting, its least and median seconds, unknowns and operations."""
    exact = solve(which, FINE)[0]
    good = []
    for setting in SETTINGS:
        found, seconds, *_ = min((solve(which, setting) for _ in range(2)), key=lambda run: run[1])
        if np.abs(found - exact).max() <= WANTED:
            good.append((seconds, setting))
    setting = min(good, key=lambda pair: pair[0])[1]
    runs = [solve(which, setting) for _ in range(REPEATS)]
    seconds = [run[1] for run in runs]
    return setting, min(seconds), float(np.median(seconds)), runs[0][2], runs[0][3]


def table(rows: Iterator[tuple[str, Scene]], against: str) -> list[str]:
    """Lines of a table, times relative to the row called `against`."""
    found = {name: cheapest(which) for name, which in rows}
    unit = found[against][1]
    lines = [
        f"| | degree | unknowns | operations | ms, min (median) | relative to {against} |",
        "|---|---|---|---|---|---|",
    ]
    for name, (setting, least, median, unknowns, operations) in found.items():
        times = f"{1e3 * least:.2f} ({1e3 * median:.2f})"
        lines.append(f"| {name} | {setting.degree} | {unknowns} | {operations} | {times} | {least / unit:.2f} |")
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
    for motion in ("planar", "spatial"):
        lines += ["", f"Effects, one at a time, {motion}", "", *table(with_effects(motion), f"{motion} rod")]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(report())
