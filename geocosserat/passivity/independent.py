"""Vectors over the rationals, and which of them are independent."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, TypeAlias

Vector: TypeAlias = dict[Any, Fraction]
"""Coefficients that are not zero, by what they belong to."""


@dataclass
class Basis:
    """Independent vectors, in the order in which they were met."""

    vectors: list[Vector] = field(default_factory=list)

    def express(self, vector: Vector) -> list[tuple[int, Fraction]] | None:
        """(position, coefficient) of the vectors that this one is the sum of; None if it is independent of them."""
        rows = [(dict(v), {i: Fraction(1)}) for i, v in enumerate(self.vectors)]
        rest, combination = dict(vector), dict[int, Fraction]()
        # eliminate: each row loses the pivots of those before it
        done: list[tuple[Any, dict[Any, Fraction], dict[int, Fraction]]] = []
        for row, made_of in rows:
            for pivot, other, of in done:
                _subtract(row, other, made_of, of, pivot)
            pivot = next(iter(row))
            done.append((pivot, row, made_of))
        for pivot, other, of in done:
            _subtract(rest, other, combination, of, pivot)
        if rest:
            return None
        return [(i, -c) for i, c in sorted(combination.items()) if c]


def _subtract(
    row: dict[Any, Fraction],
    other: Mapping[Any, Fraction],
    made_of: dict[int, Fraction],
    of: Mapping[int, Fraction],
    pivot: Any,
) -> None:
    if not (factor := row.get(pivot, Fraction(0)) / other[pivot]):
        return
    for target, source in ((row, other), (made_of, of)):
        for key, value in source.items():
            target[key] = target.get(key, Fraction(0)) - factor * value
            if not target[key]:
                del target[key]
