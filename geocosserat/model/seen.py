"""The world as a point of the rod sees it: symbols of its frame and place, and the vectors made of them.

The names hold a dot, so that no parameter of a scene can be one of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from geocosserat.model.expressions import Expression, Number, Symbol, derivative
from geocosserat.model.tree import as_expression

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

    @property
    def rotations(self) -> int:
        """How many ways there are to turn: 1 or 3."""
        return rotations(self.space)

    def to_body(self, vector: Sequence[Expression | float]) -> Vector:
        """Components in the moving frame of a vector given in the world, R^T vector."""
        return tuple(dot([row[i] for row in self.axes], vector) for i in range(self.space))

    def to_world(self, vector: Sequence[Expression | float]) -> Vector:
        """Components in the world of a vector given in the moving frame, R vector."""
        return tuple(dot(row, vector) for row in self.axes)

    def slopes(self, e: Expression) -> tuple[Vector, Vector]:
        """How ``e`` changes as the point moves along each axis of its frame (per length), and turns about each.

        For the symbols of ``seen`` only.
        """
        n = self.space
        along = tuple(total(self.axes[w][i] * self._slope(e, self.position[w]) for w in range(n)) for i in range(n))
        if n == 2:
            c, s = self.axes[0][0], self.axes[1][0]
            return along, (c * self._slope(e, s) - s * self._slope(e, c),)
        # turning about e_k, e_i moves towards e_j and e_j against e_i
        about = tuple(
            total(row[j] * self._slope(e, row[i]) - row[i] * self._slope(e, row[j]) for row in self.axes)
            for i, j in ((1, 2), (2, 0), (0, 1))
        )
        return along, about

    @staticmethod
    def _slope(e: Expression, variable: Expression) -> Expression:
        if not isinstance(variable, Symbol):
            raise TypeError(f"expected the symbols of a pose, found {variable}; use seen(2) or seen(3)")
        return derivative(e, variable.name)


def seen(space: int) -> Seen:
    """The symbols in the plane (2) or in space (3).

    ``frame.cos`` and ``frame.sin`` of the angle, or ``frame.1x``, ..., ``frame.3z``; ``place.x``, ...
    """
    position = tuple(Symbol(f"place.{axis}") for axis in AXES[:space])
    if space == 2:
        c, s = Symbol("frame.cos"), Symbol("frame.sin")
        return Seen(((c, -s), (s, c)), position)
    return Seen(tuple(tuple(Symbol(f"frame.{i}{axis}") for i in (1, 2, 3)) for axis in AXES), position)


def rotations(space: int) -> int:
    """How many ways there are to turn: 1 in the plane, 3 in space."""
    return 1 if space == 2 else 3


def nothing(count: int) -> Vector:
    """So many zeros."""
    return (Number(0.0),) * count


def total(terms: Iterable[Expression | float]) -> Expression:
    """The sum; nothing is zero."""
    result: Expression = Number(0.0)
    for term in terms:
        result = result + term
    return result


def dot(a: Sequence[Expression | float], b: Sequence[Expression | float]) -> Expression:
    """The scalar product."""
    return total(x * y for x, y in zip(a, b, strict=True))


def cross(a: Sequence[Expression | float], b: Sequence[Expression | float]) -> Vector:
    """The vector product; of vectors of the plane its one component."""
    p, q = [as_expression(x) for x in a], [as_expression(x) for x in b]
    planes = ((0, 1),) if len(p) == 2 else ((1, 2), (2, 0), (0, 1))
    return tuple(p[i] * q[j] - p[j] * q[i] for i, j in planes)
