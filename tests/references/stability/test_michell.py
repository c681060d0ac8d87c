"""Twisted rings: Michell's number, joined and held rings, and what shear does."""

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.references import ring as planar
from tests.references.stability import linear, michell
from tests.references.stability.table import RING, THIN_RING, value


@pytest.mark.parametrize("n", [2, 3, 4])
def test_the_thin_straight_rod_has_michells_number(n: int) -> None:
    """2 pi sqrt(n^2 - 1) bend / k4, a zero of the determinant without growth; stretch and shear vanishing."""
    exact = michell.classical(n, 1.0, 0.8)
    assert michell.critical(THIN_RING, n, 1.001 * exact) == pytest.approx(exact, rel=1e-12)
    stiff = replace(THIN_RING, stiffness=(1e7, 1e7, 1e7, 0.8, 1.0, 1.0))
    assert michell.critical(stiff, n, exact) == pytest.approx(exact, rel=1e-4)


@pytest.mark.parametrize(("name", "ring"), [("ring", RING), ("ring_limit", THIN_RING)])
def test_the_table_has_the_leading_growths_of_joined_rings(name: str, ring: michell.Ring) -> None:
    """Of all n up to 4, besides the rigid motions; and the value is where two waves are neutral."""
    entry = value(name)
    assert michell.critical(ring, 2, entry.value * 1.001) == pytest.approx(entry.value, rel=1e-12)
    for twist, expected in entry.growths:
        found = np.concatenate([michell.growths(ring, twist, n) for n in range(5)])
        moving = found[np.abs(found) > 1e-3]
        estimate = moving[np.argmax(moving.real)]
        assert michell.refined(ring, twist, 2, estimate) == pytest.approx(expected, rel=1e-11)
        still = sum(int(np.sum(np.abs(michell.growths(ring, twist, n)) < 1e-3)) for n in (-1, 0, 1))
        assert still == 6 + entry.zeros


def test_the_ring_is_in_balance() -> None:
    """ad*_E Sigma = 0 and the ring closes: no pitch, one turn."""
    for twist in (3.0, 11.0):
        turn, stress = michell.state(RING, twist)
        _, coad, _ = michell.blocks(turn, stress)
        assert np.abs((coad @ stress).astype(float)).max() < 1e-11
        assert turn[:3] @ turn[3:] == pytest.approx(0.0, abs=1e-14)
        assert np.hypot(turn[3], turn[5]) == pytest.approx(2.0 * math.pi)
        np.testing.assert_allclose(stress[:3], np.array(RING.stiffness[:3]) * (turn[:3] - [1.0, 0.0, 0.0]), atol=1e-11)


def test_held_where_it_closes_it_buckles_at_the_same_twist() -> None:
    """By collocation of the ring clamped at both ends, independently of any waves: decay before, growth after."""
    critical = value("ring").value
    assert value("ring_held").value == critical
    before, after = (
        linear.growths(michell.held(RING, critical * (1.0 + shift)), 2, degree=18) for shift in (-1e-4, 1e-4)
    )
    assert before.real.max() < 0.0
    assert after.real.min() > 0.0  # two at once, as of the joined ring
    # they cross zero in proportion to the distance, so that it is nowhere else
    np.testing.assert_allclose(before.real, -after.real[::-1], rtol=1e-2)


def test_without_twist_the_growths_in_the_plane_are_those_of_the_planar_ring() -> None:
    """The rates of `ring`, by its own equations."""
    plane = planar.Ring(1.0, (2000.0, 800.0, 1.0), (1.0, 2.0, 0.02))
    for n in (2, 3):
        found = michell.growths(RING, 0.0, n)
        for rate in planar.decay_rates(plane, n)[:2]:
            assert np.abs(found + rate).min() < 1e-8 * rate
