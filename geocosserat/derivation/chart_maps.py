"""From a chart to its maps: slopes of coordinates to turn, twist to rates of coordinates, derived from R^T dR.

The products are brought to a readable form by division of polynomials: sines, cosines, the size of the
coordinates and reciprocals are unknowns in which sin² + cos² = 1 and the definitions of the others hold.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyRing

from geocosserat.algebra.groups import Array
from geocosserat.derivation.charts import Chart

Poly = Any
"""An element of sympy's ring of sparse polynomials."""


@dataclass(frozen=True)
class ChartMaps:
    """What R = R(q) implies for n coordinates q; entries are functions of q and of the chart's abbreviations.

    ``rotation``: R itself in these words, object array (space, space). ``turning``: object array (rotations, n),
    rotational turn = turning q' and rotational twist = turning dq/dt (dimensionless, as q is). ``rates``: its
    inverse where the constraints hold, object array (n, rotations), dq/dt = rates twist. ``determinant``: of
    ``turning`` with the slope of the constraint, if there is one, as a last row; None for the chart of matrices.
    """

    rotation: Array
    turning: Array
    rates: Array
    determinant: sp.Expr | None


@lru_cache(maxsize=16)
def maps(chart: Chart) -> ChartMaps:
    """The maps of a chart, from nothing but its rotation matrix: the vee of R^T dR/dq_j is column j of ``turning``.

    Takes a fraction of a second, once.
    """
    reduction = _Reduction(chart)
    square = [[reduction.reduced(e) for e in row] for row in _turning(chart, reduction)]
    rotation = _written(chart.rotation, reduction)
    turning = _written(square, reduction)
    if chart.coordinates == tuple(chart.rotation.T.ravel()):
        return ChartMaps(rotation, turning, _matrix_rates(chart), None)
    # what moves along a constraint turns nothing: one row more, of zeros on the left
    square += [[reduction.reduced(e.left.diff(q) / 2) for q in chart.coordinates] for e in chart.constraints]
    determinant = reduction.reduced(_determinant(square))
    inverse = reduction.reciprocal(determinant)
    rates = [
        [_cofactor(square, i, j) * inverse for i in range(chart.group.rotations)] for j in range(len(chart.coordinates))
    ]
    return ChartMaps(rotation, turning, _written(rates, reduction), reduction.written(determinant))


def _turning(chart: Chart, reduction: _Reduction) -> Array:
    group = chart.group
    R = np.array([[reduction.reduced(e) for e in row] for row in chart.rotation], dtype=object)
    columns = []
    for q in chart.coordinates:
        tangent = np.zeros((group.size, group.size), dtype=object)
        tangent[1:, 1:] = R.T @ np.array([[reduction.slope(p, q) for p in row] for row in R], dtype=object)
        columns.append(group.vee(tangent)[group.translations :])
    return np.array(columns, dtype=object).T


def _matrix_rates(chart: Chart) -> Array:
    """Where the entries of R are the coordinates, dR/dt = R hat(twist) are their rates."""
    group = chart.group
    columns = []
    for k in range(group.rotations):
        twist = np.zeros(group.dimension, dtype=object)
        twist[group.translations + k] = 1
        columns.append((chart.rotation @ group.rotation(group.hat(twist))).T.ravel())
    return np.array(columns, dtype=object).T


