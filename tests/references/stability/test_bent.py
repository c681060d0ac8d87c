"""Growths about bent states: shooting against collocation, and against what is known of straight ones."""

import numpy as np
import pytest

from tests.references.stability import bent, buckled, columns, equilibria, linear
from tests.references.stability.straight import Rod


def test_about_a_straight_column_they_are_those_of_the_straight_rod() -> None:
    """Bending as in `columns`, before and after the buckling load, and stretching beside it."""
    for load in (1.5, 3.0):
        state = bent.State(1.0, (40.0, 16.0, 1.0, 1.0, 1.0, 1.0), (1.0, 2.0, 1.0, 1.0, 1.0, 0.02),
                           (1.0, 0.0, 0.0, 0.0, 0.0, 0.0), (-load, 0.0, 0.0, 0.0, 0.0, 0.0), bent.PLANE)  # fmt: skip
        expected = linear.growths(columns.loaded(equilibria.THICK, load), 3).real
        found = bent.growths(state, 6)
        for growth in expected:
            assert np.abs(found - growth).min() < 1e-9 * abs(growth)


def test_shooting_agrees_with_collocation() -> None:
    """The leading growths of a column bent far over."""
    _, state = equilibria.column(3.5)
    for growth in bent.growths(state, 2):
        assert bent.refined(state, growth) == pytest.approx(growth, rel=1e-9)


def test_next_to_the_pitchfork_the_buckled_rod_recovers_twice_as_fast_as_the_straight_one_leaves() -> None:
    """The growth at a distance from a pitchfork is -2 times that of the state that lost its stability."""
    load = columns.dead_load(equilibria.THICK) * 1.0005
    away = linear.leading(columns.loaded(equilibria.THICK, load)).real
    _, state = equilibria.column(load)
    assert bent.growths(state, 1)[0] == pytest.approx(-2.0 * away, rel=5e-3)


def test_on_a_falling_branch_the_buckled_rod_is_unstable() -> None:
    """A rod that snaps: its buckled states of small size, at loads below the buckling load, have a growth above 0."""
    rod = Rod(1.0, 12.0, 400.0, 1.0, 2.0, 0.02)
    assert buckled.steepness(rod) < 0.0
    # theta' at the clamp for a small angle: the expansion of `buckled` the other way round
    load = columns.dead_load(rod) * (1.0 - 1e-3)
    rise = (buckled.steepness(rod) * -1e-3 * columns.dead_load(rod)) ** 0.5
    tip = buckled.shot(rod, load, buckled.Tip(0.0, rise, 0.0, rise * load / rod.bend), 0.2)
    state = bent.State(1.0, (12.0, 400.0, 1.0, 1.0, 1.0, 1.0), (1.0, 2.0, 1.0, 1.0, 1.0, 0.02),
                       (1.0, 0.0, 0.0, 0.0, 0.0, 0.0), (-load, 0.0, 0.0, 0.0, 0.0, tip.bend), bent.PLANE)  # fmt: skip
    assert bent.growths(state, 1)[0] > 0.0
