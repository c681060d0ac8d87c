"""Whether real functions vanish: refuted at a rational point, proved by a normal form, or said to be probable."""

from __future__ import annotations

import random
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final, Literal, TypeAlias

import sympy as sp
from flint import arb, fmpq

from geocosserat.passivity.balls import precision
from geocosserat.passivity.normal import normal_forms
from geocosserat.passivity.points import enclosure
from geocosserat.passivity.polynomials import NoForm

Grade: TypeAlias = Literal["proved", "probable", "sampled"]
Point: TypeAlias = Mapping[str, Fraction]

QUICK: Final = (64, 320)
LONG: Final = (1024, 4096, 12000)
POINTS: Final = 6
_TRIES: Final = 60
_WIDTHS: Final = tuple(Fraction(w) for w in ("1/2", "1/10", "2", "1", "1/100", "5"))
_MOST_SURFACES: Final = 24
_FLAT: Final = 500  # digits, or arguments of exponentials
_STEPS: Final = 97  # a prime, so that no point lies on a step at a round number


@dataclass(frozen=True)
class Answer:
    """value: whether all vanish identically where all are defined, None if not decided. grade: of that value.

    how: in words. point, entry: of a refutation, rational values of all symbols, and which expression (from 0) is
    proved not to be zero there.
    """

    value: bool | None
    grade: Grade | None
    how: str
    point: Point | None = None
    entry: int | None = None


def vanishes(
    expressions: Sequence[sp.Expr],
    positive: Collection[str] = (),
    near: Mapping[str, Fraction] | None = None,
    within: Mapping[str, tuple[Fraction, Fraction]] | None = None,
    seed: int = 1,
    seconds: float = 4.0,
) -> Answer:
    """Whether real functions of real symbols all vanish identically, wherever all of them are defined.

    A step or modulus counts as both of its branches, its jump as nothing. ``positive``: names of symbols above zero.
    ``near``: where random points are drawn around (0, or 1 for what is positive, if not given); ``within``: closed
    intervals that they are kept to; a proof holds everywhere. ``seconds``: bound on the search for a normal form.
    Raises TypeError for functions that are not known.
    """
    entries = list(expressions)
    if all(e == 0 for e in entries):
        return Answer(True, "proved", f"{_count(entries)} that cancel{'s' if len(entries) == 1 else ''} term by term")
    points = list(_defined(entries, positive, near or {}, within or {}, random.Random(seed)))
    if not points:
        return Answer(None, None, f"no value of {_count(entries)} was found at {_TRIES} random points")
    stepped = any(e.has(sp.Abs, sp.sign, sp.Heaviside) for e in entries)
    if refuted := _refuted(entries, points, QUICK):
        return refuted
    try:
        tower, forms = normal_forms(entries, positive, seconds)
        if all(top.is_zero() for top, _ in forms):
            n = len(tower.rules)
            rules = f", {n} rule{'s' if n > 1 else ''}" if n else ""
            unknowns = f"{len(tower.meaning)} unknown{'s' if len(tower.meaning) != 1 else ''}"
            words = f"{_count(entries)} reduced to zero over {unknowns}{rules}"
            return Answer(True, "proved", f"normal form: {words}")
        # roots of squares are moduli, though they are not written so
        moduli = [m.args[0] for m in tower.meaning if isinstance(m, sp.Abs) and m.free_symbols]
        surfaces = [(x, p) for p in moduli for x in sorted(p.free_symbols, key=str) if _linear(p, x)]
        beside = [at for x, p in surfaces for q in points[:2] for at in _beside(q, x, p, positive, within or {})]
        if refuted := _refuted(entries, beside, QUICK):
            return refuted
        stepped = stepped or bool(moduli) or any(_of_functions(tower.meaning[i]) for i in tower.radicals)
    except NoForm:
        stepped = stepped or any(_of_symbols(part) for e in entries for part in e.atoms(sp.Pow, sp.log))
    if refuted := _refuted(entries, points, LONG):
        return refuted
    if stepped:
        # a branch that no point lies in may be another function
        return Answer(None, None, f"vanishes at {len(points)} random points, but steps were not separated")
    digits, flat = _digits(entries, points)
    if flat:
        return Answer(None, None, f"vanishes to {digits} digits at {len(points)} random points, but functions are flat")
    if digits < 30:
        return Answer(None, None, f"vanishes to {digits} digits only at {len(points)} random points")
    return Answer(True, "probable", f"vanishes to {digits} digits at {len(points)} random points; no normal form found")


def _count(entries: Sequence[sp.Expr]) -> str:
    return f"{len(entries)} entries" if len(entries) != 1 else "one entry"


def drawn(
    names: Sequence[str],
    positive: Collection[str],
    near: Mapping[str, Fraction],
    within: Mapping[str, tuple[Fraction, Fraction]],
    chance: random.Random,
    width: Fraction,
) -> dict[str, Fraction]:
    """A random rational point."""
    point = {}
    for name in names:
        step = Fraction(chance.randrange(1, _STEPS), _STEPS)
        low, high = within.get(name, (None, None))
        if low is not None and high is not None and high - low < 2 * width:
            point[name] = low + (high - low) * step
        elif name in positive:
            point[name] = near.get(name, Fraction(1)) * (1 + width * step)
        else:
            centre = near.get(name, Fraction(0))
            point[name] = centre + width * (2 * step - 1)
            if low is not None and high is not None:
                point[name] = min(max(point[name], low + width * step), high - width * step)
    return point


