"""The wrench of a law: written of the configuration by its own names, x, y and theta or the axes of the frame."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from geocosserat.model.describe import vector_text
from geocosserat.model.effects.effect import Effect, Pair
from geocosserat.model.expressions import (
    Binary,
    Call,
    Expression,
    ExpressionError,
    Negate,
    Symbol,
    substitute,
    symbols,
)
from geocosserat.model.law import Law
from geocosserat.model.seen import AXES, Seen, Vector, seen

ANGLE = "theta"

@dataclass(frozen=True, slots=True)
class LawWrench(Effect):
    """``components``: in the moving frame, of what is seen and of ``names``; ``given``: what these stand for.

    ``law``: where it is from. ``gives``: whether it may feed the rod; what it does then counts as a loss of the rod's
    own, less than nothing, and not as the work of the world.
    """

    kind = "law"
    keys = {}  # noqa: RUF012

    components: Vector
    names: tuple[str, ...]
    given: Vector
    law: Law
    gives: bool = True

    def wrench(self, seen: Seen) -> Pair:
        values = dict(zip(self.names, self.given, strict=True))
        wrench = tuple(substitute(e, values) for e in self.components)
        return wrench[: seen.space], wrench[seen.space :]

    def values(self) -> dict[str, Vector]:
        return {"given": self.given}

    def renamed(self, name: Callable[[str, int, Expression], Expression]) -> Effect:
        return replace(self, given=tuple(name("given", i, e) for i, e in enumerate(self.given)))

    def __str__(self) -> str:
        return f"wrench {vector_text(self.components)} of the law"


def law_wrench(law: Law) -> LawWrench:
    """The wrench of a law as an effect. Raises ExpressionError for an angle that stands by itself."""
    assert law.wrench is not None
    frame = seen(law.group.space)
    components = tuple(_in_sight(e, _seen(law, frame), frame) for e in law.wrench)
    known = {s for vector in (*frame.axes, frame.position) for e in vector for s in symbols(e)}
    names = tuple(sorted({s for e in components for s in symbols(e)} - known))
    return LawWrench(components, names, tuple(Symbol(name) for name in names), law)


def _seen(law: Law, frame: Seen) -> dict[str, Expression]:
    """What of the pose is seen, for the names of the law; of an angle nothing but its cosine and sine is."""
    axes = AXES[: frame.space]
    places = dict(zip(axes, frame.position, strict=True))
    if frame.space == 2:
        return places
    return places | {f"e{i + 1}{axis}": frame.axes[k][i] for k, axis in enumerate(axes) for i in range(3)}


def _in_sight(e: Expression, sight: Mapping[str, Expression], frame: Seen) -> Expression:
    if frame.space == 2:
        e = _turned(e, frame)
        if ANGLE in symbols(e):
            raise ExpressionError(f"{ANGLE} must be the argument of cos or sin, for turns are not counted")
    return substitute(e, sight)


def _turned(e: Expression, frame: Seen) -> Expression:
    """Cosine and sine of the angle, as they are seen."""
    c, s = frame.axes[0][0], frame.axes[1][0]
    match e:
        case Call(function, Symbol(name)) if name == ANGLE and function in ("cos", "sin", "tan"):
            return {"cos": c, "sin": s, "tan": s / c}[function]
        case Call(function, argument):
            return Call(function, _turned(argument, frame))
        case Binary(operator, left, right):
            return Binary(operator, _turned(left, frame), _turned(right, frame))
        case Negate(operand):
            return Negate(_turned(operand, frame))
        case _:
            return e
