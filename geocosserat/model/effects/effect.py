"""What an effect is: a density of wrench along the rod, written once for all of derivation, kernels and tests."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import ClassVar, Literal, TypeAlias, TypeVar

from geocosserat.model.seen import Seen, Vector
from geocosserat.model.tree import Expression, Number

Needs: TypeAlias = Literal["nothing", "direction", "pose"]
Shape: TypeAlias = Literal["scalar", "world", "body", "moment", "matrix"]
E = TypeVar("E", bound="type[Effect]")


@dataclass(frozen=True, slots=True)
class Key:
    """How a value of an effect is written in a scene.

    ``shape``: one number; a vector in the world or in the body; a moment (a number in the plane, three in space); a
    matrix in the world, as rows. ``varies``: which of ``u`` and ``t`` its expressions may use.
    """

    shape: Shape
    varies: str = "ut"


class Effect:
    """A kind of effect: subclass it as a frozen dataclass, one field a key, each a tuple of expressions.

    ``kind``: its name in scenes. ``keys``: how each value is written. ``needs``: what of the rod's pose its formulas
    use; nothing, directions of the world, or its place too.

    Formulas are written with + - * / ** of expressions; they are made into symbols, kernels and their derivatives.
    """

    kind: ClassVar[str]
    keys: ClassVar[dict[str, Key]]
    needs: ClassVar[Needs] = "nothing"

    def wrench(self, seen: Seen) -> tuple[Vector, Vector]:
        """Force density (force / length) and moment density (force), both in components of the moving frame."""
        return nothing(seen.space), nothing(rotations(seen.space))

    def medium(self, seen: Seen) -> tuple[Vector, Vector]:
        """Velocity (length / time) and spin (1 / time) of the medium that drags, in components of the moving frame."""
        return nothing(seen.space), nothing(rotations(seen.space))

    def potential(self, seen: Seen) -> Expression | None:
        """Energy density (force) whose loss is the work of the wrench; None if there is none."""
        return None

    def values(self) -> dict[str, Vector]:
        """The value of each key, matrices by rows one after the other."""
        assert is_dataclass(self)
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def renamed(self, name: Callable[[str, int, Expression], Expression]) -> Effect:
        """The same effect with each expression replaced: name(key, position, expression)."""
        new = {key: tuple(name(key, i, e) for i, e in enumerate(vector)) for key, vector in self.values().items()}
        return replace(self, **new)  # type: ignore[type-var]


def nothing(count: int) -> Vector:
    """So many zeros."""
    return (Number(0.0),) * count


def rotations(space: int) -> int:
    """How many ways there are to turn."""
    return 1 if space == 2 else 3


_KINDS: dict[str, type[Effect]] = {}


def register(effect: E) -> E:
    """Makes a kind of effect known to scenes; to be used as a decorator.

    Raises TypeError if its fields are not its keys, ValueError if another effect has that kind.
    """
    names = tuple(field.name for field in fields(effect)) if is_dataclass(effect) else ()
    if names != tuple(effect.keys):
        raise TypeError(
            f"{effect.__name__}: expected a dataclass whose fields are its keys {', '.join(effect.keys)}, "
            f"found {', '.join(names) or 'none'}; write one field for each key, in that order"
        )
    known = _KINDS.get(effect.kind)
    if known is not None and known.__qualname__ != effect.__qualname__:
        raise ValueError(f"{effect.kind}: expected a kind of its own, found that of {known.__name__}; rename it")
    _KINDS[effect.kind] = effect
    return effect


def kinds() -> tuple[str, ...]:
    """Every known kind."""
    return tuple(_KINDS)


def kind(name: str) -> type[Effect]:
    """The effect of that kind."""
    return _KINDS[name]


def together(vectors: Iterable[Vector], size: int) -> Vector:
    """The sum of vectors of so many components."""
    result = nothing(size)
    for vector in vectors:
        result = tuple(a + b for a, b in zip(result, vector, strict=True))
    return result
