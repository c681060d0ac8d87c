"""Normal forms of real functions: fractions of polynomials in unknowns that stand for functions.

Every function is written through few unknowns: ``exp`` of arguments that are independent over the rationals, pairs
(cos, sin) of such arguments, roots, logarithms and moduli of polynomials. The unknowns obey rules g**q = P. Each
rewriting is an identity wherever what is rewritten is defined, so that a numerator that reduces to zero proves that a
function vanishes; nothing follows from one that does not (there may be relations between unknowns beyond the rules).
"""

from __future__ import annotations

import time
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import lcm
from typing import Any, Final

import sympy as sp

from geocosserat.passivity.independent import Basis, Vector
from geocosserat.passivity.polynomials import MOST_POWER, NoForm, Poly, Ratio, Ring, key_of, sympy_rational

_MOST_UNKNOWNS: Final = 160
_MOST_ANGLES: Final = 24
_EXACT_ANGLES: Final = 24  # of pi


class _Again(Exception):
    """A finer unit was found; start afresh with it."""


@dataclass
class Scales:
    """Units found so far: of the arguments of exp and of sines by their position, of roots by what is under them."""

    units: dict[tuple[str, Any], int] = field(default_factory=dict)

    def refine(self, key: tuple[str, Any], factor: int) -> None:
        self.units[key] = self.units.get(key, 1) * factor
        if self.units[key] > MOST_POWER:
            raise NoForm(f"unit 1/{self.units[key]}")
        raise _Again


