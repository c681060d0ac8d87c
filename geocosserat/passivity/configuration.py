"""Configurations as a law names them, the fields that act there, and closed loops of configurations."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any, Final

import numpy as np
import sympy as sp

from geocosserat.algebra.fields import tangents
from geocosserat.algebra.groups import Array, Group
from geocosserat.algebra.symbolic import configuration
from geocosserat.derivation.notation import symbol
from geocosserat.model.expressions import Binary, Call, Expression, Number, Symbol
from geocosserat.model.law import pose_names

TURN: Final[Expression] = Binary("*", Number(2.0), Number(math.pi))
"""A full turn, unrounded."""

CAYLEY: Final = tuple(sp.Symbol(f"c'{i}", real=True) for i in (1, 2, 3))
"""Parameters of a rotation; no law can use these names."""


def pose(group: Group) -> Array:
    """The configuration with the names of a law in it: object array (size, size)."""
    if group.rotations == 3:
        return configuration(group)
    x, y, theta = (symbol(name) for name in pose_names(group))
    c, s = sp.cos(theta), sp.sin(theta)
    return group.pose(np.array([x, y], dtype=object), np.array([[c, -s], [s, c]], dtype=object))


@lru_cache(maxsize=4)
def field_rates(group: Group) -> tuple[dict[sp.Symbol, sp.Expr], ...]:
    """X_a of every name of a configuration: how it changes along each of the group's own fields."""
    g = pose(group)
    moved = tangents(group, g)
    rates = []
    for a, along in enumerate(moved):
        if group.rotations == 3:
            pairs = {g[i]: along[i] for i in np.ndindex(g.shape) if isinstance(g[i], sp.Symbol)}
        else:
            # the angle is no entry of the matrix: R' = R b_a, of which it is the rotation
            places = {g[1 + k, 0]: along[1 + k, 0] for k in range(2)}
            pairs = {**places, symbol("theta"): sp.Integer(int(group.vee(group.basis[a])[-1]))}
        rates.append({x: sp.S.Zero + rate for x, rate in pairs.items()})
    return tuple(rates)


