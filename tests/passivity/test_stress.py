"""Laws with known answers: conservative ones are proved, the others have a loop that shows it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geocosserat.model.expressions import evaluate, to_text
from geocosserat.model.law import load_law
from geocosserat.passivity.loop import work_of
from geocosserat.passivity.stress import StressAnswer, check_stress

OPEN: Mapping[str, Any] = {"symbol": True}
POSITIVE: Mapping[str, Any] = {"symbol": True, "positive": True}
SPATIAL = ("h1", "h2", "h3", "Pi1", "Pi2", "Pi3")
COMPONENTS = ("F1", "F2", "F3", "M1", "M2", "M3")


def _check(stress: Mapping[str, str] | str, motion: str = "planar", **more: Any) -> StressAnswer:
    part = {"energy": {"density": stress}} if isinstance(stress, str) else {"stress": dict(stress)}
    return check_stress(load_law({"motion": motion, **part, **more}))


def _linear(k: Any) -> dict[str, str]:
    turns = ["(h1 - 1)" if name == "h1" else name for name in SPATIAL]
    return {c: " + ".join(f"({k[i][j]})*{turns[j]}" for j in range(6)) for i, c in enumerate(COMPONENTS)}


CONSERVATIVE: dict[str, Any] = {
    "diagonal": {"F1": "10*(h1 - 1)", "F2": "10*h2", "M": "Pi"},
    "symmetric": {"F1": "10*(h1 - 1) + 2*Pi", "F2": "3*h2", "M": "Pi + 2*(h1 - 1)"},
    "prestress": {"F1": "3 + 10*(h1 - 1)", "M": "Pi - 0.5"},
    "log cosh": {"F1": "tanh(h1 - 1 + h2)", "F2": "tanh(h1 - 1 + h2) + h2**3", "M": "sin(2*Pi)"},
    "rational": {"F1": "2*(h1 - 1)*(1 + Pi**2)/(1 + (h1 - 1)**2*(1 + Pi**2))",
                 "M": "2*Pi*(h1 - 1)**2/(1 + (h1 - 1)**2*(1 + Pi**2))"},
    "squares of cosines": {"F1": "2*cos(h1 - 1)**2*sin(h2) - sin(h2)", "F2": "sin(h1 - 1)*cos(h1 - 1)*cos(h2)"},
    "double angles": {"F1": "4*sin(h1)*cos(h1)*cos(Pi)", "M": "(2*cos(h1)**2 - 1 - 2)*sin(Pi) + 2*sin(Pi)"},
    "length": {"F1": "h1*(1 - 1/sqrt(h1**2 + h2**2))", "F2": "h2*(1 - 1/sqrt(h1**2 + h2**2))"},
    "hyperbolic": {"F1": "(exp(h1) - exp(-h1))/2*cosh(h2)", "F2": "cosh(h1)*sinh(h2)"},
    "radial and singular": {"F1": "(h1 - 1)/((h1 - 1)**2 + h2**2)", "F2": "h2/((h1 - 1)**2 + h2**2)"},
    "one-sided spring": {"F1": "heaviside(h1 - 1)*h1"},
    "two-sided spring": {"F1": "10*(h1 - 1)*heaviside(h1 - 1) + 2*(h1 - 1)*heaviside(1 - h1)", "F2": "abs(h2)*h2"},
    "coupled with a kink": {"F1": "abs(h1 - 1)*h2**2", "F2": "h2*(h1 - 1)*abs(h1 - 1)"},
    "a modulus under a root": {"F1": "sqrt((h1 - 1)**2)"},
    "a sign as a quotient": {"F2": "h2/abs(h2)"},
    "a density": "5*(log(h1)*h1 - h1) + 3*h2**2 + 0.5*Pi**2/h1**2 + cos(Pi*h2)",
    "varying along u": {"F1": "(2 + heaviside(u - 0.5))*(h1 - 1) + sin(u)*Pi", "M": "sin(u)*(h1 - 1)"},
}  # fmt: skip

WORKING: dict[str, Any] = {
    "odd": {"F2": "10*h2 + 3*Pi", "M": "Pi - 3*h2"},
    "not symmetric": {"F1": "10*(h1 - 1) + 2*Pi", "M": "Pi"},
    "a thirtieth decimal": {"F1": "tanh(h1 - 1) + 1e-30*h2", "F2": "h2"},
    "a curl that vanishes at the reference": {"F1": "(h1 - 1)**2*h2**2", "F2": "h2"},
    "vortex": {"F1": "-h2/((h1 - 1)**2 + h2**2)", "F2": "(h1 - 1)/((h1 - 1)**2 + h2**2)"},
    "vortex elsewhere": {"F1": "-h2/((h1 - 2)**2 + h2**2)", "F2": "(h1 - 2)/((h1 - 2)**2 + h2**2)"},
    "vortex of curvature and shear": {"F2": "-Pi/(h2**2 + 4*Pi**2)", "M": "h2/(h2**2 + 4*Pi**2)"},
    "vortex of a cube": {"F1": "-3*(h1 - 1)**2*h2/((h1 - 1)**6 + h2**2)", "F2": "(h1 - 1)**3/((h1 - 1)**6 + h2**2)"},
    "step that does work": {"F2": "heaviside(h1 - 1)*h2"},
    "step elsewhere": {"F2": "heaviside(h1 - 1.5)*h2"},
    "step far away": {"F1": "heaviside(h1 - 50)*h2"},
    "step as a quotient": {"F2": "h2*(h1 - 1)/abs(h1 - 1)"},
    "kink on the wrong side": {"F2": "abs(h1 - 1)"},
    "cosines nearly": {"F1": "2*cos(h1 - 1)**2*sin(h2) - sin(h2)", "F2": "sin(h1 - 1)*cos(h1 - 1)*cos(h2)*1.000001"},
}


@pytest.mark.parametrize("name", CONSERVATIVE)
def test_conservative_laws_are_proved_and_have_their_energy(name: str) -> None:
    """The gradient of the energy, as an expression of the model, is the stress at random strains."""
    answer = _check(CONSERVATIVE[name])
    assert (answer.conservative, answer.grade) == (True, "proved"), answer.how
    assert answer.witness is None
    assert answer.energy is not None
    e = answer.density_expression
    assert e is not None
    chance, step = np.random.default_rng(1), 1e-5
    for _ in range(4):
        at = dict(zip(("h1", "h2", "Pi"), chance.uniform([1.3, 0.3, 0.3], [1.9, 0.9, 0.9]).tolist(), strict=True))
        at["u"] = 0.3
        for n, s in zip(("h1", "h2", "Pi"), answer.stress, strict=True):
            slope = (evaluate(e, at | {n: at[n] + step}) - evaluate(e, at | {n: at[n] - step})) / (2 * step)
            assert slope == pytest.approx(evaluate(s, at), rel=1e-6, abs=1e-8)


@pytest.mark.parametrize("name", WORKING)
def test_laws_that_give_work_have_a_certified_loop(name: str) -> None:
    """Never called conservative; the enclosure of the work holds at another precision."""
    answer = _check(WORKING[name])
    assert (answer.conservative, answer.grade) == (False, "proved"), answer.how
    loop = answer.witness
    assert loop is not None
    assert 0 < loop.low <= loop.work <= loop.high
    again = work_of(answer.stress, ("h1", "h2", "Pi"), loop, 160, tolerance=loop.work * 2.0**-30)
    assert again > 0
    assert loop.low <= float(again.upper())
    assert float(again.lower()) <= loop.high


def test_a_domain_without_the_singular_line_makes_a_vortex_conservative() -> None:
    """And one that holds it does not."""
    vortex = {"F1": "-h2/((h1 - 2)**2 + h2**2)", "F2": "(h1 - 2)/((h1 - 2)**2 + h2**2)"}
    away = _check(vortex, domain={"h1": [0.5, 1.5]})
    assert (away.conservative, away.singular) == (True, ())
    around = _check(vortex, domain={"h1": [0.5, 2.5]})
    assert around.conservative is False
    assert [s.shape for s in around.singular] == ["line"]


def test_a_domain_without_the_step_makes_it_harmless() -> None:
    """The step at 1.5 works only where strains reach it."""
    assert _check({"F2": "heaviside(h1 - 1.5)*h2"}, domain={"h1": [0.5, 1.4]}).conservative is True
    assert _check({"F2": "heaviside(h1 - 1.5)*h2"}, domain={"h1": [0.5, 1.6]}).conservative is False


@pytest.mark.parametrize(
    "stress",
    [
        {"F2": "1/(1 + exp(1/(h1 - 1)))", "F1": "h2*exp(1/(h1 - 1))/(1 + exp(1/(h1 - 1)))**2/(h1 - 1)**2"},
        {"F1": "log(-1 - h1**2)"},
        {"F1": "-2*(h1 - 1)*h2/((h1 - 1)**4 + h2**2)", "F2": "(h1 - 1)**2/((h1 - 1)**4 + h2**2)"},
    ],
)
def test_what_cannot_be_told_is_not_told(stress: dict[str, str]) -> None:
    """A law that steps at an essential singularity though its curl vanishes beside it; one without any value; one
    that is singular on a line, around which its loops do no work, but of which no regular energy is found."""
    answer = _check(stress)
    assert (answer.conservative, answer.grade) == (None, None)
    assert "not decided" in answer.how


@pytest.mark.parametrize(
    ("stress", "parameters", "condition"),
    [
        ({"F2": "h2 + a*Pi", "M": "k3*Pi - a*h2"}, {"a": OPEN, "k3": POSITIVE}, "a = 0"),
        ({"F2": "h2 + a*Pi", "M": "k3*Pi - a*h2"}, {"a": POSITIVE, "k3": POSITIVE}, "for no values"),
        ({"F1": "a*k12*h2", "F2": "a*k21*h1"}, {"a": OPEN, "k12": OPEN, "k21": OPEN}, "k12 = k21 or a = 0"),
        ({"F1": "a*k12*h2", "F2": "a*k21*h1"}, {"a": POSITIVE, "k12": OPEN, "k21": OPEN}, "k12 = k21"),
        ({"F1": "(a**2 + b**2)*sin(h2)"}, {"a": OPEN, "b": OPEN}, "a = 0 and b = 0"),
        ({"F1": "(1 + a**2)*sin(h2)"}, {"a": OPEN}, "for no values"),
        ({"F1": "(a + b)*exp(h2)*cos(Pi)"}, {"a": OPEN, "b": OPEN}, "a = -b"),
        ({"F1": "(a*b - 2)*h2 + tanh(h1)"}, {"a": OPEN, "b": OPEN}, "a*b - 2 = 0"),
        ({"F2": "a*heaviside(h1 - 1)*h2"}, {"a": OPEN}, "a = 0"),
    ],
)
def test_the_condition_on_open_parameters(stress: dict[str, str], parameters: dict[str, Any], condition: str) -> None:
    """Solved where it can be; the loop is at named values."""
    answer = _check(stress, parameters=parameters)
    assert answer.conservative is False
    assert str(answer.conditions) == condition
    assert answer.witness is not None
    assert set(answer.witness.parameters) <= set(parameters)


def test_open_parameters_that_cancel_need_no_condition() -> None:
    """A symmetric coupling is conservative whatever it is."""
    answer = _check({"F2": "h2 + a*Pi", "M": "Pi + a*h2"}, parameters={"a": OPEN})
    assert (answer.conservative, answer.conditions) == (True, None)


def test_thirty_six_open_moduli_are_conservative_if_symmetric() -> None:
    """Fifteen equations in one alternative, and they are necessary."""
    k = [[f"k{i}{j}" for j in range(6)] for i in range(6)]
    answer = _check(_linear(k), "spatial", parameters={name: OPEN for row in k for name in row})
    assert answer.conservative is False
    assert answer.conditions is not None
    assert answer.conditions.exact
    assert len(answer.conditions.alternatives) == 1
    equations = {f"{a} = {b}" for a, b in answer.conditions.alternatives[0]}
    assert equations == {f"k{i}{j} = k{j}{i}" for i in range(6) for j in range(i + 1, 6)}


@pytest.mark.parametrize("symmetric", [True, False])
def test_a_full_spatial_stiffness_is_decided_by_its_symmetry(symmetric: bool) -> None:
    """All 36 moduli."""
    k = np.round(np.random.default_rng(2).uniform(-1, 1, (6, 6)), 3)
    k = np.round((k + k.T) / 2, 3) if symmetric else k
    answer = _check(_linear(k.tolist()), "spatial")
    assert answer.conservative is symmetric
    assert len(answer.curl) == (0 if symmetric else 15)
    for (i, j), e in answer.curl:
        assert float(e) == pytest.approx(k[j, i] - k[i, j], abs=1e-12)


def test_time_in_a_law_is_seen_unless_it_cancels() -> None:
    """Also where only a step depends on it."""
    assert _check({"F1": "(1 + 0.1*sin(t))*(h1 - 1)"}).timed is True
    assert _check({"F1": "(1 + heaviside(t - 5))*(h1 - 1)"}).timed is True
    assert _check({"F1": "(sin(t)**2 + cos(t)**2)*(h1 - 1)"}).timed is False


def test_a_viscous_law_is_asked_about_at_zero_rates() -> None:
    """Its elastic part counts here."""
    answer = _check({"F1": "10*(h1 - 1) + 3*h1_dot", "F2": "h2 + h1*h2_dot"})
    assert (answer.conservative, answer.viscous) == (True, True)
    assert str(answer.energy and answer.energy.density) == "h2**2/2 + 5*(h1 - 1)**2"


def test_a_law_without_stress_is_refused() -> None:
    """With what to write."""
    law = load_law({"motion": "planar", "friction": {"matrix": [1, 1, 1]}})
    with pytest.raises(ValueError, match=r"write \[stress\] or \[energy\]"):
        check_stress(law)


_TERMS = (
    "(h1 - 1)**2*{c}", "sin(h2 + {c}*Pi)", "log(cosh({c}*h1 - h2))", "exp({c}*h2)*Pi", "sqrt(1 + {c}**2*h2**2)*h1",
    "{c}*h1*h2*Pi", "Pi**2/(1 + h2**2)", "abs(h2 - {c})**3", "tanh(Pi)**2*{c}",
)  # fmt: skip


@settings(max_examples=6, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(_TERMS), st.sampled_from([0.3, 1.0, -2.0, 0.5])), min_size=1, max_size=3))
def test_gradients_are_conservative_and_with_a_curl_they_are_not(terms: list[tuple[str, float]]) -> None:
    """Random densities, written as stresses; then with a curl of 1e-9 added."""
    from_density = _check(" + ".join(t.format(c=c) for t, c in terms))
    assert from_density.conservative is True, from_density.how
    law = load_law({"motion": "planar", "energy": {"density": " + ".join(t.format(c=c) for t, c in terms)}})
    assert law.stress is not None
    spoilt = dict(zip(("F1", "F2", "M"), map(to_text, law.stress), strict=True))
    spoilt["M"] = f"({spoilt['M']}) + 1e-9*h2"
    answer = _check(spoilt)
    assert answer.conservative is False, answer.how
    assert answer.witness is not None
    assert answer.witness.low > 0


