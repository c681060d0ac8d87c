"""Small motions about the straight rod at rest, against linear equations written down by hand."""

from __future__ import annotations

from collections.abc import Mapping

import pytest
import sympy as sp

from geocosserat.derivation.elimination import put_in
from geocosserat.derivation.equations import derive
from geocosserat.derivation.forms import document
from geocosserat.derivation.limit import LimitEquations, limit
from geocosserat.derivation.notation import T, U, fields, symbol
from geocosserat.derivation.printing import to_text
from geocosserat.derivation.records import Equations
from geocosserat.derivation.small import small_motion
from geocosserat.model.effects.weight import Weight
from geocosserat.model.records import End, RodModel
from tests.derivation.scenes import FROZEN, diagonal, limited, number, planar, same, spatial, vector

SCENES = pytest.mark.parametrize("name", FROZEN)
k1, k2, k3, k4, g1, g2, g3, g4 = (
    symbol(name) for name in ("k1", "k2", "k3", "k4", "gamma1", "gamma2", "gamma3", "gamma4")
)
theta, h1, h2, F1 = fields(("theta", "h1", "h2", "F1"))


def small(model: RodModel) -> dict[str, sp.Expr]:
    """The linear rows as right - left, by what they fix."""
    limits = limit(derive(model))
    found = small_motion(limits)
    assert found is not None
    return {f.func.__name__: -e.residual for f, e in zip(limits.fixes, found.rows, strict=True)}


def test_small_motions_of_the_euler_bernoulli_rod() -> None:
    """g2 theta_t = -k3 theta'''' and no tension from itself; friction of rotation adds g3 theta_t'' on the left.

    By hand, to first order: F2 = g3 theta_t - k3 theta'', v2 = F2'/g2, theta_t = v2', and F1'' = 0.
    """
    for spin, c in ((0, sp.S.Zero), ("gamma3", g3)):
        rows = small(planar(frozen=("h1", "h2"), friction=diagonal("gamma1", "gamma2", spin)))
        assert same(rows["F1"], F1.diff(U, 2) / g1)
        F2 = c * theta.diff(T) - k3 * theta.diff(U, 2)
        assert same(rows["theta"], F2.diff(U, 2) / g2 - theta.diff(T))


def test_small_motions_of_the_timoshenko_rod() -> None:
    """h2_t = (k2 h2)''/g2 - theta_t and g3 theta_t = k3 theta'' + k2 h2, tension apart."""
    rows = small(planar(frozen=("h1",)))
    assert same(rows["h2"], k2 * h2.diff(U, 2) / g2 - theta.diff(T) - h2.diff(T))
    assert same(rows["theta"], k3 * theta.diff(U, 2) + k2 * h2 - g3 * theta.diff(T))
    assert same(rows["F1"], F1.diff(U, 2) / g1)


def test_small_motions_of_the_extensible_rod_are_stretch_and_bend_apart() -> None:
    """g1 h1_t = k1 h1'' and the bend of the Euler-Bernoulli rod."""
    rows = small(planar(frozen=("h2",), friction=diagonal("gamma1", "gamma2", 0)))
    assert same(rows["h1"], k1 * h1.diff(U, 2) / g1 - h1.diff(T))
    assert same(rows["theta"], -k3 * theta.diff(U, 4) / g2 - theta.diff(T))


def test_small_motions_of_the_kirchhoff_rod() -> None:
    """Twist diffuses; a bend goes with a force: g4 Omega3 = (k4 + 1) Pi3' + F2, F2''/g2 = Omega3, Pi3_t = Omega3'."""
    rows = small(spatial(frozen=("h1", "h2", "h3")))
    Pi1, Pi2, Pi3, F2, F3 = fields(("Pi1", "Pi2", "Pi3", "F2", "F3"))
    Omega3, Omega2 = ((k4 + 1) * Pi3.diff(U) + F2) / g4, (k4 * Pi2.diff(U) - F3) / g4
    assert same(rows["Pi1"], k3 * Pi1.diff(U, 2) / g3 - Pi1.diff(T))
    assert same(rows["Pi3"], Omega3.diff(U) - Pi3.diff(T))
    assert same(rows["Pi2"], Omega2.diff(U) - Pi2.diff(T))
    assert same(rows["F2"], F2.diff(U, 2) / g2 - Omega3)
    assert same(rows["F3"], F3.diff(U, 2) / g2 + Omega2)


def is_the_slope(limits: LimitEquations) -> bool:
    """Whether residuals at a distance of 1e-20 from rest, over it, are the linear ones up to 1e-15."""
    found = small_motion(limits)
    assert found is not None
    size = sp.Rational(1, 10**20)
    rest = {f: sp.S.One if f == h1 else sp.S.Zero for f in limits.unknowns}
    near = {f: x + size * f for f, x in rest.items()}
    away = {f: x + f for f, x in rest.items()}

    def at(rows: Equations, place: Mapping[sp.Expr, sp.Expr]) -> list[sp.Expr]:
        return [number(put_in(e.residual, place), 9) for e in rows]

    pairs = zip(at(limits.rows, near), at(found.rows, away), strict=True)
    return all(abs(a / size - b) < sp.Float("1e-15") * (1 + abs(b)) for a, b in pairs)


@SCENES
def test_small_motions_are_the_slope_of_the_limit_at_rest(name: str) -> None:
    """Nothing is left out and nothing added by the expansion."""
    assert is_the_slope(limited(name))


def test_small_motions_where_stretch_and_shear_are_coupled() -> None:
    """The stretch enters squared then, and its slope is twice the distance."""
    stiffness = (vector("k1", "a", 0), vector("a", "k2", 0), vector(0, 0, "k3"))
    limits = limit(derive(planar(frozen=("Pi",), stiffness=stiffness)))
    assert any(e.right.has(h1**2) for e in limits.rows)
    assert is_the_slope(limits)


@pytest.mark.parametrize(
    "change",
    [
        {"effects": (Weight(vector(0, "-wa")),)},
        {"reference": vector(1, 0, "a")},
        {"reference": vector("1 + a*t", 0, 0)},
        {"right": End("free", force=vector("-a", 0))},
    ],
    ids=["weight", "curved", "moving", "loaded"],
)
def test_there_are_no_small_motions_about_a_rod_that_is_not_straight_and_free(change: dict[str, object]) -> None:
    """Then only the nonlinear equations are printed, and it is said why."""
    equations = derive(planar(frozen=("h1", "h2"), **change))
    assert small_motion(limit(equations)) is None
    text = to_text(document(equations, "limit"))
    assert "none are printed, because" in " ".join(text.split())
    assert "Small motions\n" not in text


def test_the_drive_of_an_end_is_small_too() -> None:
    """The linear conditions keep the twist that drives."""
    limits = limit(derive(planar(frozen=("h1", "h2"), left=End("driven", twist=vector(0, 0, "a*cos(t)")))))
    found = small_motion(limits)
    assert found is not None
    assert [e.right for e in found.left.equations] == [0, 0, symbol("a") * sp.cos(T)]
