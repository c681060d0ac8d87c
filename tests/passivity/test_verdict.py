"""From parts to one verdict: the worst that is certain, else undecided, else passive with the least certain grade."""

from __future__ import annotations

import itertools
from dataclasses import replace

import pytest
import sympy as sp

from geocosserat.derivation.notation import symbol
from geocosserat.model.expressions import parse
from geocosserat.passivity.conditions import Conditions
from geocosserat.passivity.friction import FrictionAnswer
from geocosserat.passivity.singular import Singular
from geocosserat.passivity.stress import StressAnswer
from geocosserat.passivity.vanish import Grade
from geocosserat.passivity.verdict import (
    GRADES,
    Part,
    Verdict,
    conditions_of,
    friction_part,
    stress_part,
    verdict_of,
    wrench_part,
)
from geocosserat.passivity.wrench import WrenchAnswer

ORDER: tuple[Verdict, ...] = ("active", "driven", "undecided", "passive")
A_IS_0 = Conditions((((symbol("a"), sp.S.Zero),),), exact=True)
NEVER = Conditions((), exact=True)


def part(verdict: Verdict, grade: Grade | None = "proved", condition: str | None = None, what: str = "stress") -> Part:
    """A part of a law with that verdict."""
    return Part(what, verdict, None if verdict == "undecided" else grade, "because", condition)


def test_no_parts_are_passive_for_certain() -> None:
    """What a law does not have gives no energy."""
    assert verdict_of([]) == ("passive", "proved")


@pytest.mark.parametrize("verdicts", list(itertools.product(ORDER, repeat=3)))
def test_the_worst_part_decides_in_any_order(verdicts: tuple[Verdict, ...]) -> None:
    """Active before driven before undecided before passive."""
    expected = min(verdicts, key=ORDER.index)
    assert verdict_of([part(v) for v in verdicts])[0] == expected


@pytest.mark.parametrize("other", GRADES)
def test_what_is_passive_at_samples_only_is_undecided(other: Grade) -> None:
    """What no sample met may give energy all the same."""
    assert verdict_of([part("passive", "sampled"), part("passive", other)]) == ("undecided", None)


@pytest.mark.parametrize("first", GRADES[1:])
@pytest.mark.parametrize("second", GRADES[1:])
def test_passive_is_as_certain_as_its_least_certain_part(first: Grade, second: Grade) -> None:
    """All parts must be passive, so the weakest grade counts."""
    assert verdict_of([part("passive", first), part("passive", second)]) == (
        "passive", min(first, second, key=GRADES.index),
    )  # fmt: skip


@pytest.mark.parametrize("verdict", ["active", "driven"])
@pytest.mark.parametrize("first", GRADES)
@pytest.mark.parametrize("second", GRADES)
def test_what_one_part_does_is_as_certain_as_its_best_evidence(verdict: Verdict, first: Grade, second: Grade) -> None:
    """One part is enough, so the strongest grade counts; how certain the passive parts are does not."""
    parts = [part(verdict, first), part("passive", "sampled"), part(verdict, second), part("undecided")]
    assert verdict_of(parts) == (verdict, max(first, second, key=GRADES.index))


def test_a_driven_part_lends_an_active_one_no_certainty() -> None:
    """The grade is that of the verdict that is given."""
    assert verdict_of([part("active", "sampled"), part("driven", "proved")]) == ("active", "sampled")


def test_undecided_has_no_grade() -> None:
    """However certain the rest is."""
    assert verdict_of([part("passive"), part("undecided")]) == ("undecided", None)


def test_a_condition_is_that_of_the_law_if_one_part_is_not_passive() -> None:
    """Else it is said of each part by name."""
    odd = part("active", condition="if and only if a = 0")
    assert conditions_of([odd, part("passive", what="friction")]) == ("passive if and only if a = 0",)
    rough = part("undecided", condition="if and only if b > 0", what="friction")
    assert conditions_of([odd, rough]) == (
        "the stress is passive if and only if a = 0", "the friction is passive if and only if b > 0",
    )  # fmt: skip


def test_a_condition_of_one_part_is_not_that_of_the_law_where_another_is_driven() -> None:
    """With a = 0 this law still is driven: the condition must name the stress."""
    odd, motor = part("active", condition="if and only if a = 0"), part("driven", what="wrench")
    assert conditions_of([odd, motor]) == ("the stress is passive if and only if a = 0",)


def test_a_passive_law_has_no_condition() -> None:
    """Even if an answer carries one."""
    assert conditions_of([part("passive", condition="if a = 0")]) == ()


@pytest.mark.parametrize(
    ("answer", "verdict"),
    [
        (StressAnswer(True, "proved", "so"), "passive"),
        (StressAnswer(True, "probable", "so"), "passive"),
        (StressAnswer(True, "proved", "so", timed=True), "driven"),
        (StressAnswer(False, "proved", "so"), "active"),
        (StressAnswer(False, "proved", "so", timed=True), "active"),
        (StressAnswer(False, "proved", "so", timed=None), "active"),
        (StressAnswer(True, "proved", "so", timed=None), "undecided"),
        (StressAnswer(None, None, "so"), "undecided"),
        (StressAnswer(None, None, "so", timed=True), "undecided"),
    ],
)
def test_a_stress_is_passive_only_with_an_energy_that_does_not_change(answer: StressAnswer, verdict: str) -> None:
    """No energy is active, whatever time does; an energy in time is driven; what is not known is not passive."""
    found = stress_part(answer)
    assert found.verdict == verdict
    assert found.grade == (None if verdict == "undecided" else answer.grade)
    assert "so" in found.why or verdict == "driven"


