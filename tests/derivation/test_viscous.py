"""The equations of rods whose stress answers to rates of strain, against ones written down by hand."""

from __future__ import annotations

from typing import Any

import pytest
import sympy as sp

from geocosserat.derivation.coordinates import in_chart
from geocosserat.derivation.elimination import put_in
from geocosserat.derivation.equations import derive
from geocosserat.derivation.forms import document
from geocosserat.derivation.limit import limit
from geocosserat.derivation.notation import T, U, field, fields, symbol
from geocosserat.derivation.printing import to_latex, to_text
from geocosserat.derivation.small import small_motion
from geocosserat.model.records import RodModel
from geocosserat.model.scene import load_scene
from tests.derivation.rods import TINY, random_motion, value
from tests.derivation.scenes import same

k, eta, a = symbol("k"), symbol("eta"), symbol("a")
h1, Pi, theta, F1 = fields(("h1", "Pi", "theta", "F1"))
VALUES = {"k": 1.5, "eta": 0.25, "a": 0.75}
PLANAR = {"F1": "3*(h1 - 1)", "F2": "2*h2", "M": "k*Pi + eta*Pi_dot*(1 + h2**2) + a*h1_dot"}
SPATIAL = {
    "F1": "3*(h1 - 1)", "F2": "2*h2", "F3": "2*h3",
    "M1": "k*Pi1 + eta*Pi1_dot", "M2": "Pi2", "M3": "Pi3 + a*Pi3*h3_dot",
}  # fmt: skip


def rod(stress: dict[str, str], friction: Any = (1, 2, 0.5), frozen: Any = ()) -> RodModel:
    """A clamped rod of that law."""
    motion = "planar" if "M" in stress else "spatial"
    law = {"motion": motion, "stress": stress, "parameters": VALUES}
    return load_scene(
        {
            "rod": {"motion": motion, "length": 1.0, "law": law, "friction": list(friction), "frozen": list(frozen)},
            "run": {"until": 1.0},
        }
    ).model


def test_the_stress_has_the_rates_of_the_turn_and_the_work_what_they_take() -> None:
    """In the law, its slope in the motion, and the power lost; rates of frozen modes are none."""
    equations = derive(rod(PLANAR))
    stress = k * Pi + eta * Pi.diff(T) * (1 + field("h2") ** 2) + a * h1.diff(T)
    assert same(equations.stress_law[2].right, stress)
    h2, F = field("h2"), [3 * (h1 - 1), 2 * field("h2")]
    assert same(equations.motion[2].right, stress.diff(U) + h1 * F[1] - h2 * F[0])
    lost = eta * (1 + h2**2) * Pi.diff(T) ** 2 + a * h1.diff(T) * Pi.diff(T)
    v1, v2, Omega = equations.twist
    assert same(equations.dissipation, lost + v1**2 + 2 * v2**2 + Omega**2 / 2)
    assert "viscosity" in equations.terms
    assert equations.viscous
    held = derive(rod(PLANAR, frozen=["h1"]))
    assert not any(e.has(a) for e in (held.stress_law[1].right, held.motion[2].right, held.dissipation))
    resting = derive(rod({**PLANAR, "M": "k*Pi + a*h1_dot"}, frozen=["h1"]))
    assert not resting.viscous
    assert "viscosity" not in resting.terms


@pytest.mark.parametrize("form", ["intrinsic", "coordinates", "limit"])
@pytest.mark.parametrize("stress", [PLANAR, SPATIAL], ids=["planar", "spatial"])
def test_every_form_prints_it(form: str, stress: dict[str, str]) -> None:
    """As text and as LaTeX, closed: with as many equations as unknowns."""
    friction = (1, 2, 0.5) if stress is PLANAR else (1, 2, 2, 0.1, 0, 0)
    frozen = [] if form != "limit" else ["h1", "h2"] if stress is PLANAR else ["h1", "h2", "h3"]
    equations = derive(rod(stress, friction, frozen))
    text = to_text(document(equations, form), unicode=False)
    assert "Pi_t" in text or "Pi1_t" in text or "theta_t" in text
    assert "viscosity" in text.splitlines()[0]
    if form != "limit":
        assert "S = S(E, E_t)" in text
    latex = to_latex(document(equations, form))
    assert r"\dot{\Pi}" in latex or r"\dot{\theta}" in latex
    assert len(equations.closed) == len(equations.unknowns)


def test_the_limit_is_the_nonlinear_beam_with_a_moment_that_creeps() -> None:
    """By hand: M = k theta' + eta theta_t', F2 = g3 theta_t - M', g1 v1 = F1' - theta' F2, g2 v2 = F2' + theta' F1; no
    stretch and no shear leave 0 = v1' - theta' v2 and theta_t = v2' + theta' v1."""
    stress = {**PLANAR, "M": "k*Pi + eta*Pi_dot"}
    limits = limit(derive(rod(stress, frozen=["h1", "h2"])))
    slope = theta.diff(U)
    M = k * slope + eta * slope.diff(T)
    F2 = theta.diff(T) / 2 - M.diff(U)
    v1, v2 = F1.diff(U) - slope * F2, (F2.diff(U) + slope * F1) / 2
    rows = {f.func.__name__: -e.residual for f, e in zip(limits.fixes, limits.rows, strict=True)}
    assert same(rows["F1"], v1.diff(U) - slope * v2)
    assert same(rows["theta"], v2.diff(U) + slope * v1 - theta.diff(T))
    assert same(limits.right.equations[-1].residual, M)
    small = small_motion(limits)
    assert small is not None
    linear = {f.func.__name__: -e.residual for f, e in zip(limits.fixes, small.rows, strict=True)}
    assert same(linear["theta"], (theta.diff(T) / 2 - M.diff(U)).diff(U, 2) / 2 - theta.diff(T))


def test_pure_twist_creeps_as_it_diffuses() -> None:
    """g Pi1_t = (k Pi1 + eta Pi1_t)''."""
    limits = limit(derive(rod(SPATIAL, (1, 2, 2, 0.1, 0, 0), ["h1", "h2", "h3", "Pi2", "Pi3"])))
    (row,) = limits.rows
    Pi1 = field("Pi1")
    assert same(row.residual, Pi1.diff(T) - 10 * (k * Pi1 + eta * Pi1.diff(T)).diff(U, 2))


@pytest.mark.parametrize("point", [(sp.Rational(1, 3), sp.Rational(2, 7)), (sp.Rational(3, 4), sp.Rational(1, 5))])
def test_the_motion_by_the_coordinates_alone_is_the_intrinsic_one_turned_into_the_world(point: Any) -> None:
    """Along a random motion, to thirty digits: rates of strain are those of slopes of the coordinates."""
    equations = derive(rod(PLANAR))
    motion = random_motion(equations.group, 51)
    known = {symbol(name): sp.Rational(repr(x)) for name, x in VALUES.items()}
    explicit = motion.fields() | dict(zip("xy", motion.position, strict=True))
    system = in_chart(equations)
    here = [value(e.residual.xreplace(known), explicit, *point) for e in equations.motion]
    R = [[x.evalf(40, subs={U: point[0], T: point[1]}) for x in row] for row in motion.rotation]
    turned = [R[0][0] * here[0] + R[0][1] * here[1], R[1][0] * here[0] + R[1][1] * here[1], here[2]]
    for equation, wanted in zip(system.alone, turned, strict=True):
        found = value(put_in(equation.residual, system.definitions).xreplace(known), explicit, *point)
        assert abs(found - wanted) < TINY * (1 + abs(wanted))
