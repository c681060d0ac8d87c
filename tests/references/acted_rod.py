"""A spatial rod in a viscous fluid on which anything may act, however its ends are held: positions and quaternions.

The balances in the world of `moving_rod`, with the densities of force f and of couple c that the scene's physics
says, as functions of time, place and frame:

    Gamma (v, Omega) = R^T (n' + f, m' + r' x n + c)

The unknowns are w and the quaternion at all Chebyshev points; w at the first point is the displacement of the left
end. Both ends have no rates but conditions, seven each: a clamped one its place and quaternion, a pinned one its place,
its moment and |q| = 1, a free one its force, its moment and |q| = 1.

A base that is driven along one screw, phi(0, t) = exp(s(t) Y) phi(0, 0), is clamped as seen by who rides on it; for
him the medium flows with -s'(t) (Y_v + Y_omega x r) and turns with -s'(t) Y_omega, and the world turns the other way.

Dimensions: those of `moving_rod`; f force / length, c force.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from tests.references import moving_rod
from tests.references.moving_rod import FIRST, STAGES, Shape, Values, conjugate, product, rotated
from tests.references.radau import instants, integrate

Array = npt.NDArray[np.float64]
Acting = Callable[[float, Values, Values], tuple[Any, Any]]
"""Time, places (..., points, 3), quaternions (..., points, 4) to world components of f and of c."""


def nothing(t: float, r: Values, q: Values) -> tuple[Any, Any]:
    """Nothing acts."""
    return np.zeros(3), np.zeros(3)


@dataclass(frozen=True)
class End:
    """How an end is held and loaded: force and torque (6,) at a time, outward, in the world or in the body."""

    kind: Literal["clamped", "pinned", "free"]
    load: Callable[[float], npt.ArrayLike] = lambda t: np.zeros(6)
    frame: Literal["body", "world"] = "body"


@dataclass(frozen=True)
class Rod:
    """stiffness, friction (6, 6); reference (6,); it starts at rest at the reference, its left end as placed."""

    length: float
    stiffness: Array
    friction: Array
    reference: Array
    left: End = End("clamped")
    right: End = End("free")
    acting: Acting = nothing
    position: npt.ArrayLike = (0.0, 0.0, 0.0)
    rotation: npt.ArrayLike = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Collocation(moving_rod.Collocation):
    """w (3) and quaternion (4) at all points make a state, (7 (degree + 1),)."""

    def __init__(self, rod: Rod, degree: int) -> None:
        self.acted = rod
        held = moving_rod.Rod(
            rod.length, rod.stiffness, rod.friction, rod.reference, lambda u: rod.reference, lambda t: np.zeros(3),
            position=rod.position, rotation=rod.rotation,
        )  # fmt: skip
        super().__init__(held, degree)
        self.first = np.concatenate([np.zeros(3), self.clamp, super().begin()]).reshape(-1, 7)
        self.start = self.places(self.first.ravel())

    def begin(self) -> Array:
        return self.first.ravel()

    def whole(self, y: Values) -> Values:
        return y.reshape(*y.shape[:-1], -1, 7)

    def moved(self, y: Values) -> Values:
        """What the rates are the rates of: r and q; nothing at the ends."""
        result = np.concatenate([self.places(y), self.whole(y)[..., 3:]], axis=-1)
        result[..., [0, -1], :] = 0.0
        return np.asarray(result.reshape(y.shape))

    def places(self, y: Values) -> Values:
        whole = self.whole(y)
        return np.asarray(self.rod.position + whole[..., :3] + self.integral @ rotated(whole[..., 3:], FIRST))

    def residual(self, t: float, y: Values) -> Values:
        """Rates between the ends; there, what is left of their conditions."""
        q, turn, stress = self.fields(y)
        place = self.places(y)
        n, m = rotated(q, stress[..., :3]), rotated(q, stress[..., 3:])
        f, c = self.acted.acting(t, place, q)
        pull = self.slope @ n + f
        couple = self.slope @ m + np.cross(rotated(q, turn[..., :3]), n) + c
        back = conjugate(q)
        twist = np.concatenate([rotated(back, pull), rotated(back, couple)], axis=-1) @ self.mobility
        rates = np.concatenate([rotated(q, twist[..., :3]), 0.5 * product(q, twist[..., 3:])], axis=-1)
        for at, sign, end in ((0, -1.0, self.acted.left), (-1, 1.0, self.acted.right)):
            load = np.asarray(end.load(t), dtype=float)
            force, torque = load[:3], load[3:]
            if end.frame == "body":
                force, torque = rotated(q[..., at, :], force), rotated(q[..., at, :], torque)
            where = place[..., at, :] - self.start[at]
            norm = np.sum(q[..., at, :] ** 2, axis=-1, keepdims=True) - 1.0
            rest = np.concatenate([sign * m[..., at, :] - torque, norm], axis=-1)
            if end.kind == "clamped":
                rest = q[..., at, :] - self.first[at, 3:]
            elif end.kind == "free":
                where = sign * n[..., at, :] - force
            rates[..., at, :] = np.concatenate([where, rest], axis=-1)
        return np.asarray(rates.reshape(y.shape))

    def shape(self, y: Array) -> Shape:
        q, turn, _ = self.fields(y)
        return Shape(self.u, self.places(y), Rotation.from_quat(np.roll(q, -1, axis=1)).as_matrix(), turn)


def solve(
    rod: Rod, until: float, degree: int = 16, first: float = 1e-4, growth: float = 1.8, longest: float = 1 / 24
) -> Shape:
    """The rod at the time `until`. Time steps: `first` and `longest` as fractions of `until`; where Newton's method
    fails on them, all are made anew, half as long.

    Raises ArithmeticError if it still fails on a sixteenth.
    """
    equations = Collocation(rod, degree)
    for halved in range(5):
        steps = instants(until, first * until, growth, longest * until / 2**halved)
        try:
            return equations.shape(integrate(equations, equations.begin(), steps, STAGES, 1e-11 * rod.length))
        except ArithmeticError as error:
            failure = error
    raise failure


def medium(friction: Array, q: Values, flow: Values, spin: npt.ArrayLike) -> tuple[Values, Values]:
    """Force and couple of a medium that moves with `flow` and turns with `spin`, in the world; friction is diagonal."""
    drag, back = np.diag(friction), conjugate(q)
    turning = rotated(back, np.broadcast_to(np.asarray(spin, dtype=float), flow.shape))
    return rotated(q, rotated(back, flow) * drag[:3]), rotated(q, turning * drag[3:])
