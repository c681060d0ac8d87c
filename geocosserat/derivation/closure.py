"""What closes a rod's equations, in words: how many equations there are, for which fields, and which are unusual."""

from __future__ import annotations

from collections.abc import Sequence

from geocosserat.derivation.records import FieldEquations, Vector

_HELD = ("clamped", "pinned", "driven")


def closure(equations: FieldEquations) -> str:
    """What the motion must be joined with to be a closed system, its unknowns counted and named."""
    unknowns = names(equations.unknowns)
    partners = ["the compatibility condition"]
    if equations.constraints:
        partners.append("the constraints")
    if equations.orientation.fields:
        partners.append("the rate of the orientation")
    if equations.position.fields:
        partners.append("the rate of the position")
    if equations.keeps_stress:
        partners.append("the stress, which is continuous where the law steps")
    of_which = ""
    if equations.multipliers:
        role = "is a multiplier" if len(equations.multipliers) == 1 else "are multipliers"
        of_which = f", of which {listed(names(equations.multipliers))} {role}"
    sentences = [
        f"Closed by {listed(partners)}: {len(equations.closed)} equations for the {len(unknowns)} unknown fields "
        f"{listed(unknowns)}{of_which}."
    ]
    if equations.algebraic:
        sentences.append(algebraic_in_words(equations))
    return " ".join(sentences)


def multipliers_in_words(equations: FieldEquations) -> str:
    """Which stresses are Lagrange multipliers, of which frozen modes, and where they are not unique."""
    found, frozen = names(equations.multipliers), equations.model.frozen
    one = len(found) == 1
    role = "is the Lagrange multiplier that keeps" if one else "are the Lagrange multipliers that keep"
    words = f"{listed(found)} {role} {listed(frozen)} at {'its' if len(frozen) == 1 else 'their'} reference."
    if not equations.model.joined and equations.left.kind in _HELD and equations.right.kind in _HELD:
        words += " With both ends held, a straight rod may leave a constant tension or twisting moment open."
    return words


def algebraic_in_words(equations: FieldEquations) -> str:
    """Which rows of the motion have no friction."""
    rows = equations.algebraic
    if len(rows) == 1:
        return f"The row of {rows[0]} has no friction: it is an algebraic balance, in force at every instant."
    return f"The rows of {listed(rows)} have no friction: they are algebraic balances, in force at every instant."


def names(fields: Vector) -> tuple[str, ...]:
    """The names of fields."""
    return tuple(f.func.__name__ for f in fields)


def listed(words: Sequence[str]) -> str:
    """Words with commas, and "and" before the last."""
    return ", ".join(words[:-1]) + (" and " if words[1:] else "") + words[-1] if words else ""
