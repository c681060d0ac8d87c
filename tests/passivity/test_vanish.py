"""Identities are proved, differences are refuted at a point, and neither is taken for the other."""

from __future__ import annotations

from fractions import Fraction

import pytest
import sympy as sp
from flint import arb, fmpq

from geocosserat.derivation.notation import symbol
from geocosserat.passivity.balls import precision
from geocosserat.passivity.points import enclosure
from geocosserat.passivity.vanish import vanishes

x, y, a = symbol("x"), symbol("y"), symbol("a")
R = sp.Rational

IDENTITIES = {
    "pythagoras": sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1,
    "double angle": sp.cos(2 * x - 2) - 2 * sp.cos(x - 1) ** 2 + 1,
    "triple angle": sp.sin(3 * x) / sp.sin(x) - 2 * sp.cos(2 * x) - 1,
    "sum of angles": sp.sin(x + y) - sp.sin(x) * sp.cos(y) - sp.cos(x) * sp.sin(y),
    "an angle of pi": sp.sin(x + sp.pi / 3) - sp.sin(x) / 2 - sp.sqrt(3) / 2 * sp.cos(x),
    "tangent of a sum": sp.tan(x + y) - (sp.tan(x) + sp.tan(y)) / (1 - sp.tan(x) * sp.tan(y)),
    "tanh by exp": sp.tanh(x) - (sp.exp(2 * x) - 1) / (sp.exp(2 * x) + 1),
    "hyperbolic pythagoras": sp.cosh(x * y) ** 2 - sp.sinh(x * y) ** 2 - 1,
    "logarithm of a product": sp.log(x * y) - sp.log(sp.Abs(x)) - sp.log(sp.Abs(y)),
    "logarithm of a square": sp.log(x**2 + 2 * x + 1) - 2 * sp.log(x + 1),
    "logarithm of exp": sp.log(sp.cosh(x) + sp.sinh(x)) - x,
    "slope of log cosh": sp.diff(sp.log(sp.cosh(2 * x - y)), x) - 2 * sp.tanh(2 * x - y),
    "root of a product": sp.sqrt(x - 1) * sp.sqrt(x + 1) - sp.sqrt(x**2 - 1),
    "root in a quotient": x / sp.sqrt(x**2 + y**2) - x * sp.sqrt(x**2 + y**2) / (x**2 + y**2),
    "exp of a sine": sp.exp(sp.sin(x) + x) - sp.exp(x) * sp.exp(sp.sin(x)),
    "an open power": sp.diff(x**a, x) * x - a * x**a,
    "two sides of a step": sp.Heaviside(x) * sp.Heaviside(-x),
    "modulus of a product": sp.Abs(x * y) - sp.Abs(x) * sp.Abs(y),
    "sign": sp.sign(x * y - 1) * (x * y - 1) - sp.Abs(x * y - 1),
    "rational": 1 / (1 + x) + x / (1 + x) - 1 + (x**2 - y**2) / (x - y) - x - y,
}


@pytest.mark.parametrize("name", IDENTITIES)
def test_identities_are_proved(name: str) -> None:
    """By a normal form, not by digits."""
    answer = vanishes([IDENTITIES[name]])
    assert (answer.value, answer.grade) == (True, "proved"), answer.how


@pytest.mark.parametrize("name", IDENTITIES)
@pytest.mark.parametrize("defect", [R(1, 10**3) * x, R(1, 10**40) * (1 + y**2), R(1, 10**300)])
def test_identities_with_a_defect_are_refuted_at_a_point_where_it_shows(name: str, defect: sp.Expr) -> None:
    """However small it is; the point is given, and Arb's enclosure there keeps off zero."""
    e = IDENTITIES[name] + defect
    answer = vanishes([sp.S.Zero, e])
    assert (answer.value, answer.grade, answer.entry) == (False, "proved", 1)
    assert answer.point is not None
    assert all(isinstance(v, Fraction) for v in answer.point.values())
    with precision(2048):
        from_point = {n: arb(fmpq(v.numerator, v.denominator)) for n, v in answer.point.items()}
        assert not enclosure(e, from_point, {}).contains(0)


def test_what_has_no_normal_form_is_only_probable() -> None:
    """Nested roots: true, and not proved."""
    answer = vanishes([sp.sqrt(5 + 2 * sp.sqrt(6)) - sp.sqrt(2) - sp.sqrt(3)])
    assert (answer.value, answer.grade) == (True, "probable")
    assert "digits at 6 random points" in answer.how


def test_what_is_nowhere_defined_is_not_decided() -> None:
    """One over an identical zero, a logarithm of what is below zero."""
    assert vanishes([1 / (sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1)]).value is None
    nowhere = sp.log(-1 - x**2)
    assert vanishes([nowhere - nowhere * sp.cos(y) ** 2 - nowhere * sp.sin(y) ** 2]).value is None


def test_signs_of_symbols_are_used_only_where_they_are_given() -> None:
    """sqrt(x**2 y) = x sqrt(y) for x > 0, not for all x."""
    e = sp.sqrt(x**2 * y) - x * sp.sqrt(y)
    assert vanishes([e], positive=("x", "y")).value is True
    assert vanishes([e]).value is False


def test_a_branch_that_is_far_away_is_seen() -> None:
    """A function that is zero up to 5 000 and then is not."""
    answer = vanishes([sp.Heaviside(x - 5000) * y])
    assert answer.value is False
    assert answer.point is not None
    assert answer.point["x"] > 5000


def test_an_interval_keeps_points_out_of_other_branches() -> None:
    """Within -1 < x < 1 the step at 2 is not met: not refuted, and not called probable either."""
    answer = vanishes([sp.Heaviside(x - 2) * y], within={"x": (Fraction(-1), Fraction(1))})
    assert answer.value is None


def test_unknown_functions_are_refused() -> None:
    """A function without rule is an error, not an answer."""
    with pytest.raises(TypeError, match="known kinds"):
        vanishes([sp.Function("f")(x)])
