"""The motions that all solvers are timed on, and what an error is.

A clamped-free rod of length 1 relaxes from a bent shape for T = 0.05. In the plane: stretch and shear stiffness k,
bending stiffness 1, friction (1, 1, 0.01), curvature 3 (1 - u)^2 (1 + 2 u) at the start, for k = 1e2, 1e4 and 1e6.
In space: k = 1e4 for stretch and shear, 0.7 for twist, 1 for bending, friction (1, 2, 2, 0.01, 0.01, 0.01), and a
start that twists, bends out of its plane, and is free of moments at the free end.

The error of a run is the largest distance of the rod at the end from a reference, over all the places where the
solver knows the rod, relative to its length: space and time together. The reference is this project's own run on
one element of degree 24 at rtol 1e-13; `reference_error` compares it with degree 20. The tests of the project
compare the same scheme with references that share no code with it.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.mesh import Array, make_mesh
from geocosserat.discretisation.pose import march
from geocosserat.discretisation.sampling import along
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.kernel.load import load
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod
from geocosserat.model.records import Scene
from geocosserat.model.scene import load_scene
from geocosserat.solver.integrate import integrate

UNTIL = 0.05
BEND = "3*(1 - u)**2*(1 + 2*u)"
FINE, ALMOST = (1, 24), (1, 20)
TIGHT = 1e-13
EXTRA = 6
"""Degrees by which the rod of given strains is finer than these, so that its positions are those of the strains."""


@dataclass(frozen=True)
class Problem:
    """A rod of length 1, straight at rest, clamped on the left. Stiffness and friction are diagonals."""

    name: str
    motion: str
    stiffness: tuple[float, ...]
    friction: tuple[float, ...]
    strain: tuple[str, ...]

    @property
    def size(self) -> int:
        """Strains at a place: 3 in the plane, 6 in space."""
        return len(self.stiffness)


def planar(k: float) -> Problem:
    """The rod in the plane."""
    return Problem(f"planar, k = {k:.0e}", "planar", (k, k, 1.0), (1.0, 1.0, 0.01), ("1", "0", BEND))


def spatial() -> Problem:
    """The rod in space."""
    strain = ("1", "0", "0", "2*(1 - u)**2*(1 + 2*u)", "1.5*(1 - u)**2*sin(3*u)", "2*(1 - u)**2*(1 + 2*u)")
    friction = (1.0, 2.0, 2.0, 0.01, 0.01, 0.01)
    return Problem("spatial, k = 1e+04", "spatial", (1e4, 1e4, 1e4, 0.7, 1.0, 1.0), friction, strain)


PROBLEMS = (planar(1e2), planar(1e4), planar(1e6), spatial())


@lru_cache(maxsize=len(PROBLEMS))
def scene(problem: Problem) -> Scene:
    """As this project reads it."""
    return load_scene(
        {
            "rod": {
                "motion": problem.motion,
                "length": 1.0,
                "stiffness": list(problem.stiffness),
                "friction": list(problem.friction),
            },
            "start": {"strain": list(problem.strain)},
            "run": {"until": UNTIL},
        }
    )


def strain(problem: Problem, u: Array) -> Array:
    """Strains (size, places) at the start."""
    return np.array([along(e, {}, u) for e in scene(problem).start.strain])


@lru_cache(maxsize=32)
def rod_of(problem: Problem, elements: int, degree: int) -> tuple[SemiDiscrete, NativeRod | NumpyRod]:
    """This project's rod and its compiled kernel."""
    rod = discretise(scene(problem), elements, degree)
    return rod, load(kernel_text(rod.structure), rod, "c")


def between(values: Array, u: Array) -> Array:
    """Values (nodes, ...) of a polynomial at the nodes of the reference, at other places of the rod."""
    nodes = rod_of(PROBLEMS[0], *FINE)[0].mesh.reference.nodes
    legendre = np.polynomial.legendre.legvander
    found: Array = legendre(2 * u - 1, FINE[1]) @ np.linalg.solve(legendre(nodes, FINE[1]), values)
    return found


def start(problem: Problem, u: Array) -> Array:
    """Position and angle (places, 3) of the planar rod at the start."""
    rod, _ = rod_of(problem, *FINE)
    poses = rod.poses(rod.state)
    assert poses.angle is not None
    return between(np.column_stack([poses.position, poses.angle]), u)


@lru_cache(maxsize=2 * len(PROBLEMS))
def _converged(problem: Problem, size: tuple[int, int]) -> tuple[Array, Array]:
    rod, kernel = rod_of(problem, *size)
    done = integrate(kernel, rod.state, np.array([0.0, UNTIL]), "radau", TIGHT, TIGHT)
    if not done.reached:
        raise RuntimeError(f"the reference was not reached: {done.reason}")
    return rod.mesh.u, rod.poses(done.states[-1]).position


def error(problem: Problem, u: Array, position: Array) -> float:
    """Largest distance of positions (places, axes) at u from the reference; the length is 1."""
    exact = between(_converged(problem, FINE)[1], u)
    return float(np.linalg.norm(exact - position, axis=1).max())


def reference_error(problem: Problem) -> float:
    """How far another fine discretisation is from the reference."""
    return error(problem, *_converged(problem, ALMOST))


def error_of_strains(problem: Problem, strains: Array, elements: int, degree: int) -> float:
    """Error of a rod whose strains (size, points) at the Gauss points of equal elements are known: everywhere on it.

    Between the points the strains are polynomials, in each element; the rod is the one that has them.
    """
    coarse, fine = make_mesh(1.0, elements, degree), make_mesh(1.0, elements, degree + EXTRA)
    legendre = np.polynomial.legendre.legvander
    spread = np.linalg.solve(
        legendre(coarse.reference.points, degree - 1).T, legendre(fine.reference.points, degree - 1).T
    )
    strains = (strains.reshape(problem.size, elements, degree) @ spread).reshape(problem.size, -1)
    axes = 2 if problem.motion == "planar" else 3
    angle = np.asarray(0.0) if axes == 2 else None
    return error(problem, fine.u, march(fine, strains, np.zeros(axes), np.eye(axes), angle).position)
