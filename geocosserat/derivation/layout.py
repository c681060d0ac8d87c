"""The parts that every laid-out form of a rod's equations shares: title, names, parameters, the world, ends, work."""

from __future__ import annotations

from typing import Final

import sympy as sp

from geocosserat.derivation import acting
from geocosserat.derivation.closure import listed, multipliers_in_words
from geocosserat.derivation.convert import exact
from geocosserat.derivation.document import Formula, Names, Section
from geocosserat.derivation.notation import field, symbol
from geocosserat.derivation.records import EndConditions, Equation, FieldEquations

LETTER: Final = {
    "turn": Formula("E", "E", "E"),
    "twist": Formula("V", "V", "V"),
    "stress": Formula("Σ", "S", r"\Sigma"),
    "wrench": Formula("j", "j", "j"),
}
ENERGY, DISSIPATION = field("epsilon"), field("delta")
_NOTHING: Final = Formula("", "", "")
_WEIGHT: Final = Formula(" + Rᵀ f", " + R^T f", r" + R^{\mathsf T} f")
_BODY: Final = Formula(" + j(u, t)", " + j(u, t)", " + j(u, t)")
_WORLD: Final = Formula(" + j(φ)", " + j(phi)", r" + j(\varphi)")
_LINEAR: Final = Formula("Σ = K (E - Ē)", "S = K (E - E0)", r"\Sigma = K (E - \bar E)")
_LAW: Final = Formula("Σ = Σ(E)", "S = S(E)", r"\Sigma = \Sigma(E)")
_VISCOUS: Final = Formula("Σ = Σ(E, Ė)", "S = S(E, E_t)", r"\Sigma = \Sigma(E, \dot E)")
_STILL: Final = Formula("j = -Γ V", "j = -Gamma V", r"j = -\Gamma V")
_MOVING: Final = Formula("j = -Γ (V - Vₘ)", "j = -Gamma (V - V_m)", r"j = -\Gamma (V - V_m)")
_MOTION: Final = Formula(
    "Γ V = Σ' + ad*_E Σ", "Gamma V = S_u + ad*_E S", r"\Gamma V = \Sigma' + \mathrm{ad}^*_E \Sigma"
)
_CARRIED: Final = Formula(" + Γ Vₘ", " + Gamma V_m", r" + \Gamma V_m")


def title(equations: FieldEquations) -> str:
    """The motion, the frozen modes and what the rod feels."""
    kind = "Planar" if equations.group.space == 2 else "Spatial"
    frozen = f", {listed(equations.model.frozen)} frozen" if equations.model.frozen else ""
    return f"{kind} rod, {equations.group.name}{frozen}: {', '.join(equations.terms)}"


def names(equations: FieldEquations) -> tuple[Names, ...]:
    """What the letters stand for; of frozen modes the reference."""
    vectors = {
        "turn": equations.turn,
        "twist": equations.twist,
        "stress": equations.stress,
        "wrench": equations.wrench,
    }
    return tuple(Names(meaning, LETTER[meaning], fields) for meaning, fields in vectors.items() if fields)


def parameters(equations: FieldEquations) -> tuple[tuple[sp.Symbol, sp.Expr], ...]:
    """The parameters that occur, with their values."""
    values = equations.model.parameters
    return tuple((symbol(name), exact(values[name])) for name in equations.parameters if name in values)


def constraints(equations: FieldEquations) -> list[Section]:
    """The rows of the compatibility condition that keep frozen modes where they are."""
    if not equations.constraints:
        return []
    frozen = equations.model.frozen
    remark = f"The rows of {listed(frozen)}, which {'is' if len(frozen) == 1 else 'are'} frozen."
    return [Section("Constraints", equations.constraints, remark=remark)]


def stress(equations: FieldEquations) -> Section:
    """The stress by its law, and which of it has none."""
    formula = _VISCOUS if equations.viscous else _LAW if equations.model.law else _LINEAR
    remark = multipliers_in_words(equations) if equations.multipliers else ""
    return Section("Stress", equations.stress_law, formula if equations.stress_law else None, remark=remark)


