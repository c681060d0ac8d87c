"""The text of a kernel: tapes of the pointwise expressions, printed into the templates."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import jinja2
import sympy as sp

from geocosserat.algebra.groups import Group
from geocosserat.codegen.identity import identity
from geocosserat.codegen.tape import Tape, jacobian, record
from geocosserat.codegen.writer import Writer
from geocosserat.discretisation.pointwise import Named, Pointwise, pointwise
from geocosserat.discretisation.structure import RodStructure
from geocosserat.shipped import shipped
from geocosserat.version import VERSION


@dataclass(frozen=True)
class KernelSource:
    """Generated text, ready to be written, compiled or loaded.

    identity: hash of structure, templates and version; signature: the arguments, in words and numbers.
    """

    identity: str
    c: str
    numpy: str
    signature: dict[str, Any]

    def __str__(self) -> str:
        counts = ", ".join(f"{name} {count}" for name, count in self.signature["operations"].items())
        return (
            f"kernel {self.identity[:12]} on {self.signature['group']}; operations: {counts}; "
            f"{len(self.c.splitlines())} lines of C, {len(self.numpy.splitlines())} of numpy"
        )


def _tapes(p: Pointwise) -> dict[str, Tape]:
    """One tape a piece of the kernel."""
    d = p.group.dimension
    held = {name: sp.Symbol(name) for name in p.group.stress}
    stress = record({**held, **p.pull}, given=p.stress)
    carry, shift = record(p.carry), record(p.shift, prefix="s")
    tangent = jacobian(stress, p.state, "d")
    rows = {str(i + 1): f"stress_{i + 1}" if i < d else f"pull_{i - d + 1}" for i in range(2 * d)}
    named = tuple((f"{rows[name.split('_')[1]]}_{name.split('_')[2]}", e) for name, e in tangent.outputs)
    carry_tangent = jacobian(carry, p.pose, "rate")
    return {
        "stress": stress,
        "tangent": Tape(tangent.steps, named),
        "turn": Tape((), tuple(p.turn.items())),
        "strain_rate": record(p.strain_rate),
        "gap": (gap := record(p.gap)),
        "gap_tangent": jacobian(gap, (*p.state, *sp.symbols(f"rate_1:{d + 1}")), "gap"),
        "velocity": record(
            {name: e for name, e in p.velocity.items() if not name.startswith("slip")},
            given={name: e for name, e in p.velocity.items() if name.startswith("slip")},
        ),
        "energy": record(p.energy, given=p.stress).only(p.energy),
        "supply": record(p.supply, given=p.stress).only(p.supply),
        "loss": record(p.loss),
        "advection": record(p.advection),
        "bracket": record(p.bracket),
        "surroundings": record(p.surroundings, prefix="w"),
        "own": record(p.own, prefix="w"),
        "surroundings_tangent": _seen_tangent(p.group, p.surroundings),
        "load_left": record(p.loads[0], prefix="l"),
        "load_right": record(p.loads[1], prefix="l"),
        "load_left_tangent": _seen_tangent(p.group, p.loads[0]),
        "load_right_tangent": _seen_tangent(p.group, p.loads[1]),
        "twist_left": record(p.twists[0], prefix="h"),
        "twist_right": record(p.twists[1], prefix="h"),
        "twist_left_tangent": _seen_tangent(p.group, p.twists[0]),
        "twist_right_tangent": _seen_tangent(p.group, p.twists[1]),
        "carry": carry,
        "carry_tangent": Tape(carry_tangent.steps + shift.steps, carry_tangent.outputs + shift.outputs),
    }


def _seen_tangent(group: Group, named: Named) -> Tape:
    """Derivatives name_j of formulas: j counts the angle and the place in the plane; in space the rotation matrix by
    rows, then the place."""
    found: dict[str, sp.Expr] = {}
    for name, e in named.items():
        if group.rotations == 1:
            c, s = sp.symbols("frame_cos frame_sin")
            slopes = [e.diff(s) * c - e.diff(c) * s]
        else:
            slopes = [e.diff(sp.Symbol(f"frame_{i}{axis}")) for axis in "xyz" for i in (1, 2, 3)]
        slopes += [e.diff(sp.Symbol(f"place_{axis}")) for axis in "xyz"[: group.translations]]
        found |= {f"{name}_{j}": slope for j, slope in enumerate(slopes, start=1) if slope != 0}
    return record(found, prefix="y")


def one_line(title: str) -> str:
    """A title that can stand in a comment of C and make and in a docstring: it ends none, escapes and joins nothing."""
    kept = "".join(c for c in title if c not in '"\\*')
    return " ".join(kept.replace("??", "").split())


@lru_cache(maxsize=1)
def environment() -> jinja2.Environment:
    """The templates; a key that is missing is an error."""
    return jinja2.Environment(
        loader=jinja2.FileSystemLoader(shipped("templates")),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )


def generate(structure: RodStructure, title: str = "") -> KernelSource:
    """Writes the kernels of a structure, in C and in numpy. Deterministic: equal structures, equal text."""
    p = pointwise(structure)
    tapes = _tapes(p)
    group = structure.group
    name = identity(structure)
    counted = ("stress", "strain_rate", "surroundings", "velocity", "tangent", *(("gap",) if p.gap else ()))
    operations = {key: tapes[key].operations for key in counted}
    places = {place: [c.name for c in structure.at(place)] for place in ("uniform", "point", "node")}
    signature = {
        "identity": name,
        "version": VERSION,
        "group": group.name,
        "motion": structure.motion,
        "state": list(structure.state_names),
        "twist": list(group.twist),
        "frozen": [name for name, held in zip(group.strain, structure.frozen, strict=True) if held],
        "viscous": [name for name, here in zip(group.strain, structure.viscous, strict=True) if here],
        "carried": structure.carried,
        "sight": structure.sight,
        "base": structure.base,
        "ends": "joined" if structure.joined else [structure.left.kind, structure.right.kind],
        "operations": operations,
        **places,
    }
    heading = {
        "title": one_line(title) or f"Semi-discrete {structure.motion} rod",
        "version": VERSION,
        "identity": name,
        "group": group.name,
        "operations": operations,
        "arguments": places,
    }

    def text(language: str, template: str) -> str:
        context = Writer(structure, language).context(tapes, p.pose)
        rendered = environment().get_template(template).render(**context, **heading)
        return "\n".join(line.rstrip() for line in rendered.splitlines()) + "\n"

    return KernelSource(name, text("c", "rod.c.j2"), text("numpy", "rod.py.j2"), signature)
