"""How numbers, vectors and matrices of expressions are written for people."""

from __future__ import annotations

from collections.abc import Sequence

from geocosserat.model.expressions import Expression, Number, to_text


def number_text(value: float) -> str:
    """The shortest text that reads back as the same number; whole numbers without a point."""
    return repr(int(value)) if value == int(value) and abs(value) < 1e6 else repr(float(value))


def vector_text(vector: Sequence[Expression]) -> str:
    """The components in parentheses."""
    return f"({', '.join(to_text(e) for e in vector)})"


def named_text(vector: Sequence[Expression], names: Sequence[str]) -> str:
    """The components with their names: ``h1 = 1, h2 = 0, Pi = 0``."""
    return ", ".join(f"{name} = {to_text(e)}" for name, e in zip(names, vector, strict=True))


def matrix_text(matrix: Sequence[Sequence[Expression]], names: Sequence[str]) -> str:
    """A diagonal matrix as its named diagonal, any other as its rows."""
    if all(e == Number(0.0) for i, row in enumerate(matrix) for j, e in enumerate(row) if i != j):
        return named_text([row[i] for i, row in enumerate(matrix)], names)
    rows = "".join(f"\n    {name:<8} {vector_text(row)}" for name, row in zip(names, matrix, strict=True))
    return f"rows and columns {', '.join(names)}{rows}"
