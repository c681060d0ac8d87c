"""The equations in a chart are the chart-free ones at the same motion, and closed."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import lru_cache

import pytest
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.derivation.coordinates import CoordinateEquations, in_chart, put_in
from geocosserat.derivation.equations import derive
from geocosserat.derivation.forms import document
from geocosserat.derivation.notation import T, U, field, field_names, symbol
from geocosserat.derivation.printing import to_text
from geocosserat.derivation.records import Equation, FieldEquations
from geocosserat.model.errors import InputError
from geocosserat.model.records import End, RodModel
from tests.derivation.charted import CASES, HEAVY, IDS, PLAIN, SWEPT, Point, jet, measured
from tests.derivation.rods import (
    HEAVY_PLANAR,
    PLAIN_PLANAR,
    PLAIN_SPATIAL,
    POINTS,
    TINY,
    diagonal,
    jets,
    substituted,
)

ALL = pytest.mark.parametrize(("group", "name"), CASES, ids=IDS)
Made = Callable[[Group, str], CoordinateEquations]


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
