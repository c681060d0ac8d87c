"""The clamped-free planar rod beyond its buckling load: shapes of its two branches, and the pitchfork they make.

Clamped at the origin along x, a dead force (-P, 0) at the free end: F = (-P cos(theta), P sin(theta)) everywhere, and
M' + h1 F2 - h2 F1 = 0 with h = e1 + F / k is, c = 1 / k2 - 1 / k1,

    k3 theta'' = -P sin(theta) - c P^2 sin(theta) cos(theta),    theta(0) = 0,   theta'(L) = 0,

which has the integral, with cosine C = cos(alpha) at the tip,

    k3 theta'^2 / 2 = P (cos(theta) - C) (1 + c P (cos(theta) + C) / 2).

Hence L is an elliptic integral of alpha: with sin(theta / 2) = p sin(phi), p = sin(alpha / 2),

    L = sqrt(k3 / P) int_0^(pi/2) dphi / sqrt((1 - p^2 sin^2 phi) (1 + c P (1 - p^2 - p^2 sin^2 phi))),

K(p) sqrt(k3 / P) if k1 = k2. The tip follows from x' = h1 cos - h2 sin = cos - P (cos^2 / k1 + sin^2 / k2) and
y' = -(k3 / P) theta'': y = (k3 / P) theta'(0). The mirror image (alpha < 0) is the other branch; modes with more waves
begin at higher loads and are not given. Near the buckling load P_c, where P eta = k3 (pi / 2 L)^2, eta = 1 + c P,

    alpha^2 ~ (P - P_c) (8 / (3 beta)) d ln(omega) / dP,   beta = (1 + 4 c P) / (6 (1 + c P)),   omega^2 = P eta / k3,
    y ~ 2 L eta alpha / pi,

so the pitchfork stands upright if 1 + 4 c P_c > 0: a rod that shortens easily and does not shear snaps.

Source: A. E. H. Love, *Mathematical Theory of Elasticity*, articles 262-263; A. Magnusson, M. Ristinmaa, C. Ljung, Int.
J. Solids Struct. 38 (2001) 8441 (extensible); the expansion is Lindstedt's for theta'' = -omega^2 (theta - beta
theta^3).

Dimensions: P, k1, k2 force; k3 force x length^2.
"""

import math
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from tests.references.stability import columns
from tests.references.stability.straight import Rod

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Tip:
    """Where the tip is: x, y (length), the angle, and the bend Pi at the clamp (1 / length)."""

    x: float
    y: float
    angle: float
    bend: float


def _compliances(rod: Rod) -> tuple[Any, Any]:
    return mpmath.mpf(1) / rod.k1, mpmath.mpf(1) / rod.k2


def _elliptic(rod: Rod, load: Any, p: Any, weight: Any) -> Any:
    """sqrt(k3 / P) times the integral of weight(cos(theta)) against the u of one branch."""
    slack, shear = _compliances(rod)
    c = shear - slack

    def density(phi: Any) -> Any:
        square = (p * mpmath.sin(phi)) ** 2
        return weight(1 - 2 * square) / mpmath.sqrt((1 - square) * (1 + c * load * (1 - p * p - square)))

    return mpmath.sqrt(mpmath.mpf(rod.bend) / load) * mpmath.quad(density, [0, mpmath.pi / 2])


def tip(rod: Rod, load: float, side: float = 1.0) -> Tip:
    """The buckled rod that bends to one side all along, by elliptic integrals; `side` is the sign of y."""
    if load <= columns.dead_load(rod):
        raise ValueError(f"expected a load beyond {columns.dead_load(rod)}, found {load}")
    with mpmath.workdps(30):
        force, (slack, shear) = mpmath.mpf(load), _compliances(rod)
        c = shear - slack
        p = mpmath.findroot(
            lambda p: _elliptic(rod, force, p, lambda cosine: 1) - rod.length,
            (mpmath.mpf(10) ** -8, 1 - mpmath.mpf(10) ** -8),
            solver="anderson",
            tol=1e-50,
            verify=False,
        )
        x = _elliptic(rod, force, p, lambda t: t - force * (t * t * slack + (1 - t * t) * shear))
        least = 1 - 2 * p * p
        bend = mpmath.sqrt(2 * force / rod.bend * (1 - least) * (1 + c * force * (1 + least) / 2))
        angle = 2 * mpmath.asin(p)
        return Tip(float(x), side * float(rod.bend / force * bend), side * float(angle), side * float(bend))


def _integrated(rod: Rod, load: float, bend: float) -> Array:
    """(x, y, theta, theta') at the tip, from the clamp with the bend there."""
    slack, shear = 1.0 / rod.k1, 1.0 / rod.k2

    def rate(u: float, y: Array) -> list[float]:
        cosine, sine = math.cos(y[2]), math.sin(y[2])
        h1, h2 = 1.0 - load * cosine * slack, load * sine * shear
        turn = -(h1 * load * sine + h2 * load * cosine) / rod.bend
        return [h1 * cosine - h2 * sine, h1 * sine + h2 * cosine, y[3], turn]

    found = solve_ivp(rate, (0.0, rod.length), [0.0, 0.0, 0.0, bend], method="DOP853", rtol=1e-13, atol=1e-14)
    return np.asarray(found.y[:, -1])


def shot(rod: Rod, load: float, estimate: Tip, within: float = 0.01) -> Tip:
    """The same by shooting, with a bend at the clamp `within` so much, relatively, of an estimate's."""
    low, high = (1.0 - within) * estimate.bend, (1.0 + within) * estimate.bend
    bend = brentq(lambda b: _integrated(rod, load, b)[3], low, high, xtol=1e-14, rtol=1e-14)
    x, y, angle, _ = _integrated(rod, load, bend)
    return Tip(float(x), float(y), float(angle), float(bend))


def steepness(rod: Rod) -> float:
    """y^2 / (P - P_c) (length^2 / force) of the pitchfork at the buckling load; not positive if it snaps."""
    critical = columns.dead_load(rod)
    c = 1.0 / rod.k2 - 1.0 / rod.k1
    eta = 1.0 + c * critical
    beta = (1.0 + 4.0 * c * critical) / (6.0 * eta)
    hurry = 0.5 * (1.0 / critical + c / eta)
    return (2.0 * rod.length * eta / math.pi) ** 2 * 8.0 / (3.0 * beta) * hurry
