"""Growth rates against closed forms, where the matrix of drag is singular too."""

from __future__ import annotations

import numpy as np
import pytest

from geocosserat.statics.pencil import growth


def test_growth_rates_of_a_chain_are_those_of_the_closed_form() -> None:
    """-4 k sin^2(j pi / (2 (n + 1))), the least one to round-off though the largest is ten million times as large."""
    n, k = 200, 1e4
    K = -k * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    found, motions = growth(K, np.eye(n), 1.0)
    expected = -4 * k * np.sin(np.arange(1, n + 1) * np.pi / (2 * (n + 1))) ** 2
    assert found.real[:5] == pytest.approx(expected[:5], rel=1e-12)
    assert np.abs(found.imag).max() < 1e-6
    assert K @ motions[:, 0] == pytest.approx(found[0] * motions[:, 0], abs=1e-9 * k)


def test_what_has_no_drag_has_no_rate() -> None:
    """x' = -3 x + y with 0 = x - 2 y: one rate, -2.5; a constraint with a multiplier adds none either."""
    K = np.array([[-3.0, 1.0], [1.0, -2.0]])
    found, motions = growth(K, np.diag([1.0, 0.0]), 1.0)
    assert found == pytest.approx([-2.5], rel=1e-14)
    assert motions[1, 0] / motions[0, 0] == pytest.approx(0.5)
    held = np.array([[-1.0, 0.0, 1.0], [0.0, -5.0, 1.0], [1.0, 1.0, 0.0]])  # x + y = 0
    assert growth(held, np.diag([1.0, 1.0, 0.0]), 1.0)[0] == pytest.approx([-3.0], rel=1e-12)


def test_pairs_and_order() -> None:
    """The fastest growing first; of a pair the one with positive frequency."""
    found, _ = growth(np.array([[0.5, -2.0, 0.0], [2.0, 0.5, 0.0], [0.0, 0.0, -1.0]]), np.eye(3), 0.1)
    assert found == pytest.approx([0.5 + 2j, 0.5 - 2j, -1.0])


def test_a_rate_that_vanishes_is_found_as_zero() -> None:
    """To round-off of the slowest rate, not of the fastest."""
    found, _ = growth(np.diag([0.0, -1.0, -1e10]), np.eye(3), 1.0)
    assert abs(found[0]) < 1e-13
