"""Energies by integration, and the split of a stress that has none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy as sp

from geocosserat.algebra.groups import SE2
from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.notation import symbol
from geocosserat.model.expressions import evaluate, parse
from geocosserat.passivity.antiderivative import antiderivative
from geocosserat.passivity.energy import energy_of, split
from geocosserat.passivity.readable import readable, slope, to_expression
from geocosserat.passivity.vanish import vanishes

STRAIN = [symbol(name) for name in SE2.strain]
REFERENCE = [sp.S.One, sp.S.Zero, sp.S.Zero]
x, y, a = symbol("x"), symbol("y"), symbol("a")

DENSITIES = {
    "quadratic": "5*(h1 - 1)**2 + 3*h2**2/2 + a*h2*Pi + Pi**2/20",
    "log cosh": "log(cosh(h1 - 1 + 2*h2)) + Pi**4",
    "rational": "(h1 - 1)**2 / (1 + Pi**2) + h2**2/2",
    "logarithm of a rational": "log(1 + (h1 - 1)**2*(1 + Pi**2))",
    "trigonometric": "sin(2*(h1 - 1))*sin(h2)/2 + cos(Pi)**2",
    "length": "(sqrt(h1**2 + h2**2) - 1)**2 + Pi**2",
    "rubber": "h1**2 + 2/h1 + h1*h2**2 + Pi**2/h1",
    "gaussian": "exp(h2**2 - Pi**2)*(h1 - 1)",
    "pieces": "heaviside(h1 - 1)*(h1 - 1)**2 + abs(h2)**3 + Pi**2",
    "exponential": "exp(h1 - 1 + h2)*Pi + h2*sinh(Pi)",
    "open power": "h1**a + h2**2",
}


def _sympy(text: str) -> sp.Expr:
    return to_sympy(parse(text, (*SE2.strain, "a")))


@pytest.mark.parametrize("name", DENSITIES)
def test_a_density_is_found_back_from_its_gradient(name: str) -> None:
    """Up to a constant; the gradient is proved to be the stress."""
    density = _sympy(DENSITIES[name])
    stress = [slope(density, e) for e in STRAIN]
    found = energy_of(stress, STRAIN, REFERENCE)
    assert found is not None
    assert found.grade == "proved"
    assert vanishes([slope(found.density - density, e) for e in STRAIN], near={"h1": 1}).value is True


def test_the_energy_of_a_stiffness_reads_as_one_writes_it() -> None:
    """In strains from the reference, without constants."""
    stress = [_sympy(t) for t in ("10*(h1 - 1)", "3*h2 + a*Pi", "a*h2 + 0.1*Pi")]
    found = energy_of(stress, STRAIN, REFERENCE)
    assert found is not None
    assert str(found.density) == "Pi**2/20 + Pi*a*h2 + 3*h2**2/2 + 5*(h1 - 1)**2"


def test_no_energy_is_given_for_a_stress_that_has_none() -> None:
    """It would not differentiate back."""
    assert energy_of([_sympy(t) for t in ("h2", "0", "0")], STRAIN, REFERENCE) is None


def test_a_given_density_is_only_taken_if_it_differentiates_back() -> None:
    """A wrong one is passed over."""
    stress = [_sympy(t) for t in ("h1 - 1", "h2", "Pi")]
    found = energy_of(stress, STRAIN, REFERENCE, given=_sympy("h1**2"))
    assert found is not None
    assert "as given" not in found.how


def test_the_split_of_a_stiffness_is_into_symmetric_and_skew_parts() -> None:
    """The energy holds the symmetric part, the remainder the skew one."""
    stress = [_sympy(t) for t in ("10*(h1 - 1)", "3*h2 + 4*Pi", "2*h2 + Pi")]
    found = split(stress, STRAIN, REFERENCE)
    assert found is not None
    h2, bend = STRAIN[1:]
    assert vanishes([found.energy - _sympy("5*(h1 - 1)**2 + 3*h2**2/2 + 3*h2*Pi + Pi**2/2")]).value is True
    assert found.remainder == (0, bend, -h2)
    assert "rays from the reference" in found.how


@pytest.mark.parametrize("stress", [("tanh(h1 - 1) + h2", "3*h2", "Pi + h1*h2"), ("h2**2", "h1*h2", "sin(Pi)")])
def test_the_remainder_does_no_work_along_rays(stress: tuple[str, ...]) -> None:
    """And energy and remainder make up the stress."""
    given = [_sympy(t) for t in stress]
    found = split(given, STRAIN, REFERENCE)
    assert found is not None
    along = sum(r * (e - c) for r, e, c in zip(found.remainder, STRAIN, REFERENCE, strict=True))
    whole = [s - slope(found.energy, e) - r for s, e, r in zip(given, STRAIN, found.remainder, strict=True)]
    assert vanishes([along, *whole], near={"h1": 1}).value is True


def test_the_split_says_when_it_is_relative_to_the_tangent() -> None:
    """Where the work along rays has no closed form."""
    stress = [_sympy(t) for t in ("exp(h1*h2) + h2", "h2*exp((h1 - 1)**2)", "Pi")]
    found = split(stress, STRAIN, REFERENCE)
    assert found is not None
    assert "tangent at the reference" in found.how
    whole = [s - slope(found.energy, e) - r for s, e, r in zip(stress, STRAIN, found.remainder, strict=True)]
    assert vanishes(whole).value is True


@pytest.mark.parametrize(
    "text",
    [
        "x*exp(x**2)", "tanh(2*x - 1)", "x/(1 + x**2 + y**2)", "sin(x)**2*cos(3*x)", "x**2*exp(-x)*y", "x*log(x + 1)",
        "1/(1 + x**2)", "1/(x**2 - 1)", "tanh(x)**4", "cosh(x)*sinh(x)*exp(x)", "heaviside(x - 1)*x", "abs(x - 1)*x**2",
        "sqrt(1 + x**2)", "exp(x)/(1 + exp(x))", "1/(x*(x**2 + 1))", "sin(x)**5", "sinh(x)/cosh(x)**3",
    ],
)  # fmt: skip
def test_antiderivatives_differentiate_back(text: str) -> None:
    """Each by the rule that is meant for it."""
    e = to_sympy(parse(text, ("x", "y")))
    found = antiderivative(e, x)
    assert found is not None
    assert vanishes([slope(found, x) - e]).value is True


@pytest.mark.parametrize("text", ["exp(-x**2)", "sin(x)/x", "1/log(x)", "exp(sin(x))"])
def test_no_antiderivative_is_invented(text: str) -> None:
    """For what has none among these functions."""
    assert antiderivative(to_sympy(parse(text, ("x",))), x) is None


@pytest.mark.parametrize("text", [*DENSITIES.values(), "-(h1 - 1)/3 - 1/(7*h2)", "h1**-2*Pi/h2", "pi*h1", "-h1"])
def test_an_expression_survives_sympy(text: str) -> None:
    """Converted there and back it has the same values and the same exact form."""
    names = (*SE2.strain, "a")
    e = parse(text, names)
    back = to_expression(to_sympy(e))
    assert back is not None
    assert vanishes([to_sympy(back) - to_sympy(e)], near={"h1": 1}, positive=("a",)).value is True
    at = {"h1": 1.3, "h2": 0.4, "Pi": -0.7, "a": 1.5}
    assert evaluate(back, at) == pytest.approx(evaluate(e, at), rel=1e-13)


def test_an_arctangent_has_no_place_in_a_model() -> None:
    """None, not something else."""
    assert to_expression(sp.atan(x)) is None


def test_slopes_do_not_see_jumps() -> None:
    """The slope of a step is zero, that of a modulus a sign."""
    assert slope(sp.Heaviside(x - 1) * x**2, x) == 2 * x * sp.Heaviside(x - 1)
    values: dict[str, Any] = {"x": np.array([-2.0, 3.0])}
    found = to_expression(slope(sp.Abs(sp.log(x**2 + 1) - 1), x))
    assert found is not None
    assert np.sign(evaluate(found, values)).tolist() == [-1.0, 1.0]


def test_readable_is_equal_and_not_longer() -> None:
    """Several ways to write it are tried."""
    e = (x + 1) ** 2 - x**2 - 2 * x + y * sp.sinh(x) / sp.cosh(x) - y * sp.tanh(x)
    assert readable(e) == 1
