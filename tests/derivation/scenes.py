"""Rods with every effect, with frozen modes and with rotations that have no friction, for the derivation's tests."""

from __future__ import annotations

import dataclasses
from functools import lru_cache
from itertools import combinations

import sympy as sp

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.derivation.distribute import terms
from geocosserat.derivation.equations import derive
from geocosserat.derivation.limit import LimitEquations, limit
from geocosserat.derivation.records import FieldEquations
from geocosserat.model.effects.couple import Couple
from geocosserat.model.effects.effect import Effect
from geocosserat.model.effects.field import Field
from geocosserat.model.effects.flow import Flow
from geocosserat.model.effects.follower import Follower
from geocosserat.model.effects.trap import Trap
from geocosserat.model.effects.weight import Weight
from geocosserat.model.expressions import Expression, parse
from geocosserat.model.records import RodModel
from tests.derivation.rods import TINY, random_value

VALUES = {
    "k1": 40.0, "k2": 30.0, "k3": 1.25, "k4": 0.75, "gamma1": 1.0, "gamma2": 2.5, "gamma3": 0.25, "gamma4": 0.125,
    "wa": 0.5, "la": 0.75, "ca": 1.5, "na": 0.25, "ba": 1.25, "ga": 0.875, "qa": 0.375, "sa": 2.0, "xa": 0.625,
    "a": 0.3, "b": 0.7,
}  # fmt: skip
NAMES = frozenset({"u", "t", *VALUES})


def vector(*entries: str | float) -> tuple[Expression, ...]:
    """Expressions from texts and numbers."""
    return tuple(parse(x, NAMES) for x in entries)


def diagonal(*entries: str | float) -> tuple[tuple[Expression, ...], ...]:
    """A diagonal matrix of expressions."""
    return tuple(vector(*(x if i == j else 0 for j in range(len(entries)))) for i, x in enumerate(entries))


def planar(**changes: object) -> RodModel:
    """A straight planar rod with a parameter for every coefficient."""
    model = RodModel(
        SE2, 1.0, diagonal("k1", "k2", "k3"), diagonal("gamma1", "gamma2", "gamma3"), vector(1, 0, 0), parameters=VALUES
    )
    return dataclasses.replace(model, **changes)


def spatial(**changes: object) -> RodModel:
    """A straight spatial rod, likewise."""
    model = RodModel(
        SE3,
        1.0,
        diagonal("k1", "k2", "k2", "k3", "k4", "k4 + 1"),
        diagonal("gamma1", "gamma2", "gamma2", "gamma3", "gamma4", "gamma4"),
        vector(1, 0, 0, 0, 0, 0),
        parameters=VALUES,
    )
    return dataclasses.replace(model, **changes)


QUASISTATIC = {SE2: diagonal("gamma1", "gamma2", 0), SE3: diagonal("gamma1", "gamma2", "gamma2", "gamma3", 0, 0)}
"""Friction matrices in which bending rotations have none."""


def effects(group: Group) -> dict[str, tuple[Effect, frozenset[str]]]:
    """One effect of each kind, and the parameters that it brings."""
    flat = group.space == 2
    third: tuple[float, ...] = () if flat else (0.5,)
    gradient = ("qa", "t", 0.25, "-qa/2") if flat else ("qa", "t", 0, 0.25, "-qa/2", 0.125, 0, 1, "-qa/2")
    return {
        "weight": (Weight(vector("wa*t", "-wa", *third)), frozenset({"wa"})),
        "follower": (Follower(vector("la*u", "t", *third)), frozenset({"la"})),
        "couple": (Couple(vector("ca*t") if flat else vector("ca", 0, "u")), frozenset({"ca"})),
        "field": (Field(vector("na", 0.5, *third), vector("ba*cos(t)", "ba", *third)), frozenset({"na", "ba"})),
        "flow": (Flow(vector(*gradient), vector("ga", "t", *third)), frozenset({"qa", "ga"})),
        "trap": (Trap(vector("sa*(1 + u)"), vector("xa", "xa*t", *third)), frozenset({"sa", "xa"})),
    }


BASE = {SE2: planar(), SE3: spatial()}
FULL = {group: dataclasses.replace(BASE[group], effects=tuple(e for e, _ in effects(group).values())) for group in BASE}
"""Rods with all effects at once."""

PLANAR_SUBSETS = [subset for size in (1, 2) for subset in combinations(SE2.strain, size)]
SPATIAL_SUBSETS = [
    ("h1",), ("Pi1",), ("h1", "h2"), ("h2", "Pi3"), ("h1", "h2", "h3"), ("Pi1", "Pi2", "Pi3"), ("h1", "Pi2", "Pi3"),
    ("h1", "h2", "h3", "Pi1"), ("h1", "h3", "Pi1", "Pi3"), ("h2", "h3", "Pi1", "Pi2", "Pi3"),
    ("h1", "h2", "h3", "Pi2", "Pi3"), ("h1", "h2", "h3", "Pi1", "Pi2"),
]  # fmt: skip
_WITHOUT_FRICTION = {*PLANAR_SUBSETS, ("h2",), ("h2", "h3"), ("h1", "h2", "h3"), ("h1", "h2", "h3", "Pi1")}
FROZEN = {
    f"{name}{', no friction' if still else ''}: {' '.join(subset)}": dataclasses.replace(
        BASE[group], frozen=subset, **({"friction": QUASISTATIC[group]} if still else {})
    )
    for name, group, subsets in (
        ("planar", SE2, PLANAR_SUBSETS),
        ("spatial", SE3, [*SPATIAL_SUBSETS, ("h2",), ("h2", "h3")]),
    )
    for subset in subsets
    for still in (False, True)
    if not still or subset in _WITHOUT_FRICTION
}
"""Rods with frozen modes: all subsets in the plane, a sample in space, with and without rotational friction."""


@lru_cache(maxsize=100)
def derived(name: str) -> FieldEquations:
    """The equations of that one of FROZEN."""
    return derive(FROZEN[name])


@lru_cache(maxsize=100)
def limited(name: str) -> LimitEquations:
    """Its limit."""
    return limit(derived(name))


def same(a: sp.Expr, b: sp.Expr) -> bool:
    """Equal in every term, and as numbers at two random values of every field and derivative to 30 digits."""
    close = all(
        abs(random_value(a - b, seed).xreplace(NUMBERS).evalf(40)) <= TINY * (1 + abs(number(b, seed)))
        for seed in (3, 5)
    )
    return terms(a - b) == {} and bool(close)


def number(e: sp.Expr, seed: int) -> sp.Expr:
    """The value of e with a random number for every field and derivative."""
    return random_value(e, seed).xreplace(NUMBERS).evalf(40)


NUMBERS = {sp.Symbol(name, real=True): sp.Rational(str(x)) for name, x in VALUES.items()}
"""Exact values of the parameters."""
