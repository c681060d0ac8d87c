"""Clamped planar rod that carries a dead force (Fx, Fy) at its free tip, stretch and shear equally stiff.

Rest state h1 = 1, h2 = Pi = 0; clamped at the origin along x. With k1 = k2 = k the stress F = k (h - e1) is
the world force P = (Fx, Fy) seen in the section, F = R^T P, so h = e1 + R^T P / k and r' = R e1 + P / k: the
tip shifts by exactly P L / k beyond that of the inextensible rod. The moment balance M' + h1 F2 - h2 F1 = 0
keeps only M' + F2 = 0, because R^T P / k is parallel to F, hence

    k3 theta'' = Fx sin(theta) - Fy cos(theta),   theta(0) = 0,   theta'(L) = 0,

the elastica, whatever k. It is a pendulum: with P at the angle alpha, psi = theta - alpha +- pi obeys
``psi'' = -w^2 sin(psi)``, w^2 = |P| / k3, and comes to rest at the tip, so with p = sin(psi_L / 2)

    sin(psi / 2) = p cd(w (L - u) | p^2).

Only the principal solution is given, the one without inflection: it grows from the unloaded rod, and is the
stable one. It is the unique p with w L <= K(p^2). Source: A. E. H. Love, *Mathematical Theory of Elasticity*,
articles 260-263; elliptic functions: NIST DLMF 22.13, 22.16.

Dimensions: k force; k3 force x length^2; angles in radians. `k = math.inf` has neither stretch nor shear.
"""

import math
from dataclasses import dataclass

import mpmath
import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Cantilever:
    """Length, equal stretch and shear stiffness k, bending stiffness k3, dead tip force in world components.

    `side` (+1 or -1) chooses the way to buckle when the force is exactly compressive; it has no effect
    otherwise.
    """

    length: float
    k: float
    k3: float
    force: tuple[float, float]
    side: float = 1.0

    @property
    def start(self) -> float:
        """psi at the clamp, in (-pi, pi]."""
        alpha = math.atan2(self.force[1], self.force[0])
        return math.pi - alpha if alpha >= 0.0 else -math.pi - alpha

    @property
    def direction(self) -> float:
        """The sign of the bending: that of psi, or the chosen side of a compressed rod."""
        return math.copysign(1.0, self.start if self.start != 0.0 else self.side)

    @property
    def frequency(self) -> float:
        """w = sqrt(|P| / k3), 1 / length."""
        return math.sqrt(math.hypot(*self.force) / self.k3)

    @property
    def straight(self) -> bool:
        """Pure tension, no load, or compression below the buckling load k3 (pi / 2 L)^2."""
        along = self.force[1] == 0.0
        return along and (self.force[0] >= 0.0 or self.frequency * self.length <= 0.5 * math.pi)


@dataclass(frozen=True)
class Shape:
    """The rod at the points u: position (points, 2), angle (points,), strain (points, 3) = (h1, h2, Pi)."""

    u: Array
    position: Array
    angle: Array
    strain: Array


def _shape(rod: Cantilever, u: Array, position: Array, angle: Array, curvature: Array) -> Shape:
    force = np.array(rod.force)
    cosine, sine = np.cos(angle), np.sin(angle)
    h1 = 1.0 + (cosine * force[0] + sine * force[1]) / rod.k
    h2 = (cosine * force[1] - sine * force[0]) / rod.k
    return Shape(u=u, position=position, angle=angle, strain=np.stack([h1, h2, curvature], axis=1))


def _straight(rod: Cantilever, u: Array) -> Shape:
    zero = np.zeros_like(u)
    position = np.outer(u, np.array([1.0, 0.0]) + np.array(rod.force) / rod.k)
    return _shape(rod, u, position, zero, zero)


def _complement(reach: mpmath.mpf, start: mpmath.mpf) -> mpmath.mpf:
    """1 - p^2, for w L = reach and |sin(psi_0 / 2)| = start; the logarithm of it is what is solved for."""
    floor = -mpmath.log(1 - start**2)
    ceiling = floor + 2 * reach + 10
    accuracy = {"solver": "anderson", "tol": mpmath.mpf(10) ** -25, "maxsteps": 200, "verify": False}
    if mpmath.ellipk(start**2) < reach:
        # too fast a pendulum: raise the amplitude until it can take the whole length to come to rest
        floor = mpmath.findroot(
            lambda z: mpmath.ellipk(1 - mpmath.exp(-z)) - reach, (floor, ceiling), **accuracy
        )
    if start == 0:
        return mpmath.exp(-floor)

    def excess(z: mpmath.mpf) -> mpmath.mpf:
        squared = 1 - mpmath.exp(-z)
        return mpmath.sqrt(squared) * mpmath.ellipfun("cd", reach, m=squared) - start

    return mpmath.exp(-mpmath.findroot(excess, (floor, ceiling), **accuracy))


