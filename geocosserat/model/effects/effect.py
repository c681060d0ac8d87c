"""What an effect is: a density of wrench along the rod, written once for all of derivation, kernels and tests."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import ClassVar, Literal, TypeAlias

from geocosserat.model.describe import vector_text
from geocosserat.model.expressions import Expression, symbols
from geocosserat.model.seen import Seen, Vector, nothing

Needs: TypeAlias = Literal["nothing", "direction", "pose"]
Shape: TypeAlias = Literal["scalar", "world", "body", "moment", "matrix"]
Pair: TypeAlias = tuple[Vector, Vector]
"""Components for translations and for rotations."""
_SHAPES = ("scalar", "world", "body", "moment", "matrix")


@dataclass(frozen=True, slots=True)
class Key:
    """How a value of an effect is written in a scene.

    ``shape``: "scalar", one number; "world" or "body", a vector there; "moment", a number in the plane, three in
    space; "matrix", in the world, as rows. ``varies``: which of ``u`` and ``t`` its expressions may use.
    """

    shape: Shape
    varies: str = "ut"

    def __post_init__(self) -> None:
        if self.shape not in _SHAPES:
            raise ValueError(f"expected a shape of {', '.join(_SHAPES)}, found {self.shape!r}; write one of them")
        if not set(self.varies) <= set("ut"):
            raise ValueError(f'expected to vary with some of "ut", found {self.varies!r}; write "", "u", "t" or "ut"')


class Effect:
    """A kind of effect: subclass it as a frozen dataclass, one field a key, each a tuple of expressions.

    ``kind``: its name in scenes. ``keys``: how each value is written. Write a ``potential``, or a ``wrench`` if there
    is none, or the ``medium`` that drags; formulas in + - * / ** of expressions, the world as ``seen`` by the rod.
    They are made into symbols, kernels and their derivatives.
    """

    kind: ClassVar[str]
    keys: ClassVar[dict[str, Key]]

    def potential(self, seen: Seen) -> Expression | None:
        """Energy density (force) whose loss is the work of the wrench; None if there is none."""
        return None

    def wrench(self, seen: Seen) -> Pair:
        """Force density (force / length) and moment density (force), both in components of the moving frame.

        Unless written otherwise, how the potential falls along each axis of the frame and about it.
        """
        energy = self.potential(seen)
        if energy is None:
            return nothing(seen.space), nothing(seen.rotations)
        along, about = seen.slopes(energy)
        return tuple(-x for x in along), tuple(-x for x in about)

    def medium(self, seen: Seen) -> Pair:
        """Velocity (length / time) and spin (1 / time) of the medium that drags, in components of the moving frame."""
        return nothing(seen.space), nothing(seen.rotations)

    def needs(self, seen: Seen) -> Needs:
        """What of the rod's pose the wrench and the medium use: nothing, directions of the world, or its place too."""
        used = frozenset[str]().union(*(symbols(e) for part in (self.wrench, self.medium) for e in sum(part(seen), ())))
        if used & frozenset[str]().union(*map(symbols, seen.position)):
            return "pose"
        return "direction" if used & frozenset[str]().union(*map(symbols, sum(seen.axes, ()))) else "nothing"

    def values(self) -> dict[str, Vector]:
        """The value of each key, matrices by rows one after the other."""
        assert is_dataclass(self)
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def renamed(self, name: Callable[[str, int, Expression], Expression]) -> Effect:
        """The same effect with each expression replaced: name(key, position, expression)."""
        new = {key: tuple(name(key, i, e) for i, e in enumerate(vector)) for key, vector in self.values().items()}
        return replace(self, **new)  # type: ignore[type-var]

    def __str__(self) -> str:
        values = ", ".join(f"{key} {vector_text(value)}" for key, value in self.values().items())
        return f"{self.kind} of {values}" if values else self.kind


def together(vectors: Iterable[Vector], size: int) -> Vector:
    """The sum of vectors of so many components."""
    result = nothing(size)
    for vector in vectors:
        result = tuple(a + b for a, b in zip(result, vector, strict=True))
    return result
