"""Balls enclose, and say where they cannot."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from flint import arb
from hypothesis import given, settings
from hypothesis import strategies as st

from geocosserat.model.expressions import ExpressionError, evaluate, parse
from geocosserat.passivity.balls import ball, ball_of, integral, line_integral, precision

NAMES = ("x", "y", "s")
TEXTS = (
    "sin(x)*cos(y) + tan(x/3)", "exp(-x**2)*log(3 + y)", "sqrt(4 + x*y)", "tanh(x) - sinh(y)/cosh(x)", "abs(x - y)**3",
    "(3 + x)**0.5 / (5 + y)**-2", "heaviside(x)*y + pi", "(2 + x)**y",
)  # fmt: skip


def test_a_decimal_is_the_rational_that_it_spells() -> None:
    """0.1 is one tenth, not the double nearest to it."""
    with precision(300):
        assert (ball(parse("0.1", ()), {}) * 10 - 1).contains(0)
        assert (ball(parse("0.1", ()), {}) * 10 - 1).rad() < arb(2) ** -290
        assert not (arb(0.1) * 10 - 1).contains(0)


@pytest.mark.parametrize("text", TEXTS)
@settings(max_examples=25, deadline=None)
@given(x=st.floats(-1.5, 1.5), y=st.floats(-1.5, 1.5))
def test_a_ball_holds_the_value_in_double_precision(text: str, x: float, y: float) -> None:
    """What numpy computes lies in the enclosure, to its own rounding."""
    e = parse(text, NAMES)
    value = evaluate(e, {"x": x, "y": y})
    enclosed = ball(e, {"x": ball_of(x), "y": ball_of(y)})
    assert enclosed.is_finite()
    assert abs(float(enclosed.mid()) - value) <= 1e-12 * (1 + abs(value))


@pytest.mark.parametrize("text", ["sqrt(x)", "log(x)", "1/x", "x**0.5", "x**-1", "tan(pi/2 + x)"])
def test_what_may_be_undefined_in_a_ball_has_no_enclosure(text: str) -> None:
    """A ball that reaches across zero gives no number where the expression has none for part of it."""
    assert not ball(parse(text, NAMES), {"x": arb(0, 0.1)}).is_finite()


def test_a_step_across_a_ball_is_between_its_sides() -> None:
    """heaviside is 1/2 at zero, one above, and [0, 1] where that is not known."""
    step = parse("heaviside(x)", NAMES)
    assert ball(step, {"x": arb(0)}) == ball_of(0.5)
    assert ball(step, {"x": arb(2)}) == 1
    across = ball(step, {"x": arb(0, 0.1)})
    assert across.contains(0)
    assert across.contains(1)


def test_a_name_without_value_is_said() -> None:
    """The message names it."""
    with pytest.raises(ExpressionError, match="the name y has no value here"):
        ball(parse("x + y", NAMES), {"x": arb(1)})


def test_the_turns_around_a_vortex_are_enclosed() -> None:
    """The integral of the angle's differential around the origin is 2 pi, to the precision that was asked for."""
    form = {"x": parse("-y/(x**2 + y**2)", NAMES), "y": parse("x/(x**2 + y**2)", NAMES)}
    path = {"x": parse("cos(2*pi*s)", NAMES), "y": parse("sin(2*pi*s)/2", NAMES)}
    with precision(160):
        off = line_integral(form, path) - 2 * arb.pi()
        assert off.contains(0)
        assert off.rad() < arb(10) ** -40


def test_an_exact_form_does_no_work_on_a_closed_way() -> None:
    """The integral of d(x**2 y) over an ellipse holds zero."""
    form = {"x": parse("2*x*y", NAMES), "y": parse("x**2", NAMES)}
    path = {"x": parse("1 + cos(2*pi*s)", NAMES), "y": parse("3*sin(2*pi*s)", NAMES)}
    assert line_integral(form, path).contains(0)


@pytest.mark.parametrize(
    ("text", "exact"),
    [
        ("abs(s - 0.3)", (0.3**2 + 0.7**2) / 2),
        ("heaviside(s - 0.25)*s", (1 - 0.25**2) / 2),
        ("sqrt(s + 1)", (2**1.5 - 1) * 2 / 3),
        ("exp(s)", math.e - 1),
    ],
)
def test_integrals_across_kinks_and_steps_are_enclosed(text: str, exact: float) -> None:
    """Against closed forms."""
    value = integral(parse(text, NAMES), tolerance=arb(1e-10))
    assert abs(float(value.mid()) - exact) < 1e-8
    assert value.rad() < 1e-8


def test_an_integral_over_a_place_without_value_is_no_number() -> None:
    """A logarithm of what is below zero on part of the way, a pole on it."""
    assert not integral(parse("log(s - 0.5)", NAMES)).is_finite()
    assert not integral(parse("log(s - 2)", NAMES)).is_finite()
    assert not integral(parse("sqrt(s - 2)", NAMES)).is_finite()
    assert not integral(parse("1/(s - 0.3)", NAMES)).is_finite()
    assert not integral(parse("(s - 0.5)**0.5", NAMES), low=Fraction(0)).is_finite()
