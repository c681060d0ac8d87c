"""Fields and loops of configurations against the group's own matrices."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.derivation.notation import symbol
from geocosserat.model.expressions import evaluate
from geocosserat.model.law import pose_names
from geocosserat.passivity.configuration import ConfigurationLoop, Swing, along_fields, cayley, free
from geocosserat.passivity.vanish import vanishes

LOOPS = [
    ConfigurationLoop(SE2, (Swing(0.3, 1.0), Swing(-0.2, 0.0, 0.7), Swing(0.4, turns=1)), "turning circle"),
    ConfigurationLoop(SE2, (Swing(0.3), Swing(0.1, 0.5), Swing(0.4, sine=0.8)), "swing"),
    ConfigurationLoop(
        SE3,
        (Swing(1, 1), Swing(0, 0, 0.5), Swing(), Swing(0, 0, 1), Swing(0.3), Swing(0, 0, 0, 1)),
        "circle and turns",
    ),
    ConfigurationLoop(
        SE3,
        (Swing(0.2), Swing(0.1, 0.4, 0.3), Swing(0, 1), Swing(0.2, turns=-1), Swing(0.1, 0.4), Swing(0.2, 0.1, 0.9)),
        "everything",
    ),
]


def matrix(loop: ConfigurationLoop, t: float) -> np.ndarray:
    """The configuration at a time."""
    p = {name: float(evaluate(e, {"t": t})) for name, e in loop.pose.items()}
    if loop.group is SE2:
        c, s = np.cos(p["theta"]), np.sin(p["theta"])
        return SE2.pose(np.array([p["x"], p["y"]]), np.array([[c, -s], [s, c]]))
    rotation = np.array([[p[f"e{i}{axis}"] for i in (1, 2, 3)] for axis in "xyz"])
    return SE3.pose(np.array([p["x"], p["y"], p["z"]]), rotation)


@pytest.mark.parametrize("group", [SE2, SE3], ids=lambda g: g.name)
def test_the_fields_of_named_configurations_have_the_groups_commutators(group: Group) -> None:
    """[X_a, X_b] = C_abc X_c on every name of a configuration, proved."""
    d, C = group.dimension, group.structure
    for name in pose_names(group):
        first = along_fields(group, symbol(name))
        second = [along_fields(group, f) for f in first]
        off = [
            free(group, second[b][a] - second[a][b] - sum(int(C[a, b, c]) * first[c] for c in range(d)))
            for a in range(d)
            for b in range(a)
        ]
        assert vanishes(off).value is True


@pytest.mark.parametrize("loop", LOOPS, ids=lambda loop: f"{loop.group.name} {loop.words}")
def test_the_twist_of_a_loop_is_its_rate_in_the_moving_frame(loop: ConfigurationLoop) -> None:
    """V = g^-1 dg/dt by differences of fourth order."""
    h = 1e-3
    for t in (0.0, 0.137, 0.61, 0.93):
        g = [matrix(loop, t + k * h) for k in (-2, -1, 1, 2)]
        rate = (g[0] - 8 * g[1] + 8 * g[2] - g[3]) / (12 * h)
        expected = loop.group.vee(np.linalg.inv(matrix(loop, t)) @ rate)
        twist = [evaluate(e, {"t": t}) for e in loop.twist]
        np.testing.assert_allclose(twist, expected, atol=2e-7)


@pytest.mark.parametrize("loop", LOOPS, ids=lambda loop: f"{loop.group.name} {loop.words}")
def test_loops_close(loop: ConfigurationLoop) -> None:
    """After one period the body is back where it was, and its frame is orthonormal all the way."""
    np.testing.assert_allclose(matrix(loop, 1.0), matrix(loop, 0.0), atol=1e-14)
    rotation = loop.group.rotation(matrix(loop, 0.37))
    np.testing.assert_allclose(rotation.T @ rotation, np.eye(loop.group.space), atol=1e-14)
    assert np.linalg.det(rotation) == pytest.approx(1.0)


def test_backwards_is_the_same_way_the_other_way_round() -> None:
    """The swing backwards at t is the swing at 1 - t, up to whole turns."""
    swing = Swing(0.3, 0.5, -0.7, 2)
    for t in (0.1, 0.45, 0.8):
        there = evaluate(swing.value, {"t": 1 - t}) - 4 * np.pi
        assert evaluate(swing.backwards.value, {"t": t}) == pytest.approx(there)
        later = evaluate(swing.value, {"t": t + 0.5}) - 2 * np.pi
        assert evaluate(swing.later.value, {"t": t}) == pytest.approx(later)


def test_cayleys_rotations_are_rotations() -> None:
    """R^T R = 1 and det R = 1 in rational numbers."""
    rotation = cayley(SE3, [Fraction(1, 3), Fraction(-2, 5), Fraction(7, 2)])
    assert ((rotation.T @ rotation) == np.eye(3, dtype=int)).all()
    a, b, c = rotation
    cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]]
    assert sum(x * y for x, y in zip(a, cross, strict=True)) == 1
