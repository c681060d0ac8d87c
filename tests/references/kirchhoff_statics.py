"""Equilibrium of a spatial rod that neither stretches nor shears: Kirchhoff's rod, clamped at u = 0, to about 1e-12.

    r' = R e_1,   R' = R Pi^,   Pi = Pi0(u) + stiffness^-1 M
    M' + Pi x M + e_1 x F = 0,   F = R^T n,   n = force + weight (L - u)

h = e_1 exactly, so the force F is not elastic: it is the multiplier that holds the rod to its length and its sections
across it, and the balance n' + weight = 0 alone gives it. Any of the three stiffnesses may be `math.inf`: that
component of Pi keeps its reference, and that of M is a multiplier too. The moment at the clamp is what is sought: with
it the equations are integrated to the tip (DOP853), where the moment must be R^T torque; Newton's method, by finite
differences, while the loads are raised in steps. The branch of the unloaded rod is followed as long as the steps of
the moment are small: `solve` does not look for bifurcations, keep to loads below buckling. Source: A. E. H. Love,
*Mathematical Theory of Elasticity*, chapters XVIII-XIX; H. B. Keller, *Numerical Methods for Two-Point Boundary-Value
Problems*.

Dimensions: stiffness force x length^2; Pi 1 / length; force, torque (force x length) and weight (force / length) are
dead, in world components.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp

Array = npt.NDArray[np.float64]
ZERO = (0.0, 0.0, 0.0)
STEPS = 8  # in which the loads are raised
GOAL = 3e-12  # of the moment left at the tip, in units of its size


@dataclass(frozen=True)
class Rod:
    """stiffness (3,): twist and two bends, `math.inf` allowed. reference: Pi0 (3,), or a function of u. The loads."""

    length: float
    stiffness: tuple[float, float, float]
    reference: npt.ArrayLike | Callable[[float], npt.ArrayLike] = ZERO
    force: tuple[float, float, float] = ZERO
    torque: tuple[float, float, float] = ZERO
    weight: tuple[float, float, float] = ZERO
    base_position: npt.ArrayLike = ZERO
    base_rotation: npt.ArrayLike = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True)
class Shape:
    """At u: position (points, 3), rotation (points, 3, 3), bend Pi, force F and moment M in the body (points, 3)."""

    u: Array
    position: Array
    rotation: Array
    bend: Array
    force: Array
    moment: Array


@dataclass(frozen=True)
class Equilibrium:
    """The solved rod: pose of the tip, stresses at the clamp in the body, moment left at the tip."""

    rod: Rod
    tip_position: Array
    tip_rotation: Array
    base_force: Array
    base_moment: Array
    residual: float

    def at(self, u: npt.ArrayLike) -> Shape:
        """The shape at u, increasing, (points,): integrated to each, not interpolated."""
        stations = np.asarray(u, dtype=float)
        states = _march(self.rod, self.base_moment[None], 1.0, stations)[:, 0]
        rotation, moment, position = states[:, :9].reshape(-1, 3, 3), states[:, 9:12], states[:, 12:]
        carried = np.asarray(self.rod.force) + np.outer(self.rod.length - stations, self.rod.weight)
        force = np.einsum("uji,uj->ui", rotation, carried)
        bend = np.stack([_reference(self.rod, x) for x in stations]) + moment / np.asarray(self.rod.stiffness)
        return Shape(stations, position, rotation, bend, force, moment)


def solve(rod: Rod) -> Equilibrium:
    """The equilibrium on the branch of the unloaded rod. Raises ArithmeticError where Newton's method loses it."""
    pull = float(np.linalg.norm(rod.force) + rod.length * np.linalg.norm(rod.weight))
    size = max(rod.length * pull, float(np.linalg.norm(rod.torque)), 1e-300)
    shift = 1e-6 * size
    copies = np.concatenate([np.zeros((1, 3)), shift * np.eye(3), -shift * np.eye(3)])
    end = np.array([rod.length])
    moment, before = np.zeros(3), np.zeros(3)
    for share in np.linspace(0.0, 1.0, STEPS + 1)[1:]:
        guess = 2.0 * moment - before if share > 1.5 / STEPS else moment
        before, moment = moment, guess
        goal, rtol = (GOAL, 1e-13) if share == 1.0 else (1e-6, 1e-8)
        for _ in range(12):
            states = _march(rod, moment + copies, share, end, rtol)[0]
            tips = states[:, :9].reshape(-1, 3, 3)
            missing = states[:, 9:12] - share * np.asarray(rod.torque) @ tips
            if np.abs(missing[0]).max() < goal * size:
                break
            slope = (missing[1:4] - missing[4:]).T / (2.0 * shift)
            moment = moment - np.linalg.solve(slope, missing[0])
        else:
            raise ArithmeticError(f"no equilibrium found at {share:.3f} of the load; expected a load without buckling")
    clamp = np.asarray(rod.base_rotation, dtype=float)
    force = clamp.T @ (np.asarray(rod.force) + rod.length * np.asarray(rod.weight))
    return Equilibrium(rod, states[0, 12:], tips[0], force, moment, float(np.abs(missing[0]).max()))


def _march(rod: Rod, moments: Array, share: float, stations: Array, rtol: float = 1e-13) -> Array:
    """States (stations, copies, 15), R by rows, M, r, from moments (copies, 3) at the clamp; increasing stations."""
    copies, compliance = len(moments), 1.0 / np.asarray(rod.stiffness)
    force, weight = share * np.asarray(rod.force), share * np.asarray(rod.weight)

    def rate(u: float, flat: Array) -> Array:
        y = flat.reshape(copies, 15)
        rotation, m = y[:, :9].reshape(copies, 3, 3), y[:, 9:12]
        bend = _reference(rod, u) + compliance * m
        f = (force + (rod.length - u) * weight) @ rotation
        turning = np.cross(rotation, bend[:, None, :]).reshape(copies, 9)  # rows of R Pi^ are row x Pi
        balance = np.cross(m, bend) + np.stack([np.zeros(copies), f[:, 2], -f[:, 1]], axis=1)  # f x e_1
        return np.concatenate([turning, balance, rotation[:, :, 0]], axis=1).ravel()

    clamp = np.concatenate([np.ravel(rod.base_rotation), np.zeros(3), np.ravel(rod.base_position)])
    start = np.tile(clamp, (copies, 1))
    start[:, 9:12] = moments
    state, here, states = start.ravel(), 0.0, []
    for there in stations:
        if there > here:
            found = solve_ivp(rate, (here, there), state, method="DOP853", rtol=rtol, atol=0.1 * rtol)
            state, here = found.y[:, -1], there
        states.append(state.reshape(copies, 15))
    return np.array(states)


def _reference(rod: Rod, u: float) -> Array:
    return np.asarray(rod.reference(u) if callable(rod.reference) else rod.reference, dtype=float)
