"""A bent planar cantilever let go in a viscous fluid: its coordinates in time, to about 1e-13.

The rod (x, y, theta)(u, t) is straight at rest, clamped at the origin along x, free at u = L, with stretch and
shear equally stiff (k) and drag equal in both directions (friction). Then the stress is a world force n, and the
balances of force and of moment of a piece of rod, in the world, need neither strains nor a moving frame:

    n = k (r' - e_1),   e_1 = (cos theta, sin theta)
    friction r_t = n'
    friction3 theta_t = k3 theta'' + x' n_y - y' n_x

with r = 0, theta = 0 at u = 0 and n = 0, theta' = 0 at u = L. It starts unstretched and unsheared, with a given
angle. Written for w = r - integral of e_1, what stretch and shear add to the unstretched rod, so that n = k w'
does not come out as a small difference of large numbers:

    friction w_t = k w'' - friction (integral of e_1)_t
    friction3 theta_t = k3 theta'' + k (w_y' cos theta - w_x' sin theta)

In space: collocation at Chebyshev points, the values at the free end eliminated by its boundary conditions. In
time: Radau IIA collocation of 6 stages (order 11), Newton's method with the Jacobian at the start of the step, on
steps that grow by a constant factor up to a longest one, so that the fast initial layers are resolved. Sources:
L. N. Trefethen, *Spectral Methods in MATLAB*, chapter 13; E. Hairer and G. Wanner, *Solving Ordinary Differential
Equations II*, sections IV.5 and IV.8.

Dimensions: k force; k3 force x length^2; friction force x time / length^2; friction3 force x time.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from numpy.polynomial import legendre

from tests.references import chebyshev

Array = npt.NDArray[np.float64]
STAGES = 6


@dataclass(frozen=True)
class Rod:
    """The coefficients, and the angle theta (radians) along the rod at the start, a smooth function of u."""

    length: float
    k: float
    k3: float
    friction: float
    friction3: float
    angle: Callable[[Array], Array]


@dataclass(frozen=True)
class Shape:
    """The rod at the points u (length): position (points, 2), length; angle (points,), unwrapped."""

    u: Array
    position: Array
    angle: Array


class Collocation:
    """The equations at the inner Chebyshev points; a state is (w, theta) there, shape (3 (degree - 1),)."""

    def __init__(self, rod: Rod, degree: int) -> None:
        self.rod, self.u = rod, chebyshev.points(degree, rod.length)
        slope = chebyshev.derivative(degree, rod.length)
        # from inner values to all: zero at the clamp, no slope at the free end
        self.fill = np.concatenate([np.zeros((1, degree - 1)), np.eye(degree - 1), -slope[-1:, 1:-1] / slope[-1, -1]])
        self.first = (slope @ self.fill)[1:-1]
        self.second = (slope @ slope @ self.fill)[1:-1]
        self.integral = chebyshev.integral(degree, rod.length, 0)

    def start(self) -> Array:
        """Unstretched and unsheared: w = 0."""
        theta = self.rod.angle(self.u)[1:-1]
        return np.concatenate([np.zeros(2 * len(theta)), theta])

    def _terms(self, state: Array) -> tuple[Array, Array, Array, Array, Array]:
        """cos and sin of theta, w' (2, inner) and theta_t at the inner points; theta at all points."""
        rod, (wx, wy, theta) = self.rod, state.reshape(3, -1)
        c, s = np.cos(theta), np.sin(theta)
        pull = np.stack([self.first @ wx, self.first @ wy])
        spin = (rod.k3 * self.second @ theta + rod.k * (pull[1] * c - pull[0] * s)) / rod.friction3
        return c, s, pull, spin, self.fill @ theta

    def rate(self, state: Array) -> Array:
        """d state / dt."""
        rod, (wx, wy, _) = self.rod, state.reshape(3, -1)
        _, _, _, spin, angle = self._terms(state)
        turning = self.fill @ spin
        advance = self.integral @ np.stack([-np.sin(angle) * turning, np.cos(angle) * turning], axis=1)
        drag = rod.k / rod.friction
        return np.concatenate(
            [drag * self.second @ wx - advance[1:-1, 0], drag * self.second @ wy - advance[1:-1, 1], spin]
        )

    def jacobian(self, state: Array) -> Array:
        """d rate / d state."""
        rod, n = self.rod, len(self.first)
        c, s, pull, spin, angle = self._terms(state)
        bend = rod.k3 * self.second - np.diag(rod.k * (pull[1] * s + pull[0] * c))
        spins = (
            np.concatenate([-rod.k * s[:, None] * self.first, rod.k * c[:, None] * self.first, bend], axis=1)
            / rod.friction3
        )
        turning, turnings = (self.fill @ spin)[:, None], self.fill @ spins
        angles = np.concatenate([np.zeros((len(angle), 2 * n)), self.fill], axis=1)
        cos, sin = np.cos(angle)[:, None], np.sin(angle)[:, None]
        advance_x = self.integral @ (-sin * turnings - cos * turning * angles)
        advance_y = self.integral @ (cos * turnings - sin * turning * angles)
        result = np.concatenate([-advance_x[1:-1], -advance_y[1:-1], spins])
        drag = rod.k / rod.friction
        result[:n, :n] += drag * self.second
        result[n : 2 * n, n : 2 * n] += drag * self.second
        return result

    def shape(self, state: Array) -> Shape:
        """Positions from w and the unstretched rod."""
        wx, wy, theta = (self.fill @ part for part in state.reshape(3, -1))
        unstretched = self.integral @ np.stack([np.cos(theta), np.sin(theta)], axis=1)
        return Shape(self.u, unstretched + np.stack([wx, wy], axis=1), theta)


