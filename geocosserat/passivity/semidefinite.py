"""Whether a quadratic form of expressions is nowhere negative: exact for numbers, by boxes for functions, by minors.

A symmetric matrix is positive semidefinite if and only if the coefficients of det(s + S) are not negative, and if and
only if all its principal minors are not negative (R. A. Horn, C. R. Johnson, Matrix Analysis, 2nd ed., section 7.2).
"""

from __future__ import annotations

import math
import random
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import Any, Final, TypeAlias

import numpy as np
import sympy as sp
from flint import arb, arb_mat, fmpq, fmpq_mat

from geocosserat.derivation.notation import symbol
from geocosserat.passivity.balls import precision
from geocosserat.passivity.definite import is_definite
from geocosserat.passivity.points import enclosure
from geocosserat.passivity.vanish import Grade

Box: TypeAlias = Mapping[str, tuple[Fraction, Fraction]]
Rows: TypeAlias = Sequence[Sequence[sp.Expr]]

_BITS: Final = 128
_BOXES: Final = 3000
_SAMPLES: Final = 400
_WIDTHS: Final = tuple(Fraction(w) for w in (10, 10, 1, 10, 1000))  # where names without bounds are sampled
_EXACT_MINORS: Final = 3


@dataclass(frozen=True)
class FormAnswer:
    """semidefinite: whether x S x >= 0 for all x; None: not decided, or if ``conditions`` hold.

    margin: smallest eigenvalue of S, scaled: of S with unit diagonal, the least of those met if S varies; 0 if exactly
    singular. conditions: inequalities that hold together; None if there are none or none were found. direction, at: x
    with x S x < 0 and where, certified.
    """

    semidefinite: bool | None
    grade: Grade | None
    how: str
    margin: float | None = None
    scaled: float | None = None
    conditions: tuple[str, ...] | None = None
    direction: tuple[float, ...] | None = None
    at: Mapping[str, float] | None = None


def decide_form(rows: Rows, box: Box, unbounded: Collection[str], opened: Mapping[str, str]) -> FormAnswer:
    """Of a symmetric matrix (d, d) whose names lie in a box, or are ``unbounded``, or are open parameters.

    ``opened``: "real" or "positive". Raises TypeError for functions that are not known.
    """
    names = {x.name for row in rows for e in row for x in e.free_symbols}
    if names & set(opened):
        return _by_minors(rows, box, opened)
    if not names:
        return _constant(rows)
    used = {name: box[name] for name in sorted(names) if name in box}
    found = _refuted(rows, used, sorted(names - set(used)))
    if found is not None:
        return found
    margin, scaled = _least(rows, used, sorted(names - set(used)))
    if margin is None:
        return FormAnswer(None, None, f"no value at any of {_SAMPLES} random points")
    unclear = FormAnswer(None, None, "negative somewhere, it seems, but not enclosed there", margin, scaled)
    ways: dict[str, None] = {}
    for block in blocks(rows):
        part = [[rows[i][j] for j in block] for i in block]
        if all(e == 0 for row in part for e in row):
            continue
        free = {x.name for row in part for e in row for x in e.free_symbols} - set(used)
        if _by_signs(part, box):
            ways["no principal minor can be negative, by the signs of its factors"] = None
        elif not free and (covered := _covered(part, used)):
            if isinstance(covered, dict):
                return _refuted_at(rows, {**{name: low for name, (low, _) in used.items()}, **covered}) or unclear
            ways["positive definite on boxes that fill the domain"] = None
        else:
            return FormAnswer(True, "sampled", f"no negative value at {_SAMPLES} random points", margin, scaled)
    return FormAnswer(True, "proved", "; ".join(ways), margin, scaled)


# numbers


def _constant(rows: Rows) -> FormAnswer:
    floats = np.array([[float(e) for e in row] for row in rows])
    margin, scaled = _eigenvalue(floats), _unit(floats)
    exact = _rationals(rows)
    if exact is None:
        with precision(_BITS):
            balls = _balls(rows, {})
            if is_definite(balls):
                return FormAnswer(True, "proved", "positive definite, enclosed in balls", margin, scaled)
            direction = _negative(balls)
        if direction is not None:
            return FormAnswer(False, "proved", "negative in a direction, enclosed in balls", margin, scaled,
                              direction=direction, at={})  # fmt: skip
        return FormAnswer(None, None, "no rational numbers, and too near to singular to enclose", margin, scaled)
    coefficients = _characteristic(exact)
    if all(c >= 0 for c in coefficients):
        if coefficients[-1] == 0:
            return FormAnswer(True, "proved", "positive semidefinite and singular, in exact numbers", 0.0, 0.0)
        return FormAnswer(True, "proved", "positive definite, in exact numbers", margin, scaled)
    direction = _negative_exactly(exact, floats)
    return FormAnswer(False, "proved", "a coefficient of the characteristic polynomial is negative, in exact numbers",
                      margin, scaled, direction=direction, at={})  # fmt: skip