def wrench(equations: FieldEquations) -> Section:
    """The wrench by its law."""
    moving = _medium_moves(equations)
    remark = "The medium moves with the twist V_m." if moving else ""
    formula = joined(_MOVING if moving else _STILL, effects(equations))
    return Section("Wrench", equations.wrench_law, formula, remark=remark)


def motion(equations: FieldEquations) -> Section:
    """The balance solved for the friction."""
    carried = _CARRIED if _medium_moves(equations) else _NOTHING
    return Section("Motion", equations.motion, joined(_MOTION, carried, effects(equations)))


def effects(equations: FieldEquations) -> Formula:
    """The term of the effects in a vector equation: nothing, the weight, or what depends on place or orientation."""
    push = acting.push(equations.group, equations.model.effects)
    if not any(push):
        return _NOTHING
    if not any(e.has(*equations.orientation.fields, *equations.position.fields) for e in push):
        return _BODY
    acts = [effect for effect in equations.model.effects if any(acting.push(equations.group, (effect,)))]
    return _WEIGHT if all(effect.kind == "weight" for effect in acts) else _WORLD


def world(equations: FieldEquations) -> list[Section]:
    """How orientation and position evolve, if the scene has them."""
    planar = equations.group.space == 2
    meaning = (
        "theta is the angle of e1 from the world's x axis."
        if planar
        else "A letter after the number names the world axis: e1z is the z component of e1."
    )
    turning = Formula("Ṙ = R Ω̂, R' = R Π̂", "R_t = R Omega^, R_u = R Pi^", r"\dot R = R \hat\Omega,\; R' = R \hat\Pi")
    moving = Formula("ṙ = R v, r' = R h", "r_t = R v, r_u = R h", r"\dot r = R v,\; r' = R h")
    sections = []
    if equations.orientation.fields:
        rows = equations.orientation_rates + equations.orientation_slopes
        sections.append(Section("Orientation", rows, turning, remark=meaning))
    if equations.position.fields:
        sections.append(Section("Position", equations.position_rates + equations.position_slopes, moving))
    return sections


def ends(equations: FieldEquations) -> list[Section]:
    """The conditions at both ends, in one section if they are joined."""
    left, right = equations.left, equations.right
    if not equations.model.joined:
        return [end(left), end(right)]
    places = [float(e.position).__repr__().removesuffix(".0") for e in (left, right)]
    return [
        Section(
            f"Ends, joined: u = {places[0]} and u = {places[1]} are one cross-section",
            left.equations + right.equations,
            remark="The ring stays closed if it is closed at the start.",
        )
    ]


def end(end: EndConditions) -> Section:
    """The conditions at one end."""
    state = f"{end.kind} and loaded" if any(end.load) else end.kind
    at = Formula(*(f"u = {float(end.position)!r}".removesuffix(".0"),) * 3)
    inline = not any(end.load) and end.kind != "joined"
    return Section(f"{end.side.capitalize()} end, {state}", end.equations, at, inline=inline)


def work(equations: FieldEquations) -> list[Section]:
    """The elastic energy and the power lost to friction and viscosity, as far as there are any."""
    elastic = [Equation(ENERGY, equations.energy)] if equations.energy else []
    lost = [Equation(DISSIPATION, equations.dissipation)] if equations.dissipation != 0 else []
    to = "friction and viscosity" if equations.viscous else "friction"
    remark = {
        (True, True): f"The elastic energy and the power lost to {to}, both per length.",
        (True, False): "The elastic energy per length.",
        (False, True): f"The power lost to {to} per length.",
    }
    if not elastic and not lost:
        return []
    return [Section("Work", (*elastic, *lost), remark=remark[bool(elastic), bool(lost)])]


def joined(*formulas: Formula) -> Formula:
    """Formulas written one after the other."""
    return Formula(*("".join(getattr(f, way) for f in formulas) for way in ("text", "ascii", "latex")))


def _medium_moves(equations: FieldEquations) -> bool:
    return any(acting.medium(equations.group, equations.model.effects))
