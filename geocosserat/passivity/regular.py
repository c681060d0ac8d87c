"""Where expressions of a configuration are not smooth, and proofs that this is nowhere."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Final, Literal, TypeAlias

import sympy as sp
from flint import fmpq, fmpq_mat

from geocosserat.algebra.groups import Group
from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.notation import symbol
from geocosserat.model.evaluation import walk
from geocosserat.model.expressions import (
    Binary,
    Call,
    Expression,
    ExpressionError,
    Number,
    evaluate,
    substitute,
    symbols,
    to_text,
)
from geocosserat.model.law import pose_names
from geocosserat.passivity.ranges import Range, sign_on

Kind: TypeAlias = Literal["pole", "root", "step"]
_MOST_DEGREE: Final = 12
_KIND: Final[dict[str, Kind]] = {"log": "root", "sqrt": "root", "abs": "step", "heaviside": "step"}


@dataclass(frozen=True)
class Singular:
    """Where ``zero`` = 0 (pole; for a root or logarithm also below zero): an expression has no value or no slope.

    For a step, ``zero`` = 0 is where its branches meet.
    """

    kind: Kind
    zero: Expression

    def __str__(self) -> str:
        words = {"pole": "pole where", "root": "root or logarithm at", "step": "step or kink where"}
        return f"{words[self.kind]} {to_text(self.zero)} = 0"


def singular(group: Group, expressions: Iterable[Expression], positive: Collection[str]) -> tuple[Singular, ...]:
    """Singular sets in the space of configurations that are not proved to be empty, each once.

    ``positive``: names of parameters above zero. Parameters with a value are to be numbers already.
    """
    names = set(pose_names(group))
    found: dict[Singular, None] = {}
    for e in expressions:
        for node in walk(e):
            for kind, zero in _parts(node):
                if symbols(zero) & names:
                    found[Singular(kind, zero)] = None
    return tuple(s for s in found if not _empty(group, s, positive))


def _parts(node: Expression) -> Iterable[tuple[Kind, Expression]]:
    match node:
        case Call("tan", argument):
            yield "pole", Call("cos", argument)
        case Call(function, argument) if function in _KIND:
            yield _KIND[function], argument
        case Binary("/", _, bottom):
            yield "pole", bottom
        case Binary("**", base, power):
            number = None if symbols(power) else evaluate(power, {})
            if number is None or not float(number).is_integer():
                yield "root", base
            elif float(number) < 0:
                yield "pole", base


def _empty(group: Group, s: Singular, positive: Collection[str]) -> bool:
    sign = sign_on(s.zero, box(group, positive, symbols(s.zero)))
    if sign > 0 or (sign and s.kind != "root"):
        return True
    return _definite(group, s)


def box(group: Group, positive: Collection[str], used: Collection[str]) -> dict[str, Range]:
    """Ranges of what is known of the names: axes are unit vectors, positive parameters positive."""
    ranges: dict[str, Range] = {}
    for name in used:
        if group.rotations == 3 and name in pose_names(group)[3:]:
            ranges[name] = (Fraction(-1), Fraction(1))
        elif name in positive:
            ranges[name] = (Fraction(0), math.inf)
    return ranges


def _definite(group: Group, s: Singular) -> bool:
    """Whether it is a quadratic polynomial in numbers that has one sign everywhere: a definite form in (1, x, ...)."""
    try:
        e = to_sympy(s.zero)
    except ExpressionError:
        return False
    names = sorted(e.free_symbols, key=str)
    try:
        polynomial = sp.Poly(e, *names, domain="QQ")
    except (sp.PolynomialError, sp.CoercionFailed):
        return False
    if polynomial.total_degree() > 2:
        return False
    n = len(names)
    rows = [[fmpq(0)] * (n + 1) for _ in range(n + 1)]
    for powers, c in polynomial.terms():
        places = [i + 1 for i, p in enumerate(powers) for _ in range(p)]
        i, j = (*([0] * (2 - len(places))), *places)
        number = fmpq(int(c.p), int(c.q))
        rows[i][j] += number / 2
        rows[j][i] += number / 2
    sign = 1 if rows[0][0] > 0 else -1
    if sign < 0 and s.kind == "root":
        return False
    leading = (fmpq_mat([[sign * x for x in row[:k]] for row in rows[:k]]).det() for k in range(1, n + 2))
    return all(minor > 0 for minor in leading)


def factors(e: sp.Expr) -> dict[sp.Expr, int]:
    """What vanishes where ``e`` does: irreducible factors of a rational function, without numbers; else ``e``."""
    if degree(e) > _MOST_DEGREE:
        return {e: 1}
    top, _ = sp.fraction(sp.together(e))
    _, powers = sp.factor_list(top)
    return {f if f.as_coeff_Mul()[0] > 0 else -f: n for f, n in powers}


def degree(e: sp.Expr) -> int:
    """A bound of the degree of a polynomial; what is no polynomial counts as one unknown."""
    if e.is_Add:
        return max(degree(a) for a in e.args)
    if e.is_Mul:
        return sum(degree(a) for a in e.args)
    if e.is_Pow and e.exp.is_Integer and e.exp > 0:
        return int(e.exp) * degree(e.base)
    return 0 if e.is_number else 1


def singular_factors(e: sp.Expr, pose: Collection[sp.Symbol]) -> frozenset[sp.Expr]:
    """Factors at whose zeros an expression of symbols may be singular; its steps are left out."""
    found: set[sp.Expr] = set()
    for part in e.atoms(sp.Pow, sp.Function):
        inside: sp.Expr | None = None
        if part.is_Pow and part.base is not sp.E and not (part.exp.is_Integer and part.exp > 0):
            inside = part.base
        elif part.func is sp.log:
            (inside,) = part.args
            inside = inside.args[0] if inside.func is sp.Abs else inside
        elif part.func is sp.tan:
            inside = sp.cos(part.args[0])
        if inside is not None and inside.free_symbols & set(pose):
            found |= set(factors(inside))
    return frozenset(found)


def may_step(e: sp.Expr, pose: Collection[sp.Symbol]) -> bool:
    """Whether an expression may jump by a finite amount across the zeros of its own denominators.

    As |g|/g does, g/sqrt(g**2), and functions of 1/g such as tanh(1/g).
    """
    names = set(pose)
    below = singular_factors(e, names)
    for part in e.atoms(sp.Pow, sp.Function):
        if not part.free_symbols & names:
            continue
        if part.func is sp.log and part.args[0].func is sp.Abs:
            continue
        if part.is_Pow and not part.exp.is_number:
            return True
        if part.is_Pow and part.base is not sp.E:
            if not part.exp.is_Integer and any(n > 1 for n in factors(part.base).values()):
                return True
            continue
        inside = part.exp if part.is_Pow else part.args[0]
        if part.func in (sp.Abs, sp.sign, sp.Heaviside):
            if below & {*factors(inside), part, inside} and not _in_logarithms(e, part):
                return True
        elif part.func is not sp.log and singular_factors(inside, names):
            return True
    return False


def _in_logarithms(e: sp.Expr, part: sp.Expr) -> bool:
    """Whether a modulus occurs within logarithms only."""
    return not e.replace(lambda x: x.func is sp.log and x.args[0] == part, lambda _: sp.S.Zero).has(part)


def numbers_in(e: Expression, values: dict[str, float]) -> Expression:
    """The expression with numbers for those names, otherwise as it is written (nothing is worked out in floats)."""
    return substitute(e, {name: Number(value) for name, value in values.items()})


def symbols_of(group: Group) -> tuple[sp.Symbol, ...]:
    """The names of a configuration as symbols."""
    return tuple(symbol(name) for name in pose_names(group))
