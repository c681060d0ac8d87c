"""The planar rod near its straight rest state: decay rates and harmonic response, for any ends.

With r = (u, y), theta and the reference curvature Pi0 all small, phi' = phi E and phi_t = phi V give h2 = y' - theta,
Pi = theta', v2 = y_t, Omega = theta_t, and the balances of force and moment keep

    y'     = theta + F2 / k2                                    F2 = k2 h2
    theta' = M / k3 + Pi0                                       M  = k3 (Pi - Pi0)
    F2'    = friction2 y_t + trap y - force
    M'     = -F2 + friction3 theta_t + field theta - couple

(F2 in the last line is h1 F2 of M' + h1 F2 - h2 F1; F1 = 0.) `trap` is a force density -trap times the displacement
from the line of the rest shape. A rod magnetised along e_1 with moment mu per length in a field (B, b), B steady and
b small, has the torque density mu (b cos(theta) - B sin(theta)): field = mu B, and mu b is part of the couple.
k2 = inf and friction3 = 0 are allowed: Euler and Bernoulli.

* *Decay rates*, y = exp(-rate t): zeros of the determinant of the end conditions, refined by `mpmath` from estimates
  by the Ritz method (energy against drag, Legendre polynomials): both forms are symmetric, so the rates are real, and
  the Ritz rates number them from the slowest.
* *Response*, y = Re(amplitude exp(i frequency t)): Chebyshev collocation of the four equations.

Dimensions: k2 force; k3 force x length^2; friction2 force x time / length^2; friction3 force x time; trap
force / length^2; field force; rates and frequencies 1 / time.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import mpmath
import numpy as np
import numpy.typing as npt
from numpy.polynomial import legendre
from scipy.linalg import eigh, null_space

from tests.references import chebyshev

Array = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]
Profile = complex | Callable[[Array], npt.ArrayLike]
Kind = Literal["clamped", "pinned", "free"]
DIGITS = 30
RITZ = 40  # degree of the polynomials of the estimates: good to 1e-6 for the first dozen rates
HELD: dict[Kind, tuple[int, int]] = {"clamped": (0, 1), "pinned": (0, 3), "free": (2, 3)}  # y, theta, F2, M


@dataclass(frozen=True)
class Rod:
    """The coefficients; `k2` may be `math.inf`, `friction3` zero."""

    length: float
    k2: float
    k3: float
    friction2: float
    friction3: float
    trap: float = 0.0
    field: float = 0.0


@dataclass(frozen=True)
class End:
    """An end and the complex amplitudes of what is done to it; those of a held component count, the others do not.

    displacement (length) and angle move a clamped end, displacement a pinned one; force and torque load a free end,
    torque a pinned one. They act *on* the rod, so F2 = force at the right and -force at the left.
    """

    kind: Kind
    displacement: complex = 0.0
    angle: complex = 0.0
    force: complex = 0.0
    torque: complex = 0.0


@dataclass(frozen=True)
class Response:
    """Complex amplitudes at the points u: displacement y, angle theta, stresses F2 and M, each (points,)."""

    u: Array
    displacement: Complex
    angle: Complex
    force: Complex
    moment: Complex


def driven(v2: complex, omega: complex, frequency: float) -> End:
    """A clamp whose twist has the harmonic amplitudes v2 (length / time) and omega (1 / time)."""
    return End("clamped", displacement=v2 / (1j * frequency), angle=omega / (1j * frequency))


def matrix(rod: Rod, growth: Any) -> list[list[Any]]:
    """d(y, theta, F2, M) / du for fields that go as exp(growth t): growth = i frequency, or -rate."""
    return [
        [0, 1, 1 / rod.k2, 0],
        [0, 0, 0, 1 / rod.k3],
        [growth * rod.friction2 + rod.trap, 0, 0, 0],
        [0, growth * rod.friction3 + rod.field, -1, 0],
    ]


def rigid_modes(rod: Rod, left: Kind, right: Kind) -> int:
    """How many rates are zero: rigid motions that nothing holds (translation, rotation about a pin or any point)."""
    if rod.trap:
        return 0
    places = sum(kind != "free" for kind in (left, right))
    turns = sum(kind == "clamped" for kind in (left, right))
    return int(places == 0) + int(places < 2 and turns == 0 and rod.field == 0.0)


def decay_rates(rod: Rod, left: Kind, right: Kind, number: int) -> Array:
    """The `number` slowest rates (1 / time), increasing, shape (number,), to about 15 digits. trap, field >= 0.

    Raises ArithmeticError if two rates are too close to be told apart.
    """
    estimates = _ritz(rod, left, right)[:number]
    rates = [0.0] * min(number, rigid_modes(rod, left, right))
    for guess in estimates[len(rates) :]:
        with mpmath.workdps(DIGITS + int(rod.length * np.abs(np.linalg.eigvals(matrix(rod, -guess)).real).max())):
            start = (mpmath.mpf(guess) * (1 - mpmath.mpf(10) ** -7), mpmath.mpf(guess))
            rate = float(mpmath.findroot(lambda x: determinant(rod, left, right, x), start, tol=1e-18, verify=False))
        if abs(rate - guess) > 1e-4 * guess or (rates and abs(rate - rates[-1]) < 1e-12 * guess):
            raise ArithmeticError(f"the rate near {guess} was not found: expected simple rates; change a coefficient")
        rates.append(rate)
    return np.array(rates)


def determinant(rod: Rod, left: Kind, right: Kind, rate: Any) -> Any:
    """Determinant of the conditions at the right for the two solutions that obey those at the left (mpmath)."""
    end = mpmath.expm(mpmath.matrix(matrix(rod, -rate)) * mpmath.mpf(rod.length))
    first, second = (k for k in range(4) if k not in HELD[left])
    a, b = HELD[right]
    return end[a, first] * end[b, second] - end[a, second] * end[b, first]


def _ritz(rod: Rod, left: Kind, right: Kind) -> Array:
    """Estimated rates, increasing; near zero for rigid modes."""
    x, weight = legendre.leggauss(RITZ + 2)
    weight = 0.5 * rod.length * weight
    size = RITZ + 1

    def values(at: Array, order: int) -> Array:
        """Legendre polynomials on the rod, differentiated `order` times in u."""
        coefficients = legendre.legder(np.eye(size), order, scl=2.0 / rod.length)
        return np.asarray(legendre.legval(at, coefficients).T)

    ends, zero = np.array([-1.0, 1.0]), np.zeros((RITZ + 2, size))
    if math.isinf(rod.k2):
        y, theta, bend = (values(x, order) for order in range(3))
        shear = zero
        held_y, held_theta = values(ends, 0), values(ends, 1)
    else:
        y, theta = np.hstack([values(x, 0), zero]), np.hstack([zero, values(x, 0)])
        bend = np.hstack([zero, values(x, 1)])
        shear = math.sqrt(rod.k2) * (np.hstack([values(x, 1), zero]) - theta)
        edge = np.zeros((2, size))
        held_y, held_theta = np.hstack([values(ends, 0), edge]), np.hstack([edge, values(ends, 0)])
    rows = [held_y[k] for k, kind in enumerate((left, right)) if kind != "free"]
    rows += [held_theta[k] for k, kind in enumerate((left, right)) if kind == "clamped"]
    free = null_space(np.array(rows)) if rows else np.eye(y.shape[1])

    def form(field: Array) -> Array:
        return np.asarray((field @ free).T @ (weight[:, None] * (field @ free)))

    stored = form(shear) + rod.k3 * form(bend) + rod.trap * form(y) + rod.field * form(theta)
    drag = rod.friction2 * form(y) + rod.friction3 * form(theta)
    shift = rod.k3 / (rod.friction2 * rod.length**4)
    # inverted, so that the slow rates are the accurate ones and a rotation without drag does no harm
    inverse = eigh(drag, stored + shift * drag, eigvals_only=True)[::-1]
    return np.asarray(1.0 / inverse[inverse > 1e-12 * inverse[0]] - shift)


def response(
    rod: Rod,
    frequency: complex,
    left: End,
    right: End,
    u: npt.ArrayLike,
    force: Profile = 0.0,
    couple: Profile = 0.0,
    curvature: Profile = 0.0,
    degree: int = 48,
) -> Response:
    """Amplitudes at u (length), shape (points,), at `frequency` (radians / time); exp(i frequency t) may also decay.

    force (force / length), couple (force) and the reference curvature (1 / length) are complex amplitudes: numbers,
    or functions of an array u.
    """
    points, slope = chebyshev.points(degree, rod.length), chebyshev.derivative(degree, rod.length)
    size, one = degree + 1, np.eye(degree + 1)
    # scaled so that a length, a force and an angle are all of size 1
    scale = np.array([rod.length, 1.0, rod.k3 / rod.length**2, rod.k3 / rod.length])
    coefficients = np.array(matrix(rod, 1j * frequency), dtype=complex) * scale[None, :] / scale[:, None]
    operator = np.kron(np.eye(4), slope) - np.kron(coefficients, one)
    known = np.zeros((4, size), dtype=complex)
    for row, (profile, sign) in {1: (curvature, 1.0), 2: (force, -1.0), 3: (couple, -1.0)}.items():
        known[row] = sign * np.asarray(profile(points) if callable(profile) else profile) / scale[row]
    system, right_side = operator.astype(complex), known.ravel()
    given = {
        0: (left, np.array([left.displacement, left.angle, -left.force, -left.torque])),
        degree: (right, np.array([right.displacement, right.angle, right.force, right.torque])),
    }
    # each end gives two conditions. Left: in place of the equations there for the components held; right: the others
    for place, (end, values) in given.items():
        for component, row in zip(HELD[end.kind], _rows(left.kind, place), strict=True):
            equation = row * size + place
            system[equation] = 0.0
            system[equation, component * size + place] = 1.0
            right_side[equation] = values[component] / scale[component]
    solution = np.linalg.solve(system, right_side).reshape(4, size) * scale[:, None]
    at = np.atleast_1d(np.asarray(u, dtype=float))
    fitted = legendre.legvander(2.0 * points / rod.length - 1.0, degree)
    wanted = legendre.legvander(2.0 * at / rod.length - 1.0, degree)
    values = wanted @ np.linalg.solve(fitted, solution.T)
    return Response(at, *values.T)


def _rows(left: Kind, place: int) -> tuple[int, ...]:
    """Which two equations the end conditions replace: at the left those of what is held there, at the right others."""
    return HELD[left] if place == 0 else tuple(k for k in range(4) if k not in HELD[left])
