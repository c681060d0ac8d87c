"""Whether a rod at rest stays there, and where that changes: the record of `stability`."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geocosserat.results.solution import Solution
from geocosserat.results.summary import summary

Complex = NDArray[np.complex128]
Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Modes:
    """Small motions about a state of rest.

    growth (k,): rates, 1 / time, the fastest growing first: motions go as exp(growth t). shapes (k, nodes, space): how
    the nodes move, lengths, the largest of each motion 1; of a growth rate that is not real, in complex numbers. errors
    (k,): by how much the rates differ from those of another mesh, relative to each; infinite if there is none. neutral:
    how many vanish, for nothing resists those motions. unstable: how many grow.
    """

    growth: Complex
    shapes: Complex
    errors: Array
    neutral: int
    unstable: int

    @property
    def stable(self) -> bool:
        """Whether no small motion grows."""
        return self.unstable == 0


@dataclass(frozen=True)
class Point:
    """A state of rest on a branch: the value that is varied, the leading growth rate and its frequency (1 / time), and
    the position of the right end."""

    value: float
    growth: float
    frequency: float
    tip: tuple[float, ...]


@dataclass(frozen=True)
class Critical:
    """A value at which a growth rate passes zero.

    kind: "divergence" or "flutter". frequency: of flutter, radians per time. gains: the rate becomes positive; lost:
    and none was before. fold: the branch turns back there. error: by how much the values of two meshes differ, or None
    if a finer one was not asked for, or has no such crossing.
    """

    value: float
    kind: str
    frequency: float
    gains: bool
    lost: bool
    fold: bool
    error: float | None

    @property
    def fields(self) -> dict[str, Any]:
        return {
            "value": self.value,
            "kind": self.kind,
            "frequency": self.frequency if self.kind == "flutter" else None,
            "gains": self.gains,
            "lost": self.lost,
            "fold": self.fold,
            "error": self.error,
        }


@dataclass(frozen=True)
class Followed:
    """States of rest while one value changes.

    branches: the first is that of the scene; others leave it where it loses stability. crossings: on the first, in its
    order. reason: why the branch was not followed to the end, or nothing.
    """

    key: str
    interval: tuple[float, float]
    branches: tuple[tuple[Point, ...], ...]
    crossings: tuple[Critical, ...]
    reason: str

    @property
    def critical(self) -> Critical | None:
        """The first loss of stability."""
        return next((crossing for crossing in self.crossings if crossing.lost), None)


@dataclass(frozen=True, eq=False)
class Map:
    """The leading growth rate over two values: growth (rows, columns), rows by the second key; NaN where no state of
    rest was found."""

    keys: tuple[str, str]
    first: Array
    second: Array
    growth: Array


@dataclass(frozen=True, eq=False)
class Stability:
    """What `stability` finds: the state of rest, small motions about it, and what becomes of both."""

    solution: Solution
    residual: float
    modes: Modes
    scene: str | None
    followed: Followed | None = None
    map: Map | None = None
    files: Sequence[str] = field(default=())

    @property
    def fields(self) -> dict[str, Any]:
        """In plain JSON types."""
        return {**rest_fields(self.solution, self.residual, self.modes, self.files, self.scene), **self._over()}

    def _over(self) -> dict[str, Any]:
        found: dict[str, Any] = {}
        if self.followed is not None:
            critical = self.followed.critical
            found |= {
                "over": self.followed.key,
                "interval": list(self.followed.interval),
                "critical": None if critical is None else critical.fields,
                "crossings": [crossing.fields for crossing in self.followed.crossings],
                "branches": [
                    [asdict(point) for point in branch]
                    for branch in self.followed.branches
                ],
                "reason": self.followed.reason,
            }
        if self.map is not None:
            rows = [[None if np.isnan(x) else float(x) for x in row] for row in self.map.growth]
            found["map"] = {
                "over": list(self.map.keys),
                "values": [self.map.first.tolist(), self.map.second.tolist()],
                "growth": rows,
            }
        return found


def rest_fields(
    solution: Solution, residual: float, modes: Modes, files: Sequence[str | os.PathLike[str]], scene: str | None = None
) -> dict[str, Any]:
    """The fields of a run, of a state of rest, with its residual and stability."""
    return {
        **summary(solution, files, scene=scene),
        "residual": residual,
        "stable": modes.stable,
        "unstable": modes.unstable,
        "neutral": modes.neutral,
        "eigenvalues": [[float(g.real), float(g.imag)] for g in modes.growth],
        "eigenvalue_errors": [float(e) if np.isfinite(e) else None for e in modes.errors],
    }
