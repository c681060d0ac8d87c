"""A twisted ring that leaves its plane: Michell's instability, with stretch, shear and curvature at rest.

A rod of length L with equal bending stiffnesses, straight at rest or an arc (0, 0, Pi3), is bent to a circle, its far
end turned by `twist` about the axis before it is joined. If it is straight at rest, a rest with Pi1 = -twist / L is the
same: with equal bending stiffnesses only the stress counts, M1 = k4 (Pi1 + twist / L). It is that rest that is meant
here, and with an arc it is a helix. Then E and Sigma are constant along the ring:

    Pi = q (-sin a, 0, cos a),  h = l (cos a, 0, sin a),  F = f (-sin a, 0, cos a),  q = 2 pi / L

sections being tilted by a about e_2, for M' + Pi x M + h x F = 0 demands a force f along the ring's axis, f = q M1
without tilt, and shear yields to it. F = k (h - e_1) gives f = k3 l tan a, l = k1 / (k1 cos a + k3 sin a tan a), and
the moment about e_2 then gives a.

Moved by eta (in the section's axes), with strains eta' + ad_E eta and stresses sigma = K times these,

    eta' = K^-1 sigma - ad_E eta,    sigma' = growth Gamma eta - ad*_E sigma - ad*_(K^-1 sigma) Sigma,

where all coefficients are constant: modes go as exp(i n q u), n whole, and a growth is a zero of a 12 x 12 determinant.
Six growths are zero, those of rigid motions (n = 0 twice, n = 1, -1); one more is if the rod is straight at rest: the
sections then turn freely about the rod's own line. Without stretch and shear, straight at rest, n waves are neutral at

    twist = 2 pi sqrt(n^2 - 1) bend / k4:    2 pi sqrt(3) bend / k4 for n = 2, the first.

*Held at one section* (both ends clamped at one place): each state of the joined ring can be moved rigidly until that
section is where it is held, without change of energy; so both lose stability at the same twist. Their growths differ,
for what is held does not drift. It, too, has a growth that is zero if the rod is straight at rest: it swings about the
tangent where it is held.

Source: J. H. Michell, Messenger of Math. 19 (1889) 181; A. Goriely, J. Elasticity 84 (2006) 281 (history, curvature at
rest); the equations are those of the rod linearised.

Dimensions: stiffness force (3), force x length^2 (3); friction force x time / length^2 (3), force x time (3).
"""

import math
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np
import numpy.typing as npt
from scipy.linalg import eig
from scipy.optimize import brentq

from tests.references.stability.linear import Matrix, Problem

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Ring:
    """`stiffness`, `friction` (6,); the first three stiffnesses may be `math.inf`. `arc`: Pi3 at rest (1 / length)."""

    length: float
    stiffness: tuple[float, ...]
    friction: tuple[float, ...]
    arc: float = 0.0

    @property
    def compliance(self) -> Array:
        """1 / K."""
        return 1.0 / np.array(self.stiffness)


def hat(a: Any) -> Any:
    """The matrix of a x."""
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]], dtype=object)


def blocks(turn: Any, stress: Any) -> tuple[Matrix, Matrix, Matrix]:
    """ad_E, ad*_E and the matrix of e -> ad*_e Sigma, each (6, 6)."""
    h, bend, force, moment = hat(turn[:3]), hat(turn[3:]), hat(stress[:3]), hat(stress[3:])
    zero = np.zeros((3, 3), dtype=object)
    return (
        np.block([[bend, h], [zero, bend]]),
        np.block([[bend, zero], [h, bend]]),
        np.block([[zero, -force], [-force, -moment]]),
    )


