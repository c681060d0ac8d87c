"""Equilibria of the spatial rod, by closed forms, by collocation and by balances over the whole rod."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.references import chebyshev, elastica, helix, static_rod
from tests.references.static_rod import Array, Rod

DIAGONAL = (40.0, 30.0, 25.0, 0.8, 1.0, 1.3)
# every mode coupled to every other; positive definite by diagonal dominance of the scaled matrix
FULL = np.sqrt(np.outer(DIAGONAL, DIAGONAL)) * (
    np.eye(6) + 0.12 * np.sin(np.add.outer(np.arange(6), np.arange(6)) * 1.7 + 0.4) * (1.0 - np.eye(6))
)


def _curled(u: float) -> Array:
    return np.array([1.0, 0.05 * u, 0.0, 0.3, 0.5 * np.cos(2.0 * u), -0.4 + 0.6 * u])


def _heavy(u: float) -> Array:
    return np.array([0.2, -0.3 - 0.5 * u, 0.1 * u**2])


EVERYTHING = Rod(
    length=1.4,
    stiffness=FULL,
    reference=_curled,
    tip_force=(0.2, 0.4, -0.5),
    tip_torque=(0.1, -0.2, 0.15),
    body_force=(-0.1, 0.2, 0.1),
    body_torque=(0.05, 0.1, -0.1),
    weight=_heavy,
    body_force_density=(0.05, 0.1, -0.2),
    body_torque_density=lambda u: (0.1 * u, 0.05, -0.1),
    base_position=(0.3, -0.2, 0.5),
    base_rotation=Rotation.from_rotvec([0.3, -1.2, 0.7]).as_matrix(),
)


def _collocated(rod: Rod, degree: int = 30) -> tuple[Array, Array, Array]:
    """Quaternions and body stresses at all Chebyshev points at once: tip position, tip rotation, stresses.

    Written in the Lie-algebra form, ad from matrix commutators; Newton with an exact (complex-step) Jacobian.
    """
    u, slope = chebyshev.points(degree, rod.length), chebyshev.derivative(degree, rod.length)
    basis = [helix.hat(x) for x in np.eye(6)]
    structure = np.zeros((6, 6, 6))
    for a, left in enumerate(basis):
        for b, right in enumerate(basis):
            m = left @ right - right @ left
            structure[a, b] = [*m[1:, 0], m[3, 2], m[1, 3], m[2, 1]]
    profile = [np.array([static_rod.value_at(p, x) for x in u]) for p in (rod.reference, rod.weight)]
    density = np.array(
        [
            [
                *static_rod.value_at(rod.body_force_density, x),
                *static_rod.value_at(rod.body_torque_density, x),
            ]
            for x in u
        ]
    )
    inverse = np.linalg.inv(static_rod.stiffness_at(rod, 0.0))
    start = np.roll(Rotation.from_matrix(np.asarray(rod.base_rotation)).as_quat(), 1)

    def frames(q: Array) -> Array:
        w, x, y, z = q.T
        rows = [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
        return np.moveaxis(np.array(rows), 2, 0)

    def residual(flat: Array, share: float) -> Array:
        q, stress = np.split(flat.reshape(degree + 1, 10), [4], axis=1)
        turn = profile[0] + stress @ inverse.T
        w, (x, y, z) = q[:, 0], q[:, 1:].T
        a, b, c = turn[:, 3:].T
        spin = 0.5 * np.array(
            [-x * a - y * b - z * c, w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a]
        )
        rotation = frames(q)
        weight = np.einsum("uji,uj->ui", rotation, profile[1])
        load = share * (density + np.concatenate([weight, np.zeros((degree + 1, 3))], axis=1))
        coadjoint = -np.einsum("ua,abc,uc->ub", turn, structure, stress)
        kinematics = slope @ q - spin.T
        balance = slope @ stress + coadjoint + load
        kinematics[0] = q[0] - start
        tip = [
            rotation[-1].T @ np.asarray(rod.tip_force) + np.asarray(rod.body_force),
            rotation[-1].T @ np.asarray(rod.tip_torque) + np.asarray(rod.body_torque),
        ]
        balance[-1] = stress[-1] - share * np.concatenate(tip)
        return np.concatenate([kinematics, balance], axis=1).ravel()

    state = np.concatenate([np.tile(start, (degree + 1, 1)), np.zeros((degree + 1, 6))], axis=1).ravel()
    for share in (0.0, 0.5, 1.0):
        for _ in range(12):
            jacobian = np.stack(
                [residual(state + 1e-30j * e, share).imag / 1e-30 for e in np.eye(len(state))], axis=1
            )
            change = np.linalg.solve(jacobian, -residual(state, share))
            state = state + change
            if np.abs(change).max() < 1e-11:
                break
        else:
            raise AssertionError("collocation did not converge")
    q, stress = np.split(state.reshape(degree + 1, 10), [4], axis=1)
    advance = np.einsum("uij,uj->ui", frames(q), (profile[0] + stress @ inverse.T)[:, :3])
    tip = np.asarray(rod.base_position) + chebyshev.integral(degree, rod.length, 0)[-1] @ advance
    return tip, frames(q)[-1], stress


def test_all_loads_together_agree_with_collocation() -> None:
    """Chebyshev collocation of the body-frame equations gives the same tip and stresses to 1e-11."""
    found = static_rod.solve(EVERYTHING)
    tip, rotation, stress = _collocated(EVERYTHING)
    np.testing.assert_allclose(found.tip_position, tip, atol=1e-11)
    np.testing.assert_allclose(found.tip_rotation, rotation, atol=1e-11)
    shape = found.at(chebyshev.points(30, EVERYTHING.length)[::6])
    np.testing.assert_allclose(shape.stress, stress[::6], atol=1e-11)
    np.testing.assert_allclose(found.base_stress, stress[0], atol=1e-11)
    assert np.linalg.norm(Rotation.from_matrix(rotation).as_rotvec()) > 0.5, "the load should be felt"


def test_force_and_moment_balance_over_the_whole_rod() -> None:
    """In the world: the clamp carries the loads, and their moments about the clamp, by Gauss quadrature."""
    rod = EVERYTHING
    found = static_rod.solve(rod)
    node, weight = np.polynomial.legendre.leggauss(24)
    shape = found.at(0.5 * rod.length * (node + 1.0))
    weight = weight * 0.5 * rod.length
    frame, clamp = found.tip_rotation, np.asarray(rod.base_rotation)
    force = np.array([_heavy(u) for u in shape.u]) + shape.rotation @ np.asarray(rod.body_force_density)
    couple = np.einsum("uij,uj->ui", shape.rotation, [[0.1 * u, 0.05, -0.1] for u in shape.u])
    pull = np.asarray(rod.tip_force) + frame @ np.asarray(rod.body_force)
    twist = np.asarray(rod.tip_torque) + frame @ np.asarray(rod.body_torque)
    origin = np.asarray(rod.base_position)
    moment = np.cross(found.tip_position - origin, pull) + twist
    moment = moment + weight @ (np.cross(shape.position - origin, force) + couple)
    np.testing.assert_allclose(clamp @ found.base_stress[:3], pull + weight @ force, atol=1e-12)
    np.testing.assert_allclose(clamp @ found.base_stress[3:], moment, atol=1e-12)


@pytest.mark.parametrize("follower", [True, False])
def test_a_uniform_wrench_makes_a_helix(follower: bool) -> None:
    """Sigma = (a Pi, a h + b Pi) at the tip and reference E - K^-1 Sigma: the turn is E; K is full."""
    turn = np.array([1.05, 0.02, -0.03, 0.9, -0.5, 1.1])
    stress = helix.uniform_stress(turn, 0.3, -0.2)
    base = helix.pose((0.3, -0.5, 0.2, 0.4, 1.1, -0.7), [1.0])[0]
    poses = helix.pose(turn, [0.5, 1.6], base)
    tip = poses[-1, 1:, 1:]
    dead, body = np.zeros(6), stress
    if not follower:
        dead, body = np.concatenate([tip @ stress[:3], tip @ stress[3:]]), np.zeros(6)
    rod = Rod(
        length=1.6,
        stiffness=FULL,
        reference=turn - np.linalg.solve(FULL, stress),
        base_position=base[1:, 0],
        base_rotation=base[1:, 1:],
        tip_force=dead[:3],
        tip_torque=dead[3:],
        body_force=body[:3],
        body_torque=body[3:],
    )
    found = static_rod.solve(rod)
    shape = found.at([0.5, 1.6])
    np.testing.assert_allclose(shape.position, poses[:, 1:, 0], atol=1e-12)
    np.testing.assert_allclose(shape.rotation, poses[:, 1:, 1:], atol=1e-12)
    np.testing.assert_allclose(shape.turn, np.tile(turn, (2, 1)), atol=1e-12)
    np.testing.assert_allclose(found.tip_position, poses[-1, 1:, 0], atol=1e-12)
    np.testing.assert_allclose(found.base_stress, stress, atol=1e-12)


@pytest.mark.parametrize("force", [(0.0, -1.0), (-3.0, 0.5), (-3.0, 1e-3)])
def test_in_the_plane_it_is_the_elastica(force: tuple[float, float]) -> None:
    """Elliptic functions give the same rod, also where a compressed rod has other, unstable equilibria."""
    u = np.array([0.0, 0.7, 1.3])
    exact = elastica.elliptic(elastica.Cantilever(1.3, 50.0, 1.2, force), u)
    found = static_rod.solve(
        Rod(1.3, static_rod.from_planar([50.0, 50.0, 1.2], 50.0), tip_force=(*force, 0.0))
    )
    shape = found.at(u)
    np.testing.assert_allclose(shape.position[:, :2], exact.position, atol=1e-12)
    np.testing.assert_allclose(shape.turn, [static_rod.from_planar(e) for e in exact.strain], atol=1e-12)


@pytest.mark.slow
def test_dead_loads_do_as_much_work_as_the_rod_stores() -> None:
    """Raising the loads in proportion: energy = P . r(1) - integral of P . r over the share of the load."""
    rod = Rod(1.4, FULL, _curled, tip_force=(0.4, -0.6, 0.5))
    node, weight = np.polynomial.legendre.leggauss(7)
    force = np.asarray(rod.tip_force)
    tips = [static_rod.solve(static_rod.scaled(rod, 0.5 * (x + 1.0))).tip_position @ force for x in node]
    final = static_rod.solve(rod)
    work = final.tip_position @ force - 0.5 * weight @ np.array(tips)
    node, weight = np.polynomial.legendre.leggauss(20)
    stress = final.at(0.7 * (node + 1.0)).stress
    energy = 0.7 * weight @ (0.5 * np.einsum("ui,ui->u", stress, np.linalg.solve(FULL, stress.T).T))
    assert work == pytest.approx(energy, rel=1e-9)


def test_distributed_couple_and_steps_give_their_closed_forms() -> None:
    """Couple m per length in the plane: M = m (L - u); steps in k3 and curvature add piece by piece."""
    couple, step, length = 0.8, 0.6, 1.5

    def stiffness(u: float) -> Array:
        return static_rod.from_planar([50.0, 50.0, 1.0 if u < step else 3.0], 50.0)

    def reference(u: float) -> Array:
        return static_rod.from_planar([1.0, 0.0, 0.0 if u < step else 2.0])

    rod = Rod(length, stiffness, reference, body_torque_density=(0.0, 0.0, couple), jumps=(step,))
    found = static_rod.solve(rod)
    first = couple * (length * step - 0.5 * step**2)
    second = couple * 0.5 * (length - step) ** 2 / 3.0 + 2.0 * (length - step)
    angle = Rotation.from_matrix(found.tip_rotation).as_rotvec()
    np.testing.assert_allclose(angle, [0.0, 0.0, first + second], atol=1e-12)
    np.testing.assert_allclose(found.base_stress, [0.0, 0.0, 0.0, 0.0, 0.0, couple * length], atol=1e-12)


def test_a_named_jump_need_not_be_searched_for() -> None:
    """Stopping at the jump takes less than half the evaluations that error control needs to find it."""

    asked: list[float] = []

    def reference(u: float) -> Array:
        asked.append(u)
        return static_rod.from_planar([1.0, 0.0, 0.0 if u < 0.6 else 2.0])

    found = static_rod.solve(Rod(1.5, DIAGONAL, reference, jumps=(0.6,)))
    counts = []
    for jumps in ((0.6,), ()):
        asked.clear()
        replace(found, rod=replace(found.rod, jumps=jumps)).at([0.0])
        counts.append(len(asked))
    assert counts[0] < 0.5 * counts[1]


def test_small_loads_give_the_linear_beam_in_both_directions() -> None:
    """P L^3 / 3 k + P L / k_shear across, P L / k1 along, T L / k_twist about, all stiffnesses different."""
    size, length = 1e-6, 1.3
    rod = Rod(length, DIAGONAL, tip_force=(size, size, size), tip_torque=(size, 0.0, 0.0))
    found = static_rod.solve(rod)
    k1, k2, k3, twist, bend2, bend3 = DIAGONAL
    across = [length**3 / (3.0 * bend3) + length / k2, length**3 / (3.0 * bend2) + length / k3]
    expected = size * np.array([length / k1, *across])
    np.testing.assert_allclose((found.tip_position - [length, 0.0, 0.0]), expected, rtol=1e-5, atol=1e-11)
    turned = Rotation.from_matrix(found.tip_rotation).as_rotvec()
    half = 0.5 * length**2
    np.testing.assert_allclose(
        turned, size * np.array([length / twist, -half / bend2, half / bend3]), rtol=1e-5
    )


def test_the_equilibrium_of_a_moved_rod_is_the_moved_equilibrium() -> None:
    """Turning and shifting base and dead loads turns and shifts the tip and leaves the stress alone."""
    turn, shift = Rotation.from_rotvec([0.9, 0.4, -1.3]).as_matrix(), np.array([1.0, -2.0, 0.5])
    plain = Rod(1.2, FULL, _curled, tip_force=(0.3, -0.2, 0.4), weight=(0.0, 0.0, -0.6))
    moved = Rod(
        1.2,
        FULL,
        _curled,
        tip_force=turn @ plain.tip_force,
        weight=turn @ plain.weight,
        base_position=shift,
        base_rotation=turn,
    )
    first, second = static_rod.solve(plain), static_rod.solve(moved)
    np.testing.assert_allclose(second.tip_position, turn @ first.tip_position + shift, atol=1e-12)
    np.testing.assert_allclose(second.tip_rotation, turn @ first.tip_rotation, atol=1e-12)
    np.testing.assert_allclose(second.base_stress, first.base_stress, atol=1e-12)


def test_a_rod_pushed_exactly_along_itself_beyond_buckling_is_refused() -> None:
    """The branch of the unloaded rod ends at the bifurcation; the error says where and what to do."""
    rod = Rod(1.0, DIAGONAL, tip_force=(-3.0, 0.0, 0.0))
    with pytest.raises(ArithmeticError, match="lower the load, or break the symmetry"):
        static_rod.solve(rod)


def test_points_outside_the_rod_are_refused() -> None:
    """`at` says which u it may be asked for."""
    found = static_rod.solve(Rod(1.0, DIAGONAL))
    with pytest.raises(ValueError, match=r"expected u between 0 and 1\.0"):
        found.at([0.5, 1.2])
