"""Equilibrium of a spatial rod clamped at u = 0 and loaded along it and at its free end, to about 1e-12.

    phi' = phi E          r' = R h,  R' = R Pi^
    E = E0(u) + K^-1 Sigma
    Sigma' + ad*_E Sigma + j = 0   F' + Pi x F + f = 0,  M' + Pi x M + h x F + m = 0

In the world the force is n = R F, with n' = -(weight + R follower), so with the tip turned by R_L everything
at the tip is known: n, M and R. The equations are integrated from the tip back to the clamp (DOP853) and
three numbers, the turn of the tip, are adjusted by Newton's method until the clamp has its orientation; the
position follows by a shift. Loads are raised in small steps, with the turn of the tip limited in each, and a
solution whose Jacobian has changed sign is refused, so the branch that grows from the unloaded rod is
followed. A fold or a bifurcation on the way is an error. Source: S. S. Antman, *Nonlinear Problems of
Elasticity*, chapters 8-9 (equations); H. B. Keller, *Numerical Methods for Two-Point Boundary-Value Problems*
(shooting).

A planar rod (h1, h2, Pi) is the spatial one with (h1, h2, Pi3): see `from_planar`.

Dimensions: E as (none, none, none, 1 / length x 3); K from E to (force x 3, force x length x 3); loads per
length.
"""

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

Array = npt.NDArray[np.float64]
Profile = Callable[[float], npt.ArrayLike]

ZERO = (0.0, 0.0, 0.0)
STRAIGHT = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
TURN_LIMIT = 0.6  # radians by which the tip may turn in one step of the load
SHARE_LIMIT = 0.125  # share of the load that one step may add


@dataclass(frozen=True)
class Rod:
    """The rod and its loads. Every profile may be a constant or a function of u.

    stiffness: diagonal (6,) or matrix (6, 6), symmetric positive definite. reference: E0 (6,).
    Dead loads, in world components: tip_force, tip_torque, weight (force per length).
    Loads fixed in the body (followers): body_force and body_torque at the tip, and the two densities.
    base_position (3,); base_rotation (3, 3), its columns e_1, e_2, e_3.
    jumps: the u where a profile jumps. Integration stops there and calls the profile on either side only.
    """

    length: float
    stiffness: npt.ArrayLike | Profile
    reference: npt.ArrayLike | Profile = STRAIGHT
    tip_force: npt.ArrayLike = ZERO
    tip_torque: npt.ArrayLike = ZERO
    body_force: npt.ArrayLike = ZERO
    body_torque: npt.ArrayLike = ZERO
    weight: npt.ArrayLike | Profile = ZERO
    body_force_density: npt.ArrayLike | Profile = ZERO
    body_torque_density: npt.ArrayLike | Profile = ZERO
    base_position: npt.ArrayLike = ZERO
    base_rotation: npt.ArrayLike = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    jumps: tuple[float, ...] = ()


@dataclass(frozen=True)
class Shape:
    """The rod at the points u.

    position (points, 3), rotation (points, 3, 3), turn E (points, 6), stress Sigma (points, 6).
    """

    u: Array
    position: Array
    rotation: Array
    turn: Array
    stress: Array


@dataclass(frozen=True)
class Equilibrium:
    """The solved rod: pose of the tip, stress (6,) at the clamp, turn error left at the clamp (radians)."""

    rod: Rod
    tip_position: Array
    tip_rotation: Array
    base_stress: Array
    residual: float

    def at(self, u: npt.ArrayLike) -> Shape:
        """The shape at u (length), any order, shape (points,): integrated to each, not interpolated.

        At a jump of the reference or the stiffness the turn is the one that the profile itself gives there.
        """
        points = np.atleast_1d(np.asarray(u, dtype=float))
        if np.any((points < 0.0) | (points > self.rod.length)):
            raise ValueError(
                f"expected u between 0 and {self.rod.length}, found {points.min()} to {points.max()}"
            )
        stations, inverse = np.unique(points, return_inverse=True)
        descending = stations[::-1]
        states = _march(self.rod, self.tip_rotation[None], descending, 1e-13)[::-1, 0][inverse.reshape(-1)]
        rotation, moment, force, shift = _split(states)
        stress = np.concatenate([np.einsum("pji,pj->pi", rotation, force), moment], axis=1)
        turn = np.stack(
            [
                value_at(self.rod.reference, x) + np.linalg.solve(stiffness_at(self.rod, x), s)
                for x, s in zip(points, stress, strict=True)
            ]
        )
        return Shape(
            u=points, position=self.tip_position + shift, rotation=rotation, turn=turn, stress=stress
        )


