"""A planar rod that neither stretches nor shears, let go in a viscous fluid: large motions, to about 1e-12.

Clamped at the origin at the angle theta(0), free at u = L. The line is r = integral of e_1, e_1 = (cos theta, sin
theta), and the world's force n in the rod is the multiplier that keeps it so:

    D(theta) r_t = n' + weight,   D = friction1 e_1 e_1^T + friction2 e_2 e_2^T,   r_t = integral of e_2 theta_t
    friction3 theta_t = k3 theta'' + e_2 . n

with r_t = 0 at u = 0, n = force(t) and theta' = 0 at u = L. At Chebyshev points these are linear equations for theta_t
and n together (eliminating theta_t from them leaves the elliptic equation of the tension); theta alone is integrated.
friction3 = 0 changes nothing. Two further unknowns integrate the power of the drag and that of the tip force, so that

    k3 / 2 integral theta'^2 - integral weight . r + dissipated - work of the force = constant

measures the result. In time: Radau IIA of 5 stages (order 9) on growing steps. Source: R. E. Goldstein and S. A.
Langer, Phys. Rev. Lett. 75 (1995) 1094 (the equations, for friction3 = 0); L. N. Trefethen, *Spectral Methods in
MATLAB*.

Dimensions: k3 force x length^2; friction1, friction2 force x time / length^2; friction3 force x time; weight
force / length.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from tests.references import chebyshev
from tests.references.radau import instants, integrate

Array = npt.NDArray[np.float64]
Values = npt.NDArray[Any]  # real, or complex for derivatives
STAGES = 5


def unloaded(t: float) -> tuple[float, float]:
    """No force on the tip."""
    return (0.0, 0.0)


@dataclass(frozen=True)
class Rod:
    """The coefficients, the angle theta (radians) at the start, a smooth function of u, and the loads.

    force(t): dead, on the tip, world components. weight: force per length, world components. friction3 may be zero.
    """

    length: float
    k3: float
    friction1: float
    friction2: float
    friction3: float
    angle: Callable[[Array], Array]
    force: Callable[[float], tuple[float, float]] = unloaded
    weight: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True)
class Shape:
    """The rod at the points u: position (points, 2), angle (points,); energy, dissipated, work of force and weight."""

    u: Array
    position: Array
    angle: Array
    energy: float
    dissipated: float
    work: float


class Collocation:
    """A state is theta at the inner points and the integrals of the two powers; see `radau.System`."""

    def __init__(self, rod: Rod, degree: int) -> None:
        self.rod, self.degree = rod, degree
        self.u, self.slope = chebyshev.points(degree, rod.length), chebyshev.derivative(degree, rod.length)
        self.integral = chebyshev.integral(degree, rod.length, 0)
        start = rod.angle(self.u)
        # theta at all points from those inside: the clamp keeps its angle, the tip is not curved
        self.fill = np.concatenate([np.zeros((1, degree - 1)), np.eye(degree - 1), -self.slope[-1:, 1:-1]])
        self.fill[-1] /= self.slope[-1, -1]
        self.offset = np.zeros(degree + 1)
        self.offset[0], self.offset[-1] = start[0], -self.slope[-1, 0] / self.slope[-1, -1] * start[0]
        self.begin = np.append(start[1:-1], [0.0, 0.0])

    def angle(self, y: Values) -> Values:
        """theta at all points, (..., points)."""
        return np.asarray(y[..., :-2] @ self.fill.T + self.offset)

    def position(self, y: Values) -> Values:
        """r at all points, (..., 2, points)."""
        theta = self.angle(y)
        return np.stack([np.cos(theta), np.sin(theta)], axis=-2) @ self.integral.T

    def motion(self, t: float, y: Values) -> tuple[Values, Values]:
        """theta_t (..., points) and the world's force n (..., 2, points)."""
        rod, n, theta = self.rod, self.degree, self.angle(y)
        c, s = np.cos(theta), np.sin(theta)
        tip = np.asarray(rod.force(t), dtype=float)
        xx, yy = rod.friction1 * c**2 + rod.friction2 * s**2, rod.friction1 * s**2 + rod.friction2 * c**2
        xy = (rod.friction1 - rod.friction2) * c * s
        # velocities of the line by theta_t inside
        sideways = [(self.integral * turned[..., None, :]) @ self.fill for turned in (-s, c)]
        drag = [xx[..., None] * sideways[0] + xy[..., None] * sideways[1]]
        drag.append(xy[..., None] * sideways[0] + yy[..., None] * sideways[1])
        size = 3 * n - 1  # theta_t inside, n_x and n_y at all points but the tip
        matrix = np.zeros((*theta.shape[:-1], size, size), dtype=theta.dtype)
        right = np.zeros((*theta.shape[:-1], size), dtype=theta.dtype)
        inner, blocks = slice(0, n - 1), (slice(n - 1, 2 * n - 1), slice(2 * n - 1, 3 * n - 1))
        for k, rows in enumerate(blocks):
            matrix[..., rows, inner] = drag[k][..., :-1, :]
            matrix[..., rows, rows] = -self.slope[:-1, :-1]
            right[..., rows] = self.slope[:-1, -1] * tip[k] + rod.weight[k]
        matrix[..., inner, inner] = rod.friction3 * np.eye(n - 1)
        places = np.arange(1, n)
        for factor, rows in zip((s, -c), blocks, strict=True):
            matrix[..., places - 1, rows.start + places] = factor[..., 1:-1]
        right[..., inner] = rod.k3 * (theta @ (self.slope @ self.slope).T)[..., 1:-1]
        solution = np.linalg.solve(matrix, right[..., None])[..., 0]
        force = solution[..., n - 1 :].reshape(*theta.shape[:-1], 2, n)
        end = np.broadcast_to(tip[:, None], (*force.shape[:-1], 1))
        return solution[..., inner] @ self.fill.T, np.concatenate([force, end], axis=-1)

    def velocity(self, y: Values, spin: Values) -> Values:
        """r_t at all points, (..., 2, points), from theta_t (..., points)."""
        theta = self.angle(y)
        return np.stack([-np.sin(theta) * spin, np.cos(theta) * spin], axis=-2) @ self.integral.T

    def moved(self, y: Values) -> Values:
        """The state itself."""
        return y

    def residual(self, t: float, y: Values) -> Values:
        """Its rate: theta_t, the power of the drag, the power of the tip force."""
        rod, theta = self.rod, self.angle(y)
        spin, _ = self.motion(t, y)
        velocity = self.velocity(y, spin)
        along = np.cos(theta) * velocity[..., 0, :] + np.sin(theta) * velocity[..., 1, :]
        across = np.cos(theta) * velocity[..., 1, :] - np.sin(theta) * velocity[..., 0, :]
        power = rod.friction1 * along**2 + rod.friction2 * across**2 + rod.friction3 * spin**2
        given = velocity[..., -1] @ np.asarray(rod.force(t), dtype=float)
        return np.concatenate([spin[..., 1:-1], np.stack([power @ self.integral[-1], given], axis=-1)], axis=-1)

    def jacobians(self, t: float, y: Array) -> tuple[Array, Array]:
        """d moved / dy and d residual / dy, by complex steps."""
        steps = y + 1e-30j * np.eye(y.size)
        return np.eye(y.size), np.asarray(self.residual(t, steps).imag.T / 1e-30)

    def shape(self, y: Array) -> Shape:
        """What is asked for."""
        place, theta = self.position(y), self.angle(y)
        energy = 0.5 * self.rod.k3 * float(self.integral[-1] @ (self.slope @ theta) ** 2)
        fallen = self.integral[-1] @ (np.asarray(self.rod.weight) @ (place - self.position(self.begin)))
        return Shape(self.u, place.T, theta, energy, float(y[-2]), float(y[-1] + fallen))


def solve(
    rod: Rod, until: float, degree: int = 24, first: float = 1e-7, growth: float = 1.8, longest: float = 1 / 20
) -> Shape:
    """The rod at the time `until`. Time steps: `first` and `longest` as fractions of `until`.

    Raises ArithmeticError if Newton's method fails: the steps are then too long.
    """
    equations = Collocation(rod, degree)
    steps = instants(until, first * until, growth, longest * until)
    return equations.shape(integrate(equations, equations.begin, steps, STAGES, 1e-11))
