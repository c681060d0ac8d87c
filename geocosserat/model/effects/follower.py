"""Follower: a force density fixed in the body, as of cilia or flagella that push along the rod."""

from __future__ import annotations

from dataclasses import dataclass

from geocosserat.model.describe import vector_text
from geocosserat.model.effects.effect import Effect, Key, Pair
from geocosserat.model.effects.registry import register
from geocosserat.model.seen import Seen, Vector, nothing


@register
@dataclass(frozen=True, slots=True)
class Follower(Effect):
    """``force``: in the moving frame (force / length). It has no potential."""

    kind = "follower"
    keys = {"force": Key("body")}  # noqa: RUF012

    force: Vector

    def wrench(self, seen: Seen) -> Pair:
        return self.force, nothing(seen.rotations)

    def __str__(self) -> str:
        return f"follower force {vector_text(self.force)} per length, turning with the rod"
