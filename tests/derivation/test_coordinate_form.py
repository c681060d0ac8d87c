"""The equations in a chart, printed: readable, valid LaTeX, one message for what there is not."""

from __future__ import annotations

import dataclasses
import re
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from click.testing import CliRunner
from matplotlib.mathtext import MathTextParser

import geocosserat
from geocosserat.algebra.groups import Group
from geocosserat.cli import main
from geocosserat.derivation.document import Document
from geocosserat.derivation.equations import derive
from geocosserat.derivation.forms import document
from geocosserat.derivation.printing import to_latex, to_text
from geocosserat.derivation.writing import Text
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import evaluate, parse
from geocosserat.model.records import End
from tests.derivation.charted import CASES, HEAVY, PLAIN, SPATIAL, SWEPT
from tests.derivation.rods import PLAIN_PLANAR, PLAIN_SPATIAL, VALUES, diagonal, jets, substituted

PRIME, MINUS = "\N{PRIME}", "\N{MINUS SIGN}"
KINDS = {"heavy": HEAVY, "plain": PLAIN, "swept": SWEPT}
PRINTED = pytest.mark.parametrize(
    ("group", "name", "kind"), [(*case, kind) for case in CASES for kind in KINDS], ids=lambda x: getattr(x, "name", x)
)


@pytest.fixture
def laid_out(group: Group, name: str, kind: str) -> Document:
    """The equations of a rod in a chart, ready to print."""
    return _laid_out(group, name, kind)


@lru_cache(maxsize=20)
def _laid_out(group: Group, name: str, kind: str) -> Document:
    return document(derive(KINDS[kind][group]), "coordinates", name)


@PRINTED
def test_text_is_ascii_where_it_must_be_and_no_line_is_too_wide(laid_out: Document) -> None:
    """In both alphabets."""
    plain, text = to_text(laid_out, unicode=False), to_text(laid_out)
    assert plain.isascii()
    assert not text.isascii()
    names = ("  chart", "  turn", "  twist", "  stress", "  with")
    if "weight" not in laid_out.title and "trap" not in laid_out.title:  # single terms of these are wider
        assert all(len(line) <= 104 for line in plain.splitlines() if not line.startswith(names))


