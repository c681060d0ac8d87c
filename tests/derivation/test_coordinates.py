"""The equations in a chart are the chart-free ones at the same motion, closed, readable and valid LaTeX."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from click.testing import CliRunner
from matplotlib.mathtext import MathTextParser

import geocosserat
from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.cli import main
from geocosserat.derivation.coordinates import CoordinateEquations, in_chart, put_in
from geocosserat.derivation.document import Document
from geocosserat.derivation.equations import derive
from geocosserat.derivation.forms import document
from geocosserat.derivation.notation import T, U, field, field_names, symbol
from geocosserat.derivation.printing import to_latex, to_text
from geocosserat.derivation.records import Equation, FieldEquations
from geocosserat.derivation.writing import Text
from geocosserat.model.effects.flow import Flow
from geocosserat.model.effects.trap import Trap
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import evaluate, parse
from geocosserat.model.records import End, RodModel
from tests.derivation.charted import CASES, IDS, SPATIAL, Point, jet, measured
from tests.derivation.rods import (
    HEAVY_PLANAR,
    HEAVY_SPATIAL,
    PLAIN_PLANAR,
    PLAIN_SPATIAL,
    POINTS,
    TINY,
    VALUES,
    diagonal,
    jets,
    substituted,
    vector,
)

ALL = pytest.mark.parametrize(("group", "name"), CASES, ids=IDS)
HEAVY = {SE2: HEAVY_PLANAR, SE3: HEAVY_SPATIAL}
# frozen modes, a rotation without friction, effects that see place and orientation, a pinned and a driven end
SWEPT = {
    SE2: dataclasses.replace(
        HEAVY_PLANAR,
        friction=diagonal(1, 2, 0),
        frozen=("h1",),
        left=End("pinned", torque=vector("a*t")),
        right=End("driven", twist=vector(1, "t", "a")),
        effects=(Trap(vector("a"), vector("t", "b")), Flow(vector(1, "a", 2, -1), vector("t", 1))),
    ),
    SE3: dataclasses.replace(
        HEAVY_SPATIAL,
        frozen=("h2", "Pi1"),
        left=End("pinned", torque=vector("a*t", 1, 2), frame="world"),
        right=End("driven", twist=vector(1, "t", "a", 0, 0, "t")),
        effects=(Trap(vector("a"), vector("t", "b", 1)), Flow(vector(1, 2, 0, "a", -1, 0, 3, 0, 0), vector("t", 1, 0))),
    ),
}
PLAIN = {SE2: PLAIN_PLANAR, SE3: PLAIN_SPATIAL}
Made = Callable[[Group, str], CoordinateEquations]
PRIME, MINUS = "\N{PRIME}", "\N{MINUS SIGN}"


@lru_cache(maxsize=20)
def heavy(group: Group, name: str) -> CoordinateEquations:
    """Full matrices, two weights, both ends loaded, in that chart."""
    return in_chart(derive(HEAVY[group]), name)


@lru_cache(maxsize=20)
def swept(group: Group, name: str) -> CoordinateEquations:
    """Frozen modes, a trap, a flow, a pinned and a driven end, in that chart."""
    return in_chart(derive(SWEPT[group]), name)


@lru_cache(maxsize=30)
def chart_free(group: Group, name: str, point: Point) -> dict[sp.Expr, sp.Expr]:
    """Turn, twist, frame and place of that motion there, with numbers for multipliers."""
    return measured(group, name, point) | multipliers(point)


def multipliers(point: Point) -> dict[sp.Expr, sp.Expr]:
    """Stresses as smooth functions of (u, t), with their slopes, at a point."""
    out = {}
    for k, name in enumerate((*SE2.stress, *SE3.stress), 1):
        stress = sp.sin(U + k * T) + U * T
        out |= {field(name): stress, field(name).diff(U): stress.diff(U)}
    return {f: x.subs(dict(zip((U, T), point, strict=True))).evalf(50) for f, x in out.items()}


def charted(system: CoordinateEquations, e: sp.Expr, point: Point) -> sp.Expr:
    """An expression of the system there: by the coordinates alone, through all that they define."""
    group, name = system.equations.group, system.chart.name
    return substituted(e, {x: _defined(group, name, x, point) for x in jets([e])}, *point)


@lru_cache(maxsize=10_000)
def _defined(group: Group, name: str, e: sp.Expr, point: Point) -> sp.Expr:
    """A field or a derivative of one: of a coordinate, or by its definition; or else a multiplier."""
    base, orders = (e.expr, e.variable_count) if isinstance(e, sp.Derivative) else (e, ())
    system = heavy(group, name)
    if base in system.coordinates:
        return jet(group, name, e, point)
    for equation in (*system.frame, *system.turn, *system.twist):
        if equation.left == base:
            return charted(system, equation.right.diff(*orders) if orders else equation.right, point)
    return multipliers(point)[e]


@ALL
def test_turn_and_twist_are_those_of_the_differentiated_frame(group: Group, name: str) -> None:
    """E and V by the coordinates against R^T R', R^T r', R^T dR/dt, R^T dr/dt of an independent R, differenced."""
    system = heavy(group, name)
    for point in POINTS:
        for equation in (*system.turn, *system.twist):
            expected = chart_free(group, name, point)[equation.left]
            assert abs(charted(system, equation.right, point) - expected) < TINY, equation
            assert abs(expected) > 1e-4
    assert tuple(e.left for e in (*system.turn, *system.twist)) == (*system.equations.turn, *system.equations.twist)


@ALL
def test_rates_undo_the_twist(group: Group, name: str) -> None:
    """The twist of a motion, put into the rates, gives the rates of its coordinates."""
    system = heavy(group, name)
    assert tuple(e.left for e in system.rates) == tuple(q.diff(T) for q in system.coordinates)
    for equation in system.rates:
        assert abs(charted(system, equation.residual, POINTS[0])) < TINY, equation
        assert abs(charted(system, equation.left, POINTS[0])) > 1e-6


@ALL
def test_compatibility_holds_of_its_own_accord(group: Group, name: str) -> None:
    """Turn and twist of any coordinates satisfy dE/dt = V' + ad_E V."""
    system = heavy(group, name)
    for equation in system.equations.compatibility:
        assert abs(charted(system, equation.residual, POINTS[0])) < TINY, equation
        assert abs(charted(system, equation.left, POINTS[0])) > 1e-6


