"""Whether expressions vanish: refuted at a point, or proved by a normal form. Never by simplification.

Refuted: evaluated modulo a large prime at random points that satisfy the constraints, exactly; then shown at a point of
rational numbers with 40 digits. Proved: as polynomials, reduced by the rules, with one unknown for each reciprocal: what
reduces to zero is zero. What is neither (it vanishes at all points tried, and its normal form is not found) is said to
be probable.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
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

    ``parameters``: expressions to put in place of symbols that are bound by a constraint. Rules must be quadratic
    forms of unknowns of their own less one: x² + y² + ... - 1. Raises ValueError for other rules, and TypeError for
    expressions that are not made of numbers, symbols, sums, products and whole powers, sin, cos, exp, log, sqrt.
    """
    entries = [sp.sympify(e, strict=True).xreplace(dict(parameters or {})) for e in expressions]
    spheres = [_sphere(rule) for rule in rules]
    algebraic = not any(e.has(sp.Function) or _roots(e) for e in entries)
    chance = random.Random(seed)
    unknowns = sorted({x for e in entries for x in e.free_symbols}, key=str)
    for _ in range(POINTS if algebraic else 0):
        point = _point(unknowns, spheres, lambda: chance.randrange(1, PRIME), _Modular())
        if point is None:
            continue
        values = [_value(e, point, _Modular(), {}) for e in entries]
        if any(v is not None and v % PRIME for v in values):
            break
    else:
        if algebraic:
            return _proof(entries, spheres)
    return _shown(entries, unknowns, spheres, chance, algebraic)


def _shown(
    entries: Sequence[sp.Expr],
    unknowns: Sequence[sp.Symbol],
    spheres: Sequence[Sequence[sp.Symbol]],
    chance: random.Random,
    algebraic: bool,
) -> Decision:
    """At points of rational numbers, with 40 digits."""
    with mpmath.workdps(DIGITS + 10):
        for _ in range(20):
            real = _Real()
            point = _point(unknowns, spheres, lambda: mpmath.mpf(chance.randrange(1, 20)) / 7, real)
            assert point is not None
            for i, e in enumerate(entries):
                value = _value(e, point, real, {})
                if abs(value) > mpmath.mpf(10) ** -DIGITS * (1 + real.largest):
                    shown = {str(x): mpmath.nstr(v, 10) for x, v in point.items()}
                    text = mpmath.nstr(value, 12)
                    how = f"refuted: at a random point entry {i + 1} is off by {text} ({DIGITS} digits)"
                    return Decision(False, how, True, shown, i, text)
    if algebraic:
        raise AssertionError("an expression that does not vanish modulo a prime does at all points tried")
    return Decision(True, f"probable: vanishes to {DIGITS} digits at 20 random points", False)


# numbers


class _Modular:
    """Numbers modulo the prime."""

    def rational(self, p: int, q: int) -> Any:
        return p * pow(q, -1, PRIME) % PRIME

    def add(self, a: Any, b: Any) -> Any:
        return (a + b) % PRIME

    def multiply(self, a: Any, b: Any) -> Any:
        return a * b % PRIME

    def power(self, a: Any, n: int) -> Any:
        if n < 0 and a % PRIME == 0:
            return None
        return pow(a, n, PRIME)

    def function(self, e: sp.Expr, a: Any) -> Any:
        raise TypeError(f"expected an algebraic expression, found {e}")


class _Real:
    """Numbers with many digits; remembers the largest, which says how far rounding reaches."""

    def __init__(self) -> None:
        self.largest = mpmath.mpf(0)

    def rational(self, p: int, q: int) -> Any:
        return mpmath.mpf(p) / q

    def add(self, a: Any, b: Any) -> Any:
        self.largest = max(self.largest, abs(a), abs(b))
        return a + b

    def multiply(self, a: Any, b: Any) -> Any:
        return a * b

    def power(self, a: Any, n: Any) -> Any:
        return a**n

    def function(self, e: sp.Expr, a: Any) -> Any:
        known: dict[Any, Callable[[Any], Any]] = {
            sp.sin: mpmath.sin, sp.cos: mpmath.cos, sp.exp: mpmath.exp, sp.log: mpmath.log
        }  # fmt: skip
        if e.func not in known:
            raise TypeError(f"expected one of sin, cos, exp, log and sqrt, found {e.func}; write it with these")
        return known[e.func](a)


