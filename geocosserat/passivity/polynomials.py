"""Fractions of polynomials in unknowns that stand for functions and obey rules g**q = P."""

from __future__ import annotations

import time
from fractions import Fraction
from typing import Any, Final, TypeAlias

import sympy as sp
from flint import Ordering, fmpz_mpoly_ctx

from geocosserat.passivity.independent import Vector

Poly: TypeAlias = Any
Ratio: TypeAlias = tuple[Poly, Poly]
"""Numerator and denominator."""

_MOST_TERMS: Final = 2_000_000
_MOST_FACTORED: Final = 3000
MOST_POWER: Final = 200


class NoForm(Exception):
    """An expression has no normal form within the bounds, or is nowhere defined."""


def key_of(p: Poly) -> Any:
    """What polynomials are told apart by."""
    return tuple(sorted(p.to_dict().items()))


class Ring:
    """The unknowns, what they mean, and their rules, from the lowest to the highest.

    ``meaning``: of each unknown, as an expression. ``rules``: (index, q, P) for g**q = P. ``above_zero``: indices of
    unknowns that are. ``until``: the time of the monotonic clock at which NoForm is raised.
    """

    def __init__(self, size: int, until: float) -> None:
        self.ring = fmpz_mpoly_ctx.get([f"g{i}" for i in range(size)], Ordering.lex)
        self.size, self.until = size, until
        self.unknowns = self.ring.gens()
        self.meaning: list[sp.Expr] = []
        self.rules: list[tuple[int, int, Poly]] = []
        self.above_zero: set[int] = set()
        self.signs: dict[Any, int] = {}
        self._named: dict[Any, Poly] = {}
        self.one, self.zero = self.ring.constant(1), self.ring.constant(0)

    def new(self, meaning: sp.Expr, rule: tuple[int, Poly] | None = None, above_zero: bool = False) -> Poly:
        index = len(self.meaning)
        if index >= self.size:
            raise NoForm(f"more than {self.size} unknowns")
        self.meaning.append(meaning)
        if rule is not None:
            self.rules.append((index, *rule))
        if above_zero:
            self.above_zero.add(index)
        return self.unknowns[index]

    def constant(self, value: Fraction | int) -> Ratio:
        value = Fraction(value)
        return self.ring.constant(value.numerator), self.ring.constant(value.denominator)

    def times(self, a: Poly, b: Poly) -> Poly:
        if len(a) * len(b) > _MOST_TERMS or time.monotonic() > self.until:
            raise NoForm("too many terms")
        return a * b

    def reduced(self, p: Poly) -> Poly:
        """By the rules, the highest unknown first."""
        for index, q, replacement in reversed(self.rules):
            if p.degrees()[index] < q:
                continue
            parts: dict[int, dict[tuple[int, ...], Any]] = {}
            for monomial, coefficient in p.to_dict().items():
                times, rest = divmod(monomial[index], q)
                parts.setdefault(times, {})[(*monomial[:index], rest, *monomial[index + 1 :])] = coefficient
            p, power, at = self.zero, self.one, 0
            for times in sorted(parts):
                while at < times:
                    power, at = self.times(power, replacement), at + 1
                p += self.times(self.ring.from_dict(parts[times]), power)
        return p

    def ratio(self, top: Poly, bottom: Poly) -> Ratio:
        """Reduced and without common factors. Raises NoForm where the denominator is zero."""
        top, bottom = self.reduced(top), self.reduced(bottom)
        if bottom.is_zero():
            raise NoForm("a denominator vanishes identically")
        if top.is_zero():
            return self.zero, self.one
        if time.monotonic() > self.until:
            raise NoForm("time")
        common = top.gcd(bottom)
        if not common.is_one():
            top, bottom = top // common, bottom // common
        return (-top, -bottom) if bottom.leading_coefficient() < 0 else (top, bottom)

    def add(self, a: Ratio, b: Ratio) -> Ratio:
        if a[1] == b[1]:
            return self.ratio(a[0] + b[0], a[1])
        common = a[1].gcd(b[1])
        left, right = b[1] // common, a[1] // common
        return self.ratio(self.times(a[0], left) + self.times(b[0], right), self.times(a[1], left))

    def multiply(self, a: Ratio, b: Ratio) -> Ratio:
        return self.ratio(self.times(a[0], b[0]), self.times(a[1], b[1]))

    def power(self, a: Ratio, n: int) -> Ratio:
        if abs(n) > MOST_POWER:
            raise NoForm(f"power {n}")
        if n < 0:
            if a[0].is_zero():
                raise NoForm("a denominator vanishes identically")
            a, n = (a[1], a[0]), -n
        result = (self.one, self.one)
        while n:
            if n & 1:
                result = self.multiply(result, a)
            n >>= 1
            if n:
                a = self.multiply(a, a)
        return result

    def named(self, key: Any, meaning: sp.Expr, rule: tuple[int, Poly] | None = None, above: bool = False) -> Poly:
        if key not in self._named:
            self._named[key] = self.new(meaning, rule, above)
        return self._named[key]

    def expression(self, p: Poly) -> sp.Expr:
        """What a polynomial means."""
        terms = []
        for monomial, coefficient in p.to_dict().items():
            factors = [self.meaning[i] ** n for i, n in enumerate(monomial) if n]
            terms.append(sp.Mul(sp.Integer(int(coefficient)), *factors))
        return sp.Add(*terms)

    def sign(self, p: Poly) -> int:
        """1 or -1 where a polynomial is known to be above or below zero, else 0."""
        if (known := self.signs.get(key_of(p))) is not None:
            return known
        strict, lead = False, 0
        for monomial, coefficient in p.to_dict().items():
            odd = [i for i, n in enumerate(monomial) if n % 2 and i not in self.above_zero]
            if odd or (lead and (coefficient > 0) != (lead > 0)):
                return 0
            lead = 1 if coefficient > 0 else -1
            strict |= all(i in self.above_zero for i, n in enumerate(monomial) if n)
        return lead if strict else 0

    def factors(self, a: Ratio) -> tuple[Fraction, list[tuple[Poly, int]]]:
        """A rational number and irreducible polynomials with their powers."""
        if a[0].is_zero():
            raise NoForm("logarithm or root of zero")
        if max(len(a[0]), len(a[1])) > _MOST_FACTORED:
            raise NoForm("too many terms")
        (top, above), (bottom, below) = a[0].factor(), a[1].factor()
        return Fraction(int(top), int(bottom)), [*above, *((p, -n) for p, n in below)]

    def vector(self, a: Ratio) -> Vector:
        """Rational coefficients of terms over one primitive denominator."""
        top, bottom = a
        content = int(bottom.content())
        key = key_of(bottom // content)
        return {(key, m): Fraction(int(c), content) for m, c in top.to_dict().items()}

    def term(self, key: Any) -> sp.Expr:
        bottom, monomial = key
        top = sp.Mul(*(self.meaning[i] ** n for i, n in enumerate(monomial) if n))
        return top / self.expression(self.ring.from_dict(dict(bottom)))

    def from_vector(self, vector: Vector) -> Ratio:
        total = (self.zero, self.one)
        for (bottom, monomial), number in vector.items():
            top = self.ring.from_dict({monomial: number.numerator})
            total = self.add(total, (top, self.ring.from_dict(dict(bottom)) * number.denominator))
        return total


def sympy_rational(value: Fraction) -> sp.Rational:
    """The same number for sympy."""
    return sp.Rational(value.numerator, value.denominator)
