"""What follows from a chart is what its rotation matrix says, to 30 digits at random points."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.derivation.chart_maps import maps
from geocosserat.derivation.charts import Chart, chart_names, chart_of, frame
from geocosserat.derivation.coordinates import put_in
from geocosserat.derivation.notation import T, U, field_names, fields
from tests.derivation.charted import CASES, IDS, PRECISE, SPATIAL, coordinates_at, jet, measured, rotation
from tests.derivation.rods import POINTS

ALL = pytest.mark.parametrize(("group", "name"), CASES, ids=IDS)
TINY = mp.mpf(10) ** -30


def at(chart: Chart, e: sp.Expr, values: list[Any]) -> Any:
    """An expression at these coordinates, its abbreviations put in, to the working precision."""
    known: dict[sp.Expr, sp.Expr] = {}
    for name, meaning in (*((e.left, e.right) for e in chart.abbreviations), *framed(chart)):
        known[name] = put_in(meaning, known)
    function = sp.lambdify(list(chart.coordinates), put_in(sp.S(e), known), "mpmath")
    return function(*values)


def framed(chart: Chart) -> list[tuple[sp.Expr, sp.Expr]]:
    """The entries of R, unless they are the coordinates."""
    pairs = zip(frame(chart.group).ravel(), maps(chart).rotation.ravel(), strict=True)
    return [(a, b) for a, b in pairs if a not in chart.coordinates]


def numbers(chart: Chart, array: np.ndarray[Any, Any], values: list[Any]) -> mp.matrix:
    """A matrix of expressions there."""
    return mp.matrix([[at(chart, e, values) for e in row] for row in array])


def random_coordinates(group: Group, name: str) -> list[list[Any]]:
    """Those of a smooth motion at two points."""
    return [coordinates_at(group, name, *(mp.mpf(x.p) / x.q for x in point)) for point in POINTS]


def derivatives(group: Group, name: str, variable: sp.Symbol, point: Any) -> mp.matrix:
    """Slopes or rates of the coordinates of that motion at a point."""
    chart = chart_of(group, name)
    return mp.matrix([mp.mpf(str(jet(group, name, q.diff(variable), point))) for q in chart.coordinates])


@ALL
def test_the_rotation_is_what_the_words_say(group: Group, name: str) -> None:
    """Against the exponential, p i p*, (1 - g)^-1 (1 + g), and the product of three turns about axes."""
    chart = chart_of(group, name)
    with mp.workdps(PRECISE):
        for q in random_coordinates(group, name):
            R = numbers(chart, maps(chart).rotation, q)
            assert mp.norm(R - rotation(name, q)) < TINY
            assert mp.norm(R.T * R - mp.eye(group.space)) < TINY
            assert abs(mp.det(R) - 1) < TINY
            assert mp.norm(R - mp.eye(group.space)) > 0.01


@ALL
def test_the_map_gives_what_differentiating_the_rotation_gives(group: Group, name: str) -> None:
    """turning q' and turning dq/dt are the vee of R^T R' and of R^T dR/dt, differenced in 60 digits."""
    chart = chart_of(group, name)
    with mp.workdps(PRECISE):
        for point, q in zip(POINTS, random_coordinates(group, name), strict=True):
            turning = numbers(chart, maps(chart).turning, q)
            found = measured(group, name, point)
            for names, variable in ((group.strain, U), (group.twist, T)):
                expected = mp.matrix([mp.mpf(str(found[x])) for x in fields(names[group.translations :])])
                assert mp.norm(turning * derivatives(group, name, variable, point) - expected) < TINY
                assert mp.norm(expected) > 0.01


@ALL
def test_the_maps_are_inverse_to_each_other(group: Group, name: str) -> None:
    """turning rates = 1; and rates turning leaves what moves along the constraints alone."""
    chart = chart_of(group, name)
    with mp.workdps(PRECISE):
        for point, q in zip(POINTS, random_coordinates(group, name), strict=True):
            turning, rates = (numbers(chart, m, q) for m in (maps(chart).turning, maps(chart).rates))
            assert mp.norm(turning * rates - mp.eye(group.rotations)) < TINY
            moved = derivatives(group, name, T, point)
            assert mp.norm(rates * (turning * moved) - moved) < TINY
            assert mp.norm(moved) > 0.01


@ALL
def test_rates_keep_the_constraints(group: Group, name: str) -> None:
    """Their gradient times the rates vanishes where they hold."""
    chart = chart_of(group, name)
    assert len(chart.coordinates) - len(chart.constraints) == group.rotations
    with mp.workdps(PRECISE):
        for q in random_coordinates(group, name):
            rates = numbers(chart, maps(chart).rates, q)
            for constraint in chart.constraints:
                assert abs(at(chart, constraint.residual, q)) < TINY
                slope = mp.matrix([[at(chart, constraint.left.diff(x), q) for x in chart.coordinates]])
                assert mp.norm(slope) > 0.1
                assert mp.norm(slope * rates) < TINY


@ALL
def test_the_determinant_is_that_of_the_map(group: Group, name: str) -> None:
    """Of ``turning``, or with the gradient of the constraint below; that of the rates is its reciprocal."""
    chart = chart_of(group, name)
    with mp.workdps(PRECISE):
        for q in random_coordinates(group, name):
            turning, rates = (numbers(chart, m, q) for m in (maps(chart).turning, maps(chart).rates))
            if len(q) == group.rotations:
                assert abs(mp.det(turning) - at(chart, maps(chart).determinant, q)) < TINY
                assert abs(mp.det(rates) * at(chart, maps(chart).determinant, q) - 1) < TINY
            elif name == "quaternion":
                square = mp.matrix([*turning.tolist(), q])
                assert abs(mp.det(square) - at(chart, maps(chart).determinant, q)) < TINY
            else:
                assert maps(chart).determinant is None


def test_charts_without_singular_set_have_bounded_rates_of_constant_size() -> None:
    """rates^T rates is 1 for the angle, 1/4 for the quaternion and 2 for the matrix, wherever."""
    with mp.workdps(PRECISE):
        for group, name, size in ((SE2, "angle", 1), (SE3, "quaternion", mp.mpf(1) / 4), (SE3, "matrix", 2)):
            chart = chart_of(group, name)
            assert chart.singular is None
            for q in random_coordinates(group, name):
                rates = numbers(chart, maps(chart).rates, q)
                assert mp.norm(rates.T * rates - size * mp.eye(group.rotations)) < TINY


def test_a_rotation_vector_is_singular_at_whole_turns_only() -> None:
    """det = 2 c2 vanishes, and the rates grow without bound, at lengths 2 pi, 4 pi, ... and nowhere between."""
    chart = chart_of(SE3, "rotation-vector")
    with mp.workdps(PRECISE):
        assert chart.singular is not None

        def singular(length: Any) -> Any:
            return at(chart, chart.singular, [length * x for x in axis])

        axis = [mp.mpf(k) / 7 for k in (2, 3, 6)]
        for turns in (1, 2, 5):
            assert abs(singular(2 * mp.pi * turns)) < TINY
            near = [(2 * mp.pi * turns + mp.mpf(10) ** -20) * x for x in axis]
            assert mp.norm(numbers(chart, maps(chart).rates, near)) > 1e19
        for length in np.linspace(0.1, 6.2, 20):
            assert singular(mp.mpf(length)) > 1e-5
            # the same set: the determinant is twice this
            q = [mp.mpf(length) * x for x in axis]
            assert abs(at(chart, maps(chart).determinant, q) - 2 * singular(mp.mpf(length))) < TINY


def test_zero_is_no_singular_rotation_vector() -> None:
    """Maps near zero tend to the identity, abbreviations to the values that the words name."""
    chart = chart_of(SE3, "rotation-vector")
    limits = {"c1": "1", "c2": "1/2", "c3": "1/6", "d1": "1", "d2": "1/12"}
    with mp.workdps(120):
        q = [mp.mpf(k) * mp.mpf(10) ** -20 for k in (1, -2, 3)]
        for matrix in (maps(chart).rotation, maps(chart).turning, maps(chart).rates):
            assert mp.norm(numbers(chart, matrix, q) - mp.eye(3)) < mp.mpf(10) ** -18
        for equation in chart.abbreviations[1:]:
            name = equation.left.func.__name__
            limit = sp.Rational(limits[name])
            assert abs(at(chart, equation.left, q) - mp.mpf(limit.p) / limit.q) < TINY
            assert f"{name} = {limits[name]}" in chart.words


def test_euler_angles_are_singular_where_e1_is_vertical() -> None:
    """det = -cos theta vanishes at theta = pi/2, where e1 is plus or minus z, and nowhere else."""
    chart = chart_of(SE3, "euler")
    with mp.workdps(PRECISE):
        for theta in (mp.pi / 2, -mp.pi / 2, 3 * mp.pi / 2):
            q = [mp.mpf("0.3"), theta, mp.mpf("0.7")]
            assert abs(at(chart, chart.singular, q)) < TINY
            assert abs(abs(rotation("euler", q)[2, 0]) - 1) < TINY
            near = [q[0], theta + mp.mpf(10) ** -20, q[2]]
            assert mp.norm(numbers(chart, maps(chart).rates, near)) > 1e19
        for q in random_coordinates(SE3, "euler"):
            assert abs(at(chart, maps(chart).determinant, q) + at(chart, chart.singular, q)) < TINY
            assert abs(at(chart, chart.singular, q)) > 0.01


def test_a_gibbs_vector_is_singular_at_half_turns_only() -> None:
    """1 + tr R = 4 / D > 0 for all finite vectors; the determinant of the rates is 2 / (1 + tr R)^2."""
    chart = chart_of(SE3, "cayley")
    with mp.workdps(PRECISE):
        for q in random_coordinates(SE3, "cayley"):
            trace = at(chart, chart.singular, q)
            assert trace > 0.01
            assert abs(mp.det(numbers(chart, maps(chart).rates, q)) - 2 / trace**2) < TINY * (1 + 2 / trace**2)
        half = mp.expm(mp.pi * mp.matrix([[0, -2, 1], [2, 0, -2], [-1, 2, 0]]) / 3)
        assert abs(1 + half[0, 0] + half[1, 1] + half[2, 2]) < TINY
        far = [mp.mpf(10) ** 20 * k / 3 for k in (2, 1, 2)]
        assert mp.norm(rotation("cayley", far) - half) < 1e-19
        assert at(chart, chart.singular, far) < 1e-39


@ALL
def test_maps_are_written_in_coordinates_and_abbreviations(group: Group, name: str) -> None:
    """No unknown of the reduction is left, and no entry is longer than a few terms."""
    chart = chart_of(group, name)
    known = field_names([*chart.coordinates, *(e.left for e in chart.abbreviations)])
    for matrix in (maps(chart).rotation, maps(chart).turning, maps(chart).rates):
        for e in map(sp.S, matrix.ravel()):
            assert {s.name for s in e.free_symbols} <= {"u", "t"}
            assert field_names([e]) <= known
            assert e.count_ops() <= 14
    assert all(q.func.__name__ not in ("u", "t") for q in chart.coordinates)


def test_the_charts_of_a_group_are_named_the_default_first() -> None:
    """A chart of the other group is none."""
    assert chart_names(SE2) == ("angle",)
    assert chart_names(SE3) == tuple(SPATIAL) == ("rotation-vector", "quaternion", "cayley", "euler", "matrix")
    assert chart_of(SE2).name == "angle"
    assert chart_of(SE3).name == "rotation-vector"
    with pytest.raises(
        ValueError, match=r"chart: expected one of rotation-vector, .*matrix, found 'angle'; choose one"
    ):
        chart_of(SE3, "angle")
    with pytest.raises(ValueError, match="chart: expected one of angle, found 'euler'"):
        chart_of(SE2, "euler")
