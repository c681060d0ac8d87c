"""One structure in one language: its tapes printed, and everything that the templates ask for."""

from dataclasses import dataclass
from typing import Any

import sympy as sp

from geocosserat.codegen.printing import print_expression, print_tape
from geocosserat.codegen.tape import Tape
from geocosserat.discretisation.cells import POINTS
from geocosserat.discretisation.structure import ZERO, EndStructure, Matrix, RodStructure, guide
from geocosserat.model.expressions import FUNCTIONS, symbols

CALLED = ("pow", "fabs", *(name for name in FUNCTIONS if name != "abs"))
"""Functions of C that expressions may call."""


@dataclass(frozen=True)
class Block:
    """A tape printed for one language, with the coefficients it needs by place as (name, slot) pairs.

    timed, timed_along: (name, code) of coefficients that depend on time, and of those that vary along the rod too.
    seen: (name, slot) of what it sees of the world; guided: of where an end belongs. needs: names of all its inputs.
    """

    uniform: list[tuple[str, int]]
    point: list[tuple[str, int]]
    node: list[tuple[str, int]]
    timed: list[tuple[str, str]]
    timed_along: list[tuple[str, str]]
    seen: list[tuple[str, int]]
    guided: list[tuple[str, int]]
    steps: list[tuple[str, str]]
    outputs: list[tuple[str, str]]
    needs: frozenset[str]

    def entries(self, stem: str) -> list[tuple[int, int, str]]:
        """Outputs called stem_i_j as (row, column, code), counted from zero."""
        split = [(*name.rsplit("_", 2), code) for name, code in self.outputs if name.count("_") == 2]
        return [(int(i) - 1, int(j) - 1, code) for found, i, j, code in split if found == stem]

    def components(self, stem: str) -> list[tuple[int, str]]:
        """Outputs called stem_i as (component, code), counted from zero."""
        split = [(*name.rsplit("_", 1), code) for name, code in self.outputs]
        return [(int(i) - 1, code) for found, i, code in split if found == stem]


def seen_slots(motion: str) -> dict[str, int]:
    """Row of a kernel's frames in which each thing that can be seen of the world stands."""
    if motion == "planar":
        return {"frame_cos": 0, "frame_sin": 1, "place_x": 2, "place_y": 3}
    frame = {f"frame_{i}{axis}": 3 * k + i - 1 for k, axis in enumerate("xyz") for i in (1, 2, 3)}
    return frame | {f"place_{axis}": 9 + k for k, axis in enumerate("xyz")}


def _entries(stem: str, matrix: Matrix) -> Tape:
    """A matrix of names as a tape."""
    named = ((i, j, name) for i, row in enumerate(matrix) for j, name in enumerate(row) if name != ZERO)
    return Tape((), tuple((f"{stem}_{i + 1}_{j + 1}", sp.Symbol(name)) for i, j, name in named))