def state(ring: Ring, twist: float) -> tuple[Array, Array]:
    """E and Sigma (6,) of the twisted ring; E is counted from a rest that is twisted by -twist / L."""
    q = 2.0 * math.pi / ring.length
    c = ring.compliance

    def found(tilt: float) -> tuple[Array, Array]:
        sine, cosine = math.sin(tilt), math.cos(tilt)
        size = 1.0 / (cosine + c[0] / c[2] * sine * sine / cosine) if c[2] > 0.0 else 1.0
        turn = np.array([size * cosine, 0.0, size * sine, -q * sine, 0.0, q * cosine])
        moment1 = ring.stiffness[3] * (turn[3] + twist / ring.length)
        moment3 = ring.stiffness[5] * (turn[5] - ring.arc)
        force = size * math.tan(tilt) / c[2] if c[2] > 0.0 else q * moment1
        return turn, np.array([-force * sine, 0.0, force * cosine, moment1, 0.0, moment3])

    def miss(tilt: float) -> float:
        turn, stress = found(tilt)
        return float(turn[2] * stress[0] - turn[0] * stress[2] + turn[5] * stress[3] - turn[3] * stress[5])

    return found(brentq(miss, -1.0, 1.0, xtol=1e-16, rtol=1e-15) if c[2] > 0.0 else 0.0)


def _constant(ring: Ring, twist: float) -> tuple[Matrix, Matrix]:
    """The 12 x 12 matrices of Y' = (constant + growth growing) Y, Y = (eta, sigma)."""
    ad, coad, turned = blocks(*state(ring, twist))
    compliance = np.diag(ring.compliance)
    zero = np.zeros((6, 6), dtype=object)
    constant = np.block([[-ad, compliance], [zero, -coad - turned @ compliance]])
    return constant, np.block([[zero, zero], [np.diag(ring.friction), zero]])


def determinant(ring: Ring, twist: float, n: int, growth: Any) -> Any:
    """What vanishes at a growth with n waves."""
    constant, growing = _constant(ring, twist)
    wave = mpmath.mpc(0, 2 * n) * mpmath.pi / ring.length
    return mpmath.det(mpmath.matrix((constant + growing * growth - wave * np.eye(12)).tolist()))


def growths(ring: Ring, twist: float, n: int) -> npt.NDArray[np.complex128]:
    """All with n waves, largest real part first, to about 1e-9 of the largest."""
    constant, growing = (np.array(a, dtype=complex) for a in _constant(ring, twist))
    wave = 2j * math.pi * n / ring.length
    found = eig(wave * np.eye(12) - constant, growing, right=False, homogeneous_eigvals=True)
    finite = np.abs(found[1]) > 1e-10 * np.abs(found).max()
    values = found[0][finite] / found[1][finite]
    return np.asarray(values[np.argsort(-values.real)])


def refined(ring: Ring, twist: float, n: int, growth: complex) -> complex:
    """The growth with n waves next to an estimate."""
    with mpmath.workdps(30):
        guess = mpmath.mpc(growth)
        scale = abs(determinant(ring, twist, n, guess * 1.01))
        pair = (guess, guess * (1 + mpmath.mpf(10) ** -6))
        return complex(mpmath.findroot(lambda x: determinant(ring, twist, n, x) / scale, pair, tol=1e-30))


def critical(ring: Ring, n: int, estimate: float) -> float:
    """The twist (radians) next to an estimate at which n waves are neutral."""

    def value(twist: float) -> float:
        with mpmath.workdps(30):
            return float(mpmath.re(determinant(ring, twist, n, 0)))

    scale = abs(value(1.02 * estimate))
    return float(brentq(lambda x: value(x) / scale, 0.98 * estimate, 1.02 * estimate, xtol=1e-13, rtol=1e-14))


def classical(n: int, bend: float, twist_stiffness: float) -> float:
    """2 pi sqrt(n^2 - 1) bend / k4."""
    return 2.0 * math.pi * math.sqrt(n * n - 1.0) * bend / twist_stiffness


def held(ring: Ring, twist: float) -> Problem:
    """The ring whose ends are both clamped at one place."""
    constant, growing = _constant(ring, twist)
    rows = np.zeros((6, 12), dtype=object)
    rows[:, :6] = np.eye(6)
    return Problem(ring.length, (constant,), growing, tuple(range(6, 12)), rows)
