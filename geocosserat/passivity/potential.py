"""The potential of a wrench, as a sum of functions like those in the wrench; the sum is fitted, then proved or dropped.

Candidates are products of the coordinates and of functions that occur in the wrench, or that have derivatives like
them. Their coefficients solve linear equations at random configurations: in floats to see which are needed, in balls to
find the rational numbers that they are. What was found is differentiated along the group's fields: that decides.
"""

from __future__ import annotations

import random
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations_with_replacement
from typing import Any, Final, TypeAlias

import numpy as np
import sympy as sp
from flint import arb, fmpq

from geocosserat.algebra.groups import Group
from geocosserat.passivity.balls import precision
from geocosserat.passivity.configuration import along_fields, cayley, field_rates, free, pose
from geocosserat.passivity.fit import BITS, rational_solution
from geocosserat.passivity.points import enclosure
from geocosserat.passivity.regular import degree, symbols_of
from geocosserat.passivity.vanish import Answer, vanishes

_MOST: Final = 260
_MOST_DEGREE: Final = 6

Monomial: TypeAlias = tuple[int, ...]
"""Indices of generators, with repetition."""


@dataclass(frozen=True)
class Potential:
    """U with j = -X[U], and how that was verified: ``answer.value`` is True."""

    energy: sp.Expr
    answer: Answer


def residual(group: Group, wrench: Sequence[sp.Expr], energy: sp.Expr) -> list[sp.Expr]:
    """j_a + X_a[U], in unknowns that nothing binds."""
    return [free(group, j + slope) for j, slope in zip(wrench, along_fields(group, energy), strict=True)]


def potential(group: Group, wrench: Sequence[sp.Expr], positive: Collection[str]) -> Potential | None:
    """A potential of a closed wrench in closed form, verified; None if none is found."""
    fit = _Fit(group, wrench, positive)
    for level in (1, 2, 3):
        energy = fit.level(level)
        if energy is None:
            continue
        answer = vanishes(residual(group, wrench, energy), positive)
        if answer.value is True:
            return Potential(energy, answer)
    return None


