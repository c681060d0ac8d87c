"""Operators on expressions, and the derivative: no term that is not there, and the values of numpy and mpmath."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings

from geocosserat.model.expressions import (
    FUNCTIONS,
    Binary,
    Call,
    Expression,
    Negate,
    Number,
    Symbol,
    derivative,
    evaluate,
    fixed,
    parse,
    substitute,
    symbols,
    to_text,
)
from tests.model.exact import exactly
from tests.model.trees import NAMES, moderate, trees

U, T = Symbol("u"), Symbol("t")
ZERO, ONE, TWO = Number(0.0), Number(1.0), Number(2.0)
VALUES = {"u": 0.3, "t": 1.7, "kappa": -2.5, "k_3": 40.0}
OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "**": operator.pow,
}  # fmt: skip


def rebuilt(e: Expression) -> Expression:
    """The same expression joined again by the operators."""
    match e:
        case Call(function, argument):
            return Call(function, rebuilt(argument))
        case Binary(mark, left, right):
            joined: Expression = OPERATORS[mark](rebuilt(left), rebuilt(right))
            return joined
        case Negate(operand):
            return -rebuilt(operand)
        case _:
            return e


@pytest.mark.parametrize(
    ("made", "expected"),
    [
        (U + 0, U), (0 + U, U), (U - 0, U), (0 - U, Negate(U)), (U * 1, U), (1 * U, U), (U * 0, ZERO), (0 * U, ZERO),
        (U / 1, U), (0 / U, ZERO), (U**1, U), (U**0, ONE), (1**U, ONE), (-Negate(U), U), (-ZERO, ZERO),
        (-TWO, Number(-2.0)),
        (TWO + 3, Number(5.0)), (3 - TWO, ONE), (TWO * 3, Number(6.0)), (1 / TWO, Number(0.5)), (TWO**3, Number(8.0)),
        (U + Number(-0.0), U), (Number(-0.0) * U, ZERO), (2 * U, Binary("*", TWO, U)), (U - T, Binary("-", U, T)),
        (1 / U, Binary("/", ONE, U)), (2**U, Binary("**", TWO, U)), (0**U, Binary("**", ZERO, U)),
        (1 - TWO, Number(-1.0)), (U / 0, Binary("/", U, ZERO)),
    ],
)  # fmt: skip
def test_zeros_and_ones_leave_no_trace(made: Expression, expected: Expression) -> None:
    """A formula has only the terms that are there, and its numbers are worked out."""
    assert made == expected


@pytest.mark.parametrize(
    "zero", [Number(-0.0) + 0, -Number(0.0), 0 - Number(0.0), Number(-0.0) / 5, Number(-1.0) * 0.0]
)
def test_no_zero_is_negative(zero: Expression) -> None:
    """-0.0 is the zero that is left out everywhere; it would print as a sign and divide to minus infinity."""
    assert isinstance(zero, Number)
    assert math.copysign(1.0, zero.value) == 1.0


@pytest.mark.parametrize(
    ("made", "text"),
    [
        (ONE / 0, "1/0"), (ZERO / 0, "0/0"), (Number(1e300) * 1e300, "1e+300*1e+300"), (ZERO**-1, "0**(-1)"),
        (Number(-1.0) ** 0.5, "(-1)**0.5"), (Number(10.0) ** 400, "10**400"), (Number(1e308) * 10, "1e+308*10"),
    ],
)  # fmt: skip
def test_numbers_without_a_finite_result_stay_as_they_are_written(made: Expression, text: str) -> None:
    """A quotient by zero is no error here: whoever evaluates it sees that it is not finite."""
    assert isinstance(made, Binary)
    assert to_text(made) == text
    assert not math.isfinite(float(evaluate(made, {})))


@given(trees)
@settings(max_examples=300)
def test_operators_compute_what_numpy_computes(e: Expression) -> None:
    """Whatever is left out or worked out, a value that is finite stays the same."""
    values = {**VALUES, "u": np.array([0.3, -1.2])}
    expected = np.broadcast_to(evaluate(e, values), 2)
    assume(np.all(np.isfinite(expected)) and _finite_inside(e))
    made = rebuilt(e)
    np.testing.assert_allclose(np.broadcast_to(evaluate(made, values), 2), expected, rtol=1e-12)
    assert symbols(made) <= symbols(e)


def _finite_inside(e: Expression) -> bool:
    """Whether no part is infinite or NaN: 0 times such a part is left out, though numpy makes it NaN."""
    parts = [e]
    while parts:
        part = parts.pop()
        if not np.all(np.isfinite(evaluate(part, {**VALUES, "u": np.array([0.3, -1.2])}))):
            return False
        match part:
            case Call(_, argument):
                parts.append(argument)
            case Binary(_, left, right):
                parts += [left, right]
            case Negate(operand):
                parts.append(operand)
    return True


@given(trees)
def test_what_was_made_by_operators_stays_under_them(e: Expression) -> None:
    """Nothing is left to leave out the second time."""
    assert rebuilt(rebuilt(e)) == rebuilt(e)


@pytest.mark.parametrize("number", [2, 2.0, np.float64(2.0), np.int64(2), np.float32(2.0)])
@pytest.mark.parametrize("mark", OPERATORS)
def test_numbers_of_python_and_numpy_are_welcome_on_both_sides(mark: str, number: Any) -> None:
    """Every operator takes them, before and after an expression, and makes an expression."""
    assert OPERATORS[mark](U, number) == Binary(mark, U, TWO)  # type: ignore[arg-type]
    assert OPERATORS[mark](number, U) == Binary(mark, TWO, U)  # type: ignore[arg-type]


@pytest.mark.parametrize("thing", ["2", None, True, [1.0], 1j])
@pytest.mark.parametrize("mark", OPERATORS)
def test_only_numbers_join_expressions(mark: str, thing: Any) -> None:
    """Anything else is an error with its type."""
    wording = f"expected an expression or a number, found {type(thing).__name__}"
    for a, b in ((U, thing), (thing, U)):
        with pytest.raises(TypeError, match=wording):
            OPERATORS[mark](a, b)


def test_an_array_is_not_an_expression() -> None:
    """An array of expressions would be no expression: no operator makes one."""
    with pytest.raises(TypeError, match="found ndarray"):
        U * np.ones(2)
    with pytest.raises(TypeError, match="found ndarray"):
        np.ones(2) * U


@given(moderate)
@settings(max_examples=400, suppress_health_check=[HealthCheck.filter_too_much])
def test_the_derivative_is_that_of_mpmath(e: Expression) -> None:
    """For any expression, to 15 digits: differences of values with 60."""
    assume("u" in symbols(e))
    with mpmath.workdps(60):
        try:
            expected = mpmath.diff(lambda u: exactly(e, {**VALUES, "u": u})[0], mpmath.mpf(VALUES["u"]), h=1e-20)
            found, _ = exactly(derivative(e, "u"), VALUES)
        except (ZeroDivisionError, OverflowError, ValueError, TypeError):
            assume(False)
        assume(isinstance(expected, mpmath.mpf) and abs(expected) < 1e12)
        assert abs(found - expected) <= 1e-15 * (1 + abs(expected))


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("u", [0.2, 0.6, 0.9])
def test_every_function_has_its_slope(name: str, u: float) -> None:
    """Each function of a function, against central differences of high order."""
    e = Call(name, U**2 + 0.1 * U)
    h = 1e-3
    weights = {-2: 1 / 12, -1: -2 / 3, 1: 2 / 3, 2: -1 / 12}
    expected = sum(w * float(evaluate(e, {"u": u + k * h})) for k, w in weights.items()) / h
    assert evaluate(derivative(e, "u"), {"u": u}) == pytest.approx(expected, rel=1e-8, abs=1e-10)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("3", "0"), ("kappa*t", "0"), ("u", "1"), ("-u", "-1"), ("kappa*u", "kappa"), ("u + t", "1"), ("t - u", "-1"),
        ("u**2", "2*u"), ("u**kappa", "kappa*u**(kappa - 1)"), ("kappa**u", "kappa**u*log(kappa)"),
        ("u/kappa", "1/kappa"),
        ("sin(u)", "cos(u)"), ("heaviside(u - t)", "0"), ("t*heaviside(u)*u", "t*heaviside(u)"), ("sin(kappa*t)", "0"),
        ("u**0", "0"), ("0*sin(u)", "0"),
    ],
)  # fmt: skip
def test_a_derivative_has_no_idle_terms(text: str, expected: str) -> None:
    """It is written as one would write it, as far as zeros and ones go."""
    assert to_text(derivative(parse(text, NAMES), "u")) == expected


def test_the_slope_of_abs_is_a_sign_and_zero_at_zero() -> None:
    """Where there is no slope, the mean of both sides."""
    slope = derivative(parse("abs(u)", NAMES), "u")
    np.testing.assert_array_equal(evaluate(slope, {"u": np.array([-2.0, 0.0, 3.0])}), [-1, 0, 1])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1 + t*sin(2*pi*u)", "1"), ("3*sin(2*pi*(u - t))", "3*sin(2*pi*u)"), ("2*pi*u", "2*pi*u"), ("cos(t)*u", "u"),
        ("exp(-t)*kappa", "kappa"), ("t", "0"), ("-t", "0"), ("(1 + t)**2*u", "u"), ("u/(1 + t)", "u"),
        ("heaviside(t)*u", "0.5*u"), ("u**t", "1"), ("sin(u + t)", "sin(u)"), ("u*(t - 1)", "u*(-1)"),
        ("1/t + u", "1/0 + u"), ("log(t) + u", "log(0) + u"),
    ],
)  # fmt: skip
def test_at_one_value_of_a_name_only_what_is_left_remains(text: str, expected: str) -> None:
    """A reference that starts from zero has no terms at the start; what does not contain the name stays as it was."""
    assert to_text(fixed(parse(text, NAMES), "t", 0.0)) == expected


@given(trees)
def test_at_one_value_of_a_name_the_value_is_that_of_substitution(e: Expression) -> None:
    """Working out changes no value, and the name is gone."""
    found, expected = fixed(e, "t", 1.7), substitute(e, {"t": Number(1.7)})
    assert "t" not in symbols(found)
    assume(_finite_inside(expected))
    np.testing.assert_allclose(evaluate(found, VALUES), evaluate(expected, VALUES), rtol=1e-9)
