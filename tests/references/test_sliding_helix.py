"""The sliding helix: both matrix equations, the balance of the whole rod, and the geometry of a screw."""

import numpy as np
import pytest

from tests.references import helix, sliding_helix
from tests.references.sliding_helix import Array

SPATIAL = np.array([1.05, 0.02, -0.03, 0.9, -0.5, 1.1])
PLANAR = np.array([0.95, 0.1, 1.3])


def _friction(size: int) -> Array:
    """Every component coupled to every other, positive definite."""
    rows = np.arange(size)
    return np.diag(1.0 + 0.3 * rows) + 0.1 * np.sin(np.add.outer(rows, rows) + 0.5)


@pytest.mark.parametrize("turn", [SPATIAL, PLANAR])
def test_its_derivatives_are_the_turn_and_the_twist(turn: Array) -> None:
    """phi' = phi E and phi_t = phi V, by central differences at an accelerating s(t) = 0.4 t + t^2."""
    base = helix.pose(np.linspace(-0.6, 0.9, len(turn)), [1.0])[0]
    step, t, u = 1e-4, 0.7, 0.3

    def at(u: float, t: float) -> Array:
        return np.asarray(sliding_helix.pose(turn, [u], 0.4 * t + t**2, base)[0])

    along = (at(u + step, t) - at(u - step, t)) / (2.0 * step)
    motion = (at(u, t + step) - at(u, t - step)) / (2.0 * step)
    twist = sliding_helix.twist(turn, 0.4 + 2.0 * t)
    np.testing.assert_allclose(along, at(u, t) @ helix.hat(turn), atol=1e-7)
    np.testing.assert_allclose(motion, at(u, t) @ helix.hat(twist), atol=1e-7)


@pytest.mark.parametrize("turn", [SPATIAL, PLANAR])
def test_the_wrench_is_the_drag_and_its_power_is_dissipated(turn: Array) -> None:
    """j = Gamma V for a full friction matrix, and for a diagonal one."""
    gamma = _friction(len(turn))
    j = sliding_helix.wrench(turn, gamma, -0.6)
    np.testing.assert_allclose(j, [-0.6 * sum(g * e for g, e in zip(row, turn, strict=True)) for row in gamma])
    np.testing.assert_allclose(sliding_helix.wrench(turn, np.arange(1.0, len(turn) + 1.0), 2.0)[1], 4.0 * turn[1])
    assert sliding_helix.power(turn, gamma, -0.6, 1.4) == pytest.approx(1.4 * 0.36 * turn @ gamma @ turn)


def test_a_uniform_stress_stays_in_balance_with_the_ends_it_needs() -> None:
    """In the world: force and moment about the origin of the end wrenches vanish, wherever the rod has slid."""
    stress = helix.uniform_stress(SPATIAL, 0.3, -0.2)
    for slid in (0.0, 2.7):
        left, right = sliding_helix.pose(SPATIAL, [0.0, 1.6], slid)
        ends = []
        for pose, sign in ((right, 1.0), (left, -1.0)):
            force, moment = sign * pose[1:, 1:] @ stress[:3], sign * pose[1:, 1:] @ stress[3:]
            ends.append(np.concatenate([force, moment + np.cross(pose[1:, 0], force)]))
        np.testing.assert_allclose(ends[0] + ends[1], 0.0, atol=1e-14)
        assert np.abs(ends[0]).max() > 0.1


def test_it_stays_on_its_own_cylinder_and_advances_by_its_pitch() -> None:
    """A slide by one turn moves every section by the pitch along the axis and leaves its frame as it was."""
    shape = helix.geometry(SPATIAL)
    turn = 2.0 * np.pi / np.linalg.norm(SPATIAL[3:])
    before, after = (sliding_helix.pose(SPATIAL, [0.2, 1.1], s) for s in (0.4, 0.4 + turn))
    np.testing.assert_allclose(after[:, 1:, 1:], before[:, 1:, 1:], atol=1e-14)
    np.testing.assert_allclose(after[:, 1:, 0] - before[:, 1:, 0], [shape.pitch * shape.axis] * 2, atol=1e-13)
