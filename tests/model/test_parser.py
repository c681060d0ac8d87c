"""The expression parser: it agrees with Python's grammar, and any text is parsed or refused."""

from __future__ import annotations

import ast

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from geocosserat.model.expressions import (
    Binary,
    Call,
    Expression,
    ExpressionError,
    Negate,
    Number,
    Symbol,
    parse,
    to_text,
)
from tests.model.trees import NAMES, arithmetic, texts, trees

GROUPED = "+".join(["(" + "+".join(["1"] * 17) + ")"] * 17)
_MARKS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}


def from_python(node: ast.expr) -> Expression:
    """Python's own syntax tree of the same text, as an expression."""
    match node:
        case ast.Constant(value=int() | float() as value):
            return Number(float(value))
        case ast.Name(id="pi"):
            return Number(3.141592653589793)
        case ast.Name(id=name):
            return Symbol(name)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return Negate(from_python(operand))
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return from_python(operand)
        case ast.BinOp(left=left, op=op, right=right):
            return Binary(_MARKS[type(op)], from_python(left), from_python(right))  # type: ignore[arg-type]
        case ast.Call(func=ast.Name(id=function), args=[argument]):
            return Call(function, from_python(argument))
    raise AssertionError(ast.dump(node))


def unfolded(e: Expression) -> Expression:
    """A negative literal as Python writes it: the negative of a positive one."""
    match e:
        case Number(value) if str(value).startswith("-"):
            return Negate(Number(-value))
        case Negate(operand):
            return Negate(unfolded(operand))
        case Binary(operator, left, right):
            return Binary(operator, unfolded(left), unfolded(right))
        case Call(function, argument):
            return Call(function, unfolded(argument))
    return e


@given(arithmetic)
@settings(max_examples=1000)
@example("-2**2")
@example("2**-1**2")
@example("-u*t/-k_3")
@example("+-+2")
def test_arithmetic_means_what_python_means(text: str) -> None:
    """Precedence and grouping are Python's, with Python's own parser for the oracle."""
    assert unfolded(parse(text, NAMES)) == from_python(ast.parse(text, mode="eval").body)


@given(texts)
@settings(max_examples=1000)
def test_nothing_parses_that_python_reads_otherwise(text: str) -> None:
    """Of the right tokens in any order, only arithmetic gets through."""
    try:
        e = parse(text, NAMES)
    except ExpressionError:
        return
    assert unfolded(e) == from_python(ast.parse(text.strip(), mode="eval").body)


@given(trees)
@settings(max_examples=500)
@example(Negate(Number(2.0)))
@example(Binary("**", Number(-2.0), Number(-2.0)))
@example(Negate(Negate(Number(-0.0))))
@example(Binary("-", Symbol("u"), Binary("-", Symbol("u"), Symbol("t"))))
def test_a_printed_expression_parses_to_itself(e: Expression) -> None:
    """``to_text`` loses nothing: not a digit, not a sign, not a parenthesis that matters."""
    assert parse(to_text(e), NAMES) == e


@given(st.text(max_size=300) | texts | st.text("()+-*/.e1u,=[]{}'\"_ \\\n", max_size=300))
@settings(max_examples=1000)
def test_any_text_parses_or_is_refused(text: str) -> None:
    """No text raises anything but ExpressionError."""
    try:
        e = parse(text, NAMES)
    except ExpressionError:
        return
    assert parse(to_text(e), NAMES) == e


