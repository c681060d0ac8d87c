"""Dense Newton matrices against block elimination: milliseconds of a whole integration, over sizes.

Where the two curves cross is geocosserat.solver.settings.DENSE_LIMIT.
"""

import statistics
import time

import numpy as np

import geocosserat.solver.cvode_native as native
from geocosserat.codegen.source import generate
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.compile import compile_c
from geocosserat.kernel.native import NativeRod
from geocosserat.model.scene import load_scene
from geocosserat.solver.integrate import integrate

STIFFNESS = {"planar": [900.0, 700.0, 1.5], "spatial": [900.0, 700.0, 600.0, 0.8, 1.5, 1.2]}
FRICTION = {"planar": [1.0, 2.0, 0.01], "spatial": [1.0, 2.0, 1.9, 0.01, 0.02, 0.03]}
BEND = {"planar": ["1", "0", "3*(1-u)"], "spatial": ["1", "0", "0", "1-u", "2*(1-u)", "3*(1-u)"]}
CASES = [(1, 4), (1, 8), (1, 12), (1, 16), (4, 4), (16, 1), (8, 4), (64, 1)]


def measure(motion: str, elements: int, degree: int, rounds: int = 5) -> tuple[int, float, float]:
    """(size of the state, median ms with dense matrices, median ms with blocks)."""
    rod = {"motion": motion, "length": 1.0, "stiffness": STIFFNESS[motion], "friction": FRICTION[motion]}
    scene = load_scene({"rod": rod, "start": {"strain": BEND[motion]}, "run": {"until": 0.05}})
    made = discretise(scene, elements, degree)
    kernel = NativeRod(compile_c(generate(made.structure).c, degree), made)
    times, kept = np.array([0.0, 0.05]), native.DENSE_LIMIT
    spent: dict[int, list[float]] = {10**9: [], 0: []}
    for _ in range(rounds):
        for limit, found in spent.items():
            native.DENSE_LIMIT = limit
            start = time.perf_counter()
            integrate(kernel, made.state, times, "cvode", 1e-7, 1e-7)
            found.append(1e3 * (time.perf_counter() - start))
    native.DENSE_LIMIT = kept
    dense, blocks = (statistics.median(t) for t in spent.values())
    return kernel.size, dense, blocks


def table() -> str:
    """Markdown, one row a case."""
    lines = ["| motion | elements x degree | size | dense, ms | blocks, ms |", "|---|---|---|---|---|"]
    for motion in ("planar", "spatial"):
        for n, p in CASES:
            size, dense, blocks = measure(motion, n, p)
            lines.append(f"| {motion} | {n} x {p} | {size} | {dense:.2f} | {blocks:.2f} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(table())