def _value(e: sp.Expr, point: Mapping[sp.Symbol, Any], numbers: Any, seen: dict[sp.Expr, Any]) -> Any:
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
        for k, argument in enumerate(e.args):
            next_one = _value(argument, point, numbers, seen)
            value = next_one if k == 0 else None if value is None or next_one is None else combine(value, next_one)
    elif e.is_Pow and e.exp.is_Integer:
        base = _value(e.base, point, numbers, seen)
        value = None if base is None else numbers.power(base, int(e.exp))
    elif e.is_Pow and e.exp.is_Rational and isinstance(numbers, _Real):
        value = numbers.power(_value(e.base, point, numbers, seen), mpmath.mpf(int(e.exp.p)) / int(e.exp.q))
    elif e.is_Function and len(e.args) == 1:
        value = numbers.function(e, _value(e.args[0], point, numbers, seen))
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
    unknowns: Sequence[sp.Symbol], spheres: Sequence[Sequence[sp.Symbol]], draw: Callable[[], Any], numbers: Any
) -> dict[sp.Symbol, Any] | None:
    """A random point on the spheres, by stereographic projection: rational if what is drawn is."""
    point = {x: draw() for x in unknowns}
    for sphere in spheres:
        free = [draw() for _ in sphere[1:]]
        square = free[0] * 0
        for x in free:
            square = numbers.add(square, numbers.multiply(x, x))
        share = numbers.power(numbers.add(square, numbers.rational(1, 1)), -1)
        if share is None:
            return None
        minus = numbers.rational(-1, 1)
        point[sphere[0]] = numbers.multiply(numbers.add(square, minus), share)
        for x, y in zip(sphere[1:], free, strict=True):
            point[x] = numbers.multiply(numbers.multiply(numbers.rational(2, 1), y), share)
    return point


# normal form


def _proof(entries: Sequence[sp.Expr], spheres: Sequence[Sequence[sp.Symbol]]) -> Decision:
    reciprocals: dict[sp.Expr, sp.Symbol] = {}

    def named(e: sp.Expr) -> sp.Expr:
        """No ring has negative powers: one over something is an unknown of its own."""
        if e.is_Pow and e.exp.is_negative:
            base = named(e.base)
            return reciprocals.setdefault(base, sp.Dummy()) ** (-e.exp)
        return e.func(*(named(a) for a in e.args)) if e.args and e.has(sp.Pow) else e

    written = [named(e) for e in entries]
    terms = 0
    if any(e != 0 for e in written):
        leading = [sphere[0] for sphere in spheres]
        symbols = {x for e in (*written, *reciprocals) for x in e.free_symbols} | {x for s in spheres for x in s}
        symbols |= set(reciprocals.values())
        order = [*leading, *sorted(symbols - set(leading), key=str)]
        ring = PolyRing(order, sp.QQ, lex)
        rules = [ring.from_expr(sum(x**2 for x in sphere) - 1) for sphere in spheres]
        rules += [ring.from_expr(base * one_over - 1) for base, one_over in reciprocals.items()]
        for e in written:
            for part in sp.Add.make_args(e):
                terms += len(ring.from_expr(part))
            if ring.from_expr(e).rem(rules):
                return Decision(True, f"probable: vanishes at {POINTS} random points modulo 2^61 - 1", False)
    how = f"proved: normal form of {len(entries)} entries, {terms} terms cancel"
    return Decision(True, how if terms else f"proved: {len(entries)} entries alike")