@ALL
@pytest.mark.parametrize("made", [heavy, swept])
def test_the_motion_has_the_residual_of_the_chart_free_form(group: Group, name: str, made: Made) -> None:
    """Full stiffness and friction, weight, trap, flow: the same numbers from the coordinates as from E, V and frame."""
    system = made(group, name)
    for point in POINTS:
        for row, equation in zip(system.motion, system.equations.motion, strict=True):
            found = charted(system, row.residual, point)
            expected = substituted(equation.residual, chart_free(group, name, point), *point)
            assert abs(found - expected) < TINY * (1 + abs(expected)), equation
            assert abs(expected) > 1e-3


@ALL
@pytest.mark.parametrize("made", [heavy, swept])
def test_ends_have_the_residual_of_the_chart_free_form(group: Group, name: str, made: Made) -> None:
    """Loaded in the body and in the world, pinned and driven; stresses by their law."""
    system = made(group, name)
    free = chart_free(group, name, POINTS[0])
    laws = {e.left: e.right for e in system.stress_law}
    for rows, end in ((system.left, system.equations.left), (system.right, system.equations.right)):
        if end.kind == "clamped":  # see below
            continue
        assert len(rows) == len(end.equations) > 0
        for a, b in zip(rows, end.equations, strict=True):
            found = charted(system, a.residual.xreplace(laws), POINTS[0])
            expected = substituted(b.residual.xreplace(laws), free, *POINTS[0])
            assert abs(found - expected) < TINY * (1 + abs(expected)), b
            assert abs(expected) > 1e-3


def test_a_clamped_end_keeps_its_coordinates() -> None:
    """No twist is no rate, also where there are more coordinates than twists."""
    for group, name in CASES:
        system = in_chart(derive(PLAIN[group]), name)
        assert [(e.left, e.right) for e in system.left] == [(q.diff(T), 0) for q in system.coordinates]
        still = put_in(system.rates[-1].right, dict.fromkeys(system.equations.twist, sp.S.Zero))
        assert still == 0


