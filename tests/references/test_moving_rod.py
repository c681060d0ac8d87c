"""The moving spatial rod: at rest, in the plane, and its derivatives."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.references import moving_rod, relaxing_cantilever, static_rod
from tests.references.derivatives import assert_derivatives
from tests.references.moving_rod import Collocation, Rod, conjugate, product, rotated, solve

STIFFNESS = np.diag([60.0, 40.0, 30.0, 0.8, 1.2, 1.0])
STIFFNESS[3, 5] = STIFFNESS[5, 3] = 0.3
FRICTION = np.diag([1.0, 2.0, 1.8, 0.01, 0.006, 0.008])
FRICTION[0, 3] = FRICTION[3, 0] = 0.05
REFERENCE = np.array([1.05, 0.02, -0.01, 0.6, 0.2, 1.1])
BASE = Rotation.from_rotvec([0.3, -0.5, 0.8]).as_matrix()
ROD = Rod(
    length=1.2,
    stiffness=STIFFNESS,
    friction=FRICTION,
    reference=REFERENCE,
    start=lambda u: REFERENCE + 0.2 * np.sin(u) * np.array([0.1, -0.2, 0.1, 1.0, -1.0, 2.0]),
    force=lambda t: (0.5, 0.4, -0.3),
    weight=(0.1, 0.2, -0.6),
    position=(0.1, 0.2, 0.3),
    rotation=BASE,
)


def test_quaternions_turn_vectors_as_scipy_does() -> None:
    """Also such as have a length; the inverse turns back."""
    rng = np.random.default_rng(1)
    q, x = rng.normal(size=(5, 4)), rng.normal(size=(5, 3))
    expected = Rotation.from_quat(np.roll(q, -1, axis=1)).apply(x)
    np.testing.assert_allclose(rotated(q, x), expected, atol=1e-14)
    np.testing.assert_allclose(rotated(conjugate(q), rotated(q, x)), x, atol=1e-14)
    both = product(q, q[::-1])
    np.testing.assert_allclose(rotated(both, x), rotated(q, rotated(q[::-1], x)), atol=1e-13)


def test_the_start_has_the_given_turn() -> None:
    """Marched from the clamp, differentiated at the points."""
    equations = Collocation(ROD, 20)
    shape = equations.shape(equations.begin())
    np.testing.assert_allclose(shape.turn, [ROD.start(u) for u in shape.u], atol=1e-10)
    np.testing.assert_allclose(shape.position[0], ROD.position)
    np.testing.assert_allclose(shape.rotation[0], BASE, atol=1e-15)


def test_an_equilibrium_does_not_move() -> None:
    """The rod that shooting finds has no rates and meets the conditions at the free end: all couplings, all loads."""
    static = static_rod.solve(
        static_rod.Rod(
            1.2, STIFFNESS, REFERENCE, tip_force=ROD.force(0.0), weight=ROD.weight,
            base_position=ROD.position, base_rotation=BASE,
        )
    )  # fmt: skip
    equations = Collocation(ROD, 18)
    found = static.at(equations.u)
    q = np.roll(Rotation.from_matrix(found.rotation).as_quat(), 1, axis=1)
    q *= np.sign(np.sum(q * q[:1], axis=1, keepdims=True))
    w = found.position - found.position[0] - equations.integral @ found.rotation[:, :, 0]
    equations.clamp = q[0]
    left = equations.residual(0.0, np.concatenate([w, q], axis=1)[1:].ravel()).reshape(-1, 7)
    assert np.abs(left[:-1]).max() < 1e-6  # of rates that are 1e2 for a strain of 1 %
    assert np.abs(left[-1]).max() < 1e-9


def test_the_jacobians_are_derivatives() -> None:
    """Against central differences."""
    equations = Collocation(ROD, 6)
    assert_derivatives(equations, equations.begin(), 1e-7)


@pytest.mark.slow
def test_in_the_plane_it_is_the_relaxing_cantilever() -> None:
    """Other unknowns, another formulation, no quaternions there: the same positions to 1e-9."""
    planar = relaxing_cantilever.Rod(1.0, 1e3, 1.0, 1.0, 1e-2, lambda u: 1.5 * u - 1.5 * u**3 + 0.75 * u**4)
    spatial = Rod(
        length=1.0,
        stiffness=np.diag([1e3, 1e3, 700.0, 2.0, 3.0, 1.0]),
        friction=np.diag([1.0, 1.0, 3.0, 0.03, 0.02, 1e-2]),
        reference=np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        start=lambda u: (1.0, 0.0, 0.0, 0.0, 0.0, 1.5 * (1.0 - u) ** 2 * (1.0 + 2.0 * u)),
        force=lambda t: (0.0, 0.0, 0.0),
    )
    expected = relaxing_cantilever.solve(planar, 0.03, degree=14)
    found = solve(spatial, 0.03, degree=14)
    np.testing.assert_allclose(found.position[:, :2], expected.position, atol=1e-9)
    np.testing.assert_allclose(found.position[:, 2], 0.0, atol=1e-12)
    np.testing.assert_allclose(found.rotation[:, 1, 0], np.sin(expected.angle), atol=1e-9)


def test_too_long_steps_are_refused() -> None:
    """Newton's method says so."""
    bent = REFERENCE + np.array([0.0, 0.0, 0.0, 0.0, 0.0, 9.0])
    hard = Rod(1.0, STIFFNESS, FRICTION, REFERENCE, lambda u: bent, lambda t: (0.0, 0.0, 9.0))
    with np.errstate(all="ignore"), pytest.raises(ArithmeticError, match="expected shorter time steps"):
        moving_rod.solve(hard, 5.0, degree=6, first=1.0, longest=1.0)
