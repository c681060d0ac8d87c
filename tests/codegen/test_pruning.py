"""Pruning, proved: what a scene does not name costs its kernel nothing, whatever else there may be."""

from __future__ import annotations

import json
import re
from itertools import combinations

import pytest

from geocosserat.codegen.source import KernelSource, generate
from geocosserat.discretisation.structuring import structure_of
from geocosserat.model.effects import registry
from geocosserat.model.scene import load_scene
from tests.codegen.counts import ENDS, FILE, HELD, KINDS, counts, source, values, wanted
from tests.discretisation.rods import FROZEN, LAWFUL, MOTIONS, scene

motions = pytest.mark.parametrize("motion", MOTIONS)
SIGHTS = ("nothing", "direction", "pose")


def arguments(s: KernelSource) -> set[str]:
    return {name for place in ("uniform", "point", "node") for name in s.signature[place]}


@pytest.mark.slow
def test_kernels_consist_of_what_they_did() -> None:
    """No effect and no end has got dearer, in the plane or in space, for a scene with it or without; a change that is
    meant to change these counts writes them anew: python -m tests.codegen.counts"""
    known = json.loads(FILE.read_text())
    found = {name: counts(source(*what)) for name, what in wanted().items()}
    assert set(found) == set(known)
    changed = {name: (known[name], row) for name, row in found.items() if row != known[name]}
    assert not changed, f"expected the counts of tests/codegen/counts.json, found others: {changed}"


@motions
@pytest.mark.parametrize("kind", ["", *KINDS])
def test_a_kernel_does_not_depend_on_effects_that_its_scene_does_not_name(
    motion: str, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In a program without any other effect its text is the same, letter for letter."""
    kinds = (kind,) if kind else ()
    monkeypatch.setattr(registry, "_KINDS", {name: registry._KINDS[name] for name in kinds})
    alone = generate(structure_of(load_scene(values(motion, ENDS[0], kinds)).model))
    among = source(motion, ENDS[0], kinds)
    assert (alone.c, alone.numpy, alone.signature) == (among.c, among.numpy, among.signature)


@motions
@pytest.mark.parametrize("pair", list(combinations(KINDS, 2)), ids=" and ".join)
def test_two_effects_need_what_each_of_them_needs_and_no_more(motion: str, pair: tuple[str, str]) -> None:
    """Their arguments together, the sight of the one that sees more, an addition where both act; the rest is as if
    neither were there."""
    none, one, other = (source(motion, ENDS[0], kinds) for kinds in ((), pair[:1], pair[1:]))
    both = source(motion, ENDS[0], pair)
    assert arguments(both) == arguments(one) | arguments(other)
    assert both.signature["sight"] == max(one.signature["sight"], other.signature["sight"], key=SIGHTS.index)
    n, a, b, ab = (s.signature["operations"] for s in (none, one, other, both))
    for part in ("stress", "strain_rate", "tangent"):
        assert n[part] == a[part] == b[part] == ab[part]
    d = len(both.signature["twist"])
    assert max(a["surroundings"], b["surroundings"]) <= ab["surroundings"]
    assert ab["surroundings"] <= a["surroundings"] + b["surroundings"] + d
    assert n["velocity"] <= max(a["velocity"], b["velocity"]) == ab["velocity"] <= n["velocity"] + d


@motions
@pytest.mark.parametrize("kind", KINDS)
def test_an_effect_adds_its_own_arguments_only(motion: str, kind: str) -> None:
    """They are called after it; of a flow, the friction of an end that stands in it too."""
    more = arguments(source(motion, ENDS[0], (kind,))) - arguments(source(motion, ENDS[0], ()))
    assert all(name.startswith(kind) or (kind == "flow" and name.startswith("left_friction")) for name in more)
    assert arguments(source(motion, "free free", (kind,))) - arguments(source(motion, "free free", ())) == {
        name for name in more if name.startswith(kind)
    }


MARKS = {
    # text of C: the ends of a plain rod that leave it
    r"\bhold\(": set(HELD),
    r"\bcarry\(": {"free free", "pinned free", "joined"},
    r"\bcarry_tangent\(": {"free free", "pinned free", "joined"},
    r"\bcourse\(": set(),
    r"\bjoin\(": {"joined"},
    r"\bmerge\(": {"joined"},
    r"\bclose_ring\(": {"joined"},
    r"\borient\(": set(),
    r"\bFROZEN\[": {"frozen"},
    r"\bproblem_residual\(": {"frozen"},
    r"\bload_on\(": set(),
    r"\bsupplied\(": set(),
    r"\bsurround\(": set(),
    r"\bheaviside\(": set(),
    r"\bpower\[stride \+ n\]": {"driven free"},
    r"_mobility_": {"pinned free"},
    r"_friction_": {"driven free"},
    r"_(pull|home_\w+) ": set(),
}


@motions
@pytest.mark.parametrize("mark", MARKS)
def test_every_kind_of_end_leaves_its_own_marks_only(motion: str, mark: str) -> None:
    """Functions, arguments and rows of the kernels of rods on which nothing else acts."""
    found = {ends for ends in ENDS if re.search(mark, source(motion, ends, ()).c)}
    assert found == MARKS[mark]


@pytest.mark.parametrize("name", [name for name in FROZEN if name not in LAWFUL])
def test_frozen_modes_leave_no_stiffness_of_theirs(name: str) -> None:
    """Not an argument, not a letter in either text; of the others there is all."""
    structure = structure_of(scene(name).model)
    s = generate(structure)
    for i, held in enumerate(structure.frozen, start=1):
        own = [rf"\bk_{i}_\d\b", rf"\bk_\d_{i}\b"]
        for text in (s.c, s.numpy, json.dumps(s.signature)):
            assert any(re.search(mark, text) for mark in own) == (not held)


@motions
def test_a_frozen_mode_takes_operations_away(motion: str) -> None:
    """Fewer of the stress and its tangent, and no more of anything at a point or a node."""
    free, frozen = (source(motion, ends, ()).signature["operations"] for ends in ("clamped free", "frozen"))
    assert frozen["stress"] < free["stress"]
    assert frozen["tangent"] < free["tangent"]
    assert all(frozen[part] <= free[part] for part in free)
