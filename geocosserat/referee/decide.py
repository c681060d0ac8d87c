"""Whether expressions vanish: refuted at a point, or proved by a normal form. Never by simplification.

Refuted: evaluated modulo a large prime at random points that satisfy the constraints, then shown at a point of rational
numbers, both exactly. Proved: as polynomials, reduced by the rules, with one unknown for each reciprocal: what reduces
to zero is zero. What is neither (it vanishes at all points tried, and its normal form is not found) is said to be
probable; so is what holds roots, sines or exponentials and vanishes to 40 digits.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from typing import Any

import mpmath
import sympy as sp
from sympy.polys.orderings import lex
from sympy.polys.rings import PolyRing

PRIME = 2**61 - 1
"""A polynomial of degree n that is not zero vanishes at a random point with a probability of at most n / PRIME
(Schwartz, J. ACM 27, 701 (1980))."""

POINTS, DIGITS = 3, 40


@dataclass(frozen=True)
class Decision:
    """vanishes: whether all do. how: in words. proved: by a normal form or a point; else only probable.

    point: of a refutation, the values of all symbols; entry, value: which one is not zero there, and what it is.
    """

    vanishes: bool
    how: str
    proved: bool = True
    point: Mapping[str, str] | None = None
    entry: int | None = None
    value: str | None = None


def decide(
    expressions: Sequence[sp.Expr],
    parameters: Mapping[sp.Symbol, sp.Expr] | None = None,
    rules: Sequence[sp.Expr] = (),
    seed: int = 1,
) -> Decision:
    """Whether all these expressions vanish wherever the rules do.

    ``parameters``: expressions to put in place of symbols that are bound by a constraint. Rules must be sums of squares
    of unknowns of their own, less one: x² + y² + ... - 1. Raises ValueError for other rules, and TypeError for
    expressions that are not made of numbers, symbols, sums, products and powers, sin, cos, exp and log.
    """
    # strict: expressions and numbers only; text is refused, not read
    bound = {x: sp.sympify(value, strict=True) for x, value in (parameters or {}).items()}
    entries = [sp.sympify(e, strict=True).xreplace(bound) for e in expressions]
    spheres = [_sphere(rule) for rule in rules]
    chance = random.Random(seed)
    unknowns = sorted({x for e in entries for x in e.free_symbols}, key=str)

    def refuted(numbers: _Numbers, points: int) -> Decision | None:
        valued = [False] * len(entries)
        for _ in range(points):
            point = _point(unknowns, spheres, chance, numbers)
            for i, e in enumerate(entries):
                value = _value(e, point, numbers, {})
                valued[i] |= value is not None
                if value is not None and not numbers.vanishes(value):
                    return numbers.refutation(point, i, value)
        if not all(valued):
            how = f"refuted: entry {valued.index(False) + 1} has a value at none of {points} random points"
            return Decision(False, how, False, entry=valued.index(False))
        return None

    if any(e.has(sp.Function) or _roots(e) for e in entries):
        with mpmath.workdps(DIGITS + 10):
            return refuted(_Real(), 20) or Decision(
                True, f"probable: vanishes to {DIGITS} digits at 20 random points", False
            )
    unequal = refuted(_Modular(), POINTS)
    if unequal is None and (proof := _proof(entries, spheres)):
        return proof
    # at numbers that can be read, if it is off there
    return (
        refuted(_Numbers(), 20)
        or unequal
        or Decision(True, f"probable: vanishes at {POINTS} random points modulo 2^61 - 1", False)
    )


# numbers


class _Numbers:
    """Rational numbers: exact, and slow where they grow long."""

    words = "exact"

    def draw(self, chance: random.Random) -> Any:
        return Fraction(chance.randrange(1, 20), 7)

    def rational(self, p: int, q: int) -> Any:
        return Fraction(p, q)

    def add(self, a: Any, b: Any) -> Any:
        return a + b

    def multiply(self, a: Any, b: Any) -> Any:
        return a * b

    def power(self, a: Any, n: Any) -> Any:
        return None if n < 0 and self.vanishes(a) else a**n

    def function(self, e: sp.Expr, a: Any) -> Any:
        raise TypeError(f"expected an algebraic expression, found {e}")

    def vanishes(self, a: Any) -> bool:
        return bool(a == 0)

    def refutation(self, point: Mapping[sp.Symbol, Any], entry: int, value: Any) -> Decision:
        def text(x: Any) -> str:
            if isinstance(x, int):
                return str(x)
            return str(mpmath.nstr(mpmath.mpf(x.numerator) / x.denominator if isinstance(x, Fraction) else x, 12))

        shown = {str(x): str(v) if isinstance(v, Fraction) else text(v) for x, v in point.items()}
        how = f"refuted: entry {entry + 1} is off by {text(value)} at a random point ({self.words})"
        return Decision(False, how, True, shown, entry, text(value))


class _Modular(_Numbers):
    """Numbers modulo the prime."""

    words = "modulo 2^61 - 1"

    def draw(self, chance: random.Random) -> Any:
        return chance.randrange(1, PRIME)

    def rational(self, p: int, q: int) -> Any:
        return p * pow(q, -1, PRIME) % PRIME

    def add(self, a: Any, b: Any) -> Any:
        return (a + b) % PRIME

    def multiply(self, a: Any, b: Any) -> Any:
        return a * b % PRIME

    def power(self, a: Any, n: Any) -> Any:
        return None if n < 0 and a == 0 else pow(a, n, PRIME)


class _Real(_Numbers):
    """Numbers with many digits; remembers the largest that was added, which says how far rounding reaches."""

    words = f"{DIGITS} digits"

    def __init__(self) -> None:
        self.largest = mpmath.mpf(1)

    def draw(self, chance: random.Random) -> Any:
        return mpmath.mpf(chance.randrange(1, 20)) / 7

    def rational(self, p: int, q: int) -> Any:
        return mpmath.mpf(p) / q

    def add(self, a: Any, b: Any) -> Any:
        self.largest = max(self.largest, abs(a), abs(b))
        return a + b

    def function(self, e: sp.Expr, a: Any) -> Any:
        known: dict[Any, Callable[[Any], Any]] = {
            sp.sin: mpmath.sin, sp.cos: mpmath.cos, sp.exp: mpmath.exp, sp.log: mpmath.log
        }  # fmt: skip
        if e.func not in known:
            raise TypeError(f"expected one of sin, cos, exp, log and sqrt, found {e.func}; write it with these")
        return known[e.func](a)

    def vanishes(self, a: Any) -> bool:
        return bool(abs(a) <= mpmath.mpf(10) ** -DIGITS * self.largest)


def _value(e: sp.Expr, point: Mapping[sp.Symbol, Any], numbers: _Numbers, seen: dict[sp.Expr, Any]) -> Any:
    """The value at a point; None where it has none."""
    if e in seen:
        return seen[e]
    value: Any
    if e.is_Symbol:
        value = point[e]
    elif e.is_Rational:
        value = numbers.rational(int(e.p), int(e.q))
    elif e.is_Add or e.is_Mul:
        combine = numbers.add if e.is_Add else numbers.multiply
        value = None
        values = [_value(argument, point, numbers, seen) for argument in e.args]
        value = None if any(v is None for v in values) else reduce(combine, values)
    elif e.is_Pow and e.exp.is_Rational:
        base = _value(e.base, point, numbers, seen)
        whole = e.exp.is_Integer
        value = None if base is None else numbers.power(base, int(e.exp) if whole else mpmath.mpf(e.exp.p) / e.exp.q)
    elif e.is_Function and len(e.args) == 1:
        argument = _value(e.args[0], point, numbers, seen)
        value = None if argument is None else numbers.function(e, argument)
    else:
        raise TypeError(f"expected numbers, symbols, sums, products, powers and functions, found {e}")
    seen[e] = value
    return value


def _roots(e: sp.Expr) -> bool:
    return any(not p.exp.is_Integer for p in e.atoms(sp.Pow))


def _sphere(rule: sp.Expr) -> list[sp.Symbol]:
    """The unknowns of x² + y² + ... - 1."""
    unknowns = sorted(rule.free_symbols, key=str)
    if sp.expand(rule - sum(x**2 for x in unknowns) + 1) != 0:
        raise ValueError(f"expected a rule x**2 + y**2 + ... - 1, found {rule}; bind other constraints by parameters")
    return unknowns


def _point(
    unknowns: Sequence[sp.Symbol], spheres: Sequence[Sequence[sp.Symbol]], chance: random.Random, numbers: _Numbers
) -> dict[sp.Symbol, Any]:
    """A random point on the spheres, by stereographic projection: rational if what is drawn is."""
    point = {x: numbers.draw(chance) for x in unknowns}
    one, two = numbers.rational(1, 1), numbers.rational(2, 1)
    for first, *others in spheres:
        share = None
        while share is None:  # modulo a prime, a sum of squares may be -1
            free = [numbers.draw(chance) for _ in others]
            square = reduce(numbers.add, (numbers.multiply(x, x) for x in free))
            share = numbers.power(numbers.add(square, one), -1)
        point[first] = numbers.add(one, numbers.multiply(numbers.rational(-2, 1), share))
        for x, y in zip(others, free, strict=True):
            point[x] = numbers.multiply(numbers.multiply(two, y), share)
    return point


# normal form


def _proof(entries: Sequence[sp.Expr], spheres: Sequence[Sequence[sp.Symbol]]) -> Decision | None:
    """None if something is left."""
    if all(e == 0 for e in entries):
        return Decision(True, f"proved: {_count(entries)} alike")
    reciprocals: dict[sp.Expr, sp.Symbol] = {}

    def named(e: sp.Expr) -> sp.Expr:
        """No ring has negative powers: one over something is an unknown of its own."""
        if e.is_Pow and e.exp.is_negative:
            return reciprocals.setdefault(named(e.base), sp.Dummy()) ** (-e.exp)
        return e.func(*(named(a) for a in e.args)) if e.args and e.has(sp.Pow) else e

    written = [named(e) for e in entries]
    ring, rules = _ring([*written, *reciprocals, *reciprocals.values()], spheres)
    rules += [ring.from_expr(base * one_over - 1) for base, one_over in reciprocals.items()]
    parts = [[ring.from_expr(part) for part in sp.Add.make_args(e)] for e in written]
    terms = sum(len(part) for sums in parts for part in sums)
    if not any(sum(sums, ring.zero).rem(rules) for sums in parts):
        return Decision(True, f"proved: normal form of {_count(entries)}, {terms} terms cancel")
    # reciprocals within reciprocals: over one denominator
    ring, rules = _ring(entries, spheres)
    if not any(_over(e, ring)[0].rem(rules) for e in entries):
        return Decision(True, f"proved: normal form of {_count(entries)} over one denominator")
    return None


def _count(entries: Sequence[sp.Expr]) -> str:
    return f"{len(entries)} entries" if len(entries) != 1 else "one entry"


def _ring(expressions: Sequence[sp.Expr], spheres: Sequence[Sequence[sp.Symbol]]) -> tuple[PolyRing, list[Any]]:
    """Polynomials in all symbols, and the rules there; their leading terms have nothing in common, so that what is
    left of a division by them is a normal form."""
    leading = [sphere[0] for sphere in spheres]
    symbols = {x for e in expressions for x in e.free_symbols} | {x for sphere in spheres for x in sphere}
    ring = PolyRing([*leading, *sorted(symbols - set(leading), key=str)] or [sp.Dummy()], sp.QQ, lex)
    return ring, [ring.from_expr(sum(x**2 for x in sphere) - 1) for sphere in spheres]


def _over(e: sp.Expr, ring: PolyRing) -> tuple[Any, Any]:
    """Numerator and denominator."""
    if e.is_Add or e.is_Mul:
        parts = [_over(a, ring) for a in e.args]
        if e.is_Add:
            return reduce(lambda a, b: (a[0] * b[1] + b[0] * a[1], a[1] * b[1]), parts)
        return reduce(lambda a, b: (a[0] * b[0], a[1] * b[1]), parts)
    if e.is_Pow:
        n, (top, bottom) = int(e.exp), _over(e.base, ring)
        return (top**n, bottom**n) if n >= 0 else (bottom**-n, top**-n)
    return ring.from_expr(e), ring.one
