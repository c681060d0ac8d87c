"""The cast: rods that between them have every feature a kernel can have, in the plane and in space.

Numbers are of order one, so that no term hides behind another.
"""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.model.records import Scene
from geocosserat.model.scene import load_scene
from geocosserat.passivity.storing import stored

Array = NDArray[np.float64]
MOTIONS = ("planar", "spatial")
SIZES = ((1, 5), (4, 2), (6, 1))
"""(elements, degree): spectral, in between, and the staggered second-order grid."""

NASTY = {
    "int": 0.3, "half": -0.7, "k_1_1": 1.3, "double": 0.4, "_": 0.2, "x0": 0.6, "P": 0.5, "p_int": -0.3, "self": 0.9,
}  # fmt: skip
"""Parameters named like words of C and Python, and like names inside a kernel."""

PLAIN = {
    "planar": {"stiffness": [3.0, 2.0, 1.5], "friction": [1.0, 2.0, 0.5]},
    "spatial": {"stiffness": [3.0, 2.0, 2.5, 0.9, 1.5, 1.2], "friction": [1.0, 2.0, 1.6, 0.3, 0.5, 0.4]},
}
VARYING = {
    "planar": {
        "stiffness": ["3 + u", "2*exp(-u)", "1.5 + sin(3*u)**2"],
        "friction": ["1 + u**2", 2.0, "0.5 + 0.2*u"],
        "reference": ["1 + 0.1*u", 0.2, "2*cos(u)"],
    },
    "spatial": {
        "stiffness": ["3 + u", "2*exp(-u)", 2.5, "0.9 + 0.3*u", "1.5 + sin(3*u)**2", 1.2],
        "friction": ["1 + u**2", 2.0, "1.6 - u/3", "0.3 + 0.2*u", 0.5, 0.4],
        "reference": ["1 + 0.1*u", 0.2, 0.0, "u", "2*cos(u)", -0.5],
    },
}
STEPPED = {
    "planar": {
        "stiffness": [3.0, "2 - heaviside(u - middle)", "1.5*(1 + heaviside(u - middle))"],
        "friction": ["1 + 2*heaviside(u - middle)", 2.0, "0.5 - 0.3*heaviside(u - middle)"],
        "reference": [1.0, 0.0, "1 - 2*heaviside(u - middle)"],
    },
    "spatial": {
        "stiffness": [3.0, "2 - heaviside(u - middle)", 2.5, "0.9 + heaviside(u - middle)", 1.5, 1.2],
        "friction": ["1 + 2*heaviside(u - middle)", 2.0, 1.6, "0.5 - 0.3*heaviside(u - middle)", 0.5, 0.4],
        "reference": [1.0, 0.0, 0.0, "1 - 2*heaviside(u - middle)", 0.5, "heaviside(u - middle)"],
    },
}


def full(motion: str, varying: str = "0") -> list[list[str | float]]:
    """A full symmetric positive definite matrix, no two entries alike; `varying` is added along the diagonal."""
    d = 3 if motion == "planar" else 6
    return [
        [f"{2 + 0.3 * i} + {varying}" if i == j else (-1) ** (i + j) * 0.3 / (1 + i + j) for j in range(d)]
        for i in range(d)
    ]


def blocks(motion: str) -> list[list[float]]:
    """A matrix that couples the first component to the last, and nothing else."""
    d = 3 if motion == "planar" else 6
    matrix = np.diag(1.0 + 0.3 * np.arange(d))
    matrix[0, -1] = matrix[-1, 0] = 0.4
    return [[float(x) for x in row] for row in matrix]


def load(motion: str, *entries: str | float, **more: Any) -> dict[str, Any]:
    """A loaded free end: force and torque from the six spatial entries, or those of them that the plane has."""
    if motion == "planar":
        return {"kind": "free", "force": list(entries[:2]), "torque": entries[5], **more}
    return {"kind": "free", "force": list(entries[:3]), "torque": list(entries[3:]), **more}


def weight(motion: str, *force: str | float) -> dict[str, Any]:
    return {"kind": "weight", "force": list(force[: 2 if motion == "planar" else 3])}


FREE, CLAMPED = {"kind": "free"}, {"kind": "clamped"}


def cut(motion: str, *entries: str | float) -> list[str | float]:
    """The components of a vector that there are."""
    return list(entries[: 2 if motion == "planar" else 3])


