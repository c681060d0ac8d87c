"""What is printed is what was derived, reads well, and is valid LaTeX."""

from __future__ import annotations

import ast
import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from matplotlib.mathtext import MathTextParser

from geocosserat.derivation import printing
from geocosserat.derivation.equations import derive
from geocosserat.derivation.forms import document
from geocosserat.derivation.notation import T, U, field, symbol
from geocosserat.derivation.printing import to_latex, to_text
from geocosserat.derivation.writing import Latex, Text, decimal
from geocosserat.model.effects.weight import Weight
from geocosserat.model.expressions import evaluate, parse
from geocosserat.model.records import End, RodModel
from tests.derivation.rods import (
    HEAVY_PLANAR,
    HEAVY_SPATIAL,
    PLAIN_PLANAR,
    PLAIN_SPATIAL,
    RODS,
    VALUES,
    diagonal,
    jets,
    substituted,
    vector,
)

ALL = pytest.mark.parametrize("model", RODS.values(), ids=RODS)
PRIME, MINUS = "\N{PRIME}", "\N{MINUS SIGN}"


def test_the_planar_rod_reads_as_one_would_write_it() -> None:
    """Dots and primes; in ASCII h1_t and v1_u."""
    text = to_text(document(derive(PLAIN_PLANAR))).replace(PRIME, "'").replace(MINUS, "-")
    for line in (
        "  ḣ₁ = v₁' - Π v₂ + Ω h₂",
        "  F₂' + Π F₁ + f₂ = 0",
        "  M' + h₁ F₂ - h₂ F₁ + m = 0",
        "  F₁ = κ (h₁ - 1)",
        "  0.01 Ω = Π' + κ h₂",
        "  v₁ = 0,  v₂ = 0,  Ω = 0",
        "  ε = κ (h₁ - 1)²/2 + κ h₂²/2 + Π²/2",
    ):
        assert line in text.splitlines(), line
    plain = to_text(document(derive(PLAIN_PLANAR)), unicode=False)
    assert "  h1_t = v1_u - Pi v2 + Omega h2" in plain.splitlines()
    assert plain.isascii()


@ALL
def test_ascii_text_is_ascii(model: RodModel) -> None:
    """For terminals and files that know nothing else."""
    assert to_text(document(derive(model)), unicode=False).isascii()


@ALL
def test_every_printed_side_has_the_value_of_what_was_derived(model: RodModel) -> None:
    """Each side, written in ASCII and read back with the products put in, evaluates to the same number."""
    equations = derive(model)
    script = Text(unicode=False)
    sides = [side for part in equations.parts.values() for e in part for side in (e.left, e.right)]
    assert equations.energy is not None
    rng = np.random.default_rng(71)
    for e in (*sides, equations.energy, equations.dissipation):
        numbers = {jet: sp.Rational(int(rng.integers(1, 200)), 64) for jet in jets([e])}
        env = VALUES | {script.write(jet): float(x) for jet, x in numbers.items()} | {"u": 3 / 8, "t": 5 / 8}
        text = re.sub(r"(?<![-+]) (?![-+])", "*", script.write(e)).replace("^", "**")
        expected = float(substituted(e, numbers, sp.Rational(3, 8), sp.Rational(5, 8)))
        assert evaluate(parse(text, frozenset(env)), env) == pytest.approx(expected, rel=1e-10, abs=1e-10), (
            text
        )


