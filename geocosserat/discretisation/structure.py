"""What a kernel has to contain for a model: which entries exist, and how each one varies.

This is the part of a model that decides the *text* of its kernel. Numbers are not in it: they are
sampled later and handed to the kernel as arguments, so one kernel serves every value of every parameter.
Entries that are literally zero leave no trace. No symbolic algebra happens here: a run whose kernel is
already built only needs this module.
"""

from dataclasses import dataclass
from typing import Literal

from geocosserat.algebra.groups import Group, group_of
from geocosserat.model.expressions import Expression, Number, symbols, to_text
from geocosserat.model.law import rates

Place = Literal["uniform", "point", "node"]
Sight = Literal["nothing", "direction", "pose"]
Row = tuple[str, ...]
Matrix = tuple[Row, ...]
Formulas = tuple[Expression, ...]
ZERO, ONE = "0", "1"


@dataclass(frozen=True)
class Coefficient:
    """One named input of a kernel.

    place: "uniform" one number; "point" an array over Gauss points; "node" an array over nodes.
    timed: not an argument but evaluated by the kernel at each call, from t, coefficients called p_... and steps, and u.
    """

    name: str
    place: Place
    expression: Expression | None = None  # None: not one expression (an entry of the friction or its inverse)
    timed: bool = False


@dataclass(frozen=True)
class EndStructure:
    """What a kernel does at one end.

    twist: its prescribed components, all d or, of a pinned end, the translations; formulas of coefficients and of what
    is seen; empty if none is prescribed. load (d): likewise, components in the moving frame; empty if there is none.
    mobility, friction (d, d): names of entries that only this end needs: of a pinned end the inverse of the friction of
    its rotations; of a driven one, and of any that is held in a medium that moves, the friction; None elsewhere.
    """

    kind: str
    twist: Formulas = ()
    load: Formulas = ()
    mobility: Matrix | None = None
    friction: Matrix | None = None

    def describe(self) -> list[object]:
        twist, load = ([to_text(e) for e in formulas] for formulas in (self.twist, self.load))
        return [self.kind, twist, load, self.mobility, self.friction]


@dataclass(frozen=True)
class LawStructure:
    """A law in place of a stiffness: formulas of the turn and its rates by the names of their components, coefficients
    and t.

    stress (d). energy: density of what is stored. remainder: the part of the stress that stores nothing, d formulas,
    or none; of a viscous mode by the name of its stress. supply: power density of what changes the law in time.
    """

    stress: Formulas
    energy: Expression
    remainder: Formulas
    supply: Expression

    def describe(self) -> list[object]:
        return [[to_text(e) for e in f] for f in (self.stress, (self.energy,), self.remainder, (self.supply,))]


