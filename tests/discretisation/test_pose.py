"""Poses marched from the turn: exact rotations, order 2p at element ends, the same from either end."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from geocosserat.algebra.exponential import rotation_from_vector
from geocosserat.discretisation.mesh import Mesh, make_mesh
from geocosserat.discretisation.pose import Poses, march, plane_rotation
from tests.references import circle, helix

Array = NDArray[np.float64]
ARC = np.array([1.1, 0.3, 2.0])
HELIX = np.array([1.0, 0.2, -0.3, 1.5, -0.8, 2.0])
LENGTH = 1.7


def uniform(mesh: Mesh, turn: Array) -> Array:
    """The same turn at every Gauss point, (d, points)."""
    return np.repeat(turn[:, None], len(mesh.u_point), axis=1)


def random_turn(d: int, mesh: Mesh, seed: int, batch: tuple[int, ...] = ()) -> Array:
    return np.random.default_rng(seed).normal(size=(*batch, d, len(mesh.u_point)))


def marched(mesh: Mesh, turn: Array, end: str = "left") -> Poses:
    """From the identity."""
    space = 2 if turn.shape[-2] == 3 else 3
    angle = np.asarray(0.0) if space == 2 else None
    return march(mesh, turn, np.zeros(space), np.eye(space), angle, end)


def pose_error(mesh: Mesh, turn: Array, nodes: slice) -> float:
    """Largest difference to the exact arc or helix on those nodes."""
    exact = helix.closed_pose(turn, mesh.u)
    found = marched(mesh, uniform(mesh, turn))
    difference = max(
        np.abs(found.position - exact[:, 1:, 0])[nodes].max(), np.abs(found.rotation - exact[:, 1:, 1:])[nodes].max()
    )
    return float(difference)


@pytest.mark.parametrize("turn", [ARC, HELIX], ids=["arc", "helix"])
@pytest.mark.parametrize("degree", [1, 2, 3])
def test_element_ends_converge_with_order_2p(degree: int, turn: Array) -> None:
    """Halving the elements divides the error of an exact helix by 4 to the p; inside, by 2 to the p + 1 or more."""
    coarse, fine = (make_mesh(LENGTH, n, degree) for n in (8, 16))
    ends = pose_error(coarse, turn, np.s_[::degree]) / pose_error(fine, turn, np.s_[::degree])
    assert ends == pytest.approx(4**degree, rel=0.1)
    anywhere = pose_error(coarse, turn, np.s_[:]) / pose_error(fine, turn, np.s_[:])
    assert anywhere > 0.9 * 2 ** (degree + 1)


@pytest.mark.parametrize("turn", [ARC, HELIX], ids=["arc", "helix"])
def test_one_element_converges_spectrally(turn: Array) -> None:
    """Three more degrees are worth at least two digits, down to round-off."""
    errors = [pose_error(make_mesh(LENGTH, 1, p), turn, np.s_[:]) for p in (3, 6, 9, 12, 15, 18)]
    assert all(b < 0.01 * a or b < 1e-14 for a, b in pairwise(errors))
    assert errors[-1] < 1e-14


@pytest.mark.parametrize("turn", [ARC, HELIX], ids=["arc", "helix"])
def test_the_highest_degree_is_as_accurate_as_the_numbers_allow(turn: Array) -> None:
    """Degree 64 on one element, several turns of the rod."""
    assert pose_error(make_mesh(10 * LENGTH, 1, 64), turn, np.s_[:]) < 3e-13


def test_a_circle_closes() -> None:
    """The reference circle, every node, one angle of 2 pi in all."""
    mesh = make_mesh(2 * np.pi, 4, 10)
    found = marched(mesh, uniform(mesh, np.array([1.0, 0.0, 1.0])))
    np.testing.assert_allclose(found.position, circle.position(mesh.u, 1.0, 1.0), rtol=0, atol=1e-13)
    np.testing.assert_allclose(found.angle, circle.angle(mesh.u, 1.0, 1.0), rtol=0, atol=1e-14)
    np.testing.assert_allclose(found.position[-1], 0, rtol=0, atol=1e-13)


@pytest.mark.parametrize("degree", [1, 2, 5, 12])
def test_rotations_are_orthogonal_at_element_ends_for_any_turn(degree: int) -> None:
    """Gauss collocation keeps quadratic invariants, however wild the turn; in the plane at every node."""
    mesh = make_mesh(LENGTH, 6, degree)
    R = marched(mesh, 5 * random_turn(6, mesh, 1)).rotation[::degree]
    np.testing.assert_allclose(R.swapaxes(-1, -2) @ R, np.broadcast_to(np.eye(3), R.shape), rtol=0, atol=5e-14)
    np.testing.assert_allclose(np.linalg.det(R), 1, rtol=0, atol=5e-14)
    R = marched(mesh, 5 * random_turn(3, mesh, 1)).rotation
    np.testing.assert_allclose(R.swapaxes(-1, -2) @ R, np.broadcast_to(np.eye(2), R.shape), rtol=0, atol=4e-16)


@pytest.mark.parametrize("degree", [1, 2, 5, 12])
def test_the_planar_angle_is_the_exact_integral_of_the_bend(degree: int) -> None:
    """A linear invariant: exact for a bend of degree p - 1 in each element, unwrapped over any number of turns."""
    mesh = make_mesh(LENGTH, 3, degree)
    bend = 40 * np.random.default_rng(2).normal(size=degree)
    x = 2 * mesh.u_point / LENGTH - 1
    turn = np.stack([np.ones_like(x), np.zeros_like(x), legendre.legval(x, bend)])
    exact = LENGTH / 2 * legendre.legval(2 * mesh.u / LENGTH - 1, legendre.legint(bend, lbnd=-1))
    found = marched(mesh, turn)
    assert found.angle is not None
    np.testing.assert_allclose(found.angle, exact, rtol=0, atol=1e-13 * np.abs(exact).max())
    np.testing.assert_allclose(found.rotation, plane_rotation(found.angle), rtol=0, atol=1e-15)


@pytest.mark.parametrize("d", [3, 6])
@pytest.mark.parametrize(("elements", "degree"), [(1, 5), (4, 2), (6, 1)])
def test_marching_from_the_left_and_back_from_the_right_agree(d: int, elements: int, degree: int) -> None:
    """Starting from the pose that the march from the left ends with gives the same poses, to round-off."""
    mesh = make_mesh(LENGTH, elements, degree)
    turn = random_turn(d, mesh, 3)
    space = 2 if d == 3 else 3
    rotation = plane_rotation(np.asarray(0.4)) if d == 3 else rotation_from_vector(np.array([0.3, -0.2, 0.9]))
    angle = np.asarray(0.4) if d == 3 else None
    there = march(mesh, turn, np.arange(float(space)), rotation, angle)
    last = None if there.angle is None else there.angle[-1]
    back = march(mesh, turn, there.position[-1], there.rotation[-1], last, end="right")
    np.testing.assert_allclose(back.position, there.position, rtol=0, atol=3e-14)
    np.testing.assert_allclose(back.rotation, there.rotation, rtol=0, atol=3e-14)
    if there.angle is not None:
        np.testing.assert_allclose(back.angle, there.angle, rtol=0, atol=1e-14)


@pytest.mark.parametrize("d", [3, 6])
@pytest.mark.parametrize("end", ["left", "right"])
def test_many_states_are_marched_as_one(d: int, end: str) -> None:
    """Leading axes of the turn and of the start are a batch: each state as if it were alone."""
    mesh, batch = make_mesh(LENGTH, 3, 2), (2, 4)
    space = 2 if d == 3 else 3
    turn = random_turn(d, mesh, 5, batch)
    rng = np.random.default_rng(6)
    position, angles = rng.normal(size=(*batch, space)), rng.normal(size=batch)
    rotation = plane_rotation(angles) if d == 3 else rotation_from_vector(rng.normal(size=(*batch, 3)))
    together = march(mesh, turn, position, rotation, angles if d == 3 else None, end)
    for i in np.ndindex(batch):
        alone = march(mesh, turn[i], position[i], rotation[i], angles[i] if d == 3 else None, end)
        np.testing.assert_allclose(together.position[i], alone.position, rtol=0, atol=1e-14)
        np.testing.assert_allclose(together.rotation[i], alone.rotation, rtol=0, atol=1e-14)
        assert (together.angle is None) == (d == 6)


@pytest.mark.parametrize("d", [3, 6])
def test_moving_the_start_moves_every_pose_with_it(d: int) -> None:
    """phi' = phi E is left-invariant: a rigid motion of the start is the same motion of the rod."""
    mesh = make_mesh(LENGTH, 4, 3)
    turn, space = random_turn(d, mesh, 7), 2 if d == 3 else 3
    G = plane_rotation(np.asarray(1.1)) if d == 3 else rotation_from_vector(np.array([1.0, -0.5, 0.3]))
    r = np.arange(1.0, space + 1)
    here = marched(mesh, turn)
    there = march(mesh, turn, r, G, np.asarray(1.1) if d == 3 else None)
    np.testing.assert_allclose(there.position, r + here.position @ G.T, rtol=0, atol=1e-14)
    np.testing.assert_allclose(there.rotation, G @ here.rotation, rtol=0, atol=1e-14)


