"""The text of a kernel: tapes of the pointwise expressions, printed into the templates."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import jinja2
import sympy as sp

from geocosserat.codegen.identity import identity
from geocosserat.codegen.printing import print_expression, print_tape
from geocosserat.codegen.tape import Tape, jacobian, record
from geocosserat.discretisation.pointwise import Pointwise, pointwise
from geocosserat.discretisation.structure import ZERO, RodStructure, Row
from geocosserat.model.expressions import symbols
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


@dataclass(frozen=True)
class Block:
    """A tape printed for one language, with the coefficients it needs by place as (name, slot) pairs.

    needs: names of all its inputs.
    """

    uniform: list[tuple[str, int]]
    point: list[tuple[str, int]]
    node: list[tuple[str, int]]
    steps: list[tuple[str, str]]
    outputs: list[tuple[str, str]]
    needs: frozenset[str]

    def entries(self, stem: str) -> list[tuple[int, int, str]]:
        """Outputs called stem_i_j as (row, column, code), counted from zero."""
        split = [(*name.rsplit("_", 2), code) for name, code in self.outputs if name.count("_") == 2]
        return [(int(i) - 1, int(j) - 1, code) for found, i, j, code in split if found == stem]


def _tapes(p: Pointwise) -> dict[str, Tape]:
    """One tape a piece of the kernel."""
    stress = record({**{name: sp.Symbol(name) for name in p.stress}, **p.pull}, given=p.stress)
    carry, spin = record(p.carry), record(p.spin, prefix="s")
    tangent = jacobian(stress, p.turn, "d")
    d = p.group.dimension
    rows = {str(i + 1): f"stress_{i + 1}" if i < d else f"pull_{i - d + 1}" for i in range(2 * d)}
    named = tuple((f"{rows[name.split('_')[1]]}_{name.split('_')[2]}", e) for name, e in tangent.outputs)
    carry_tangent = jacobian(carry, p.pose, "rate")
    return {
        "stress": stress,
        "tangent": Tape(tangent.steps, named),
        "strain_rate": record(p.strain_rate),
        "velocity": record(p.velocity),
        "energy": record(p.energy, given=p.stress),
        "advection": record(p.advection),
        "bracket": record(p.bracket),
        "carry": carry,
        "carry_tangent": Tape(carry_tangent.steps + spin.steps, carry_tangent.outputs + spin.outputs),
    }


def _mobility(structure: RodStructure) -> Tape:
    return Tape(
        (),
        tuple(
            (f"mobility_{i + 1}_{j + 1}", sp.Symbol(name))
            for i, row in enumerate(structure.mobility)
            for j, name in enumerate(row)
            if name != ZERO
        ),
    )


def _code(names: tuple[str, ...]) -> list[str]:
    return ["0.0" if name == ZERO else name for name in names]


class _Writer:
    """Prints one structure in one language."""

    def __init__(self, structure: RodStructure, language: str) -> None:
        self.structure, self.language = structure, language
        self.slots = {
            place: {c.name: i for i, c in enumerate(structure.at(place))} for place in ("uniform", "point", "node")
        }

    def block(self, tape: Tape, also: frozenset[str] = frozenset()) -> Block:
        used = tape.inputs | also
        steps, outputs = print_tape(tape, self.language)
        place = {p: [(name, i) for name, i in slots.items() if name in used] for p, slots in self.slots.items()}
        return Block(place["uniform"], place["point"], place["node"], steps, outputs, used)

    def timed(self, along_nodes: bool, coordinate: str = "") -> list[tuple[str, str]]:
        """(name, code) of the time-dependent coefficients that do, or do not, vary along the nodes."""
        printed, varying = [], {"u", *self.slots["node"]}
        for c in self.structure.at("time"):
            assert c.expression is not None
            if bool(varying & symbols(c.expression)) == along_nodes:
                code = print_expression(c.expression, self.language, lambda s: coordinate if s == "u" else s)
                printed.append((c.name, code))
        return printed

    def needed(self, loads: Iterable[Row]) -> frozenset[str]:
        """Names of these loads, and of the parameters in them."""
        names = {name for load in loads for name in load}
        expressions = [c.expression for c in self.structure.at("time") if c.name in names]
        return frozenset(names.union(*(symbols(e) for e in expressions if e is not None)))

    def body_weight(self) -> list[str]:
        """Components of the dead force density in the moving frame."""
        planar = self.structure.motion == "planar"
        signs = {(0, 0): "+0", (1, 0): "+1", (0, 1): "-1", (1, 1): "+0"}  # cosine and sine of the angle

        def entry(world: int, body: int) -> str:
            sign, slot = (signs[world, body][0], signs[world, body][1]) if planar else ("+", str(3 * world + body))
            read = f"w->frame[{slot} * N + n]" if self.language == "c" else f"frame[{slot}]"
            return read if sign == "+" else f"-{read}"

        present = [(i, name) for i, name in enumerate(self.structure.weight) if name != ZERO]
        return [" + ".join(f"{entry(i, j)} * {name}" for i, name in present) for j in range(len(self.structure.weight))]

    def context(self, tapes: dict[str, Tape], pose: tuple[sp.Symbol, ...]) -> dict[str, Any]:
        """Everything the templates of this language ask for."""
        s, group = self.structure, self.structure.group
        loads = [
            {"side": side, "frame": load.frame, "wrench": _code(load.wrench)}
            for side, load in zip(("left", "right"), s.loads, strict=True)
            if load is not None
        ]
        applied = self.needed([s.weight, *(load.wrench for load in s.loads if load is not None)])
        seen = self.needed([s.weight, *(load.wrench for load in s.loads if load is not None and load.frame == "world")])
        timed = self.timed(along_nodes=False)
        blocks = {name: self.block(tape) for name, tape in tapes.items()}
        return {
            **blocks,
            "velocity": self.block(tapes["velocity"], also=applied),
            "mobility": self.block(_mobility(s)),
            "seen": self.block(Tape((), ()), also=seen),
            "d": group.dimension,
            "space": group.translations,
            "rotations": group.rotations,
            "strain": group.strain,
            "twist": group.twist,
            "values": [f"value_{i + 1}" for i in range(group.dimension)],
            "carried": s.carried,
            "pose": [symbol.name for symbol in pose],
            "world": s.world,
            "world_load": any(load["frame"] == "world" for load in loads),
            "base": s.base,
            "held": [end for end, held in zip(("0", "N - 1"), s.held, strict=True) if held],
            "loads": loads,
            "weight": _code(s.weight) if any(name != ZERO for name in s.weight) else [],
            "body_weight": self.body_weight(),
            "timed": timed,
            "timed_seen": [(name, code) for name, code in timed if name in seen],
            "timed_nodes": self.timed(along_nodes=True, coordinate="r->u[n]" if self.language == "c" else "self.u"),
        }


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
    operations = {key: tapes[key].operations for key in ("stress", "strain_rate", "velocity", "tangent")}
    places = {place: [c.name for c in structure.at(place)] for place in ("uniform", "point", "node")}
    signature = {
        "identity": name,
        "version": VERSION,
        "group": group.name,
        "motion": structure.motion,
        "turn": list(group.strain),
        "twist": list(group.twist),
        "carried": structure.carried,
        "world": structure.world,
        "base": structure.base,
        "held": list(structure.held),
        "operations": operations,
        **places,
    }
    heading = {
        "title": one_line(title) or f"Semi-discrete {structure.motion} rod",
        "version": VERSION,
        "identity": name,
        "group": group.name,
        "operations": operations,
        **places,
    }

    def text(language: str, template: str) -> str:
        context = _Writer(structure, language).context(tapes, p.pose)
        # the names of places in the heading are lists of names; blocks carry their own
        rendered = environment().get_template(template).render(**context, **heading)
        return "\n".join(line.rstrip() for line in rendered.splitlines()) + "\n"

    return KernelSource(name, text("c", "rod.c.j2"), text("numpy", "rod.py.j2"), signature)
