"""For which values of open parameters given functions vanish identically."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import sympy as sp
from flint import arb, arb_mat, fmpq

from geocosserat.passivity.balls import precision
from geocosserat.passivity.normal import Tower, normal_forms
from geocosserat.passivity.points import enclosure
from geocosserat.passivity.polynomials import NoForm, Poly, Ratio, key_of
from geocosserat.passivity.vanish import vanishes

Equation: TypeAlias = tuple[sp.Expr, sp.Expr]
"""Left and right side."""

_MOST_BRANCHES: Final = 64
_MOST_COMPARED: Final = 40


@dataclass(frozen=True)
class Conditions:
    """Alternatives, each of which is a set of equations that hold together; none: no values do.

    exact: whether they are necessary as well as sufficient, as proved; else there may be further values.
    """

    alternatives: tuple[tuple[Equation, ...], ...]
    exact: bool

    def __str__(self) -> str:
        if not self.alternatives:
            return "for no values" if self.exact else "for no values that were found"
        parts = [" and ".join(f"{a} = {b}" for a, b in equations) for equations in self.alternatives]
        several = len(parts) > 1
        return " or ".join(f"({p})" if several and " and " in p else p for p in parts)


def conditions(expressions: Sequence[sp.Expr], open_: Collection[str], positive: Collection[str]) -> Conditions | None:
    """When all expressions vanish identically in the symbols that are not open. None where no answer was found.

    The numerators are polynomials in functions of what is not open; their coefficients must vanish. Necessary only if
    those functions are independent, which their values at random points prove.
    """
    try:
        tower, forms = normal_forms(expressions, positive)
        return _conditions(tower, forms, expressions, set(open_), positive)
    except NoForm:
        return None


def _conditions(
    tower: Tower, forms: Sequence[Ratio], expressions: Sequence[sp.Expr], open_: set[str], positive: Collection[str]
) -> Conditions | None:
    names = [{x.name for x in meaning.free_symbols} for meaning in tower.meaning]
    moving = [i for i, found in enumerate(names) if found - open_]
    mixed = any(names[i] & open_ for i in moving)
    system: list[Poly] = []
    monomials: dict[tuple[int, ...], None] = {}
    for top, _ in forms:
        groups: dict[tuple[int, ...], dict[Any, Any]] = {}
        for monomial, coefficient in top.to_dict().items():
            outer = tuple(monomial[i] for i in moving)
            inner = tuple(0 if i in moving else n for i, n in enumerate(monomial))
            groups.setdefault(outer, {})[inner] = coefficient
        monomials |= dict.fromkeys(groups)
        system += [tower.ring.from_dict(group) for group in groups.values()]
    plain = all(tower.meaning[i].is_Symbol for i in moving)
    exact = not mixed and (plain or _independent(tower, moving, list(monomials)))
    solver = _Solver(tower, {i for i, m in enumerate(tower.meaning) if m.is_Symbol and m.name in open_})
    branches = list(solver.branches(system, ()))
    if solver.exceeded:
        return None
    found = [_equations(tower, branch) for branch in solver.least(branches)]
    # what solves the system is put back: a proof that it suffices
    for equations in found:
        bound = {a: b for a, b in equations if a.is_Symbol}
        if len(bound) == len(equations) and vanishes([e.subs(bound) for e in expressions], positive).value is not True:
            return None
    if mixed:
        # functions such as exp(a*x) become numbers at a = 0
        inside = sorted({x for i in moving for x in tower.meaning[i].free_symbols if x.name in open_}, key=str)
        for x in inside:
            if ((x, sp.S.Zero),) not in found and x.name not in positive:
                at_zero = vanishes([e.subs(x, 0) for e in expressions], positive)
                found += [((x, sp.S.Zero),)] if at_zero.value is True else []
    return Conditions(tuple(found), exact)


def _independent(tower: Tower, moving: Sequence[int], monomials: Sequence[tuple[int, ...]]) -> bool:
    """Whether functions are linearly independent: the determinant of their values at random points is not zero."""
    if len(monomials) > _MOST_COMPARED:
        return False
    functions = [
        sp.Mul(*(tower.meaning[i] ** n for i, n in zip(moving, monomial, strict=True))) for monomial in monomials
    ]
    symbols = sorted({x.name for f in functions for x in f.free_symbols})
    for width in (37, 101, 11):
        rows = []
        with precision(64 + 32 * len(functions)):
            for k in range(1, 4 * len(functions) + 8):
                point = {
                    x: arb(fmpq((k * k * (7 + 2 * i) + 5 * k * (i + 1)) % 997 + 1, 997)) * arb(fmpq(20, width))
                    for i, x in enumerate(symbols)
                }
                seen: dict[sp.Expr, arb] = {}
                row = [enclosure(f, point, seen) for f in functions]
                if all(value.is_finite() for value in row):
                    rows.append(row)
                if len(rows) == len(functions):
                    determinant = arb_mat(rows).det()
                    if determinant.is_finite() and not determinant.contains(0):
                        return True
                    break
    return False


Step: TypeAlias = tuple[int | None, Poly, Poly]
"""An unknown and the numerator and denominator of what it equals; without unknown: a polynomial that vanishes."""


class _Solver:
    """Polynomial equations by factors and by unknowns that occur alone."""

    def __init__(self, tower: Tower, unknowns: set[int]) -> None:
        self.tower, self.unknowns, self.count, self.exceeded = tower, unknowns, 0, False

    def branches(self, system: Sequence[Poly], done: tuple[Step, ...]) -> Iterator[tuple[Step, ...]]:
        if self.exceeded:
            return
        left = {key_of(p): p for p in map(self._plain, system) if not p.is_zero()}
        if not left:
            self.count += 1
            self.exceeded |= self.count > _MOST_BRANCHES
            yield done
            return
        pieces = {key: self._factors(p) for key, p in left.items()}
        key = min(pieces, key=lambda k: (len(pieces[k]), sum(len(f) for f in pieces[k])))
        others = [p for k, p in left.items() if k != key]
        for factor in pieces[key]:
            yield from self._taken(factor, others, done)

    def _plain(self, p: Poly) -> Poly:
        return p if p.is_zero() else p // p.content()

    def _factors(self, p: Poly) -> list[Poly]:
        """Those that may vanish."""
        return [f for f, _ in p.factor()[1] if not self.tower.sign(f)]

    def _taken(self, factor: Poly, others: list[Poly], done: tuple[Step, ...]) -> Iterator[tuple[Step, ...]]:
        terms = factor.to_dict()
        even = all(n % 2 == 0 or i in self.tower.above_zero for m in terms for i, n in enumerate(m))
        if len(terms) > 1 and even and len({c > 0 for c in terms.values()}) == 1:
            # a sum of squares: every one of them
            yield from self.branches([*others, *(self.tower.ring.from_dict({m: 1}) for m in terms)], done)
            return
        for index in sorted(self.unknowns, key=lambda i: (i in self.tower.above_zero, i)):
            top, bottom = self._solved(factor, index)
            if bottom is None:
                continue
            if index in self.tower.above_zero and (top.is_zero() or self.tower.sign(top) * int(bottom) < 0):
                return
            yield from self.branches([self.put(p, index, top, bottom) for p in others], (*done, (index, top, bottom)))
            return
        if self._unreal(factor):
            return
        rest = [divmod(p, factor)[1] for p in others]
        yield from self.branches(rest, (*done, (None, factor, self.tower.one)))

    def _solved(self, factor: Poly, index: int) -> tuple[Poly, Any]:
        """numerator and whole denominator of an unknown that occurs linearly, with a number before it."""
        if factor.degrees()[index] != 1:
            return factor, None
        alone = [(m, c) for m, c in factor.to_dict().items() if m[index]]
        if len(alone) != 1 or sum(alone[0][0]) != 1:
            return factor, None
        number = alone[0][1]
        rest = factor - number * self.tower.unknowns[index]
        return -rest, number

    def put(self, p: Poly, index: int, top: Poly, bottom: Any) -> Poly:
        """A polynomial with an unknown replaced by a fraction, times a power of the denominator."""
        degree = p.degrees()[index]
        if not degree:
            return p
        total = self.tower.zero
        for monomial, c in p.to_dict().items():
            n = monomial[index]
            rest = self.tower.ring.from_dict({(*monomial[:index], 0, *monomial[index + 1 :]): c})
            total += rest * top**n * bottom ** (degree - n)
        return total

    def _unreal(self, factor: Poly) -> bool:
        """Whether a polynomial of one unknown has no real root (no positive one, if that is above zero)."""
        inside = [i for i, n in enumerate(factor.degrees()) if n]
        if len(inside) != 1 or inside[0] not in self.unknowns:
            return False
        polynomial = sp.Poly(self.tower.expression(factor), self.tower.meaning[inside[0]])
        low = 0 if inside[0] in self.tower.above_zero else None
        return bool(polynomial.count_roots(low, None) == 0)

    def least(self, branches: Sequence[tuple[Step, ...]]) -> list[tuple[Step, ...]]:
        """Without those that another one holds."""
        kept: list[tuple[Step, ...]] = []
        for branch in sorted(branches, key=len):
            if not any(self._holds(other, branch) for other in kept):
                kept.append(branch)
        return kept

    def _holds(self, wide: tuple[Step, ...], narrow: tuple[Step, ...]) -> bool:
        for index, top, bottom in wide:
            p = top if index is None else bottom * self.tower.unknowns[index] - top
            for other, above, below in narrow:
                p = divmod(p, above)[1] if other is None else self.put(p, other, above, below)
            if not p.is_zero():
                return False
        return True


def _equations(tower: Tower, branch: tuple[Step, ...]) -> tuple[Equation, ...]:
    """Each unknown is bound to what is still free."""
    solved: list[Equation] = []
    for index, top, bottom in reversed(branch):
        value = tower.expression(top) / (sp.Integer(int(bottom)) if index is not None else 1)
        value = sp.expand(value.subs({a: b for a, b in solved if a.is_Symbol}))
        solved.append((tower.meaning[index], value) if index is not None else (value, sp.S.Zero))
    return tuple(sorted(solved, key=lambda pair: str(pair[0])))
