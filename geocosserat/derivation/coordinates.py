"""The field equations of a rod in a chart: a closed system for its coordinates as functions of (u, t).

Turn and twist become functions of the coordinates and of their slopes and rates; the motion of the chart-free
form and the rates of the coordinates close the system. Compatibility then holds of its own accord.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import Array
from geocosserat.derivation.chart_maps import maps
from geocosserat.derivation.charts import Chart, chart_of, frame
from geocosserat.derivation.distribute import terms
from geocosserat.derivation.elimination import put_in
from geocosserat.derivation.notation import T, U, field_names, is_field
from geocosserat.derivation.records import EndConditions, Equation, Equations, FieldEquations, Vector
from geocosserat.model.errors import InputError


@dataclass(frozen=True)
class CoordinateEquations:
    """A rod in a chart of n coordinates, in a group of dimension d; fields of (u, t).

    ``coordinates``: of the position (lengths), then of the rotation (dimensionless). ``frame``: the chart's
    abbreviations and the entries of R, functions of the coordinates (dimensionless). ``turn``: E of coordinates and
    slopes (dimensionless, then 1 / length), without what is frozen; ``twist``: V, d components, the same function
    of coordinates and rates (length / time, then 1 / time). ``rates``: its inverse, dq/dt of coordinates and V, n
    equations. ``stress_law``, ``motion``: those of the chart-free form. ``constraint``: what the coordinates satisfy,
    which the rates keep. ``frozen``: frozen components of E, as functions of coordinates and slopes, at their
    reference; ``multipliers``: the stresses that keep them there and have no law. ``left``, ``right``: the ends; that
    a clamped end has no twist is said by the rates of its coordinates. ``alone``: in the plane, the motion with turn
    and twist put in, forces in the world (force / length, then force), for x, y and theta alone; empty in space.
    ``singular``: where the chart fails, if it does.
    """

    equations: FieldEquations
    chart: Chart
    coordinates: Vector
    frame: Equations
    turn: Equations
    twist: Equations
    rates: Equations
    stress_law: Equations
    motion: Equations
    constraint: Equations
    frozen: Equations
    multipliers: Vector
    left: Equations
    right: Equations
    alone: Equations
    singular: Equations

    @property
    def unknowns(self) -> Vector:
        """The fields of the closed system: coordinates, twist, multipliers, and the stress if the motion keeps it."""
        kept = tuple(e.left for e in self.stress_law) if self.equations.keeps_stress else ()
        return (*self.coordinates, *self.equations.twist, *self.multipliers, *kept)

    @property
    def closed(self) -> Equations:
        """The closed system, as many equations as ``unknowns``; ``frame`` and ``turn`` define what else occurs."""
        laws = self.stress_law if self.equations.keeps_stress else ()
        return self.motion + self.rates + self.frozen + laws

    @property
    def definitions(self) -> Mapping[sp.Expr, sp.Expr]:
        """What abbreviations, frame and turn stand for, each with the ones before it put in."""
        known: dict[sp.Expr, sp.Expr] = {}
        for equation in (*self.frame, *self.turn):
            known[equation.left] = put_in(equation.right, known)
        return known


def in_chart(equations: FieldEquations, name: str | None = None) -> CoordinateEquations:
    """The equations in the chart of that name, or in the default chart of their group.

    Raises ValueError for a chart that the group has not, and InputError (a ValueError) for equations with
    fields that the configuration does not give, which would not be closed.
    """
    group = equations.group
    chart = chart_of(group, name)
    q = (*chart.position, *chart.coordinates)
    framed = _framed(chart)
    turn = _forward(chart, U)
    measures = tuple(Equation(E, x) for E, x in zip(equations.turn, turn, strict=True) if is_field(E))
    twist = _equations(equations.twist, _forward(chart, T))
    rates = _equations((x.diff(T) for x in q), _rates(chart, equations.twist))
    system = CoordinateEquations(
        equations=equations,
        chart=chart,
        coordinates=q,
        frame=framed,
        turn=measures,
        twist=twist,
        rates=rates,
        stress_law=equations.stress_law,
        motion=equations.motion,
        constraint=chart.constraints,
        frozen=tuple(Equation(x, E) for E, x in zip(equations.turn, turn, strict=True) if not is_field(E)),
        multipliers=equations.multipliers,
        left=_end(equations.left, q),
        right=_end(equations.right, q),
        alone=_alone(equations, chart, measures, twist) if group.space == 2 else (),
        singular=() if chart.singular is None else (Equation(chart.singular, sp.S.Zero),),
    )
    _refuse_open(system)
    return system


def _entries(chart: Chart) -> Array:
    """R as it is used: by its own fields in space, spelt out in the plane."""
    return frame(chart.group) if chart.group.space == 3 else chart.rotation


def _framed(chart: Chart) -> Equations:
    names, values = frame(chart.group).T.ravel(), maps(chart).rotation.T.ravel()
    return (*chart.abbreviations, *(Equation(a, b) for a, b in zip(names, values, strict=True) if a != b))


def _forward(chart: Chart, variable: sp.Symbol) -> Vector:
    """Components of g^-1 dg by that variable: translations from the group, rotations from the chart's map."""
    group = chart.group
    g = group.pose(np.zeros(group.space, dtype=object), _entries(chart))
    moved = np.zeros((group.size, group.size), dtype=object)
    moved[1:, 0] = [x.diff(variable) for x in chart.position]
    along = group.vee(group.inverse(g) @ moved)[: group.translations]
    slopes = np.array([x.diff(variable) for x in chart.coordinates], dtype=object)
    return (*along, *(maps(chart).turning @ slopes))