def _rationals(rows: Rows) -> Any:
    if not all(e.is_Rational for row in rows for e in row):
        return None
    return fmpq_mat([[fmpq(int(e.p), int(e.q)) for e in row] for row in rows])


def _characteristic(matrix: Any) -> list[Any]:
    """Coefficients of det(s + S), from s^d down (Faddeev and LeVerrier)."""
    n = matrix.nrows()
    one = fmpq_mat([[fmpq(int(i == j)) for j in range(n)] for i in range(n)])
    coefficients, power, negative = [fmpq(1)], fmpq_mat(n, n), matrix * fmpq(-1)
    for k in range(1, n + 1):
        power = negative * power + one * coefficients[-1]
        product = negative * power
        trace = fmpq(0)
        for i in range(n):
            trace += product[i, i]
        coefficients.append(-trace / k)
    return coefficients


def _negative_exactly(matrix: Any, floats: Any) -> tuple[float, ...] | None:
    for direction in _directions(floats):
        x = fmpq_mat([[fmpq(*float(v).as_integer_ratio())] for v in direction])
        if (x.transpose() * matrix * x)[0, 0] < 0:
            return direction
    return None


def _directions(floats: Any) -> Iterator[tuple[float, ...]]:
    """Of the smallest eigenvalue, of the matrix and of it with a unit diagonal, and of 2 x 2 blocks."""
    if not np.isfinite(floats).all():
        return
    size = np.sqrt(np.where(np.diag(floats) != 0, np.abs(np.diag(floats)), 1.0))
    for scale in (np.ones(len(size)), size):
        _, vectors = np.linalg.eigh(floats / scale[:, None] / scale)
        yield tuple(float(v) for v in vectors[:, 0] / scale)
    for i, j in combinations(range(len(floats)), 2):
        if floats[i, j]:
            # a coupling to what has no friction of its own
            out = np.zeros(len(floats))
            big = 1.0 + abs(floats[j, j] / floats[i, j])
            out[i], out[j] = -math.copysign(big, floats[i, j]), 1.0
            yield tuple(out.tolist())
            out[i], out[j] = 1.0, -math.copysign(1.0 + abs(floats[i, i] / floats[i, j]), floats[i, j])
            yield tuple(out.tolist())


def _eigenvalue(floats: Any) -> float:
    return float(np.linalg.eigvalsh(floats)[0])


def _unit(floats: Any) -> float:
    """Of the matrix with unit diagonal; 0 where an entry of the diagonal is not positive."""
    diagonal = np.diag(floats)
    if not (diagonal > 0).all():
        return 0.0
    size = np.sqrt(diagonal)
    return _eigenvalue(floats / size[:, None] / size)


# functions


def _balls(rows: Rows, values: Mapping[str, arb]) -> Any:
    seen: dict[sp.Expr, arb] = {}
    return arb_mat([[enclosure(e, values, seen) for e in row] for row in rows])


def _ball(x: Fraction) -> arb:
    return arb(fmpq(x.numerator, x.denominator))


def _points(box: Box, free: Sequence[str]) -> Iterator[dict[str, Fraction]]:
    chance = random.Random(1)
    ends = dict(box)
    for k in range(_SAMPLES):
        wide = _WIDTHS[k % len(_WIDTHS)]
        ends |= {name: (Fraction(0) if name == "t" else -wide, wide) for name in free}
        share = {name: Fraction(chance.randrange(0, 98), 97) for name in ends}
        if k < 2:
            share = dict.fromkeys(ends, Fraction(k))
        yield {name: low + share[name] * (high - low) for name, (low, high) in ends.items()}


def _refuted(rows: Rows, box: Box, free: Sequence[str]) -> FormAnswer | None:
    with precision(_BITS):
        return next((found for point in _points(box, free) if (found := _refuted_at(rows, point))), None)


def _refuted_at(rows: Rows, point: Mapping[str, Fraction]) -> FormAnswer | None:
    with precision(_BITS):
        balls = _balls(rows, {name: _ball(x) for name, x in point.items()})
        direction = _negative(balls)
        if direction is None:
            return None
        at = {name: float(x) for name, x in point.items()}
        where = ", ".join(f"{name} = {x:.6g}" for name, x in at.items())
        return FormAnswer(False, "proved", f"negative in a direction at {where}, enclosed in balls",
                          _eigenvalue(_floats(balls)), direction=direction, at=at)  # fmt: skip


def _negative(balls: Any) -> tuple[float, ...] | None:
    """x with x S x < 0 for every S in a ball matrix."""
    floats = _floats(balls)
    for direction in _directions(floats):
        x = arb_mat([[arb(v)] for v in direction])
        if (x.transpose() * balls * x)[0, 0] < 0:
            return direction
    return None


def _floats(balls: Any) -> Any:
    return np.array([[float(x.mid()) if x.is_finite() else math.nan for x in row] for row in balls.tolist()])


