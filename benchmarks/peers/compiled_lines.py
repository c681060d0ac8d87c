"""Solver (b): the grids and unknowns of solver (a), with rate and Jacobian compiled by numba, in CVODE.

CVODE is that of scikit-sundae, with its banded linear solver (the one of LAPACK is slower here). The Jacobian is
exact, or CVODE differences the rate, whichever turns out cheaper: the binding takes banded Jacobians in full
matrices, of which only the band is touched, and copying that takes longer than differencing on fine grids. Rate and
Jacobian are called through Python, which matters on coarse grids only.
"""

import os
import time
from collections.abc import Callable
from contextlib import redirect_stdout
from functools import lru_cache
from io import StringIO
from typing import Any

import numpy as np
from numba import njit
from sksundae.cvode import CVODE

from benchmarks.peers.lines import begin, error_of_state
from benchmarks.peers.problems import UNTIL, Problem
from benchmarks.warm import warm
from geocosserat.discretisation.mesh import Array

MOST_STEPS = 20_000
JACOBIANS = ("exact", "differenced")

os.environ.setdefault("SUNLOGGER_WARNING_FILENAME", os.devnull)  # what fails is left out


@njit(cache=True)
def planar_rate(y: Array, dy: Array, k: Array, drag: Array) -> None:
    """Of x, y, theta at the nodes but the clamped one, interleaved."""
    n = len(y) // 3
    h = 1.0 / n
    a, b, d = k[0] / (drag[0] * h), k[0] / drag[2], k[2] / (drag[2] * h)
    x0, y0, t0 = 0.0, 0.0, 0.0
    fx0, fy0, m0, q0 = 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        x1, y1, t1 = y[3 * i], y[3 * i + 1], y[3 * i + 2]
        middle = 0.5 * (t0 + t1)
        c, s = np.cos(middle), np.sin(middle)
        xs, ys = (x1 - x0) / h, (y1 - y0) / h
        fx, fy, m, q = a * (xs - c), a * (ys - s), d * (t1 - t0) / h, 0.5 * b * (ys * c - xs * s)
        if i > 0:
            j = 3 * (i - 1)
            dy[j] = fx - fx0
            dy[j + 1] = fy - fy0
            dy[j + 2] = m - m0 + q + q0
        x0, y0, t0, fx0, fy0, m0, q0 = x1, y1, t1, fx, fy, m, q
    j = 3 * (n - 1)
    dy[j] = -2 * fx0
    dy[j + 1] = -2 * fy0
    dy[j + 2] = 2 * (q0 - m0)


@njit(cache=True)
def planar_jacobian(y: Array, J: Array, k: Array, drag: Array) -> None:
    """The band of J (3 n, 3 n); entries outside are left as they are."""
    n = len(y) // 3
    h = 1.0 / n
    a, b, d = k[0] / (drag[0] * h), 0.5 * k[0] / drag[2], k[2] / (drag[2] * h)
    for i in range(n):
        lo, hi = max(0, 3 * i - 3), min(3 * n, 3 * i + 6)
        for r in range(3):
            for c in range(lo, hi):
                J[3 * i + r, c] = 0.0
    for i in range(n):  # the midpoint before node i, between places p and q = p + 3 of the state
        q = 3 * i
        p = q - 3
        x0, y0, t0 = (0.0, 0.0, 0.0) if i == 0 else (y[p], y[p + 1], y[p + 2])
        middle = 0.5 * (t0 + y[q + 2])
        c, s = np.cos(middle), np.sin(middle)
        xs, ys = (y[q] - x0) / h, (y[q + 1] - y0) / h
        turned = -0.5 * b * (ys * s + xs * c)
        last = 2.0 if i == n - 1 else 1.0
        for row, sign in ((p, 1.0), (q, -last)):
            if row < 0:
                continue
            size = abs(sign)
            J[row, q] += sign * a / h
            J[row + 1, q + 1] += sign * a / h
            J[row + 2, q + 2] += sign * d / h + size * turned
            J[row, q + 2] += sign * a * 0.5 * s
            J[row + 1, q + 2] -= sign * a * 0.5 * c
            J[row + 2, q] -= size * b * s / h
            J[row + 2, q + 1] += size * b * c / h
            if p >= 0:
                J[row, p] -= sign * a / h
                J[row + 1, p + 1] -= sign * a / h
                J[row + 2, p + 2] += -sign * d / h + size * turned
                J[row, p + 2] += sign * a * 0.5 * s
                J[row + 1, p + 2] -= sign * a * 0.5 * c
                J[row + 2, p] += size * b * s / h
                J[row + 2, p + 1] -= size * b * c / h


