"""The linear equations laid out: the base, the displacement, the ends, the turn alone, and a base that is known."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

import numpy as np
import sympy as sp

from geocosserat.derivation import layout
from geocosserat.derivation.closure import listed, names
from geocosserat.derivation.document import Document, Formula, Names, Section
from geocosserat.derivation.known_base import KnownBase, known_base
from geocosserat.derivation.linear import LinearEquations, linearise
from geocosserat.derivation.linear_ends import ends_alone, ends_displaced
from geocosserat.derivation.linear_turn import TurnAlone, turn_alone
from geocosserat.derivation.notation import field, parameter_names
from geocosserat.derivation.operators import LinearSystem
from geocosserat.derivation.records import EndConditions, Equation, FieldEquations

_FEW: Final = 3
_KINEMATICS: Final = Formula("δE = η' + ad_E η", "dE = eta_u + ad_E eta", r"\delta E = \eta' + \mathrm{ad}_E \eta")
_STRESS: Final = Formula("δΣ = T δE", "dS = T dE", r"\delta\Sigma = T \, \delta E")
_MOTION: Final = Formula(
    "Γ (η̇ + ad_V η) = δΣ' + ad*_E δΣ + ad*_δE Σ",
    "Gamma (eta_t + ad_V eta) = dS_u + ad*_E dS + ad*_dE S",
    r"\Gamma (\dot\eta + \mathrm{ad}_V \eta) = \delta\Sigma' + \mathrm{ad}^*_E \delta\Sigma"
    r" + \mathrm{ad}^*_{\delta E} \Sigma",
)
_WORLD: Final = Formula(" + S η", " + S eta", r" + S \eta")
_TWIST: Final = Formula(
    "Γ δV = δΣ' + ad*_E δΣ + ad*_δE Σ",
    "Gamma dV = dS_u + ad*_E dS + ad*_dE S",
    r"\Gamma \delta V = \delta\Sigma' + \mathrm{ad}^*_E \delta\Sigma + \mathrm{ad}^*_{\delta E} \Sigma",
)
_COMPATIBILITY: Final = Formula(
    "δĖ = δV' + ad_E δV + ad_δE V",
    "dE_t = dV_u + ad_E dV + ad_dE V",
    r"\delta\dot E = \delta V' + \mathrm{ad}_E \delta V + \mathrm{ad}_{\delta E} V",
)
_FROM: Final = Formula(", from ", ", from ", r" \quad\text{from}\quad ")
_ETA: Final = Formula("η", "eta", r"\eta"), Formula("η̇", "eta_t", r"\dot\eta")
_Y: Final = Formula("y", "y", "y"), Formula("ẏ", "y_t", r"\dot y")
_DE: Final = Formula("δE", "dE", r"\delta E"), Formula("δĖ", "dE_t", r"\delta\dot E")
_Z: Final = Formula("z", "z", "z"), Formula("ż", "z_t", r"\dot z")
_BY_THE_TURN: Final = ", by the turn"


def linearised(equations: FieldEquations) -> Document:
    """The linear equations about any base, and about the base that the scene has of its own.

    Raises InputError as `linearise`.
    """
    linear = linearise(equations)
    alone, own = turn_alone(linear.base), known_base(linear.base)
    sections = [
        replace(layout.stress(equations), heading="Base", remark=_base_in_words(linear)),
        Section("Change of the turn", linear.kinematics, _KINEMATICS),
        Section("Change of the stress", linear.stress, _STRESS if linear.stress else None, remark=_multipliers(linear)),
        Section("Motion", (), _motion(linear), remark=_rows_in_words(linear)),
        *_matrices(linear.motion, ""),
        *_ends(ends_displaced(linear.base), ""),
        *(_alone(linear, alone) if alone else []),
        *(_known(own, linear, alone) if own else []),
    ]
    present = parameter_names(side for s in sections for e in s.equations for side in (e.left, e.right))
    letters = [n for n in layout.names(equations) if n.meaning != "wrench"]
    title = layout.title(equations)
    return Document(
        f"Linearised {title[0].lower()}{title[1:]}",
        (*letters, Names("shift", _ETA[0], linear.base.displacement)),
        tuple((name, value) for name, value in layout.parameters(equations) if name.name in present),
        tuple(s for s in sections if s.equations or s.remark),
    )


def _base_in_words(linear: LinearEquations) -> str:
    equations = linear.base.equations
    seen = names((*equations.orientation.fields, *equations.position.fields))
    letters = ["turn", "twist", *(["stress"] if equations.stress else [])]
    words = (
        f"The base is any motion of the rod, at rest or not: {listed([*letters, *seen])} are its own and solve the "
        "equations of the form intrinsic; at rest the twist is 0. The rod is displaced from it by eta, components in "
        "the moving frame: lengths, then angles. All that follows is of first order in eta."
    )
    coefficients = (*linear.base.tangent.flat, *linear.base.friction.flat)
    if equations.keeps_stress or any(e.has(sp.Heaviside, sp.sign) for e in coefficients):
        words += " It holds between steps, across which eta and the stress are continuous."
    return words


def _multipliers(linear: LinearEquations) -> str:
    found, frozen = names(linear.base.multipliers), linear.base.equations.model.frozen
    role = "is the change of the multiplier that keeps" if len(found) == 1 else "are the changes of the multipliers of"
    return f"{listed(found)} {role} {listed(frozen)}{' frozen' if len(found) == 1 else ''}." if found else ""


def _motion(linear: LinearEquations) -> Formula:
    """D, A and R of the displacement; where they are of more than that, what they are made of."""
    whole = _diffusing(_Y if linear.base.multipliers else _ETA, linear.motion)
    made_of = (_MOTION, _WORLD) if np.any(linear.base.world != 0) else (_MOTION,)
    return layout.joined(whole, _FROM, *made_of)


def _rows_in_words(linear: LinearEquations) -> str:
    unknowns, still = names(linear.balance.unknowns), linear.base.equations.algebraic
    letter = "y" if linear.base.multipliers else "eta"
    sentences = [f"{letter} is {listed(unknowns)}, in this order; entries that are not listed are 0."]
    if linear.base.multipliers:
        rows = "row says" if len(linear.base.multipliers) == 1 else "rows say"
        sentences.append(f"The last {rows} that what is frozen does not change.")
    if still:
        which = "rows of {} have" if still[1:] else "row of {} has"
        sentences.append(f"The {which.format(listed(still))} no friction: balance at every instant.")
    if linear.base.equations.orientation.fields or linear.base.equations.position.fields:
        sentences.append("The rod sees the world, so the displacement itself is the unknown.")
    return " ".join(sentences)


def _diffusing(unknown: tuple[Formula, Formula], system: LinearSystem) -> Formula:
    """N y_t = D y'' + A y' + R y, by the unknown and its rate."""
    y, rate = unknown
    mass = Formula(*("" if system.solved else "N ",) * 3)
    return layout.joined(
        mass, rate, Formula(" = D ", " = D ", r" = D \, "), y, Formula("'' + A ", "_uu + A ", r"'' + A \, "), y,
        Formula("' + R ", "_u + R ", r"' + R \, "), y,
    )  # fmt: skip


