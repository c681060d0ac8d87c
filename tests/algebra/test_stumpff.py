"""Stumpff functions against their defining hypergeometric series at 50 digits."""

from __future__ import annotations

from math import factorial

import mpmath as mp
import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from geocosserat.algebra.stumpff import stumpff, stumpff_derivative
from geocosserat.algebra.symbolic import Stumpff

ORDERS = pytest.mark.parametrize("k", range(9))
ARGUMENTS = st.one_of(st.floats(-500, 500), st.floats(-1e-6, 1e-6), st.floats(-1e4, 1e8))


def exact(k: int, s: float) -> mp.mpf:
    """c_k(s) = 1F2(1; (k+1)/2, (k+2)/2; -s/4) / k!."""
    return mp.hyp1f2(1, mp.mpf(k + 1) / 2, mp.mpf(k + 2) / 2, -mp.mpf(s) / 4) / mp.factorial(k)


@ORDERS
@given(s=ARGUMENTS)
def test_values_are_accurate_to_1e_15_at_any_argument(k: int, s: float) -> None:
    """Relative to the value itself: on both sides of zero, around the switch to closed forms, and far out."""
    with mp.workdps(50):
        expected = exact(k, s)
        assert abs(mp.mpf(float(stumpff(k, s))) - expected) <= 1.5e-15 * abs(expected)


@ORDERS
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_series_and_closed_form_meet(k: int, side: float) -> None:
    """On the two neighbours of the switch the two ways agree."""
    switch = side * 0.5 * (k + 1) * (k + 2)
    inside, outside = stumpff(k, [np.nextafter(switch, 0.0), np.nextafter(switch, 2 * switch)])
    assert inside == pytest.approx(outside, rel=2e-15)


@ORDERS
@given(s=st.floats(-200, 200))
def test_the_family_is_closed_under_differentiation(k: int, s: float) -> None:
    """c_k' = (k c_{k+2} - c_{k+1}) / 2, against a derivative taken at 50 digits."""
    with mp.workdps(50):
        expected = float(mp.diff(lambda x: exact(k, x), mp.mpf(s)))
    assert float(stumpff_derivative(k, s)) == pytest.approx(expected, rel=1e-13, abs=1e-15)


@ORDERS
@given(s=st.floats(-300, 300))
def test_two_orders_up_is_the_remainder(k: int, s: float) -> None:
    """c_k(s) = 1/k! - s c_{k+2}(s)."""
    remainder = float(s * stumpff(k + 2, s))
    rounding = 1e-14 * (1 + abs(remainder))
    assert float(stumpff(k, s)) + remainder == pytest.approx(1 / factorial(k), abs=rounding)


def test_a_batch_keeps_its_shape_and_a_not_a_number() -> None:
    """Any shape in, the same out; the overflow far on the hyperbolic side is infinite and silent."""
    s = np.array([[0.0, 5.0, 1e9], [-3.0, np.nan, -1e9]])
    for k in range(5):
        value = stumpff(k, s)
        assert value.shape == s.shape
        assert np.isnan(value[1, 1])
        assert np.isposinf(value[1, 2])
        assert value[0, 1] == stumpff(k, 5.0)


def test_a_negative_order_is_refused() -> None:
    """There is no c_{-1}, numeric or symbolic."""
    with pytest.raises(ValueError, match="expected an integer >= 0, found -1"):
        stumpff(-1, 0.0)
    with pytest.raises(ValueError, match="expected an integer >= 0, found -1"):
        Stumpff(-1, sp.Symbol("s"))


@ORDERS
def test_symbolic_and_numeric_are_one_function(k: int) -> None:
    """Values to 40 digits, derivatives of any order, the value at zero, and the elementary form."""
    s = sp.Symbol("s")
    for value in (sp.Rational(1, 7), sp.Rational(-37, 2), sp.Integer(90)):
        with mp.workdps(60):
            at = mp.mpf(value.p) / value.q
            here, third = exact(k, at), mp.diff(lambda x: exact(k, x), at, 3)
            assert mp.almosteq(mp.mpf(str(Stumpff(k, value).evalf(40))), here, mp.mpf("1e-38"))
            found = mp.mpf(str(Stumpff(k, s).diff(s, 3).subs(s, value).evalf(40)))
            assert mp.almosteq(found, third, mp.mpf("1e-13"), mp.mpf("1e-16"))
        assert float(Stumpff(k, value).elementary().evalf(40, chop=True)) == pytest.approx(
            float(stumpff(k, float(value))), rel=1e-14
        )
    assert Stumpff(k, 0) == sp.Rational(1, factorial(k))
    assert Stumpff(k, s).diff(s).subs(s, 0) == -sp.Rational(1, factorial(k + 2))


def test_symbolic_functions_print_readably() -> None:
    """As text and as LaTeX, powers included."""
    c = Stumpff(2, sp.Symbol("s"))
    assert str(c) == "c2(s)"
    assert sp.latex(c) == r"c_{2}\left(s\right)"
    assert sp.latex(c**2) == r"c_{2}^{2}\left(s\right)"
