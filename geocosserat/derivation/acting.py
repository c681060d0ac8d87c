"""What acts along a rod, out of the formulas of its effects: the push and the motion of the medium, in fields."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

import sympy as sp

from geocosserat.algebra.groups import Group
from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.notation import symbol
from geocosserat.derivation.orientation import position, rotation
from geocosserat.model.effects.effect import Effect
from geocosserat.model.expressions import Expression, Symbol
from geocosserat.model.seen import seen

Vector = tuple[sp.Expr, ...]


def push(group: Group, effects: Iterable[Effect]) -> Vector:
    """Sum of the wrench densities, d components in the moving frame (force / length, force).

    Raises ExpressionError for a value that is infinite or not real.
    """
    parts = (effect.wrench(seen(group.space)) for effect in effects)
    return _total(group, ((*force, *moment) for force, moment in parts))


def medium(group: Group, effects: Iterable[Effect]) -> Vector:
    """Twist of the medium that drags, d components in the moving frame (length / time, 1 / time).

    Raises ExpressionError as `push`.
    """
    parts = (effect.medium(seen(group.space)) for effect in effects)
    return _total(group, ((*velocity, *spin) for velocity, spin in parts))


def in_fields(group: Group, e: Expression) -> sp.Expr:
    """A formula of an effect, with what it sees of the world as fields of orientation and position."""
    return to_sympy(e).xreplace(_fields_of(group))


def _total(group: Group, vectors: Iterable[tuple[Expression, ...]]) -> Vector:
    rows = [[in_fields(group, e) for e in vector] for vector in vectors]
    return tuple(sp.Add(*(row[k] for row in rows)) for k in range(group.dimension))


@lru_cache(maxsize=2)
def _fields_of(group: Group) -> dict[sp.Symbol, sp.Expr]:
    """The field for each symbol of what is seen."""
    world, R = seen(group.space), rotation(group)
    pairs = [(e, R[axis, i]) for axis, row in enumerate(world.axes) for i, e in enumerate(row)]
    pairs += zip(world.position, position(group), strict=True)
    return {symbol(e.name): value for e, value in pairs if isinstance(e, Symbol)}
