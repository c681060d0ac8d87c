"""Normal forms: what is found dependent, and what an unknown means."""

from __future__ import annotations

from fractions import Fraction

import pytest
import sympy as sp

from geocosserat.derivation.notation import symbol
from geocosserat.passivity.independent import Basis
from geocosserat.passivity.normal import normal_forms
from geocosserat.passivity.polynomials import NoForm

x, y = symbol("x"), symbol("y")


def test_dependent_vectors_are_expressed_by_the_others() -> None:
    """With rational coefficients; None for an independent one."""
    basis = Basis([{"x": Fraction(1), "1": Fraction(-1)}, {"x": Fraction(1), "y": Fraction(2)}])
    assert basis.express({"y": Fraction(4), "1": Fraction(2)}) == [(0, -2), (1, 2)]
    assert basis.express({"z": Fraction(1)}) is None
    assert basis.express({}) == []


def test_arguments_that_are_multiples_share_their_unknowns() -> None:
    """cos(x/2), sin(x), exp(x/3) and exp(x/2) need one pair and one exponential."""
    tower, _ = normal_forms([sp.cos(x / 2) + sp.sin(x) + sp.exp(x / 3) + sp.exp(x / 2)])
    assert sorted(map(str, tower.meaning)) == ["cos(x/2)", "exp(x/6)", "sin(x/2)", "x"]


@pytest.mark.parametrize(
    "e",
    [
        sp.tanh(2 * x) / (1 + sp.cosh(x) ** 2), sp.sqrt(1 + x**2) * sp.sin(3 * x + y), sp.log(x**2 + 1) ** 2 / x,
        sp.Abs(x - 1) * sp.exp(-x / 2), (x**2 + 1) ** sp.Rational(2, 3), sp.Heaviside(x - y) * x, sp.pi * sp.tan(x),
    ],
)  # fmt: skip
def test_a_normal_form_is_the_function(e: sp.Expr) -> None:
    """What its unknowns mean, put back, has the same values."""
    tower, [(top, bottom)] = normal_forms([e])
    back = tower.expression(top) / tower.expression(bottom)
    for at in ({x: 0.7, y: 1.9}, {x: 1.6, y: 0.3}):
        assert float(back.subs(at)) == pytest.approx(float(e.subs(at)), rel=1e-12)


@pytest.mark.parametrize("e", [sp.exp(1000 * x) + sp.exp(x), 1 / (sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1), x**1000])
def test_bounds_are_kept(e: sp.Expr) -> None:
    """No form rather than one of any size."""
    with pytest.raises(NoForm):
        normal_forms([e])
