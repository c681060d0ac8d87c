"""Flow: the medium moves, and drags the rod along."""

from __future__ import annotations

from dataclasses import dataclass

from geocosserat.model.describe import vector_text
from geocosserat.model.effects.effect import Effect, Key, Pair
from geocosserat.model.effects.registry import register
from geocosserat.model.expressions import Expression
from geocosserat.model.seen import Seen, Vector, dot


@register
@dataclass(frozen=True, slots=True)
class Flow(Effect):
    """The linear flow  velocity + gradient . position  (length / time, 1 / time), both in the world.

    The wrench is j = -Γ (V - V_flow): friction resists motion relative to the medium, which turns with half its
    vorticity.
    """

    kind = "flow"
    keys = {"gradient": Key("matrix", "t"), "velocity": Key("world", "t")}  # noqa: RUF012

    gradient: Vector
    velocity: Vector

    def medium(self, seen: Seen) -> Pair:
        n = seen.space
        rows = [self.gradient[n * i : n * i + n] for i in range(n)]
        velocity = tuple(v + dot(row, seen.position) for v, row in zip(self.velocity, rows, strict=True))

        def spin(i: int, j: int) -> Expression:
            return 0.5 * (rows[j][i] - rows[i][j])

        if n == 2:
            return seen.to_body(velocity), (spin(0, 1),)
        return seen.to_body(velocity), seen.to_body((spin(1, 2), spin(2, 0), spin(0, 1)))

    def __str__(self) -> str:
        return f"flow of velocity {vector_text(self.velocity)} and gradient {vector_text(self.gradient)} (by rows)"