@ALL
def test_the_latex_is_balanced_and_can_be_typeset(model: RodModel) -> None:
    """Braces, left and right, environments; and every row parses as mathematics."""
    latex = to_latex(document(derive(model)))
    assert latex.count("{") == latex.count("}")
    assert len(re.findall(r"\\left\b", latex)) == len(re.findall(r"\\right\b", latex))
    assert re.findall(r"\\begin\{(.*?)\}", latex) == re.findall(r"\\end\{(.*?)\}", latex)
    assert latex.count("$") % 2 == 0
    parser = MathTextParser("agg")
    rows = [
        row.replace("&", "")
        for block in re.findall(r"\\begin\{(?:align|equation)\*\}\n(.*?)\n\\end", latex, re.DOTALL)
        for row in block.split("\\\\\n")
    ]
    formulas = [f.replace(r"\mathsf T", "T") for f in re.findall(r"\$(.*?)\$", latex)]
    for formula in (*rows[:: 1 + len(rows) // 50], *formulas):
        parser.parse(f"${formula}$")
    assert len(rows) > 10


def names_in(latex: str) -> set[str]:
    """Fields and parameters in the equations of a LaTeX text."""
    body = "".join(re.findall(r"\\begin\{align\*\}\n(.*?)\\end", latex, re.DOTALL))
    body = re.sub(r"\\(?:dot|frac|quad|left|right|sqrt|sin|cos|exp|mathrm)\b", " ", body)
    return {letter + index for letter, index in re.findall(r"\\?([A-Za-z]+)\}?(?:_\{(\w+)\})?", body)}


@ALL
def test_the_latex_contains_the_fields_of_the_scene_and_no_other(model: RodModel) -> None:
    """Names in the equations are the fields, the parameters and the coordinates that occur, and no others."""
    equations = derive(model)
    document_ = document(equations)
    found = names_in(to_latex(document_))
    expected = set(equations.fields) | set(equations.parameters) | {"epsilon", "delta"}
    assert found - {"u", "t"} == expected


@pytest.mark.parametrize("model", [PLAIN_PLANAR, PLAIN_SPATIAL], ids=["planar", "spatial"])
def test_a_scene_without_weight_mentions_no_orientation(model: RodModel) -> None:
    """No heading, no symbol, no word of it in text or LaTeX."""
    for text in (to_text(document(derive(model))), to_latex(document(derive(model)))):
        for word in ("rientation", "theta", "θ", "Rᵀ", r"R^", "world", "e_{1", "e₁", "weight"):
            assert word not in text, word
    assert "Orientation" in to_text(document(derive(HEAVY_PLANAR)))
    assert r"R^{\mathsf T} f" in to_latex(document(derive(HEAVY_SPATIAL)))


def test_lines_are_broken_at_the_width() -> None:
    """No equation is wider than asked; what goes on in the next line is indented further."""
    text = to_text(document(derive(PLAIN_SPATIAL)), width=40)
    equations = [line for line in text.splitlines() if "=" in line and "," not in line and ":" not in line]
    assert max(map(len, equations)) <= 42
    assert any(line.startswith("       +") for line in text.splitlines())


def test_a_parameter_that_has_the_name_of_a_field_is_marked() -> None:
    """F1 of the scene and F1 the stress are told apart; so are epsilon and the energy."""
    model = dataclasses.replace(PLAIN_PLANAR, stiffness=diagonal("F1", "epsilon", 1))
    text = to_text(document(derive(model)))
    assert "F₁ = F1_par (h₁" in text
    assert "F1_par = 2, epsilon_par = 0.05" in text
    assert r"\mathrm{F1\_par}" in to_latex(document(derive(model)))


def test_parameters_are_listed_with_their_values() -> None:
    """Only those that occur."""
    assert "with    κ = 10000\n" in to_text(document(derive(PLAIN_PLANAR)))
    assert "with    κ = 10000, g = 9.81, a = 0.3, b = 0.7\n" in to_text(document(derive(HEAVY_PLANAR)))


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("0", "0"), ("10000", "10000"), ("1/100", "0.01"), ("1/2", "1/2"), ("5/16", "0.3125"), ("1/3", "1/3"),
        ("1/30", "1/30"), ("1e-9", "1e-9"), ("2e12", "2e12"), ("123456789", "123456789"),
        ("1e-300", "1e-300"),
    ],
)  # fmt: skip
def test_numbers_are_short_and_exact(value: str, text: str) -> None:
    """Decimals where they are short, fractions where those read better, never a rounded one."""
    number = sp.Rational(value)
    assert (decimal(number) or str(number)) == text
    assert sp.Rational(text) == number


x, a, b = symbol("x1"), symbol("a"), symbol("b")
h, Pi, F = field("h1"), field("Pi"), field("F1")


