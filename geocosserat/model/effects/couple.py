"""Couple: a moment density fixed in the body."""

from __future__ import annotations

from dataclasses import dataclass

from geocosserat.model.describe import vector_text
from geocosserat.model.effects.effect import Effect, Key, Pair
from geocosserat.model.effects.registry import register
from geocosserat.model.seen import Seen, Vector, nothing


@register
@dataclass(frozen=True, slots=True)
class Couple(Effect):
    """``torque``: in the moving frame (force). It has no potential: in the plane it does work with every turn."""

    kind = "couple"
    keys = {"torque": Key("moment")}  # noqa: RUF012

    torque: Vector

    def wrench(self, seen: Seen) -> Pair:
        return nothing(seen.space), self.torque

    def __str__(self) -> str:
        return f"couple {vector_text(self.torque)} per length, turning with the rod"
