"""Buckling loads of columns: closed forms, the determinant of the linear problem, and Euler's limit."""

import math
from dataclasses import replace
from typing import Any

import pytest

from tests.references.stability import columns, linear
from tests.references.stability.columns import WAVES, Ends
from tests.references.stability.straight import Rod

SOFT = Rod(1.3, 25.0, 9.0, 1.2, 2.0, 0.05)
ENDS: list[Ends] = ["pinned", "clamped"]


@pytest.mark.parametrize("rod", [SOFT, replace(SOFT, k1=math.inf), replace(SOFT, k2=math.inf)])
def test_the_dead_load_is_a_zero_of_the_determinant(rod: Rod) -> None:
    """The quadratic equation for the load agrees with the series solution of the four equations."""
    load = columns.dead_load(rod)
    assert linear.divergence(lambda p: columns.loaded(rod, p), 1.01 * load) == pytest.approx(load, rel=1e-14)


@pytest.mark.parametrize("ends", ENDS)
def test_the_growth_is_a_zero_of_the_determinant(ends: Ends) -> None:
    """Both ends in place: the same, and the first along the way, those with a force across included."""
    stretch = columns.growth(SOFT, ends)

    def family(g: Any) -> linear.Problem:
        return columns.grown(SOFT, g, ends)

    assert linear.divergence(family, stretch * 1.001) == pytest.approx(stretch, rel=1e-14)
    assert linear.loss(family, [1.0, 2.0 * stretch - 1.0])[0] == pytest.approx(stretch, rel=1e-9)


def test_stiff_columns_buckle_at_eulers_loads() -> None:
    """pi^2 / 4, pi^2 and 4 pi^2, in units of k3 / L^2."""
    thin = Rod(2.0, math.inf, math.inf, 3.0)
    unit = math.pi**2 * 3.0 / 4.0
    assert columns.dead_load(thin) == pytest.approx(unit / 4.0, rel=1e-15)
    for ends in ENDS:
        load = 1e12 * (columns.growth(replace(thin, k1=1e12), ends) - 1.0)
        assert load == pytest.approx(unit * WAVES[ends] ** 2, rel=1e-4)


def test_shear_lowers_the_load_as_haringx_says_and_equal_stretch_undoes_it() -> None:
    """P = (k2 / 2) (sqrt(1 + 4 P_E / k2) - 1) without stretch; Euler's load if k1 = k2."""
    euler = columns.dead_load(replace(SOFT, k1=math.inf, k2=math.inf))
    haringx = 4.5 * (math.sqrt(1.0 + 4.0 * euler / 9.0) - 1.0)
    assert columns.dead_load(replace(SOFT, k1=math.inf)) == pytest.approx(haringx, rel=1e-14)
    assert columns.dead_load(replace(SOFT, k1=9.0)) == pytest.approx(euler, rel=1e-14)


def test_a_rod_that_shortens_too_fast_does_not_buckle() -> None:
    """Without shear, and k1 < 4 P_E, no load does it."""
    with pytest.raises(ValueError, match="shortened"):
        columns.dead_load(Rod(1.0, 9.0, math.inf))
    assert columns.dead_load(Rod(1.0, 10.0, math.inf)) > 0.25 * math.pi**2
