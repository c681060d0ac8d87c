"""Where laws are singular, and what a loop can do about it."""

from __future__ import annotations

from fractions import Fraction

import pytest
import sympy as sp

from geocosserat.derivation.notation import symbol
from geocosserat.model.expressions import parse
from geocosserat.passivity.ranges import ALL, Range
from geocosserat.passivity.singular import singular_sets
from geocosserat.passivity.steps import continuous, steps_of

NAMES = ("h1", "h2", "Pi")
STRAIN = [symbol(n) for n in NAMES]
BOX: dict[str, Range] = dict.fromkeys(NAMES, ALL)
CENTRE = {"h1": sp.S.One, "h2": sp.S.Zero, "Pi": sp.S.Zero}
h1, h2, bend = STRAIN


@pytest.mark.parametrize(
    ("text", "shapes"),
    [
        ("1/(1 + h1**2)", []),
        ("1/((h1 - 1)**2 + h2**2)", ["line"]),
        ("1/((h1 - 1)**2 + h2**2 + 0.001)", []),
        ("1/((h1 - 1)**2 + h2**2 - 0.001)", ["curved"]),
        ("1/((h1 - 1)**2 + h2**2 + 4*Pi**2)", ["small"]),
        ("1/((h1 - h2)**2 + (h1 + h2 - 2)**2)", ["line"]),
        ("1/(h1**2 - h2**2)", ["wall", "wall"]),
        ("1/(h1**2 - h2)", ["curved"]),
        ("log(h1)", ["edge"]),
        ("sqrt(1 - h1**2 - h2**2)", ["edge"]),
        ("sqrt(h1**2 + h2**2 - 0.1)", ["curved"]),
        ("log(h1 - h2**2)", ["edge"]),
        ("log(h2**2 - h1)", ["curved"]),
        ("log(-h1*h2)", ["wall", "wall"]),
        ("h1**-0.5", ["edge"]),
        ("tan(h1 + 2*h2)", ["curved"]),
        ("tan(Pi)", ["wall"]),
        ("exp(1/h2)", ["essential"]),
        ("log(sin(h1))", ["edge"]),
        ("1/exp(h1)", []),
        ("1/u", []),
        ("1/(h1*(h2 - 3))", ["wall", "wall"]),
        ("1/sqrt(h1**2 + h2**2)", ["line"]),
    ],
)
def test_singular_sets_are_found_and_told_apart(text: str, shapes: list[str]) -> None:
    """By how a loop can pass them."""
    found = singular_sets([parse(text, (*NAMES, "u"))], NAMES, BOX, (), CENTRE)
    assert sorted(s.shape for s in found) == shapes


def test_a_point_on_a_line_is_exact() -> None:
    """Where the quadratic form has its least value."""
    text = "1/((h1 - 0.3)**2 + (h1 - 0.3 - h2)**2)"
    (line,) = singular_sets([parse(text, NAMES)], NAMES, BOX, (), CENTRE)
    assert line.point == {"h1": sp.Rational(3, 10), "h2": 0}


def test_what_lies_outside_the_domain_is_left_out() -> None:
    """Proved by bounds over the box."""
    e = parse("1/((h1 - 2)**2 + h2**2)", NAMES)
    assert singular_sets([e], NAMES, BOX | {"h1": (Fraction(1, 2), Fraction(3, 2))}, (), CENTRE) == ()


@pytest.mark.parametrize(
    ("stress", "workless"),
    [
        ((sp.Heaviside(h1 - 1) * h1, 0, 0), True),
        ((0, sp.Heaviside(h1 - 1) * h2, 0), False),
        ((sp.Heaviside(h1 - 1), sp.Heaviside(h2), sp.Abs(bend)), True),
        ((sp.Heaviside(h1 - h2), -sp.Heaviside(h1 - h2), 0), True),
        ((sp.Heaviside(h1 - h2), sp.Heaviside(h1 - h2), 0), False),
        ((sp.sign(h1**2 + h2**2 - 2) * h1, sp.sign(h1**2 + h2**2 - 2) * h2, 0), True),
        ((0, sp.sign(h1**2 + h2**2 - 2) * h2, 0), False),
        ((0, sp.Abs(h1 - 1) * h2, 0), True),
        ((0, sp.sqrt((h1 - 1) ** 2 * (1 + h2**2)) / (h1 - 1), 0), False),
        ((1 / sp.sqrt(sp.Abs(h1 - 1)), 0, 0), True),
        ((1 / sp.Abs(h1 - 1), 0, 0), True),
        ((0, h2 / sp.Abs(h1 - 1), 0), False),
        ((0, sp.Heaviside(sp.exp(h1) - 2) * h2, 0), False),
        ((sp.Heaviside(sp.exp(h1) - 2) * h1, 0, 0), True),
        ((0, sp.Heaviside(h1 - 1) * (h1 - 1) * h2, 0), True),
    ],
)
def test_steps_do_no_work_if_their_jump_is_normal(stress: tuple[sp.Expr, ...], workless: bool | None) -> None:
    """Or not there; also across curved surfaces, and hidden in roots of squares."""
    found = steps_of([sp.sympify(e) for e in stress], STRAIN, (), BOX)
    assert found.workless is workless, found.how
    assert found.surfaces


@pytest.mark.parametrize(
    ("e", "expected"),
    [
        (sp.Abs(h1 - 1) * h2, True),
        (sp.Heaviside(h1 - 1) * (h1**2 - 1), True),
        (sp.Heaviside(h1 - 1) * h1, False),
        (h1 * sp.sign(h1 * h2) * h2, True),
        (h1 * sp.sign(h1 * h2), False),
        (sp.exp(h1), True),
    ],
)
def test_continuity_across_steps(e: sp.Expr, expected: bool) -> None:
    """Both sides agree where the surface is."""
    assert continuous(e, STRAIN, ()) is expected