def _defined(
    entries: Sequence[sp.Expr],
    positive: Collection[str],
    near: Mapping[str, Fraction],
    within: Mapping[str, tuple[Fraction, Fraction]],
    chance: random.Random,
) -> Iterator[Point]:
    """Random points at which all entries have a value."""
    names = sorted({x.name for e in entries for x in e.free_symbols})
    found = 0
    surfaces = _surfaces(entries)
    for k in range(_TRIES):
        point = drawn(names, positive, near, within, chance, _WIDTHS[k % len(_WIDTHS)])
        # on both sides of every step, wherever it is
        sides = [moved for x, p in surfaces for moved in _beside(point, x, p, positive, within)] if k < 2 else []
        for here in [point, *sides]:
            with precision(QUICK[0]):
                if all(value.is_finite() for value in _values(entries, here)):
                    found += here is point
                    yield here
        if found >= POINTS:
            return


def _surfaces(entries: Sequence[sp.Expr]) -> list[tuple[sp.Symbol, sp.Expr]]:
    """What steps and moduli are of, with each symbol in which it is linear."""
    found: dict[tuple[sp.Symbol, sp.Expr], None] = {}
    for e in entries:
        for part in e.atoms(sp.Abs, sp.sign, sp.Heaviside):
            for x in sorted(part.args[0].free_symbols, key=str):
                if _linear(part.args[0], x):
                    found[(x, part.args[0])] = None
    return list(found)[:_MOST_SURFACES]


def _linear(p: sp.Expr, x: sp.Symbol) -> bool:
    return not p.has(sp.Abs, sp.sign, sp.Heaviside) and not sp.diff(p, x).has(x)


def _of_functions(root: sp.Expr) -> bool:
    """Whether a root is of functions, which may be squares of others: 1 - cos x."""
    return bool(root.args) and any(f.free_symbols for f in root.args[0].atoms(sp.Function, sp.Pow) if not _whole(f))


def _of_symbols(part: sp.Expr) -> bool:
    return not _whole(part) and bool(part.args[0].free_symbols)


def _whole(part: sp.Expr) -> bool:
    return bool(part.is_Pow and part.exp.is_Integer)


def _beside(
    point: Point,
    x: sp.Symbol,
    p: sp.Expr,
    positive: Collection[str],
    within: Mapping[str, tuple[Fraction, Fraction]],
) -> Iterator[dict[str, Fraction]]:
    """The point moved along x to both sides of p = 0, if that is allowed."""
    others = {
        y: sp.Rational(point[y.name].numerator, point[y.name].denominator) for y in p.free_symbols - {x}
    }
    slope, rest = sp.diff(p, x).subs(others), p.subs({**others, x: 0})
    if not slope.is_Rational or not rest.is_Rational or slope == 0:
        return
    root = Fraction(int((-rest / slope).p), int((-rest / slope).q))
    low, high = within.get(x.name, (None, None))
    for offset in (Fraction(3, 7), Fraction(-3, 7), Fraction(1, 101), Fraction(-1, 101)):
        at = root + offset
        if (low is None or at > low) and (high is None or at < high) and (at > 0 or x.name not in positive):
            yield {**point, x.name: at}


def _values(entries: Sequence[sp.Expr], point: Point) -> Iterator[arb]:
    balls = _balls(point)
    seen: dict[sp.Expr, arb] = {}
    return (enclosure(e, balls, seen) for e in entries)


def _balls(point: Point) -> dict[str, arb]:
    return {name: arb(fmpq(x.numerator, x.denominator)) for name, x in point.items()}


def _refuted(entries: Sequence[sp.Expr], points: Sequence[Point], rising: Sequence[int]) -> Answer | None:
    for bits in rising:
        for point in points:
            with precision(bits):
                for i, value in enumerate(_values(entries, point)):
                    if value.is_finite() and not value.contains(0):
                        shown = value.str(6, radius=False)
                        words = f"entry {i + 1} is {shown} at a rational point, enclosed with {bits} bits"
                        return Answer(False, "proved", words, point, i)
    return None


def _digits(entries: Sequence[sp.Expr], points: Sequence[Point]) -> tuple[int, bool]:
    """Digits after the point to which all entries are enclosed around zero, and whether any function is so flat, or so
    near to zero, at these points that what vanishes there need not vanish elsewhere: tanh(1000), x**10000."""
    worst, flat = arb(0), False
    with precision(LONG[-1]):
        for k, point in enumerate(points):
            seen: dict[sp.Expr, arb] = {}
            for e in entries:
                value = enclosure(e, _balls(point), seen)
                if k < 2:
                    worst = worst.max(value.abs_upper()) if value.is_finite() else arb("inf")
            flat = flat or any(_flat(part, value, seen) for part, value in seen.items())
        if not worst.is_finite() or worst > 1:
            return 0, flat
        if worst.is_zero():
            return LONG[-1], flat
        return int(float((-worst.log() / arb(10).log()).mid())), flat


def _flat(part: sp.Expr, value: arb, seen: Mapping[sp.Expr, arb]) -> bool:
    if part.func in (sp.tanh, sp.coth, sp.exp, sp.sech, sp.csch) and not abs(seen[part.args[0]]) < _FLAT:
        return True
    return bool(part.is_Pow and not value.contains(0) and abs(value) < arb(10) ** -_FLAT)