@ALL
def test_rates_keep_the_constraint(group: Group, name: str) -> None:
    """Its rate of change, with the rates of the coordinates put in, is zero where it holds."""
    system = heavy(group, name)
    rates = {e.left: e.right for e in system.rates}
    for equation in system.constraint:
        assert abs(charted(system, equation.residual, POINTS[0])) < TINY
        assert abs(charted(system, equation.left.diff(T).xreplace(rates), POINTS[0])) < TINY
    assert len(system.constraint) == len(system.coordinates) - group.dimension


def test_the_usual_planar_equations_come_out_as_one_writes_them() -> None:
    """Equal stiffness k and friction g: g x_t = k (x'' + theta' sin), g y_t = k (y'' - theta' cos), and the angle's."""
    stiffness, friction = diagonal("kappa", "kappa", "b"), diagonal("g", "g", "a")
    model = dataclasses.replace(PLAIN_PLANAR, stiffness=stiffness, friction=friction)
    x, y, theta = (field(name) for name in ("x", "y", "theta"))
    k, g, a, b = (symbol(name) for name in ("kappa", "g", "a", "b"))
    expected = [
        (g * x.diff(T), k * (x.diff(U, 2) + theta.diff(U) * sp.sin(theta))),
        (g * y.diff(T), k * (y.diff(U, 2) - theta.diff(U) * sp.cos(theta))),
        (a * theta.diff(T), b * theta.diff(U, 2) + k * (y.diff(U) * sp.cos(theta) - x.diff(U) * sp.sin(theta))),
    ]
    for equation, (left, right) in zip(in_chart(derive(model)).alone, expected, strict=True):
        assert sp.expand(equation.left - left) == 0
        assert sp.expand(equation.right - right) == 0


def planar_by_hand(model: RodModel) -> list[Equation]:
    """Forces and moments of a planar rod with diagonal laws, balanced in the world's axes; derived by hand."""
    x, y, theta = (field(name) for name in ("x", "y", "theta"))
    c, s = sp.cos(theta), sp.sin(theta)
    expression = derive(model)
    (k1, k2, k3), (g1, g2, g3) = ([sp.S(e.coeff(f)) for e, f in pairs] for pairs in laws(expression))
    h1, h2, bend = (law.right.xreplace(dict.fromkeys(expression.turn, sp.S.Zero)) for law in expression.stress_law)
    axial = k1 * (c * x.diff(U) + s * y.diff(U)) + h1
    shear = k2 * (c * y.diff(U) - s * x.diff(U)) + h2
    force_x, force_y = axial * c - shear * s, axial * s + shear * c
    along, across = c * x.diff(T) + s * y.diff(T), c * y.diff(T) - s * x.diff(T)
    weight_y = -symbol("g") * (1 + U)
    return [
        Equation(g1 * along * c - g2 * across * s, force_x.diff(U)),
        Equation(g1 * along * s + g2 * across * c, force_y.diff(U) + weight_y),
        Equation(g3 * theta.diff(T), (k3 * theta.diff(U) + bend).diff(U) + x.diff(U) * force_y - y.diff(U) * force_x),
    ]


def laws(equations: FieldEquations) -> list[list[tuple[sp.Expr, sp.Expr]]]:
    """Right sides of the stress law with E, left sides of the motion with V, expanded."""
    stresses = [sp.expand(e.right) for e in equations.stress_law]
    drags = [sp.expand(e.left) for e in equations.motion]
    return [list(zip(stresses, equations.turn, strict=True)), list(zip(drags, equations.twist, strict=True))]


def test_the_planar_rod_by_the_coordinates_alone_is_the_balance_in_the_world() -> None:
    """Unequal stiffness varying along a curved rod, unequal friction, weight: as derived by hand; sines gone."""
    system = heavy(SE2, "angle")
    for found, expected in zip(system.alone, planar_by_hand(HEAVY_PLANAR), strict=True):
        for point in POINTS:
            for a, b in ((found.left, expected.left), (found.right, expected.right)):
                number = charted(system, b, point)
                assert abs(charted(system, a, point) - number) < TINY * (1 + abs(number))
                assert abs(number) > 1e-3
        squares = [p for p in (found.left + found.right).atoms(sp.Pow) if isinstance(p.base, sp.sin)]
        assert squares == []
    assert heavy(SE3, "euler").alone == ()


