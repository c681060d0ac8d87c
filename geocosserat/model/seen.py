"""The world as a point of the rod sees it: symbols of its frame and place, and the vectors made of them.

The names hold a dot, so that no parameter of a scene can be one of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from geocosserat.model.tree import Expression, Number, Symbol

Vector: TypeAlias = tuple[Expression, ...]
AXES = ("x", "y", "z")


@dataclass(frozen=True, slots=True)
class Seen:
    """axes: R by rows, R[world][body], its columns the frame e_1, e_2(, e_3). position: in the world, a length."""

    axes: tuple[Vector, ...]
    position: Vector

    @property
    def space(self) -> int:
        """2 or 3."""
        return len(self.position)

    def to_body(self, vector: Sequence[Expression]) -> Vector:
        """Components in the moving frame of a vector given in the world, R^T vector."""
        return tuple(total(row[i] * x for row, x in zip(self.axes, vector, strict=True)) for i in range(self.space))

    def to_world(self, vector: Sequence[Expression]) -> Vector:
        """Components in the world of a vector given in the moving frame, R vector."""
        return tuple(dot(row, vector) for row in self.axes)


def total(terms: object) -> Expression:
    """The sum; nothing is zero."""
    result: Expression = Number(0.0)
    for term in terms:  # type: ignore[attr-defined]
        result = result + term
    return result


def dot(a: Sequence[Expression], b: Sequence[Expression]) -> Expression:
    """The scalar product."""
    return total(x * y for x, y in zip(a, b, strict=True))


def cross(a: Sequence[Expression], b: Sequence[Expression]) -> Vector:
    """The vector product; of vectors of the plane its one component."""
    if len(a) == 2:
        return (a[0] * b[1] - a[1] * b[0],)
    return tuple(a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3] for i in range(3))


def seen(space: int) -> Seen:
    """The symbols: ``frame.cos`` and ``frame.sin`` of the angle, or ``frame.1x``, ..., ``frame.3z``; ``place.x``, ..."""
    position = tuple(Symbol(f"place.{axis}") for axis in AXES[:space])
    if space == 2:
        c, s = Symbol("frame.cos"), Symbol("frame.sin")
        return Seen(((c, -s), (s, c)), position)
    return Seen(tuple(tuple(Symbol(f"frame.{i}{axis}") for i in (1, 2, 3)) for axis in AXES), position)
