"""From a model to the structure of its kernel: everything that varies gets a name and a place."""

from collections.abc import Sequence
from dataclasses import replace

from geocosserat.algebra.groups import Group
from geocosserat.discretisation.structure import (
    ONE,
    ZERO,
    Coefficient,
    EndStructure,
    Formulas,
    LawStructure,
    Matrix,
    Place,
    RodStructure,
    guide,
    present,
)
from geocosserat.model.effects.effect import Effect, together
from geocosserat.model.effects.law_wrench import LawWrench
from geocosserat.model.expressions import (
    Binary,
    Call,
    Expression,
    Negate,
    Number,
    Symbol,
    constant,
    derivative,
    fixed,
    substitute,
    symbols,
)
from geocosserat.model.law import Law, at_rest, rates
from geocosserat.model.records import End, RodModel
from geocosserat.model.seen import AXES, Seen, cross, nothing, seen

FIRMNESS = ("free", "pinned", "clamped", "driven")
"""Kinds of end, the later the better to march poses from: the other end, if it does not move, is held in its place."""


class _Names:
    """Names the coefficients of a model, in order, once each."""

    def __init__(self) -> None:
        self.found: dict[str, Coefficient] = {}
        self.steps: dict[tuple[Expression, Place], str] = {}

    def add(self, name: str, expression: Expression, varying: Place) -> str:
        """The name to use for `expression`; a literal zero needs none."""
        if constant(expression) == 0.0:
            return ZERO
        used = symbols(expression)
        place: Place = varying if "u" in used else "uniform"
        timed = "t" in used
        written = self._inputs(expression, varying) if timed else expression
        self.found[name] = Coefficient(name, place, written, timed)
        return name

    def formula(self, name: str, expression: Expression, varying: Place) -> Expression:
        """The same as a symbol, or zero."""
        named = self.add(name, expression, varying)
        return Number(0.0) if named == ZERO else Symbol(named)

    def _inputs(self, e: Expression, varying: Place, kept: Sequence[str] = ("t", "u")) -> Expression:
        """`e` in terms of t, u (or what else is kept) and coefficients: its parameters, and its steps along the rod
        (which are sampled from both sides of a node, like all else)."""
        match e:
            case Symbol(parameter) if parameter not in kept:
                # a prefix keeps the user's names apart from those of the kernel
                self.found[f"p_{parameter}"] = Coefficient(f"p_{parameter}", "uniform", e)
                return Symbol(f"p_{parameter}")
            case Call("heaviside", argument) if "u" in symbols(argument):
                name = self.steps.setdefault((e, varying), f"step_{len(self.steps) + 1}")
                self.found[name] = Coefficient(name, varying, e)
                return Symbol(name)
            case Call(function, argument):
                return Call(function, self._inputs(argument, varying, kept))
            case Negate(operand):
                return Negate(self._inputs(operand, varying, kept))
            case Binary(operator, left, right):
                return Binary(operator, self._inputs(left, varying, kept), self._inputs(right, varying, kept))
            case _:
                return e

    def law(self, e: Expression, group: Group) -> Expression:
        """`e` in terms of t, the turn, its rates, the stress and coefficients; u is one of them."""
        written = self._inputs(e, "point", ("t", "u", *group.strain, *rates(group), *group.stress))
        if "u" not in symbols(written):
            return written
        self.found["along"] = Coefficient("along", "point", Symbol("u"))
        return substitute(written, {"u": Symbol("along")})

    def sampled(self, name: str) -> Expression:
        """A number that is no expression of the scene's."""
        self.found[name] = Coefficient(name, "uniform")
        return Symbol(name)

    def stiffness(self, matrix: Sequence[Sequence[Expression]], frozen: Sequence[bool]) -> Matrix:
        """Names of a symmetric matrix: both halves share a name; frozen modes have none."""
        d = len(matrix)
        names = [[ZERO] * d for _ in range(d)]
        for i in range(d):
            for j in range(i, d):
                if not (frozen[i] or frozen[j]):
                    names[i][j] = names[j][i] = self.add(f"k_{i + 1}_{j + 1}", matrix[i][j], "point")
        return tuple(tuple(row) for row in names)

    def entries(self, stem: str, pattern: Sequence[Sequence[bool]], places: Sequence[Place]) -> Matrix:
        """Names of a symmetric matrix that is sampled as a whole, where the pattern has entries; a place each row."""
        d = len(pattern)
        names = [[ZERO] * d for _ in range(d)]
        for i in range(d):
            for j in range(i, d):
                if pattern[i][j]:
                    name = f"{stem}_{i + 1}_{j + 1}"
                    self.found[name] = Coefficient(name, places[i])
                    names[i][j] = names[j][i] = name
        return tuple(tuple(row) for row in names)


