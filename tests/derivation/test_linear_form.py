"""The linear equations, printed: as text and as LaTeX, for every kind of rod, and from the command line."""

from __future__ import annotations

import json
import re
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from click.testing import CliRunner
from matplotlib.mathtext import MathTextParser

import geocosserat
from geocosserat.cli import main
from geocosserat.derivation.document import Document
from geocosserat.derivation.equations import derive
from geocosserat.derivation.forms import document
from geocosserat.derivation.notation import field, symbol
from geocosserat.derivation.printing import to_latex, to_text
from geocosserat.derivation.writing import Latex, Text
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import evaluate, parse
from tests.derivation.displaced import MODELS
from tests.derivation.rods import PLAIN_PLANAR, jets
from tests.derivation.scenes import FROZEN, planar

PRIME, MINUS = "\N{PRIME}", "\N{MINUS SIGN}"
NAMES = ("plain planar", "plain spatial", "SE(2) all effects", "stepped", "planar law", "swimmer")
PRINTED = pytest.mark.parametrize("name", [*NAMES, *(name for name in MODELS if name in FROZEN)])


@lru_cache(maxsize=20)
def laid_out(name: str) -> Document:
    """The linear equations of that rod, ready to print."""
    return document(derive(MODELS[name]), "linearised")


@PRINTED
def test_text_is_ascii_where_it_must_be_and_headings_are_told_apart(name: str) -> None:
    """In both alphabets; every section has a heading of its own."""
    found = laid_out(name)
    plain, text = to_text(found, unicode=False), to_text(found)
    assert plain.isascii()
    assert "δ" in text
    headings = [section.heading for section in found.sections]
    assert len(set(headings)) == len(headings)
    assert headings[0] == "Base"
    assert {"Motion", "Advection", "Reaction"} <= set(headings)
    assert ("Mass" in headings) == (name in FROZEN)


