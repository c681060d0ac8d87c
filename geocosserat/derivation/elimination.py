"""Eliminating fields from a system of equations, as far as that is possible in closed form."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Final

import sympy as sp

from geocosserat.derivation.distribute import distributed, terms
from geocosserat.derivation.notation import U, has_fields, is_field
from geocosserat.derivation.records import Equation, Vector

_LARGEST_BLOCK: Final = 3


@dataclass(frozen=True)
class Row:
    """One equation of a system. ``origin``: what it says. ``partner``: the field that it is naturally about."""

    origin: str
    equation: Equation
    partner: sp.Expr


@dataclass(frozen=True)
class Solved:
    """A field given by others: ``equation``, field = value; ``origin``: the row that gave it."""

    equation: Equation
    origin: str


@dataclass(frozen=True)
class System:
    """Equations for unknown fields, and the fields that have been eliminated, by those that are left.

    ``stretch``: positive, so that one may divide by it. ``divided``: whether that was done.
    """

    rows: tuple[Row, ...]
    unknowns: Vector
    stretch: sp.Expr
    solved: tuple[Solved, ...] = ()
    divided: bool = False

    @property
    def values(self) -> dict[sp.Expr, sp.Expr]:
        """The value of every eliminated field."""
        return {s.equation.left: s.equation.right for s in self.solved}

    def row(self, origin: str) -> Row | None:
        """The row of that origin, None if it has been used."""
        return next((row for row in self.rows if row.origin == origin), None)

    def solve(self, row: Row, candidates: Iterable[sp.Expr]) -> System:
        """The system after that row has given the first of the candidates that it gives in closed form.

        The candidate must occur in the row linearly, not differentiated, and with a coefficient that is not zero; and
        what it is equal to must be differentiable where it is differentiated. The same system if there is none.
        """
        for unknown in (c for c in candidates if c in self.unknowns):
            coefficient, rest = _parted(row.equation, unknown)
            if coefficient == 0 or not (coefficient.is_number or self._positive(coefficient)):
                continue
            value = distributed(-rest / coefficient)
            if not self._would_break([unknown], [value]):
                return self._without([row], {unknown: value}, row.origin, has_fields(coefficient))
        return self

    def solve_friction(self, rows: Mapping[sp.Expr, Row], friction: Callable[[sp.Expr, sp.Expr], sp.Expr]) -> System:
        """The system after balances have given their velocities, wherever friction couples few enough of them.

        ``rows``: the balance of each velocity. ``friction``: the coefficient of two of these.
        """
        system = self
        for block in coupled(tuple(rows), friction):
            inverse = inverted(sp.Matrix([[friction(a, b) for b in block] for a in block]))
            if inverse is None:
                continue
            # what the left-hand sides hold besides these velocities goes to the right
            apart = dict.fromkeys(block, sp.S.Zero)
            pushes = sp.Matrix([e.right - put_in(e.left, apart) for e in (rows[v].equation for v in block)])
            values = dict(zip(block, (distributed(x) for x in inverse * pushes), strict=True))
            if not system._would_break(values, values.values()):
                system = system._without([rows[v] for v in block], values, "friction")
        return system

    def replaced(self, values: Mapping[sp.Expr, sp.Expr], drop: Iterable[str], add: Vector, origin: str) -> System:
        """The system with those values put in, without the rows named, with those unknowns before the rest."""
        dropped = [row for row in self.rows if row.origin in set(drop)]
        others = tuple(f for f in self._left(values) if f not in add)
        return replace(self._without(dropped, values, origin), unknowns=add + others)

    def _without(
        self,
        used: Iterable[Row],
        values: Mapping[sp.Expr, sp.Expr],
        origin: str,
        divided: bool = False,
    ) -> System:
        gone = {row.origin for row in used}
        rows = tuple(
            replace(row, equation=_put_in_equation(row.equation, values)) for row in self.rows if row.origin not in gone
        )
        before = tuple(replace(s, equation=_put_in_equation(s.equation, values)) for s in self.solved)
        new = tuple(Solved(Equation(f, value), origin) for f, value in values.items())
        return replace(
            self, rows=rows, unknowns=self._left(values), solved=before + new, divided=self.divided or divided
        )

    def _positive(self, coefficient: sp.Expr) -> bool:
        return bool(self.stretch != 0 and (coefficient / self.stretch).is_number)

    def _left(self, values: Mapping[sp.Expr, sp.Expr]) -> Vector:
        return tuple(f for f in self.unknowns if f not in values)

    def _would_break(self, fields: Iterable[sp.Expr], values: Iterable[sp.Expr]) -> bool:
        """Whether a value with a step along the rod would be differentiated there, in a row or in another value."""
        if not any(U in step.free_symbols for value in values for step in value.atoms(sp.Heaviside)):
            return False
        kept = (*(row.equation for row in self.rows), *(s.equation for s in self.solved))
        sides = (side for equation in kept for side in (equation.left, equation.right))
        slopes = {d for side in sides for d in side.atoms(sp.Derivative) if U in d.variables}
        return any(d.expr in fields for d in slopes)


def put_in(e: sp.Expr, values: Mapping[sp.Expr, sp.Expr]) -> sp.Expr:
    """e with values for fields, in their derivatives too."""
    jets = {
        d: values[d.expr].diff(*d.variable_count) for d in e.atoms(sp.Derivative) if is_field(d) and d.expr in values
    }
    return e.xreplace({**values, **jets})


def occur(e: sp.Expr) -> frozenset[sp.Expr]:
    """The fields that occur in an expression, differentiated or not."""
    return frozenset(f for f in e.atoms(sp.Function) if is_field(f))


def inverted(matrix: sp.Matrix) -> sp.Matrix | None:
    """The inverse of a regular matrix, None where it would be too long to be read."""
    if matrix.rows > _LARGEST_BLOCK:
        return matrix.inv() if all(e.is_Rational for e in matrix) else None
    return matrix.inv(method="ADJ")


def _put_in_equation(equation: Equation, values: Mapping[sp.Expr, sp.Expr]) -> Equation:
    if not (occur(equation.left) | occur(equation.right)).intersection(values):
        return equation
    return Equation(*(distributed(put_in(side, values)) for side in (equation.left, equation.right)))


def _parted(equation: Equation, unknown: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """The coefficient of the unknown in the residual, and the rest; zero if it is not just a linear term."""
    coefficient, rest = sp.S.Zero, sp.S.Zero
    for product, c in terms(equation.residual).items():
        if not product.has(unknown):
            rest += c * product
            continue
        factor = product / unknown
        if factor.has(unknown):
            return sp.S.Zero, rest
        coefficient += c * factor
    return coefficient, rest


def coupled(fields: Vector, coefficient: Callable[[sp.Expr, sp.Expr], sp.Expr]) -> list[Vector]:
    """The fields in groups that the coefficients couple, each in the given order."""
    groups: list[list[sp.Expr]] = []
    for f in fields:
        touching = [g for g in groups if any(coefficient(f, x) != 0 or coefficient(x, f) != 0 for x in g)]
        groups = [g for g in groups if g not in touching] + [[*(x for g in touching for x in g), f]]
    return [tuple(f for f in fields if f in g) for g in groups]
