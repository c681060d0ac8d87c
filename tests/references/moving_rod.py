"""A spatial rod in a viscous fluid, clamped at u = 0: positions and quaternions in time, to about 1e-9.

The balances of force and of moment of a piece of rod, in the world, for n = R F and m = R M:

    h = R^T r',  Pi from R' = R Pi^,  (F, M) = K ((h, Pi) - E0)
    v = R^T r_t, Omega from R_t = R Omega^,  Gamma (v, Omega) = R^T (n' + weight, m' + r' x n)

with n, m given at the free end. The unknowns at Chebyshev points are the quaternion of R and w = r - integral of
e_1, what stretch and shear add to the unstretched rod: the stiff part is linear in w. Neither strains nor a Lie
bracket is integrated. The free end has no rate: its seven unknowns obey (F, M) = load and |q| = 1, so the system is
differential-algebraic (index 1); Radau IIA of 4 stages (order 7) integrates it as it stands, on growing steps.
Source: L. N. Trefethen, *Spectral Methods in MATLAB*.

Dimensions: stiffness (force x 3, force x length^2 x 3); friction (force x time / length^2 x 3, force x time x 3).
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from tests.references import chebyshev
from tests.references.radau import instants, integrate

Array = npt.NDArray[np.float64]
Values = npt.NDArray[Any]  # real, or complex for derivatives

FIRST = np.array([1.0, 0.0, 0.0])
STAGES = 4


@dataclass(frozen=True)
class Rod:
    """The coefficients, the loads and the start.

    stiffness, friction (6, 6); reference (6,). force(t) (3,): dead, in world components, on the free end. weight (3,):
    force per length, in the world. start(u) (6,): the turn at the start. position (3,), rotation (3, 3) of the clamp.
    """

    length: float
    stiffness: Array
    friction: Array
    reference: Array
    start: Callable[[float], npt.ArrayLike]
    force: Callable[[float], npt.ArrayLike]
    weight: npt.ArrayLike = (0.0, 0.0, 0.0)
    position: npt.ArrayLike = (0.0, 0.0, 0.0)
    rotation: npt.ArrayLike = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


@dataclass(frozen=True)
class Shape:
    """The rod at the points u: position (points, 3), rotation (points, 3, 3), turn E (points, 6)."""

    u: Array
    position: Array
    rotation: Array
    turn: Array


class Collocation:
    """w (3) and quaternion (4) at all points but the clamp make a state, (7 degree,); see `radau.System`."""

    def __init__(self, rod: Rod, degree: int) -> None:
        self.rod, self.u = rod, chebyshev.points(degree, rod.length)
        self.slope = chebyshev.derivative(degree, rod.length)
        self.integral = chebyshev.integral(degree, rod.length, 0)
        self.clamp = np.roll(Rotation.from_matrix(np.asarray(rod.rotation)).as_quat(), 1)
        self.mobility = np.linalg.inv(rod.friction)

    def begin(self) -> Array:
        """phi' = phi E from the clamp, for w and q."""

        def rate(u: float, y: Array) -> Array:
            turn = np.asarray(self.rod.start(u), dtype=float)
            return np.concatenate([rotated(y[3:], turn[:3] - FIRST), 0.5 * product(y[3:], turn[3:])])

        clamp, states = np.concatenate([np.zeros(3), self.clamp]), []
        for before, after in itertools.pairwise(self.u):  # to each point, not interpolated
            clamp = solve_ivp(rate, (before, after), clamp, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
            states.append(clamp)
        return np.array(states).ravel()

    def moved(self, y: Values) -> Values:
        """What the rates are the rates of: r - r(clamp) and q; nothing at the free end."""
        whole = self.whole(y)
        along = self.integral @ rotated(whole[..., 3:], FIRST)
        result = np.concatenate([whole[..., :3] + along, whole[..., 3:]], axis=-1)[..., 1:, :]
        result[..., -1, :] = 0.0
        return np.asarray(result.reshape(y.shape))

    def whole(self, y: Values) -> Values:
        """w and quaternion at all points, (..., points, 7): with the clamp in front."""
        clamp = np.concatenate([np.zeros(3), self.clamp])
        points = y.reshape(*y.shape[:-1], -1, 7)
        return np.concatenate([np.broadcast_to(clamp, (*y.shape[:-1], 1, 7)), points], axis=-2)

    def fields(self, y: Values) -> tuple[Values, Values, Values]:
        """At all points: quaternions (..., 4), turn and stress (..., 6)."""
        whole = self.whole(y)
        slopes = self.slope @ whole
        q, dq = whole[..., 3:], slopes[..., 3:]
        bend = 2.0 * product(conjugate(q), dq)[..., 1:] / np.sum(q * q, axis=-1, keepdims=True)
        stretch = rotated(conjugate(q), slopes[..., :3])
        excess = np.concatenate([stretch + (FIRST - self.rod.reference[:3]), bend - self.rod.reference[3:]], axis=-1)
        return q, np.concatenate([stretch + FIRST, bend], axis=-1), excess @ self.rod.stiffness

    def residual(self, t: float, y: Values) -> Values:
        """Rates of all points but the free end, and what is left of its conditions."""
        q, turn, stress = self.fields(y)
        n, m = rotated(q, stress[..., :3]), rotated(q, stress[..., 3:])
        pull = self.slope @ n + np.asarray(self.rod.weight)
        couple = self.slope @ m + np.cross(rotated(q, turn[..., :3]), n)
        back = conjugate(q)
        twist = np.concatenate([rotated(back, pull), rotated(back, couple)], axis=-1) @ self.mobility
        rates = np.concatenate([rotated(q, twist[..., :3]), 0.5 * product(q, twist[..., 3:])], axis=-1)[..., 1:, :]
        missing = n[..., -1, :] - np.asarray(self.rod.force(t))
        norm = np.sum(q[..., -1, :] ** 2, axis=-1, keepdims=True) - 1.0
        rates[..., -1, :] = np.concatenate([missing, m[..., -1, :], norm], axis=-1)
        return np.asarray(rates.reshape(y.shape))

    def jacobians(self, t: float, y: Array) -> tuple[Array, Array]:
        """d moved / dy and d residual / dy, by complex steps."""
        steps = y + 1e-30j * np.eye(y.size)
        moved, residual = (values.imag.T / 1e-30 for values in (self.moved(steps), self.residual(t, steps)))
        return np.asarray(moved), np.asarray(residual)

    def shape(self, y: Array) -> Shape:
        """Positions from w and the unstretched rod."""
        q, turn, _ = self.fields(y)
        rotation = Rotation.from_quat(np.roll(q, -1, axis=1)).as_matrix()
        along = self.whole(y)[:, :3] + self.integral @ rotation[:, :, 0]
        return Shape(self.u, np.asarray(self.rod.position) + along, rotation, turn)


def conjugate(q: Values) -> Values:
    """The quaternion of the inverse rotation, unless it has a length."""
    return np.asarray(q * np.array([1.0, -1.0, -1.0, -1.0]))


def product(a: Values, b: Values) -> Values:
    """Quaternion product; b may be a vector (..., 3)."""
    if b.shape[-1] == 3:
        b = np.concatenate([np.zeros_like(b[..., :1]), b], axis=-1)
    s, v, p, w = a[..., :1], a[..., 1:], b[..., :1], b[..., 1:]
    scalar = s * p - np.sum(v * w, axis=-1, keepdims=True)
    return np.concatenate([scalar, s * w + p * v + np.cross(v, w)], axis=-1)


def rotated(q: Values, x: Values) -> Values:
    """The vector x turned by q, whatever the length of q."""
    return np.asarray(product(product(q, x), conjugate(q))[..., 1:] / np.sum(q * q, axis=-1, keepdims=True))


def solve(
    rod: Rod, until: float, degree: int = 16, first: float = 1e-5, growth: float = 1.6, longest: float = 1 / 32
) -> Shape:
    """The rod at the time `until`. Time steps: `first` and `longest` as fractions of `until`.

    Raises ArithmeticError if Newton's method fails: the steps are then too long.
    """
    equations = Collocation(rod, degree)
    steps = instants(until, first * until, growth, longest * until)
    return equations.shape(integrate(equations, equations.begin(), steps, STAGES, 1e-11 * rod.length))