def _rates(chart: Chart, twist: Vector) -> Vector:
    """Rates of the coordinates: of the position from dg/dt = g hat(V), of the others from the chart's map."""
    group = chart.group
    g = group.pose(np.zeros(group.space, dtype=object), _entries(chart))
    moved = group.position(g @ group.hat(np.array(twist, dtype=object)))
    return (*moved, *(maps(chart).rates @ np.array(twist[group.translations :], dtype=object)))


def _end(end: EndConditions, coordinates: Vector) -> Equations:
    """No twist is no rate of the coordinates; stresses and loads stay as they are."""
    if end.kind == "clamped":
        return tuple(Equation(q.diff(T), sp.S.Zero) for q in coordinates)
    return end.equations


def _alone(equations: FieldEquations, chart: Chart, turn: Equations, twist: Equations) -> Equations:
    """The planar motion turned into the world, with turn and twist by the coordinates."""
    known = {e.left: e.right for e in (*turn, *twist)}
    sides = ([put_in(side, known) for side in (e.left, e.right)] for e in equations.motion)
    left, right = (np.array(side, dtype=object) for side in zip(*sides, strict=True))
    n = equations.group.space
    world = np.eye(equations.group.dimension, dtype=int).astype(object)
    world[:n, :n] = chart.rotation
    rates = [q.diff(T) for q in (*chart.position, *chart.coordinates)]
    return _equations((_collected(e, rates) for e in world @ left), (_circular(e) for e in world @ right))


def _circular(e: sp.Expr) -> sp.Expr:
    """Multiplied out, with 1 - cos² for sin²."""

    def even(factor: sp.Expr) -> sp.Expr:
        base, power = factor.as_base_exp()
        if not isinstance(base, sp.sin) or not power.is_Integer or power < 2:
            return factor
        return (1 - sp.cos(*base.args) ** 2) ** (power // 2) * base ** (power % 2)

    parts = (c * sp.Mul(*map(even, sp.Mul.make_args(product))) for product, c in terms(e).items())
    return sp.Add(*(c * product for product, c in terms(sp.Add(*parts)).items()))


def _collected(e: sp.Expr, rates: Iterable[sp.Expr]) -> sp.Expr:
    """A sum that is linear in the rates, by rate."""
    e = _circular(e)
    return sp.Add(*(e.coeff(rate) * rate for rate in rates))


def _refuse_open(system: CoordinateEquations) -> None:
    """The fields that occur must be coordinates, twist, what these define, or multipliers."""
    parts = (
        system.frame, system.turn, system.rates, system.stress_law, system.motion, system.frozen, system.left,
        system.right,
    )  # fmt: skip
    used = field_names(side for part in parts for e in part for side in (e.left, e.right))
    defined = [e.left for e in (*system.frame, *system.turn, *system.stress_law)]
    rest = used - field_names((*system.coordinates, *system.equations.twist, *system.multipliers, *defined))
    if rest:
        raise InputError(
            "equations in which the configuration is all that is unknown",
            f"also {', '.join(sorted(rest))}",
            "use the form intrinsic",
            key="--form coordinates",
        )


def _equations(left: Iterable[sp.Expr], right: Iterable[sp.Expr]) -> Equations:
    return tuple(Equation(a, b) for a, b in zip(left, right, strict=True))
