"""Multiplying out products of fields changes nothing but the form."""

from __future__ import annotations

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from geocosserat.derivation.distribute import distributed, terms, vanishes
from geocosserat.derivation.notation import T, U, fields, symbol
from tests.derivation.rods import TINY, random_value

H, V, M = fields(("h1", "v1", "M"))
A = symbol("a")
LEAVES = st.sampled_from([H, V, M, H.diff(U), U, A, sp.Rational(2, 3), sp.Integer(-1), sp.cos(H), sp.exp(U)])


def expressions() -> st.SearchStrategy[sp.Expr]:
    """Sums, products and powers of fields, coordinates, parameters and numbers."""
    return st.recursive(
        LEAVES,
        lambda inner: st.one_of(
            st.tuples(inner, inner).map(lambda p: p[0] + p[1]),
            st.tuples(inner, inner).map(lambda p: p[0] * p[1]),
            st.tuples(inner, st.integers(0, 3)).map(lambda p: p[0] ** p[1]),
        ),
        max_leaves=8,
    )


@settings(max_examples=50)
@given(e=expressions())
def test_the_value_does_not_change(e: sp.Expr) -> None:
    """At random values of fields, their derivatives and the coordinates."""
    before = random_value(e, 61)
    assert abs(random_value(distributed(e), 61) - before) <= TINY * (1 + abs(before))


@settings(max_examples=50)
@given(e=expressions())
def test_nothing_minus_itself_leaves_a_term(e: sp.Expr) -> None:
    """The terms of e, multiplied out, taken from e cancel without a trace."""
    assert terms(sp.Add(e, -distributed(e), evaluate=False)) == {}


def test_coefficients_keep_their_form_unless_another_is_shorter() -> None:
    """(1 - u)^2 stays, (a + u) - u becomes a."""
    assert terms((1 - U) ** 2 * (H + V) * M) == {H * M: (1 - U) ** 2, V * M: (1 - U) ** 2}
    assert terms((A + U) * H - U * H) == {H: A}


def test_products_are_merged_across_brackets() -> None:
    """a (h - 1) v - a h v = -a v."""
    assert terms(A * (H - 1) * V - A * H * V) == {V: -A}


@pytest.mark.usefixtures("patience")
@pytest.mark.parametrize("power", [100, 10**6])
def test_a_high_power_in_a_coefficient_costs_nothing(power: int) -> None:
    """Coefficients are judged by their value at two points, never expanded."""
    c = (1 + U) ** power
    assert terms(c * H - c * V + (A - A * T) * M)[H] == c
    assert terms((c + A) * H - c * H) == {H: A}


def test_a_hidden_zero_vanishes_and_a_small_number_does_not() -> None:
    """(u + 1)^2 - u^2 - 2u - 1 is zero; 1e-29 more of it is not."""
    hidden = (U + 1) ** 2 - U**2 - 2 * U - 1
    assert vanishes(hidden)
    assert vanishes(sp.Integer(0))
    assert not vanishes(hidden + sp.Rational(1, 10**29))
    assert not vanishes(A - U)