def test_the_planar_motion_alone_keeps_the_stress_where_the_law_steps() -> None:
    """World force of the kept stress; with the law put in on a smooth piece it is the same as without the step."""
    stepped = dataclasses.replace(PLAIN_PLANAR, stiffness=diagonal("kappa*(1 + heaviside(u - 0.5))", "kappa", "b"))
    smooth = dataclasses.replace(PLAIN_PLANAR, stiffness=diagonal("2*kappa", "kappa", "b"))
    kept, usual = (in_chart(derive(model)) for model in (stepped, smooth))
    assert all(e.right.has(field("F1")) for e in kept.alone)
    on = {sp.Heaviside(U - sp.Rational(1, 2)): 1}
    known = {e.left: put_in(e.right.subs(on), kept.definitions) for e in kept.stress_law}
    for a, b in zip(kept.alone, usual.alone, strict=True):
        assert abs(charted(usual, put_in(a.residual, known) - b.residual, POINTS[1])) < TINY * 1e4


@ALL
def test_nothing_is_left_undefined(group: Group, name: str) -> None:
    """Each field is a coordinate, twist, or on the left of one definition that uses the ones before it."""
    for system in (heavy(group, name), swept(group, name), in_chart(derive(PLAIN[group]), name)):
        known = field_names([*system.coordinates, *system.equations.twist, *system.multipliers])
        for equation in (*system.frame, *system.turn, *system.stress_law):
            assert field_names([equation.right]) <= known, equation
            assert not field_names([equation.left]) & known, equation
            known |= field_names([equation.left])
        parts = system.closed + system.constraint + system.left + system.right + system.singular
        used = field_names(side for e in parts for side in (e.left, e.right))
        assert used <= known
        assert len(system.closed) == len(system.unknowns) == len(set(system.unknowns))
        assert field_names(system.unknowns) <= used


def test_equations_with_a_field_that_nothing_gives_are_refused() -> None:
    """They would not be closed."""
    equations = derive(PLAIN_PLANAR)
    motion = (Equation(equations.motion[0].left, field("temperature")), *equations.motion[1:])
    with pytest.raises(InputError, match=r"--form coordinates: .*found also temperature; use the form intrinsic"):
        in_chart(dataclasses.replace(equations, motion=motion))


def test_frozen_modes_are_constraints_on_the_coordinates() -> None:
    """A turn held at its reference is an equation between coordinates, and its stress an unknown."""
    equations = derive(dataclasses.replace(PLAIN_PLANAR, frozen=("h1",)))
    system = in_chart(equations)
    x, y, theta = (field(name) for name in ("x", "y", "theta"))
    assert system.frozen == (Equation(sp.cos(theta) * x.diff(U) + sp.sin(theta) * y.diff(U), sp.S.One),)
    assert system.multipliers == (field("F1"),)
    assert [e.left for e in system.turn] == [field("h2"), field("Pi")]
    text = to_text(document(equations, "coordinates"), unicode=False)
    assert "Planar rod, SE(2), h1 frozen, in the chart angle: elasticity, friction" in text
    assert "Frozen\n  cos(theta) x_u + sin(theta) y_u = 1\n  F1 is the Lagrange multiplier" in text
    assert "7 equations for the 7 unknown fields x, y, theta, v1, v2, Omega and F1" in text.replace("\n ", "")


@ALL
def test_frozen_modes_have_the_turn_of_the_motion(group: Group, name: str) -> None:
    """The left sides are components of the turn, the right sides the reference."""
    system, free = swept(group, name), chart_free(group, name, POINTS[0])
    held = [k for k, frozen in enumerate(system.equations.model.held) if frozen]
    assert len(system.frozen) == len(held) > 0
    for equation, k in zip(system.frozen, held, strict=True):
        assert abs(charted(system, equation.left, POINTS[0]) - free[field(group.strain[k])]) < TINY
        assert equation.right == system.equations.turn[k]


def test_joined_ends_share_twist_and_stress() -> None:
    """As in the intrinsic form: one section, the two places of one cross-section."""
    ring = dataclasses.replace(PLAIN_SPATIAL, joined=True, left=End("free"))
    text = to_text(document(derive(ring), "coordinates", "quaternion"), unicode=False)
    assert "Ends, joined" in text
    assert "v1(0) = v1(1)" in text


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
