"""Growths about bent states: shooting against collocation, and against what is known of straight ones."""

import numpy as np
import pytest

from tests.references.stability import bent, buckled, columns, equilibria, linear


def test_about_a_straight_column_they_are_those_of_the_straight_rod() -> None:
    """Bending as in `columns`, before and after the buckling load, and stretching beside it."""
    for load in (1.5, 3.0):
        state = bent.State(1.0, (40.0, 16.0, 1.0, 1.0, 1.0, 1.0), (1.0, 2.0, 1.0, 1.0, 1.0, 0.02),
                           (1.0, 0.0, 0.0, 0.0, 0.0, 0.0), (-load, 0.0, 0.0, 0.0, 0.0, 0.0), bent.PLANE)  # fmt: skip
        expected = linear.growths(columns.loaded(equilibria.THICK, load), 3).real
        found = bent.growths(state, 6, degree=20)
        for growth in expected[:2]:
            assert np.abs(found - growth).min() < 1e-9 * abs(growth)


def test_shooting_agrees_with_collocation() -> None:
    """The leading growths of a column bent far over."""
    _, state = equilibria.column(3.5)
    for growth in bent.growths(state, 1, degree=20):
        assert bent.refined(state, growth) == pytest.approx(growth, rel=1e-8)


def test_next_to_the_pitchfork_the_buckled_rod_recovers_twice_as_fast_as_the_straight_one_leaves() -> None:
    """The growth at a distance from a pitchfork is -2 times that of the state that lost its stability."""
    load = columns.dead_load(equilibria.THICK) * 1.0005
    away = linear.leading(columns.loaded(equilibria.THICK, load)).real
    _, state = equilibria.column(load)
    assert bent.growths(state, 1)[0] == pytest.approx(-2.0 * away, rel=5e-3)


def test_on_a_falling_branch_the_buckled_rod_is_unstable() -> None:
    """A rod that snaps: of its buckled states below the buckling load the small ones grow, the large ones recover."""
    rod = equilibria.SNAPPING
    least, _ = buckled.fold(rod)
    for load in (least + 1e-3, 3.85):
        small, large = (equilibria.column(load, rod, small=which)[1] for which in (True, False))
        assert bent.growths(small, 1)[0] > 0.0
        assert bent.growths(large, 1)[0] < 0.0
