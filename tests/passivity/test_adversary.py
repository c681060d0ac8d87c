"""Laws made to look passive, or active, where they are not."""

from __future__ import annotations

from typing import Any

import pytest

from geocosserat.model.law import load_law
from geocosserat.passivity.check import Check, check

pytestmark = pytest.mark.slow

OPEN = {"symbol": True}
POSITIVE = {"symbol": True, "positive": True}
Plain = dict[str, Any]


def asked(**law: Any) -> Check:
    """The check of a law in the plane."""
    return check(load_law({"motion": "planar", **law}), brief=True)


def forced(fx: str, fy: str, **more: Any) -> Check:
    """Of a force along the axes of the world."""
    wrench = {"f1": f"({fx})*cos(theta) + ({fy})*sin(theta)", "f2": f"({fy})*cos(theta) - ({fx})*sin(theta)"}
    return asked(wrench=wrench, **more)


_FREQUENT = "25*cos(25*h1*h2)*{0}*cos(h1*h2) - sin(25*h1*h2)*sin(h1*h2)*{0}"  # has no normal form
_VORTEX = ("-h2/((h1 - 2)**2 + h2**2)", "(h1 - 2)/((h1 - 2)**2 + h2**2)")

HIDDEN: dict[str, Plain] = {
    "a root of a square, where no normal form is found":
        {"F1": "sqrt(h2**2 - h2 + 0.25)/(h2 - 0.5) + sin(h1) + sin(25*h1)", "F2": "h2"},
    "fourth roots of a square": {"F1": "(h2**2 - h2 + 0.25)**0.25*(h2*(h2 - 1) + 0.25)**0.25/(h2 - 0.5)", "F2": "h2"},
    "the root of 1 - cos": {"F1": "sqrt(1 - cos(Pi - 0.5))/sin(Pi/2 - 0.25)", "F2": "h2"},
    "the root of 1 - cos**2": {"F1": "sqrt(1 - cos(h2)**2)/sin(h2)", "F2": "h2"},
    "curl beyond a hidden kink": {"F1": "h2*(sqrt(h1**2 - 200*h1 + 10000) + h1 - 100)"},
    "a vortex cut by a wall that can be crossed": {"F1": _VORTEX[0], "F2": f"{_VORTEX[1]} + abs(h2)**0.5"},
    "curl where tanh is flat": {"F1": f"(1 + tanh(1e4*(h1 - 50)))*h2 + {_FREQUENT.format('h2')}",
                                "F2": _FREQUENT.format("h1")},
    "a force on one line only": {"F1": "10*(h1 - 1)*heaviside(h2**2)", "F2": "h2"},
    "a force beside one line only": {"F1": "10*(h1 - 1)*(heaviside(h2) - 0.5)**2", "F2": "h2"},
}  # fmt: skip


@pytest.mark.parametrize("name", HIDDEN)
def test_what_hides_in_a_stress_is_not_called_passive(name: str) -> None:
    """Each of these stresses does work on some cycle, though its tangent looks symmetric at most points."""
    assert asked(stress=HIDDEN[name]).verdict in ("active", "undecided")


@pytest.mark.parametrize("density", ["h2*tanh(1/((h1 - 1)**2 + h2**2 - 1))", "h2*tanh(tan(h1 + h2))"])
def test_an_energy_that_steps_across_a_curve_is_not_called_passive(density: str) -> None:
    """Out across the circle at one shear and back at another, the energy steps by different amounts without stress."""
    assert asked(energy={"density": density}).verdict in ("active", "undecided")


@pytest.mark.parametrize("more", [{"F1": "heaviside(h2 - 0.5)"}, {"F1": _VORTEX[0], "F2": _VORTEX[1]}])
def test_no_curl_is_not_enough_where_there_are_steps_or_lines(more: Plain) -> None:
    """With a = 0 the curl is gone, but the step or the vortex does work for every a."""
    found = asked(stress={"F2": "h2", **more, "F1": f"a*h2 + {more['F1']}"}, parameters={"a": OPEN})
    assert found.verdict == "active"
    assert found.conditions == ()