def effects(motion: str) -> dict[str, dict[str, Any]]:
    """One effect of each kind, by its kind; varying wherever it may."""
    planar = motion == "planar"
    gradient = [[0.3, "0.8*cos(t)", 0.1], [-0.2, -0.5, 0.4], [0.3, 0.1, 0.2]]
    return {
        "follower": {"kind": "follower", "force": cut(motion, "0.3*sin(u + t)", 0.2, "-u")},
        "couple": {"kind": "couple", "torque": "0.2*t + u" if planar else [0.1, "0.2*t + u", "cos(u)"]},
        "field": {
            "kind": "field",
            "moment": cut(motion, 0.7, "0.3*u", -0.4),
            "field": cut(motion, "cos(t)", "sin(t)", 0.5),
        },
        "flow": {
            "kind": "flow",
            "gradient": [cut(motion, *row) for row in gradient[: len(cut(motion, 0, 0, 0))]],
            "velocity": cut(motion, 0.1, -0.2, "0.3*t"),
        },
        "trap": {"kind": "trap", "stiffness": "1 + u", "centre": cut(motion, 0.2, "0.3*t", -0.1)},
        "weight": weight(motion, 0.3, "-1 - u", 0.4),
    }


def acting(motion: str, *kinds: str) -> list[dict[str, Any]]:
    """The effects of these kinds."""
    return [effects(motion)[kind] for kind in kinds]


def driven(motion: str, way: int = 1) -> dict[str, Any]:
    """A driven end that does not move along in one direction; backwards with -1."""
    twist: list[Any] = ["0.3*cos(t)", 0, 0.1, "0.5*t", 0.2, "-sin(t)"]
    twist = twist if way > 0 else ["0.2*sin(t)", "-0.3*cos(t)", 0, 0.4, "cos(t)", "-0.1*t"]
    return {"kind": "driven", "twist": [twist[0], twist[1], twist[5]] if motion == "planar" else twist}


def pinned(motion: str, frame: str) -> dict[str, Any]:
    """A pinned end under a torque."""
    return {"kind": "pinned", "torque": 0.3 if motion == "planar" else [0.1, "0.2*t", -0.3], "frame": frame}


def closed(motion: str) -> dict[str, Any]:
    """A circle that is one at rest too."""
    bend = 2 * np.pi / LENGTH
    return {"reference": [1, 0, bend] if motion == "planar" else [1, 0, 0, 0, 0, bend]}


ODD = {
    "planar": {
        "motion": "planar",
        "parameters": {"a": 0.4, "k": "2 + 0.5"},
        "stress": {
            "F1": "3*(h1 - 1) + a*abs(Pi - 0.1)*h2", "F2": "2*h2 + a*Pi**3", "M": "k*tanh(Pi) - a*h2*cos(t + u)",
        },
        "wrench": {"f1": "0.3*cos(theta) + a*y", "f2": "-0.3*sin(theta)", "m": "0.1*sin(theta)*x*t"},
    },
    "spatial": {
        "motion": "spatial",
        "parameters": {"a": 0.4, "k": "2 + 0.5"},
        "stress": {
            "F1": "3*(h1 - 1) + a*abs(Pi1 - 0.1)*h2", "F2": "2*h2 + a*Pi1**3", "F3": "2.5*h3 - a*Pi2/(2 + h1**2)",
            "M1": "k*tanh(Pi1) - a*h2*cos(t + u)", "M2": "1.5*Pi2 + a*Pi3*heaviside(h1)", "M3": "1.2*Pi3 - a*Pi2",
        },
        "wrench": {"f1": "0.3*e1z + a*y", "f2": "0.3*e2z - z", "m1": "0.1*e3x*x*t", "m3": "e1y"},
    },
}  # fmt: skip
"""Laws without an energy that is known, and loads without a potential."""

SOFT = {
    "planar": "1.5*(h1 - 1)**2 + h2**2*(1 + 0.3*heaviside(u - 0.65)) + log(cosh(k*(Pi - sin(t))))/k + 0.2*h1*Pi**2",
    "spatial": "1.5*(h1 - 1)**2 + h2**2*(1 + 0.3*heaviside(u - 0.65)) + 1.1*h3**2 + 0.2*h1*Pi2**2 "
    "+ log(cosh(k*(Pi1 - sin(t))))/k + exp(0.2*Pi2*Pi3) + 0.7*Pi2**2 + sqrt(1 + u + Pi3**2)",
}
"""Energy densities that are not quadratic, and change in time."""