class _Fit:
    """``generators``: what candidates are products of. ``multipliers``: functions of parameters before them."""

    def __init__(self, group: Group, wrench: Sequence[sp.Expr], positive: Collection[str]) -> None:
        self.group, self.positive = group, positive
        self.wrench = list(wrench)
        names = symbols_of(group)
        n = group.space
        forced = any(e != 0 for e in wrench[:n])
        turned = any(e != 0 for e in wrench[n:])
        used = {x for e in wrench for x in e.free_symbols}
        self.place = list(names[:n]) if forced else []
        self.frame = _turning(group, used) if turned else []
        inside = {*self.place, *self.frame}
        parts = {p for e in wrench for p in e.atoms(sp.Function, sp.Pow)}
        atoms = sorted((p for p in parts if _special(p, set(names))), key=sp.default_sort_key)
        self.degree = min(_MOST_DEGREE, max((degree(e) for e in wrench), default=0))
        family = dict.fromkeys(f for p in atoms for f in _family(p))
        self.functions = [f for f in family if (f.free_symbols & set(names)) <= inside]
        self.generators = [*self.place, *self.frame, *self.functions]
        self.multipliers = list(_multipliers(self.wrench, names, self.functions))
        self.slopes = [along_fields(group, g) for g in self.generators]
        everything = (*wrench, *self.generators, *self.multipliers)
        self.symbols = sorted({x for e in everything for x in e.free_symbols}, key=str)

    def monomials(self, level: int) -> list[Monomial]:
        p, q, f = len(self.place), len(self.frame), len(self.functions)
        place, frame, functions = range(p), range(p, p + q), range(p + q, p + q + f)
        found: dict[Monomial, None] = {}

        def add(which: Iterable[int], most: int, times: Sequence[int] = ()) -> None:
            for k in range(1 if not times else 0, most + 1):
                for m in combinations_with_replacement(tuple(which), k):
                    found[tuple(sorted((*m, *times)))] = None

        add(functions, 1)
        add(place, min(self.degree + 1, 4))
        add(frame, max(1, min(self.degree, 2)))
        if level >= 2:
            add(functions, 2)
            for g in functions:
                add((*place, *frame), 2 if p + q < 8 else 1, (g,))
            add((*place, *frame), 2)
        if level >= 3:
            add((*functions, *place, *frame), self.degree + 1 if len(self.generators) < 9 else min(self.degree + 1, 3))
        return sorted(found, key=len)

    def level(self, level: int) -> sp.Expr | None:
        """The sum of candidates of that level that fits, not yet verified."""
        monomials = self.monomials(level)[: _MOST // max(1, len(self.multipliers))]
        basis = [(q, m) for m in monomials for q in range(len(self.multipliers))]
        if not basis:
            return None
        with precision(BITS):
            d = self.group.dimension
            rows, right = [], []
            needed = 2 * len(basis) // d + 8
            for wrench, generators, slopes, multipliers in self._points():
                numbers = [[_slope(m, generators, slope) for m in monomials] for slope in slopes]
                rows += [[multipliers[q] * x for x in row for q in range(len(multipliers))] for row in numbers]
                right += [-j for j in wrench]
                if len(rows) >= needed * d:
                    break
            else:
                return None
            coefficients = rational_solution(rows, right)
        if coefficients is None:
            return None
        terms = []
        for c, (q, m) in zip(coefficients, basis, strict=True):
            if c:
                product = sp.Mul(*(self.generators[i] for i in m))
                terms.append(sp.Rational(c.numerator, c.denominator) * self.multipliers[q] * product)
        return sp.Add(*terms)

    def _points(self) -> Iterator[tuple[list[arb], list[arb], list[list[arb]], list[arb]]]:
        chance = random.Random(1)
        frame: Any = self.group.rotation(pose(self.group)) if self.group.rotations == 3 else None
        for attempt in range(600):
            width = (Fraction(1), Fraction(1, 3), Fraction(3))[attempt % 3]
            values: dict[str, arb] = {}
            for x in self.symbols:
                step = Fraction(chance.randrange(-96, 97), 97) or Fraction(1, 5)
                values[x.name] = _ball(1 + width * abs(step) if x.name in self.positive else width * step)
            if frame is not None:
                rotation: Any = cayley(self.group, [Fraction(chance.randrange(-20, 21), 13) for _ in range(3)])
                values |= {frame[i].name: _ball(Fraction(rotation[i])) for i in np.ndindex(3, 3)}
            seen: dict[sp.Expr, arb] = {}
            wrench = [enclosure(e, values, seen) for e in self.wrench]
            generators = [enclosure(e, values, seen) for e in self.generators]
            slopes = [
                [enclosure(self.slopes[g][a], values, seen) for g in range(len(self.generators))]
                for a in range(self.group.dimension)
            ]
            multipliers = [enclosure(e, values, seen) for e in self.multipliers]
            if all(x.is_finite() for x in (*wrench, *generators, *multipliers, *(y for row in slopes for y in row))):
                yield wrench, generators, slopes, multipliers


def _turning(group: Group, used: set[sp.Symbol]) -> list[sp.Symbol]:
    """Of the frame, what occurs and what that turns into; the angle of the plane always."""
    names = symbols_of(group)[group.space :]
    if group.rotations == 1:
        return list(names)
    turned = {x for rates in field_rates(group) for y in used & set(rates) for x in rates[y].free_symbols}
    return [x for x in names if x in used | turned]


def _ball(x: Fraction) -> arb:
    return arb(fmpq(x.numerator, x.denominator))


def _slope(monomial: Monomial, values: Sequence[arb], slopes: Sequence[arb]) -> arb:
    """Of a product, by the rule of products."""
    total = arb(0)
    for k, g in enumerate(monomial):
        term = slopes[g]
        if term.is_zero():
            continue
        for other in (*monomial[:k], *monomial[k + 1 :]):
            term = term * values[other]
        total = total + term
    return total


def _special(p: sp.Expr, pose_symbols: set[sp.Symbol]) -> bool:
    if not p.free_symbols & pose_symbols:
        return False
    return bool(p.is_Function or not (p.exp.is_Integer and p.exp > 0))


def _family(p: sp.Expr) -> list[sp.Expr]:
    """Functions whose derivatives hold ``p``, or that ``p`` comes from."""
    a = p.args[0]
    match p.func:
        case sp.exp:
            return [p]
        case sp.sin | sp.cos:
            return [sp.sin(a), sp.cos(a)]
        case sp.sinh | sp.cosh:
            return [sp.sinh(a), sp.cosh(a)]
        case sp.tanh:
            return [sp.log(sp.cosh(a)), p]
        case sp.tan:
            return [sp.log(sp.Abs(sp.cos(a))), p]
        case sp.log:
            return [p]
        case sp.Heaviside | sp.Abs | sp.sign:
            return list(dict.fromkeys([p, sp.Abs(a)]))
        case sp.Pow:
            base, power = p.args
            raised = sp.log(sp.Abs(base)) if power == -1 else base ** (power + 1)
            return [*([] if raised.is_polynomial() else [raised]), *_arctangent(base, power), p]
    return [p]


def _arctangent(base: sp.Expr, power: sp.Expr) -> list[sp.Expr]:
    """Of one over a quadratic without real roots."""
    if power != -1 or len(base.free_symbols) != 1 or not base.is_polynomial():
        return []
    (x,) = base.free_symbols
    polynomial = sp.Poly(base, x)
    if polynomial.degree() != 2:
        return []
    a, b, c = polynomial.all_coeffs()
    root = 4 * a * c - b * b
    return [sp.atan((2 * a * x + b) / sp.sqrt(root)) / sp.sqrt(root)] if root.is_positive else []


def _multipliers(
    wrench: Sequence[sp.Expr], names: Sequence[sp.Symbol], functions: Sequence[sp.Expr]
) -> Iterator[sp.Expr]:
    """Functions of parameters that stand before terms of the wrench, and over slopes of arguments."""
    before = {_without_number(_outside(term, names)) for e in wrench for term in _terms(e)}
    below = {sp.S.One}
    for f in functions:
        inner = f.args[0]
        for x in inner.free_symbols & set(names):
            below |= {_without_number(_outside(term, names)) for term in _terms(inner.diff(x))}
    seen = set[sp.Expr]()
    for q in sorted(before - {sp.S.Zero}, key=sp.default_sort_key):
        for c in sorted(below - {sp.S.Zero}, key=sp.default_sort_key):
            if (m := q / c) not in seen and m.is_finite is not False:
                seen.add(m)
                yield m


def _terms(e: sp.Expr) -> tuple[sp.Expr, ...]:
    terms: tuple[sp.Expr, ...] = sp.Add.make_args(sp.expand(e) if degree(e) <= 2 * _MOST_DEGREE else e)
    return terms


def _outside(term: sp.Expr, names: Sequence[sp.Symbol]) -> sp.Expr:
    return term.as_independent(*names, as_Add=False)[0]


def _without_number(e: sp.Expr) -> sp.Expr:
    return e.as_coeff_Mul(rational=True)[1] if e != 0 else e
