"""Linear operators along the rod, y -> c_0 y + c_1 y' + c_2 y'' + ..., with matrices for coefficients."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import Array
from geocosserat.derivation.notation import T, U
from geocosserat.derivation.records import Equation, Equations, Vector


@dataclass(frozen=True)
class Operator:
    """``coefficients``: of y, y', y'' and so on, each (rows, n) for n fields y, in fields of the base."""

    coefficients: tuple[Array, ...]

    # numpy then leaves matrix @ operator to the operator
    __array_ufunc__ = None

    def __add__(self, other: Operator) -> Operator:
        return Operator(tuple(a + b for a, b in self._beside(other)))

    def __sub__(self, other: Operator) -> Operator:
        return Operator(tuple(a - b for a, b in self._beside(other)))

    def __rmatmul__(self, matrix: Array) -> Operator:
        return Operator(tuple(matrix @ c for c in self.coefficients))

    def slope(self) -> Operator:
        """The derivative along the rod of what it gives: (c y)' = c' y + c y'."""
        changing = Operator(tuple(each(slope, c) for c in self.coefficients))
        return changing + Operator((self._nothing, *self.coefficients))

    def above(self, other: Operator) -> Operator:
        """Its rows, and below them those of another on the same fields."""
        return Operator(tuple(np.vstack([a, b]) for a, b in self._beside(other)))

    def rows(self, kept: Sequence[int]) -> Operator:
        """Only those rows."""
        return Operator(tuple(c[list(kept)] for c in self.coefficients))

    def each(self, function: Callable[[sp.Expr], sp.Expr]) -> Operator:
        """With that function of each coefficient."""
        return Operator(tuple(each(function, c) for c in self.coefficients))

    def of(self, y: Vector) -> Vector:
        """What it gives for these fields, term by term."""
        jets = [(c, np.array([f.diff((U, k)) for f in y], dtype=object)) for k, c in enumerate(self.coefficients)]
        return tuple(sp.Add(*(e for c, x in jets for e in c[row] * x)) for row in range(len(self._nothing)))

    @property
    def _nothing(self) -> Array:
        return 0 * self.coefficients[0]

    def _beside(self, other: Operator) -> Iterator[tuple[Array, Array]]:
        """Coefficients of the same order, zeros where one of the two has none."""
        for a, b in zip_longest(self.coefficients, other.coefficients):
            yield self._nothing if a is None else a, other._nothing if b is None else b


@dataclass(frozen=True)
class LinearSystem:
    """``mass`` y_t = ``operator`` y for the fields y, ``unknowns``: diffusion, advection and reaction.

    A row without mass is a constraint or a balance, in force at every instant.
    """

    unknowns: Vector
    mass: Array
    operator: Operator

    @property
    def diffusion(self) -> Array:
        """The coefficient of y''."""
        return self._coefficient(2)

    @property
    def advection(self) -> Array:
        """The coefficient of y'."""
        return self._coefficient(1)

    @property
    def reaction(self) -> Array:
        """The coefficient of y."""
        return self._coefficient(0)

    @property
    def solved(self) -> bool:
        """Whether each row is the rate of its own field."""
        return bool(np.all(self.mass == identity(len(self.mass))))

    @property
    def rows(self) -> Equations:
        """Each row spelt out."""
        rates = np.array([f.diff(T) for f in self.unknowns], dtype=object)
        return tuple(Equation(a, b) for a, b in zip(self.mass @ rates, self.operator.of(self.unknowns), strict=True))

    def each(self, function: Callable[[sp.Expr], sp.Expr]) -> LinearSystem:
        """With that function of each coefficient."""
        return LinearSystem(self.unknowns, each(function, self.mass), self.operator.each(function))

    def _coefficient(self, order: int) -> Array:
        coefficients = self.operator.coefficients
        return coefficients[order] if order < len(coefficients) else 0 * self.mass


def identity(size: int) -> Array:
    """The unit matrix in sympy's whole numbers."""
    return np.array(sp.eye(size), dtype=object)


def each(function: Callable[[sp.Expr], sp.Expr], matrix: Array) -> Array:
    """That function of each entry that is not literally zero."""
    out = np.empty(matrix.shape, dtype=object)
    for index, e in np.ndenumerate(matrix):
        out[index] = function(e) if e != 0 else sp.S.Zero
    return out


def slope(e: sp.Expr) -> sp.Expr:
    """The derivative along the rod, between steps."""
    return slope_by(e, U)


def slope_by(e: sp.Expr, variable: sp.Expr) -> sp.Expr:
    """The derivative by a coordinate or a field, between steps."""
    return between_steps(e.diff(variable))


def between_steps(e: sp.Expr) -> sp.Expr:
    """e where nothing jumps: what the derivative of a step is at the step is no part of it."""
    return e.replace(sp.DiracDelta, lambda *_: sp.S.Zero)