DAMPED = {
    "planar": {
        "motion": "planar",
        "parameters": {"c": 0.4},
        "stress": {"F1": "3*(h1 - 1)", "F2": "2*h2", "M": "1.5*Pi + c*(1 + 0.5*sin(u))*Pi_dot/(1 + Pi**2)"},
    },
    "spatial": {
        "motion": "spatial",
        "parameters": {"c": 0.4},
        "stress": {
            "F1": "3*(h1 - 1)", "F2": "2*h2", "F3": "2.5*h3", "M1": "0.9*Pi1", "M2": "1.5*Pi2",
            "M3": "1.2*Pi3 + c*(1 + 0.5*sin(u))*Pi3_dot/(1 + Pi1**2)",
        },
    },
}  # fmt: skip
"""Laws of which one bend is viscous."""

CREEPING = {
    "planar": {
        "motion": "planar",
        "parameters": {"a": 0.25},
        "stress": {
            "F1": "3*(h1 - 1) + 0.3*(1 + Pi**2)*h1_dot + a*Pi_dot", "F2": "2*h2 + h1_dot",
            "M": "1.5*Pi - 0.2*h1 + (0.4 + 0.1*u)*Pi_dot - a*h1_dot*cos(t) + 0.7*h2_dot",
        },
    },
    "spatial": {
        "motion": "spatial",
        "parameters": {"a": 0.25},
        "stress": {
            "F1": "3*(h1 - 1) + 0.3*(1 + Pi3**2)*h1_dot + a*Pi2_dot", "F2": "2*h2", "F3": "2.5*h3 + 0.7*h2_dot",
            "M1": "0.9*Pi1 + 0.2*h1*Pi1_dot + h2_dot", "M3": "1.2*Pi3 + a*h3_dot",
            "M2": "1.5*Pi2 - 0.2*h1 + (0.4 + 0.1*u)*Pi2_dot - a*h1_dot*cos(t)",
        },
    },
}  # fmt: skip
"""Laws with several viscous modes that answer to each other's rates, to those of a mode that is not viscous, and not to
those of one that is frozen, though they are written; part of the stress at rest has no energy."""

ACTIVE = {
    "planar": ["1 + 0.1*sin(u - t)", 0.1, "2*cos(u + 3*t)"],
    "spatial": ["1 + 0.1*sin(u - t)", 0.1, "0.2*t", "u", "2*cos(u + 3*t)", -0.5],
}
"""References that change in time."""

STRETCHES = {"planar": ["h1", "h2"], "spatial": ["h1", "h2", "h3"]}
LENGTH = 1.3


def _rod(motion: str, material: Mapping[str, Any], **more: Any) -> dict[str, Any]:
    turned = {"angle": 0.7} if motion == "planar" else {"rotation": [0.3, -0.4, 0.7]}
    place = [0.3, -0.2] if motion == "planar" else [0.3, -0.2, 0.5]
    values = {"rod": {"motion": motion, "length": LENGTH, **material}, "run": {"until": 7.0}}
    return values | {"start": turned | {"position": place}} | more


