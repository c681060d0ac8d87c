"""Verdicts are computed: a claim of any kind (holds, misprint, condition, definition) fails if it is not so."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy as sp

from geocosserat.referee.decide import decide
from geocosserat.referee.jets import Jets
from geocosserat.referee.motion import Motion, cross
from geocosserat.referee.report import VERDICTS
from geocosserat.referee.statement import Check, Section, compare, judge, verdict_on

x, y, k = sp.symbols("x y k")
SQUARE = (x + y) ** 2
EXPANDED = x**2 + 2 * x * y + y**2
WRONG = x**2 - 2 * x * y + y**2


@pytest.mark.parametrize(
    ("check", "verdict", "words"),
    [
        (Check(SQUARE, EXPANDED), "holds", "proved: normal form"),
        (Check(SQUARE, EXPANDED, defines=True), "definition", "proved: normal form"),
        (Check(WRONG, SQUARE, corrected=EXPANDED), "misprint", "printed refuted"),
        (Check(WRONG, SQUARE, condition=("y is nothing", {y: sp.S.Zero})), "conditional", "with the condition proved"),
        (
            Check(WRONG, SQUARE, corrected=EXPANDED, condition=("y is nothing", {y: sp.S.Zero})),
            "conditional",
            "without it refuted",
        ),
        (Check(sp.sin(x) ** 2 + sp.cos(x) ** 2, 1), "holds", "probable"),
        # claims that are not so
        (Check(WRONG, SQUARE), "fails", "does not follow, and no other is given: refuted"),
        (Check(WRONG, SQUARE, defines=True), "fails", "does not follow, and no other is given: refuted"),
        (Check(WRONG, SQUARE, corrected=WRONG + x), "fails", "the corrected form does not follow either: refuted"),
        (Check(SQUARE, EXPANDED, corrected=EXPANDED), "fails", "needs no correction and no condition, it holds"),
        (
            Check(SQUARE, EXPANDED, condition=("y is nothing", {y: sp.S.Zero})),
            "fails",
            "needs no correction and no condition, it holds",
        ),
        (Check(WRONG, SQUARE, condition=("y is one", {y: sp.S.One})), "fails", "not even if y is one: refuted"),
        (Check(WRONG, SQUARE, condition=("k is nothing", {k: sp.S.Zero})), "fails", "not even if k is nothing"),
        (
            Check(WRONG, SQUARE, corrected=WRONG + x, condition=("y is nothing", {y: sp.S.Zero})),
            "fails",
            "the corrected form does not follow: refuted",
        ),
        (Check(SQUARE, EXPANDED, also=[("x is y", x, y)]), "fails", "expected x is y: refuted"),
        (Check(WRONG, SQUARE, corrected=EXPANDED, also=[("x is y", x, y)]), "fails", "expected x is y: refuted"),
    ],
)
def test_a_verdict_is_earned(check: Check, verdict: str, words: str) -> None:
    """What it says of how is what decided it."""
    found, how = verdict_on(check)
    assert found == verdict
    assert words in how


def test_what_supports_a_verdict_is_named() -> None:
    """After how it was decided."""
    _, how = verdict_on(Check(SQUARE, EXPANDED, also=[("x commutes with y", x * y, y * x)]))
    assert how.endswith("; x commutes with y")


def test_one_wrong_entry_of_many_is_enough() -> None:
    """Of a vector, of a matrix."""
    right = np.array([[x, y], [x * y, 1]], dtype=object)
    wrong = right.copy()
    wrong[1, 0] = -x * y
    found = compare(wrong, right)
    assert (found.vanishes, found.entry) == (False, 2)
    assert compare(right, right.tolist()).vanishes


@pytest.mark.parametrize(
    ("left", "right", "shapes"),
    [
        ([x, y], [x, y, 0], r"\(2,\) and \(3,\)"),
        ([0, 0, 0], 0, r"\(3,\) and \(\)"),
        ([[x], [y]], [x, y], r"\(2, 1\) and \(2,\)"),
    ],
)
def test_sides_of_two_shapes_are_refused(left: Any, right: Any, shapes: str) -> None:
    """numpy would stretch one of them."""
    with pytest.raises(ValueError, match=f"expected two sides of one shape, found {shapes}; bring them to one"):
        compare(left, right)


def test_constraints_of_the_fields_count() -> None:
    """A vector product of rotated vectors, with the fields and without."""
    rod = Motion()
    (h, Pi), R = rod.split(rod.turn), rod.rotation
    check = Check(cross(R @ h, R @ Pi), R @ cross(h, Pi), fields=rod)
    assert verdict_on(check)[0] == "holds"
    assert verdict_on(Check(check.printed, check.derived))[0] == "fails"


def test_a_condition_may_bind_a_derivative() -> None:
    """Each is a symbol of its own."""
    jets = Jets()
    f = jets.scalar("f")
    check = Check(jets.du(x * f), 0, condition=("f is uniform", {jets.du(f): sp.S.Zero}), fields=jets)
    assert verdict_on(check)[0] == "conditional"


def record(**words: Any) -> Section:
    """A section of one statement."""
    section = Section("one")

    @section.states("(7)", "a square", "(x+y)^2=x^2+2xy+y^2", **words)
    def square() -> Check:
        return Check(SQUARE, EXPANDED)

    return section


def test_a_finding_has_the_agreed_fields() -> None:
    """A part only where there is one; the derived form is the printed one unless it is given."""
    (whole,), (part,) = record().statements, record(part="(7b)", remark="So.", affects=["(8)"]).statements
    assert (whole.name, part.name) == ("(7)", "(7b)")
    fields = judge(whole).fields
    assert set(fields) == {"id", "verdict", "says", "printed", "derived", "remark", "affects", "how"}
    assert fields["printed"] == fields["derived"] == "(x+y)^2=x^2+2xy+y^2"
    fields = judge(part).fields
    assert (fields["id"], fields["part"], fields["remark"], fields["affects"]) == ("(7)", "(7b)", "So.", ["(8)"])


def test_the_condition_is_told() -> None:
    """In words."""
    section = Section("one")

    @section.states("(1)", "a square", "(x+y)^2=x^2-2xy+y^2")
    def square() -> Check:
        return Check(WRONG, SQUARE, condition=("y is nothing", {y: sp.S.Zero}))

    assert judge(section.statements[0]).fields["condition"] == "y is nothing"


def test_the_code_is_what_decides_without_its_heading() -> None:
    """From def to the end."""
    (statement,) = record().statements
    assert statement.code == "def square() -> Check:\n    return Check(SQUARE, EXPANDED)\n"


def test_every_verdict_is_reached_above() -> None:
    """The table of verdicts misses none."""
    marks = test_a_verdict_is_earned.pytestmark
    assert {case[1] for case in marks[0].args[1]} == set(VERDICTS)


@pytest.mark.parametrize("text", ["__import__('os').getpid()", "x**2", "0"])
def test_text_is_never_read_as_an_expression(text: str) -> None:
    """Neither as a field, nor in a law, nor as one side of a check: nothing of it is evaluated."""
    jets = Jets()
    x = jets.scalar("x")
    for read in (
        lambda: decide([text]),
        lambda: decide([x], {x: text}),
        lambda: jets.law(x, u=text),
        lambda: jets.du(text),
        lambda: compare(text, x),
        lambda: compare([text], [text]),
        lambda: compare(x, 0, jets, {x: text}),
    ):
        with pytest.raises((sp.SympifyError, TypeError)):
            read()
