"""The rod on which anything acts: a clamped one under weight, one that slides along itself, one that is carried."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.references import acted_rod, moving_rod, sliding_helix
from tests.references.acted_rod import Collocation, End, Rod
from tests.references.derivatives import assert_derivatives
from tests.references.moving_rod import rotated

STIFFNESS, FRICTION = np.diag([60.0, 50.0, 40.0, 0.9, 1.2, 1.0]), np.diag([1.5, 2.0, 1.8, 0.03, 0.02, 0.025])
ROD = Rod(
    length=1.2,
    stiffness=STIFFNESS,
    friction=FRICTION,
    reference=np.array([1.0, 0.0, 0.0, 1.0, 0.3, 2.0]),
    position=(0.1, 0.2, 0.3),
    rotation=Rotation.from_rotvec([0.3, -0.5, 0.8]).as_matrix(),
)


def test_clamped_and_free_it_is_the_moving_rod() -> None:
    """Under a dead force that comes on gently: the same places and frames to 1e-10."""

    def force(t: float) -> np.ndarray:
        return np.array([3.0, 1.0, -2.0]) * np.sin(10.0 * t) ** 2

    rod = replace(ROD, right=End("free", lambda t: np.append(force(t), np.zeros(3)), "world"))
    old = moving_rod.Rod(
        1.2, STIFFNESS, FRICTION, ROD.reference, lambda u: ROD.reference, force, (0.0, 0.0, 0.0), ROD.position,
        ROD.rotation,
    )  # fmt: skip
    found, wanted = acted_rod.solve(rod, 0.1, 14), moving_rod.solve(old, 0.1, 14, 1e-4, 1.8, 1 / 24)
    np.testing.assert_allclose(found.position, wanted.position, atol=1e-10)
    np.testing.assert_allclose(found.rotation, wanted.rotation, atol=1e-10)


def test_free_it_slides_along_itself() -> None:
    """Pushed by forces and couples fixed in it: the closed form, to 1e-9."""
    push = sliding_helix.wrench(ROD.reference, FRICTION, 1.5)
    base = np.eye(4)
    base[1:, 0], base[1:, 1:] = ROD.position, ROD.rotation
    rod = replace(ROD, left=End("free"), acting=lambda t, r, q: (rotated(q, push[:3]), rotated(q, push[3:])))
    found = acted_rod.solve(rod, 0.1)
    wanted = sliding_helix.pose(ROD.reference, found.u, 0.15, base)
    np.testing.assert_allclose(found.position, wanted[:, 1:, 0], atol=1e-9)
    np.testing.assert_allclose(found.rotation, wanted[:, 1:, 1:], atol=1e-9)


def test_free_in_a_medium_that_moves_as_a_rigid_body_it_is_carried_along() -> None:
    """A screw about an axis of the world: nothing is strained."""
    flow, spin = np.array([0.3, -0.2, 0.5]), np.array([0.0, 0.0, 2.0])
    rod = replace(
        ROD, left=End("free"), acting=lambda t, r, q: acted_rod.medium(FRICTION, q, flow + np.cross(spin, r), spin)
    )
    start, found = Collocation(rod, 14), acted_rod.solve(rod, 0.1, 14)
    first = start.shape(start.begin())
    turn = Rotation.from_rotvec(0.1 * spin)
    # what turns about the origin at spin while it drifts: r(t) = R (r0 - c) + c + along, c the axis
    axis = np.array([-flow[1], flow[0], 0.0]) / 2.0
    wanted = turn.apply(first.position - axis) + axis + [0.0, 0.0, 0.05]
    np.testing.assert_allclose(found.position, wanted, atol=1e-9)
    np.testing.assert_allclose(found.turn, np.broadcast_to(ROD.reference, found.turn.shape), atol=1e-8)


@pytest.mark.parametrize("left", ["clamped", "pinned", "free"])
@pytest.mark.parametrize("right", ["clamped", "pinned", "free"])
def test_at_rest_nothing_is_left_of_its_equations(left: str, right: str) -> None:
    """However it is held; and the Jacobians are derivatives."""
    rod = replace(ROD, left=End(left), right=End(right))  # type: ignore[arg-type]
    fine = Collocation(rod, 18)
    assert np.abs(fine.residual(0.0, fine.begin())).max() < 1e-6  # of rates that are 1e2 for a strain of 1 %
    equations = Collocation(rod, 6)
    assert_derivatives(equations, equations.begin(), 1e-6)
