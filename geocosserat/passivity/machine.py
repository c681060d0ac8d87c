"""The testing machine: a witness as a scene that `run` runs, whose ledger shows what the law gives.

A loop of strain is driven by two grips on a rod of one element of degree 1: its one Gauss point follows the loop
exactly, for between a clamped node and a driven one the strain rate is what the twist V of the grip makes it,

    dE/dt = V / L + ad_E V / 2,    V = (1 / L + ad_E / 2)^-1 dE/dt.

A loop of configurations is gone through by a bead: a rod shrunk to a point, both of whose nodes are driven alike.
Once round, nothing is stored; what is dissipated is less than nothing by what the law gave (the drag on the grips is
made too small to matter), and the work of the grips is negative by as much: they gain it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from geocosserat.algebra.exponential import vector_from_rotation
from geocosserat.algebra.groups import Group
from geocosserat.model.expressions import Expression, Number, Symbol, derivative, evaluate, substitute, to_text
from geocosserat.model.law import Law, at_rest
from geocosserat.model.seen import cross, dot
from geocosserat.model.toml_text import to_toml
from geocosserat.passivity.balls import PARAMETER
from geocosserat.passivity.configuration import ConfigurationLoop
from geocosserat.passivity.loop import Loop

Vector = tuple[Expression, ...]

LENGTH: Final = 1.0
_DRAG: Final = 1e-10
"""Share of the work that drag on the grips may take."""
_FRAMES: Final = 101


def grip(group: Group, turn: Sequence[Expression], rate: Sequence[Expression]) -> Vector:
    """Twist of the driven end, d components, under which the strain E of one element of degree 1 has this rate.

    ``turn``, ``rate``: E (dimensionless, then 1 / length) and dE/dt, d expressions each. From (a + b x)^-1 =
    (a² - a b x + b b^T) / (a (a² + b²)) with a = 1 / L and b half the rotational part of E; in the plane b b^T is
    left out, as b is normal to it.
    """
    n, a = group.translations, 1.0 / LENGTH
    half = [0.5 * e for e in turn]
    b = half[n:]
    square = a * a + dot(b, b)

    def solved(w: Sequence[Expression]) -> Vector:
        """(a + b x)^-1 w."""
        if n == 2:
            (normal,) = b
            return (a * w[0] + normal * w[1]) / square, (a * w[1] - normal * w[0]) / square
        away, along = cross(b, w), dot(b, w)
        return tuple((a * a * x - a * y + along * z) / (a * square) for x, y, z in zip(w, away, b, strict=True))

    spin = solved(rate[n:]) if n == 3 else (rate[2] / a,)
    # (h / 2) x spin; in the plane a vector across the normal
    moved = cross(half[:n], spin) if n == 3 else (half[1] * spin[0], -(half[0] * spin[0]))
    velocity = solved([r - m for r, m in zip(rate[:n], moved, strict=True)])
    return (*velocity, *spin)


def strain_machine(law: Law, loop: Loop) -> str:
    """A scene, as TOML text, in which grips take a rod of this law once round a loop of strain, in unit time.

    Its rod is one unit long: what the law gives is ``loop.work``. Terms with rates of the turn are left
    out: what viscosity takes vanishes as the loop is gone round more slowly.
    """
    path = loop.path(law.group.strain)
    time = {PARAMETER: Symbol("t")}
    turn = [substitute(path[name], time) for name in law.group.strain]
    rate = [derivative(e, "t") for e in turn]
    twist = grip(law.group, turn, rate)
    values = {name: float(x) for name, x in loop.parameters.items()}
    tables = _law_tables(law, values)
    at = {name: Number(float(x)) for name, x in loop.parameters.items() if name in ("u", "t")}
    stress = [substitute(at_rest(e, law.group), at) for e in law.stress or ()]
    tables["stress"] = {name: to_text(e) for name, e in zip(law.group.stress, stress, strict=True)}
    end = {"kind": "driven", "twist": [to_text(e) for e in twist]}
    return _scene(
        law, f"witness: {law.name}, once round a loop of strain", tables,
        start={"strain": [float(evaluate(e, {"t": 0.0})) for e in turn]},
        ends={"left": {"kind": "clamped"}, "right": end},
        drag=_drag(law.group, twist, loop.work),
    )  # fmt: skip


def configuration_machine(law: Law, loop: ConfigurationLoop) -> str:
    """A scene, as TOML text, in which a bead is taken once round a loop of configurations, in unit time."""
    tables = _law_tables(law, loop.values)
    at = {name: Number(float(x)) for name, x in loop.values.items() if name in ("u", "t")}
    tables["wrench"] = {
        name: to_text(substitute(e, at)) for name, e in zip(law.group.wrench, law.wrench or (), strict=True)
    }
    end = {"kind": "driven", "twist": [to_text(e) for e in loop.twist]}
    d = law.group.dimension
    return _scene(
        law, f"witness: {law.name}, once round a loop of configurations", tables,
        start={"strain": [0.0] * d, **_place(loop)}, ends={"left": end, "right": end},
        drag=_drag(law.group, loop.twist, loop.work), more={"reference": [0.0] * d, "stiffness": [1.0] * d},
    )  # fmt: skip


def _place(loop: ConfigurationLoop) -> dict[str, Any]:
    """Where the loop begins, as a scene says it."""
    group, pose = loop.group, {name: float(evaluate(e, {"t": 0.0})) for name, e in loop.pose.items()}
    position = [pose[axis] for axis in "xyz"[: group.space]]
    if group.rotations == 1:
        return {"position": position, "angle": pose["theta"]}
    rotation = np.array([[pose[f"e{i}{axis}"] for i in (1, 2, 3)] for axis in "xyz"])
    return {"position": position, "rotation": [float(x) for x in vector_from_rotation(rotation)]}


def _law_tables(law: Law, values: Mapping[str, float]) -> dict[str, Any]:
    """The tables of the law that all its parts share, with numbers for what is open."""
    tables = {"name": law.name, "motion": "planar" if law.group.rotations == 1 else "spatial"}
    parameters = {**law.parameters, **{name: x for name, x in values.items() if name in law.open}}
    return {**tables, "reference": list(law.reference), **({"parameters": parameters} if parameters else {})}


def _drag(group: Group, twist: Vector, work: float) -> float:
    """A friction so small that it takes but a little of the work."""
    t = np.linspace(0.0, 1.0, 64, endpoint=False)
    speeds = [np.broadcast_to(evaluate(e, {"t": t}), t.shape) for e in twist]
    return _DRAG * abs(work) / max(float(np.mean(sum(v * v for v in speeds))), 1e-300)


def _scene(
    law: Law, title: str, tables: dict[str, Any], *, start: dict[str, Any], ends: dict[str, Any], drag: float,
    more: Mapping[str, Any] | None = None,
) -> str:  # fmt: skip
    group = law.group
    motion = "planar" if group.rotations == 1 else "spatial"
    rod = {"motion": motion, "length": LENGTH, "friction": [drag] * group.dimension}
    scene = {
        "title": title[:200],
        "rod": {**rod, **(more or {}), "law": tables},
        "start": start,
        "ends": ends,
        "run": {"until": 1.0, "frames": _FRAMES, "elements": 1, "degree": 1, "rtol": 1e-10, "method": "radau"},
    }
    return to_toml(scene)
