"""When a straight rod that is spun at its base begins to whirl: linear stability of the twisted state.

The rod of `spun_rod` in its steady state carries the moment M1 = -friction4 spin (L - u). It is moved a little aside by
y + i z = xi, its e_1 tilted by the complex angle theta; a vector across is a complex number, and e_1 x turns it by i.
With equal properties in all directions across the rod, the world's force and moment across it are N and P,

    N = k2 (xi' - theta)        P = i bend theta' + M1 theta
    N' = friction2 xi_t         P' + i N = M1' theta + i friction5 theta_t

for r' x n = i N (there is no force along the rod) and the drags across and about the axis: -M1' e_1 per length is the
drag of the spin, and e_1 tilts. Clamped: xi = theta = 0 at u = 0; free: N = P = 0 at u = L. k2 = inf and friction5 = 0
leave friction2 xi_t = -bend xi'''' + i (M1 xi'')', whose threshold is published as spin = 8.9 bend / (friction4 L^2).
Source: C. W. Wolgemuth, T. R. Powers, R. E. Goldstein, Phys. Rev. Lett. 84 (2000) 1623.

A mode goes as exp(growth t) in the world; in the frame that turns with the base as exp((growth - i spin) t).

Dimensions: k2 force; bend force x length^2; friction2 force x time / length^2; friction4, friction5 force x time.
"""

import cmath
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from tests.references import chebyshev

Complex = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class Rod:
    """The coefficients and the spin (radians / time); `k2` may be `math.inf`, `friction5` zero."""

    length: float
    k2: float
    bend: float
    friction2: float
    friction4: float
    friction5: float
    spin: float

    def moment(self, u: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """M1 (force x length) at u of the steady twist."""
        return np.asarray(-self.friction4 * self.spin * (self.length - np.asarray(u, dtype=float)))


def growths(rod: Rod, number: int, degree: int = 40) -> Complex:
    """The `number` leading growths (1 / time), largest real part first, by collocation of the first-order system.

    The unknown q = growth xi, growth theta gives N and P by integration from the tip, these theta and xi from the base.
    """
    u = chebyshev.points(degree, rod.length)
    slope = chebyshev.derivative(degree, rod.length)
    size, one, zero = degree + 1, np.eye(degree + 1), np.zeros((degree + 1, degree + 1))
    moment, spent = np.diag(rod.moment(u)), rod.friction4 * rod.spin
    # rows: xi' - theta - N / k2 = 0, i bend theta' + M1 theta - P = 0, N' = ..., P' + i N - M1' theta = ...
    left = np.block(
        [
            [slope, -one, -one / rod.k2, zero],
            [zero, 1j * rod.bend * slope + moment, zero, -one],
            [zero, zero, slope, zero],
            [zero, -spent * one, 1j * one, slope],
        ]
    )
    right = np.zeros_like(left)
    right[2 * size : 3 * size, :size] = rod.friction2 * one
    right[3 * size :, size : 2 * size] = 1j * rod.friction5 * one
    for row in (0, size, 3 * size - 1, 4 * size - 1):  # xi, theta at the base, N, P at the tip: they vanish
        left[row], right[row] = np.eye(4 * size)[row], 0.0
    inverse = np.linalg.eigvals(np.linalg.solve(left, right))
    # small ones belong to modes that the points do not resolve, or to rotations without drag
    found = 1.0 / inverse[np.abs(inverse) > 1e-6 * np.abs(inverse).max()]
    return np.asarray(found[np.argsort(-found.real)][:number])


def determinant(rod: Rod, growth: complex) -> complex:
    """What vanishes at a growth: the conditions at the tip for the two solutions from the clamp, by integration."""

    def rate(u: float, flat: Complex) -> Complex:
        xi, theta, force, moment = flat.reshape(4, 2)
        m1, spent = float(rod.moment(u)), rod.friction4 * rod.spin
        return np.concatenate(
            [
                theta + force / rod.k2,
                -1j * (moment - m1 * theta) / rod.bend,
                growth * rod.friction2 * xi,
                -1j * force + (spent + 1j * growth * rod.friction5) * theta,
            ]
        )

    start = np.zeros((4, 2), dtype=complex)
    start[2, 0], start[3, 1] = rod.bend / rod.length**2, rod.bend / rod.length
    found = solve_ivp(rate, (0.0, rod.length), start.ravel(), method="DOP853", rtol=1e-12, atol=1e-14)
    end = found.y[:, -1].reshape(4, 2)
    return complex(end[2, 0] * end[3, 1] - end[2, 1] * end[3, 0])


def refined(rod: Rod, growth: complex) -> complex:
    """The zero of the determinant next to `growth`, by secants."""
    before, now = growth * (1.0 + 1e-4), growth
    values = determinant(rod, before), determinant(rod, now)
    for _ in range(20):
        step = values[1] * (now - before) / (values[1] - values[0])
        before, now = now, now - step
        if cmath.isclose(before, now, rel_tol=1e-12):
            return now
        values = values[1], determinant(rod, now)
    raise ArithmeticError(f"secants from {growth} did not settle; expected a growth close to a mode's")


def threshold(rod: Rod) -> tuple[float, float]:
    """The spin (radians / time) above which the rod whirls, and at which angular velocity it then does.

    The spin of `rod` itself is not used.
    """
    unit = rod.bend / (rod.friction4 * rod.length**2)

    def leading(share: float) -> complex:
        return complex(growths(replace(rod, spin=share * unit), 1)[0])

    high = 1.0
    while leading(high).real < 0.0:
        high += 1.0
        if high > 100.0:
            raise ArithmeticError("expected a threshold below 100 bend / (friction4 L^2), found none")
    share = brentq(lambda x: leading(x).real, high - 1.0, high, xtol=1e-13, rtol=1e-14)
    return share * unit, leading(share).imag
