"""Buckled columns: elliptic integrals against shooting, against the elastica, and the pitchfork they grow from."""

import math

import mpmath
import pytest

from tests.references import elastica
from tests.references.stability import buckled, columns
from tests.references.stability.straight import Rod

SHEARED = Rod(1.0, 40.0, 16.0)
SNAPPING = Rod(1.0, 12.0, 400.0)  # shortens easily, hardly shears


@pytest.mark.parametrize("rod", [SHEARED, Rod(1.4, 9.0, 5.0, 1.3), Rod(), SNAPPING])
@pytest.mark.parametrize("times", [1.1, 2.5])
def test_elliptic_integrals_agree_with_shooting(rod: Rod, times: float) -> None:
    """Place, angle and bend, to 1e-12."""
    load = times * columns.dead_load(rod)
    found = buckled.tip(rod, load)
    other = buckled.shot(rod, load, found)
    for name in ("x", "y", "angle", "bend"):
        assert getattr(found, name) == pytest.approx(getattr(other, name), abs=2e-12)


@pytest.mark.parametrize("k", [math.inf, 30.0])
def test_equally_stiff_rods_are_elasticas(k: float) -> None:
    """With k1 = k2 it is the elastica of the other module, by Jacobi's functions, shifted by its stretch."""
    shape = elastica.elliptic(elastica.Cantilever(1.0, k, 1.0, (-3.5, 0.0)), [1.0])
    found = buckled.tip(Rod(1.0, k, k), 3.5)
    assert (found.x, found.y) == pytest.approx(tuple(shape.position[0]), abs=1e-13)
    assert found.angle == pytest.approx(shape.angle[0], abs=1e-13)


def test_the_classical_table_is_met() -> None:
    """P / P_c = 1.015 ... 9.116 turn the tip by 20 ... 176 degrees (Timoshenko and Gere, table 2-4)."""
    for angle, ratio, x, y in [(20, 1.015, 0.970, 0.220), (60, 1.152, 0.741, 0.593), (120, 1.884, 0.123, 0.803)]:
        p = math.sin(math.radians(angle) / 2)
        exact = float((2 * mpmath.ellipk(p * p) / mpmath.pi) ** 2)
        assert exact == pytest.approx(ratio, abs=1.1e-3)
        found = buckled.tip(Rod(), exact * 0.25 * math.pi**2)
        assert found.angle == pytest.approx(math.radians(angle), rel=1e-12)
        assert (found.x, found.y) == pytest.approx((x, y), abs=1.1e-3)


def test_the_branches_are_mirror_images() -> None:
    """x alike, y, angle and bend of the other sign."""
    up, down = (buckled.tip(SHEARED, 3.0, side) for side in (1.0, -1.0))
    assert (down.x, down.y, down.angle, down.bend) == (up.x, -up.y, -up.angle, -up.bend)


@pytest.mark.parametrize("rod", [SHEARED, Rod(2.0, math.inf, 3.0)])
def test_the_pitchfork_opens_as_the_expansion_says(rod: Rod) -> None:
    """y^2 / (P - P_c) tends to its limit, linearly."""
    critical, limit = columns.dead_load(rod), buckled.steepness(rod)
    errors = [
        buckled.tip(rod, critical * (1.0 + step)).y ** 2 / (critical * step) / limit - 1.0 for step in (2e-4, 1e-4)
    ]
    assert abs(errors[1]) < 2e-3
    assert errors[0] == pytest.approx(2.0 * errors[1], rel=5e-3)


def test_a_rod_that_shortens_easily_snaps() -> None:
    """Its pitchfork opens downwards: at the buckling load it has a buckled state of finite size."""
    assert buckled.steepness(SNAPPING) < 0.0
    assert buckled.tip(SNAPPING, columns.dead_load(SNAPPING) * (1.0 + 1e-9)).y > 0.3
    assert buckled.steepness(SHEARED) > 0.0


def test_there_is_no_buckled_shape_below_the_load() -> None:
    """The request is refused."""
    with pytest.raises(ValueError, match="beyond"):
        buckled.tip(SHEARED, 2.0)
