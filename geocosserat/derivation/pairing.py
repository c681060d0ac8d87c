"""Which equation of a system fixes which of its fields."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from geocosserat.derivation.elimination import Row, System, occur


def pairing(system: System) -> tuple[sp.Expr, ...]:
    """For each row, a field that it contains, no field twice: its partner if possible, else one that is left over.

    ValueError if the system cannot fix its fields: more or fewer rows than fields, or rows about too few fields.
    """
    wishes = [_wishes(row, system) for row in system.rows]
    taken: dict[sp.Expr, int] = {}
    for k in sorted(range(len(wishes)), key=lambda k: system.rows[k].partner not in wishes[k]):
        _place(k, wishes, taken, set())
    fixed = {k: f for f, k in taken.items()}
    if len(fixed) != len(system.rows) or len(fixed) != len(system.unknowns):
        raise ValueError(
            f"expected as many equations as unknown fields, found {len(system.rows)} for {len(system.unknowns)}, of "
            f"which {len(fixed)} can be told apart; use the intrinsic form"
        )
    return tuple(fixed[k] for k in range(len(system.rows)))


def _wishes(row: Row, system: System) -> list[sp.Expr]:
    present = occur(row.equation.left) | occur(row.equation.right)
    found = [f for f in system.unknowns if f in present]
    return sorted(found, key=lambda f: f != row.partner)


def _place(row: int, wishes: Sequence[Sequence[sp.Expr]], taken: dict[sp.Expr, int], tried: set[sp.Expr]) -> bool:
    """Give the row a field, moving others to another of theirs where need be (an augmenting path)."""
    free = next((f for f in wishes[row] if f not in taken), None)
    if free is not None:
        taken[free] = row
        return True
    for f in wishes[row]:
        if f not in tried:
            tried.add(f)
            if _place(taken[f], wishes, taken, tried):
                taken[f] = row
                return True
    return False
