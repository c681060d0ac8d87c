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

    friction (w + integral of e_1)_t = k w''
    friction3 theta_t = k3 theta'' + k (w_y' cos theta - w_x' sin theta)

In space: collocation at Chebyshev points, the values at the free end eliminated by its boundary conditions. In
time: Radau IIA of 6 stages (order 11), on steps that grow by a constant factor up to a longest one, so that the fast
initial layers are resolved. Source: L. N. Trefethen, *Spectral Methods in MATLAB*, chapter 13.

Dimensions: k force; k3 force x length^2; friction force x time / length^2; friction3 force x time.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tests.references import chebyshev
from tests.references.radau import instants, integrate

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
    """The equations at the inner Chebyshev points; a state is (w_x, w_y, theta) there, shape (3 (degree - 1),)."""

    def __init__(self, rod: Rod, degree: int) -> None:
        self.rod, self.u = rod, chebyshev.points(degree, rod.length)
        slope = chebyshev.derivative(degree, rod.length)
        # from inner values to all: zero at the clamp, no slope at the free end
        self.fill = np.concatenate([np.zeros((1, degree - 1)), np.eye(degree - 1), -slope[-1:, 1:-1] / slope[-1, -1]])
        self.first, self.second = (slope @ self.fill)[1:-1], (slope @ slope @ self.fill)[1:-1]
        self.integral = chebyshev.integral(degree, rod.length, 0)
        self.size = 3 * (degree - 1)

    def start(self) -> Array:
        """Unstretched and unsheared: w = 0."""
        theta = self.rod.angle(self.u)[1:-1]
        return np.concatenate([np.zeros(2 * len(theta)), theta])

    def moved(self, y: Array) -> Array:
        """Coordinates (x, y, theta) at the inner points."""
        unstretched = self._unstretched(y)[..., 1:-1]
        return y + np.concatenate([unstretched, 0.0 * unstretched[..., :1, :]], axis=-2).reshape(y.shape)

    def _unstretched(self, y: Array) -> Array:
        """Integral of e_1 at all points, (..., 2, points)."""
        angle = self._parts(y)[..., 2, :] @ self.fill.T
        return np.stack([np.cos(angle), np.sin(angle)], axis=-2) @ self.integral.T

    @staticmethod
    def _parts(y: Array) -> Array:
        return np.reshape(y, (*y.shape[:-1], 3, -1))

    def residual(self, t: float, y: Array) -> Array:
        """Their rates."""
        rod, (wx, wy, theta) = self.rod, np.moveaxis(self._parts(y), -2, 0)
        drag, first, second = rod.k / rod.friction, self.first.T, self.second.T
        couple = rod.k3 * theta @ second + rod.k * (wy @ first * np.cos(theta) - wx @ first * np.sin(theta))
        return np.concatenate([drag * wx @ second, drag * wy @ second, couple / rod.friction3], axis=-1)

    def jacobians(self, t: float, y: Array) -> tuple[Array, Array]:
        """d moved / dy and d residual / dy."""
        rod, n, (wx, wy, theta) = self.rod, len(self.first), self._parts(y)
        angle, nothing = (self.fill @ theta)[:, None], np.zeros((n, n))
        along = [(self.integral @ (turned * self.fill))[1:-1] for turned in (-np.sin(angle), np.cos(angle))]
        mass = np.eye(3 * n)
        mass[: 2 * n, 2 * n :] += np.concatenate(along)
        c, s = np.cos(theta)[:, None], np.sin(theta)[:, None]
        pull = self.first @ np.stack([wx, wy], axis=1)
        bend = rod.k3 * self.second - rod.k * np.diag(pull[:, 1] * s[:, 0] + pull[:, 0] * c[:, 0])
        drag = rod.k / rod.friction * self.second
        couple = np.concatenate([-rod.k * s * self.first, rod.k * c * self.first, bend], axis=1) / rod.friction3
        return mass, np.block([[drag, nothing, nothing], [nothing, drag, nothing], [couple]])

    def shape(self, y: Array) -> Shape:
        """Positions from w and the unstretched rod."""
        parts = self._parts(y) @ self.fill.T
        return Shape(self.u, (parts[:2] + self._unstretched(y)).T, parts[2])


def solve(
    rod: Rod, until: float, degree: int = 20, first: float = 1e-7, growth: float = 2.0, longest: float = 1 / 16
) -> Shape:
    """The rod at the time `until`. Time steps: `first` and `longest` as fractions of `until`.

    Raises ArithmeticError if Newton's method fails: the steps are then too long.
    """
    equations = Collocation(rod, degree)
    steps = instants(until, first * until, growth, longest * until)
    return equations.shape(integrate(equations, equations.start(), steps, STAGES, 1e-13 * rod.length))
