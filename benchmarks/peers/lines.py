"""Solver (a): the method of lines in numpy, integrated by scipy.

In the plane the paper's equations for position and angle (its display 76, derived anew from compatibility and
balance, for equal stretch and shear stiffness and isotropic friction), unknowns x, y, theta at the nodes, strains
at the midpoints between them: second order, and it does not lock. With N = k (r' - e_1) the force in the world at a
midpoint,

    gamma dr/dt = N',    gamma_3 dtheta/dt = theta'' + <e_1 x N>

where < > is the mean of the two midpoints next to a node, and a node at the free end has half a cell to itself. In
space the same grid with the strains as unknowns: velocities at the nodes from the balance, strains at the midpoints
from the compatibility. Components are written out: `np.cross` costs several times as much.

Unknowns are interleaved by place, so the Jacobian has as many diagonals as two neighbouring places need. LSODA runs
as `odeint` (its loop is compiled; through `solve_ivp` each step passes through Python) and differences its banded
Jacobian itself; scipy's BDF does so by groups of columns of a `jac_sparsity`. The better of the two counts.
"""

import time
import warnings
from collections.abc import Callable

import numpy as np
from scipy.integrate import odeint, solve_ivp
from scipy.sparse import diags_array as diags
from scipy.sparse import kron, spmatrix

from benchmarks.peers.problems import UNTIL, Problem, error, error_of_strains, start, strain
from benchmarks.warm import warm
from geocosserat.discretisation.mesh import Array

METHODS = ("lsoda", "bdf")
MOST_STEPS = 100_000
Rate = Callable[[Array], Array]


def planar_rate(problem: Problem, cells: int) -> Rate:
    """Of y (3 cells,): x, y, theta at the nodes but the clamped one."""
    h = 1.0 / cells
    k, bending = problem.stiffness[1:]
    drag, turning = problem.friction[1:]
    pose = np.zeros((cells + 1, 3))
    flux = np.zeros((cells + 1, 3))  # force in the world and moment; behind the free end there is none
    turn = np.zeros(cells + 1)

    def rate(y: Array) -> Array:
        pose[1:] = y.reshape(cells, 3)
        slope = (pose[1:] - pose[:-1]) / h
        middle = (pose[1:, 2] + pose[:-1, 2]) / 2
        c, s = np.cos(middle), np.sin(middle)
        x, y = slope[:, 0], slope[:, 1]
        flux[:-1, 0] = k / drag * (x - c)
        flux[:-1, 1] = k / drag * (y - s)
        flux[:-1, 2] = bending / turning * slope[:, 2]
        turn[:-1] = 0.5 * k / turning * (y * c - x * s)
        out = (flux[1:] - flux[:-1]) / h
        out[:, 2] += turn[1:] + turn[:-1]
        out[-1] *= 2
        return out.ravel()

    return rate


def spatial_rate(problem: Problem, cells: int) -> Rate:
    """Of y (6 cells,): the strains at the midpoints."""
    h = 1.0 / cells
    k = np.array(problem.stiffness)[:, None]
    rest = np.eye(6)[:, :1]
    share = 1.0 / (h * np.array(problem.friction))[:, None]
    stress, pull = np.zeros((6, cells + 2)), np.zeros((6, cells + 2))  # with a cell behind each end
    twist = np.zeros((6, cells + 1))

    def rate(y: Array) -> Array:
        e = np.ascontiguousarray(y.reshape(cells, 6).T)
        stress[:, 1:-1] = k * (e - rest)
        h1, h2, h3, p1, p2, p3 = e
        f1, f2, f3, m1, m2, m3 = stress[:, 1:-1]
        pull[:, 1:-1] = (
            p3 * f2 - p2 * f3,
            p1 * f3 - p3 * f1,
            p2 * f1 - p1 * f2,
            p3 * m2 - p2 * m3 + h3 * f2 - h2 * f3,
            p1 * m3 - p3 * m1 + h1 * f3 - h3 * f1,
            p2 * m1 - p1 * m2 + h2 * f1 - h1 * f2,
        )
        twist[:] = share * (stress[:, 1:] - stress[:, :-1] - 0.5 * h * (pull[:, 1:] + pull[:, :-1]))
        twist[:, 0] = 0.0
        twist[:, -1] *= 2
        v1, v2, v3, o1, o2, o3 = (twist[:, 1:] + twist[:, :-1]) / 2
        out = (twist[:, 1:] - twist[:, :-1]) / h
        out[0] += h2 * o3 - h3 * o2 + p2 * v3 - p3 * v2
        out[1] += h3 * o1 - h1 * o3 + p3 * v1 - p1 * v3
        out[2] += h1 * o2 - h2 * o1 + p1 * v2 - p2 * v1
        out[3] += p2 * o3 - p3 * o2
        out[4] += p3 * o1 - p1 * o3
        out[5] += p1 * o2 - p2 * o1
        return out.T.ravel()

    return rate


def begin(problem: Problem, cells: int) -> Array:
    """The state at the start, interleaved by place."""
    u = np.linspace(0.0, 1.0, cells + 1)
    if problem.motion == "planar":
        return start(problem, u[1:]).ravel()
    return strain(problem, (u[1:] + u[:-1]) / 2).T.ravel()


def error_of_state(problem: Problem, y: Array) -> float:
    """Error of a state; of positions at the nodes in the plane, everywhere on the rod in space."""
    if problem.motion == "planar":
        position = y.reshape(-1, 3)[:, :2]
        u = np.linspace(0.0, 1.0, len(position) + 1)
        return error(problem, u, np.concatenate([np.zeros((1, 2)), position]))
    strains = y.reshape(-1, 6).T
    return error_of_strains(problem, strains, strains.shape[1], 1)


def _pattern(problem: Problem, cells: int) -> spmatrix:
    """Where the Jacobian may be other than zero."""
    ones = diags([np.ones(cells - 1), np.ones(cells), np.ones(cells - 1)], offsets=[-1, 0, 1])
    return kron(ones, np.ones((problem.size, problem.size))).tocsc()


def solve(problem: Problem, cells: int, method: str, rtol: float) -> tuple[float, float, int]:
    """Error, seconds, and calls of the rate."""
    rate = (planar_rate if problem.motion == "planar" else spatial_rate)(problem, cells)
    y, band, times = begin(problem, cells), 2 * problem.size - 1, (0.0, UNTIL)
    pattern = _pattern(problem, cells) if method == "bdf" else None

    def by_lsoda() -> tuple[tuple[Array, int], float]:
        at = time.perf_counter()
        found, told = odeint(
            lambda y, _: rate(y),
            y,
            times,
            rtol=rtol,
            atol=rtol,
            ml=band,
            mu=band,
            mxstep=MOST_STEPS,
            full_output=True,
        )
        return (found[-1], int(told["nfe"][-1])), time.perf_counter() - at

    def by_bdf() -> tuple[tuple[Array, int], float]:
        at = time.perf_counter()
        run = solve_ivp(
            lambda _, y: rate(y), times, y, "BDF", t_eval=times[1:], rtol=rtol, atol=rtol, jac_sparsity=pattern
        )
        seconds = time.perf_counter() - at
        if not run.success:
            raise RuntimeError(f"BDF: {run.message}")
        return (run.y[:, -1], run.nfev), seconds

    with warnings.catch_warnings():
        if method == "lsoda":
            warnings.simplefilter("error")  # by which it says that it failed
        (end, calls), seconds = warm(by_lsoda if method == "lsoda" else by_bdf)
    return error_of_state(problem, end), seconds, calls