def cast(motion: str) -> dict[str, dict[str, Any]]:
    """The scenes of one motion, by name."""
    curved = {"reference": VARYING[motion]["reference"]}
    return {
        "plain": _rod(motion, PLAIN[motion]),
        "pushed": _rod(
            motion,
            VARYING[motion],
            ends={"right": load(motion, "0.5*sin(t)", -0.4, 0.3, "0.2*t", 0.1, 0.25)},
        ),
        "dead": _rod(motion, PLAIN[motion], ends={"right": load(motion, 0.5, -0.4, 0.3, 0, 0, 0, frame="world")}),
        "twisted": _rod(motion, PLAIN[motion], ends={"right": load(motion, 0, 0, 0, 0.2, 0.3, "0.4*t", frame="world")}),
        "drifting": _rod(
            motion,
            {"stiffness": blocks(motion), "friction": blocks(motion)},
            ends={"left": load(motion, 0.1, 0.2, 0.15, 0.3, 0.1, 0.2), "right": FREE},
        ),
        "hung": _rod(
            motion,
            {"stiffness": blocks(motion), "friction": full(motion)},
            ends={"left": load(motion, 0.5, -0.4, 0.3, 0.2, 0.1, 0.25, frame="world"), "right": CLAMPED},
            effects=[weight(motion, 0.0, "-1 - u", 0.4)],
        ),
        "held": _rod(
            motion,
            STEPPED[motion],
            parameters={"middle": 0.65},
            ends={"left": CLAMPED, "right": CLAMPED},
            effects=[weight(motion, "0.3*heaviside(u - middle)", "(cos(t)*u - 1)*(1 + heaviside(u - middle))", 0.0)],
        ),
        "everything": _rod(
            motion,
            {"stiffness": full(motion, "u"), "friction": full(motion, "u**2"), **curved},
            parameters=NASTY,
            ends={
                "left": load(motion, "int*t", "half", "k_1_1", "double - t", "_", "x0*cos(P*t)", frame="world"),
                "right": load(motion, "p_int", "self*t", 0, "int", "t**2", "-half"),
            },
            effects=[weight(motion, "double*t*sin(u)", -0.5, "u"), weight(motion, 0.0, "x0*heaviside(t - 0.2)", 0.3)],
        ),
        "stirred": _rod(
            motion,
            {"stiffness": full(motion, "u"), "friction": full(motion, "u**2"), "reference": ACTIVE[motion]},
            ends={"left": FREE, "right": FREE},
            effects=list(effects(motion).values()),
        ),
        "hinged": _rod(
            motion,
            VARYING[motion] | {"friction": full(motion, "u")},
            ends={"left": FREE, "right": pinned(motion, "world")},
            effects=acting(motion, "flow", "trap", "couple"),
        ),
        "cranked": _rod(
            motion,
            VARYING[motion] | {"friction": blocks(motion), "frozen": STRETCHES[motion]},
            ends={"left": pinned(motion, "body"), "right": driven(motion)},
            effects=acting(motion, "flow", "couple"),
        ),
        "shaken": _rod(
            motion,
            PLAIN[motion] | {"reference": ACTIVE[motion], "frozen": _bends(motion)},
            ends={"left": driven(motion), "right": FREE},
        ),
        "reeled": _rod(
            motion,
            {"stiffness": full(motion), "friction": blocks(motion), "reference": ACTIVE[motion]}
            | {"frozen": _bends(motion)},
            ends={"left": load(motion, 0.5, -0.4, 0.3, 0.1, 0.2, 0.3, frame="world"), "right": CLAMPED},
            effects=acting(motion, "flow", "field", "weight"),
        ),
        "towed": _rod(
            motion,
            VARYING[motion] | {"friction": full(motion, "u"), "frozen": ["h1"]},
            ends={"left": FREE, "right": driven(motion)},
            effects=acting(motion, "field"),
        ),
        "swept": _rod(
            motion,
            {"stiffness": blocks(motion), "friction": full(motion), **curved},
            ends={"left": CLAMPED, "right": driven(motion)},
            effects=acting(motion, "flow", "follower"),
        ),
        "wrung": _rod(
            motion,
            {"stiffness": blocks(motion), "friction": full(motion), **curved, "frozen": ["h2"]},
            ends={"left": driven(motion), "right": driven(motion, -1)},
            effects=acting(motion, "flow"),
        ),
        "hoop": _rod(
            motion,
            PLAIN[motion] | closed(motion) | {"stiffness": ["3 + sin(u)", *PLAIN[motion]["stiffness"][1:]]},
            ends={"joined": True},
        ),
        "ring": _rod(
            motion,
            PLAIN[motion] | closed(motion) | {"friction": full(motion, "u"), "frozen": STRETCHES[motion]},
            ends={"joined": True},
            effects=[
                *acting(motion, "follower", "flow"),
                weight(motion, 0.3, "-cos(t)", 0.4),
                {"kind": "trap", "stiffness": 0.9, "centre": cut(motion, 0.2, "0.3*t", -0.1)},
            ],
        ),
        "odd": _rod(
            motion,
            {"law": ODD[motion], "friction": full(motion, "u"), "frozen": ["h2"], **curved},
            ends={"left": CLAMPED, "right": load(motion, 0.5, -0.4, 0.3, 0.1, 0.2, 0.3)},
        ),
        "soft": _rod(
            motion,
            {"law": {"motion": motion, "energy": {"density": SOFT[motion]}, "parameters": {"k": 1}}}
            | {"friction": blocks(motion)},
            parameters={"k": 1.2},
            ends={"left": FREE, "right": pinned(motion, "body")},
        ),
        "damped": _rod(
            motion,
            {"law": DAMPED[motion], "friction": full(motion, "u"), **curved},
            ends={"left": FREE, "right": load(motion, 0.5, -0.4, 0.3, 0.1, 0.2, 0.3, frame="world")},
            effects=acting(motion, "trap", "follower"),
        ),
        "creeping": _rod(
            motion,
            {"law": CREEPING[motion], "friction": full(motion), "frozen": ["h2"], **closed(motion)},
            ends={"joined": True},
            effects=acting(motion, "couple"),
        ),
    }