def _connected(matrix: Sequence[Sequence[Expression]]) -> list[int]:
    """For each component the first one that it is coupled to, directly or not: the inverse couples the same ones."""
    d = len(matrix)
    block = list(range(d))
    for i in range(d):
        for j in range(d):
            if constant(matrix[i][j]) != 0.0:
                low, high = sorted((block[i], block[j]))
                block = [low if b == high else b for b in block]
    return block


def _mobility(names: _Names, friction: Sequence[Sequence[Expression]]) -> Matrix:
    """Names of the inverse of the friction."""
    d, block = len(friction), _connected(friction)
    varies = {
        b: any("u" in symbols(friction[i][j]) for i in range(d) for j in range(d) if block[i] == block[j] == b)
        for b in set(block)
    }
    places: list[Place] = ["node" if varies[b] else "uniform" for b in block]
    return names.entries("mobility", [[a == b for b in block] for a in block], places)


def _load(names: _Names, side: str, end: End, group: Group) -> Formulas:
    if end.force is None and end.torque is None:
        return ()
    nothing = (Number(0.0),)
    parts = (*(end.force or nothing * group.translations), *(end.torque or nothing * group.rotations))
    named = [names.formula(f"{side}_{name}", part, "uniform") for name, part in zip(group.wrench, parts, strict=True)]
    if not present(tuple(named)):
        return ()
    if end.frame == "world":
        frame, force, torque = seen(group.space), named[: group.translations], named[group.translations :]
        named = [*frame.to_body(force), *(frame.to_body(torque) if group.rotations > 1 else torque)]
    return tuple(named)


def _end(names: _Names, side: str, end: End, model: RodModel, dragged: bool) -> EndStructure:
    group = model.group
    d, uniform = group.dimension, ["uniform"] * group.dimension
    twist: Formulas = nothing({"clamped": d, "pinned": group.translations}.get(end.kind, 0))
    mobility = friction = None
    block = _connected(model.friction)
    if end.kind == "driven" and end.twist is not None:
        twist = tuple(
            names.formula(f"{side}_{name}", e, "uniform") for name, e in zip(group.twist, end.twist, strict=True)
        )
    if end.kind == "driven" or (dragged and end.kind != "free"):
        friction = names.entries(f"{side}_friction", [[a == b for b in block] for a in block], uniform)  # type: ignore[arg-type]
    if end.kind == "pinned":
        turns = range(group.translations, d)
        pattern = [[block[i] == block[j] and i in turns and j in turns for j in range(d)] for i in range(d)]
        mobility = names.entries(f"{side}_mobility", pattern, uniform)  # type: ignore[arg-type]
    return EndStructure(end.kind, twist, _load(names, side, end, group), mobility, friction)


def _stirred(model: RodModel) -> bool:
    """Whether something may move the rod for ever: anything timed, a medium that flows, a load without a potential."""
    frame = seen(model.group.space)
    ends = (model.left, model.right)
    if any(end.kind == "driven" or end.force or end.torque for end in ends):
        return True
    timed = any("t" in symbols(e) for e in (*model.reference, *((model.law.stress or ()) if model.law else ())))
    timed |= any("t" in symbols(e) for effect in model.effects for value in effect.values().values() for e in value)
    flows = any(present((*velocity, *spin)) for velocity, spin in (e.medium(frame) for e in model.effects))
    return timed or flows or any(effect.potential(frame) is None for effect in model.effects)