@PRINTED
def test_the_latex_is_balanced_and_can_be_typeset(laid_out: Document) -> None:
    """Braces, left and right, environments; every row parses as mathematics; words are there too."""
    latex = to_latex(laid_out)
    assert latex.count("{") == latex.count("}")
    assert len(re.findall(r"\\left\b", latex)) == len(re.findall(r"\\right\b", latex))
    assert re.findall(r"\\begin\{(.*?)\}", latex) == re.findall(r"\\end\{(.*?)\}", latex)
    assert latex.count("$") % 2 == 0
    blocks = re.findall(r"\\begin\{(?:align|equation)\*\}\n(.*?)\n\\end", latex, re.DOTALL)
    rows = [row.replace("&", "") for block in blocks for row in block.split("\\\\\n")]
    formulas = [f.replace(r"\mathsf T", "T") for f in re.findall(r"\$(.*?)\$", latex)]
    parser = MathTextParser("agg")
    for formula in (*rows[:: 1 + len(rows) // 12], *formulas):
        parser.parse(f"${formula}$")
    for section in laid_out.sections:
        assert section.remark in latex
    outside = re.sub(r"\\begin\{(align|equation)\*\}.*?\\end\{\1\*\}|\$.*?\$", "", latex, flags=re.DOTALL)
    assert not re.search(r"[\^&#%<>_]", outside)


@PRINTED
def test_every_printed_side_has_the_value_of_what_was_derived(laid_out: Document) -> None:
    """Written in ASCII and read back with the products put in."""
    script = Text(unicode=False)
    rng = np.random.default_rng(72)
    equations = [equation for section in laid_out.sections for equation in section.equations]
    for e in (side for equation in equations for side in (equation.left, equation.right)):
        numbers = {jet: sp.Rational(int(rng.integers(1, 200)), 64) for jet in jets([e])}
        env = VALUES | {script.write(jet): float(x) for jet, x in numbers.items()} | {"u": 3 / 8, "t": 5 / 8}
        text = re.sub(r"(?<![-+]) (?![-+])", "*", script.write(e)).replace("^", "**")
        expected = float(substituted(e, numbers, sp.Rational(3, 8), sp.Rational(5, 8)))
        assert evaluate(parse(text, frozenset(env)), env) == pytest.approx(expected, rel=1e-10, abs=1e-9), text


@PRINTED
def test_a_document_says_what_its_chart_is_and_where_it_fails(laid_out: Document) -> None:
    """Headings in reading order, with the convention and the singular set."""
    headings = [section.heading for section in laid_out.sections]
    assert len(set(headings)) == len(headings)
    assert headings[0] == "Chart"
    assert headings[-1] == "Singular set"
    assert {"Turn", "Stress", "Motion", "Rates"} <= set(headings)
    assert laid_out.sections[0].remark
    assert laid_out.sections[-1].remark
    assert bool(laid_out.sections[-1].equations) == (not laid_out.sections[-1].remark.startswith("None"))
    assert ", in the chart " in laid_out.title


def test_the_planar_rod_reads_as_one_would_write_it() -> None:
    """Definitions, motion, rates, and the equations of x, y and theta alone."""
    model = dataclasses.replace(PLAIN_PLANAR, friction=diagonal(1, 1, 0.01))
    text = to_text(document(derive(model), "coordinates")).replace(PRIME, "'").replace(MINUS, "-")
    for line in (
        "Planar rod, SE(2), in the chart angle: elasticity, friction",
        "  chart   q = (x, y, θ)",
        "  h₁ = cos(θ) x' + sin(θ) y'",
        "  h₂ = cos(θ) y' - sin(θ) x'",
        "   Π = θ'",
        "  ẋ = v₁ cos(θ) - v₂ sin(θ)",
        "       ẋ = κ sin(θ) θ' + κ x''",
        "       ẏ = κ y'' - κ cos(θ) θ'",
        "  0.01 θ̇ = θ'' - κ sin(θ) x' + κ cos(θ) y'",
        "  ẋ = 0,  ẏ = 0,  θ̇ = 0",
    ):
        assert line in text.splitlines(), line


def test_euler_angles_read_as_in_the_textbooks() -> None:
    """The body rates of z-y'-x'' angles."""
    text = to_text(document(derive(PLAIN_SPATIAL), "coordinates", "euler"), unicode=False)
    for line in (
        "  Pi1 = phi_u - sin(theta) psi_u",
        "  Pi2 = cos(phi) theta_u + cos(theta) sin(phi) psi_u",
        "  Pi3 = cos(theta) cos(phi) psi_u - sin(phi) theta_u",
        "  theta_t = Omega2 cos(phi) - Omega3 sin(phi)",
        "  cos(theta) = 0",
    ):
        assert line in text.splitlines(), line


def test_a_parameter_that_looks_like_a_coordinate_is_marked() -> None:
    """Its own name, the same with an underscore, and the name of a rate; others stay as they are."""
    names = ("theta1", "x", "c_2", "x_t", "theta_1", "d2_u", "theta4", "x_top")
    known = frozenset(names)
    stiffness = tuple(tuple(parse(names[i] if i == j else 0, known) for j in range(6)) for i in range(6))
    weight = tuple(parse(name, known) for name in names[6:])
    model = dataclasses.replace(
        PLAIN_SPATIAL,
        stiffness=stiffness,
        right=End("free", force=(*weight, parse(0, known))),
        parameters={name: 2.0 + k for k, name in enumerate(names)},
    )
    text = to_text(document(derive(model), "coordinates"), unicode=False)
    (line,) = [line for line in text.splitlines() if line.startswith("  with")]
    assert line == (
        "  with    theta1_par = 2, x_par = 3, c_2_par = 4, x_t_par = 5, theta_1_par = 6, d2_u_par = 7, "
        "theta4 = 8, x_top = 9"
    )
    assert "  F1 = theta1_par (h1 - 1)" in text.splitlines()


def test_the_forms_and_charts_that_there_are_not_are_refused() -> None:
    """By the layout itself."""
    equations = derive(PLAIN_PLANAR)
    with pytest.raises(ValueError, match="chart: expected one of angle, found 'euler'; choose one"):
        document(equations, "coordinates", "euler")
    with pytest.raises(ValueError, match="chart: expected none for the form intrinsic, found 'angle'; leave it out"):
        document(equations, "intrinsic", "angle")


def test_a_chart_is_chosen_from_python(examples: Path) -> None:
    """By default the angle in the plane and the rotation vector in space; the fields say which."""
    for file, default, other in (("sinking", "angle", None), ("hanging", "rotation-vector", "quaternion")):
        scene = examples / f"{file}.toml"
        equations = geocosserat.derive(scene, "coordinates")
        assert (equations.form, equations.fields["chart"]) == ("coordinates", default)
        assert f"in the chart {default}" in equations.text
        assert f"in the chart {default}" in equations.latex
        if other:
            assert f"in the chart {other}" in geocosserat.derive(scene, "coordinates", chart=other).text
        assert geocosserat.derive(scene).fields["chart"] is None


@pytest.mark.parametrize(
    ("file", "form", "chart", "message"),
    [
        (
            "hanging", "coordinates", "angles",
            "--chart: expected one of rotation-vector, quaternion, cayley, euler, matrix, for a spatial rod, "
            "found 'angles'; choose one of these, or leave it out",
        ),
        ("hanging", "coordinates", "angle", "for a spatial rod, found 'angle'"),
        ("sinking", "coordinates", "euler", "--chart: expected angle, for a planar rod, found 'euler'"),
        (
            "sinking", "intrinsic", "angle",
            "--chart: expected no chart for the form intrinsic, found 'angle'; leave it out, or say --form coordinates",
        ),
    ],
)  # fmt: skip
def test_charts_that_there_are_not_are_refused(examples: Path, file: str, form: str, chart: str, message: str) -> None:
    """One message, from Python and from the command line, that names the choices."""
    scene = str(examples / f"{file}.toml")
    with pytest.raises(InputError, match=re.escape(message)):
        geocosserat.derive(scene, form, chart=chart)
    done = CliRunner().invoke(main, ["derive", scene, "--form", form, "--chart", chart])
    assert (done.exit_code, done.stdout) == (2, "")
    assert message in done.stderr


@pytest.mark.parametrize("name", SPATIAL)
@pytest.mark.usefixtures("patience")
def test_the_command_line_prints_every_chart(examples: Path, name: str) -> None:
    """As text and as LaTeX."""
    words = ["derive", str(examples / "helix.toml"), "--form", "coordinates", "--chart", name]
    text, latex = (CliRunner().invoke(main, [*words, *more]) for more in ([], ["--latex"]))
    assert (text.exit_code, latex.exit_code) == (0, 0)
    assert f"in the chart {name}" in text.stdout
    assert latex.stdout.startswith(rf"\section*{{Spatial rod, SE(3), in the chart {name}")
