"""Bases of linear equations that need no computing: the rod at rest, and the straight rod under an end load."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from geocosserat.derivation.distribute import distributed
from geocosserat.derivation.elimination import put_in
from geocosserat.derivation.linear import Base
from geocosserat.derivation.notation import T, U, is_field
from geocosserat.derivation.operators import LinearSystem, between_steps
from geocosserat.derivation.records import EndConditions
from geocosserat.model.expressions import symbols


@dataclass(frozen=True)
class KnownBase:
    """``heading``, ``words``: which it is. ``values``: of its fields; ``still``: derivatives of others that vanish."""

    heading: str
    words: str
    values: Mapping[sp.Expr, sp.Expr]
    still: Mapping[sp.Expr, sp.Expr]

    def of(self, system: LinearSystem) -> LinearSystem:
        """The linear equations about this base."""
        return system.each(lambda e: distributed(between_steps(put_in(e, self.values).xreplace(self.still))))


def known_base(base: Base) -> KnownBase | None:
    """The base that the scene has of its own, None where it would have to be computed."""
    equations = base.equations
    ends = (equations.left, equations.right)
    moves = any(T in e.free_symbols for e in equations.reference)
    if moves or equations.model.effects or any(end.kind in ("joined", "driven") for end in ends):
        return None
    loaded = [end for end in ends if any(end.load)]
    if not loaded:
        return _at_rest(base)
    return _straight(base, loaded[0]) if len(loaded) == 1 else None


def _at_rest(base: Base) -> KnownBase | None:
    equations = base.equations
    turn = {e: r for e, r in zip(equations.turn, equations.reference, strict=True) if is_field(e)}
    if any(distributed(put_in(law.right, turn)) != 0 for law in equations.stress_law):
        return None
    words = "The rod is at rest in its reference: E is the reference, V = 0 and there is no stress."
    return KnownBase("About the rod at rest", words, turn | _zero(equations.twist, equations.stress), {})


def _straight(base: Base, loaded: EndConditions) -> KnownBase | None:
    """h1 and F1 stay: they are what the load makes of them."""
    equations, (h1, *others) = base.equations, base.turn
    given = getattr(equations.model, loaded.side)
    other = equations.right if loaded.side == "left" else equations.left
    turn = _zero(tuple(e for e in others if is_field(e)))
    stress = _zero(tuple(s for s in equations.stress if s != base.stress[0]))
    law = {e.left: put_in(e.right, turn) for e in equations.stress_law}
    fits = (
        loaded.kind == "free"
        and other.kind in ("clamped", "pinned")
        and given.force is not None
        and given.torque is None
        and not any("t" in symbols(e) for e in given.force)
        and not any(equations.reference[1:])
        and base.stress[0] != 0
        and (given.frame == "world" or not any(loaded.load[1:]))
        and all(distributed(e) == 0 for s, e in law.items() if s in stress)
    )
    if not fits:
        return None
    F1 = base.stress[0]
    uniform = is_field(h1) and U not in law[F1].xreplace({h1: sp.S.One}).free_symbols
    still = (F1, h1) if uniform else (F1,)
    aligned = f"Where the {other.side} end holds the rod along the load, it may be"
    held = aligned if given.frame == "world" else "The rod is"
    words = (
        f"{held} straight and at rest: of turn and stress only h1 and F1 are left. F1 is the tension, less than 0 "
        "under a thrust, and h1 the stretch that goes with it by the law."
    )
    return KnownBase(
        "About the straight rod under its load",
        words,
        turn | stress | _zero(equations.twist),
        {f.diff((U, k)): sp.S.Zero for f in still for k in (1, 2)},
    )


def _zero(*vectors: tuple[sp.Expr, ...]) -> dict[sp.Expr, sp.Expr]:
    return {f: sp.S.Zero for vector in vectors for f in vector}