class Writer:
    """Prints one structure in one language, "c" or "numpy"."""

    def __init__(self, structure: RodStructure, language: str) -> None:
        self.structure, self.language = structure, language
        self.slots = {
            place: {c.name: i for i, c in enumerate(structure.at(place))} for place in ("uniform", "point", "node")
        }
        self.seen = seen_slots(structure.motion)
        self.guide = [name.replace(".", "_") for name in guide(structure.group.space)]

    def block(self, *tapes: Tape) -> Block:
        """The tapes one after the other, with all that they read."""
        steps: list[tuple[str, str]] = []
        outputs: list[tuple[str, str]] = []
        used: frozenset[str] = frozenset()
        for tape in tapes:
            more, results = print_tape(tape, self.language)
            steps, outputs, used = steps + more, outputs + results, used | tape.inputs
        timed = [c for c in self.structure.timed if c.name in used and c.expression is not None]
        used = used.union(*(symbols(c.expression) for c in timed if c.expression is not None))
        code: dict[bool, list[tuple[str, str]]] = {False: [], True: []}
        for c in timed:
            assert c.expression is not None
            u = {"point": ("r->u_point[i]", "self.u_point"), "node": ("r->u[n]", "self.u"), "uniform": ("", "")}
            coordinate = u[c.place][self.language != "c"]

            def name(symbol: str, coordinate: str = coordinate) -> str:
                return coordinate if symbol == "u" else symbol

            code[c.place != "uniform"].append((c.name, print_expression(c.expression, self.language, name)))
        place = {p: [(name, i) for name, i in slots.items() if name in used] for p, slots in self.slots.items()}
        seen = [(name, i) for name, i in self.seen.items() if name in used]
        guided = [(name, i) for i, name in enumerate(self.guide) if name in used]
        return Block(
            place["uniform"], place["point"], place["node"], code[False], code[True], seen, guided, steps, outputs, used
        )

    def end(self, side: str, end: EndStructure, tapes: dict[str, Tape]) -> dict[str, Any]:
        """What the templates ask of one end."""
        group = self.structure.group
        felt = [f"medium_{i + 1}" for i in range(group.dimension)]
        if end.kind == "pinned":
            felt += [f"wrench_{i + 1}" for i in range(group.translations, group.dimension)]
        surroundings = tapes["surroundings"].only(felt)
        twist = tapes[f"twist_{side}"]
        mobility, friction = _entries("mobility", end.mobility or ()), _entries("friction", end.friction or ())
        space, d = group.translations, group.dimension
        coupling = friction.only(f"friction_{i + 1}_{j + 1}" for i in range(space, d) for j in range(space))
        return {
            "side": side,
            "index": "0" if side == "left" else "N - 1",
            "kind": end.kind,
            "reads": self.block(surroundings, twist, mobility, friction),
            "surroundings": self.block(surroundings),
            "twist": self.block(twist),
            "twist_tangent": self.block(tapes[f"twist_{side}_tangent"]),
            "moved": bool(twist.outputs),
            "mobility": self.block(mobility),
            "friction": self.block(friction),
            "coupling": self.block(coupling),
            "load": self.block(tapes[f"load_{side}"]) if end.load else None,
            "load_tangent": self.block(tapes[f"load_{side}_tangent"]),
        }

    def context(self, tapes: dict[str, Tape], pose: tuple[sp.Symbol, ...]) -> dict[str, Any]:
        """Everything the templates of this language ask for."""
        s, group = self.structure, self.structure.group
        ends = [self.end("left", s.left, tapes), self.end("right", s.right, tapes)]
        d = group.dimension
        surrounding = {name for name, _ in tapes["surroundings"].outputs}
        apart = ("load", "turn", "twist")
        blocks = {name: self.block(tape) for name, tape in tapes.items() if not name.startswith(apart)}
        turn = self.block(tapes["turn"])
        return {
            **blocks,
            "turn_at": turn,
            "turn_codes": [code for _, code in turn.outputs],
            "at_node": self.block(tapes["surroundings"], tapes["velocity"]),
            "mobility": self.block(_entries("mobility", s.mobility)),
            "d": d,
            "space": group.translations,
            "rotations": group.rotations,
            "state": s.state_names,
            "twist": group.twist,
            "values": [f"value_{i + 1}" for i in range(d)],
            "frozen": [int(fixed) for fixed in s.constrained],
            "functions": [f"{name}(" for name in CALLED],
            "viscous": sum(s.viscous),
            "carried": s.carried,
            "prescribed": s.prescribed and s.increments > 0,
            "guided": s.guided,
            "powers": POINTS + 1,
            "pose": [symbol.name for symbol in pose],
            "world": s.increments > 0,
            "placed": s.sight == "pose",
            "increments": s.increments,
            "rows_seen": {"nothing": 0, "direction": 2 if d == 3 else 9, "pose": 4 if d == 3 else 12}[s.sight],
            "base": s.base,
            "joined": s.joined,
            "indeterminate": s.indeterminate,
            "active": s.active,
            "losing": s.losing,
            "rates": [f"rate_{i + 1}" for i in range(d)],
            "dragged": s.dragged,
            "kinds": [end["kind"] for end in ends],
            "drives": any(end["moved"] for end in ends),
            "pushes": [f"wrench_{i + 1}" in surrounding for i in range(d)],
            "drags": [f"medium_{i + 1}" in surrounding for i in range(d)],
            "stepping": any(word in str(s.describe()) for word in ("heaviside", "abs")),
            "pushed": any(name.startswith("wrench") for name in surrounding),
            "held": [end for end in ends if end["kind"] != "free"],
            "loads": [end for end in ends if end["load"] is not None],
        }
