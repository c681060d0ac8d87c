"""What happens where a stress steps: a loop across the step at two places may do net work.

A bounded stress that is curl-free on both sides of a surface p = 0 has a potential across it exactly if its jump is
normal to the surface, jump_i dp/dE_j = jump_j dp/dE_i: then the jump of the potential is constant along the surface.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from geocosserat.passivity.normal import Tower, normal_forms
from geocosserat.passivity.polynomials import NoForm, Poly
from geocosserat.passivity.ranges import Range, sign_on
from geocosserat.passivity.readable import to_expression

_PARTS = (sp.Abs, sp.sign, sp.Heaviside)


@dataclass(frozen=True)
class Steps:
    """surfaces: expressions that vanish where the stress or its slope steps. workless: whether all jumps are normal
    to their surfaces; None if that was not decided. how: in words."""

    surfaces: tuple[sp.Expr, ...]
    workless: bool | None
    how: str


def steps_of(
    stress: Sequence[sp.Expr], strain: Sequence[sp.Symbol], positive: Collection[str], box: Mapping[str, Range]
) -> Steps:
    """The surfaces of steps and kinks within a box, and whether the steps do no work."""
    names = set(strain)
    written = any(part.free_symbols & names for e in stress for part in e.atoms(*_PARTS))
    try:
        tower, forms = normal_forms(stress, positive)
    except NoForm:
        if written:
            return Steps((), None, "the steps were not separated: no normal form was found")
        if any(_may_hide(part, names) for e in stress for part in e.atoms(sp.Pow, sp.log)):
            return Steps((), None, "roots may hide steps: no normal form was found")
        return Steps((), True, "no steps are written")
    hidden = [p for p in _radicands(tower, names) if not _outside(p, box)]
    if hidden:
        return Steps((), None, f"the root of {hidden[0]} may hide a step")
    if (where := _otherwise_on(stress, strain, positive, box)) is not None:
        return Steps((), None, f"where {where} = 0 the law may differ from both sides: its steps are one half there")
    moduli = [m.args[0] for m in tower.meaning if isinstance(m, sp.Abs) and m.free_symbols & names]
    surfaces = [p for p in moduli if not _outside(p, box)]
    if not surfaces:
        return Steps((), True, "no steps")
    plain = [tower.expression(top) / tower.expression(bottom) for top, bottom in forms]
    for p in surfaces:
        if (fault := _fault(plain, p, strain, positive)) is not None:
            return Steps(tuple(surfaces), None if fault.startswith("not") else False, f"at {p} = 0: {fault}")
    count = f"{len(surfaces)} surface{'s' if len(surfaces) > 1 else ''}"
    how = f"the jumps are normal to {count}, by normal forms divided by what vanishes there"
    return Steps(tuple(surfaces), True, how)


def _otherwise_on(
    stress: Sequence[sp.Expr], strain: Sequence[sp.Symbol], positive: Collection[str], box: Mapping[str, Range]
) -> sp.Expr | None:
    """A surface of steps on which the stress is not proved to be the mean of what it is on both sides.

    The step of zero is one half: what is linear in steps is the mean there, but heaviside(x)**2 or heaviside(x**2) are
    not. A body may stay on a surface, as a straight rod does on that of no bending. Components along the normal of the
    surface do not matter.
    """
    names = set(strain)
    written = sorted({h.args[0] for e in stress for h in e.atoms(sp.Heaviside)}, key=sp.default_sort_key)
    inner = [e for e in written if e.free_symbols & names and not _outside(e, box)]
    if any(e.has(sp.Heaviside, sp.sign) for e in inner):
        return inner[0]
    try:
        for inside in inner:
            tower, [(top, _), *others] = normal_forms([inside, *written], positive, noting=False)
            surfaces = [(p, n) for p, n in top.factor()[1] if tower.expression(p).free_symbols & names]
            if any(n % 2 == 0 for _, n in surfaces):
                return inside
            for p, _ in surfaces:
                same = [e for e, (other, _) in zip(written, others, strict=True) if _divides(p, other)]
                if any(_not_mean(e, x, same, tower.expression(p), strain, positive)
                       for e, x in zip(stress, strain, strict=True)):  # fmt: skip
                    return inside
    except NoForm:
        return inner[0]
    return None


def _not_mean(
    e: sp.Expr,
    x: sp.Symbol,
    same: Sequence[sp.Expr],
    p: sp.Expr,
    strain: Sequence[sp.Symbol],
    positive: Collection[str],
) -> bool:
    """Whether a component of the stress, that along x, may differ from the mean where p = 0 and these steps turn."""
    if not p.free_symbols & (set(strain) - {x}):
        return False
    steps = {sp.Heaviside(inside): sp.Dummy() for inside in same}
    marked = e.xreplace(steps)
    used = [d for d in steps.values() if marked.has(d)]
    if not used:
        return False
    if not marked.is_polynomial(*used):
        return True
    above = [c for powers, c in sp.Poly(marked, *used).terms() if sum(powers) > 1]
    if not above:
        return False
    (surface, _), *forms = normal_forms([p, *above], positive, noting=False)[1]
    return any(not _divides(surface, top) or _divides(surface, bottom) for top, bottom in forms)


def _may_hide(part: sp.Expr, names: Collection[sp.Symbol]) -> bool:
    if part.is_Pow and part.exp.is_Integer:
        return False
    return bool(part.args[0].free_symbols & set(names))


def _radicands(tower: Tower, names: Collection[sp.Symbol]) -> Iterator[sp.Expr]:
    """What stands under roots and may vanish without a change of sign: 1 - cos x is a square, and its root a modulus.

    A polynomial without repeated factors changes its sign where it vanishes: there a root ends.
    """
    for index, _, inside in tower.rules:
        if index not in tower.radicals or isinstance(tower.meaning[index], sp.Abs):
            continue
        used = [tower.meaning[i] for i, n in enumerate(inside.degrees()) if n]
        functions = [m for m in used if not m.is_Symbol and not isinstance(m, sp.Abs) and m.free_symbols & set(names)]
        if functions and not _one_sign(tower, inside):
            yield tower.expression(inside)


def _one_sign(tower: Tower, p: Poly) -> bool:
    """Whether all terms of a polynomial have one sign, and one of them does not vanish, by what is above zero alone."""
    terms = p.to_dict()
    odd = any(n % 2 and i not in tower.above_zero for m in terms for i, n in enumerate(m))
    strict = any(all(i in tower.above_zero for i, n in enumerate(m) if n) for m in terms)
    return strict and not odd and len({c > 0 for c in terms.values()}) == 1


def _outside(p: sp.Expr, box: Mapping[str, Range]) -> bool:
    e = to_expression(p)
    return e is not None and sign_on(e, box) != 0


def _fault(
    stress: Sequence[sp.Expr], p: sp.Expr, strain: Sequence[sp.Symbol], positive: Collection[str]
) -> str | None:
    """What is wrong with the jump across p = 0; None if it is normal."""
    modulus = {part: part.args[0] for e in stress for part in e.atoms(sp.Abs) if part.args[0] in (p, -p)}
    above = [e.xreplace({part: p for part in modulus}) for e in stress]
    below = [e.xreplace({part: -p for part in modulus}) for e in stress]
    jump = [a - b for a, b in zip(above, below, strict=True)]
    normal = [sp.diff(p, x) for x in strain]
    entries = [
        jump[i] * normal[j] - jump[j] * normal[i]
        for i in range(len(strain))
        for j in range(i)
        if (normal[i] != 0 or normal[j] != 0)
    ]
    try:
        # both sides at once: nothing may be taken to be above zero on one of them
        tower, forms = normal_forms([p, *entries], positive, noting=False)
    except NoForm:
        return "not decided: no normal form of the jump"
    if not modulus or any(isinstance(m, sp.Abs) and m.args[0] in (p, -p) for m in tower.meaning):
        return "not decided: the sides were not told apart"
    # a component along the normal may be unbounded: a wall, or an energy that is steep there
    surface = forms[0][0]
    for top, bottom in forms[1:]:
        if not top.is_zero() and (not _divides(surface, top) or _divides(surface, bottom)):
            return "the jump is not proved to be normal to it"
    return None


def _divides(surface: object, p: object) -> bool:
    return bool(divmod(p, surface)[1].is_zero())  # type: ignore[operator]


def continuous(e: sp.Expr, strain: Sequence[sp.Symbol], positive: Collection[str]) -> bool:
    """Whether an expression is proved to be continuous across the surfaces where its steps and moduli turn."""
    names = set(strain)
    roots = any(_may_hide(part, names) for part in e.atoms(sp.Pow, sp.log))
    if not roots and not any(part.free_symbols & names for part in e.atoms(*_PARTS)):
        return True
    try:
        tower, [(top, bottom)] = normal_forms([e], positive)
        if any(True for _ in _radicands(tower, names)):
            return False
        plain = tower.expression(top) / tower.expression(bottom)
        for p in [m.args[0] for m in tower.meaning if isinstance(m, sp.Abs) and m.free_symbols & names]:
            if not any(part.args[0] in (p, -p) for part in plain.atoms(sp.Abs)):
                return False
            above, below = (
                plain.xreplace({part: side * p for part in plain.atoms(sp.Abs) if part.args[0] in (p, -p)})
                for side in (1, -1)
            )
            forms = normal_forms([p, above - below], positive, noting=False)[1]
            (surface, _), (jump, under) = forms
            if not jump.is_zero() and (not _divides(surface, jump) or _divides(surface, under)):
                return False
    except NoForm:
        return False
    return True
