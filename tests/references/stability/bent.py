"""Growths of a rod near any bent state that a dead force at its free end holds, clamped at the other.

A state is E(u), Sigma(u) with E = E0 + K^-1 Sigma and Sigma' = -ad*_E Sigma, from the stress at the clamp. Moved by eta
(in the section's axes), with strain eta' + ad_E eta and sigma = K times it,

    eta' = K^-1 sigma - ad_E eta,    sigma' = growth Gamma eta - ad*_E sigma - ad*_(K^-1 sigma) Sigma,

eta = 0 at the clamp. At the tip the force is R^T P, which turns against the section, and there is no moment:

    sigma = (F x eta_rotation, 0)    at u = L.

The rod keeps an energy, so that the growths are real. They are zeros of a determinant, for which state and motion are
integrated together (DOP853); estimates, and a second method, by Chebyshev collocation. A planar rod is the spatial one
with the parts (h1, h2, Pi3) only.

Source: the balance laws linearised; S. S. Antman, *Nonlinear Problems of Elasticity*, chapter 8.

Dimensions: stiffness force (3), force x length^2 (3); friction force x time / length^2 (3), force x time (3).
"""

import itertools
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from tests.references import chebyshev
from tests.references.stability.michell import blocks

Array = npt.NDArray[np.float64]
PLANE = (0, 1, 5)
SPACE = (0, 1, 2, 3, 4, 5)


@dataclass(frozen=True)
class State:
    """A bent rod: stiffness, friction and rest (6,), the stress (6,) at the clamp; `parts` that can move."""

    length: float
    stiffness: npt.ArrayLike
    friction: npt.ArrayLike
    rest: npt.ArrayLike
    base_stress: npt.ArrayLike
    parts: tuple[int, ...] = SPACE

    @property
    def compliance(self) -> Array:
        """1 / K."""
        return 1.0 / np.asarray(self.stiffness, dtype=float)

    def turn(self, stress: Array) -> Array:
        """E (6,)."""
        return np.asarray(self.rest, dtype=float) + self.compliance * stress

    def stress(self, u: Array) -> Array:
        """Sigma (points, 6) at increasing u, the first of them 0; integrated to each."""
        found = [np.asarray(self.base_stress, dtype=float)]
        for before, after in itertools.pairwise(u):
            step = solve_ivp(
                lambda x, s: _balance(self, s), (before, after), found[-1], method="DOP853", rtol=1e-13, atol=1e-13
            )
            found.append(step.y[:, -1])
        return np.stack(found)


def _blocks(state: State, stress: Array) -> tuple[Array, Array, Array]:
    ad, coad, turned = (np.array(a, dtype=float) for a in blocks(state.turn(stress), stress))
    return ad, coad, turned


def _balance(state: State, stress: Array) -> Array:
    turn = state.turn(stress)
    force = np.cross(turn[3:], stress[:3])
    return -np.concatenate([force, np.cross(turn[3:], stress[3:]) + np.cross(turn[:3], stress[:3])])


def _system(state: State, stress: Array) -> Array:
    """The matrix (2 parts, 2 parts) of Y' = (matrix + growth ...) Y, Y = (eta, sigma)."""
    ad, coad, turned = _blocks(state, stress)
    compliance = np.diag(state.compliance)
    pick = np.ix_(state.parts, state.parts)
    zero = np.zeros((len(state.parts),) * 2)
    return np.block([[-ad[pick], compliance[pick]], [zero, (-coad - turned @ compliance)[pick]]])


def _rows(state: State, stress: Array) -> Array:
    """What vanishes at the tip, (parts, 2 parts)."""
    load = np.zeros((6, 6))
    for k in range(3):
        load[:3, 3 + k] = np.cross(stress[:3], np.eye(3)[k])
    return np.hstack([-load[np.ix_(state.parts, state.parts)], np.eye(len(state.parts))])


def determinant(state: State, growth: float) -> float:
    """What vanishes at a growth (1 / time)."""
    size = len(state.parts)
    drag = growth * np.asarray(state.friction, dtype=float)[list(state.parts)]

    def rate(u: float, flat: Array) -> Array:
        stress, motion = flat[:6], flat[6:].reshape(2 * size, size)
        change = _system(state, stress) @ motion
        change[size:] += drag[:, None] * motion[:size]
        return np.concatenate([_balance(state, stress), change.ravel()])

    pull = float(np.abs(np.asarray(state.base_stress)[3:]).max()) / state.length
    scale = np.array([pull] * 3 + [pull * state.length] * 3)[list(state.parts)]  # of stresses, so that all are alike
    start = np.concatenate([np.asarray(state.base_stress), np.vstack([np.zeros((size, size)), np.diag(scale)]).ravel()])
    found = solve_ivp(rate, (0.0, state.length), start, method="DOP853", rtol=1e-13, atol=1e-13)
    motion = found.y[6:, -1].reshape(2 * size, size)
    return float(np.linalg.det(_rows(state, found.y[:6, -1]) @ motion / scale[:, None]))


def growths(state: State, number: int, degree: int = 24) -> Array:
    """The `number` leading growths (1 / time), by collocation."""
    u, size = chebyshev.points(degree, state.length), 2 * len(state.parts)
    half, points = size // 2, degree + 1
    stress = state.stress(u)
    left = np.kron(np.eye(size), chebyshev.derivative(degree, state.length))
    for i, s in enumerate(stress):
        left[i::points, i::points] -= _system(state, s)
    right = np.zeros_like(left)
    for k, x in enumerate(np.asarray(state.friction, dtype=float)[list(state.parts)]):
        right[(half + k) * points : (half + k + 1) * points, k * points : (k + 1) * points] = x * np.eye(points)
    for k, row in enumerate(_rows(state, stress[-1])):
        for at, condition, point in ((k * points, np.eye(size)[k], 0), ((half + k) * points + degree, row, degree)):
            left[at], right[at] = np.kron(condition, np.eye(points)[point]), 0.0
    inverse = np.linalg.eigvals(np.linalg.solve(left, right))
    found = 1.0 / inverse[np.abs(inverse) > 1e-7 * np.abs(inverse).max()]
    return np.asarray(found[np.argsort(-found.real)][:number].real)


def refined(state: State, growth: float) -> float:
    """The growth (1 / time) next to an estimate."""
    low, high = growth - 1e-5 * abs(growth), growth + 1e-5 * abs(growth)
    return float(brentq(lambda x: determinant(state, x), low, high, xtol=1e-15 * abs(growth), rtol=1e-14))