@pytest.mark.parametrize(
    ("e", "text", "latex"),
    [
        (-h, "-h1", "-h_{1}"),
        (h - a, "h1 - a", "h_{1} - a"),
        (a - h, "a - h1", "a - h_{1}"),
        (a * (h + b) / -2, "-a (h1 + b)/2", r"-\frac{a \, \left(h_{1} + b\right)}{2}"),
        (h / (2 * a), "h1/(2 a)", r"\frac{h_{1}}{2 \, a}"),
        ((h + 1) / a, "(h1 + 1)/a", r"\frac{h_{1} + 1}{a}"),
        (1 / (a + b), "1/(a + b)", r"\frac{1}{a + b}"),
        (1 / a**2, "1/a^2", r"\frac{1}{a^{2}}"),
        ((a + 1) ** U, "(a + 1)^u", r"\left(a + 1\right)^{u}"),
        (a ** (-U), "a^(-u)", "a^{-u}"),
        (sp.sqrt(a) / 2, "sqrt(a)/2", r"\frac{\sqrt{a}}{2}"),
        (1 / sp.sqrt(a), "1/sqrt(a)", r"\frac{1}{\sqrt{a}}"),
        (a ** sp.Rational(3, 2), "a^(3/2)", r"a^{\frac{3}{2}}"),
        (sp.exp(1) * a, "e a", r"e \, a"),
        (sp.Abs(U - 1), "|u - 1|", r"\left|u - 1\right|"),
        (sp.sign(U - a), "sign(u - a)", r"\operatorname{sign}\left(u - a\right)"),
        (sp.Heaviside(U - a), "heaviside(u - a)", r"H\left(u - a\right)"),
        (sp.Rational(-1, 3) * h, "-h1/3", r"-\frac{h_{1}}{3}"),
        (h.diff(T), "h1_t", r"\dot{h}_{1}"),
        (Pi.diff(T).diff(U, 2), "Pi_tuu", r"\dot{\Pi}''"),
        (h.diff(U) ** 2, "h1_u^2", r"h_{1}'^{2}"),
        (F * Pi.diff(U) * a * 2, "2 a F1 Pi_u", r"2 \, a \, F_{1} \, \Pi'"),
        (2 * sp.pi * symbol("kappa_1"), "2 pi kappa_1", r"2 \, \pi \, \kappa_{1}"),
        (symbol("Ex") * 3, "3 Ex", r"3 \, \mathrm{Ex}"),
        (sp.Rational(1, 10**9) * h, "1e-9 h1", r"10^{-9} \, h_{1}"),
        (sp.Integer(2), "2", "2"),
        (sp.Mul(-1, h + 1, evaluate=False), "-(h1 + 1)", r"-\left(h_{1} + 1\right)"),
    ],
)
def test_expressions_are_written_with_the_brackets_they_need(e: sp.Expr, text: str, latex: str) -> None:
    """Signs, quotients, powers, functions and derivatives, as text and as LaTeX."""
    assert Text(unicode=False).write(e) == text
    assert Latex().write(e) == latex


def test_derivatives_have_dots_and_primes() -> None:
    """A letter that has no dotted form takes a combining dot."""
    script = Text()
    assert script.write(h.diff(T)) == "ḣ₁"
    assert script.write(Pi.diff(T)) == "Π\N{COMBINING DOT ABOVE}"
    assert script.write(Pi.diff(U, 2)) == "Π" + PRIME * 2
    assert script.write(h**2 - 1) == f"h₁² {MINUS} 1"


def test_an_unknown_form_is_refused() -> None:
    """The forms that there are, are named."""
    with pytest.raises(ValueError, match=r"form: expected one of intrinsic, .*found 'printed'; choose one"):
        document(derive(PLAIN_PLANAR), "printed")


@pytest.mark.usefixtures("patience")
def test_the_fullest_spatial_rod_is_derived_and_printed() -> None:
    """Full matrices, weight and loads: text and LaTeX name every field that there is."""
    equations = derive(HEAVY_SPATIAL)
    laid_out = document(equations)
    assert len(to_text(laid_out)) > 1000
    assert all(name[0] in to_latex(laid_out) for name in equations.fields)


def test_a_clamped_rod_with_a_dead_load_needs_the_orientation_but_has_no_weight_term() -> None:
    """The load on the end sees the world; the wrench does not."""
    model = dataclasses.replace(PLAIN_PLANAR, right=End("free", force=vector(0, -1), frame="world"))
    text = to_text(document(derive(model)))
    assert "Orientation" in text
    assert "Rᵀ" not in text
    heavy = to_text(document(derive(dataclasses.replace(PLAIN_PLANAR, effects=(Weight(vector(0, -1)),)))))
    assert "Rᵀ f" in heavy


def test_the_modules_build_no_expression_from_text() -> None:
    """No sympify, parse_expr, eval or exec in the stage."""
    for path in Path(str(printing.__file__)).parent.glob("*.py"):
        called = {
            node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.Call)
        }
        assert not called & {"eval", "exec", "sympify", "parse_expr", "simplify"}, path