@njit(cache=True)
def _cell(e: Array, k: Array, stress: Array, pull: Array) -> None:
    """Stress of a cell, and what the balance law takes off it along the rod."""
    for c in range(6):
        stress[c] = k[c] * e[c]
    stress[0] -= k[0]
    for i in range(3):
        j, q = (i + 1) % 3, (i + 2) % 3
        pull[i] = e[3 + q] * stress[j] - e[3 + j] * stress[q]
        pull[3 + i] = e[3 + q] * stress[3 + j] - e[3 + j] * stress[3 + q] + e[q] * stress[j] - e[j] * stress[q]


@njit(cache=True)
def _twist(n: int, i: int, left: Array, right: Array, drag: Array, out: Array) -> None:
    """Twist of node i from stress and pull of the cells beside it."""
    share = 2.0 * n if i == n else float(n)
    for c in range(6):
        out[c] = share / drag[c] * (right[0, c] - left[0, c] - 0.5 / n * (right[1, c] + left[1, c]))


@njit(cache=True)
def spatial_rate(y: Array, dy: Array, k: Array, drag: Array) -> None:
    """Of the strains of the cells, interleaved."""
    n = len(y) // 6
    own, following = np.zeros((2, 6)), np.zeros((2, 6))
    v0, v1, w = np.zeros(6), np.zeros(6), np.zeros(6)
    _cell(y[:6], k, own[0], own[1])
    for cell in range(n):
        e = y[6 * cell : 6 * cell + 6]
        if cell + 1 < n:
            _cell(y[6 * cell + 6 : 6 * cell + 12], k, following[0], following[1])
        else:
            following[:] = 0.0
        _twist(n, cell + 1, own, following, drag, v1)
        for c in range(6):
            w[c] = 0.5 * (v0[c] + v1[c])
        for i in range(3):
            j, q = (i + 1) % 3, (i + 2) % 3
            dy[6 * cell + i] = (
                n * (v1[i] - v0[i]) + e[3 + j] * w[q] - e[3 + q] * w[j] + e[j] * w[3 + q] - e[q] * w[3 + j]
            )
            dy[6 * cell + 3 + i] = n * (v1[3 + i] - v0[3 + i]) + e[3 + j] * w[3 + q] - e[3 + q] * w[3 + j]
        own, following, v0, v1 = following, own, v1, v0


@njit(cache=True)
def _feed(e: Array, k: Array, half: float, side: float, share: float, drag: Array, out: Array) -> None:
    """What a change of a cell's strains does to the twist of the node on its right (side -1) or left (side 1)."""
    out[:] = 0.0
    f = k[:3] * e[:3]
    f[0] -= k[0]
    m = k[3:] * e[3:]
    for i in range(3):
        j, q = (i + 1) % 3, (i + 2) % 3
        out[i, j] = e[3 + q] * k[j]
        out[i, q] = -e[3 + j] * k[q]
        out[i, 3 + j] = -f[q]
        out[i, 3 + q] = f[j]
        out[3 + i, j] = e[q] * k[j] - f[q]
        out[3 + i, q] = f[j] - e[j] * k[q]
        out[3 + i, 3 + j] = e[3 + q] * k[3 + j] - m[q]
        out[3 + i, 3 + q] = m[j] - e[3 + j] * k[3 + q]
    for i in range(6):
        for j in range(6):
            out[i, j] *= -half * share / drag[i]
        out[i, i] += side * k[i] * share / drag[i]


@njit(cache=True)
def _carry(e: Array, slope: float, feed: Array, J: Array, row: int, column: int) -> None:
    """J block += (slope + ad_E / 2) feed."""
    for c in range(6):
        for i in range(3):
            j, q = (i + 1) % 3, (i + 2) % 3
            turned = e[3 + j] * feed[q, c] - e[3 + q] * feed[j, c] + e[j] * feed[3 + q, c] - e[q] * feed[3 + j, c]
            J[row + i, column + c] += slope * feed[i, c] + 0.5 * turned
            turned = e[3 + j] * feed[3 + q, c] - e[3 + q] * feed[3 + j, c]
            J[row + 3 + i, column + c] += slope * feed[3 + i, c] + 0.5 * turned


