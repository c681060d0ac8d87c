"""Linearity as it is written: what counts is linear indeed, and what is not is never taken for it."""

from __future__ import annotations

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.notation import symbol
from geocosserat.model.expressions import Binary, Call, Expression, ExpressionError, Negate, Number, Symbol, parse
from geocosserat.model.linear import is_linear

RATES = ("x", "y")
NAMES = (*RATES, "a", "b")


@pytest.mark.parametrize(
    "text",
    ["3", "a**2 + sin(b)", "x", "-x", "2*x + a*y - b", "(a + b)*(x - 3*y)", "x/(1 + a**2)", "a*(b*(x + y))*2",
     "x**1", "exp(a)*x + heaviside(b)*y", "x - x", "abs(a)/b*y"],
)  # fmt: skip
def test_sums_of_single_rates_are_linear(text: str) -> None:
    """With whatever factors of the other names."""
    assert is_linear(parse(text, NAMES), RATES)


@pytest.mark.parametrize(
    "text",
    ["x*y", "x**2", "x*(1 + x)", "sin(x)", "abs(x)", "1/x", "a/(b + x)", "x**a", "a**x", "heaviside(x)*a", "x**0.5",
     "(x + 1)**2 - x**2", "x*x/x", "y*exp(-x)"],
)  # fmt: skip
def test_what_is_not_is_said_not_to_be(text: str) -> None:
    """Nor what would be, multiplied out."""
    assert not is_linear(parse(text, NAMES), RATES)


leaves: st.SearchStrategy[Expression] = st.one_of(
    st.sampled_from(NAMES).map(Symbol), st.integers(-2, 2).map(lambda n: Number(float(n)))
)
trees: st.SearchStrategy[Expression] = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.tuples(st.sampled_from("+-*/"), inner, inner).map(lambda x: Binary(*x)),
        st.tuples(inner, st.sampled_from((1.0, 2.0))).map(lambda x: Binary("**", x[0], Number(x[1]))),
        inner.map(Negate),
        inner.map(lambda e: Call("sin", e)),
    ),
    max_leaves=8,
)


@given(trees)
def test_whatever_counts_as_linear_has_no_second_derivative(e: Expression) -> None:
    """With respect to any two rates, by another algebra."""
    if not is_linear(e, RATES):
        return
    try:
        exact = to_sympy(e)
    except ExpressionError:  # 1/0
        return
    for first in RATES:
        for second in RATES:
            assert sp.simplify(exact.diff(symbol(first), symbol(second))) == 0
