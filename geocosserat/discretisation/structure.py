"""What a kernel has to contain for a model: which entries exist, and how each one varies.

This is the part of a model that decides the *text* of its kernel. Numbers are not in it: they are
sampled later and handed to the kernel as arguments, so one kernel serves every value of every parameter.
Entries that are literally zero leave no trace. No symbolic algebra happens here: a run whose kernel is
already built only needs this module.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from geocosserat.algebra.groups import Group, group_of
from geocosserat.model.effects.weight import Weight
from geocosserat.model.expressions import (
    Binary,
    Call,
    Expression,
    Negate,
    Number,
    Symbol,
    constant,
    symbols,
    to_text,
)
from geocosserat.model.records import End, RodModel

Place = Literal["uniform", "point", "node", "time"]
Row = tuple[str, ...]
Matrix = tuple[Row, ...]
ZERO, ONE = "0", "1"


@dataclass(frozen=True)
class Coefficient:
    """One named input of a kernel.

    place: "uniform" one number; "point" an array over Gauss points; "node" an array over nodes;
    "time" an expression that the kernel evaluates itself at each call, from t and `parameters` (and u).
    """

    name: str
    place: Place
    expression: Expression | None = None  # None: not one expression (an entry of the mobility)


@dataclass(frozen=True)
class Load:
    """Wrench on one end: names (or "0") of its components, in the body or in the world frame."""

    frame: Literal["body", "world"]
    wrench: Row


@dataclass(frozen=True)
class RodStructure:
    """The skeleton of a semi-discrete rod; equal structures have equal kernels.

    stiffness, mobility (d, d) and reference (d): names of coefficients, or "0", or "1".
    weight (space): names of the world components of the dead force density, or "0".
    base: where poses are marched from: the "left" or "right" end when that is held, else "carried":
    the pose of the left end is part of the state.
    """

    motion: Literal["planar", "spatial"]
    stiffness: Matrix
    reference: Row
    mobility: Matrix
    held: tuple[bool, bool]
    loads: tuple[Load | None, Load | None]
    weight: Row
    base: Literal["left", "right", "carried"]
    coefficients: tuple[Coefficient, ...]

    @property
    def group(self) -> Group:
        return group_of(self.motion)

    @property
    def world(self) -> bool:
        """Whether anything in the rod sees the world, so that orientations must be known."""
        return any(w != ZERO for w in self.weight) or any(
            load is not None and load.frame == "world" for load in self.loads
        )

    @property
    def carried(self) -> int:
        """Number of state entries that hold the pose of the left end (position and angle, or quaternion)."""
        if self.base != "carried":
            return 0
        return 3 if self.motion == "planar" else 7

    def at(self, place: Place) -> tuple[Coefficient, ...]:
        return tuple(c for c in self.coefficients if c.place == place)

    def describe(self) -> dict[str, object]:
        """JSON-like description; the kernel's identity is the hash of it."""
        return {
            "motion": self.motion,
            "stiffness": self.stiffness,
            "reference": self.reference,
            "mobility": self.mobility,
            "held": self.held,
            "loads": [None if load is None else [load.frame, load.wrench] for load in self.loads],
            "weight": self.weight,
            "base": self.base,
            "coefficients": [
                [c.name, c.place, to_text(c.expression) if c.place == "time" and c.expression else ""]
                for c in self.coefficients
            ],
        }