@dataclass(frozen=True)
class RodStructure:
    """The skeleton of a semi-discrete rod; equal structures have equal kernels.

    frozen (d): the modes held at their reference; their stress takes their place in the state.
    viscous (d): the modes whose stress answers to rates of strain; it has a place of its own in the state, after the
    turn, since the rates follow from it.
    stiffness, mobility (d, d) and reference, reference_rate (d): names of coefficients, or "0", or "1".
    law: instead of the stiffness; reference is then that of frozen modes alone.
    own: the part of the wrench whose work is a loss of the rod, less than nothing, d formulas; empty if there is none.
    wrench, medium (d): density of wrench, and twist of the medium, in the moving frame: formulas of coefficients and
    of what is seen. base: the end that poses are marched from. Where it moves, its pose is part of the state (carried),
    unless it is driven: that pose follows from the time alone (prescribed).
    """

    motion: Literal["planar", "spatial"]
    frozen: tuple[bool, ...]
    stiffness: Matrix
    reference: Row
    reference_rate: Row
    mobility: Matrix
    left: EndStructure
    right: EndStructure
    joined: bool
    wrench: Formulas
    medium: Formulas
    base: Literal["left", "right"]
    moving_base: bool
    coefficients: tuple[Coefficient, ...]
    law: LawStructure | None = None
    own: Formulas = ()

    @property
    def group(self) -> Group:
        return group_of(self.motion)

    @property
    def viscous(self) -> tuple[bool, ...]:
        """For each mode, whether its stress answers to rates of strain."""
        stress = self.law.stress if self.law else (Number(0.0),) * self.group.dimension
        return tuple(not symbols(e).isdisjoint(rates(self.group)) for e in stress)

    @property
    def state_names(self) -> Row:
        """What the state holds at each point, row by row: the turn, of frozen modes the stress; then that of viscous
        ones."""
        group = self.group
        turn = (s if held else e for e, s, held in zip(group.strain, group.stress, self.frozen, strict=True))
        return (*turn, *(s for s, here in zip(group.stress, self.viscous, strict=True) if here))

    @property
    def constrained(self) -> tuple[bool, ...]:
        """For each of these rows, whether it is a stress that a constraint fixes."""
        return (*self.frozen, *(True for here in self.viscous if here))

    @property
    def sight(self) -> Sight:
        """What of the rod's pose its loads depend on."""
        formulas = [*self.wrench, *self.medium]
        for end in (self.left, self.right):
            formulas += [*end.twist, *end.load]
        seen = {name.split(".")[0] for e in formulas for name in symbols(e)}
        return "pose" if "place" in seen else "direction" if "frame" in seen else "nothing"

    @property
    def increments(self) -> int:
        """How many small changes of pose the loads answer to: rotations, then translations."""
        group = self.group
        return {"nothing": 0, "direction": group.rotations, "pose": group.dimension}[self.sight]

    @property
    def prescribed(self) -> bool:
        """Whether the pose of the base follows from the time alone, for it is driven."""
        return (self.left if self.base == "left" else self.right).kind == "driven"

    @property
    def guided(self) -> bool:
        """Whether both ends are driven: then the other one is drawn to where it belongs, which follows likewise."""
        return self.left.kind == self.right.kind == "driven"

    @property
    def carried(self) -> int:
        """Number of state entries that hold the pose of the base (position and angle, or quaternion)."""
        if self.prescribed or not self.moving_base:
            return 0
        return 3 if self.motion == "planar" else 7

    @property
    def indeterminate(self) -> bool:
        """Whether both ends are held (or joined) and modes are frozen: then a stress may have no unique value."""
        held = self.joined or "free" not in (self.left.kind, self.right.kind)
        return held and any(self.frozen)

    @property
    def active(self) -> bool:
        """Whether the reference, or the law itself, changes in time."""
        changing = self.law is not None and self.law.supply != Number(0.0)
        return changing or any(name != ZERO for name in self.reference_rate)

    @property
    def losing(self) -> bool:
        """Whether part of the stress stores nothing, viscous or not."""
        return self.law is not None and present(self.law.remainder)

    @property
    def dragged(self) -> bool:
        """Whether the medium moves."""
        return present(self.medium)

    def at(self, place: Place) -> tuple[Coefficient, ...]:
        """The arguments of one kind, in order."""
        return tuple(c for c in self.coefficients if c.place == place and not c.timed)

    @property
    def timed(self) -> tuple[Coefficient, ...]:
        """Coefficients that the kernel evaluates itself."""
        return tuple(c for c in self.coefficients if c.timed)

    def describe(self) -> dict[str, object]:
        """JSON-like description; the kernel's identity is the hash of it."""
        return {
            "motion": self.motion,
            "frozen": self.frozen,
            "stiffness": self.stiffness,
            "reference": self.reference,
            "reference_rate": self.reference_rate,
            "mobility": self.mobility,
            "left": self.left.describe(),
            "right": self.right.describe(),
            "joined": self.joined,
            "wrench": [to_text(e) for e in self.wrench],
            "medium": [to_text(e) for e in self.medium],
            "base": self.base,
            "moving_base": self.moving_base,
            "law": self.law.describe() if self.law else None,
            "own": [to_text(e) for e in self.own],
            "coefficients": [
                [c.name, c.place, to_text(c.expression) if c.timed and c.expression else ""] for c in self.coefficients
            ],
        }


def guide(space: int) -> Row:
    """Names of the pose of a course, as formulas use them: position and angle, or position and quaternion."""
    return tuple(f"home.{name}" for name in (("x", "y", "angle") if space == 2 else "xyzabcd"))


def present(formulas: Formulas) -> bool:
    """Whether any of them is not literally zero."""
    return any(e != Number(0.0) for e in formulas)
