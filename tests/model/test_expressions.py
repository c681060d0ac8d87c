"""Evaluation, substitution and steps of expressions."""

from __future__ import annotations

import math
import warnings

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from geocosserat.model.expressions import (
    FUNCTIONS,
    Call,
    Expression,
    ExpressionError,
    Number,
    Symbol,
    constant,
    evaluate,
    jump_positions,
    jumps,
    parse,
    substitute,
    symbols,
    to_text,
)
from tests.model.exact import FUNCTION, exactly
from tests.model.trees import NAMES, moderate, trees

VALUES = {"u": 0.3, "t": 1.7, "kappa": -2.5, "k_3": 40.0}


@given(moderate)
@settings(max_examples=1000)
def test_evaluation_agrees_with_60_digits(e: Expression) -> None:
    """The value is the exact one to within what rounding each operation can do, bounded along the tree."""
    with mpmath.workdps(60):
        try:
            value, error = exactly(e, VALUES)
        except (ZeroDivisionError, OverflowError, ValueError, TypeError):
            assume(False)
        assert abs(evaluate(e, VALUES) - value) <= 2 * error


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_is_the_one_of_its_name(name: str) -> None:
    """Each function against 30 digits at a few points."""
    for x in (0.2, 0.5, 0.9, 3.1):
        with mpmath.workdps(30):
            expected = float(FUNCTION[name](mpmath.mpf(x)))
        assert evaluate(Call(name, Symbol("u")), {"u": x}) == pytest.approx(expected, rel=4e-16)


@given(trees)
def test_an_array_is_evaluated_entry_by_entry(e: Expression) -> None:
    """Evaluation over an array gives what evaluation at each of its numbers gives."""
    u = np.array([0.0, 0.3, -1.0, 2.0])
    together = np.broadcast_to(evaluate(e, {**VALUES, "u": u}), u.shape)
    singly = np.array([evaluate(e, {**VALUES, "u": float(x)}) for x in u])
    np.testing.assert_allclose(together, singly, rtol=1e-9 if "**" in to_text(e) else 1e-12)


def test_a_tower_of_powers_is_infinite_and_quick() -> None:
    """Powers are taken in floating point: 9**9**9**9 is infinite, not a number of 10^77 digits."""
    assert constant(parse("9**9**9**9", ())) == math.inf


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1/0", math.inf),
        ("-1/0", -math.inf),
        ("0/0", math.nan),
        ("log(-1)", math.nan),
        ("sqrt(-1)", math.nan),
    ],
)
def test_what_has_no_value_is_not_finite_and_warns_of_nothing(text: str, value: float) -> None:
    """Outside a domain the value is NaN or infinite, for the caller to refuse."""
    with warnings.catch_warnings(action="error"):
        assert constant(parse(text, ())) == pytest.approx(value, nan_ok=True)


def test_heaviside_is_one_half_at_its_step() -> None:
    """The value at the step is the mean of both sides."""
    np.testing.assert_array_equal(
        evaluate(parse("heaviside(u)", {"u"}), {"u": np.array([-1.0, 0.0, 1.0])}), [0, 0.5, 1]
    )


def test_integers_among_the_values_are_numbers_too() -> None:
    """2**u at u = -1 is a half, even if the caller's -1 is an integer."""
    assert evaluate(parse("t**u", {"u", "t"}), {"u": -1, "t": 2}) == 0.5


def test_a_name_without_a_value_is_named() -> None:
    """The message says which, and what is known."""
    with pytest.raises(ExpressionError, match="the name kappa has no value here; known: t u"):
        evaluate(parse("kappa*u", NAMES), {"u": 1.0, "t": 2.0})


@given(trees, trees)
def test_substitution_is_evaluation_of_the_replaced(e: Expression, inner: Expression) -> None:
    """Replacing a name by an expression and giving the name that expression's value are the same."""
    value = float(evaluate(inner, VALUES))
    assume(math.isfinite(value))
    replaced = substitute(e, {"u": inner})
    np.testing.assert_equal(evaluate(replaced, VALUES), evaluate(e, {**VALUES, "u": value}))
    assert symbols(replaced) <= (symbols(e) - {"u"}) | symbols(inner)


def test_substitution_is_simultaneous() -> None:
    """Names may be exchanged."""
    exchanged = substitute(parse("u - t", NAMES), {"u": Symbol("t"), "t": Symbol("u")})
    assert exchanged == parse("t - u", NAMES)


