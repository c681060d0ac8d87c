"""Energy densities by integration along the axes or along rays, and the split of a stress that has none."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import sympy as sp

from geocosserat.passivity.antiderivative import Search, antiderivative
from geocosserat.passivity.readable import large_powers, readable, slope
from geocosserat.passivity.steps import continuous
from geocosserat.passivity.vanish import Grade, vanishes

_BASES: Final = (sp.S.Zero, sp.S.Half, -sp.S.Half)
_LONGEST: Final = 150
_SECONDS: Final = 1.5  # for the work along rays
_IN_ALL: Final = 4.0  # for all ways to an energy
_BAD: Final = (sp.zoo, sp.nan, sp.oo, -sp.oo, sp.I)


@dataclass(frozen=True)
class Energy:
    """density: force. grade: of the proof that its gradient is the stress. how: in words."""

    density: sp.Expr
    grade: Grade
    how: str


@dataclass(frozen=True)
class Split:
    """A stress as the gradient of an energy and a remainder. how: what the split is relative to."""

    energy: sp.Expr
    remainder: tuple[sp.Expr, ...]
    how: str


def energy_of(
    stress: Sequence[sp.Expr],
    strain: Sequence[sp.Symbol],
    reference: Sequence[sp.Expr],
    positive: Collection[str] = (),
    given: sp.Expr | None = None,
    accept: Callable[[sp.Expr], bool] = lambda density: True,
) -> Energy | None:
    """An energy density with that gradient, zero at the reference where it has a value there; None if none was found.

    What is returned was differentiated back. ``given``: a density that is tried first. ``accept``: whether a density
    will do (is regular where the stress is).
    """
    if given is not None and accept(given) and (found := _verified(given, stress, strain, positive, "as given")):
        return found
    turns = [sp.Dummy(x.name, real=True) for x in strain]
    moved = {x: c + d for x, c, d in zip(strain, reference, turns, strict=True)}
    shifted = [e.subs(moved, simultaneous=True) for e in stress]
    back = {d: x - c for x, c, d in zip(strain, reference, turns, strict=True)}
    seen: set[sp.Expr] = set()
    until = time.monotonic() + _IN_ALL
    for density, how in _candidates(shifted, turns, until):
        if how.endswith("base") and not large_powers(density):
            # counted from where the energy has a value, not from the reference: no constant of its own
            density = sp.expand(density).as_independent(*turns, as_Add=True)[1]
        if density in seen or density.has(*_BAD):
            continue
        seen.add(density)
        short = [readable(density, positive), readable(density.xreplace(back), positive)]
        written = min((short[0].xreplace(back), short[1]), key=lambda w: (sp.count_ops(w), len(str(w))))
        if accept(written) and (found := _verified(written, stress, strain, positive, how)):
            return found
    return None


def _verified(
    density: sp.Expr, stress: Sequence[sp.Expr], strain: Sequence[sp.Symbol], positive: Collection[str], how: str
) -> Energy | None:
    answer = vanishes([slope(density, x) - e for x, e in zip(strain, stress, strict=True)], positive)
    if answer.value is not True or answer.grade is None:
        return None
    return Energy(density, answer.grade, f"{how}, and differentiated back: {answer.how}")


def _candidates(
    stress: Sequence[sp.Expr], turns: Sequence[sp.Symbol], until: float
) -> Iterator[tuple[sp.Expr, str]]:
    n = len(turns)
    orders = [list(range(n)), list(reversed(range(n)))]
    # the components that depend on most come first, where the others are at rest
    orders.append(sorted(range(n), key=lambda i: len(stress[i].free_symbols & set(turns))))
    for base in _BASES:
        for order in orders:
            if time.monotonic() > until:
                return
            density = _along_axes(stress, turns, order, base, until)
            if density is not None:
                yield density, "integrated along the axes" if base == 0 else "integrated along the axes from a base"
        if base == 0 and (density := along_rays(stress, turns)) is not None:
            yield density, "integrated along the rays from the reference"


def _along_axes(
    stress: Sequence[sp.Expr], turns: Sequence[sp.Symbol], order: Sequence[int], base: sp.Expr, until: float
) -> sp.Expr | None:
    total = sp.S.Zero
    rest = dict[sp.Symbol, sp.Expr]()
    for i in order:
        x = turns[i]
        e = stress[i].subs(rest)
        if e.has(*_BAD):
            return None
        whole = antiderivative(e, x, Search(0, until)) if e != 0 else sp.S.Zero
        if whole is None:
            return None
        lower = whole.subs(x, base)
        if lower.has(*_BAD):
            return None
        total += whole - lower
        rest[x] = base
    return total


def along_rays(stress: Sequence[sp.Expr], turns: Sequence[sp.Symbol]) -> sp.Expr | None:
    """The work of the stress along the straight way from turns zero, int_0^1 stress(s d) . d ds; None if not found."""
    s = sp.Dummy("s", real=True)
    ray = {d: s * d for d in turns}
    work = sp.Add(*(e.subs(ray, simultaneous=True) * d for e, d in zip(stress, turns, strict=True)))
    if sp.count_ops(work) < 1500:
        work = sp.expand(work) if not large_powers(work) and work.is_polynomial(s) else work
    # lengths on a ray: sqrt(s**2 r) is s sqrt(r)
    work = work.replace(lambda e: e.is_Pow and e.base.is_Add and e.has(s), lambda e: sp.factor_terms(e.base) ** e.exp)
    work = work.subs(sp.Abs(s), s)
    whole = antiderivative(work, s, Search(0, time.monotonic() + _SECONDS)) if work != 0 else sp.S.Zero
    if whole is None:
        return None
    lower = whole.subs(s, 0)
    if lower.has(*_BAD):
        return None
    found = whole.subs(s, 1) - lower
    return None if found.has(*_BAD) else found


def split(
    stress: Sequence[sp.Expr],
    strain: Sequence[sp.Symbol],
    reference: Sequence[sp.Expr],
    positive: Collection[str] = (),
) -> Split | None:
    """The part of a stress that does all the work along rays from the reference, and the rest.

    Where the work along rays has no closed form that was found, the energy is that of the stress and the symmetric part
    of its tangent at the reference; None if the stress has no value there either.
    """
    turns = [sp.Dummy(x.name, real=True) for x in strain]
    moved = {x: c + d for x, c, d in zip(strain, reference, turns, strict=True)}
    back = {d: x - c for x, c, d in zip(strain, reference, turns, strict=True)}
    shifted = [e.subs(moved, simultaneous=True) for e in stress]
    energy = along_rays(shifted, turns)
    how = "relative to the rays from the reference, along which the energy does all the work"
    if energy is not None and (sp.count_ops(energy) > _LONGEST or not continuous(energy, turns, positive)):
        energy = None
    # a work that is regular may be written so that it is not: (1 - cos x) / x
    if energy is not None:
        energy = sp.expand_mul(energy)  # x log(x) / x is regular
        energy = None if any(energy.subs(x, 0).has(*_BAD) for x in turns) else energy
    if energy is not None:
        rest = [readable(e - slope(energy, d), positive) for e, d in zip(shifted, turns, strict=True)]
        along = sp.Add(*(r * d for r, d in zip(rest, turns, strict=True)))
        if sp.count_ops(along) > 2 * _LONGEST or vanishes([along], positive).value is not True:
            energy = None
    if energy is None:
        zero = dict.fromkeys(turns, 0)
        tangent = [[slope(e, d).subs(zero) for d in turns] for e in shifted]
        energy = sp.Add(
            *(e.subs(zero) * d for e, d in zip(shifted, turns, strict=True)),
            *((tangent[i][j] + tangent[j][i]) / 4 * a * b for i, a in enumerate(turns) for j, b in enumerate(turns)),
        )
        if energy.has(*_BAD):
            return None
        how = "relative to the stress and the symmetric part of the tangent at the reference"
        rest = [e - slope(energy, d) for e, d in zip(shifted, turns, strict=True)]
    return Split(
        readable(energy, positive).xreplace(back), tuple(readable(r, positive).xreplace(back) for r in rest), how
    )
