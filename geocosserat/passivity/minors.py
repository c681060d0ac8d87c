"""Conditions on open parameters under which a tangent is definite and its eigenvalues have positive real parts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import sympy as sp
from sympy.polys.matrices import DomainMatrix

from geocosserat.derivation.convert import to_sympy
from geocosserat.model.expressions import ExpressionError, Number, fixed
from geocosserat.model.law import Matrix, Sign
from geocosserat.passivity.definite import characteristic, hurwitz
from geocosserat.passivity.tangent import Tangent, blocks, part, parts, symmetric

_MOST_NODES: Final = 400
_MOST_RATES: Final = 3
_MOST_DENSE: Final = 3
_MOST_OPEN: Final = 4
_MOST_TERMS: Final = 60


@dataclass(frozen=True)
class Conditions:
    """Inequalities that all have to hold, as texts ("k1*k2 - a**2/4 > 0"); () if they hold for all values, None if not
    found. ``never``: one of them is the negative of what is known. ``where``: "everywhere" or "at the reference"."""

    inequalities: tuple[str, ...] | None
    never: bool
    where: str
    reason: str = ""


def conditions(tangent: Tangent, opened: Mapping[str, Sign]) -> tuple[Conditions, Conditions]:
    """Under which sym T is positive definite, and all eigenvalues of friction^-1 T have positive real parts.

    Leading principal minors of the coupled blocks; Hurwitz's determinants for blocks of up to three. Exact for a
    tangent that does not depend on the strain; else at the reference, where they are necessary.
    """
    where = "at the reference" if tangent.variables else "everywhere"
    t, f = (_rested(m, tangent) for m in (tangent.matrix, tangent.friction))
    nodes = sum(1 for m in (t, f) for _ in parts(e for row in m for e in row))
    if nodes > _MOST_NODES:
        missing = Conditions(None, False, where, "the tangent is too long for its minors to be read")
        return missing, missing
    return _found(_definite, t, f, opened, where), _found(_positive, t, f, opened, where)


def _found(kind: Any, t: Matrix, f: Matrix, opened: Mapping[str, Sign], where: str) -> Conditions:
    try:
        quantities = kind(t, f)
    except (ExpressionError, _TooLargeError) as error:
        return Conditions(None, False, where, str(error))
    texts, never = [], False
    for quantity in quantities:
        text = quantity if isinstance(quantity, str) else _positive_text(quantity, opened)
        if text is False:
            never = True
        elif text is not True and text not in texts:
            texts.append(text)
    return Conditions(tuple(texts), never, where)


class _TooLargeError(Exception):
    """A block too large for conditions that anyone would read."""


def _definite(t: Matrix, f: Matrix) -> list[sp.Expr | str]:
    """Leading principal minors, but for those that nobody would read: they are named."""
    del f
    halves = symmetric(t)
    found: list[sp.Expr | str] = []
    for block in blocks(halves):
        matrix = sp.Matrix([[to_sympy(e) for e in row] for row in part(halves, block)])
        last = len(block) if len(matrix.free_symbols) <= _MOST_OPEN else min(len(block), _MOST_DENSE)
        if last < len(block):
            rows = ", ".join(str(i + 1) for i in block)
            found.append(f"leading principal minors {last + 1} to {len(block)} of sym T in rows {rows} > 0")
        for k in range(1, last + 1):
            minor = DomainMatrix.from_Matrix(matrix[:k, :k]).to_field()
            found.append(minor.domain.to_sympy(minor.det()))
    return found


def _positive(t: Matrix, f: Matrix) -> list[sp.Expr]:
    found = []
    d = range(len(t))
    pattern = tuple(tuple(t[i][j] if f[i][j] == Number(0.0) else f[i][j] for j in d) for i in d)
    for block in blocks(pattern):
        if len(block) > _MOST_RATES:
            raise _TooLargeError(f"{len(block)} coupled strains: Hurwitz's determinants are too long to be read")
        stiff, drag = (sp.Matrix([[to_sympy(e) for e in row] for row in part(m, block)]) for m in (t, f))
        if drag.det() == 0:
            raise _TooLargeError("the friction is singular")
        coefficients = characteristic((drag.inv() * stiff).tolist())
        # the last determinant is the one before it times the last coefficient
        found += [*hurwitz(coefficients)[:-1], coefficients[-1]]
    return found


def _positive_text(quantity: sp.Expr, opened: Mapping[str, Sign]) -> str | bool:
    """The condition quantity > 0, without the factors that are known to be positive; True if nothing is left of it,
    False if it cannot hold."""
    signs = {s: sp.Symbol(s.name, positive=True) for s in quantity.free_symbols if opened.get(s.name) == "positive"}
    signed = (sp.S.Zero + quantity).xreplace(signs)
    factored = sp.factor(signed) if len(sp.Add.make_args(signed)) <= _MOST_TERMS else signed
    if factored.is_positive:
        return True
    if factored.is_nonpositive:
        return False
    coefficient, factors = factored.as_coeff_mul()
    left = [x for x in factors if not x.is_positive]
    sign = -1 if coefficient < 0 else 1
    # numbers that multiply a sum only blur it
    numbers = [x for x in left if x.is_Add]
    rest = sp.Mul(sign, *left) if len(left) != 1 or not numbers else sp.expand(sign * left[0])
    if len(sp.Add.make_args(rest)) > _MOST_TERMS:
        return f"a polynomial of {len(sp.Add.make_args(rest))} terms > 0"
    return f"{rest} > 0"


def _rested(matrix: Matrix, tangent: Tangent) -> Matrix:
    rows = matrix
    for r in tangent.ranges:
        rows = tuple(tuple(fixed(e, r.name, r.rest) for e in row) for row in rows)
    return rows