def _matrices(system: LinearSystem, of: str) -> Iterable[Section]:
    """Mass, diffusion, advection and reaction by their entries."""
    parts = [
        *([] if system.solved else [("Mass", "N", system.mass)]),
        ("Diffusion", "D", system.diffusion),
        ("Advection", "A", system.advection),
        ("Reaction", "R", system.reaction),
    ]
    for heading, letter, matrix in parts:
        comma = "," if len(matrix) > 9 else ""
        entries = tuple(
            Equation(field(f"{letter}{a + 1}{comma}{b + 1}"), e) for (a, b), e in np.ndenumerate(matrix) if e != 0
        )
        yield Section(f"{heading}{of}", entries, inline=len(entries) <= _FEW)


def _ends(ends: Iterable[EndConditions], of: str) -> Iterable[Section]:
    for end in ends:
        section = layout.end(end)
        yield replace(section, heading=f"{section.heading}{of}")


def _alone(linear: LinearEquations, alone: TurnAlone) -> Iterable[Section]:
    """The turn as the unknown: fewer, and no place or angle anywhere."""
    frozen = bool(linear.base.multipliers)
    where = "; a multiplier stands in the place of what is frozen, and its row has no rate" if frozen else ""
    remark = (
        "The rod does not see the world, so the change of its turn closes by itself. "
        f"{'z' if frozen else 'dE'} is {listed(names(alone.motion.unknowns))}, in this order{where}."
    )
    formula = layout.joined(_diffusing(_Z if frozen else _DE, alone.motion), _FROM, _COMPATIBILITY)
    yield Section("Change of the twist", alone.twist, _TWIST)
    yield Section("Turn alone", (), formula, remark=remark)
    yield from _matrices(alone.motion, _BY_THE_TURN)
    yield from _ends(ends_alone(linear.base), _BY_THE_TURN)


def _known(own: KnownBase, linear: LinearEquations, alone: TurnAlone | None) -> Iterable[Section]:
    yield Section(own.heading, own.of(linear.motion).rows, remark=own.words)
    if alone:
        yield Section(f"{own.heading}{_BY_THE_TURN}", own.of(alone.motion).rows)