@pytest.mark.parametrize(
    ("answer", "verdict"),
    [
        (FrictionAnswer(True, "proved", "so"), "passive"),
        (FrictionAnswer(True, "sampled", "so"), "passive"),
        (FrictionAnswer(False, "proved", "so"), "active"),
        (FrictionAnswer(None, None, "so"), "undecided"),
    ],
)
def test_friction_is_passive_only_if_it_never_gives(answer: FrictionAnswer, verdict: str) -> None:
    """What is not known is not passive."""
    assert (friction_part("friction", answer).verdict, friction_part("friction", answer).grade) == (
        verdict, answer.grade,
    )  # fmt: skip


def test_conditions_of_friction_hold_together() -> None:
    """All of them are needed."""
    found = friction_part("friction", FrictionAnswer(None, None, "so", conditions=("a > 0", "b > 0")))
    assert conditions_of([found]) == ("passive if a > 0 and b > 0",)  # what is singular may be dissipative too
    found = friction_part("friction", FrictionAnswer(None, None, "so", conditions=("a >= 0", "b >= 0")))
    assert conditions_of([found]) == ("passive if and only if a >= 0 and b >= 0",)


@pytest.mark.parametrize(
    ("answer", "verdict"),
    [
        (WrenchAnswer(True, True, "proved", "so"), "passive"),
        (WrenchAnswer(True, False, "proved", "so"), "driven"),
        (WrenchAnswer(False, False, "proved", "so"), "driven"),
        (WrenchAnswer(None, False, "proved", "so"), "driven"),
        (WrenchAnswer(True, True, "proved", "so", timed=True), "driven"),
        (WrenchAnswer(True, None, "proved", "so"), "undecided"),
        (WrenchAnswer(None, None, None, "so"), "undecided"),
        (WrenchAnswer(None, None, None, "so", timed=True), "undecided"),
        (WrenchAnswer(None, None, "proved", "so", exact_if=A_IS_0), "driven"),
        (WrenchAnswer(True, None, "proved", "so", exact_if=A_IS_0), "driven"),
    ],
)
def test_a_wrench_is_passive_only_with_a_potential(answer: WrenchAnswer, verdict: str) -> None:
    """Closed is not enough; what is not known is not passive."""
    assert wrench_part(answer).verdict == verdict


def test_conditions_say_whether_they_are_necessary() -> None:
    """If and only if, or if; none where no value does."""
    def said(conditions: Conditions) -> tuple[str, ...]:
        return conditions_of([stress_part(StressAnswer(False, "proved", "so", conditions=conditions))])

    assert said(A_IS_0) == ("passive if and only if a = 0",)
    assert said(Conditions(A_IS_0.alternatives, exact=False)) == ("passive if a = 0",)
    assert said(NEVER) == ()
    assert conditions_of([wrench_part(WrenchAnswer(None, None, None, "so", exact_if=A_IS_0))]) == (
        "passive if and only if a = 0",
    )


@pytest.mark.parametrize(
    ("stress", "singular", "said"),
    [
        ("a*h2 + h1", False, ("passive if and only if a = 0",)),
        ("a*h2 + heaviside(u - 0.5)*h1", False, ("passive if and only if a = 0",)),
        ("a*h2 + heaviside(h2)", False, ("passive only if a = 0",)),
        ("a*h2 + 1/h1", True, ("passive only if a = 0",)),
    ],
)
def test_where_steps_or_holes_may_work_a_vanishing_curl_is_not_enough(
    stress: str, singular: bool, said: tuple[str, ...]
) -> None:
    """It is needed, and no more is said."""
    answer = StressAnswer(
        False, "proved", "so", curl=(((0, 1), symbol("a")),), conditions=A_IS_0,
        singular=(Singular(symbol("h1"), "wall"),) if singular else (),
        stress=(parse(stress, ("h1", "h2", "a", "u")),),
    )  # fmt: skip
    assert conditions_of([stress_part(answer)]) == said
    loose = replace(answer, conditions=Conditions(A_IS_0.alternatives, exact=False))
    assert conditions_of([stress_part(loose)]) == (() if "only if" in said[0].replace("if and only if", "") else (
        "passive if a = 0",
    ))  # fmt: skip


def test_a_stress_that_is_timed_as_well_is_not_made_passive_by_its_condition() -> None:
    """With a = 0 it still is driven."""
    timed = StressAnswer(False, "proved", "so", conditions=A_IS_0, timed=True)
    assert conditions_of([stress_part(timed)]) == ()


def test_a_wrench_that_is_timed_as_well_is_not_made_passive_by_its_condition() -> None:
    """With a = 0 it still is driven."""
    timed = WrenchAnswer(None, None, "proved", "so", exact_if=A_IS_0, timed=True)
    assert conditions_of([wrench_part(timed)]) == ()