def from_planar(values: npt.ArrayLike, unused: float = 0.0) -> Array:
    """Put planar components (h1, h2, Pi) into spatial ones (6,), or a planar matrix (3, 3) into (6, 6).

    `unused` fills what a planar rod lacks: zero for a turn; for a stiffness a value that is not soft, or the
    rod may leave the plane.
    """
    planar = np.asarray(values, dtype=float)
    places = np.array([0, 1, 5])
    if planar.ndim == 1:
        spatial = np.full(6, unused)
        spatial[places] = planar
        return spatial
    matrix = np.eye(6) * unused
    matrix[np.ix_(places, places)] = planar
    return matrix


def solve(rod: Rod) -> Equilibrium:
    """The equilibrium on the branch of the unloaded rod.

    Raises ArithmeticError when raising the load does not reach it: a fold or a bifurcation lies before it.
    """
    rough, fine = 1e-8, 1e-13
    start = _march(scaled(rod, 0.0), np.eye(3)[None], np.array([0.0]), fine)[0, 0]
    unloaded = np.asarray(rod.base_rotation, dtype=float) @ _split(start)[0].T
    share, tip, step, change = 0.0, unloaded, SHARE_LIMIT, np.zeros(3)
    while share < 1.0:
        wanted = min(1.0, share + step)
        # go on turning at the same rate
        guess = tip @ Rotation.from_rotvec(change * (wanted - share)).as_matrix()
        found = _newton(scaled(rod, wanted), guess, rough, 1e-6, 1e-6)
        turned = np.inf if found is None else np.linalg.norm(_vector(tip.T @ found[0]))
        if found is None or turned > TURN_LIMIT:
            step *= 0.5
            if step < 1e-6:
                raise ArithmeticError(
                    f"no equilibrium found beyond {share:.6g} of the load: expected a branch without fold or "
                    "bifurcation; lower the load, or break the symmetry with a small side load"
                )
            continue
        change = _vector(tip.T @ found[0]) / (wanted - share)
        step = min(2.0 * step, SHARE_LIMIT) if turned < 0.5 * TURN_LIMIT else step
        share, tip = wanted, found[0]
    final = _newton(rod, tip, fine, 1e-13, 1e-11)
    if final is None:
        raise ArithmeticError(
            "the equilibrium was found to 1e-6 but not refined: expected a clamp turned by < 1e-11"
        )
    tip, residual = final
    base = _march(rod, tip[None], np.array([0.0]), fine)[0]
    rotation, moment, force, shift = _split(base)
    stress = np.concatenate([rotation[0].T @ force[0], moment[0]])
    position = np.asarray(rod.base_position, dtype=float) - shift[0]
    return Equilibrium(
        rod=rod, tip_position=position, tip_rotation=tip, base_stress=stress, residual=residual
    )


def _newton(rod: Rod, tip: Array, rtol: float, goal: float, accept: float) -> tuple[Array, float] | None:
    """Turn the tip until the clamp has its orientation; the tip and the angle that is left there, or None.

    Stops below `goal`, or where rounding stops the progress below `accept`.
    """
    clamp = np.asarray(rod.base_rotation, dtype=float)
    offset = 1e-4 if rtol > 1e-10 else 1e-6
    best, best_tip = np.inf, tip
    for _ in range(12):
        tips = np.stack([tip, *(tip @ Rotation.from_rotvec(offset * axis).as_matrix() for axis in np.eye(3))])
        clamps = _split(_march(rod, tips, np.array([0.0]), rtol)[0])[0]
        turns = np.stack([_vector(clamp.T @ found) for found in clamps])
        left = float(np.linalg.norm(turns[0]))
        if best < accept and left > 0.5 * best:
            return best_tip, best
        jacobian = (turns[1:] - turns[0]).T / offset
        if left < goal:
            # a negative determinant: beyond a fold, or on a branch that a bifurcation destabilised
            return (tip, left) if np.linalg.det(jacobian) > 0.0 else None
        if not left < 4.0 * best:
            return None
        if left < best:
            best, best_tip = left, tip
        correction = np.linalg.solve(jacobian, -turns[0])
        tip = tip @ Rotation.from_rotvec(correction * min(1.0, 1.0 / np.linalg.norm(correction))).as_matrix()
    return None


