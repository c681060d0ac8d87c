"""Linear algebra of an implicit step: milliseconds of a whole integration, over sizes.

In C: the kernel's own block elimination against dense matrices and against GMRES, both through CVODE's binding. In
numpy there is only the binding: where its two columns cross is geocosserat.solver.settings.DENSE_LIMIT.
"""

import statistics
import time
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.load import load
from geocosserat.model.scene import load_scene
from geocosserat.solver import cvode
from geocosserat.solver import integrate as door
from geocosserat.solver.integrate import integrate

STIFFNESS = {"planar": [900.0, 700.0, 1.5], "spatial": [900.0, 700.0, 600.0, 0.8, 1.5, 1.2]}
FRICTION = {"planar": [1.0, 2.0, 0.01], "spatial": [1.0, 2.0, 1.9, 0.01, 0.02, 0.03]}
BEND = {"planar": ["1", "0", "3*(1-u)"], "spatial": ["1", "0", "0", "1-u", "2*(1-u)", "3*(1-u)"]}
CASES = [(1, 4), (1, 8), (1, 12), (1, 16), (4, 4), (16, 1), (8, 4), (64, 1)]


@contextmanager
def binding(limit: int) -> Iterator[None]:
    """CVODE through its binding, dense up to this size."""
    kept = door.sundials, cvode.DENSE_LIMIT
    door.sundials, cvode.DENSE_LIMIT = (lambda _: None), limit  # type: ignore[assignment]
    try:
        yield
    finally:
        door.sundials, cvode.DENSE_LIMIT = kept  # type: ignore[assignment]


def measure(motion: str, elements: int, degree: int, rounds: int = 5) -> tuple[int, list[float]]:
    """Size of the state, and median ms: C with blocks, dense, GMRES; numpy dense, GMRES."""
    rod = {"motion": motion, "length": 1.0, "stiffness": STIFFNESS[motion], "friction": FRICTION[motion]}
    scene = load_scene({"rod": rod, "start": {"strain": BEND[motion]}, "run": {"until": 0.05}})
    made = discretise(scene, elements, degree)
    text, times = kernel_text(made.structure), np.array([0.0, 0.05])
    c, plain = (load(text, made, backend) for backend in ("c", "numpy"))

    def run(kernel: object) -> float:
        start = time.perf_counter()
        integrate(kernel, made.state, times, "cvode", 1e-7, 1e-7)  # type: ignore[arg-type]
        return 1e3 * (time.perf_counter() - start)

    spent: list[list[float]] = [[] for _ in range(5)]
    for _ in range(rounds):
        spent[0].append(run(c))
        for i, (kernel, limit) in enumerate([(c, 10**9), (c, 0), (plain, 10**9), (plain, 0)], start=1):
            with binding(limit):
                spent[i].append(run(kernel))
    return c.size, [statistics.median(t) for t in spent]


def table() -> str:
    """Markdown, one row a case."""
    columns = ["C, blocks", "C, dense", "C, GMRES", "numpy, dense", "numpy, GMRES"]
    lines = [f"| motion | elements x degree | size | {' | '.join(columns)} |", "|---" * (3 + len(columns)) + "|"]
    for motion in ("planar", "spatial"):
        for n, p in CASES:
            size, spent = measure(motion, n, p)
            lines.append(f"| {motion} | {n} x {p} | {size} | {' | '.join(f'{t:.2f}' for t in spent)} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(table())