@pytest.mark.parametrize(
    ("text", "wording"),
    [
        ("__import__('os').system('true')", 'character "\'" is not available'),
        ("__import__(u)", "no function __import__"),
        ("u.__class__", r"character '\.' is not available"),
        ("(lambda u: u)(1)", "character ':' is not available"),
        ("lambda", "the name lambda is not known"),
        ("[u for u in t]", r"character '\[' is not available; group with"),
        ("{u}", r"character '\{' is not available"),
        ("u if t else 1", "expected an operator before 'if'"),
        ("sin(u, t)", "character ',' is not available; a function takes one argument"),
        ('"u"', "character '\"' is not available"),
        ("`u`", "character '`' is not available"),
        ("u; t", "character ';' is not available"),
        ("u\\t", "is not available"),
        ("u\x00", r"character '\\x00' is not available"),
        ("u\x0bt", "is not available"),
        ("u // t", r"expected a number, a name or '\(', found '/'"),
        ("u % t", "character '%' is not available; only"),
        ("u ^ 2", r"character '\^' is not available; write \*\* for a power"),
        ("u > 0.5", "a step is written heaviside"),
        ("u = 1", "character '=' is not available"),
        ("2u", "expected an operator before 'u'; write products with"),
        ("1_000", "expected an operator before '_000'"),
        ("0x10", "expected an operator before 'x10'"),
        ("1j", "expected an operator before 'j'"),
        ("2 3", "expected an operator before '3'"),
        ("1..2", "expected an operator before '.2'"),
        ("()", r"expected a number, a name or '\(', found '\)'"),
        ("", "the expression is empty; write a number"),
        (" \t\n", "the expression is empty"),
        ("u +", "found the end"),
        ("(u", r"never closed; add '\)' \(at character 1\)"),
        ("(u t)", "expected an operator before 't'"),
        ("u)", r"this '\)' closes nothing; remove it \(at character 2\)"),
        ("sin", r"sin is a function; write sin\(...\)"),
        ("sin u", r"sin is a function; write sin\(...\)"),
        ("sni(u)", "no function sni; did you mean sin"),
        ("max(u)", "no function max; "),
        ("qqq(u)", "no function qqq; available: sin cos"),
        ("u(1)", r"u is a number; write u\*\(...\) for a product"),
        ("pi(1)", r"pi is a number"),
        ("kapa*u", r"the name kapa is not known; did you mean kappa\? \(at character 1\)"),
        ("U", r"did you mean u\?"),
        ("zzz", "known here: k_3 kappa pi t u"),
        ("nan", "the name nan is not known"),
        ("inf", "the name inf is not known"),
        ("1e999", "the number is too large"),
        ("9" * 400, "the number is too large"),
        ("\N{CYRILLIC SMALL LETTER A}", r"U\+0430 \(CYRILLIC SMALL LETTER A\) is not ASCII"),
        ("\N{MATHEMATICAL BOLD SMALL U}", "MATHEMATICAL BOLD SMALL U"),
        ("1 \N{MINUS SIGN} u", "MINUS SIGN"),
        ("\N{FULLWIDTH DIGIT ONE}", "FULLWIDTH DIGIT ONE"),
        ("u\N{SUPERSCRIPT TWO}", "SUPERSCRIPT TWO"),
        ("u\N{NO-BREAK SPACE}+1", "NO-BREAK SPACE"),
        ("\N{ARABIC-INDIC DIGIT THREE}", "not ASCII"),
        ("\ud800", "not ASCII"),
    ],
)
def test_what_is_not_arithmetic_is_refused_with_what_to_do(text: str, wording: str) -> None:
    """Code, quotes, other languages' operators, look-alike letters: each has its own message."""
    with pytest.raises(ExpressionError, match=wording):
        parse(text, NAMES)


@pytest.mark.parametrize(
    ("text", "wording"),
    [
        ("(" * 5000 + "u" + ")" * 4999, "nested more than 100 levels"),
        ("(" * 10_000, "nested more than 100 levels"),
        ("-" * 9_999 + "u", "nested more than 100 levels"),
        ("+" * 9_999 + "u", "nested more than 100 levels"),
        ("sin(" * 1900 + "u" + ")" * 1900, "nested more than 100 levels"),
        ("**".join(["9"] * 3000), "nested more than 100 levels"),
        ("+".join(["1"] * 5000), "more than 100 levels deep; group long sums"),
        ("+".join([f"({GROUPED})"] * 16), "more than 5000 parts"),
        ("u" * 10_001, "has 10001 characters, at most 10000"),
        ("1+" * 500_000 + "1", "has 1000001 characters"),
        ("u" * 10_000, "the name u{37}... is not known"),
        ("1 " * 5000, "expected an operator before '1'"),
        ("." * 10_000, r"character '\.' is not available"),
        ("1e" * 5000, "expected an operator before"),
    ],
)
@pytest.mark.usefixtures("patience")
def test_hostile_sizes_are_refused_at_once(text: str, wording: str) -> None:
    """Length, depth and number of nodes are bounded: no stack overflow, no long wait, a short message."""
    with pytest.raises(ExpressionError, match=wording) as caught:
        parse(text, NAMES)
    assert len(str(caught.value)) < 300


@pytest.mark.parametrize(
    ("value", "wording"),
    [
        (True, "found the boolean true"),
        (float("nan"), "must be finite, found nan"),
        (float("-inf"), "must be finite, found -inf"),
        (10**400, "too large"),
        (None, "found NoneType"),
        ([1], "found list"),
        (1j, "found complex"),
        (b"u", "found bytes"),
    ],
)
def test_only_numbers_and_text_are_expressions(value: object, wording: str) -> None:
    """Booleans are not numbers, and no other object is let in."""
    with pytest.raises(ExpressionError, match=wording):
        parse(value, NAMES)  # type: ignore[arg-type]


@pytest.mark.parametrize(("value", "number"), [(3, 3.0), (-2.5, -2.5), ("-2.5", -2.5), ("1e4", 1e4), (" .5 ", 0.5)])
def test_a_number_is_a_number_however_it_is_written(value: str | float, number: float) -> None:
    """A number and its text give the same node, sign included."""
    assert parse(value, ()) == Number(number)


def test_the_longest_sensible_sum_is_read() -> None:
    """A hundred terms fit; the bound is for what no one writes by hand."""
    assert parse("+".join(["u"] * 100), NAMES)


def test_the_error_knows_its_position() -> None:
    """``position`` counts from 0, so that a caller can point at the character."""
    with pytest.raises(ExpressionError) as caught:
        parse("1 + kapa", NAMES)
    assert caught.value.position == 4