def _march(rod: Rod, tips: Array, stations: Array, rtol: float) -> Array:
    """States at the descending `stations`, shape (stations, copies, 18), for tips turned (copies, 3, 3).

    A state is R (9), M in the body (3), n in the world (3), r relative to the tip (3).
    """
    copies = len(tips)
    force = np.asarray(rod.tip_force, dtype=float) + tips @ np.asarray(rod.body_force, dtype=float)
    torque = np.asarray(rod.tip_torque, dtype=float) @ tips + np.asarray(rod.body_torque, dtype=float)
    state = np.concatenate([tips.reshape(copies, 9), torque, force, np.zeros((copies, 3))], axis=1)
    stops = sorted({rod.length, *stations, *(u for u in rod.jumps if 0.0 < u < rod.length)}, reverse=True)
    reached = {rod.length: state}
    pull, twist = _sizes(rod)
    # rounding is judged by the size that a component can have, not by the one it happens to have
    size = np.concatenate([np.ones(9), np.full(3, twist), np.full(3, pull), np.full(3, rod.length)])
    for upper, lower in itertools.pairwise(stops):
        inside = (float(np.nextafter(lower, upper)), float(np.nextafter(upper, lower)))
        result = solve_ivp(
            lambda u, y, inside=inside: _rate(rod, min(max(u, inside[0]), inside[1]), y),
            (upper, lower),
            state.ravel(),
            method="DOP853",
            rtol=rtol,
            atol=0.1 * rtol * np.tile(size, copies),
        )
        state = result.y[:, -1].reshape(copies, 18)
        reached[lower] = state
    return np.stack([reached[float(u)] for u in stations])


def _rate(rod: Rod, u: float, flat: Array) -> Array:
    rotation, moment, force, _ = _split(flat.reshape(-1, 18))
    stress = np.concatenate([np.einsum("cji,cj->ci", rotation, force), moment], axis=1)
    turn = value_at(rod.reference, u) + np.linalg.solve(stiffness_at(rod, u), stress.T).T
    h, bend = turn[:, :3], turn[:, 3:]
    turning = np.cross(rotation, bend[:, None, :], axis=2)  # rows of R Pi^ are row x Pi
    balance = -np.cross(bend, moment) - np.cross(h, stress[:, :3]) - value_at(rod.body_torque_density, u)
    pull = -(value_at(rod.weight, u) + rotation @ value_at(rod.body_force_density, u))
    advance = np.einsum("cij,cj->ci", rotation, h)
    return np.concatenate([turning.reshape(-1, 9), balance, pull, advance], axis=1).ravel()


def _sizes(rod: Rod) -> tuple[float, float]:
    """How large force and moment get: from the loads, sampled, and never zero."""
    within = rod.length * np.array([0.211, 0.789])
    densities = [
        np.abs(value_at(profile, u)).max() for profile in (rod.weight, rod.body_force_density) for u in within
    ]
    couples = [np.abs(value_at(rod.body_torque_density, u)).max() for u in within]
    pull = max(_largest(rod.tip_force), _largest(rod.body_force), rod.length * max(densities), 1e-3)
    twist = max(
        _largest(rod.tip_torque), _largest(rod.body_torque), rod.length * max(couples), rod.length * pull
    )
    return pull, twist


def _largest(values: npt.ArrayLike) -> float:
    return float(np.abs(np.asarray(values, dtype=float)).max())


def _split(states: Array) -> tuple[Array, Array, Array, Array]:
    """Rotation, body moment, world force and position of states with a last axis of 18."""
    shape = states.shape[:-1]
    return states[..., :9].reshape(*shape, 3, 3), states[..., 9:12], states[..., 12:15], states[..., 15:]


def _vector(rotation: Array) -> Array:
    return np.asarray(Rotation.from_matrix(rotation).as_rotvec())


def value_at(profile: npt.ArrayLike | Profile, u: float) -> Array:
    """A constant, or a function of u at u."""
    return np.asarray(profile(u) if callable(profile) else profile, dtype=float)


def stiffness_at(rod: Rod, u: float) -> Array:
    """K at u, shape (6, 6)."""
    values = value_at(rod.stiffness, u)
    return np.diag(values) if values.ndim == 1 else values


def scaled(rod: Rod, share: float) -> Rod:
    """The same rod with every load multiplied by `share`."""

    def times(profile: npt.ArrayLike | Profile) -> npt.ArrayLike | Profile:
        return (
            (lambda u: share * value_at(profile, u))
            if callable(profile)
            else share * np.asarray(profile, dtype=float)
        )

    return replace(
        rod,
        tip_force=share * np.asarray(rod.tip_force),
        tip_torque=share * np.asarray(rod.tip_torque),
        body_force=share * np.asarray(rod.body_force),
        body_torque=share * np.asarray(rod.body_torque),
        weight=times(rod.weight),
        body_force_density=times(rod.body_force_density),
        body_torque_density=times(rod.body_torque_density),
    )
