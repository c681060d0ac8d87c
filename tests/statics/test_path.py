"""Paths of states of rest, and where small motions begin to grow on them."""

from __future__ import annotations

import numpy as np
import pytest

from geocosserat.kernel.contract import Array
from geocosserat.statics.crossing import Looked, branches
from geocosserat.statics.newton import NotAtRest, newton
from geocosserat.statics.path import Eased, begin, follow
from geocosserat.statics.search import deflated, others
from tests.statics.systems import Varied, system


def looked(family: Varied) -> Looked:
    return Looked(family, lambda place: family.linear(place.x, place.p).spectrum(1.0), 1.0)


def snap(y: Array, p: float) -> Array:
    """A force of 0.9 - 2 p on a bar that snaps through at 0.9 - 2 p = -2 / sqrt(27)."""
    return 0.9 - 2 * p + y - y**3


def pitchfork(y: Array, p: float) -> Array:
    """Beside 0, which is stable before p = 1/3, rests at plus and minus sqrt(p - 1/3)."""
    return (p - 1 / 3) * y - y**3


def hopf(y: Array, p: float) -> Array:
    """Rests at 0, and swings with 7 radians per time from p = 0.6 on."""
    a, b = y
    return np.array([(p - 0.6) * a - 7 * b, 7 * a + (p - 0.6) * b]) - (a * a + b * b) * y


def test_a_path_goes_round_folds() -> None:
    """Of the bar that snaps: through three branches, and all its places are rests."""
    family = Varied(snap, 1)
    start = newton(family.at(0.0), np.array([1.5])).x
    places = list(follow(family, begin(family, start, 0.0, 1.0)))
    assert places[-1].p == 1.0
    assert max(abs(family.residual(place.x, place.p)[0]) for place in places) < 1e-9
    turns = np.diff(np.sign([place.onward for place in places]))
    assert np.count_nonzero(turns) == 2


def test_the_fold_is_where_the_closed_form_has_it() -> None:
    """To ten digits, as a divergence with a fold; the second one wins stability back."""
    family = Varied(snap, 1)
    start = newton(family.at(0.0), np.array([1.5])).x
    one, other = (crossing for _, crossing in looked(family).crossings(list(looked(family).path(start, 0.0))))
    assert one.spot.place.p == pytest.approx((0.9 + 2 / 27**0.5) / 2, abs=1e-10)
    assert other.spot.place.p == pytest.approx((0.9 - 2 / 27**0.5) / 2, abs=1e-10)
    assert (one.kind, one.fold, one.gains) == ("divergence", True, True)
    assert (other.fold, other.gains) == (True, False)


def test_both_branches_leave_a_pitchfork() -> None:
    """One to either side, as the root of the closed form."""
    family = Varied(pitchfork, 1)
    spots = list(looked(family).path(np.zeros(1), 0.0))
    ((_, crossing),) = looked(family).crossings(spots)
    assert crossing.spot.place.p == pytest.approx(1 / 3, abs=1e-11)
    assert not crossing.fold
    ends = []
    for place in branches(crossing):
        *_, last = looked(family).switched(place)
        assert last.place.p == 1.0
        assert last.unstable == 0
        ends.append(last.place.x[0])
    assert sorted(ends) == pytest.approx([-((2 / 3) ** 0.5), (2 / 3) ** 0.5], abs=1e-9)


def test_flutter_is_one_crossing_with_its_frequency() -> None:
    """Of a pair."""
    family = Varied(hopf, 2)
    ((_, crossing),) = looked(family).crossings(list(looked(family).path(np.zeros(2), 0.0)))
    assert crossing.kind == "flutter"
    assert crossing.spot.place.p == pytest.approx(0.6, abs=1e-10)
    assert crossing.frequency == pytest.approx(7.0, abs=1e-8)


def test_a_path_that_ends_says_where() -> None:
    """The rest sqrt(1 - 2 p) meets its mirror image and both cease to be followed where the root has no slope."""
    family = Varied(lambda y, p: np.where(p < 0.5, y - 1.0, np.nan), 1)
    with pytest.raises(NotAtRest, match=r"ends at 0\.4999"):
        list(follow(family, begin(family, np.ones(1), 0.0, 1.0)))


def test_easing_leads_from_the_start_to_a_rest() -> None:
    """What holds the start is taken away little by little."""
    bar = system(lambda y: snap(y, 0.0), [2.5])
    eased = Eased(bar, bar.residual(bar.x))
    *_, last = follow(eased, begin(eased, bar.x, 0.0, 1.0))
    assert last.p == 1.0
    assert abs(snap(last.x, 0.0)[0]) < 1e-9


def test_a_top_between_two_wells_is_found_from_one_of_them() -> None:
    """Nothing relaxes to it."""
    wells = system(lambda y: y - y**3, [1.0])
    well = newton(wells, wells.x)
    same = lambda x, y: bool(np.abs(x - y).max() < 1e-6)  # noqa: E731
    found = list(others(wells, well, lambda linear, x: linear.spectrum(0.3), same))
    assert sorted(rest.x[0] for rest in found) == pytest.approx([-1.0, 0.0], abs=1e-12)


def test_known_rests_repel_newtons_method() -> None:
    """From beside one of them it goes to another one, and when all are known nowhere."""
    wells = system(lambda y: y - y**3, [1.3])
    one = newton(wells, wells.x).x
    assert one == pytest.approx([1.0])
    other = deflated(wells, wells.x, [one]).x
    assert min(abs(other - [0.0]), abs(other - [-1.0])) < 1e-12
    third = deflated(wells, wells.x, [one, other]).x
    assert sorted([one[0], other[0], third[0]]) == pytest.approx([-1.0, 0.0, 1.0], abs=1e-12)
    with pytest.raises(NotAtRest, match="no other state"):
        deflated(wells, wells.x, [one, other, third])


def test_all_rests_of_a_plane_with_four_wells_are_found() -> None:
    """Nine: four wells, four saddles, and the top, from the top."""
    wells = system(lambda y: y - y**3, [0.0, 0.0])
    top = newton(wells, wells.x)
    same = lambda x, y: bool(np.abs(x - y).max() < 1e-6)  # noqa: E731
    found = list(others(wells, top, lambda linear, x: linear.spectrum(0.3), same))
    assert len(found) == 8
    corners = {tuple(np.round(rest.x).astype(int)) for rest in found}
    assert len(corners) == 8
    assert max(np.abs(rest.x - np.round(rest.x)).max() for rest in found) < 1e-10