def _least(rows: Rows, box: Box, free: Sequence[str]) -> tuple[float | None, float | None]:
    margins, scaled = [], []
    with precision(64):
        for k, point in enumerate(_points(box, free)):
            if k >= 100:
                break
            floats = _floats(_balls(rows, {name: _ball(x) for name, x in point.items()}))
            if np.isfinite(floats).all():
                margins.append(_eigenvalue(floats))
                scaled.append(_unit(floats))
    return (min(margins), min(scaled)) if margins else (None, None)


def _covered(rows: Rows, box: Box) -> bool | dict[str, Fraction]:
    """Whether the matrix is proved definite on each of a number of boxes that are the whole together; a point where it
    is not semidefinite, if one is met on the way."""
    names = {x.name for row in rows for e in row for x in e.free_symbols}
    waiting = [{name: ends for name, ends in box.items() if name in names}]
    with precision(_BITS):
        for _ in range(_BOXES):
            if not waiting:
                return True
            part = waiting.pop()
            if is_definite(_balls(rows, {name: _ball(a).union(_ball(b)) for name, (a, b) in part.items()})):
                continue
            if not part:
                return False
            centre = {name: (a + b) / 2 for name, (a, b) in part.items()}
            if _refuted_at(rows, centre) is not None:
                return centre
            name = max(part, key=lambda n: part[n][1] - part[n][0])
            low, high = part[name]
            middle = (low + high) / 2
            waiting += [{**part, name: (low, middle)}, {**part, name: (middle, high)}]
    return False


def _by_signs(rows: Rows, box: Box) -> bool:
    """Whether no principal minor is negative by the signs of its factors: for up to three rows."""
    if len(rows) > _EXACT_MINORS:
        return False
    signs = {symbol(name): sp.Symbol(name, nonnegative=True) for name, (low, _) in box.items() if low >= 0}
    signs[symbol("t")] = sp.Symbol("t", nonnegative=True)
    for minor in _minors(rows, range(len(rows))):
        e = minor.xreplace(signs)
        if (sp.factor(e) if e.is_polynomial() else e).is_nonnegative is not True:
            return False
    return True


# minors


def blocks(rows: Rows) -> list[list[int]]:
    """Indices that are coupled."""
    left, out = list(range(len(rows))), list[list[int]]()
    while left:
        block = [left.pop(0)]
        for i in block:
            near = [j for j in left if rows[i][j] != 0 or rows[j][i] != 0]
            block += near
            left = [j for j in left if j not in near]
        out.append(sorted(block))
    return out


def _minors(rows: Rows, block: Sequence[int], leading: bool = False) -> Iterator[sp.Expr]:
    for k in range(1, len(block) + 1):
        for which in [block[:k]] if leading else combinations(block, k):
            yield sp.Matrix([[rows[i][j] for j in which] for i in which]).det(method="berkowitz")


def _by_minors(rows: Rows, box: Box, opened: Mapping[str, str]) -> FormAnswer:
    """Conditions on open parameters: not negative for blocks of up to three, else positive definite."""
    names = {x for row in rows for e in row for x in e.free_symbols}
    signs = {x: sp.Symbol(x.name, positive=True) for x in names if opened.get(x.name) == "positive"}
    signs |= {x: sp.Symbol(x.name, nonnegative=True) for x in names if x.name in box and box[x.name][0] >= 0}
    signs |= {x: sp.Symbol(x.name, nonnegative=True) for x in names if x.name == "t"}
    varying = sorted(x.name for x in names if x.name not in opened)
    texts: dict[str, None] = {}
    strict = False
    for block in blocks(rows):
        large = len(block) > _EXACT_MINORS
        strict |= large
        for minor in _minors(rows, block, leading=large):
            e = sp.factor(minor.xreplace(signs))
            if e.is_positive or (e.is_nonnegative and not large):
                continue
            if e.is_negative:
                return FormAnswer(False, "proved", f"a principal minor, {e}, is negative for all values", conditions=())
            if large and e.is_nonpositive:
                return FormAnswer(None, None, f"not definite: a leading principal minor, {e}, is not positive")
            texts[f"{_plain(e)} {'>' if large else '>='} 0"] = None
    if not texts:
        return FormAnswer(True, "proved", "no principal minor can be negative, by the signs of its factors")
    where = f", for all {', '.join(varying)}" if varying else ""
    how = ("positive definite if and only if its leading principal minors are positive" if strict
           else "positive semidefinite if and only if no principal minor is negative")  # fmt: skip
    return FormAnswer(None, "proved", how + where, conditions=tuple(t + where for t in texts))


def _plain(e: sp.Expr) -> sp.Expr:
    """Without factors that are positive."""
    number, rest = e.as_coeff_Mul()
    left = [f for f in sp.Mul.make_args(rest) if not f.is_positive]
    out = sp.Mul(-1 if number < 0 else 1, *left)
    return sp.expand(out) if len(left) == 1 else out
