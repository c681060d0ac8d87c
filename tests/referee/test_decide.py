"""What vanishes is proved, what does not is refuted at a point that anyone can look at, and nothing is simplified."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

import numpy as np
import pytest
import sympy as sp

from geocosserat.referee import decide as engine
from geocosserat.referee.decide import decide
from geocosserat.referee.motion import rotation_of

a, b, c, d, x, y, z = sp.symbols("a b c d x y z")
q = sp.symbols("q0:4")
SPHERE = [sum(s**2 for s in q) - 1]
CIRCLE = [c**2 + d**2 - 1]
ROTATION = sp.Matrix(rotation_of(q))


def exact(point: Mapping[str, str] | None) -> dict[sp.Symbol, sp.Rational]:
    assert point is not None
    fractions = {name: Fraction(value) for name, value in point.items()}
    return {sp.Symbol(name): sp.Rational(f.numerator, f.denominator) for name, f in fractions.items()}


def test_an_identity_is_proved_and_says_how_much_cancels() -> None:
    """Whatever way it is written."""
    found = decide([(x + y) ** 3 - x**3 - 3 * x**2 * y - 3 * x * y**2 - y**3])
    assert (found.vanishes, found.proved, found.point) == (True, True, None)
    assert found.how == "proved: normal form of one entry, 8 terms cancel"


def test_what_is_alike_needs_no_normal_form() -> None:
    """It says so."""
    assert decide([sp.S.Zero, x - x]).how == "proved: 2 entries alike"


def test_a_wrong_sign_is_refuted_at_a_point_that_shows_it() -> None:
    """The entry, its value, and the values of all symbols: put in, they give just that value."""
    wrong = (x - y) ** 2 - x**2 - 2 * x * y - y**2
    found = decide([x - x, wrong])
    assert (found.vanishes, found.proved, found.entry) == (False, True, 1)
    assert "entry 2" in found.how
    assert "(exact)" in found.how
    value = wrong.subs(exact(found.point))
    assert value != 0
    assert float(found.value or 0) == pytest.approx(float(value), rel=1e-11)


def test_the_point_of_a_refutation_satisfies_the_constraints() -> None:
    """Exactly: on the sphere, where only what is wrong there counts."""
    wrong = q[0] ** 2 + q[1] ** 2 + q[2] ** 2 - 1
    found = decide([wrong], rules=SPHERE)
    point = exact(found.point)
    assert not found.vanishes
    assert SPHERE[0].subs(point) == 0
    assert wrong.subs(point) != 0


@pytest.mark.parametrize("entry", range(9))
def test_what_holds_only_on_rotations_is_proved_there_and_refuted_elsewhere(entry: int) -> None:
    """The cofactors of R are R itself, entry by entry."""
    wanted = [(ROTATION.cofactor_matrix() - ROTATION)[entry]]
    assert decide(wanted, rules=SPHERE).how.startswith("proved")
    assert not decide(wanted).vanishes


def test_parameters_stand_for_bound_symbols() -> None:
    """Symbols of a rotation matrix are free without them."""
    R = sp.Matrix(3, 3, sp.symbols("R1:4(1:4)"))
    values = dict(zip(R, ROTATION, strict=True))
    assert decide([R.det() - 1], values, SPHERE).proved
    assert decide([R.det() - 1], values, SPHERE).vanishes
    assert not decide([R.det() - 1]).vanishes


def test_two_constraints_hold_at_once() -> None:
    """Each has its own unknowns."""
    wanted = [(c**2 + d**2) * sum(s**2 for s in q) - 1]
    assert decide(wanted, rules=[*SPHERE, *CIRCLE]).how.startswith("proved")
    assert not decide(wanted, rules=SPHERE).vanishes
    assert not decide(wanted, rules=CIRCLE).vanishes


@pytest.mark.parametrize(
    "identity",
    [
        1 / (x * y) - (1 / x) * (1 / y),
        x / (x + y) + y / (x + y) - 1,
        1 / (x - y) - (x + y) / (x**2 - y**2),
        1 / (1 / x + 1 / y) - x * y / (x + y),
        1 / (1 + 1 / (1 + 1 / x)) - (x + 1) / (2 * x + 1),
        (x / y) ** -3 - y**3 / x**3,
        1 / (1 / (x + 1 / y) + z) - (x * y + 1) / (y + z * (x * y + 1)),
    ],
)
def test_reciprocals_are_proved_within_each_other_too(identity: sp.Expr) -> None:
    """And with one term more they are refuted."""
    assert decide([identity]).how.startswith("proved")
    assert decide([identity + sp.Rational(1, 10**6) / (x + 3)]).how.startswith("refuted")


def test_a_reciprocal_on_a_constraint_is_proved() -> None:
    """One over the squared norm, which is one."""
    norm = sum(s**2 for s in q)
    assert decide([1 / norm - 1], rules=SPHERE).how.startswith("proved")
    assert decide([1 / (1 + norm) - sp.Rational(1, 2)], rules=SPHERE).how.startswith("proved")
    assert not decide([1 / norm - 1]).vanishes


def test_one_over_something_is_not_taken_for_nothing() -> None:
    """A product with a reciprocal vanishes only if the other factor does."""
    assert not decide([1 / x - 1]).vanishes
    assert not decide([x * (1 / y) - 1]).vanishes
    assert decide([x * (1 / x) - 1]).vanishes


@pytest.mark.parametrize("defect", [sp.Rational(1, 10**40), sp.Rational(1, 10**400), -sp.Rational(1, 2**61 - 2)])
def test_the_smallest_defect_is_caught(defect: sp.Rational) -> None:
    """No tolerance: rational numbers are exact."""
    found = decide([(x + y) ** 2 - x**2 - 2 * x * y - y**2 + defect * x])
    assert not found.vanishes
    assert "exact" in found.how


@pytest.mark.parametrize("defect", [engine.PRIME * x, engine.PRIME / x, engine.PRIME / (1 + 1 / x)])
def test_a_defect_that_vanishes_modulo_the_prime_is_not_proved_away(defect: sp.Expr) -> None:
    """The prime itself as a coefficient: points see nothing there, the normal form does, and then a rational point."""
    found = decide([(x + y) ** 2 - x**2 - 2 * x * y - y**2, defect])
    assert (found.vanishes, found.entry) == (False, 1)
    assert "exact" in found.how


def test_what_vanishes_at_all_points_but_has_no_normal_form_is_only_probable() -> None:
    """sin^2 + cos^2 = 1: true, but no polynomial identity."""
    found = decide([sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1])
    assert (found.vanishes, found.proved) == (True, False)
    assert found.how == "probable: vanishes to 40 digits at 20 random points"


@pytest.mark.parametrize(
    "wrong",
    [
        sp.sin(x) ** 2 - sp.cos(x) ** 2 - 1,
        sp.sin(2 * x) - sp.sin(x) * sp.cos(x),
        sp.exp(x + y) - sp.exp(x) * sp.exp(y) + sp.Rational(1, 10**35),
        sp.log(x * y) - sp.log(x) + sp.log(y),
        sp.sqrt(x**2 + y**2) - x - y,
    ],
)
def test_a_wrong_identity_of_functions_is_refuted(wrong: sp.Expr) -> None:
    """To forty digits."""
    found = decide([wrong])
    assert not found.vanishes
    assert "(40 digits)" in found.how


@pytest.mark.parametrize(
    "right",
    [
        sp.sin(2 * x) - 2 * sp.sin(x) * sp.cos(x),
        sp.exp(x + y) - sp.exp(x) * sp.exp(y),
        sp.log(x * y) - sp.log(x) - sp.log(y),
        sp.sqrt(x) * sp.sqrt(y) - sp.sqrt(x * y),
    ],
)
def test_a_right_identity_of_functions_is_probable(right: sp.Expr) -> None:
    """Of positive numbers: those are tried."""
    assert decide([right]).how.startswith("probable")


@pytest.mark.parametrize(
    ("unsupported", "message"),
    [
        (sp.tan(x), "expected one of sin, cos, exp, log and sqrt, found tan"),
        (sp.Abs(x) - x, "expected one of sin, cos, exp, log and sqrt, found Abs"),
        (sp.Function("f")(x), "expected one of sin, cos, exp, log and sqrt, found f"),
        (sp.Derivative(sp.Function("f")(x), x), "expected numbers, symbols, sums, products, powers and functions"),
        (sp.pi * x, "expected numbers, symbols, sums, products, powers and functions, found pi"),
        (x**y, "expected numbers, symbols, sums, products, powers and functions"),
        (sp.Integral(x, x), "expected numbers, symbols, sums, products, powers and functions"),
        (sp.Float(0.5) * x, "expected numbers, symbols, sums, products, powers and functions, found 0.5"),
        (sp.I * x, "expected numbers, symbols, sums, products, powers and functions, found I"),
    ],
)
def test_what_cannot_be_decided_is_refused(unsupported: sp.Expr, message: str) -> None:
    """Rather than waved through; a float is no exact number."""
    with pytest.raises(TypeError, match=message):
        decide([unsupported])


def test_text_is_no_expression() -> None:
    """It would be run as code."""
    with pytest.raises(sp.SympifyError):
        decide(["x - x"])  # type: ignore[list-item]


@pytest.mark.parametrize("rule", [x * y - 1, x**2 + y**2 - 2, x**2 - y**2 - 1, x**2 + y - 1, x**3 - 1])
def test_other_constraints_are_refused(rule: sp.Expr) -> None:
    """Their points could not be drawn; the message says what else to do."""
    with pytest.raises(ValueError, match=r"expected a rule x\*\*2 \+ y\*\*2 .* bind other constraints by parameters"):
        decide([x], rules=[rule])


def test_the_same_question_has_the_same_answer() -> None:
    """Points are drawn by a generator of their own; another seed shows another point."""
    first, again, other = (decide([x * y - x], seed=seed) for seed in (1, 1, 2))
    assert first == again
    assert first.point != other.point


def test_numpy_arrays_of_expressions_are_taken() -> None:
    """As they come out of a Motion."""
    assert decide(list(np.array([x, y], dtype=object) - np.array([x, y], dtype=object))).vanishes


def test_a_rule_alone_vanishes_and_so_does_what_it_divides() -> None:
    """Also of high degree."""
    assert decide([SPHERE[0], SPHERE[0] * (x + q[0]) ** 3], rules=SPHERE).how.startswith("proved")
    assert not decide([SPHERE[0] * (x + q[0]) ** 3 + q[1] ** 9], rules=SPHERE).vanishes


def test_what_vanishes_at_all_rational_points_that_are_drawn_is_refuted() -> None:
    """A polynomial with a root at each of them; modulo the prime it does not vanish."""
    assert not decide([sp.prod([7 * x - k for k in range(1, 20)])]).vanishes


@pytest.mark.parametrize("nowhere", [1 / CIRCLE[0], x / CIRCLE[0] - 3, 1 / (sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1)])
def test_what_has_a_value_nowhere_does_not_pass(nowhere: sp.Expr) -> None:
    """One over what vanishes by a rule: nothing was tried."""
    assert not decide([nowhere], rules=CIRCLE).vanishes
