"""Rods, and random smooth motions in every chart, with the rotation by another definition than that of the chart."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp
from numpy.typing import NDArray

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.derivation.charts import chart_names, chart_of, frame
from geocosserat.derivation.notation import T, U, field, fields
from geocosserat.model.effects.flow import Flow
from geocosserat.model.effects.trap import Trap
from geocosserat.model.records import End
from tests.derivation.rods import (
    HEAVY_PLANAR,
    HEAVY_SPATIAL,
    PLAIN_PLANAR,
    PLAIN_SPATIAL,
    diagonal,
    random_motion,
    smooth,
    vector,
)

Array = NDArray[Any]
CASES = [(group, name) for group in (SE2, SE3) for name in chart_names(group)]
IDS = [name for _, name in CASES]
SPATIAL = [name for group, name in CASES if group is SE3]
PRECISE = 60
SEED = 5
HEAVY = {SE2: HEAVY_PLANAR, SE3: HEAVY_SPATIAL}
# frozen modes, a rotation without friction, effects that see place and orientation, a pinned and a driven end
SWEPT = {
    SE2: dataclasses.replace(
        HEAVY_PLANAR,
        friction=diagonal(1, 2, 0),
        frozen=("h1",),
        left=End("pinned", torque=vector("a*t")),
        right=End("driven", twist=vector(1, "t", "a")),
        effects=(Trap(vector("a"), vector("t", "b")), Flow(vector(1, "a", 2, -1), vector("t", 1))),
    ),
    SE3: dataclasses.replace(
        HEAVY_SPATIAL,
        frozen=("h2", "Pi1"),
        left=End("pinned", torque=vector("a*t", 1, 2), frame="world"),
        right=End("driven", twist=vector(1, "t", "a", 0, 0, "t")),
        effects=(Trap(vector("a"), vector("t", "b", 1)), Flow(vector(1, 2, 0, "a", -1, 0, 3, 0, 0), vector("t", 1, 0))),
    ),
}
PLAIN = {SE2: PLAIN_PLANAR, SE3: PLAIN_SPATIAL}
Point = tuple[sp.Rational, sp.Rational]


@lru_cache(maxsize=40)
def explicit(group: Group, name: str) -> dict[str, sp.Expr]:
    """The coordinates of a random smooth motion as functions of (u, t), by the names of their fields."""
    chart = chart_of(group, name)
    rng = np.random.default_rng(SEED)
    values = [smooth(rng) / 2 for _ in range(group.space + len(chart.coordinates))]
    names = [q.func.__name__ for q in (*chart.position, *chart.coordinates)]
    if name == "quaternion":
        length = sp.sqrt(sp.Add(*(x**2 for x in values[3:])))
        values[3:] = [x / length for x in values[3:]]
    if name == "matrix":
        values[3:] = random_motion(group, SEED).rotation.T.ravel()
    return dict(zip(names, values, strict=True))


def coordinates_at(group: Group, name: str, u: Any, t: Any) -> list[Any]:
    """Those of the rotation at (u, t)."""
    return _function(group, name)(u, t)[group.space :]


@lru_cache(maxsize=40)
def _function(group: Group, name: str) -> Callable[[Any, Any], list[Any]]:
    values = list(explicit(group, name).values())
    function: Callable[[Any, Any], list[Any]] = sp.lambdify([U, T], values, "mpmath", cse=True)
    return function


def hat(w: list[Any]) -> mp.matrix:
    """The matrix of w x."""
    x, y, z = w
    return mp.matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def rotation(name: str, q: list[Any]) -> mp.matrix:
    """The frame of these coordinates, by what their name means and not by the formulas of the chart."""
    match name:
        case "angle":
            z = mp.expj(q[0])
            return mp.matrix([[z.real, -z.imag], [z.imag, z.real]])
        case "rotation-vector":
            return mp.expm(hat(q))
        case "quaternion":
            return mp.matrix([list(row) for row in zip(*(_turned(q, axis) for axis in range(3)), strict=True)])
        case "cayley":
            return mp.inverse(mp.eye(3) - hat(q)) * (mp.eye(3) + hat(q))
        case "euler":
            return mp.expm(hat([0, 0, q[0]])) * mp.expm(hat([0, q[1], 0])) * mp.expm(hat([q[2], 0, 0]))
        case "matrix":
            return mp.matrix([[q[0], q[3], q[6]], [q[1], q[4], q[7]], [q[2], q[5], q[8]]])
    raise AssertionError(name)


def _turned(p: list[Any], axis: int) -> list[Any]:
    """The imaginary part of p i p*, for one of the units i."""
    unit = [mp.mpf(int(k == axis + 1)) for k in range(4)]
    return _times(_times(p, unit), [p[0], -p[1], -p[2], -p[3]])[1:]


def _times(p: list[Any], q: list[Any]) -> list[Any]:
    a, b, c, d = p
    e, f, g, h = q
    return [
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    ]


@lru_cache(maxsize=100)
def measured(group: Group, name: str, point: Point) -> dict[sp.Expr, sp.Expr]:
    """Turn, its slope, twist, frame and place of that motion at a point, by the fields of the chart-free equations.

    From the independent rotation, differenced in 60 digits: with g the configuration, E = g^-1 g', E' = g^-1 g'' - E E
    and V = g^-1 dg/dt.
    """
    n = group.space
    with mp.workdps(PRECISE):
        u, t = (mp.mpf(x.p) / x.q for x in point)

        @lru_cache(maxsize=100)
        def pose(precision: int, *at: Any) -> mp.matrix:
            g = mp.eye(n + 1)
            values = _function(group, name)(*at)
            g[1:, 0], g[1:, 1:] = mp.matrix(values[:n]), rotation(name, values[n:])
            return g

        def slope(orders: tuple[int, int]) -> mp.matrix:
            out = mp.matrix(n + 1)
            for index in np.ndindex(n + 1, n + 1):
                out[index] = mp.diff(lambda *at, index=index: pose(mp.mp.prec, *at)[index], (u, t), orders)
            return out

        g = pose(mp.mp.prec, u, t)
        inverse = mp.inverse(g)
        E, V = inverse * slope((1, 0)), inverse * slope((0, 1))
        bent = inverse * slope((2, 0)) - E * E
        for algebra in (E, V, bent):
            assert mp.norm(algebra[1:, 1:] + algebra[1:, 1:].T) < mp.mpf(10) ** -35
        strain, twist = fields(group.strain), fields(group.twist)
        out = dict(zip((*strain, *twist), (*_vee(E), *_vee(V)), strict=True))
        out |= {f.diff(U): x for f, x in zip(strain, _vee(bent), strict=True)}
        out |= {e: g[1 + i, 1 + j] for (i, j), e in np.ndenumerate(frame(group))}
        out |= {field(axis): g[1 + k, 0] for k, axis in enumerate("xyz"[:n])}
        if n == 2:
            out[field("theta")] = _function(group, name)(u, t)[2]
        return {f: sp.Float(str(x), 50) for f, x in out.items()}


def _vee(M: mp.matrix) -> list[Any]:
    """Components of a matrix of the algebra, where its entries are positive."""
    rotations = [M[2, 1]] if M.rows == 3 else [M[3, 2], M[1, 3], M[2, 1]]
    return [*M[1:, 0], *rotations]


@lru_cache(maxsize=10_000)
def jet(group: Group, name: str, of: sp.Expr, point: Point) -> sp.Expr:
    """A coordinate of that motion, or a derivative of one, at a point, to 45 digits."""
    base, orders = (of.expr, dict(of.variable_count)) if isinstance(of, sp.Derivative) else (of, {})
    k = list(explicit(group, name)).index(base.func.__name__)
    with mp.workdps(PRECISE):
        u, t = (mp.mpf(x.p) / x.q for x in point)
        order = (int(orders.get(U, 0)), int(orders.get(T, 0)))
        x = mp.diff(lambda *at: _function(group, name)(*at)[k], (u, t), order)
        return sp.Float(str(x), 45)
