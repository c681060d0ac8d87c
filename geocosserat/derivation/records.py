"""What a derivation hands on: the field equations of one rod, as frozen records of symbolic expressions."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import sympy as sp

from geocosserat.algebra.groups import Group
from geocosserat.derivation.notation import field_names, parameter_names
from geocosserat.derivation.orientation import Orientation
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
    """What holds at one end at all times; ``position``: its u. ``load``: in moving-frame components."""

    side: str
    kind: str
    position: sp.Expr
    load: Vector
    equations: Equations


@dataclass(frozen=True)
class FieldEquations:
    """Everything that governs one rod. Vectors are components in the moving frame, in the order of the group.

    ``turn``, ``twist``: the fields E and V. ``stress``, ``wrench``: the fields S and j, only those not zero.
    ``orientation``: the fields through which the world is seen, none if nothing in the scene sees it.

    ``compatibility``: dE/dt = V' + ad_E V. ``balance``: S' + ad*_E S + j = 0. ``stress_law``: S(E).
    ``wrench_law``: j = -Gamma V + effects. ``orientation_rates``, ``orientation_slopes``: in t and in u.
    ``motion``: the balance solved for the friction, Gamma V = S(E)' + ad*_E S(E) + effects, which with
    ``compatibility`` and ``orientation_rates`` is the closed system. Where the law has steps in u, ``motion``
    keeps the stress, which is continuous there, and ``stress_law`` closes it. ``left``, ``right``: the ends.

    ``energy``: elastic energy per length at rest (force), None unless the stiffness is symmetric.
    ``dissipation``: power lost to friction per length at rest (force / time).
    """

    model: RodModel
    turn: Vector
    twist: Vector
    stress: Vector
    wrench: Vector
    orientation: Orientation
    compatibility: Equations
    balance: Equations
    stress_law: Equations
    wrench_law: Equations
    orientation_rates: Equations
    orientation_slopes: Equations
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
            "motion": self.motion,
            "left end": self.left.equations,
            "right end": self.right.equations,
        }

    @property
    def terms(self) -> tuple[str, ...]:
        """What the rod feels, in words: elasticity, friction, the kinds of effects, the loaded ends."""
        loaded = (f"load on the {end.side} end" for end in (self.left, self.right) if any(end.load))
        present = [("elasticity", bool(self.stress)), ("friction", self.dissipation != 0)]
        effects = (type(effect).__name__.lower() for effect in self.model.effects)
        return (*(name for name, there in present if there), *dict.fromkeys(effects), *loaded)

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of all fields that occur: turn, twist, stress, wrench, orientation."""
        vectors = (self.turn, self.twist, self.stress, self.wrench, self.orientation.fields)
        present = field_names(self._sides())
        return tuple(name for vector in vectors for f in vector if (name := f.func.__name__) in present)

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