class _Collector:
    """Names the coefficients of a model, in order, once each."""

    def __init__(self) -> None:
        self.found: dict[str, Coefficient] = {}
        self.steps: dict[Expression, str] = {}

    def add(self, name: str, expression: Expression, varying: Place) -> str:
        """The name to use for `expression`; literal zero and one need none."""
        if constant(expression) == 0.0:
            return ZERO
        used = symbols(expression)
        if "t" in used:
            self.found[name] = Coefficient(name, "time", self.name_inputs(expression, varying))
        else:
            self.found[name] = Coefficient(name, varying if "u" in used else "uniform", expression)
        return name

    def name_inputs(self, e: Expression, varying: Place) -> Expression:
        """`e` in terms of t, u and coefficients: its parameters, and its steps along the rod (which are sampled from
        both sides of a node, like all else)."""
        match e:
            case Symbol(parameter) if parameter not in ("t", "u"):
                # a prefix keeps the user's names apart from those of the kernel
                self.found[f"p_{parameter}"] = Coefficient(f"p_{parameter}", "uniform", e)
                return Symbol(f"p_{parameter}")
            case Call("heaviside", argument) if "u" in symbols(argument):
                name = self.steps.setdefault(e, f"step_{len(self.steps) + 1}")
                self.found[name] = Coefficient(name, varying, e)
                return Symbol(name)
            case Call(function, argument):
                return Call(function, self.name_inputs(argument, varying))
            case Negate(operand):
                return Negate(self.name_inputs(operand, varying))
            case Binary(operator, left, right):
                return Binary(operator, self.name_inputs(left, varying), self.name_inputs(right, varying))
            case _:
                return e

    def symmetric(self, letter: str, matrix: Sequence[Sequence[Expression]]) -> Matrix:
        """Names of a symmetric matrix: both halves share a name."""
        d = len(matrix)
        names = [[ZERO] * d for _ in range(d)]
        for i in range(d):
            for j in range(i, d):
                names[i][j] = names[j][i] = self.add(f"{letter}_{i + 1}_{j + 1}", matrix[i][j], "point")
        return tuple(tuple(row) for row in names)

    def mobility(self, friction: Sequence[Sequence[Expression]]) -> Matrix:
        """Names of the inverse of the friction: each connected block of components has a full inverse."""
        d = len(friction)
        block = list(range(d))
        for i in range(d):
            for j in range(d):
                if constant(friction[i][j]) != 0.0:
                    low, high = sorted((block[i], block[j]))
                    block = [low if b == high else b for b in block]
        varies = {
            b: any("u" in symbols(friction[i][j]) for i in range(d) for j in range(d) if block[i] == block[j] == b)
            for b in set(block)
        }
        names = [[ZERO] * d for _ in range(d)]
        for i in range(d):
            for j in range(i, d):
                if block[i] == block[j]:
                    name = f"mobility_{i + 1}_{j + 1}"
                    self.found[name] = Coefficient(name, "node" if varies[block[i]] else "uniform")
                    names[i][j] = names[j][i] = name
        return tuple(tuple(row) for row in names)

    def load(self, side: str, end: End, group: Group) -> Load | None:
        if end.force is None and end.torque is None:
            return None
        nothing = (Number(0.0),)
        parts = (*(end.force or nothing * group.translations), *(end.torque or nothing * group.rotations))
        wrench = tuple(
            self.add(f"{side}_{name}", part, "uniform") for name, part in zip(group.wrench, parts, strict=True)
        )
        # in the plane a couple is the same in both frames: a world load without force sees no world
        forceless = all(w == ZERO for w in wrench[: group.translations])
        frame = "body" if forceless and group.rotations == 1 else end.frame
        return None if all(w == ZERO for w in wrench) else Load("world" if frame == "world" else "body", wrench)


def _total_weight(model: RodModel) -> tuple[Expression, ...]:
    total: list[Expression] = [Number(0.0)] * model.group.translations
    for effect in model.effects:
        if not isinstance(effect, Weight):
            raise TypeError(f"expected effects of kind weight, found {type(effect).__name__}")
        for i, force in enumerate(effect.force):
            if constant(force) != 0.0:
                total[i] = force if constant(total[i]) == 0.0 else Binary("+", total[i], force)
    return tuple(total)


def structure_of(model: RodModel) -> RodStructure:
    """The structure of the kernel that `model` calls for.

    Raises TypeError for an effect that the discretisation does not know.
    """
    group = model.group
    collect = _Collector()
    stiffness = collect.symmetric("k", model.stiffness)
    reference = tuple(
        ONE if constant(e) == 1.0 else collect.add(f"rest_{name}", e, "point")
        for name, e in zip(group.strain, model.reference, strict=True)
    )
    mobility = collect.mobility(model.friction)
    held = (model.left.kind == "clamped", model.right.kind == "clamped")
    loads = (collect.load("left", model.left, group), collect.load("right", model.right, group))
    weight = tuple(
        collect.add(f"weight_{axis}", force, "node") for axis, force in zip("xyz", _total_weight(model), strict=False)
    )
    return RodStructure(
        motion="planar" if group.translations == 2 else "spatial",
        stiffness=stiffness,
        reference=reference,
        mobility=mobility,
        held=held,
        loads=loads,
        weight=weight,
        base="left" if held[0] else "right" if held[1] else "carried",
        coefficients=tuple(collect.found.values()),
    )
