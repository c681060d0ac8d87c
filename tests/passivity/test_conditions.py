"""Systems of open parameters."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
import sympy as sp

from geocosserat.derivation.notation import symbol
from geocosserat.passivity.conditions import conditions

x, y, a, b, c = (symbol(n) for n in ("x", "y", "a", "b", "c"))


@pytest.mark.parametrize(
    ("expressions", "positive", "text"),
    [
        ([a * x, (b - c) * a * y], (), "a = 0"),
        ([a * (b - c)], (), "b = c or a = 0"),
        ([a * (b - c)], ("a",), "b = c"),
        ([(a - 1) * (b - 1), (a - 1) * (c - 2)], (), "a = 1 or (b = 1 and c = 2)"),
        ([(a**2 + b**2) * sp.sin(x)], (), "a = 0 and b = 0"),
        ([(a**2 - 2) * x], (), "a**2 - 2 = 0"),
        ([(a**2 + a + 1) * x], (), "for no values"),
        ([(a + b) * x], ("a", "b"), "for no values"),
        ([(a - 3) * sp.sin(x), (a + 3) * sp.cos(x)], (), "for no values"),
        ([(a + b) * sp.exp(x) * sp.cos(y) + (a - 2 * b) * sp.sin(y)], (), "a = 0 and b = 0"),
        ([(2 * a - b) * x, (b - c) * y], (), "a = c/2 and b = c"),
        ([a * sp.sin(2 * x) - 2 * b * sp.sin(x) * sp.cos(x)], (), "a = b"),
        ([a * sp.sin(x) ** 2 + b * sp.cos(x) ** 2 - c], (), "a = c and b = c"),
    ],
)
def test_conditions_are_solved(expressions: Sequence[sp.Expr], positive: tuple[str, ...], text: str) -> None:
    """And they are necessary: what multiplies the coefficients is independent."""
    found = conditions(expressions, ("a", "b", "c"), positive)
    assert found is not None
    assert (str(found), found.exact) == (text, True)


def test_a_parameter_within_a_function_makes_conditions_only_sufficient() -> None:
    """exp(a x) is one at a = 0, which no coefficient says; that value is tried."""
    found = conditions([sp.exp(a * x) - 1], ("a",), ())
    assert found is not None
    assert (str(found), found.exact) == ("a = 0", False)
    none = conditions([sp.exp(a * x) + 1], ("a",), ())
    assert none is not None
    assert str(none) == "for no values that were found"


def test_nested_roots_stay_in_the_equation() -> None:
    """sqrt(5 + 2 sqrt(6)) = sqrt(2) + sqrt(3) is not seen, and no wrong solution is made of that."""
    e = a * sp.sqrt(5 + 2 * sp.sqrt(6)) * x - b * (sp.sqrt(2) + sp.sqrt(3)) * x
    found = conditions([e], ("a", "b"), ())
    assert found is not None
    ((equation,),) = found.alternatives
    assert float((equation[0] - equation[1]).subs({a: 7, b: 7})) == pytest.approx(0, abs=1e-12)
    assert abs(float((equation[0] - equation[1]).subs({a: 7, b: 8}))) > 1
