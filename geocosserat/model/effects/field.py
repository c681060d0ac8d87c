"""Field: the torque of a magnetic (or electric) field on a rod magnetised in its own frame."""

from __future__ import annotations

from dataclasses import dataclass

from geocosserat.model.describe import vector_text
from geocosserat.model.effects.effect import Effect, Key, Pair
from geocosserat.model.effects.registry import register
from geocosserat.model.expressions import Expression
from geocosserat.model.seen import Seen, Vector, cross, dot, nothing


@register
@dataclass(frozen=True, slots=True)
class Field(Effect):
    """``moment``: per length, in the moving frame; ``field``: in the world. Their product is a force.

    The field is uniform in space, so there is no force; while it changes in time the potential does work.
    """

    kind = "field"
    keys = {"moment": Key("body"), "field": Key("world", "t")}  # noqa: RUF012

    moment: Vector
    field: Vector

    def wrench(self, seen: Seen) -> Pair:
        return nothing(seen.space), cross(self.moment, seen.to_body(self.field))

    def potential(self, seen: Seen) -> Expression:
        return -dot(self.moment, seen.to_body(self.field))

    def __str__(self) -> str:
        return f"field {vector_text(self.field)} on a moment {vector_text(self.moment)} per length"
