"""What accuracy costs in time, measured for one scene: the record, and which of its points nobody need go beyond."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

AS_GIVEN = "as given"
RESOLVED = 100.0
"""An error is told by a reference that is at least so many times as exact."""


@dataclass(frozen=True)
class Point:
    """One way to compute the scene. error: of positions at the end, relative to the length; None if the run failed.

    model: which modes are frozen, in words. seconds, median: of an integration, the least and the median of `repeats`.
    reason: why it failed.
    """

    model: str
    method: str
    elements: int
    degree: int
    rtol: float
    unknowns: int
    error: float | None
    seconds: float
    median: float
    repeats: int
    rates: int
    jacobians: int
    steps: int
    reason: str


@dataclass(frozen=True)
class ModelError:
    """What a model leaves out: its own error, however finely it is computed; None if that is not known, and why."""

    model: str
    frozen: tuple[str, ...]
    error: float | None
    reason: str


@dataclass(frozen=True)
class Reference:
    """What counts as exact, and its own error, estimated cautiously."""

    method: str
    elements: int
    degree: int
    rtol: float
    error: float


@dataclass(frozen=True)
class Diagram:
    """Errors and seconds of a scene over methods, meshes, tolerances and models.

    reference: None if there is none, for the reason given; then there is nothing to measure errors by. left_out: how
    many ways were not tried for want of time. machine: what it was measured on, in words.
    """

    scene: str
    title: str
    points: tuple[Point, ...]
    models: tuple[ModelError, ...]
    reference: Reference | None
    left_out: int
    machine: Mapping[str, str]
    reason: str = ""

    @property
    def floor(self) -> float:
        """Errors below this are not told apart by the reference."""
        return RESOLVED * self.reference.error if self.reference else 0.0

    @property
    def reached(self) -> bool:
        """Whether any way came to its end."""
        return any(point.error is not None for point in self.points)

    @property
    def front(self) -> tuple[int, ...]:
        """The points that no other one beats in both error and seconds, from the fastest on. Errors below the floor
        count as the floor."""
        best, found = math.inf, []
        numbered = [(p.seconds, max(p.error, self.floor), i) for i, p in enumerate(self.points) if p.error is not None]
        for _, error, i in sorted(numbered):
            if error < best:
                best = error
                found.append(i)
        return tuple(found)

    @property
    def fields(self) -> dict[str, Any]:
        """In plain JSON types."""
        return {
            "scene": self.scene,
            "title": self.title,
            "points": [asdict(point) for point in self.points],
            "front": list(self.front),
            "models": [{**asdict(model), "frozen": list(model.frozen)} for model in self.models],
            "reference": {**asdict(self.reference), "floor": self.floor} if self.reference else None,
            "reached": self.reached,
            "reason": self.reason,
            "left_out": self.left_out,
            "machine": dict(self.machine),
        }
