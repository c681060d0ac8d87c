"""Decay of the clamped-free planar rod about its straight rest state, with finite shear and rotary friction.

The rod of length L rests at h1 = 1, h2 = 0, Pi = 0. Small bending and shear close on themselves,

    friction2 * v2    = F2'               F2 = k2 * h2      d/dt h2 = v2' - Omega
    friction3 * Omega = M' + F2           M  = k3 * Pi      d/dt Pi = Omega'

with v2 = Omega = 0 at u = 0 and F2 = M = 0 at u = L. (The sign of Omega in the first line is that of [E, V] =
E V - V E for E = [[0, 0, 0], [h1, 0, -Pi], [h2, Pi, 0]]; the F2 in the second is the h1 F2 of
M' + h1 F2 - h2 F1 + m = 0.) A mode decays as exp(-rate t). This is the overdamped twin of the Timoshenko
beam; k2 = inf and friction3 = 0 leave rate = beta^4 k3 / (friction2 L^4) with cos(beta) cosh(beta) = -1, the
Euler-Bernoulli rod. Rates are the zeros of the boundary determinant, found in three steps:

1. *count*: the number of rates below a trial rate is the number of focal points of the trial problem on (0,
   L), since shortening the rod raises every rate (Morse index theorem). They are counted exactly, close pairs
   included, by the Lagrangian angles: the eigenvalues of U = (P + iQ)(P - iQ)^-1 that pass -1, where Q, P are
   the blocks of (v2, Omega) and (F2, M) of the solutions that start from the clamp (Arnold, Funct. Anal.
   Appl. 1 (1967) 1);
2. *bisect* on the count until a bracket holds the one wanted rate;
3. *refine* the zero of the determinant inside it in `mpmath`.

Dimensions: k2 force; k3 force x length^2; friction2 force x time / length^2; friction3 force x time.
Rates: 1 / time.
"""

import math
from dataclasses import dataclass

import mpmath
import numpy as np
import numpy.typing as npt
from scipy.linalg import expm

Array = npt.NDArray[np.float64]
DIGITS = 40


@dataclass(frozen=True)
class Rod:
    """The four coefficients and the length; `k2` may be `math.inf` (no shear) and `friction3` zero."""

    length: float
    k2: float
    k3: float
    friction2: float
    friction3: float

    @property
    def shear(self) -> float:
        """k3 / (k2 L^2), no dimension."""
        return self.k3 / (self.k2 * self.length**2)

    @property
    def rotary(self) -> float:
        """friction3 / (friction2 L^2), no dimension."""
        return self.friction3 / (self.friction2 * self.length**2)

    def rate(self, beta: float) -> float:
        """The rate (1 / time) at which beta^4 = rate * friction2 * L^4 / k3."""
        return float(beta**4 * self.k3 / (self.friction2 * self.length**4))


@dataclass(frozen=True)
class Mode:
    """One mode: rate (1 / time) and shapes of strain and velocity at the points u; Pi = 1 at the clamp.

    `strain` is (points, 3) in the order h1, h2, Pi (h1 is the excess over 1: zero); `velocity` is v1, v2,
    Omega. The solution is strain * exp(-rate t), velocity * exp(-rate t) times any small amplitude.
    """

    rate: float
    u: Array
    strain: Array
    velocity: Array


def _system(rod: Rod, beta: float) -> list[list[float]]:
    """dy/dx of y = (v2, Omega, F2, M), x = u / L, scaled by powers of beta to be of one size."""
    square = beta * beta
    return [
        [0, beta, -beta * rod.shear * square, 0],  # v2' = Omega - rate F2 / k2
        [0, 0, 0, -beta],  # Omega' = -rate M / k3
        [beta, 0, 0, 0],  # F2' = friction2 v2
        [0, beta * rod.rotary * square, -beta, 0],  # M' = friction3 Omega - F2
    ]