def bent(u: float | Array) -> Array:
    """A turn that varies along the rod, (6, ...)."""
    u = np.asarray(u, dtype=float)
    one = np.ones_like(u)
    return np.stack([1 + 0.1 * u, 0.2 * np.sin(3 * u), 0.1 * one, 2 * np.cos(2 * u), u**2 - 1, 1.5 * one + u])


def quadrature_free(turn: Callable[[float], Array], length: float) -> Array:
    """The pose (4, 4) at the end by an adaptive integrator."""
    done = solve_ivp(
        lambda u, y: (y.reshape(4, 4) @ helix.hat(turn(u))).ravel(), (0.0, length), np.eye(4).ravel(),
        method="DOP853", rtol=1e-13, atol=1e-13,
    )  # fmt: skip
    return np.asarray(done.y[:, -1].reshape(4, 4))


def test_a_rod_of_varying_turn_ends_where_its_equation_says() -> None:
    """Against an adaptive Runge-Kutta integration of phi' = phi E; non-commuting rotations all along."""
    exact = quadrature_free(bent, LENGTH)
    for elements, degree in ((1, 20), (3, 10)):
        mesh = make_mesh(LENGTH, elements, degree)
        found = marched(mesh, bent(mesh.u_point))
        np.testing.assert_allclose(found.position[-1], exact[1:, 0], rtol=0, atol=1e-11)
        np.testing.assert_allclose(found.rotation[-1], exact[1:, 1:], rtol=0, atol=1e-11)


def test_a_planar_rod_in_space_stays_in_its_plane() -> None:
    """The spatial march of a planar turn agrees with the planar one, where both have converged."""
    mesh = make_mesh(LENGTH, 2, 14)
    flat = bent(mesh.u_point)[[0, 1, 5]]
    solid = np.zeros((6, len(mesh.u_point)))
    solid[[0, 1, 5]] = flat
    plane, space = marched(mesh, flat), marched(mesh, solid)
    np.testing.assert_allclose(space.position[:, :2], plane.position, rtol=0, atol=1e-13)
    np.testing.assert_array_equal(space.position[:, 2], 0)
    np.testing.assert_allclose(space.rotation[:, :2, :2], plane.rotation, rtol=0, atol=1e-13)
