"""The form in coordinates, laid out: a closed system for the configuration in a chart."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from geocosserat.derivation import layout
from geocosserat.derivation.closure import algebraic_in_words, listed, multipliers_in_words, names
from geocosserat.derivation.coordinates import CoordinateEquations, in_chart
from geocosserat.derivation.document import Document, Formula, Names, Section
from geocosserat.derivation.records import EndConditions, Equations, FieldEquations

_MOST_INLINE: Final = 7
_LETTER: Final = Formula("q", "q", "q")
_SLOPES: Final = Formula("r' = R h, R' = R Π̂", "r_u = R h, R_u = R Pi^", r"r' = R h,\; R' = R \hat\Pi")
_RATES: Final = Formula("ṙ = R v, Ṙ = R Ω̂", "r_t = R v, R_t = R Omega^", r"\dot r = R v,\; \dot R = R \hat\Omega")


def coordinates(equations: FieldEquations, chart: str | None = None) -> Document:
    """The form in coordinates; ``chart``: its name, by default the first of the group.

    Raises ValueError as `in_chart`.
    """
    system = in_chart(equations, chart)
    letters = [n for n in layout.names(equations) if n.meaning != "wrench"]
    sections = [
        Section("Chart", system.frame, remark=system.chart.words),
        *_kept(system),
        Section("Turn", system.turn, _SLOPES, remark="The twist V is the same function with rates in place of slopes."),
        *_frozen(system),
        *([replace(layout.stress(equations), remark="")] if system.stress_law else []),
        replace(layout.motion(equations), remark=_closure(system)),
        Section("Rates", system.rates, _RATES),
        *_alone(system),
        *_ends(system),
        Section("Singular set", system.singular, remark=system.chart.where),
    ]
    title = layout.title(equations).replace(":", f", in the chart {system.chart.name}:", 1)
    return Document(
        title,
        (Names("chart", _LETTER, system.coordinates), *letters),
        layout.parameters(equations),
        tuple(sections),
    )


def _kept(system: CoordinateEquations) -> list[Section]:
    remark = "The rates keep it; it must hold at the start."
    return [Section("Constraint", system.constraint, remark=remark)] if system.constraint else []


def _frozen(system: CoordinateEquations) -> list[Section]:
    return [Section("Frozen", system.frozen, remark=multipliers_in_words(system.equations))] if system.frozen else []


def _closure(system: CoordinateEquations) -> str:
    partners = ["the rates of the coordinates"]
    if system.frozen:
        partners.append("what is frozen")
    if system.equations.keeps_stress:
        partners.append("the stress, which is continuous where the law steps")
    unknowns = names(system.unknowns)
    words = (
        f"Closed by {listed(partners)}: {len(system.closed)} equations for the {len(unknowns)} unknown fields "
        f"{listed(unknowns)}."
    )
    return f"{words} {algebraic_in_words(system.equations)}" if system.equations.algebraic else words


def _alone(system: CoordinateEquations) -> list[Section]:
    remark = "The same motion, its force turned into the world, with turn and twist put in."
    return [Section("Motion by the coordinates alone", system.alone, remark=remark)] if system.alone else []


def _ends(system: CoordinateEquations) -> list[Section]:
    if system.equations.model.joined:
        return layout.ends(system.equations)
    pairs = ((system.equations.left, system.left), (system.equations.right, system.right))
    return [_end(end, conditions) for end, conditions in pairs]


def _end(end: EndConditions, conditions: Equations) -> Section:
    section = layout.end(end)
    short = section.inline and len(conditions) <= _MOST_INLINE
    remark = "The coordinates stay what they are at the start." if end.kind == "clamped" else section.remark
    return replace(section, equations=conditions, inline=short, remark=remark)