@njit(cache=True)
def spatial_jacobian(y: Array, J: Array, k: Array, drag: Array) -> None:
    """The band of J (6 n, 6 n); entries outside are left as they are."""
    n = len(y) // 6
    half = 0.5 / n
    own, following, feed = np.zeros((2, 6)), np.zeros((2, 6)), np.zeros((6, 6))
    v0, v1, w = np.zeros(6), np.zeros(6), np.zeros(6)
    _cell(y[:6], k, own[0], own[1])
    for cell in range(n):
        r = 6 * cell
        e = y[r : r + 6]
        for i in range(r, r + 6):
            for c in range(max(0, r - 6), min(6 * n, r + 12)):
                J[i, c] = 0.0
        share = float(n) if cell + 1 < n else 2.0 * n
        _feed(e, k, half, -1.0, share, drag, feed)
        _carry(e, float(n), feed, J, r, r)
        if cell + 1 < n:
            following_e = y[r + 6 : r + 12]
            _cell(following_e, k, following[0], following[1])
            _feed(following_e, k, half, 1.0, share, drag, feed)
            _carry(e, float(n), feed, J, r, r + 6)
        else:
            following[:] = 0.0
        if cell > 0:
            _feed(e, k, half, 1.0, float(n), drag, feed)
            _carry(e, -float(n), feed, J, r, r)
            _feed(y[r - 6 : r], k, half, -1.0, float(n), drag, feed)
            _carry(e, -float(n), feed, J, r, r - 6)
        _twist(n, cell + 1, own, following, drag, v1)
        for c in range(6):
            w[c] = 0.5 * (v0[c] + v1[c])
        for i in range(3):  # the strain in ad_E
            j, q = (i + 1) % 3, (i + 2) % 3
            for b in (0, 3):
                J[r + b + i, r + b + j] += w[3 + q]
                J[r + b + i, r + b + q] -= w[3 + j]
            J[r + i, r + 3 + j] += w[q]
            J[r + i, r + 3 + q] -= w[j]
        own, following, v0, v1 = following, own, v1, v0


def functions(problem: Problem) -> tuple[Callable[..., Any], Callable[..., Any], Array, Array]:
    """Rate, Jacobian, stiffness and friction."""
    pair = (planar_rate, planar_jacobian) if problem.motion == "planar" else (spatial_rate, spatial_jacobian)
    return *pair, np.array(problem.stiffness), np.array(problem.friction)


@lru_cache(maxsize=8)
def _compiled(problem: Problem) -> None:
    """Compiles before anything is timed."""
    rate, jacobian, k, drag = functions(problem)
    y = begin(problem, 2)
    y.flags.writeable = False  # as CVODE hands it on
    rate(y, np.empty_like(y), k, drag)
    jacobian(y, np.empty((len(y), len(y))), k, drag)


def solve(problem: Problem, cells: int, jacobians: str, rtol: float) -> tuple[float, float, int]:
    """Error, seconds, and calls of the rate."""
    _compiled(problem)
    rate, jacobian, k, drag = functions(problem)
    calls, y, band = [0], begin(problem, cells), 2 * problem.size - 1

    def f(t: float, y: Array, dy: Array) -> None:
        calls[0] += 1
        rate(y, dy, k, drag)

    def fill(t: float, y: Array, dy: Array, J: Array) -> None:
        jacobian(y, J, k, drag)

    exact = fill if jacobians == "exact" else None

    def run() -> tuple[Any, float]:
        calls[0] = 0
        at = time.perf_counter()
        solver = CVODE(
            f, rtol=rtol, atol=rtol, linsolver="band", lband=band, uband=band, jacfn=exact, max_num_steps=MOST_STEPS
        )
        solver.init_step(0.0, y)
        found = solver.step(UNTIL, method="normal", tstop=UNTIL)
        return found, time.perf_counter() - at

    with redirect_stdout(StringIO()):  # the binding prints what it also returns
        done, seconds = warm(run)
    if not done.success:
        raise RuntimeError(f"CVODE: {done.message}")
    return error_of_state(problem, np.array(done.y)), seconds, calls[0]
