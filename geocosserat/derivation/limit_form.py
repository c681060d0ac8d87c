"""The limit equations laid out: what was eliminated and how, the closed system, the ends, and small motions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from geocosserat.derivation import layout
from geocosserat.derivation.closure import listed, names
from geocosserat.derivation.document import Document, Formula, Names, Section
from geocosserat.derivation.limit import ANGLE, UNDRIVEN, LimitEquations, limit
from geocosserat.derivation.notation import parameter_names
from geocosserat.derivation.records import FieldEquations
from geocosserat.derivation.small import SmallMotion, small_motion

_LETTER: Final = Formula("y", "y", "y")
_NONE: Final = (
    "Small motions about the straight rod at rest: none are printed, because the rod is curved or its reference moves, "
    "or because something acts on it."
)
_SHARED: Final = "With the twist and the stress as eliminated above."


def limit_form(equations: FieldEquations) -> Document:
    """The limit equations of a rod with frozen modes, and where it is straight and free of load their linear form.

    Raises InputError for a rod without frozen modes.
    """
    found = limit(equations)
    small = small_motion(found)
    sections = [
        Section("Eliminated", tuple(s.equation for s in found.solved), remark=_origins(found)),
        Section("Closed system", found.rows, remark=_closed(found) + ("" if small else f"\n{_NONE}")),
        *_ends(found, found, ""),
        *(_small(found, small) if small else []),
    ]
    letters = [n for n in layout.names(equations) if n.meaning != "wrench"]
    present = parameter_names(side for s in sections for e in s.equations for side in (e.left, e.right))
    values = tuple((name, value) for name, value in layout.parameters(equations) if name.name in present)
    title = layout.title(equations)
    return Document(
        f"Limit of the {title[0].lower()}{title[1:]}",
        (*letters, Names("unknown", _LETTER, found.unknowns)),
        values,
        tuple(s for s in sections if s.equations or s.remark),
    )


def _origins(found: LimitEquations) -> str:
    """Which equation gave which field."""
    given: dict[str, list[str]] = {}
    for s in found.solved:
        given.setdefault(s.origin, []).append(s.equation.left.func.__name__)
    still = given.pop(UNDRIVEN, [])
    turned = given.pop(ANGLE, [])
    sentences = ["theta is the angle of e1 from the world's x axis."] if turned else []
    if given:
        sources = (f"{listed(fields)} by {origin}" for origin, fields in given.items())
        sentences.append(f"{'; '.join(sources)}.")
    if still:
        verb, them = ("vanishes", "it") if len(still) == 1 else ("vanish", "them")
        sentences.append(f"{listed(still)} {verb}: nothing drives {them}.")
    if found.divided:
        sentences.append("Divided by h1, which is positive.")
    return " ".join(sentences)


def _closed(found: LimitEquations) -> str:
    unknowns = names(found.unknowns)
    if len(unknowns) == 1:
        sentences = [f"One equation for the one unknown field {unknowns[0]}."]
    else:
        sentences = [
            f"{len(found.rows)} equations for the {len(unknowns)} unknown fields {listed(unknowns)}; "
            f"in the order in which they stand they fix {listed(names(found.fixes))}."
        ]
    if found.multipliers:
        one = len(found.multipliers) == 1
        role = "is a Lagrange multiplier" if one else "are Lagrange multipliers"
        sentences.append(f"{listed(names(found.multipliers))} {role}.")
    kept = [f for f in found.unknowns if f in found.equations.twist]
    if kept:
        sentences.append(f"No equation gives {listed(names(tuple(kept)))} in closed form.")
    if found.equations.keeps_stress:
        sentences.append("The stress is continuous where the law steps, and stays a field.")
    return " ".join(sentences)


def _ends(found: LimitEquations, given: LimitEquations | SmallMotion, which: str) -> list[Section]:
    if found.equations.model.joined:
        return [] if which else [replace(s, remark=f"{_SHARED} {s.remark}") for s in layout.ends(found.equations)]
    return [_headed(layout.end(end), which) for end in (given.left, given.right)]


def _headed(section: Section, which: str) -> Section:
    return replace(section, heading=f"{section.heading}{which}", inline=False)


def _small(found: LimitEquations, small: SmallMotion) -> Iterable[Section]:
    remark = "To first order in the distance from the straight rod at rest without load."
    return [Section("Small motions", small.rows, remark=remark), *_ends(found, small, ", small motions")]
