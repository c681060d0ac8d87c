"""Loops whose net work is certified, against closed forms and quadrature."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

import numpy as np
import pytest

from geocosserat.algebra.groups import SE2
from geocosserat.model.expressions import Expression, evaluate, parse
from geocosserat.passivity.loop import Loop, curl_on_grid, exact_number, find_loop, work_of
from geocosserat.passivity.ranges import ALL, Range

F = Fraction
NAMES = SE2.strain
REST = (F(1), F(0), F(0))
PLANES = ((0, 1), (0, 2), (1, 2))


def _stress(*texts: str) -> tuple[Expression, ...]:
    return tuple(parse(t, (*NAMES, "a", "u")) for t in texts)


def _find(
    *texts: str, box: Mapping[str, Range] | None = None, values: Mapping[str, Fraction] | None = None
) -> Loop | None:
    return find_loop(_stress(*texts), NAMES, REST, {**dict.fromkeys(NAMES, ALL), **(box or {})}, PLANES, [values or {}])


def _quadrature(stress: tuple[Expression, ...], loop: Loop, count: int = 20_000) -> float:
    """Minus the integral of the stress along the loop, by the midpoint rule."""
    s = (np.arange(count) + 0.5) / count
    way = {name: np.broadcast_to(evaluate(e, {"s": s}), s.shape) for name, e in loop.path(NAMES).items()}
    ends = {name: np.broadcast_to(evaluate(e, {"s": np.arange(count + 1) / count}), count + 1) for name, e in
            loop.path(NAMES).items()}  # fmt: skip
    env = {**way, **{name: float(v) for name, v in loop.parameters.items()}}
    return -sum(float(np.sum(evaluate(e, env) * np.diff(ends[name]))) for e, name in zip(stress, NAMES, strict=True))


def test_the_work_of_an_odd_modulus_is_its_curl_times_the_area() -> None:
    """F2 = a Pi, M = -a h2 gives 2 a pi r**2, around the reference."""
    loop = _find("10*(h1 - 1)", "3*h2 + a*Pi", "Pi - a*h2", values={"a": F(3)})
    assert loop is not None
    assert loop.centre == REST
    assert {loop.first, loop.second} == {1, 2}
    assert loop.radii == (F(1, 10), F(1, 10))
    assert loop.parameters == {"a": 3}
    exact = 2 * 3 * np.pi * 0.01
    assert loop.low <= exact <= loop.high
    assert 0 < loop.low <= loop.work <= loop.high
    assert loop.high - loop.low < 1e-9 * exact


@pytest.mark.parametrize(
    "stress",
    [
        ("h2", "0", "0"),
        ("tanh(h1 - 1) + h2", "h1*h2", "sin(Pi)*h2"),
        ("-h2/((h1 - 1)**2 + h2**2)", "(h1 - 1)/((h1 - 1)**2 + h2**2)", "0"),
        ("0", "heaviside(h1 - 1)*h2", "0"),
        ("0", "(h1 - 1)**2*h2", "Pi"),
        ("exp(h2)", "abs(h1 - 1)*h2", "0"),
    ],
)
def test_the_certified_work_is_what_quadrature_finds(stress: tuple[str, ...]) -> None:
    """In double precision, along the path that the loop gives: the law gives work, whichever way it turns."""
    loop = _find(*stress)
    assert loop is not None
    assert loop.low > 0
    assert loop.work == pytest.approx(_quadrature(_stress(*stress), loop), rel=2e-3)


def test_a_curl_far_below_double_precision_is_certified() -> None:
    """1e-30 of a curl beside stiffnesses of one: the precision is raised until the sign is sure."""
    loop = _find("tanh(h1 - 1)", "3*h2 + 1e-30*Pi", "Pi - 1e-30*h2")
    assert loop is not None
    assert loop.bits > 64
    exact = 2e-30 * np.pi * float(loop.radii[0]) * float(loop.radii[1])
    assert loop.low <= exact <= loop.high
    assert loop.low > 0


def test_no_loop_is_found_for_a_gradient() -> None:
    """Nothing is certified that is not there."""
    stress = _stress("tanh(h1 - 1 + h2)", "tanh(h1 - 1 + h2)", "Pi")
    assert find_loop(stress, NAMES, REST, dict.fromkeys(NAMES, ALL), PLANES, deep=False) is None


def test_a_loop_stays_in_the_domain() -> None:
    """Narrow intervals make a small ellipse, off the reference if that lies on the edge."""
    box: dict[str, Range] = {"h1": (F(99, 100), F(101, 100)), "h2": (F(0), F(1, 20))}
    loop = _find("sqrt(h2)", "log(h1)", "0", box=box)
    assert loop is not None
    for index, radius in ((loop.first, loop.radii[0]), (loop.second, loop.radii[1])):
        low, high = box.get(NAMES[index], ALL)
        assert low <= loop.centre[index] - radius
        assert loop.centre[index] + radius <= high


def test_the_loop_backwards_takes_what_it_gave() -> None:
    """The order of its components is its sense."""
    stress = _stress("h2", "0", "0")
    loop = _find("h2", "0", "0")
    assert loop is not None
    back = Loop(loop.centre, loop.second, loop.first, loop.radii, 0.0, 0.0, 0.0, 64, {})
    assert (work_of(stress, NAMES, loop) + work_of(stress, NAMES, back)).contains(0)
    assert work_of(stress, NAMES, back) < 0


def test_the_work_is_minus_the_integral_of_the_curl_over_the_inside() -> None:
    """Stokes, on the grid that is drawn."""
    stress = _stress("h2**3 + h2", "sin(h1)", "0")
    loop = find_loop(stress, NAMES, REST, dict.fromkeys(NAMES, ALL), ((0, 1),))
    assert loop is not None
    a, b = (float(r) for r in loop.radii)
    x, y, curl = curl_on_grid(stress, NAMES, loop, (a, b), 601)
    assert x.shape == y.shape == curl.shape == (601, 601)
    x0, y0 = (float(loop.centre[i]) for i in (loop.first, loop.second))
    inside = ((x - x0) / a) ** 2 + ((y - y0) / b) ** 2 < 1
    area = (2 * a / 600) * (2 * b / 600)
    assert -float(np.sum(curl[inside])) * area == pytest.approx(loop.work, rel=5e-3)


@pytest.mark.parametrize("value", [F(1, 10), F(1, 3), F(-7, 97), F(5), F(123456789, 1000)])
def test_rationals_are_written_exactly(value: Fraction) -> None:
    """Decimals where they are exact, quotients elsewhere."""
    assert evaluate(exact_number(value), {}) == pytest.approx(float(value), rel=1e-15)