def _homing(names: _Names, side: str, end: EndStructure, space: int) -> EndStructure:
    """The same end, drawn back to its place by as much as it strays from there.

    Where the base of the poses is the other end, nothing but the strains says where this one is, and those carry the
    error of the scheme: once, where the rod settles, but over and over where it is stirred. So its twist is not just
    what is prescribed but less pull times its distance from home: that changes nothing but that error.
    """
    frame = seen(space)
    home = _guide(space) if end.kind == "driven" else _place(names, side, end.kind, space)
    back = frame.to_body(tuple(there - here for there, here in zip(home.position, frame.position, strict=True)))
    if home.axes:
        sights = [frame.to_body([row[i] for row in home.axes]) for i in range(space)]  # its axes as this end sees them
        units = [tuple(Number(float(i == j)) for j in range(space)) for i in range(space)]
        turns = [cross(unit, sight) for unit, sight in zip(units, sights, strict=True)]
        back = (*back, *(turns[0] if space == 2 else (0.5 * x for x in together(turns, 3))))
    pull = names.sampled(f"{side}_pull")
    prescribed = end.twist or nothing(len(back))
    return replace(end, twist=tuple(x + pull * y for x, y in zip(prescribed, back, strict=True)))


def _place(names: _Names, side: str, kind: str, space: int) -> Seen:
    """Where an end belongs that stays where it is, and, if it is clamped, how it is turned there."""
    position = tuple(names.sampled(f"{side}_home_{axis}") for axis in AXES[:space])
    if kind == "pinned":
        return Seen((), position)
    if space == 2:
        c, s = names.sampled(f"{side}_home_cos"), names.sampled(f"{side}_home_sin")
        return Seen(((c, -s), (s, c)), position)
    axes = tuple(tuple(names.sampled(f"{side}_home_{i}{axis}") for i in (1, 2, 3)) for axis in AXES)
    return Seen(axes, position)


def _guide(space: int) -> Seen:
    """Where an end belongs that follows a course, and how it is turned there."""
    position = tuple(Symbol(name) for name in guide(space)[:space])
    if space == 2:
        angle = Symbol(guide(space)[2])
        c, s = Call("cos", angle), Call("sin", angle)
        return Seen(((c, -s), (s, c)), position)
    a, *v = (Symbol(name) for name in guide(space)[3:])
    # of a unit quaternion
    rows = []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        row: list[Expression] = [Number(0.0)] * 3
        row[i] = 1.0 - 2.0 * (v[j] * v[j] + v[k] * v[k])
        row[j] = 2.0 * (v[i] * v[j] - a * v[k])
        row[k] = 2.0 * (v[i] * v[k] + a * v[j])
        rows.append(tuple(row))
    return Seen(tuple(rows), position)


def _named_effects(names: _Names, effects: Sequence[Effect]) -> list[Effect]:
    """The effects with every value replaced by the symbol of its coefficient."""
    found: list[Effect] = []
    for effect in effects:
        same = sum(other.kind == effect.kind for other in found)
        stem = effect.kind if same == 0 else f"{effect.kind}{same + 1}"

        def name(key: str, i: int, e: Expression, stem: str = stem) -> Expression:
            return names.formula(f"{stem}_{key}_{i + 1}", e, "node")

        found.append(effect.renamed(name))
    return found