def count_below(rod: Rod, beta: float) -> int:
    """How many modes have a rate below `rod.rate(beta)`; exact, whatever their spacing."""
    system = np.array(_system(rod, beta), dtype=float)
    steps = 16 + math.ceil(8.0 * float(np.linalg.norm(system, 2)))
    step = expm(system / steps)
    frame = np.vstack([np.zeros((2, 2)), np.eye(2)])  # no velocity at the clamp, any stress
    turned, previous = 0.0, 0.0
    for _ in range(steps):
        frame, upper = np.linalg.qr(step @ frame)
        # keep the orientation of the pair: the argument of det(P + iQ) is tracked
        frame[:, 0] *= math.copysign(1.0, float(np.linalg.det(upper)))
        angle = float(np.angle(np.linalg.det(frame[2:] + 1j * frame[:2])))
        turned += (angle - previous + np.pi) % (2.0 * np.pi) - np.pi
        previous = angle
    plus = frame[2:] + 1j * frame[:2]
    eigenvalues = np.linalg.eigvals(plus @ np.linalg.inv(plus.conj()))
    # the lifted angles of U sum to 2 arg det(P + iQ); each is its principal value plus a whole number of
    # passages of -1
    return abs(round((2.0 * turned - float(np.sum(np.angle(eigenvalues)))) / (2.0 * np.pi)))


def determinant(rod: Rod, beta: mpmath.mpf) -> mpmath.mpf:
    """Determinant of the boundary conditions: the (F2, M) block at L of the solutions from the clamp."""
    end = mpmath.expm(mpmath.matrix(_system(rod, beta)))
    return end[2, 2] * end[3, 3] - end[2, 3] * end[3, 2]


def _root(rod: Rod, index: int) -> mpmath.mpf:
    """beta of mode `index` (0 is the slowest), to about `DIGITS` digits."""
    low, high = 0.0, 2.0
    while count_below(rod, high) <= index:
        low, high = high, 1.5 * high
    while count_below(rod, low) < index or count_below(rod, high) > index + 1:
        middle = 0.5 * (low + high)
        if high - low < 1e-9 * high:
            raise ArithmeticError(
                f"rate {index} cannot be told from its neighbour to 1e-9: expected simple rates; "
                "change k2 or friction3"
            )
        low, high = (middle, high) if count_below(rod, middle) <= index else (low, middle)
    with mpmath.workdps(DIGITS):
        bracket = (mpmath.mpf(low), mpmath.mpf(high))
        accuracy = mpmath.mpf(10) ** -30
        return mpmath.findroot(
            lambda b: determinant(rod, b),
            bracket,
            solver="anderson",
            tol=accuracy,
            maxsteps=100,
            verify=False,
        )


def decay_rates(rod: Rod, number: int) -> Array:
    """The `number` slowest rates (1 / time), increasing, shape (number,), to double precision."""
    return np.array([float(rod.rate(_root(rod, index))) for index in range(number)])


def mode(rod: Rod, index: int, u: npt.ArrayLike) -> Mode:
    """Mode `index` (0 is the slowest) at the points u (length), shape (points,)."""
    at = np.asarray(u, dtype=float)
    with mpmath.workdps(DIGITS):
        beta = _root(rod, index)
        system = mpmath.matrix(_system(rod, beta))
        end = mpmath.expm(system)
        # the null vector of the end conditions, with M = 1 at the clamp
        start = mpmath.matrix([0, 0, -end[2, 3] / end[2, 2], 1])
        values = [mpmath.expm(system * (x / rod.length)) * start for x in at]
        shape = np.array([[float(component) for component in value] for value in values])
    beta, rate = float(beta), rod.rate(float(beta))
    moment = rod.k3 * shape[:, 3]
    force = rod.k3 * beta / rod.length * shape[:, 2]
    zero = np.zeros_like(at)
    strain = np.stack([zero, force / rod.k2, moment / rod.k3], axis=1)
    velocity = np.stack(
        [zero, rate * (rod.length / beta) ** 2 * shape[:, 0], rate * rod.length / beta * shape[:, 1]], axis=1
    )
    return Mode(rate=rate, u=at, strain=strain, velocity=velocity)