class _Reduction:
    """The ring of a chart, and the rules that hold in it.

    There is one ring for each square of a coordinate that the size of the coordinates can eliminate: of the
    equal forms that they give, the shortest is written.
    """

    def __init__(self, chart: Chart) -> None:
        self._size = chart.size
        self._lengths = chart.size.left.atoms(AppliedUndef) if chart.size else set()
        self._reciprocals = dict(chart.reciprocals)
        vanishing = [e**2 + sp.cos(*e.args) ** 2 - 1 for e in chart.unknowns if isinstance(e, sp.sin)]
        vanishing += [value * reciprocal - 1 for value, reciprocal in self._reciprocals.items()]
        orders = [chart.unknowns]
        if chart.size:
            vanishing.append(chart.size.right - chart.size.left)
            orders = _orders(chart.unknowns, chart.coordinates)
        self._rings = [PolyRing(order, sp.QQ, lex) for order in orders]
        self._rules = [[ring.from_expr(e) for e in vanishing] for ring in self._rings]
        self._names = [[ring.from_expr(e) for e in chart.names] for ring in self._rings]
        fixed = {e.left: e.right for e in chart.constraints if self._size and e.left == self._size.right}
        self._gradients: dict[tuple[sp.Expr, sp.Expr], Poly] = {}
        self._constants = {f: value for f in self._lengths for value in fixed.values()}

    def slope(self, p: Poly, q: sp.Expr) -> Poly:
        """The derivative by a coordinate, by the chain rule through the unknowns that depend on it."""
        total = self._rings[0].zero
        for x, unknown in zip(p.ring.gens, p.ring.symbols, strict=True):
            partial = p.diff(x)
            if partial:
                total += partial * self._gradient(unknown, q)
        return self.reduced(total)

    def _gradient(self, unknown: sp.Expr, q: sp.Expr) -> Poly:
        if (unknown, q) not in self._gradients:
            self._gradients[unknown, q] = self._new_gradient(unknown, q)
        return self._gradients[unknown, q]

    def _new_gradient(self, unknown: sp.Expr, q: sp.Expr) -> Poly:
        if unknown == q:
            return self._rings[0].one
        if isinstance(unknown, sp.sin | sp.cos):
            (angle,) = unknown.args
            return self._element(unknown.diff(angle)) * self._gradient(angle, q)
        if self._size and unknown in self._lengths:
            per = self.reciprocal(self._element(self._size.left.diff(unknown)))
            return self._element(self._size.right.diff(q)) * per
        for value, reciprocal in self._reciprocals.items():
            if unknown == reciprocal:
                return -(self._element(unknown) ** 2) * self.slope(self._element(value), q)
        return self._rings[0].zero

    def reduced(self, e: sp.Expr | Poly) -> Poly:
        """The expression or polynomial in the first ring, in its normal form there."""
        return self._element(e).rem(self._rules[0])

    def reciprocal(self, p: Poly) -> Poly:
        """One over a product of the expressions whose reciprocals are known, and of a number."""
        out = self._rings[0].one
        pairs = [(self._element(x), self._element(y)) for x, y in self._reciprocals.items()]
        factors = [pair for x, y in pairs for pair in ((x, y), (y, x))]
        while not p.is_ground:
            for factor, reciprocal in factors:
                quotient, remainder = divmod(p, factor)
                if not remainder:
                    p, out = quotient, self.reduced(out * reciprocal)
                    break
            else:
                raise AssertionError(f"the reciprocal of {p.as_expr()} is not known")
        return out.quo_ground(p.coeff(1))

    def written(self, e: sp.Expr | Poly) -> sp.Expr:
        """As an expression with the abbreviations of the chart, as short as may be."""
        p = self._element(e)
        forms = []
        for ring, rules, names in zip(self._rings, self._rules, self._names, strict=True):
            form = p.set_ring(ring).rem(rules).rem(names).rem(rules).as_expr()
            forms += [form, sp.factor_terms(form)]
        best = min(forms, key=lambda x: (x.has(*self._lengths), sp.count_ops(x)))
        values = {reciprocal: 1 / value for value, reciprocal in self._reciprocals.items()}
        return best.xreplace(values).xreplace(self._constants)

    def _element(self, e: sp.Expr | Poly) -> Poly:
        if not isinstance(e, int | sp.Basic):
            return e
        # no ring has negative powers: one over a field is an unknown of its own
        known = self._reciprocals
        e = sp.S(e).replace(
            lambda x: x.is_Pow and x.exp.is_Integer and x.exp < 0 and x.base in known,
            lambda x: known[x.base] ** -x.exp,
        )
        return self._rings[0].from_expr(e)


def _orders(unknowns: Sequence[sp.Expr], coordinates: Sequence[sp.Expr]) -> list[tuple[sp.Expr, ...]]:
    """The unknowns with each of the coordinates first among these."""
    start = list(unknowns).index(coordinates[0])
    before, after = unknowns[:start], unknowns[start + len(coordinates) :]
    return [(*before, q, *(other for other in coordinates if other != q), *after) for q in coordinates]


def _written(matrix: Iterable[Iterable[sp.Expr | Poly]], reduction: _Reduction) -> Array:
    return np.array([[reduction.written(e) for e in row] for row in matrix], dtype=object)


def _determinant(matrix: Sequence[Sequence[Poly]]) -> Poly:
    """By the first row."""
    if len(matrix) == 1:
        return matrix[0][0]
    return sum(e * _cofactor(matrix, 0, j) for j, e in enumerate(matrix[0]))


def _cofactor(matrix: Sequence[Sequence[Poly]], i: int, j: int) -> Poly:
    minor = [[*row[:j], *row[j + 1 :]] for k, row in enumerate(matrix) if k != i]
    return (-1) ** (i + j) * _determinant(minor) if minor else matrix[0][0] ** 0
