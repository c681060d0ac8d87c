"""What a scene says, as frozen records: the rod, its ends, its effects, the start and the run.

Expressions keep the names of parameters, ``u`` (the material coordinate, 0 to length) and ``t``; the values
of the parameters are in ``RodModel.parameters``. ``s`` has been rewritten to ``u/length``.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from geocosserat.algebra.groups import Group
from geocosserat.model.describe import matrix_text, named_text, number_text, vector_text
from geocosserat.model.effects.effect import Effect
from geocosserat.model.expressions import Expression
from geocosserat.model.law import Law

Vector: TypeAlias = tuple[Expression, ...]
Matrix: TypeAlias = tuple[tuple[Expression, ...], ...]
Frame: TypeAlias = Literal["body", "world"]
Backend: TypeAlias = Literal["auto", "c", "numpy"]


@dataclass(frozen=True, slots=True)
class End:
    """One end of the rod.

    ``kind``: "clamped" (does not move), "free", "pinned" (turns about a fixed point) or "driven". ``force`` (force, 2
    or 3 components) and ``torque`` (force x length, 1 component in the plane, 3 in space) are the load on a free end,
    on a pinned one only the torque, expressions of ``t``; None where there is none. ``frame``: "body" (the load turns
    with the end) or "world" (a dead load). ``twist``: of a driven end, in its moving frame, expressions of ``t``.
    """

    kind: str
    force: Vector | None = None
    torque: Vector | None = None
    frame: Frame = "body"
    twist: Vector | None = None

    def __str__(self) -> str:
        if self.twist is not None:
            return f"{self.kind} with twist {vector_text(self.twist)}"
        load = [f"{name} {vector_text(value)}" for name, value in self._loads()]
        return ", ".join([self.kind, *load, *([f"fixed in the {self.frame}"] if load else [])])

    def _loads(self) -> Iterator[tuple[str, Vector]]:
        if self.force is not None:
            yield "force", self.force
        if self.torque is not None:
            yield "torque", self.torque


@dataclass(frozen=True, slots=True)
class RodModel:
    """The rod and what acts on it: everything the equations of motion are derived from.

    ``length``: at rest. ``stiffness``: K, d x d, symmetric and positive definite, in the order of
    ``group.strain`` (force for stretch and shear, force x length² for bend and twist), expressions of ``u``.
    ``friction``: Γ, likewise in the order of ``group.twist`` (force x time / length² for translations, force
    x time for rotations), where a rotation may have none. ``reference``: the turn at rest, expressions of ``u`` and,
    if it is active, of ``t``. ``frozen``: modes held at their reference, whatever their stiffness. ``joined``: the ends
    are one point; ``left`` and ``right`` are then free of load. ``law``: what gives the stress in place of the
    stiffness, which then is the law's tangent at the reference and says no more than how stiff the rod is about.
    """

    group: Group
    length: float
    stiffness: Matrix
    friction: Matrix
    reference: Vector
    frozen: tuple[str, ...] = ()
    left: End = End("clamped")
    right: End = End("free")
    effects: tuple[Effect, ...] = ()
    joined: bool = False
    parameters: Mapping[str, float] = field(default_factory=dict)
    law: Law | None = None

    @property
    def held(self) -> tuple[bool, ...]:
        """For each mode, whether it is frozen."""
        return tuple(name in self.frozen for name in self.group.strain)

    def __str__(self) -> str:
        group = self.group
        lines = [
            f"rod in {group.name}, length {number_text(self.length)}",
            *self._elasticity(),
            f"  friction   {matrix_text(self.friction, group.twist)}",
            f"  reference  {named_text(self.reference, group.strain)}",
            *([f"  frozen     {', '.join(self.frozen)}"] if self.frozen else []),
            *(["  ends       joined"] if self.joined else [f"  left end   {self.left}", f"  right end  {self.right}"]),
            *(f"  effect     {effect}" for effect in self.effects),
        ]
        if self.parameters:
            values = (f"{name} = {number_text(value)}" for name, value in self.parameters.items())
            lines.append(f"  parameters {', '.join(values)}")
        return "\n".join(lines)

    def _elasticity(self) -> Iterator[str]:
        if self.law is None:
            yield f"  stiffness  {matrix_text(self.stiffness, self.group.strain)}"
        elif self.law.stress is not None:
            yield f"  law        {self.law.name}"
            yield f"  stress     {named_text(self.law.stress, self.group.stress)}"


@dataclass(frozen=True, slots=True)
class Start:
    """The rod at time 0.

    ``strain``: the turn, expressions of ``u``. ``position`` of the left end (length, world). ``rotation`` of
    the left end (radians): the angle in the plane, a rotation vector in space.
    """

    strain: Vector
    position: tuple[float, ...]
    rotation: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class RunSettings:
    """How long and how accurately to simulate; None leaves a choice to the planner.

    ``until``: final time. ``frames``: instants kept, 0 and ``until`` among them. ``accuracy``: position error
    at the end relative to the length. ``rtol``, ``atol``: of the time integrator.
    """

    until: float
    frames: int = 51
    accuracy: float | None = None
    elements: int | None = None
    degree: int | None = None
    method: str | None = None
    rtol: float | None = None
    atol: float | None = None
    backend: Backend = "auto"

    def __str__(self) -> str:
        chosen = (
            f"{name} {value if isinstance(value, str) else number_text(value)}"
            for name in ("accuracy", "elements", "degree", "method", "rtol", "atol")
            if (value := getattr(self, name)) is not None
        )
        return ", ".join(
            [f"until {number_text(self.until)}", f"{self.frames} frames", *chosen, f"backend {self.backend}"]
        )


@dataclass(frozen=True, slots=True)
class Scene:
    """A whole scene. ``source`` is TOML text that loads to this scene, ``path`` the file it came from."""

    title: str
    model: RodModel
    start: Start
    run: RunSettings
    source: str
    path: str | None = None

    def __str__(self) -> str:
        place = ", ".join(number_text(x) for x in self.start.position)
        turn = ", ".join(number_text(x) for x in self.start.rotation)
        return "\n".join(
            [
                self.title,
                str(self.model),
                f"  start      {named_text(self.start.strain, self.model.group.strain)}",
                f"             left end at ({place}), rotation ({turn})",
                f"  run        {self.run}",
            ]
        )