class Tower(Ring):
    """The unknowns that expressions need, made as they are met.

    ``radicals``: indices of roots and moduli. ``noting``: whether what is under a root or a logarithm is taken to be
    above zero wherever it occurs.
    """

    def __init__(
        self,
        symbols: Sequence[sp.Symbol],
        size: int,
        positive: Collection[str],
        scales: Scales,
        until: float,
        noting: bool = True,
    ) -> None:
        if size > _MOST_UNKNOWNS:
            raise NoForm(f"more than {_MOST_UNKNOWNS} unknowns")
        super().__init__(size, until)
        self.scales, self.noting = scales, noting
        self.radicals: set[int] = set()
        self._arguments: dict[int, Ratio] = {}
        self._inside: dict[int, Ratio] = {}
        self._seen: dict[sp.Expr, Ratio] = {}
        self._bases = {"exp": Basis(), "angle": Basis()}
        for x in symbols:
            self._seen[x] = (self.new(x, above_zero=x.name in positive), self.one)

    # what an expression is

    def of(self, e: sp.Expr) -> Ratio:
        """The normal form. Raises NoForm where there is none."""
        if (known := self._seen.get(e)) is None:
            known = self._seen[e] = self._of(e)
        return known

    def _of(self, e: sp.Expr) -> Ratio:
        if e.is_Rational:
            return self.constant(Fraction(int(e.p), int(e.q)))
        if e is sp.pi:
            return self.new(e, above_zero=True), self.one
        if e is sp.E:
            return self.exponential((self.one, self.one))
        if e.is_Add:
            return self._sum([self.of(a) for a in e.args])
        if e.is_Mul:
            product = (self.one, self.one)
            for a in e.args:
                product = self.multiply(product, self.of(a))
            return product
        if e.is_Pow:
            if e.exp.is_Integer:
                return self.power(self.of(e.base), int(e.exp))
            if e.exp.is_Rational:
                return self.power(self.root(self.of(e.base), int(e.exp.q)), int(e.exp.p))
            return self.exponential(self.multiply(self.of(e.exp), self.logarithm(self.of(e.base))))
        if e.is_Function and e.args and e.func in _RULES:
            value: Ratio = _RULES[e.func](self, self.of(e.args[0]))
            return value
        if e.is_Function and len(e.args) == 1 and not isinstance(e, sp.core.function.AppliedUndef):
            return self.named((e.func.__name__, *self.key_of(self.of(e.args[0]))), e), self.one
        raise NoForm(f"{e.func}")

    def _sum(self, parts: list[Ratio]) -> Ratio:
        by_bottom: dict[Any, Ratio] = {}
        for top, bottom in parts:
            key = key_of(bottom)
            by_bottom[key] = (by_bottom[key][0] + top, bottom) if key in by_bottom else (top, bottom)
        total = (self.zero, self.one)
        for part in by_bottom.values():
            total = self.add(total, part)
        return total

    def key_of(self, a: Ratio) -> tuple[Any, Any]:
        return key_of(a[0]), key_of(a[1])

    # functions

    def _in_units(self, kind: str, vector: Vector) -> list[tuple[int, int, bool]]:
        """(position, whole number, whether it is new) of the independent arguments that a vector is made of."""
        basis = self._bases[kind]
        found = basis.express(vector)
        if found is None:
            unit = self.scales.units.get((kind, len(basis.vectors)), 1)
            basis.vectors.append({k: v / unit for k, v in vector.items()})
            return [(len(basis.vectors) - 1, unit, True)]
        for position, share in found:
            if share.denominator != 1:
                self.scales.refine((kind, position), share.denominator)
        return [(position, int(number), False) for position, number in found]

    def exponential(self, a: Ratio) -> Ratio:
        result = (self.one, self.one)
        vector = self.vector(a)
        for key in list(vector):
            # exp(q log|p|) is |p|**q
            inside = self._logarithm_in(key)
            if inside is not None:
                share = vector.pop(key)
                base = self.root(self.modulus(inside), share.denominator)
                result = self.multiply(result, self.power(base, share.numerator))
        if not vector:
            return result
        for position, number, new in self._in_units("exp", vector):
            if new:
                argument = sum((self.term(k) * sympy_rational(v / number) for k, v in vector.items()), sp.S.Zero)
                unknown = self.named(("exp", position), sp.exp(argument), above=True)
                bottom = {k: v / number for k, v in vector.items()}
                self._arguments[len(self.meaning) - 1] = self.from_vector(bottom)
            unknown = self._named[("exp", position)]
            result = self.multiply(result, self.power((unknown, self.one), number))
        return result

    def _logarithm_in(self, key: Any) -> Ratio | None:
        """What a term is the logarithm of, if it is one alone."""
        bottom, monomial = key
        if sum(monomial) != 1 or not self.ring.from_dict(dict(bottom)).is_one():
            return None
        return self._inside.get(monomial.index(1))

    def angles(self, a: Ratio) -> tuple[Ratio, Ratio]:
        """cos and sin of a."""
        vector = self.vector(a)
        cos, sin = self.constant(1), self.constant(0)
        for key in list(vector):
            top = self.term(key)
            if top is sp.pi and _EXACT_ANGLES % vector[key].denominator == 0:
                turn = sympy_rational(vector.pop(key)) * sp.pi
                cos, sin = (self.of(sp.expand_func(f(turn)).rewrite(sp.sqrt)) for f in (sp.cos, sp.sin))
        if not vector:
            return cos, sin
        for position, number, new in self._in_units("angle", vector):
            if abs(number) > _MOST_ANGLES:
                raise NoForm(f"{number} times an angle")
            if new:
                argument = sum((self.term(k) * sympy_rational(v / number) for k, v in vector.items()), sp.S.Zero)
                c = self.named(("cos", position), sp.cos(argument))
                self.named(("sin", position), sp.sin(argument), (2, self.one - c * c))
            one = (self._named[("cos", position)], self.one), (self._named[("sin", position)], self.one)
            if number < 0:
                one = one[0], self.multiply(one[1], self.constant(-1))
            for _ in range(abs(number)):
                cos, sin = (
                    self.add(self.multiply(cos, one[0]), self.multiply(self.constant(-1), self.multiply(sin, one[1]))),
                    self.add(self.multiply(sin, one[0]), self.multiply(cos, one[1])),
                )
        return cos, sin

    def modulus(self, a: Ratio) -> Ratio:
        if a[0].is_zero():
            return a
        number, factors = self.factors(a)
        result = self.constant(abs(number))
        for p, n in factors:
            result = self.multiply(result, self.power(self._modulus_of(p) if n % 2 else (p, self.one), n))
        return result

    def _modulus_of(self, p: Poly) -> Ratio:
        if sign := self.sign(p):
            return sign * p, self.one
        name = self.named(("abs", key_of(p)), sp.Abs(self.expression(p), evaluate=False), (2, self.reduced(p * p)))
        self.radicals.add(self.unknowns.index(name))
        return name, self.one

    def defined(self, a: Ratio) -> None:
        """Take note of a radicand or the argument of a logarithm, which is above zero where it is meant."""
        if not self.noting:
            return
        number, factors = self.factors(a)
        unknown = [(p, n) for p, n in factors if n % 2 and not self.sign(p)]
        if len(unknown) == 1:
            sign = 1 if number > 0 else -1
            for p, n in factors:
                sign *= self.sign(p) if n % 2 and self.sign(p) else 1
            p = unknown[0][0]
            self.signs[key_of(p)], self.signs[key_of(-p)] = sign, -sign

    def logarithm(self, a: Ratio) -> Ratio:
        self.defined(a)
        number, factors = self.factors(a)
        parts = [self.multiply(self.constant(n), self._logarithm_of(p)) for p, n in factors]
        for side, sign in ((number.numerator, 1), (number.denominator, -1)):
            for prime, n in sp.factorint(abs(side), limit=1000).items():
                if prime != 1:
                    name = self._log_unknown(self.ring.constant(int(prime)))
                    parts.append(self.multiply(self.constant(sign * n), name))
        return self._sum(parts)

    def _logarithm_of(self, p: Poly) -> Ratio:
        """log|p|."""
        if len(p) == 1 and p in self.unknowns:
            index = self.unknowns.index(p)
            if index in self._arguments:
                return self._arguments[index]
            for at, q, replacement in self.rules:
                if at == index and index in self.radicals:
                    return self.multiply(self.constant(Fraction(1, q)), self.logarithm((replacement, self.one)))
        return self._log_unknown(p)

    def _log_unknown(self, p: Poly) -> Ratio:
        sign = self.sign(p)
        inner = self.expression(p)
        name = self.named(("log", key_of(p)), sp.log(sign * inner if sign else sp.Abs(inner, evaluate=False)))
        self._inside[self.unknowns.index(name)] = (p, self.one)
        return name, self.one

    def root(self, a: Ratio, q: int) -> Ratio:
        """The q-th root of a > 0."""
        if q == 1:
            return a
        key = ("root", self.key_of(a))
        unit = self.scales.units.get(key, 1)
        if unit % q:
            self.scales.refine(key, lcm(unit, q) // unit)
        if unit != q:
            return self.power(self.root_of(a, unit), unit // q)
        return self.root_of(a, q)

    def root_of(self, a: Ratio, q: int) -> Ratio:
        if a[0].is_zero():
            return a
        self.defined(a)
        number, factors = self.factors(a)
        result, lump = (self.one, self.one), self.constant(1 if number > 0 else -1)[0]
        for side, sign in ((abs(number.numerator), 1), (number.denominator, -1)):
            for prime, n in sp.factorint(side, limit=1000).items():
                factors.append((self.ring.constant(int(prime)), sign * n))
        for p, n in factors:
            whole, rest = divmod(n, q)
            outside = (p, self.one) if whole % 2 == 0 or p.is_constant() else self._modulus_of(p)
            if whole:
                result = self.multiply(result, self.power(outside, whole))
            if not rest:
                continue
            if sign := self.sign(p):
                lump = lump if sign > 0 or n % 2 == 0 else -lump
                result = self.multiply(result, self.power(self._root_unknown(sign * p, q), rest))
            elif rest % 2 == 0:
                # the fourth root of p**2 is a root of |p|
                result = self.multiply(result, self.power(self._root_unknown(self._modulus_of(p)[0], q), rest))
            else:
                lump = self.times(lump, p**rest)
        if not lump.is_one():
            result = self.multiply(result, self._root_unknown(lump, q))
        return result

    def _root_unknown(self, p: Poly, q: int) -> Ratio:
        if p.is_one():
            return p, self.one
        if p in self.unknowns and (index := self.unknowns.index(p)) in self._arguments:
            return self.exponential(self.multiply(self.constant(Fraction(1, q)), self._arguments[index]))
        meaning = self.expression(p) ** sp.Rational(1, q)
        name = self.named(("root", q, key_of(p)), meaning, (q, p), above=True)
        self.radicals.add(self.unknowns.index(name))
        return name, self.one


def _tan(tower: Tower, a: Ratio) -> Ratio:
    cos, sin = tower.angles(a)
    return tower.multiply(sin, tower.power(cos, -1))


def _hyperbolic(sinh: int, cosh: int) -> Any:
    def of(tower: Tower, a: Ratio) -> Ratio:
        x = tower.exponential(a)
        y = tower.power(x, -1)
        s, c = tower.add(x, tower.multiply(tower.constant(-1), y)), tower.add(x, y)
        half = tower.constant(Fraction(1, 2) ** (sinh + cosh))
        return tower.multiply(half, tower.multiply(tower.power(s, sinh), tower.power(c, cosh)))

    return of


def _sign(tower: Tower, a: Ratio) -> Ratio:
    return tower.multiply(tower.modulus(a), tower.power(a, -1))


def _heaviside(tower: Tower, a: Ratio) -> Ratio:
    return tower.multiply(tower.constant(Fraction(1, 2)), tower.add(tower.constant(1), _sign(tower, a)))


_RULES: Final[Mapping[Any, Any]] = {
    sp.exp: Tower.exponential,
    sp.log: Tower.logarithm,
    sp.sin: lambda tower, a: tower.angles(a)[1],
    sp.cos: lambda tower, a: tower.angles(a)[0],
    sp.tan: _tan,
    sp.cot: lambda tower, a: tower.power(_tan(tower, a), -1),
    sp.sec: lambda tower, a: tower.power(tower.angles(a)[0], -1),
    sp.csc: lambda tower, a: tower.power(tower.angles(a)[1], -1),
    sp.sinh: _hyperbolic(1, 0),
    sp.cosh: _hyperbolic(0, 1),
    sp.tanh: _hyperbolic(1, -1),
    sp.coth: _hyperbolic(-1, 1),
    sp.sech: _hyperbolic(0, -1),
    sp.csch: _hyperbolic(-1, 0),
    sp.Abs: Tower.modulus,
    sp.sign: _sign,
    sp.Heaviside: _heaviside,
    sp.DiracDelta: lambda tower, a: tower.constant(0),
}


def normal_forms(
    expressions: Sequence[sp.Expr], positive: Iterable[str] = (), seconds: float = 4.0, noting: bool = True
) -> tuple[Tower, list[Ratio]]:
    """The normal forms of expressions of real symbols, where all of them are defined.

    ``positive``: names of symbols that are above zero. ``noting``: False for expressions that are not defined at the
    same points. Raises NoForm where there is none within the bounds.
    """
    symbols = sorted({x for e in expressions for x in e.free_symbols}, key=str)
    functions = {p for e in expressions for p in e.atoms(sp.Function, sp.Pow)}
    size = len(symbols) + 2 + 4 * sum(1 for p in functions if not (p.is_Pow and p.exp.is_Integer))
    size = min(size + (10 if functions else 0), max(_MOST_UNKNOWNS, len(symbols) + 2))
    insides = [
        p.base if p.is_Pow else p.args[0]
        for p in sorted(functions, key=sp.default_sort_key)
        if (p.is_Pow and not p.exp.is_Integer and p.base is not sp.E) or p.func is sp.log
    ]
    scales, names = Scales(), frozenset(positive)
    until = time.monotonic() + seconds
    for _ in range(40):
        try:
            tower = Tower(symbols, size, names, scales, until, noting)
            for inside in insides:
                if not inside.is_number:
                    tower.defined(tower.of(inside))
            return tower, [tower.of(e) for e in expressions]
        except _Again:
            continue
    raise NoForm("units that grow ever finer")
