"""Bounds hold wherever one looks; what varies is found however narrow it is."""

from __future__ import annotations

import numpy as np
import pytest

from geocosserat.model.bounds import bounds
from geocosserat.model.expressions import Expression, evaluate, parse
from geocosserat.model.features import leaves, pulses

FORMULAS = (
    "t", "-2*t+1", "t**2-t", "t**3", "t**-2", "t**-3", "(t+3)**0.5", "2**t", "t*u", "u/t", "u/(t-0.5)", "sin(7*t)",
    "cos(t*u)", "tan(t)", "exp(-t**2)", "log(t+1.5)", "sqrt(t)", "tanh(9*t)", "sinh(t)", "cosh(t-0.2)", "abs(t-u)",
    "heaviside(t-0.3)*u", "(u-t)*(u+t)", "exp(-((t-0.37)/1e-3)**2)", "sin(t)/t", "(1+t**2)**u", "k*t",
)  # fmt: skip


def formula(text: str) -> Expression:
    return parse(text, frozenset({"t", "u", "k"}))


@pytest.mark.parametrize("text", FORMULAS)
def test_values_lie_within_bounds(text: str) -> None:
    """On intervals long and short, beside poles and across them; where a value is none, nothing is claimed."""
    chance = np.random.default_rng(3)
    size = 10.0 ** chance.uniform(-4, 1, 300)
    low = chance.uniform(-2, 2, 300)
    e = formula(text)
    below, above = (np.broadcast_to(x, 300) for x in bounds(e, {"t": (low, low + size), "u": (low, low), "k": 3.0}))
    for x in np.linspace(0.0, 1.0, 21):
        value = np.broadcast_to(evaluate(e, {"t": low + x * size, "u": low, "k": 3.0}), 300)
        slack = 1e-13 * (1.0 + np.abs(value))
        defined = np.isfinite(value)
        assert np.all((below - slack <= value)[defined])
        assert np.all((value <= above + slack)[defined])
        assert np.all((np.isinf(below) | np.isinf(above))[~defined])


def test_bounds_of_short_intervals_are_close() -> None:
    """Else nothing would ever count as flat."""
    low = np.linspace(0.1, 1.0, 50)
    for text in ("exp(-t**2)", "sin(7*t)*t", "u/t", "tanh(9*t)", "t**2-t", "2**t"):
        below, above = bounds(formula(text), {"t": (low, low + 1e-6), "u": 2.0})
        assert np.all(above - below < 1e-3)


@pytest.mark.parametrize("width", [1e-2, 1e-5, 1e-9])
def test_intervals_gather_where_a_formula_varies(width: float) -> None:
    """Some dozens of them, the shortest a part of the width of a peak; the integral over them has all digits."""
    e = formula(f"exp(-((t-0.37)/{width})**2)")
    edges = leaves(e, "t", 1.0, {})
    sizes = np.diff(edges)
    assert len(edges) < 100
    assert np.all(sizes > 0.0)
    assert sizes.max() == 0.125
    assert 0.01 * width < sizes.min() < 0.2 * width
    x, w = np.polynomial.legendre.leggauss(8)
    places = edges[:-1, None] + sizes[:, None] * (x + 1) / 2
    (peak,) = pulses(e, "t", 1.0, {})
    assert abs(peak - 0.37) < 0.3 * width
    total = np.sum(np.asarray(evaluate(e, {"t": places})) * w * sizes[:, None] / 2)
    assert total == pytest.approx(width * np.sqrt(np.pi), rel=1e-6)


@pytest.mark.parametrize(
    ("text", "peaks"),
    [
        ("exp(-((t-0.37)/1e-4)**2)", [0.37]),
        ("exp(-((t-0.37)/1e-9)**2)", [0.37]),
        ("1/cosh((t-0.5)/1e-5)", [0.5]),
        ("0.3*sin(50*t)+exp(-((t-0.37)/1e-4)**2)", [0.37]),
        ("t*exp(-((t-0.37)/1e-4)**2)-exp(-((t-0.77)/1e-3)**2)", [0.37, 0.77]),
        ("heaviside(t-k)-heaviside(t-k-1e-3)", [0.3005]),
        ("1+1e-12*t", []),
        ("sin(50*t)", []),
        ("exp(-t/0.001)", []),
        ("tanh((t-0.3)/1e-5)", []),
        ("sqrt(t)+1/(2-t)", []),
        ("cos(20000*t)", []),
        ("log(t)", []),
    ],
)
def test_pulses_are_found_and_nothing_else(text: str, peaks: list[float]) -> None:
    """What lasts, or varies everywhere alike, is no pulse: steps see it."""
    np.testing.assert_allclose(pulses(formula(text), "t", 1.0, {"k": 0.3}), peaks, rtol=0, atol=5e-4)