def radau(stages: int) -> tuple[Array, Array]:
    """Nodes (stages,) in (0, 1], the last one 1, and the collocation matrix (stages, stages) of Radau IIA."""
    right = legendre.legsub(np.eye(stages + 1)[stages], np.eye(stages + 1)[stages - 1])
    x = np.sort(legendre.legroots(right).real)
    x[-1] = 1.0
    powers = legendre.legvander(x, stages)
    integrals = [x + 1.0] + [(powers[:, k + 1] - powers[:, k - 1]) / (2 * k + 1) for k in range(1, stages)]
    return 0.5 * (x + 1.0), 0.5 * np.stack(integrals, axis=1) @ np.linalg.inv(powers[:, :stages])


def instants(until: float, first: float, growth: float, longest: float) -> Array:
    """Ends of the time steps, from 0: growing, never above `longest`, the last ones equal."""
    ends = [0.0]
    step = first
    while step < longest and ends[-1] + step < until:
        ends.append(ends[-1] + step)
        step *= growth
    rest = until - ends[-1]
    return np.concatenate([ends[:-1], ends[-1] + np.linspace(0.0, rest, max(1, int(np.ceil(rest / longest))) + 1)])


def solve(
    rod: Rod, until: float, degree: int = 20, first: float = 1e-7, growth: float = 2.0, longest: float = 1 / 16
) -> Shape:
    """The rod at the time `until`. Time steps: `first` and `longest` as fractions of `until`.

    Raises ArithmeticError if Newton's method fails: the steps are then too long.
    """
    equations = Collocation(rod, degree)
    state = equations.start()
    _, matrix = radau(STAGES)
    # in the eigenvectors of the collocation matrix the stages have a linear system each
    factors, vectors = np.linalg.eig(matrix)
    inverse_vectors = np.linalg.inv(vectors)
    for step in np.diff(instants(until, first * until, growth, longest * until)):
        systems = np.linalg.inv(np.eye(len(state)) - step * factors[:, None, None] * equations.jacobian(state))
        stages = np.tile(state, (STAGES, 1))
        for _ in range(60):
            residual = stages - state - step * matrix @ np.stack([equations.rate(y) for y in stages])
            change = (vectors @ np.einsum("sij,sj->si", systems, inverse_vectors @ residual)).real
            stages = stages - change
            if np.abs(change).max() < 1e-13:
                break
        else:
            raise ArithmeticError(f"Newton's method left {np.abs(change).max():.1e}; expected shorter time steps")
        state = stages[-1]
    return equations.shape(state)