def _bends(motion: str) -> list[str]:
    """Modes to freeze of which one is a bend."""
    return ["h2", "Pi"] if motion == "planar" else ["h2", "Pi1", "Pi3"]


CAST = {f"{motion} {name}": values for motion in MOTIONS for name, values in cast(motion).items()}
NAMES = tuple(CAST)
VISCOUS = tuple(name for name in NAMES if name.split()[1] in ("damped", "creeping"))
"""Rods whose stress answers to rates of strain."""
LAWFUL = (*(name for name in NAMES if name.split()[1] in ("odd", "soft")), *VISCOUS)
"""Rods made of a law in place of a stiffness."""
_PLACED = ("odd", "damped", "held", "stirred", "hinged", "cranked", "reeled", "swept", "wrung", "ring")
_SEEING = ("dead", "hung", "everything", "towed", *_PLACED)
WORLD = (*(name for name in NAMES if name.split()[1] in _SEEING), "spatial twisted")
"""Rods whose loads see the world."""
PLACED = tuple(name for name in NAMES if name.split()[1] in _PLACED)
"""Those that see where they are in it."""
JOINED = tuple(name for name in NAMES if name.split()[1] in ("hoop", "ring", "creeping"))
_FROZEN = ("creeping", "cranked", "shaken", "reeled", "towed", "wrung", "ring", "odd")
FROZEN = tuple(name for name in NAMES if name.split()[1] in _FROZEN)


def changed(name: str, **tables: Mapping[str, Any]) -> Scene:
    """The scene of that name with entries of some of its tables replaced."""
    values = copy.deepcopy(CAST[name])
    for table, entries in tables.items():
        values[table] = {**values.get(table, {}), **entries}
    return _loaded(name, values)


@cache
def scene(name: str) -> Scene:
    return _loaded(name, CAST[name])


def _loaded(name: str, values: Mapping[str, Any]) -> Scene:
    """The scene; of a law that stores and loses, with what it stores."""
    found = load_scene(values)
    return replace(found, model=stored(found.model)) if name.endswith("creeping") else found


@cache
def rod(name: str, elements: int, degree: int) -> SemiDiscrete:
    return yielding(discretise(scene(name), elements, degree))


def yielding(rod: SemiDiscrete, pull: float = 0.7) -> SemiDiscrete:
    """The rod with slacks and pulls of order one, in place of some near round-off and some that are huge: no term hides
    behind another."""
    names = [c.name for c in rod.structure.at("uniform")]
    moderate = {"slack_F1": 0.3, "slack_F2": 0.4, "slack_F3": 0.5, "slack_M1": 0.6, "slack_M2": 0.7, "slack_M3": 0.8}
    moderate |= {"slack_M": 0.8, "left_pull": pull, "right_pull": pull}
    return replace(rod, uniform=np.array([moderate.get(name, x) for name, x in zip(names, rod.uniform, strict=True)]))


def given(rod: SemiDiscrete) -> dict[str, float]:
    """Numbers of the kernel that are not in the scene, by name: slacks, pulls and where held ends belong."""
    found = zip((c.name for c in rod.structure.at("uniform")), rod.uniform, strict=True)
    return {name: float(x) for name, x in found if any(mark in name for mark in ("slack_", "_pull", "_home_"))}


def random_state(rod: SemiDiscrete, seed: int, size: float = 0.4) -> Array:
    """A state far from rest: turn at its start plus `size` times noise, a carried pose of any norm, any energies."""
    rng = np.random.default_rng(seed)
    state = rod.state.copy()
    state += size * rng.normal(size=len(state))
    return state
