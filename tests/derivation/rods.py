"""Small rods to derive, and ways to put numbers into what is derived."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp
from numpy.typing import NDArray

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.derivation.notation import T, U, is_field
from geocosserat.model.effects.weight import Weight
from geocosserat.model.expressions import Expression, parse
from geocosserat.model.records import End, RodModel

Array = NDArray[Any]
NAMES = frozenset({"u", "t", "kappa", "g", "a", "b", "F1", "epsilon"})
VALUES = {"kappa": 1e4, "g": 9.81, "a": 0.3, "b": 0.7, "F1": 2.0, "epsilon": 0.05}
DIGITS = 40
TINY = sp.Float("1e-30")


def vector(*entries: str | float) -> tuple[Expression, ...]:
    """Expressions from texts and numbers."""
    return tuple(parse(x, NAMES) for x in entries)


def diagonal(*entries: str | float) -> tuple[tuple[Expression, ...], ...]:
    """A diagonal matrix of expressions."""
    return tuple(vector(*(x if i == j else 0 for j in range(len(entries)))) for i, x in enumerate(entries))


def full(group: Group, scale: str) -> tuple[tuple[Expression, ...], ...]:
    """A full symmetric matrix of expressions, no two entries alike."""
    d = group.dimension
    return tuple(
        vector(*(f"{scale}*{1 + min(i, j)}/{7 + max(i, j)} + {9 * (i == j)}" for j in range(d)))
        for i in range(d)
    )


def straight(group: Group) -> tuple[Expression, ...]:
    """The straight reference."""
    return vector(1, *([0] * (group.dimension - 1)))


PLAIN_PLANAR = RodModel(
    SE2, 1.0, diagonal("kappa", "kappa", 1.0), diagonal(1.0, 2.0, 0.01), straight(SE2), parameters=VALUES
)
PLAIN_SPATIAL = RodModel(
    SE3,
    1.0,
    diagonal("kappa", "kappa", "kappa", 1.5, "b", 2.0),
    diagonal(1.0, 2.0, 2.0, 0.1, 0.01, 0.01),
    straight(SE3),
    parameters=VALUES,
)
HEAVY_PLANAR = RodModel(
    SE2,
    2.5,
    diagonal("kappa*(1 + u/2)", "kappa", "1 + a*u**2"),
    diagonal(1.0, 2.0, 0.01),
    vector("1 + a*u", 0, "3*(1-u)**2*(1+2*u)"),
    right=End("free", force=vector("a", "b*cos(t)"), torque=vector("0.1*t"), frame="world"),
    effects=(Weight(vector(0, "-g*(1 + u)")),),
    parameters=VALUES,
)
HEAVY_SPATIAL = RodModel(
    SE3,
    2.5,
    full(SE3, "a*(1 + u)"),
    full(SE3, "b"),
    vector("1 + a*u", 0, 0, "u", "3*(1-u)**2*(1+2*u)", "exp(-u)"),
    left=End("free", force=vector(1, "a", "t"), torque=vector(0, "b", 0), frame="body"),
    right=End("free", force=vector(0, "b*sin(t)", "g"), torque=vector("a", 0, 1), frame="world"),
    effects=(Weight(vector(0, 0, "-g")), Weight(vector("a*u*t", 0, "-1/4"))),
    parameters=VALUES,
)
RODS = {
    "plain planar": PLAIN_PLANAR,
    "plain spatial": PLAIN_SPATIAL,
    "heavy planar": HEAVY_PLANAR,
    "heavy spatial": HEAVY_SPATIAL,
}


class Motion:
    """A random smooth motion of a rod: its configuration, its turn and its twist, explicit in (u, t)."""

    def __init__(self, group: Group, seed: int) -> None:
        rng = np.random.default_rng(seed)
        self.group = group
        angles = [smooth(rng) for _ in range(group.rotations)]
        self.angle = angles[0]
        R = _plane(2, 0, 1, angles[0])
        if group.space == 3:
            R = (
                np.eye(3, dtype=int)
                @ _plane(3, 0, 1, angles[0])
                @ _plane(3, 2, 0, angles[1])
                @ _plane(3, 1, 2, angles[2])
            )
        self.rotation = R
        self.position = np.array([smooth(rng) for _ in range(group.space)], dtype=object)
        phi = group.pose(self.position, R)
        self.turn = group.vee(group.inverse(phi) @ derivative(phi, U))
        self.twist = group.vee(group.inverse(phi) @ derivative(phi, T))

    def fields(self) -> dict[str, sp.Expr]:
        """Explicit turn, twist and orientation by the names of their fields."""
        group = self.group
        out = dict(zip((*group.strain, *group.twist), (*self.turn, *self.twist), strict=True))
        if group.space == 2:
            return out | {"theta": self.angle}
        return out | {f"e{i + 1}{'xyz'[k]}": self.rotation[k, i] for k, i in np.ndindex(3, 3)}


def _plane(size: int, i: int, j: int, angle: sp.Expr) -> Array:
    R = np.eye(size, dtype=int).astype(object)
    R[i, i] = R[j, j] = sp.cos(angle)
    R[j, i], R[i, j] = sp.sin(angle), -sp.sin(angle)
    return R


def smooth(rng: np.random.Generator) -> sp.Expr:
    """A random function of (u, t) with all second derivatives."""
    c = [sp.Rational(int(n), 13) for n in rng.integers(-12, 13, 6)]
    return c[0] + c[1] * U + c[2] * T + c[3] * U * T + c[4] * sp.sin(U + 2 * T) + c[5] * U**2


def derivative(array: Array, variable: sp.Symbol) -> Array:
    """Entry by entry."""
    out = np.empty_like(array)
    for index, entry in np.ndenumerate(array):
        out[index] = (sp.Integer(0) + entry).diff(variable)
    return out


def jets(expressions: Iterable[sp.Expr]) -> set[sp.Expr]:
    """The fields and the derivatives of fields that occur, each an independent quantity."""
    found: set[sp.Expr] = set()
    for e in expressions:
        derivatives = e.atoms(sp.Derivative)
        found |= derivatives
        # each its own: terms with one and the same could cancel
        bare = e.xreplace({d: sp.Dummy() for d in derivatives})
        found |= {f for f in bare.atoms(sp.Function) if is_field(f)}
    return found


def value(e: sp.Expr, explicit: dict[str, sp.Expr], u: sp.Rational, t: sp.Rational) -> sp.Expr:
    """e at (u, t) to 40 digits where the fields are these functions of (u, t); parameters at VALUES."""
    numbers = {}
    for jet in jets([e]):
        base = jet.expr if isinstance(jet, sp.Derivative) else jet
        orders = jet.variable_count if isinstance(jet, sp.Derivative) else ()
        numbers[jet] = _number(explicit[base.func.__name__], tuple(tuple(x) for x in orders), u, t)
    return substituted(e, numbers, u, t)


@lru_cache(maxsize=10_000)
def _number(
    function: sp.Expr, orders: tuple[tuple[sp.Symbol, int], ...], u: sp.Rational, t: sp.Rational
) -> sp.Expr:
    for variable, order in orders:
        function = function.diff(variable, order)
    with mp.workdps(DIGITS + 5):
        here = sp.lambdify([U, T], function, "mpmath", cse=True)(mp.mpf(u.p) / u.q, mp.mpf(t.p) / t.q)
        return sp.Float(str(here), DIGITS)


@lru_cache(maxsize=100)
def random_motion(group: Group, seed: int) -> Motion:
    """A random motion, the same for the same seed."""
    return Motion(group, seed)


def parameters(e: sp.Expr) -> dict[sp.Symbol, sp.Rational]:
    """The parameters that occur and their exact VALUES."""
    return {s: sp.Rational(str(VALUES[s.name])) for s in e.free_symbols if s.name in VALUES}


def random_value(e: sp.Expr, seed: int) -> sp.Expr:
    """e with a random number for every field and, independently, every derivative."""
    numbers = {}
    for jet in jets([e]):
        rng = np.random.default_rng([seed, *str(jet).encode()])
        numbers[jet] = sp.Rational(int(rng.integers(-300, 300)), 101)
    return substituted(e, numbers, sp.Rational(3, 7), sp.Rational(5, 11))


def substituted(e: sp.Expr, numbers: dict[sp.Expr, sp.Expr], u: sp.Rational, t: sp.Rational) -> sp.Expr:
    """e with numbers for its jets, coordinates and parameters, to 40 digits."""
    derivatives = {k: v for k, v in numbers.items() if isinstance(k, sp.Derivative)}
    return e.xreplace(derivatives).xreplace(numbers).xreplace({U: u, T: t, **parameters(e)}).evalf(DIGITS)


POINTS: Sequence[tuple[sp.Rational, sp.Rational]] = (
    (sp.Rational(1, 3), sp.Rational(2, 7)),
    (sp.Rational(11, 13), sp.Rational(-4, 9)),
)
