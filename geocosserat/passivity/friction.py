"""Whether friction and viscous stresses only ever take energy away.

Friction j = -Γ V does the work -V Γ V: what matters is the symmetric part of Γ; the skew part does no work. A viscous
stress, Σ_v = Σ(E, E') - Σ(E, 0) with the rates E' of the turn, gives no energy if and only if Σ_v E' >= 0.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

import sympy as sp
from flint import arb, fmpq

from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.notation import symbol
from geocosserat.model.law import Law, rates
from geocosserat.passivity.balls import precision, rational
from geocosserat.passivity.points import enclosure
from geocosserat.passivity.regular import numbers_in
from geocosserat.passivity.semidefinite import Box, FormAnswer, decide_form
from geocosserat.passivity.vanish import Grade, vanishes

LENGTH: Final[tuple[Fraction, Fraction]] = (Fraction(0), Fraction(1))
"""Where u is taken to lie: a law does not know the length of the rod."""

_ASSUMED: Final = "u is taken from 0 to 1"
_SAMPLES: Final = 600


@dataclass(frozen=True)
class FrictionAnswer:
    """dissipative: whether no motion gains energy; None: not decided, or if ``conditions`` hold (all of them).

    margin: smallest eigenvalue of the symmetric part, whose entries differ in dimension (of Γ: force x time / length²,
    force x time / length, force x time); scaled: of the same with unit diagonal, a pure number from 0 to 1. If the
    matrix varies, the least of those met. skew: entries of the skew part, as texts, which do no work; () if there are
    none. direction, at: a twist (or rate of the turn) that gains energy, and where. assumptions: what was assumed.
    """

    dissipative: bool | None
    grade: Grade | None
    how: str
    margin: float | None = None
    scaled: float | None = None
    skew: tuple[str, ...] = ()
    conditions: tuple[str, ...] | None = None
    direction: tuple[float, ...] | None = None
    at: Mapping[str, float] | None = None
    assumptions: tuple[str, ...] = ()


def friction_answer(law: Law) -> FrictionAnswer | None:
    """The answer for the friction of a law; None if it has none.

    Raises ExpressionError if an entry is nowhere defined, TypeError for functions that are not known.
    """
    if law.friction is None:
        return None
    values = dict(law.parameters)
    matrix = [[to_sympy(numbers_in(e, values)) for e in row] for row in law.friction]
    return _of_form(matrix, law.group.twist, {"u": LENGTH}, law)


def viscous_answer(law: Law) -> FrictionAnswer | None:
    """The answer for the part of the stress that depends on the rates of the turn; None if there is none.

    Raises ExpressionError if a component is nowhere defined, TypeError for functions that are not known.
    """
    if law.stress is None or not law.viscous:
        return None
    values = dict(law.parameters)
    stress = [to_sympy(numbers_in(e, values)) for e in law.stress]
    speeds = [symbol(name) for name in rates(law.group)]
    still = dict.fromkeys(speeds, sp.S.Zero)
    viscous = [e - e.xreplace(still) for e in stress]
    positive = {name for name, sign in law.open.items() if sign == "positive"}
    matrix = [[e.diff(x) for x in speeds] for e in viscous]
    bends = [entry.diff(x) for row in matrix for entry in row for x in speeds]
    if any(e.has(sp.nan, sp.zoo) for e in viscous):
        return FrictionAnswer(None, None, "the stress has no value at rest: its viscous part is not told apart")
    if any(e.has(sp.DiracDelta, sp.Heaviside, sp.sign) for row in matrix for e in row):
        return _nonlinear(viscous, speeds, law)
    plain = not any(_written(part, speeds) for e in viscous for part in e.atoms(sp.Pow, sp.Function))
    if plain and vanishes(bends, positive).value is True:
        linear = [[e.xreplace(still) for e in row] for row in matrix]
        return _of_form(linear, law.group.strain, _domain(law), law)
    return _nonlinear(viscous, speeds, law)


def _written(part: sp.Expr, speeds: Sequence[sp.Symbol]) -> bool:
    """Whether a function of rates is written, which may hide steps that no slope shows."""
    whole = part.is_Pow and part.exp.is_Integer and part.exp > 0
    return not whole and bool(part.free_symbols & set(speeds))


def _domain(law: Law) -> Box:
    return {"u": LENGTH, **{name: (rational(low), rational(high)) for name, (low, high) in law.domain.items()}}


def _of_form(matrix: Sequence[Sequence[sp.Expr]], names: Sequence[str], box: Box, law: Law) -> FrictionAnswer:
    d = range(len(matrix))
    positive = {name for name, sign in law.open.items() if sign == "positive"}
    symmetric = [[(matrix[i][j] + matrix[j][i]) / 2 for j in d] for i in d]
    used = {x.name for row in matrix for e in row for x in e.free_symbols}
    form = decide_form(symmetric, box, used - set(box) - set(law.open), law.open)
    skew = []
    for i in d:
        for j in range(i + 1, len(matrix)):
            entry = (matrix[i][j] - matrix[j][i]) / 2
            if entry != 0 and vanishes([entry], positive).value is not True:
                skew.append(f"{names[i]}, {names[j]}: {entry}")
    return _answer(form, tuple(skew), used)


def _answer(form: FormAnswer, skew: tuple[str, ...], used: set[str]) -> FrictionAnswer:
    return FrictionAnswer(
        form.semidefinite, form.grade, form.how, form.margin, form.scaled, skew, form.conditions, form.direction,
        form.at, (_ASSUMED,) if "u" in used else (),
    )  # fmt: skip


def _nonlinear(viscous: Sequence[sp.Expr], speeds: Sequence[sp.Symbol], law: Law) -> FrictionAnswer:
    """Term by term where each is of one sign; a point where the power is negative; else sampled."""
    power = sp.expand(sp.Add(*(e * x for e, x in zip(viscous, speeds, strict=True))))
    used = {x.name for x in power.free_symbols}
    assumed = (_ASSUMED,) if "u" in used else ()
    signs = {symbol(name): sp.Symbol(name, positive=True) for name, sign in law.open.items() if sign == "positive"}
    box = _domain(law)
    signs |= {symbol(name): sp.Symbol(name, nonnegative=True) for name, (low, _) in box.items() if low >= 0}
    signs[symbol("t")] = sp.Symbol("t", nonnegative=True)
    if all(_not_negative(term.xreplace(signs), speeds) for term in sp.Add.make_args(power)):
        how = "the power is a sum of terms that cannot be negative"
        return FrictionAnswer(True, "proved", how, assumptions=assumed)
    points = _sampled(power, box, law)
    negative = next(points, None)
    if negative is not None:
        if not used & set(law.open):
            direction = tuple(negative.get(x.name, 0.0) for x in speeds)
            at = {name: x for name, x in negative.items() if symbol(name) not in speeds}
            how = "negative power at a rational point, enclosed in balls"
            return FrictionAnswer(False, "proved", how, direction=direction, at=at, assumptions=assumed)
        return FrictionAnswer(None, None, "negative power for some values of the open parameters", assumptions=assumed)
    if used & set(law.open):
        return FrictionAnswer(None, None, "nonlinear in the rates, with open parameters", assumptions=assumed)
    how = f"nonlinear in the rates: no negative power at {_SAMPLES} random points"
    return FrictionAnswer(True, "sampled", how, assumptions=assumed)


def _not_negative(term: sp.Expr, speeds: Sequence[sp.Symbol]) -> bool:
    """By the signs of factors, and rate times an odd growing function of it."""
    if term.is_nonnegative:
        return True
    for x in speeds:
        for f in term.atoms(sp.tanh, sp.sinh):
            inner, rest = f.args[0], term / f
            slope = inner / x
            # f(c x) has the sign of x if c is positive
            if x not in slope.free_symbols and slope.is_positive and (rest * x).is_nonnegative:
                return True
    return False


def _sampled(power: sp.Expr, box: Box, law: Law) -> Iterator[dict[str, float]]:
    """Points at which the power is negative."""
    chance = random.Random(1)
    names = sorted(x.name for x in power.free_symbols)
    positive = {name for name, sign in law.open.items() if sign == "positive"}
    with precision(128):
        for k in range(_SAMPLES):
            width = (Fraction(1), Fraction(1, 10), Fraction(10), Fraction(1000))[k % 4]
            point = {}
            for name in names:
                share = Fraction(chance.randrange(1, 97), 97)
                if name in box:
                    low, high = box[name]
                    point[name] = low + share * (high - low)
                elif name in positive or name == "t":
                    point[name] = width * share
                else:
                    point[name] = width * (2 * share - 1)
            value = enclosure(power, {n: arb(fmpq(x.numerator, x.denominator)) for n, x in point.items()}, {})
            if value < 0:
                yield {name: float(x) for name, x in point.items()}
