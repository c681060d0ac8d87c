"""The result of a run: pure data, the contract between the solver's side and all that reads results."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geocosserat.algebra.groups import Group, group_of

Array = NDArray[np.float64]

# dimensions of every array; `component` counts 3 or 6, `axis` and `frame` 2 or 3
SHAPES: Mapping[str, tuple[str, ...]] = {
    "time": ("time",),
    "u": ("node",),
    "u_point": ("point",),
    "position": ("time", "node", "axis"),
    "rotation": ("time", "node", "axis", "frame"),
    "angle": ("time", "node"),
    "twist": ("time", "node", "component"),
    "turn": ("time", "point", "component"),
    "stress": ("time", "point", "component"),
    "energy": ("time",),
    "dissipated": ("time",),
    "work": ("time",),
}
TEXTS = ("scene", "title", "motion", "method", "backend", "reason")
EVALUATIONS = ("rate", "jacobian", "steps")
SECONDS = ("derive", "compile", "plan", "solve")


@dataclass(frozen=True, eq=False, repr=False)
class Solution:
    """A rod over time: T frames, Q = elements x degree Gauss points, N = Q + 1 nodes, d components.

    scene, title      text of the scene (TOML) and its title
    motion            "planar" (d = 3) or "spatial" (d = 6)
    length            length of the rod at rest
    time (T,)         a time;  u (N,), u_point (Q,)  lengths along the rod at rest
    position (T, N, axis)         a length, world components
    rotation (T, N, axis, frame)  R, column i is the frame vector e_i
    angle (T, N)      of e_1 to the x axis, unwrapped, in the plane; None in space
    twist (T, N, d)   v: length / time, Omega: 1 / time;  moving frame
    turn (T, Q, d)    h: dimensionless, Pi: 1 / length;   moving frame
    stress (T, Q, d)  F: force, M: force x length;        moving frame
    energy, dissipated, work (T,)  force x length: stored, taken by friction so far, done on the rod so far
    requested, estimated  position error at the end relative to the length: asked for, and found; or None
    evaluations       rate, jacobian, steps;   seconds   derive, compile, plan, solve
    contents          what the kernel consisted of: fields, terms, arguments, operations
    provenance        versions, platform, date, kernel: whatever is needed to do it again
    reached, reason   whether the run came to its end with the accuracy asked for, and if not, why
    plan              the runs that led to it: setting, seconds and those foreseen; empty if the scene gave the setting
    fell_back         where the safe method took over: from which one, at what time, and why; else None

    Arrays are copied, double precision and read-only. Equality is bit for bit.

    Raises ValueError when shapes do not fit together, or times or nodes do not increase.
    """

    scene: str
    title: str
    motion: str
    length: float
    time: Array
    u: Array
    u_point: Array
    position: Array
    rotation: Array
    angle: Array | None
    twist: Array
    turn: Array
    stress: Array
    energy: Array
    dissipated: Array
    work: Array
    method: str
    elements: int
    degree: int
    unknowns: int
    backend: str
    requested: float | None
    estimated: float | None
    evaluations: Mapping[str, int]
    seconds: Mapping[str, float]
    contents: Mapping[str, Any]
    provenance: Mapping[str, str]
    reached: bool
    reason: str
    plan: Sequence[Mapping[str, Any]] = ()
    fell_back: Mapping[str, Any] | None = None

    def __post_init__(self) -> None:
        plain: dict[str, object] = {name: _frozen(getattr(self, name)) for name in SHAPES}
        plain |= {name: int(getattr(self, name)) for name in ("elements", "degree", "unknowns")}
        plain |= {name: _number(getattr(self, name)) for name in ("length", "requested", "estimated")}
        plain |= {
            "reached": bool(self.reached),
            **{name: _writable(getattr(self, name)) for name in TEXTS},
            "evaluations": {key: int(value) for key, value in self.evaluations.items()},
            "seconds": {key: float(value) for key, value in self.seconds.items()},
            # plain, and equal to what a file gives back
            "contents": json.loads(json.dumps(self.contents)),
            "plan": json.loads(json.dumps(list(self.plan))),
            "fell_back": None if self.fell_back is None else dict(self.fell_back),
            "provenance": {str(key): str(value) for key, value in self.provenance.items()},
        }
        for name, value in plain.items():
            object.__setattr__(self, name, value)
        self._check()

    def _check(self) -> None:
        group = self.group
        points = self.elements * self.degree
        sizes = {"time": len(np.atleast_1d(self.time)), "node": points + 1, "point": points,
                 "component": group.dimension, "axis": group.space, "frame": group.space}
        if (self.angle is not None) != (self.motion == "planar"):
            found = "None" if self.angle is None else "an array"
            raise ValueError(f"solution.angle: expected an array in the plane and None in space, "
                             f"found {found} for a {self.motion} motion; correct the one or the other")
        for name, dimensions in SHAPES.items():
            array, expected = getattr(self, name), tuple(sizes[dimension] for dimension in dimensions)
            if array is None and name == "angle":  # in space
                continue
            if array is None or array.shape != expected:
                raise ValueError(f"solution.{name}: expected the shape {expected} ({', '.join(dimensions)}), "
                                 f"found {None if array is None else array.shape}; correct it: {self.elements} "
                                 f"elements of degree {self.degree} have {points + 1} nodes and {points} points")
        for name in ("time", "u", "u_point"):
            array = getattr(self, name)
            if array.size == 0 or not np.all(np.isfinite(array)) or np.any(np.diff(array) <= 0):
                raise ValueError(f"solution.{name}: expected at least one number, increasing, found {array}; "
                                 f"store each frame and node once and in order")
        for name, keys in (("evaluations", EVALUATIONS), ("seconds", SECONDS)):
            missing = [key for key in keys if key not in getattr(self, name)]
            if missing:
                raise ValueError(f"solution.{name}: expected the keys {', '.join(keys)}, found no "
                                 f"{', '.join(missing)}; write 0 for what was not needed")

    @property
    def group(self) -> Group:
        """SE(2) or SE(3), with the names of the components."""
        return group_of(self.motion)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Solution):
            return NotImplemented
        return all(_same(getattr(self, field.name), getattr(other, field.name)) for field in fields(self))

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        state = "reached" if self.reached else f"stopped: {self.reason}"
        return (f"Solution({self.title!r}: {self.motion}, {self.elements} x degree {self.degree}, "
                f"{self.unknowns} unknowns, {self.method}, "
                f"{len(self.time)} frames until t = {self.time[-1]:g}, {state})")


def _frozen(values: Array | None) -> Array | None:
    if values is None:
        return None
    copy = np.array(values, dtype=np.float64, order="C")
    copy.setflags(write=False)
    return copy


def _writable(text: str) -> str:
    """Text that every file can hold: a scene may spell NUL in its title, and a file name may be no Unicode."""
    return str(text).replace("\0", "\ufffd").encode("utf-8", "replace").decode()


def _number(value: float | None) -> float | None:
    return None if value is None else float(value)


def _same(one: object, other: object) -> bool:
    """Equal bit for bit: NaN equals itself, 0.0 differs from -0.0."""
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return one.shape == other.shape and one.tobytes() == other.tobytes()
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(one[key], other[key]) for key in one)
    # the shortest repr of a float determines all its bits
    return type(one) is type(other) and repr(one) == repr(other)