def test_conditions_of_a_law_with_harmless_steps_are_kept() -> None:
    """A yield in shear does no work on a cycle, so a = 0 is all that is needed."""
    found = asked(stress={"F1": "a*h2", "F2": "h2*heaviside(h2 - 0.5)"}, parameters={"a": OPEN})
    assert found.stress is not None
    assert found.stress.conditions is not None
    assert str(found.stress.conditions) == "a = 0"


def test_a_closed_wrench_with_a_step_has_no_condition() -> None:
    """The force along x steps with y: it does work whatever a is."""
    found = forced("a*y + heaviside(y)", "0", parameters={"a": OPEN})
    assert found.verdict == "driven"
    assert found.conditions == ()


def test_an_angle_that_counts_turns_only_for_some_parameters_is_not_called_passive() -> None:
    """With a = 0 the couple is 1 at every angle, and each full turn gains work."""
    assert asked(wrench={"m": "a*theta + 1"}, parameters={"a": OPEN}).verdict in ("driven", "undecided")
    assert asked(wrench={"m": "a*theta"}, parameters={"a": OPEN}).verdict == "passive"


def test_a_full_turn_through_a_pole_has_no_period() -> None:
    """tan(theta/2)**2 is infinite at half a turn, and has a potential up to there."""
    found = asked(wrench={"m": "tan(theta/2)**2"})
    assert found.verdict in ("passive", "undecided")
    assert found.wrench is not None
    assert found.wrench.periods == ()


def test_time_that_hides_in_a_root_drives() -> None:
    """The root of (t - 100)**2 over t - 100 turns its sign at t = 100."""
    assert asked(stress={"F1": "h1*sqrt(t**2 - 200*t + 10000)/(t - 100)"}).verdict in ("driven", "undecided")


def test_a_viscosity_that_turns_beyond_a_hidden_kink_is_active() -> None:
    """Beyond the rate 120 the viscous stress pushes on."""
    viscous = "h1_dot - 3*(sqrt(h1_dot**2 - 200*h1_dot + 10000) - 100 + h1_dot)"
    assert asked(stress={"F1": f"h1 + {viscous}"}).verdict == "active"


def test_time_begins_at_zero_for_viscosity() -> None:
    """A viscosity that grows with t from zero never gives energy."""
    assert asked(stress={"F1": "h1 + t*h1_dot"}).verdict == "passive"


def test_friction_that_is_negative_in_a_tiny_interval_is_found() -> None:
    """Within 1e-4 of u = 0.30111 the friction is negative."""
    found = asked(friction={"matrix": ["(u - 0.30111)**2 - 1e-8", "1", "1"]})
    assert (found.verdict, found.grade) == ("active", "proved")
    assert asked(friction={"matrix": ["(u - 0.30111)**2 + 1e-8", "1", "1"]}).verdict == "passive"


def test_a_singular_friction_of_open_strength_is_not_called_active() -> None:
    """a (1, 1, 1, 1)^T (1, 1, 1, 1) takes energy away for every a > 0, though no minor of two rows is positive."""
    rows = [["a" if max(i, j) < 4 else "1" if i == j else "0" for j in range(6)] for i in range(6)]
    law = {"motion": "spatial", "friction": {"matrix": rows}, "parameters": {"a": POSITIVE}}
    assert check(load_law(law), brief=True).verdict in ("passive", "undecided")


def test_where_u_is_taken_is_said() -> None:
    """A friction that turns at u = 1.5 is passive on a rod of length 1, and that is stated."""
    found = asked(friction={"matrix": ["1.5 - u", "1", "1"]})
    assert found.verdict == "passive"
    assert "u is taken from 0 to 1" in found.fields["assumptions"]


@pytest.mark.parametrize("fx", ["heaviside(y**2)", "(heaviside(y) - 0.5)**2"])
def test_a_force_that_is_other_on_one_line_is_not_called_passive(fx: str) -> None:
    """The step of zero is one half: on y = 0 the force is other than beside it, and a body may go along that line."""
    assert forced(fx, "0").verdict in ("driven", "undecided")


def test_friction_without_value_is_not_called_passive() -> None:
    """The root has no value where u is taken."""
    assert asked(friction={"matrix": ["sqrt(u - 2)", "1", "1"]}).verdict == "undecided"
