"""Bounds over boxes hold, and signs that are proved are right."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from geocosserat.model.expressions import evaluate, parse
from geocosserat.passivity.ranges import ALL, Range, bounds, sign_on

F = Fraction
BOX: dict[str, Range] = {"x": (F(1, 2), F(3, 2)), "y": (F(-1), F(2)), "z": ALL}
TEXTS = (
    "x*y - x**2", "sin(x*y) + cos(y)", "exp(y)/x", "log(x)*sqrt(1 + y**2)", "tanh(y)**3 - sinh(y)", "cosh(y)*abs(y)",
    "heaviside(y)*x", "x**y", "(x - y)*(x - y)", "tan(x/2)", "y**-2 * y**2 + x", "x**0.5",
)  # fmt: skip


@pytest.mark.parametrize("text", TEXTS)
def test_values_lie_within_bounds(text: str) -> None:
    """At random points of the box, where bounds are given."""
    e = parse(text, tuple(BOX))
    found = bounds(e, BOX)
    if found is None:
        assert text == "y**-2 * y**2 + x"
        return
    chance = np.random.default_rng(1)
    values = evaluate(e, {"x": chance.uniform(0.5, 1.5, 500), "y": chance.uniform(-1, 2, 500)})
    assert float(found[0]) <= np.min(values) + 1e-12
    assert np.max(values) - 1e-12 <= float(found[1])


@pytest.mark.parametrize(
    ("text", "sign"),
    [
        ("1 + z**2", 1), ("-1 - exp(z)", -1), ("cosh(z) - 0.5", 1), ("(x - 2)**2 + z**2", 1), ("x**2 - 2*x + 1.01", 1),
        ("x - 1", 0), ("z", 0), ("log(y)", 0), ("sqrt(y + 2) + exp(z)", 1), ("tanh(z) + 1.5", 1), ("x - 0.5", 0),
        ("exp(1000000*x)", 1), ("sin(x)", 1), ("(x - 2)**50*10**200", 1),
    ],
)  # fmt: skip
def test_signs_are_proved_where_they_hold(text: str, sign: int) -> None:
    """Also over boxes that reach to infinity; zero where it is not proved."""
    assert sign_on(parse(text, tuple(BOX)), BOX) == sign


def test_both_signs_on_parts_of_a_box_are_no_sign() -> None:
    """A function that steps over zero has none."""
    assert sign_on(parse("heaviside(y - 0.25) - 0.5", ("y",)), {"y": (F(-1), F(2))}) == 0


def test_a_name_without_range_may_be_anything() -> None:
    """Then a bound is infinite."""
    assert bounds(parse("exp(w)", ("w",)), {}) == (0, math.inf)
