"""Kirchhoff's rod against the elastica, the limit of stiff rods, collocation, and balances over the whole rod."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.marks import slow
from tests.references import chebyshev, elastica, kirchhoff_statics, static_rod
from tests.references.kirchhoff_statics import Array, Rod, solve


def _curled(u: float) -> tuple[float, float, float]:
    return (0.3, 0.5 * math.cos(2.0 * u), -0.4 + 0.6 * u)


BASE = Rotation.from_rotvec([0.3, -1.2, 0.7]).as_matrix()
ROD = Rod(
    length=1.4,
    stiffness=(0.8, 1.0, 1.3),
    reference=_curled,
    force=(0.3, 0.5, -0.7),
    torque=(0.1, -0.2, 0.15),
    weight=(0.2, -0.3, 0.1),
    base_position=(0.3, -0.2, 0.5),
    base_rotation=BASE,
)


@pytest.mark.parametrize("force", [(0.0, -1.0), (1.5, -2.0), (-1.0, 0.5)])
def test_in_the_plane_it_is_the_inextensible_elastica(force: tuple[float, float]) -> None:
    """Elliptic functions, no stretch and no shear: position, bend and multiplier to 1e-12."""
    u = np.array([0.0, 0.7, 1.3])
    exact = elastica.elliptic(elastica.Cantilever(1.3, math.inf, 1.2, force), u)
    shape = solve(Rod(1.3, (0.9, 2.0, 1.2), force=(*force, 0.0))).at(u)
    np.testing.assert_allclose(shape.position[:, :2], exact.position, atol=1e-12)
    np.testing.assert_allclose(shape.bend[:, 2], exact.strain[:, 2], atol=2e-12)
    c, s = np.cos(exact.angle), np.sin(exact.angle)
    np.testing.assert_allclose(shape.force[:, 0], c * force[0] + s * force[1], atol=1e-12)
    np.testing.assert_allclose(shape.force[:, 1], c * force[1] - s * force[0], atol=1e-12)
    np.testing.assert_allclose(shape.position[:, 2], 0.0, atol=1e-14)


@pytest.mark.slow
def test_stiff_rods_tend_to_it() -> None:
    """The stretching, shearing rod of `static_rod`, extrapolated from three k: tip and stress at the clamp to 1e-9."""
    found = solve(ROD)
    results = []
    for k in (1e3, 2e3, 4e3):
        stiff = static_rod.Rod(
            length=ROD.length,
            stiffness=(k, 0.7 * k, 0.5 * k, *ROD.stiffness),
            reference=lambda u: (1.0, 0.0, 0.0, *_curled(u)),
            tip_force=ROD.force,
            tip_torque=ROD.torque,
            weight=ROD.weight,
            base_position=ROD.base_position,
            base_rotation=BASE,
        )
        near = static_rod.solve(stiff)
        results.append(np.concatenate([near.tip_position, near.tip_rotation.ravel(), near.base_stress]))
    once = [2.0 * results[1] - results[0], 2.0 * results[2] - results[1]]
    expected = (4.0 * once[1] - once[0]) / 3.0
    mine = np.concatenate([found.tip_position, found.tip_rotation.ravel(), found.base_force, found.base_moment])
    np.testing.assert_allclose(mine, expected, atol=1e-9)
    assert np.abs(results[0] - mine).max() > 1e-4


def _collocated(rod: Rod, degree: int = 28) -> tuple[Array, Array]:
    """Tip position and moments (points, 3) in the world, all Chebyshev points at once, Newton with complex steps.

    Unknowns: the rotation matrix by rows and the moment m in the world, m' + r' x n = 0.
    """
    u, slope = chebyshev.points(degree, rod.length), chebyshev.derivative(degree, rod.length)
    reference = np.array([kirchhoff_statics._reference(rod, x) for x in u])
    compliance = 1.0 / np.asarray(rod.stiffness)
    clamp = np.asarray(rod.base_rotation).ravel()

    def residual(flat: Array, share: float) -> Array:
        frames, m = np.split(flat.reshape(degree + 1, 12), [9], axis=1)
        rotation = frames.reshape(-1, 3, 3)
        bend = reference + compliance * np.einsum("uji,uj->ui", rotation, m)
        spin = np.einsum("uij,uj->ui", rotation, bend)  # in the world: R' = spin x columns
        turned = np.cross(spin[:, None, :], np.swapaxes(rotation, 1, 2))
        kinematics = slope @ frames - np.swapaxes(turned, 1, 2).reshape(-1, 9)
        n = share * (np.asarray(rod.force) + np.outer(rod.length - u, rod.weight))
        balance = slope @ m + np.cross(rotation[:, :, 0], n)
        kinematics[0], balance[-1] = frames[0] - clamp, m[-1] - share * np.asarray(rod.torque)
        return np.concatenate([kinematics, balance], axis=1).ravel()

    state = np.concatenate([np.tile(clamp, (degree + 1, 1)), np.zeros((degree + 1, 3))], axis=1).ravel()
    for share in (0.0, 0.5, 1.0):
        for _ in range(15):
            jacobian = np.stack([residual(state + 1e-30j * e, share).imag / 1e-30 for e in np.eye(state.size)], axis=1)
            change = np.linalg.solve(jacobian, -residual(state, share))
            state = state + change
            if np.abs(change).max() < 1e-11:
                break
        else:
            raise AssertionError("collocation did not converge")
    frames, m = np.split(state.reshape(degree + 1, 12), [9], axis=1)
    along = chebyshev.integral(degree, rod.length, 0)[-1] @ frames[:, [0, 3, 6]]
    return np.asarray(rod.base_position) + along, m


@pytest.mark.parametrize("stiffness", [slow((0.8, 1.0, 1.3)), slow((math.inf, 1.0, 1.3)), (0.8, math.inf, math.inf)])
def test_it_agrees_with_collocation(stiffness: tuple[float, float, float]) -> None:
    """In the world, on Chebyshev points, all loads, also with some of twist and bends held: to 1e-11."""
    rod = replace(ROD, stiffness=stiffness)
    found = solve(rod)
    tip, moments = _collocated(rod)
    np.testing.assert_allclose(found.tip_position, tip, atol=1e-11)
    shape = found.at(chebyshev.points(28, rod.length)[::7])
    np.testing.assert_allclose(np.einsum("uij,uj->ui", shape.rotation, shape.moment), moments[::7], atol=1e-11)
    for k, stiff in enumerate(stiffness):
        if math.isinf(stiff):
            np.testing.assert_array_equal(shape.bend[:, k], [_curled(u)[k] for u in shape.u])


def test_force_and_moment_balance_over_the_whole_rod() -> None:
    """In the world: the clamp carries the loads and their moments about the clamp, by Gauss quadrature."""
    found = solve(ROD)
    node, weight = np.polynomial.legendre.leggauss(24)
    shape = found.at(0.5 * ROD.length * (node + 1.0))
    share = 0.5 * ROD.length * weight
    force, heavy = np.asarray(ROD.force), np.asarray(ROD.weight)
    np.testing.assert_allclose(BASE @ found.base_force, force + ROD.length * heavy, atol=1e-14)
    origin = np.asarray(ROD.base_position)
    moment = np.cross(found.tip_position - origin, force) + np.asarray(ROD.torque)
    moment = moment + share @ np.cross(shape.position - origin, heavy)
    np.testing.assert_allclose(BASE @ found.base_moment, moment, atol=1e-11)
    np.testing.assert_allclose(found.tip_rotation.T @ found.tip_rotation, np.eye(3), atol=1e-12)


def test_a_load_that_cannot_be_followed_is_refused() -> None:
    """Pushed far beyond buckling from a slightly bent rest."""
    rod = Rod(1.0, (1.0, 1.0, 1.0), (0.0, 0.0, 0.01), force=(-400.0, 0.0, 0.0))
    with pytest.raises(ArithmeticError, match="expected a load without buckling"):
        solve(rod)
