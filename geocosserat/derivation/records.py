"""What a derivation hands on: the field equations of one rod, as frozen records of symbolic expressions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import sympy as sp

from geocosserat.algebra.groups import Group
from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.notation import T, field_names, is_field, parameter_names
from geocosserat.derivation.orientation import Carried
from geocosserat.model.expressions import symbols
from geocosserat.model.records import RodModel

Vector = tuple[sp.Expr, ...]


@dataclass(frozen=True)
class Equation:
    """left = right, exactly as it is to be read (sympy's own Eq would decide or rearrange it)."""

    left: sp.Expr
    right: sp.Expr

    @property
    def residual(self) -> sp.Expr:
        """left - right."""
        return self.left - self.right

    def __str__(self) -> str:
        return f"{self.left} = {self.right}"


Equations = tuple[Equation, ...]


@dataclass(frozen=True)
class EndConditions:
    """What holds at one end at all times; ``position``: its u. ``load``: in moving-frame components.

    Of joined ends, the left has the twist that both share, the right the stress.
    """

    side: str
    kind: str
    position: sp.Expr
    load: Vector
    equations: Equations


@dataclass(frozen=True)
class FieldEquations:
    """Everything that governs one rod. Vectors are components in the moving frame, in the order of the group.

    ``turn``, ``twist``: E and V, all d components; a frozen one of E is its reference, the others are fields.
    ``stress``, ``wrench``: the fields S and j, only those not zero. ``orientation``, ``position``: the fields
    through which the world is seen, none if nothing in the scene sees it. ``multipliers``: those components of
    the stress that no law gives, because they keep a frozen mode at its reference.

    ``compatibility``: dE/dt = V' + ad_E V, all d rows; that of a frozen mode is a constraint on V. ``balance``:
    S' + ad*_E S + j = 0. ``stress_law``: S(E), of a viscous law S(E, dE/dt). ``wrench_law``: j = -Gamma (V - V_medium)
    + effects. ``orientation_rates``, ``orientation_slopes``, ``position_rates``, ``position_slopes``: in t and in u.
    ``motion``: the balance solved for the friction, Gamma V = S(E)' + ad*_E S(E) + Gamma V_medium + effects, which
    with ``compatibility`` and the rates is the closed system; a row without friction has nothing on the left.
    Where the law has steps in u, ``motion`` keeps the stress, which is continuous there, and ``stress_law`` closes
    it. ``left``, ``right``: the ends.

    ``energy``: elastic energy per length at rest (force), None unless the stiffness is symmetric.
    ``dissipation``: power lost to friction against the medium, and to viscosity, per length at rest (force / time).
    """

    model: RodModel
    turn: Vector
    twist: Vector
    stress: Vector
    wrench: Vector
    orientation: Carried
    position: Carried
    multipliers: Vector
    compatibility: Equations
    balance: Equations
    stress_law: Equations
    wrench_law: Equations
    orientation_rates: Equations
    orientation_slopes: Equations
    position_rates: Equations
    position_slopes: Equations
    motion: Equations
    left: EndConditions
    right: EndConditions
    energy: sp.Expr | None
    dissipation: sp.Expr

    @property
    def group(self) -> Group:
        """The group of the motion."""
        return self.model.group

    @property
    def parts(self) -> dict[str, Equations]:
        """Every equation, by the name of its part."""
        return {
            "compatibility": self.compatibility,
            "balance": self.balance,
            "stress": self.stress_law,
            "wrench": self.wrench_law,
            "orientation": self.orientation_rates + self.orientation_slopes,
            "position": self.position_rates + self.position_slopes,
            "motion": self.motion,
            "left end": self.left.equations,
            "right end": self.right.equations,
        }

    @property
    def reference(self) -> Vector:
        """The turn at rest: dimensionless, then 1 / length."""
        return tuple(to_sympy(e) for e in self.model.reference)

    @property
    def constraints(self) -> Equations:
        """The rows of the compatibility condition that belong to frozen modes."""
        return tuple(e for e, held in zip(self.compatibility, self.model.held, strict=True) if held)

    @property
    def rates(self) -> Equations:
        """The rows of the compatibility condition that belong to free modes: dE/dt of each."""
        return tuple(e for e, held in zip(self.compatibility, self.model.held, strict=True) if not held)

    @property
    def algebraic(self) -> tuple[str, ...]:
        """The velocities without friction, whose row of the motion is a balance without any velocity."""
        return tuple(v.func.__name__ for v, e in zip(self.twist, self.motion, strict=True) if e.left == 0)

    @property
    def keeps_stress(self) -> bool:
        """Whether the motion keeps the stress as a field that has a law."""
        return any(e.right.has(*(law.left for law in self.stress_law)) for e in self.motion if self.stress_law)

    @property
    def unknowns(self) -> Vector:
        """The fields of the closed system: turn, twist, multipliers, kept stress, orientation, position."""
        kept = tuple(e.left for e in self.stress_law) if self.keeps_stress else ()
        turn = tuple(e for e in self.turn if is_field(e))
        return (*turn, *self.twist, *self.multipliers, *kept, *self.orientation.fields, *self.position.fields)

    @property
    def closed(self) -> Equations:
        """The closed system: as many equations as ``unknowns``."""
        laws = self.stress_law if self.keeps_stress else ()
        return self.compatibility + self.motion + laws + self.orientation_rates + self.position_rates

    @property
    def viscous(self) -> bool:
        """Whether some stress answers to a rate of strain."""
        return any(e.right.has(*(x.diff(T) for x in self.turn if is_field(x))) for e in self.stress_law)

    @property
    def terms(self) -> tuple[str, ...]:
        """What the rod feels, in words: elasticity, viscosity, friction, kinds of effects, loaded and driven ends."""
        present = [
            ("elasticity", bool(self.stress_law)),
            ("viscosity", self.viscous),
            ("active reference", any("t" in symbols(e) for e in self.model.reference)),
            ("friction", self.dissipation != 0),
        ]
        effects = (effect.kind for effect in self.model.effects)
        ends = (self.left, self.right)
        loaded = (f"load on the {end.side} end" for end in ends if any(end.load))
        driven = (f"drive of the {end.side} end" for end in ends if end.kind == "driven")
        return (*(name for name, there in present if there), *dict.fromkeys(effects), *loaded, *driven)

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of all fields that occur: turn, twist, stress, wrench, orientation, position."""
        vectors = (
            self.turn, self.twist, self.stress, self.wrench, self.orientation.fields, self.position.fields,
        )  # fmt: skip
        present = field_names(self._sides())
        return tuple(name for vector in vectors for f in vector if is_field(f) and (name := f.func.__name__) in present)

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the parameters that occur, in the order of the model."""
        present = parameter_names(self._sides())
        known = [name for name in self.model.parameters if name in present]
        return (*known, *sorted(present.difference(known)))

    def _sides(self) -> Iterable[sp.Expr]:
        return (side for part in self.parts.values() for e in part for side in (e.left, e.right))

    def __str__(self) -> str:
        return "\n".join(f"{name}: {equation}" for name, part in self.parts.items() for equation in part)
