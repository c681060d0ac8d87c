"""The wrench of a law as a one-form on the group: its brackets, its period in the angle, steps of potentials."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import Final

import sympy as sp

from geocosserat.algebra.groups import Group
from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.notation import T, symbol
from geocosserat.model.expressions import Expression
from geocosserat.model.law import Law
from geocosserat.passivity.configuration import along_fields, free
from geocosserat.passivity.regular import Singular, numbers_in, singular, singular_factors, symbols_of
from geocosserat.passivity.vanish import vanishes

THETA: Final = symbol("theta")


@dataclass(frozen=True)
class Form:
    """The wrench with numbers for what has a value: as expressions, and exact."""

    group: Group
    written: tuple[Expression, ...]
    components: tuple[sp.Expr, ...]
    opened: Collection[str]
    positive: Collection[str]
    singular: tuple[Singular, ...] = ()
    counted: bool = False  # not of period 2 pi in theta: a full turn is no closed loop

    @property
    def steps(self) -> tuple[Singular, ...]:
        return tuple(s for s in self.singular if s.kind == "step")

    @property
    def holes(self) -> tuple[Singular, ...]:
        return tuple(s for s in self.singular if s.kind != "step")

    @property
    def timed(self) -> bool:
        return any(T in e.free_symbols for e in self.components)


def form_of(law: Law) -> Form | None:
    """The wrench of a law, None if it has none. Raises ExpressionError if a component is nowhere defined."""
    if law.wrench is None:
        return None
    positive = {name for name, sign in law.open.items() if sign == "positive"}
    written = tuple(numbers_in(e, dict(law.parameters)) for e in law.wrench)
    form = Form(law.group, written, tuple(to_sympy(e) for e in written), set(law.open), positive)
    return replace(form, singular=singular(form.group, written, positive), counted=not _periodic(form))


def brackets(group: Group, wrench: Sequence[sp.Expr]) -> list[sp.Expr]:
    """X_a[j_b] - X_b[j_a] - C_abc j_c for a < b, in unknowns that nothing binds: d (d - 1) / 2 expressions."""
    slopes = [along_fields(group, j) for j in wrench]
    d, structure = group.dimension, group.structure
    out = []
    for a in range(d):
        for b in range(a + 1, d):
            turned = sp.Add(*(int(structure[a, b, c]) * wrench[c] for c in range(d)))
            out.append(free(group, slopes[b][a] - slopes[a][b] - turned))
    return out


def over_a_turn(e: sp.Expr) -> sp.Expr:
    """What is added over a full turn in the plane."""
    return e.xreplace({THETA: THETA + 2 * sp.pi}) - e


def _periodic(form: Form) -> bool:
    """Whether the law is of period 2 pi in theta; True if that is not refuted, and not asked of what is."""
    if all(THETA not in e.free_symbols for e in form.components):
        return True
    return vanishes([over_a_turn(e) for e in form.components], form.positive).value is not False


def known_factors(form: Form) -> frozenset[sp.Expr]:
    names = symbols_of(form.group)
    return frozenset().union(*(singular_factors(e, names) for e in form.components))


def continuous(group: Group, energy: sp.Expr) -> bool:
    """Whether a potential is proved to be continuous across each of its steps."""
    stepped = energy.atoms(sp.Heaviside, sp.sign)
    for step in stepped:
        inside = step.args[0]
        one = sp.Dummy()
        written = energy.xreplace({step: one})
        above = 1
        below = 0 if step.func is sp.Heaviside else -1
        jump = sp.expand(written.xreplace({one: sp.Integer(above)}) - written.xreplace({one: sp.Integer(below)}))
        if not _vanishes_on(group, jump, inside):
            return False
    return True


def _vanishes_on(group: Group, jump: sp.Expr, inside: sp.Expr) -> bool:
    """Whether the jump is zero wherever ``inside`` is: solved for a coordinate, or a multiple of it."""
    for x in symbols_of(group)[: group.space] if group.rotations == 3 else symbols_of(group):
        if inside.is_polynomial(x) and sp.degree(inside, x) == 1:
            slope = inside.coeff(x, 1) if inside.is_Add or inside.is_Mul or inside.is_Symbol else None
            if slope is not None and slope.is_number:
                there = -(inside - slope * x) / slope
                return vanishes([free(group, jump.subs(x, there))]).value is True
    top, _ = sp.fraction(sp.together(jump))
    names = sorted((jump.free_symbols | inside.free_symbols), key=str)
    if not (top.is_polynomial(*names) and inside.is_polynomial(*names)):
        return False
    return bool(sp.rem(top, inside, *names) == 0)
