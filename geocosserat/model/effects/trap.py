"""Trap: every point of the rod is drawn to a place in the world, as by an optical trap."""

from __future__ import annotations

from dataclasses import dataclass

from geocosserat.model.describe import vector_text
from geocosserat.model.effects.effect import Effect, Key, Pair
from geocosserat.model.effects.registry import register
from geocosserat.model.expressions import Expression, to_text
from geocosserat.model.seen import Seen, Vector, dot, nothing


@register
@dataclass(frozen=True, slots=True)
class Trap(Effect):
    """``stiffness``: of a spring, per length (force / length²); ``centre``: where it is at rest, in the world."""

    kind = "trap"
    keys = {"stiffness": Key("scalar"), "centre": Key("world", "t")}  # noqa: RUF012

    stiffness: Vector
    centre: Vector

    def wrench(self, seen: Seen) -> Pair:
        (stiffness,) = self.stiffness
        pull = tuple(stiffness * away for away in self._away(seen))
        return seen.to_body(pull), nothing(seen.rotations)

    def potential(self, seen: Seen) -> Expression:
        (stiffness,) = self.stiffness
        away = self._away(seen)
        return 0.5 * (stiffness * dot(away, away))

    def _away(self, seen: Seen) -> Vector:
        return tuple(c - x for c, x in zip(self.centre, seen.position, strict=True))

    def __str__(self) -> str:
        return f"trap of stiffness {to_text(self.stiffness[0])} per length about {vector_text(self.centre)}"
