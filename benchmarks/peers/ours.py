"""This project: `integrate` on the generated kernel, warm, at a degree, a number of elements, a method and a
tolerance.

`solve` is a relaxing rod, `settle` the cantilever of `statics`: a motion from rest that goes on until it is static,
on one element and with as much friction as one likes. Timed as it is called from Python: from the initial state to
the state at the end. Compilation, and the marching of positions afterwards, are not timed, as for the other
solvers.
"""

import time
from functools import lru_cache

import numpy as np

from benchmarks.peers.problems import UNTIL, Problem, error_of_strains, rod_of
from benchmarks.peers.statics import LOAD, STIFFNESS, tip
from benchmarks.warm import warm
from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.kernel.load import load
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod
from geocosserat.model.scene import load_scene
from geocosserat.solver.integrate import integrate
from geocosserat.solver.trajectory import Trajectory


def solve(problem: Problem, elements: int, degree: int, method: str, rtol: float) -> tuple[float, float, int]:
    """Error, seconds, and steps."""
    rod, kernel = rod_of(problem, elements, degree)
    state, seconds, steps = _timed(rod, kernel, UNTIL, method, rtol)
    return error_of_strains(problem, rod.turn(state), elements, degree), seconds, steps


def _timed(
    rod: SemiDiscrete, kernel: NativeRod | NumpyRod, until: float, method: str, rtol: float
) -> tuple[np.ndarray, float, int]:
    """The state at the end, seconds, steps."""
    times = np.array([0.0, until])

    def run() -> tuple[Trajectory, float]:
        begin = time.perf_counter()
        found = integrate(kernel, rod.state, times, method, rtol, rtol)
        return found, time.perf_counter() - begin

    done, seconds = warm(run)
    if not done.reached:
        raise RuntimeError(f"ours: {done.reason}")
    return done.states[-1], seconds, done.steps


@lru_cache(maxsize=32)
def _cantilever(degree: int) -> tuple[SemiDiscrete, NativeRod | NumpyRod]:
    scene = load_scene(
        {
            "rod": {"motion": "planar", "length": 1.0, "stiffness": list(STIFFNESS), "friction": [1.0, 1.0, 0.01]},
            "ends": {"right": {"kind": "free", "force": [0.0, -LOAD], "frame": "world"}},
            "run": {"until": 1.0},
        }
    )
    rod = discretise(scene, 1, degree)
    return rod, load(kernel_text(rod.structure), rod, "c")


def settle(degree: int, method: str, until: float, rtol: float) -> tuple[float, float, int]:
    """Error of the tip, seconds, steps."""
    rod, kernel = _cantilever(degree)
    state, seconds, steps = _timed(rod, kernel, until, method, rtol)
    return float(np.linalg.norm(rod.poses(state, until).position[-1] - tip())), seconds, steps
