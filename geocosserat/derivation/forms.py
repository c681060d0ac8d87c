"""The forms in which a rod's equations can be laid out; each makes a Document of the same FieldEquations."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import sympy as sp

from geocosserat.derivation.convert import exact
from geocosserat.derivation.document import Document, Formula, Names, Section
from geocosserat.derivation.notation import field, symbol
from geocosserat.derivation.records import EndConditions, Equation, FieldEquations

LETTER: Final = {
    "turn": Formula("E", "E", "E"),
    "twist": Formula("V", "V", "V"),
    "stress": Formula("Σ", "S", r"\Sigma"),
    "wrench": Formula("j", "j", "j"),
}
WORLD_FORCE: Final = Formula(" + Rᵀ f", " + R^T f", r" + R^{\mathsf T} f")
NOTHING: Final = Formula("", "", "")
ENERGY, DISSIPATION = field("epsilon"), field("delta")


def document(equations: FieldEquations, form: str = "intrinsic") -> Document:
    """The equations in that form, ready to print. ValueError for a form that there is not."""
    if form not in FORMS:
        raise ValueError(f"form: expected one of {', '.join(FORMS)}, found {form!r}; choose one of these")
    return FORMS[form](equations)


def intrinsic(equations: FieldEquations) -> Document:
    """The form in the Lie algebra: turn, twist, stress and wrench in the moving frame."""
    weight = WORLD_FORCE if equations.orientation.fields and equations.model.effects else NOTHING
    sections = [
        Section(
            "Compatibility",
            equations.compatibility,
            Formula("Ė = V' + ad_E V", "E_t = V_u + ad_E V", r"\dot E = V' + \mathrm{ad}_E V"),
        ),
        Section(
            "Balance",
            equations.balance,
            Formula(
                "Σ' + ad*_E Σ + j = 0", "S_u + ad*_E S + j = 0", r"\Sigma' + \mathrm{ad}^*_E \Sigma + j = 0"
            ),
        ),
        Section(
            "Stress",
            equations.stress_law,
            Formula("Σ = K (E - Ē)", "S = K (E - E0)", r"\Sigma = K (E - \bar E)"),
        ),
        Section("Wrench", equations.wrench_law, _with("j = -Γ V", "j = -Gamma V", r"j = -\Gamma V", weight)),
        *_orientation(equations),
        Section(
            "Motion",
            equations.motion,
            _with(
                "Γ V = Σ' + ad*_E Σ",
                "Gamma V = S_u + ad*_E S",
                r"\Gamma V = \Sigma' + \mathrm{ad}^*_E \Sigma",
                weight,
            ),
            remark=_closure(equations),
        ),
        _end(equations.left),
        _end(equations.right),
        *_work(equations),
    ]
    return Document(_title(equations), _names(equations), _parameters(equations), tuple(sections))


FORMS: Final[dict[str, Callable[[FieldEquations], Document]]] = {"intrinsic": intrinsic}


def _title(equations: FieldEquations) -> str:
    kind = "Planar" if equations.group.space == 2 else "Spatial"
    return f"{kind} rod, {equations.group.name}: {', '.join(equations.terms)}"


def _names(equations: FieldEquations) -> tuple[Names, ...]:
    vectors = {
        "turn": equations.turn,
        "twist": equations.twist,
        "stress": equations.stress,
        "wrench": equations.wrench,
    }
    return tuple(Names(meaning, LETTER[meaning], fields) for meaning, fields in vectors.items() if fields)


def _parameters(equations: FieldEquations) -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    values = equations.model.parameters
    return tuple((symbol(name), exact(values[name])) for name in equations.parameters if name in values)


def _orientation(equations: FieldEquations) -> list[Section]:
    if not equations.orientation.fields:
        return []
    planar = equations.group.space == 2
    meaning = (
        "theta is the angle of e1 from the world's x axis."
        if planar
        else "A letter after the number names the world axis: e1z is the z component of e1."
    )
    return [
        Section(
            "Orientation",
            equations.orientation_rates + equations.orientation_slopes,
            Formula(
                "Ṙ = R Ω̂, R' = R Π̂", "R_t = R Omega^, R_u = R Pi^", r"\dot R = R \hat\Omega,\; R' = R \hat\Pi"
            ),
            remark=meaning,
        )
    ]


def _closure(equations: FieldEquations) -> str:
    partners = ["the compatibility condition"]
    if equations.orientation.fields:
        partners.append("the rate of the orientation")
    if equations.stress and any(e.right.has(*equations.stress) for e in equations.motion):
        partners.append("the stress, which is continuous where the law steps")
    return f"Closed by {', '.join(partners[:-1])}{' and ' if len(partners) > 1 else ''}{partners[-1]}."


def _end(end: EndConditions) -> Section:
    state = "clamped" if end.kind == "clamped" else "free and loaded" if any(end.load) else "free"
    at = Formula(*(f"u = {float(end.position)!r}".removesuffix(".0"),) * 3)
    return Section(f"{end.side.capitalize()} end, {state}", end.equations, at, inline=not any(end.load))


def _work(equations: FieldEquations) -> list[Section]:
    elastic = [Equation(ENERGY, equations.energy)] if equations.energy else []
    lost = [Equation(DISSIPATION, equations.dissipation)] if equations.dissipation != 0 else []
    remark = {
        (True, True): "The elastic energy and the power lost to friction, both per length.",
        (True, False): "The elastic energy per length.",
        (False, True): "The power lost to friction per length.",
    }
    if not elastic and not lost:
        return []
    return [Section("Work", (*elastic, *lost), remark=remark[bool(elastic), bool(lost)])]


def _with(text: str, plain: str, latex: str, extra: Formula) -> Formula:
    return Formula(text + extra.text, plain + extra.ascii, latex + extra.latex)
