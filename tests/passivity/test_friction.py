"""Friction and viscous stresses: dissipative or not, with certificates."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from geocosserat.model.expressions import evaluate
from geocosserat.model.law import Law, load_law
from geocosserat.passivity.friction import FrictionAnswer, friction_answer, viscous_answer

OPEN, POSITIVE = {"symbol": True}, {"symbol": True, "positive": True}


def law(matrix: Any, motion: str = "planar", **parameters: Any) -> Law:
    """A law of friction alone."""
    return load_law({"name": "a", "motion": motion, "friction": {"matrix": matrix}, "parameters": parameters})


def friction(matrix: Any, motion: str = "planar", **parameters: Any) -> FrictionAnswer:
    """Its answer."""
    answer = friction_answer(law(matrix, motion, **parameters))
    assert answer is not None
    return answer


def viscous(stress: dict[str, str], domain: dict[str, Any] | None = None, **parameters: Any) -> FrictionAnswer:
    """The answer for the viscous part of a planar stress."""
    values = {"name": "a", "motion": "planar", "stress": stress, "parameters": parameters}
    answer = viscous_answer(load_law(values | ({"domain": domain} if domain else {})))
    assert answer is not None
    return answer


def test_positive_friction_is_dissipative_with_its_margin() -> None:
    """A diagonal has its least entry as margin, and one without dimension."""
    answer = friction([1, 2, 0.01])
    assert (answer.dissipative, answer.grade, answer.skew) == (True, "proved", ())
    assert answer.margin == pytest.approx(0.01)
    assert answer.scaled == pytest.approx(1.0)


def test_the_skew_part_does_no_work() -> None:
    """However large it is, it is reported and changes nothing."""
    answer = friction([[1, 300, 0], [-300, 1, 0], [0, 0, 1]])
    assert answer.dissipative is True
    assert answer.margin == pytest.approx(1.0)
    assert answer.skew == ("v1, v2: 300",)


def test_singular_friction_is_dissipative_with_margin_zero() -> None:
    """Semidefinite in exact numbers, which no enclosure could tell."""
    for matrix in ([1, 0, 2], [[1, 1, 0], [1, 1, 0], [0, 0, 1]], [["0.1", "0.3", 0], ["0.3", "0.9", 0], [0, 0, 1]]):
        answer = friction(matrix)
        assert (answer.dissipative, answer.grade, answer.margin) == (True, "proved", 0.0)


@pytest.mark.parametrize(
    "matrix",
    [
        [[1, 0, 0], [0, -1e-30, 0], [0, 0, 1]],
        [[1, 1.0000000000000002, 0], [1.0000000000000002, 1, 0], [0, 0, 1]],
        [[0, 1e-20, 0], [1e-20, 5, 0], [0, 0, 1]],
        ["1 - 2*u", 1, 1],
        [["exp(u)", "1.9", 0], ["1.9", "1 + u", 0], [0, 0, 1]],
    ],
)
def test_friction_that_gives_energy_is_refuted_by_a_motion(matrix: Any) -> None:
    """The direction given has negative dissipation, where that is large enough to be seen in floats."""
    given = law(matrix)
    answer = friction_answer(given)
    assert answer is not None
    assert (answer.dissipative, answer.grade) == (False, "proved")
    assert answer.direction is not None
    assert answer.at is not None
    assert given.friction is not None
    gamma = np.array([[float(evaluate(e, dict(answer.at))) for e in row] for row in given.friction])
    x = np.array(answer.direction)
    assert x @ gamma @ x <= 1e-15


def test_friction_that_varies_is_proved_over_the_length() -> None:
    """By boxes where it is definite, by signs where it vanishes at an end; the length is an assumption."""
    for matrix in ([["1+u", "0.5", 0], ["0.5", "1+sin(u)", 0], [0, 0, "exp(u)"]], ["u", "1", "u**2"]):
        answer = friction(matrix)
        assert (answer.dissipative, answer.grade) == (True, "proved")
        assert answer.assumptions == ("u is taken from 0 to 1",)


def test_open_parameters_give_conditions() -> None:
    """All principal minors are to be non-negative; those known to be are left out."""
    assert friction(["g", 1, 1], g=OPEN).conditions == ("g >= 0",)
    assert friction(["g", 1, 1], g=POSITIVE).dissipative is True
    answer = friction([["a", "b", 0], ["b", "c", 0], [0, 0, 1]], a=POSITIVE, b=OPEN, c=POSITIVE)
    assert answer.dissipative is None
    assert answer.conditions == ("a*c - b**2 >= 0",)
    assert friction(["-g", 1, 1], g=POSITIVE).dissipative is False


def test_spatial_friction_with_couplings() -> None:
    """Six rows, translations coupled to rotations: definite up to the product of the diagonal entries."""
    def coupled(c: float) -> FrictionAnswer:
        rows = [[float(i == j) for j in range(6)] for i in range(6)]
        rows[0][5] = rows[5][0] = c
        return friction(rows, "spatial")

    assert coupled(0.999).dissipative is True
    assert coupled(1).margin == 0.0
    assert coupled(1.001).dissipative is False


def test_a_linear_viscous_stress_is_judged_by_its_matrix() -> None:
    """Kelvin-Voigt: positive coefficients take energy, negative ones give it, skew ones do neither."""
    assert viscous({"F1": "h1 - 1 + 2*h1_dot", "M": "Pi + 0.1*Pi_dot"}).dissipative is True
    assert viscous({"F1": "h1 - 1 - 2*h1_dot"}).dissipative is False
    answer = viscous({"F1": "h2_dot", "F2": "-h1_dot"})
    assert answer.dissipative is True
    assert answer.skew == ("h1, h2: 1",)
    assert viscous({"F1": "e*h1_dot"}, e=OPEN).conditions == ("e >= 0",)


def test_a_viscosity_that_depends_on_strain_is_proved_over_the_domain() -> None:
    """Definite on the domain, negative beyond it."""
    stress = {"F1": "(1 + 0.5*sin(h1))*h1_dot + 0.2*h2_dot", "F2": "h2_dot"}
    assert viscous(stress, {"h1": [0.5, 2]}).grade == "proved"
    assert viscous({"F1": "(2 - h1)*h1_dot"}, {"h1": [0.5, 1.9]}).grade == "proved"
    assert viscous({"F1": "(2 - h1)*h1_dot"}, {"h1": [0.5, 2.1]}).dissipative is False


def test_nonlinear_viscosity_is_judged_term_by_term_or_sampled() -> None:
    """Odd growing functions of their own rate are proved, a negative power is refuted, what is left is sampled."""
    grown = viscous({"F1": "tanh(3*h1_dot)", "M": "Pi_dot**3 + Pi_dot*abs(Pi_dot)"})
    assert (grown.dissipative, grown.grade) == (True, "proved")
    assert viscous({"F1": "h1_dot**3 - 0.1*h1_dot"}).dissipative is False
    mixed = viscous({"F1": "h1_dot**3 + h1_dot*h2_dot**2 - 0.1*h1_dot**2*h2_dot", "F2": "h2_dot**3"})
    assert (mixed.dissipative, mixed.grade) == (True, "sampled")


def test_a_stress_without_rates_has_no_viscous_answer() -> None:
    """Nor has a law without friction an answer for that."""
    elastic = load_law({"name": "a", "motion": "planar", "stress": {"F1": "h1 - 1"}})
    assert viscous_answer(elastic) is None
    assert friction_answer(elastic) is None