def slope(e: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """de/dx beside the steps of ``e``: their jumps are not seen."""
    d = e.diff(x)
    return d.replace(sp.DiracDelta, lambda *_: sp.S.Zero) if d.has(sp.DiracDelta) else d


def along_fields(group: Group, e: sp.Expr) -> tuple[sp.Expr, ...]:
    """X_a[e] of an expression of a configuration, d expressions."""
    return tuple(
        sp.Add(*(rate * slope(e, x) for x, rate in rates.items() if x in e.free_symbols and rate != 0))
        for rates in field_rates(group)
    )


def free(group: Group, e: sp.Expr) -> sp.Expr:
    """The same with unknowns that nothing binds: in space, rotations by Cayley's rational parametrisation.

    R = 1 + 2 (c x + c x c x) / (1 + c²), which leaves out half turns only.
    """
    return e if group.rotations == 1 else e.xreplace(_bound(group))


@lru_cache(maxsize=4)
def _bound(group: Group) -> dict[sp.Symbol, sp.Expr]:
    rotation = cayley(group, CAYLEY)
    entries = group.rotation(pose(group))
    return {entries[i]: rotation[i] for i in np.ndindex(entries.shape)}


def cayley(group: Group, c: Any) -> Array:
    """Rotation matrix (3, 3) of parameters of any exact numbers or expressions."""
    one = sum(x * x for x in c) + 1
    turn = sum(x * group.rotation(b).astype(object) for x, b in zip(c, group.basis[group.space :], strict=True))
    rotation: Array = np.eye(3, dtype=int).astype(object) + (turn + turn @ turn) * 2 / one
    return rotation


# loops


@dataclass(frozen=True, slots=True)
class Swing:
    """A coordinate over one period: centre + cosine cos(2 pi t) + sine sin(2 pi t) + turns 2 pi t."""

    centre: float = 0.0
    cosine: float = 0.0
    sine: float = 0.0
    turns: int = 0

    @property
    def backwards(self) -> Swing:
        """The same way, gone the other way round."""
        return Swing(self.centre, self.cosine, -self.sine, -self.turns)

    @property
    def later(self) -> Swing:
        """The same way, half a period ahead."""
        return Swing(self.centre, -self.cosine, -self.sine, self.turns)

    @property
    def value(self) -> Expression:
        """The coordinate, an expression of t."""
        phase = TURN * Symbol("t")
        return (
            Number(self.centre)
            + self.cosine * Call("cos", phase)
            + self.sine * Call("sin", phase)
            + float(self.turns) * phase
        )

    @property
    def rate(self) -> Expression:
        """Its derivative by t, exact: no product of pi with another number is rounded."""
        phase = TURN * Symbol("t")
        swing = self.sine * Call("cos", phase) - self.cosine * Call("sin", phase)
        return TURN * (swing + float(self.turns))


@dataclass(frozen=True)
class ConfigurationLoop:
    """A closed loop of configurations, gone round once while t runs from 0 to 1, and the work that a wrench does.

    ``swings``: of the coordinates x, y, theta, or x, y, z (lengths) and alpha, beta, gamma: R = R_x(alpha) R_y(beta)
    R_z(gamma), turns about the axes of the frame one after the other. ``work``, ``low``, ``high``: net work of the
    wrench on the body over one period (force: per length of rod), with certified bounds. ``values``: of u and of open
    parameters, for which that is the work. ``timed``: whether the law's own t runs with the loop's.
    """

    group: Group
    swings: tuple[Swing, ...]
    words: str
    work: float = 0.0
    low: float = 0.0
    high: float = 0.0
    values: Mapping[str, float] = field(default_factory=dict, hash=False)
    timed: bool = False

    @property
    def coordinates(self) -> tuple[Expression, ...]:
        """x, y, theta, or x, y, z, alpha, beta, gamma: expressions of t."""
        return tuple(swing.value for swing in self.swings)

    @property
    def pose(self) -> dict[str, Expression]:
        """The names of a law's configuration, each an expression of t."""
        n = self.group.space
        values = self.coordinates
        if n == 2:
            return dict(zip(pose_names(self.group), values, strict=True))
        rotation = _rotation(self.group, values[n:])
        return dict(zip(pose_names(self.group), (*values[:n], *rotation.T.ravel()), strict=True))

    @property
    def twist(self) -> tuple[Expression, ...]:
        """V = g^-1 dg/dt in the moving frame, in the order of the group's twist: expressions of t, of period 1."""
        n = self.group.space
        rates = np.array([swing.rate for swing in self.swings], dtype=object)
        rotation = _rotation(self.group, self.coordinates[n:])
        velocity = rotation.T @ rates[:n]
        if n == 2:
            return (*velocity, rates[2])
        spin = _times(np.zeros(n, dtype=int), Number(0.0))
        for k in range(n):
            # later turns carry the axis of this one along
            later = _rotation(self.group, self.coordinates[n:], range(k + 1, n))
            spin = spin + np.array([entry * rates[n + k] for entry in later[k]], dtype=object)
        return (*velocity, *spin)


def _rotation(group: Group, angles: tuple[Expression, ...], which: range | None = None) -> Array:
    """The product of plane rotations, object array of expressions."""
    one = np.eye(group.space, dtype=int)
    product = _times(one, Number(1.0))
    for k in which if which is not None else range(group.rotations):
        turn = group.rotation(group.basis[group.space + k])
        square = turn @ turn
        c, s = _circular(angles[k])
        product = product @ (_times(-square, c) + _times(turn, s) + _times(one + square, Number(1.0)))
    return product


def _times(matrix: Array, e: Expression) -> Array:
    """Whole numbers times an expression, entry by entry."""
    out = np.empty(matrix.shape, dtype=object)
    for index, number in np.ndenumerate(matrix):
        out[index] = -e if number == -1 else int(number) * e
    return out


def _circular(angle: Expression) -> tuple[Expression, Expression]:
    if angle == Number(0.0):
        return Number(1.0), Number(0.0)
    return Call("cos", angle), Call("sin", angle)
