"""Scene expressions become exact symbolic ones of the same value, and none takes long."""

from __future__ import annotations

import math

import pytest
import sympy as sp
from hypothesis import assume, given
from hypothesis import strategies as st

from geocosserat.derivation.convert import exact, to_sympy
from geocosserat.derivation.notation import symbol
from geocosserat.model.expressions import FUNCTIONS, ExpressionError, evaluate, parse

NAMES = frozenset({"u", "t", "kappa"})


def texts() -> st.SearchStrategy[str]:
    """Texts of expressions in u, t and kappa."""
    leaves = st.sampled_from(["u", "t", "kappa", "pi", "0.1", "2", "3.75", "1e-3", "7"])
    return st.recursive(
        leaves,
        lambda inner: st.one_of(
            st.tuples(inner, st.sampled_from("+-*/"), inner).map(lambda p: f"({p[0]} {p[1]} {p[2]})"),
            st.tuples(st.sampled_from(FUNCTIONS), inner).map(lambda p: f"{p[0]}({p[1]})"),
            st.tuples(inner, st.integers(0, 3)).map(lambda p: f"({p[0]})**{p[1]}"),
            inner.map(lambda x: f"(-({x}))"),
        ),
        max_leaves=8,
    )


@given(text=texts(), u=st.floats(0.05, 0.95), t=st.floats(0.05, 0.95), kappa=st.floats(0.05, 0.95))
def test_values_agree_with_the_scene_s_own_evaluation(text: str, u: float, t: float, kappa: float) -> None:
    """At any point where the latter is finite and its rounding harmless."""
    at = {"u": u, "t": t, "kappa": kappa}
    e = parse(text, NAMES)
    expected = evaluate(e, at)
    assume(math.isfinite(expected) and 1e-6 < abs(expected) < 1e6)
    try:
        converted = to_sympy(e)
    except ExpressionError:
        assume(False)
    found = converted.evalf(30, subs={symbol(name): sp.Float(x, 30) for name, x in at.items()})
    # a step or a cancellation right at the point makes rounding decide
    shifted = evaluate(e, {name: x * (1 + 1e-13) for name, x in at.items()})
    assume(abs(shifted - expected) < 1e-9 * abs(expected))
    assert complex(found) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0.1", sp.Rational(1, 10)),
        ("1e-300", sp.Rational(1, 10**300)),
        ("1e4", sp.Integer(10000)),
        ("0.1 + 0.2 - 0.3", sp.Integer(0)),
        ("1/3", sp.Rational(1, 3)),
        ("sin(pi)", sp.Integer(0)),
        ("kappa*(1 - 1)", sp.Integer(0)),
        ("heaviside(0)", sp.Rational(1, 2)),
        ("sqrt(u)**2", symbol("u")),
    ],
)
def test_numbers_are_exact(text: str, expected: sp.Expr) -> None:
    """Decimals are the rationals that they spell and pi is pi, so what cancels on paper cancels."""
    assert to_sympy(parse(text, NAMES)) == expected


def test_a_float_is_the_rational_that_its_shortest_decimal_spells() -> None:
    """0.1 is 1/10, not its binary neighbour; pi stays symbolic."""
    assert exact(0.1) == sp.Rational(1, 10)
    assert exact(2.5) == sp.Rational(5, 2)
    assert exact(-0.0) == 0
    assert exact(math.pi) is sp.pi


@pytest.mark.parametrize(
    "text", ["1/0", "u/(1 - 1)", "sqrt(-1)", "log(0)", "log(-2)*u", "tan(pi/2)", "0**(-1)"]
)
def test_what_is_infinite_or_not_real_is_refused(text: str) -> None:
    """A message with the text and what to do, instead of a symbol for infinity in the equations."""
    with pytest.raises(
        ExpressionError, match=r"expected a finite real expression, found .*remove the division"
    ):
        to_sympy(parse(text, NAMES))


@pytest.mark.parametrize(
    "text",
    [
        "9**9**9",
        "2**(1e300)",
        "0.5**1e15",
        "(2**1000)**1000",
        "1e300**300.5",
        "exp(1e12*log(2))",
        "exp(2000*log(2))",
        "exp(-1e12*log(3))",
    ],
)
@pytest.mark.usefixtures("patience")
def test_a_number_out_of_range_is_refused_at_once(text: str) -> None:
    """Exact arithmetic would compute it to its last digit."""
    with pytest.raises(ExpressionError, match=r"range of doubles, found .*smaller exponent"):
        to_sympy(parse(text, NAMES))


@pytest.mark.parametrize(
    "text", ["(1 + u)**1000000", "u**0.5", "2**0.333", "exp(-1000000)", "kappa**(1e9)", "sin(1e300)"]
)
@pytest.mark.usefixtures("patience")
def test_large_powers_of_names_are_left_alone(text: str) -> None:
    """They are no trouble unless multiplied out, and nothing does that."""
    assert to_sympy(parse(text, NAMES)) != 0
