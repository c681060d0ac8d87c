"""A closed planar ring at rest as a circle: rates at which its modes decay.

The reference is E0 = (1, 0, q), q = 2 pi / L, the ends joined. About rest phi' = phi E and phi_t = phi V give

    h1_t = v1' - q v2                 friction1 v1    = F1' - q F2
    h2_t = v2' + q v1 - Omega         friction2 v2    = F2' + q F1
    Pi_t = Omega'                     friction3 Omega = M' + F2

with (F1, F2, M) = K times the small excess strain e. The coefficients are constant, so a mode is the real part of
exp(i n q u) times a vector: with A = i n q + ad_E0 the first column is e_t = A V, the second Gamma V = -A^H K e, and

    e_t = -A Gamma^-1 A^H K e,

3 x 3. The rates are real and not negative, as of a product of two such Hermitian matrices. A is singular for n = 1 (a
shift) and n = 0 (a turn); the strain of the eigenvalue zero there would open the ring, so those n have two rates. For
n = 0: k1 q^2 / friction2, a change of size, and k2 (1 / friction3 + q^2 / friction1), sections tilting.

The inextensible, unshearable ring has one rate for each n >= 2: displaced by cos(n q u) outwards, it moves by
sin(n q u) / n along, its curvature changes by q^2 (n^2 - 1), its sections turn by q (n - 1 / n):

    rate = k3 q^4 (n^2 - 1)^2 / (friction2 + friction1 / n^2 + friction3 q^2 (n - 1 / n)^2).

Source: Fourier series; R. Hoppe, J. reine angew. Math. 73 (1871) 158 for the ring with inertia.

Dimensions: k1, k2 force; k3 force x length^2; friction1, friction2 force x time / length^2; friction3 force x time.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import eigh

Array = npt.NDArray[np.float64]
Complex = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class Ring:
    """The length round the ring, stiffness (k1, k2, k3) and friction (3,)."""

    length: float
    stiffness: tuple[float, float, float]
    friction: tuple[float, float, float]

    @property
    def curvature(self) -> float:
        """2 pi / L."""
        return 2.0 * np.pi / self.length


@dataclass(frozen=True)
class Mode:
    """Strain Re(strain exp(i n q u - rate t)), twist likewise; both complex (3,), for a unit of K-weighted strain."""

    rate: float
    strain: Complex
    twist: Complex


def modes(ring: Ring, n: int) -> list[Mode]:
    """The modes with n waves round the ring, slowest first: two for n = 0 and 1, three above."""
    q = ring.curvature
    wave = 1j * n * q
    # [E0, V] in components, with the slope
    operator = np.array([[wave, -q, 0.0], [q, wave, -1.0], [0.0, 0.0, wave]])
    stiffness, friction = np.diag(ring.stiffness), np.array(ring.friction)
    # in the stress K e = s: K^-1 s_t = -A Gamma^-1 A^H s, Hermitian against Hermitian
    drag = operator / friction @ operator.conj().T
    rates, stresses = eigh(drag, np.linalg.inv(stiffness))
    first = 1 if n < 2 else 0
    result = []
    for rate, stress in list(zip(rates, stresses.T, strict=True))[first:]:
        twist = -(operator.conj().T @ stress) / friction
        result.append(Mode(float(rate), np.linalg.solve(stiffness, stress), twist))
    return result


def decay_rates(ring: Ring, n: int) -> Array:
    """Their rates (1 / time), increasing: (2,) for n = 0 and 1, (3,) above. Those with n > 0 are double (cos, sin)."""
    return np.array([mode.rate for mode in modes(ring, n)])


def inextensible_rate(ring: Ring, n: int) -> float:
    """The rate (1 / time) with n >= 2 waves in the limit of large k1 and k2."""
    q, (friction1, friction2, friction3) = ring.curvature, ring.friction
    drag = friction2 + friction1 / n**2 + friction3 * q**2 * (n - 1.0 / n) ** 2
    return float(ring.stiffness[2] * q**4 * (n**2 - 1) ** 2 / drag)