def elliptic(rod: Cantilever, u: npt.ArrayLike) -> Shape:
    """The shape at u (length), shape (points,), by elliptic functions; exact to double precision."""
    at = np.asarray(u, dtype=float)
    if rod.straight:
        return _straight(rod, at)
    with mpmath.workdps(40 + int(2 * rod.frequency * rod.length)):
        fx, fy = (mpmath.mpf(component) for component in rod.force)
        size = mpmath.hypot(fx, fy)
        w, length = mpmath.sqrt(size / rod.k3), mpmath.mpf(rod.length)
        start = mpmath.mpf(0) if fy == 0 else mpmath.cos(abs(mpmath.atan2(fy, fx)) / 2)  # sin(|psi_0| / 2)
        complement = _complement(w * length, start)
        m = 1 - complement
        p = rod.direction * mpmath.sqrt(m)

        def along(rest: mpmath.mpf) -> mpmath.mpf:
            """Integral of -cos(psi) over the last `rest` of the rod, by Jacobi's epsilon function."""
            x = w * rest
            sn, cn, cd = (mpmath.ellipfun(name, x, m=m) for name in ("sn", "cn", "cd"))
            squares = x - mpmath.ellipe(mpmath.atan2(sn, cn), m) + m * sn * cd
            return 2 * squares / w - rest

        def rate(rest: mpmath.mpf) -> mpmath.mpf:
            """theta' at `rest` from the tip."""
            return 2 * w * p * mpmath.sqrt(complement) * mpmath.ellipfun("sd", w * rest, m=m)

        psi_start = 2 * mpmath.asin(p * mpmath.ellipfun("cd", w * length, m=m))
        rows = []
        for point in at:
            rest = length - mpmath.mpf(float(point))
            angle = 2 * mpmath.asin(p * mpmath.ellipfun("cd", w * rest, m=m)) - psi_start
            x, y = along(length) - along(rest), (rate(rest) - rate(length)) / w**2
            cosine, sine = fx / size, fy / size
            stretch = mpmath.mpf(float(point)) / rod.k
            rows.append(
                (
                    cosine * x - sine * y + fx * stretch,
                    sine * x + cosine * y + fy * stretch,
                    angle,
                    rate(rest),
                )
            )
        values = np.array([[float(component) for component in row] for row in rows])
    return _shape(rod, at, values[:, :2], values[:, 2], values[:, 3])


def shooting(rod: Cantilever, u: npt.ArrayLike) -> Shape:
    """The same by shooting on the moment at the clamp; the balance as it stands, no use of k1 = k2.

    Good to about 1e-12 * exp(w L): meant for w L up to about 4. `u` must increase.
    """
    at = np.asarray(u, dtype=float)
    if rod.straight:
        return _straight(rod, at)
    force = np.array(rod.force)

    def rate(_: float, state: Array) -> list[float]:
        angle, moment = state[:2]
        cosine, sine = math.cos(angle), math.sin(angle)
        f1, f2 = cosine * force[0] + sine * force[1], cosine * force[1] - sine * force[0]
        h1, h2 = 1.0 + f1 / rod.k, f2 / rod.k
        return [moment / rod.k3, h2 * f1 - h1 * f2, cosine * h1 - sine * h2, sine * h1 + cosine * h2]

    def spent(_: float, state: Array) -> float:
        return float(state[1])

    spent.terminal = True  # type: ignore[attr-defined]  # the moment is used up: the tip of a shorter rod
    spent.direction = -rod.direction  # type: ignore[attr-defined]

    def march(moment: float, points: Array | None) -> tuple[float, Array]:
        """Where the integration ended, and the states at `points` (or only there)."""
        result = solve_ivp(
            rate,
            (0.0, rod.length),
            [0.0, rod.direction * moment, 0.0, 0.0],
            method="DOP853",
            t_eval=points,
            events=spent if points is None else None,
            max_step=rod.length / 64,  # keeps the interpolant between steps as good as the steps
            rtol=1e-13,
            atol=1e-15,
        )
        return float(result.t[-1]), np.asarray(result.y)

    def excess(moment: float) -> float:
        end, states = march(moment, None)
        # too small a moment is used up before L, too large a one is left over: both measures vanish together
        return end - rod.length if end < rod.length else abs(float(states[1, -1]))

    largest = 2.0 * rod.k3 * rod.frequency * math.cos(0.5 * rod.start)  # never used up on a rod of any length
    moment = brentq(excess, 1e-9 * largest, largest, xtol=1e-300, rtol=1e-15)
    states = march(moment, at)[1]
    return _shape(rod, at, states[2:].T, states[0], states[1] / rod.k3)