@PRINTED
def test_the_latex_is_balanced_and_can_be_typeset(name: str) -> None:
    """Braces and environments; rows and formulas parse as mathematics."""
    latex = to_latex(laid_out(name))
    assert latex.count("{") == latex.count("}")
    assert re.findall(r"\\begin\{(.*?)\}", latex) == re.findall(r"\\end\{(.*?)\}", latex)
    assert latex.count("$") % 2 == 0
    blocks = re.findall(r"\\begin\{(?:align|equation)\*\}\n(.*?)\n\\end", latex, re.DOTALL)
    rows = [row.replace("&", "") for block in blocks for row in block.split("\\\\\n")]
    formulas = [f.replace(r"\text{from}", r"\mathrm{from}") for f in re.findall(r"\$(.*?)\$", latex)]
    parser = MathTextParser("agg")
    for formula in (*rows[:: 1 + len(rows) // 12], *formulas):
        parser.parse(f"${formula}$")
    outside = re.sub(r"\\begin\{(align|equation)\*\}.*?\\end\{\1\*\}|\$.*?\$", "", latex, flags=re.DOTALL)
    assert not re.search(r"[\^&#%<>_]", outside.replace(r"\&", ""))


@PRINTED
def test_every_printed_side_has_the_value_of_what_was_derived(name: str) -> None:
    """Written in ASCII and read back with the products put in."""
    script = Text(unicode=False)
    rng = np.random.default_rng(74)
    sides = [side for section in laid_out(name).sections for e in section.equations for side in (e.left, e.right)]
    for e in sides:
        known = {jet: sp.Rational(int(rng.integers(1, 200)), 64) for jet in jets([e])}
        named = {s: sp.Rational(int(rng.integers(1, 200)), 64) for s in e.free_symbols}
        # entries beyond the ninth have a comma
        env = {script.write(x).replace(",", "_"): float(y) for x, y in (known | named).items()}
        text = re.sub(r"(?<![-+]) (?![-+])", "*", script.write(e)).replace("^", "**").replace(",", "_")
        slopes = {f: x for f, x in known.items() if isinstance(f, sp.Derivative)}
        expected = float(e.xreplace(slopes).xreplace(known).xreplace(named).evalf(30))
        assert evaluate(parse(text, frozenset(env)), env) == pytest.approx(expected, rel=1e-10, abs=1e-9), text


def test_the_planar_rod_reads_as_one_would_write_it() -> None:
    """Entries of the matrices, the stress of the base in them, the ends, and the rod at rest spelt out."""
    text = to_text(document(derive(PLAIN_PLANAR), "linearised")).replace(PRIME, "'").replace(MINUS, "-")
    for line in (
        "Linearised planar rod, SE(2): elasticity, friction",
        "  shift   η = (η₁, η₂, η₃)",
        "Change of the turn:  δE = η' + ad_E η",
        "  δh₂ = η₂' + Π η₁ - h₁ η₃",
        "Motion:  η̇ = D η'' + A η' + R η, from Γ (η̇ + ad_V η) = δΣ' + ad*_E δΣ + ad*_δE Σ",
        "  D₁₁ = κ,  D₂₂ = κ/2,  D₃₃ = 100",
        "  A₃₂ = 100 κ h₁ - 100 F₁",
        "  R₁₂ = Ω - κ Π'",
        "  η₁ = 0,  η₂ = 0,  η₃ = 0",
        "  δF₁ = 0,  δF₂ = 0,  δM = 0",
        "Turn alone:  δĖ = D δE'' + A δE' + R δE, from δĖ = δV' + ad_E δV + ad_δE V",
        "  δv₁ = 0,  δv₂ = 0,  δΩ = 0",
        "  η̇₁ = κ η₁''",
        "  δḣ₁ = κ δh₁''",
    ):
        assert line in text.splitlines(), line
    plain = to_text(document(derive(PLAIN_PLANAR), "linearised"), unicode=False).splitlines()
    assert "  eta1_t = kappa eta1_uu" in plain
    assert "  dh2 = eta2_u + Pi eta1 - h1 eta3" in plain


def test_a_change_is_written_with_its_letter_and_a_parameter_of_that_name_is_told_apart() -> None:
    """dF1 the field is delta F1, dots and primes on the F; dM the parameter is no change of M."""
    dF1 = field("dF1")
    t, u = symbol("t"), symbol("u")
    assert (Text().write(dF1.diff(t)), Latex().write(dF1.diff(t))) == ("δḞ₁", r"\delta \dot{F}_{1}")
    assert Text(unicode=False).write(field("dPi").diff(u)) == "dPi_u"
    assert Latex().write(field("dPi").diff(u)) == r"\delta \Pi'"
    assert (Text().write(symbol("dM")), Latex().write(symbol("dM"))) == ("dM", r"\mathrm{dM}")
    assert Text().write(field("d2")) == "d₂"


def test_what_a_scene_lacks_is_not_mentioned() -> None:
    """No world, no steps, no multipliers, no mass where there are none; S where there is a world to see."""
    text = to_text(document(derive(planar()), "linearised"))
    for word in ("S η", "steps", "multiplier", "Mass", "theta"):
        assert word not in text, word
    seen = to_text(laid_out("SE(2) all effects"))
    assert "+ S η" in seen
    assert "Turn alone" not in seen
    assert "between steps" in to_text(laid_out("stepped"))


def test_the_command_line_prints_it_in_every_way(examples: Path) -> None:
    """Text, LaTeX and one JSON object; no chart is taken, and viscous laws are refused with one message."""
    scene = str(examples / "cantilever.toml")
    words = ["derive", scene, "--form", "linearised"]
    text, latex, fields = (CliRunner().invoke(main, [*words, *more]) for more in ([], ["--latex"], ["--json"]))
    assert (text.exit_code, latex.exit_code, fields.exit_code) == (0, 0, 0)
    both = json.loads(fields.stdout)
    assert (both["form"], both["text"], both["latex"]) == ("linearised", text.stdout, latex.stdout)
    assert geocosserat.derive(scene, "linearised").text == text.stdout
    with pytest.raises(InputError, match="no chart for the form linearised"):
        geocosserat.derive(scene, "linearised", chart="angle")
    creeps = "rod.law.stress={F1='h1 - 1', F2='h2', M='Pi + Pi_dot'}"
    settings = [word for value in ("rod.law.motion='planar'", creeps) for word in ("--set", value)]
    viscous = CliRunner().invoke(main, [*words, *settings])
    assert viscous.exit_code == 2
