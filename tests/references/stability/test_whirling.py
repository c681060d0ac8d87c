"""The onset of whirling, against the other computation of it and the published number."""

import pytest

from tests.references import whirl
from tests.references.stability import linear, whirling
from tests.references.stability.straight import Rod
from tests.references.stability.table import value


def test_the_series_agrees_with_collocation_of_other_variables() -> None:
    """Force and moment of `whirl`, there integrated from tip to base, give the same threshold: to 1e-9."""
    rod = Rod(1.3, 50.0, 30.0, 1.2, 0.7, 0.05)
    other = whirl.threshold(whirl.Rod(1.3, 30.0, 1.2, 0.7, 0.02, 0.05, 0.0))
    found = linear.flutter(lambda spin: whirling.spun(rod, 0.02, spin), *other)
    assert found == pytest.approx(other, rel=1e-9)


def test_the_classical_threshold_is_the_published_one() -> None:
    """8.9 bend / (friction4 L^2): 8.8651; stretch has no part in it."""
    assert value("whirl_limit").value == pytest.approx(8.9, abs=0.05)
    spin, velocity = linear.flutter(lambda p: whirling.spun(Rod(k1=3.0), 1.0, p), 8.8, 22.0)
    assert spin == pytest.approx(value("whirl_limit").value, rel=1e-13)
    # whirling is seen from the world with twice the velocity at half the friction across
    assert velocity == pytest.approx(2.0 * (spin + value("whirl_limit").frequency), rel=1e-13)


def test_the_frame_of_the_base_sees_the_difference_of_velocities() -> None:
    """exp(growth t) in the world is exp((growth - i spin) t) there; of the two conjugates the positive one is given."""
    assert whirling.seen(1.0 + 3.0j, 5.0) == 1.0 + 2.0j
    assert whirling.seen(1.0 + 7.0j, 5.0) == 1.0 + 2.0j
