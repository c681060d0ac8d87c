"""The linear equations of the turn alone are the slope of its nonlinear rate, to 30 digits."""

from __future__ import annotations

import dataclasses

import pytest
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3
from geocosserat.derivation.elimination import put_in
from geocosserat.derivation.equations import derive
from geocosserat.derivation.linear import base_of
from geocosserat.derivation.linear_turn import turn_alone
from geocosserat.derivation.notation import T, U, field, fields, is_field
from geocosserat.derivation.records import FieldEquations
from geocosserat.model.records import End, RodModel
from tests.derivation.displaced import CLOSE, PLANAR_LAW, SPATIAL_LAW, of_law, precise, with_effect
from tests.derivation.scenes import BASE, FROZEN, diagonal, effects, vector

MODELS: dict[str, RodModel] = {
    **{
        f"{group.name} {name}": with_effect(group, effects(group)[name][0])
        for group in BASE
        for name in ("follower", "couple")
    },
    "varying": dataclasses.replace(
        BASE[SE2],
        stiffness=(vector("k1*(1 + u)", "a", "u"), vector("a", "k2", 0), vector("u", 0, "k3*exp(u)")),
        friction=(vector("gamma1*(1 + u)", "b*u", 0), vector("b*u", "gamma2", 0), vector(0, 0, "gamma3/(1 + u)")),
        reference=vector("1 + a*t", "sin(u)", "u*t"),
    ),
    "coupled": dataclasses.replace(
        BASE[SE3],
        friction=tuple(
            vector(*(f"{1 + min(i, j)}/8 + {(i == j) * 4}" if i // 3 == j // 3 else 0 for j in range(6)))
            for i in range(6)
        ),
        reference=vector(1, 0, "a*u", "t", 0, "b"),
    ),
    "planar law": of_law("planar", PLANAR_LAW),
    "spatial law": of_law("spatial", SPATIAL_LAW),
    "planar: h1 h2": FROZEN["planar: h1 h2"],
    "spatial: h1 h3 Pi1 Pi3": FROZEN["spatial: h1 h3 Pi1 Pi3"],
    "swimmer, frozen": dataclasses.replace(BASE[SE2], reference=vector("1 + a*sin(u - t)", 0, "u*t"), frozen=("h1",)),
}
# exact, and so small that its square is nothing
STEP = sp.Rational(1, 2**90)


def shape(name: str, k: int) -> sp.Expr:
    """A function of u with all derivatives, another for each field."""
    c = [sp.Rational((sum(map(ord, name)) * (7 * k + j + 3)) % 31 - 15, 16) for j in range(4)]
    return c[0] + c[1] * U + c[2] * U**2 + c[3] * U**3


def balanced(equations: FieldEquations) -> list[sp.Expr]:
    """The twist by the motion, in fields."""
    friction = sp.Matrix([[e.left.diff(v) for v in equations.twist] for e in equations.motion])
    return list(friction.LUsolve(sp.Matrix([e.right for e in equations.motion])))


@pytest.mark.parametrize("name", MODELS)
def test_the_linear_rate_of_the_turn_is_the_slope_of_the_nonlinear_one(name: str) -> None:
    """At a base that moves and is under stress; of frozen modes the rate of the constraint, with multipliers."""
    equations = derive(MODELS[name])
    base = base_of(equations)
    alone = turn_alone(base)
    assert alone is not None
    turn = {e: shape(str(e), 1) + 2 * (str(e)[:2] == "h1") for e in equations.turn if is_field(e)}
    kept = {s: shape(str(s), 2) for s in equations.multipliers}
    unknowns = {y: shape(str(y), 3) for y in alone.motion.unknowns}
    pairs = dict(zip(equations.turn, base.turn_change, strict=True))
    pairs |= {s: field(f"d{s.func.__name__}") for s in equations.multipliers}

    def value(e: sp.Expr, size: sp.Rational) -> sp.Expr:
        return precise(put_in(e, {f: x + size * unknowns[pairs[f]] for f, x in (turn | kept).items()}), {})

    twist = balanced(equations)
    rates = [put_in(e.right, dict(zip(equations.twist, twist, strict=True))) for e in equations.compatibility]
    slopes, moved = ([(value(e, STEP) - value(e, -STEP)) / (2 * STEP) for e in part] for part in (rates, twist))
    laws = {e.left: e.right for e in equations.stress_law}
    known = {v: value(e, sp.S.Zero) for v, e in zip(equations.twist, twist, strict=True)}
    functions = turn | kept | {s: put_in(e, turn) for s, e in laws.items()} | unknowns
    for row, mass, slope in zip(alone.motion.rows, alone.motion.mass.diagonal(), slopes, strict=True):
        found = precise(put_in(row.right.xreplace(known), functions), {})
        assert abs(found - slope) < CLOSE * (1 + abs(slope)), row
        assert mass in (0, 1)
    for row, slope in zip(alone.twist, moved, strict=True):
        found = precise(put_in(row.right.xreplace(known), functions), {})
        assert abs(found - slope) < CLOSE * (1 + abs(slope)), row


def test_the_rows_of_frozen_modes_have_no_rate() -> None:
    """Their multipliers stand in their places."""
    alone = turn_alone(base_of(derive(FROZEN["planar: h1 h2"])))
    assert alone is not None
    assert alone.motion.unknowns == fields(("dF1", "dF2", "dPi"))
    assert [e.left for e in alone.motion.rows] == [0, 0, field("dPi").diff(T)]


def test_it_is_not_closed_where_the_rod_sees_the_world_or_friction_is_missing() -> None:
    """An effect or a load in the world; a rotation without friction; a friction too full to be inverted."""
    for group in BASE:
        for kind in ("weight", "field", "flow", "trap"):
            assert turn_alone(base_of(derive(with_effect(group, effects(group)[kind][0])))) is None
    dead = End("free", force=vector("a", 0), frame="world")
    assert turn_alone(base_of(derive(dataclasses.replace(BASE[SE2], right=dead)))) is None
    still = diagonal(1, 2, 0)
    assert turn_alone(base_of(derive(dataclasses.replace(BASE[SE2], friction=still)))) is None
    full = tuple(vector(*(f"b/{i + j + 1} + {(i == j) * 9}" for j in range(6))) for i in range(6))
    assert turn_alone(base_of(derive(dataclasses.replace(BASE[SE3], friction=full)))) is None
    assert turn_alone(base_of(derive(BASE[SE3]))) is not None
