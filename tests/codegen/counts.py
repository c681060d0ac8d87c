"""What kernels consist of: the counts that tests compare, and the command that writes them anew.

python -m tests.codegen.counts     (from the top of the checkout, after a change that is meant to change them)
"""

from __future__ import annotations

import ast
import json
import re
from functools import cache
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from geocosserat.codegen.source import KernelSource, generate
from geocosserat.discretisation.structuring import structure_of
from geocosserat.model.scene import load_scene
from tests.discretisation.rods import CAST, CLAMPED, FREE, LENGTH, MOTIONS, STRETCHES, driven, effects

FILE = Path(__file__).with_name("counts.json")
KINDS = tuple(effects("planar"))
SETS = ((), *((kind,) for kind in KINDS), *combinations(KINDS, 2))
HELD = ("clamped free", "pinned free", "driven free", "free clamped", "clamped clamped", "frozen")
ENDS = (*HELD, "free free", "joined")


def values(motion: str, ends: str, kinds: tuple[str, ...]) -> dict[str, Any]:
    """A plain rod with these ends (or frozen stretches, clamped and free) and these effects."""
    found = CAST[f"{motion} plain"] | {"effects": [effects(motion)[kind] for kind in kinds]}
    if ends == "joined":
        bend = 2 * np.pi / LENGTH
        strain = [1, 0, bend] if motion == "planar" else [1, 0, 0, 0, 0, bend]
        return found | {"ends": {"joined": True}, "start": {"strain": strain}}
    if ends == "frozen":
        return found | {"rod": found["rod"] | {"frozen": STRETCHES[motion]}}
    known = {"clamped": CLAMPED, "free": FREE, "pinned": {"kind": "pinned"}, "driven": driven(motion)}
    left, right = ends.split()
    return found | {"ends": {"left": known[left], "right": known[right]}}


@cache
def source(motion: str, ends: str, kinds: tuple[str, ...]) -> KernelSource:
    return generate(structure_of(load_scene(values(motion, ends, kinds)).model))


def counts(s: KernelSource) -> dict[str, int]:
    """Operations of each part, arguments, entries of state and pose; all statements of C and arithmetic of numpy."""
    bare = re.sub(r"/\*.*?\*/", "", s.c, flags=re.DOTALL)
    arithmetic = sum(isinstance(node, ast.BinOp | ast.UnaryOp | ast.Call) for node in ast.walk(ast.parse(s.numpy)))
    enum = re.search(r"CARRIED = (\d+), SEEN = (\d+), ROWS = (\d+)", s.c)
    assert enum is not None
    return {
        **{name.replace("_", " "): count for name, count in s.signature["operations"].items()},
        "arguments": sum(len(s.signature[place]) for place in ("uniform", "point", "node")),
        "fields": len(s.signature["state"]) + sum(int(x) for x in enum.groups()),
        "statements": bare.count(";"),
        "arithmetic": arithmetic,
    }


def wanted() -> dict[str, tuple[str, str, tuple[str, ...]]]:
    """All scenes that are counted, by name: every set of effects on one kind of rod, every single one on the others."""
    found = {}
    for motion in MOTIONS:
        for ends in ENDS:
            for kinds in SETS:
                if len(kinds) < 2 or ends == ENDS[0]:
                    found[f"{motion}, {ends}, {' and '.join(kinds) or 'nothing'}"] = (motion, ends, kinds)
    return found


def write() -> None:
    found = {name: counts(source(*what)) for name, what in wanted().items()}
    rows = (f"  {json.dumps(name)}: {json.dumps(row)}" for name, row in found.items())
    FILE.write_text("{\n" + ",\n".join(rows) + "\n}\n")


if __name__ == "__main__":
    write()