def test_substitution_cannot_explode() -> None:
    """A small expression substituted into another stays bounded."""
    e = parse("+".join(["(" + "+".join(["u"] * 50) + ")"] * 50), NAMES)
    with pytest.raises(ExpressionError, match="more than 5000 parts; shorten"):
        substitute(e, {"u": e})


@given(trees)
def test_a_constant_is_what_contains_no_name(e: Expression) -> None:
    """``constant`` gives the value exactly when ``symbols`` is empty."""
    if symbols(e):
        assert constant(e) is None
    else:
        np.testing.assert_equal(constant(e), evaluate(e, {}))


@given(st.floats(0.01, 0.99), st.floats(-100, 100).filter(lambda a: abs(a) > 1e-3), st.floats(0.1, 100))
def test_a_step_is_found_where_it_is(place: float, slope: float, length: float) -> None:
    """Whatever the slope, its sign and the length: heaviside(a*(u - c)) steps at c."""
    e = parse("1 + kappa*heaviside(slope*(u - place*length))", {"u", "kappa", "slope", "place", "length"})
    values = {"kappa": 2.0, "slope": slope, "place": place, "length": length}
    assert jump_positions(e, length, values) == pytest.approx((place * length,), rel=1e-12)


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("heaviside(u - 0.5)", (0.5,)),
        ("heaviside(0.75 - u) + heaviside(u - 0.25) + heaviside(u - 0.25)**2", (0.25, 0.75)),
        ("heaviside((2*u - 1)/3)", (0.5,)),
        ("heaviside(-(u - 0.5)*2 + 0*t**0)", None),
        ("heaviside(u)", ()),
        ("heaviside(1 - u)", ()),
        ("heaviside(u - 3)", ()),
        ("heaviside(t - 0.5)", ()),
        ("abs(u - 0.5)", ()),
        ("u**2", ()),
    ],
)
def test_steps_inside_the_rod_are_boundaries(text: str, places: tuple[float, ...] | None) -> None:
    """Each step strictly inside the rod, once, in rising order; steps at the ends and in time are none."""
    e = parse(text, NAMES)
    if places is None:
        with pytest.raises(ExpressionError, match="a step must not move"):
            jump_positions(e, 1.0, {})
    else:
        assert jump_positions(e, 1.0, {}) == pytest.approx(places)


@pytest.mark.parametrize(
    ("text", "wording"),
    [
        (
            "heaviside(sin(u))",
            r"heaviside\(sin\(u\)\) is not a step at one place; write steps as heaviside\(u - 0.5\)",
        ),
        ("heaviside(u**2 - 0.25)", "not a step at one place"),
        ("heaviside(1/u - 2)", "not a step at one place"),
        ("heaviside(u*(u - 1))", "not a step at one place"),
        ("heaviside(heaviside(u - 0.5) - 0.5)", "not a step at one place"),
        ("heaviside(u - 0.3*t)", "a step must not move, but .* depends on u and t"),
    ],
)
def test_a_step_at_no_known_place_is_refused(text: str, wording: str) -> None:
    """Element boundaries need places that are known and stay."""
    with pytest.raises(ExpressionError, match=wording):
        jumps(parse(text, NAMES))


def test_expressions_are_values() -> None:
    """Equal trees are equal and hash alike, and cannot be changed."""
    one, other = parse("sin(u)*2", NAMES), parse("sin(u) * 2", NAMES)
    assert one == other
    assert hash(one) == hash(other)
    with pytest.raises(AttributeError):
        one.left = Number(1.0)  # type: ignore[misc,union-attr]


def test_a_number_is_finite() -> None:
    """No tree can hold an infinity or a NaN."""
    with pytest.raises(ExpressionError, match="must be finite"):
        Number(math.inf)


@pytest.mark.parametrize(
    ("text", "printed"),
    [
        ("3*(1-u)**2*(1+2*u)", "3*(1 - u)**2*(1 + 2*u)"),
        ("2*pi*t", "2*pi*t"),
        ("-u", "-u"),
        ("-(u+t)", "-(u + t)"),
        ("u-(-2)", "u - (-2)"),
        ("((u))/(t)", "u/t"),
        ("u/(t*2)", "u/(t*2)"),
        ("1e-6", "1e-06"),
        ("sin((u))", "sin(u)"),
    ],
)
def test_expressions_print_as_one_would_write_them(text: str, printed: str) -> None:
    """Parentheses only where they are needed, pi by its name."""
    assert to_text(parse(text, NAMES)) == printed
