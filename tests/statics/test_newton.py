"""Newton's method and relaxation, on systems whose states of rest are known."""

from __future__ import annotations

import numpy as np
import pytest

from geocosserat.kernel.contract import Array
from geocosserat.statics.find import find
from geocosserat.statics.newton import NotAtRest, newton, relax
from tests.statics.systems import system


def pull(y: Array) -> Array:
    """Towards 2 by an odd force that hardly grows: without cutting its steps Newton's method flies off from afar."""
    return -np.arctan(3 * (y - 2.0))


def two_wells(y: Array) -> Array:
    """Rests at -1 and 1, and on the top between them at 0."""
    return y - y**3


@pytest.mark.parametrize("start", [1.9, -5.0, 40.0])
def test_newton_reaches_the_rest_from_near_and_far(start: float) -> None:
    """To round-off; the whole step alone would diverge from the last two."""
    rest = newton(system(pull, [start]), np.array([start]), most=100)
    assert rest.x[0] == pytest.approx(2.0, abs=1e-14)
    assert rest.left < 1e-13


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_scales_do_not_change_the_rest(scale: float) -> None:
    """Entries in other units lead to the same state."""
    rest = newton(system(lambda y: pull(y / scale) * scale, [1.5 * scale], scale), np.array([1.5]))
    assert rest.x[0] == pytest.approx(2.0, abs=1e-13)


def test_newton_says_so_where_there_is_no_rest() -> None:
    """A force that never vanishes."""
    with pytest.raises(NotAtRest, match=r"nearer to rest|still takes steps"):
        newton(system(lambda y: 1.0 + y**2, [0.3]), np.array([0.3]))


def test_a_force_to_which_nothing_gives_way_is_no_rest() -> None:
    """A constant one: no step takes it away, and none is told to be left."""
    with pytest.raises(NotAtRest, match="nothing gives way"):
        newton(system(lambda y: 0.0 * y + 1.0, [0.3]), np.array([0.3]))


def test_relaxation_leads_to_a_stable_rest_where_newton_stays_on_the_top() -> None:
    """From beside the top of a hill Newton's method climbs it, a rod runs down."""
    hill = system(two_wells, [0.1])
    assert abs(newton(hill, hill.x).x[0]) < 1e-12
    assert relax(hill, hill.x).x[0] == pytest.approx(1.0, abs=1e-12)


def test_a_motion_that_nothing_resists_is_left_alone() -> None:
    """The force depends on x - y alone: of all rests the nearest is found."""
    tied = system(lambda y: np.array([1.0 - y[0] + y[1], y[0] - y[1] - 1.0]), [3.0, 1.0])
    rest = newton(tied, tied.x)
    assert rest.x == pytest.approx([2.5, 1.5], abs=1e-12)


def test_find_tries_one_way_after_the_other_and_tells_what_each_met() -> None:
    """All three are named."""
    none = system(lambda y: 1.0 + y**2, [0.3])
    with pytest.raises(NotAtRest, match=r"at once: .*; relaxing: .*; eased: "):
        find(none, none.x)


def test_numbers_that_are_not_finite_are_no_rest() -> None:
    """They end the search with a reason."""
    with pytest.raises(NotAtRest, match="not finite"):
        newton(system(lambda y: y * np.nan, [1.0]), np.array([1.0]))