def _law(names: _Names, law: Law, group: Group, frozen: Sequence[bool]) -> LawStructure:
    """The law of the modes that are free, where the others rest. Without an energy that is known, the whole stress
    stores nothing."""
    assert law.stress is not None
    zero = Number(0.0)
    stress = [zero if held else _resting(e, group, frozen) for e, held in zip(law.stress, frozen, strict=True)]
    energy = law.energy if law.energy is not None else zero
    remainder = list(law.remainder) if law.energy is not None else stress
    for i, name in enumerate(group.stress):
        if not symbols(stress[i]).isdisjoint(rates(group)):
            # the whole stress, as the state has it, less what stores
            remainder = remainder or [zero] * group.dimension
            storing = zero if law.energy is None else at_rest(stress[i], group) - remainder[i]
            remainder = [*remainder[:i], Symbol(name) - storing, *remainder[i + 1 :]]

    def free(formulas: Sequence[Expression]) -> Formulas:
        return tuple(names.law(zero if held else e, group) for e, held in zip(formulas, frozen, strict=True))

    return LawStructure(
        stress=free(stress),
        energy=names.law(energy, group),
        remainder=free(remainder) if remainder else (),
        supply=names.law(derivative(energy, "t"), group),
    )


def _resting(e: Expression, group: Group, frozen: Sequence[bool]) -> Expression:
    """A formula where frozen modes do not change."""
    for rate, held in zip(rates(group), frozen, strict=True):
        e = fixed(e, rate, 0.0) if held else e
    return e


def structure_of(model: RodModel, anchored: bool = False) -> RodStructure:
    """The structure of the kernel that `model` calls for. anchored: an end that the march of poses does not hold is
    drawn to its place even where nothing stirs the rod, so that the rate alone says where the rod can rest."""
    group, names = model.group, _Names()
    frozen = model.held
    law = _law(names, model.law, group, frozen) if model.law else None
    if law is None:
        stiffness = names.stiffness(model.stiffness, frozen)
    else:
        stiffness = ((ZERO,) * group.dimension,) * group.dimension
    reference = tuple(
        ZERO if law and not held else ONE if constant(e) == 1.0 else names.add(f"rest_{name}", e, "point")
        for name, e, held in zip(group.strain, model.reference, frozen, strict=True)
    )
    reference_rate = tuple(
        names.add(f"rate_{name}", derivative(e, "t"), "point")
        for name, e in zip(group.strain, model.reference, strict=True)
    )
    mobility = _mobility(names, model.friction)
    frame = seen(group.space)
    effects = _named_effects(names, model.effects)
    pushes = [sum(effect.wrench(frame), ()) for effect in effects]
    wrench = together(pushes, group.dimension)
    gives = [isinstance(effect, LawWrench) and effect.gives for effect in effects]
    own = together((push for push, mine in zip(pushes, gives, strict=True) if mine), group.dimension)
    medium = together(((*flow, *spin) for flow, spin in (e.medium(frame) for e in effects)), group.dimension)
    sides = (("left", model.left), ("right", model.right))
    left, right = (_end(names, side, end, model, present(medium)) for side, end in sides)
    base = "left" if FIRMNESS.index(model.left.kind) >= FIRMNESS.index(model.right.kind) else "right"
    held = model.joined or "free" not in (model.left.kind, model.right.kind)
    stirred = held and not model.joined and (anchored or _stirred(model))
    if stirred and base == "left":
        right = _homing(names, "right", right, group.space)
    elif stirred:
        left = _homing(names, "left", left, group.space)
    for stress, frozen_mode in zip(group.stress, frozen, strict=True):
        if held and frozen_mode:
            names.sampled(f"slack_{stress}")
    return RodStructure(
        motion="planar" if group.translations == 2 else "spatial",
        frozen=frozen,
        stiffness=stiffness,
        reference=reference,
        reference_rate=reference_rate,
        mobility=mobility,
        left=left,
        right=right,
        joined=model.joined,
        wrench=wrench,
        medium=medium,
        base="left" if base == "left" else "right",
        moving_base=(left if base == "left" else right).kind != "clamped",
        coefficients=tuple(names.found.values()),
        law=law,
        own=own if present(own) else (),
    )
