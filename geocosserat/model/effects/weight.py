"""Weight: a force density fixed in the world."""

from __future__ import annotations

from dataclasses import dataclass

from geocosserat.model.describe import vector_text
from geocosserat.model.effects.effect import Effect, Key, Pair
from geocosserat.model.effects.registry import register
from geocosserat.model.expressions import Expression
from geocosserat.model.seen import Seen, Vector, dot, nothing


@register
@dataclass(frozen=True, slots=True)
class Weight(Effect):
    """``force``: in the world (force / length)."""

    kind = "weight"
    keys = {"force": Key("world")}  # noqa: RUF012

    force: Vector

    def wrench(self, seen: Seen) -> Pair:
        return seen.to_body(self.force), nothing(seen.rotations)

    def potential(self, seen: Seen) -> Expression:
        return -dot(self.force, seen.position)

    def __str__(self) -> str:
        return f"weight {vector_text(self.force)} per length, fixed in the world"
