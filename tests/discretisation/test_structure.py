"""The structure of a kernel: what a model calls for and nothing else; numbers are never part of it."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocosserat.codegen.identity import identity, templates_hash
from geocosserat.discretisation.structure import RodStructure
from geocosserat.discretisation.structuring import structure_of
from geocosserat.model.expressions import Number, symbols
from geocosserat.model.scene import load_scene
from tests.discretisation.rods import (
    CAST,
    CLAMPED,
    FREE,
    FROZEN,
    JOINED,
    LENGTH,
    MOTIONS,
    NAMES,
    PLACED,
    WORLD,
    acting,
    changed,
    driven,
    effects,
    load,
    scene,
    weight,
)

PINNED = {"kind": "pinned"}


def structure(name: str, **tables: Any) -> RodStructure:
    return structure_of(changed(name, **tables).model)


def names(found: RodStructure) -> set[str]:
    return {c.name for c in found.coefficients}


def test_a_plain_rod_needs_its_diagonals_and_nothing_else() -> None:
    """No load, no weight, no reference, no off-diagonal entry leaves a coefficient."""
    assert names(structure("planar plain")) == {
        "k_1_1", "k_2_2", "k_3_3", "mobility_1_1", "mobility_2_2", "mobility_3_3",
    }  # fmt: skip
    spatial = {f"{stem}_{i}_{i}" for stem in ("k", "mobility") for i in range(1, 7)}
    assert names(structure("spatial plain")) == spatial


@pytest.mark.parametrize("zero", [0, 0.0, "0", "2 - 2", "0*1e3", "-0", "sin(0)"])
def test_an_entry_that_is_zero_in_any_words_leaves_no_coefficient(zero: str | float) -> None:
    """In the law, the reference, the loads and the weight."""
    K = [[3.0, zero, zero], [zero, 2.0, zero], [zero, zero, 1.5]]
    found = structure(
        "planar plain",
        rod={"stiffness": K, "friction": [[1.0, zero, zero], [zero, 2.0, zero], [zero, zero, 0.5]],
             "reference": [1, zero, zero]},
        ends={"right": load("planar", zero, zero, 0, 0, 0, zero, frame="world")},
    )  # fmt: skip
    assert found == structure("planar plain")
    heavy = load_scene(CAST["planar plain"] | {"effects": [weight("planar", zero, zero)]})
    assert structure_of(heavy.model) == structure("planar plain")


def test_a_parameter_that_happens_to_be_zero_keeps_its_coefficient() -> None:
    """It may be changed later, without another kernel."""
    values = CAST["planar plain"] | {"parameters": {"pull": 0.0}, "ends": {"right": {"force": ["pull", 0.0]}}}
    assert "right_f1" in names(structure_of(load_scene(values).model))


@pytest.mark.parametrize("name", NAMES)
def test_every_coefficient_stands_where_it_varies(name: str) -> None:
    """Uniform without u; with u entries of the law and the reference at points, values of effects at nodes. With t they
    are no arguments."""
    found = structure_of(scene(name).model)
    kinds = tuple(effect.kind for effect in scene(name).model.effects)
    arguments = {c.name: place for place in ("uniform", "point", "node") for c in found.at(place)}  # type: ignore[arg-type]
    for c in found.coefficients:
        if c.expression is None:
            ends = [f"{side}_{x}" for side in ("left", "right") for x in ("friction", "mobility", "pull", "home")]
            assert c.name.startswith(("mobility", "slack", *ends))
            assert c.place in (("uniform", "node") if c.name.startswith("mobility") else ("uniform",))
            assert arguments[c.name] == c.place
            continue
        used = symbols(c.expression)
        if "u" in used and c.name.startswith("step"):
            assert c.place == ("point" if found.law else "node")
        elif "u" in used:
            assert c.place == ("node" if c.name.startswith(kinds) else "point")
        else:
            assert c.place == "uniform"
        assert c.timed == ("t" in used)
        assert (c.name in arguments) != c.timed


@pytest.mark.parametrize("name", NAMES)
def test_numbers_are_no_part_of_an_identity(name: str) -> None:
    """Other parameters, lengths, starts and meshes take the same kernel."""
    values = CAST[name]
    parameters = {key: x + 0.01 for key, x in values.get("parameters", {}).items()}
    length = {} if name in JOINED else {"length": 1.7}  # what closes a ring depends on its length
    other = changed(name, parameters=parameters, rod=length, start={"position": values["start"]["position"][::-1]})
    assert identity(structure_of(other.model)) == identity(structure_of(scene(name).model))
    assert structure_of(other.model).describe() == structure_of(scene(name).model).describe()


def test_entries_of_a_law_may_change_without_another_kernel() -> None:
    """As long as none becomes zero or varies where it did not."""
    plain = identity(structure("planar plain"))
    assert identity(structure("planar plain", rod={"stiffness": [9.0, 8.0, 7.0], "friction": [1.1, 1.2, 1.3]})) == plain
    bent = identity(structure("planar plain", rod={"reference": [1, 0, 0.3]}))
    assert identity(structure("planar plain", rod={"reference": [1, 0, -9.3]})) == bent != plain


OTHERS: dict[str, dict[str, Any]] = {
    "a coupling in the law": {"rod": {"stiffness": [[3.0, 0.1, 0], [0.1, 2.0, 0], [0, 0, 1.5]]}},
    "another coupling": {"rod": {"stiffness": [[3.0, 0, 0.1], [0, 2.0, 0], [0.1, 0, 1.5]]}},
    "a coupling in the friction": {"rod": {"friction": [[3.0, 0.1, 0], [0.1, 2.0, 0], [0, 0, 1.5]]}},
    "a stiffness that varies": {"rod": {"stiffness": [3.0, 2.0, "1 + u"]}},
    "a friction that varies": {"rod": {"friction": [3.0, 2.0, "1 + u"]}},
    "a curvature at rest": {"rod": {"reference": [1, 0, 0.5]}},
    "a varying curvature at rest": {"rod": {"reference": [1, 0, "u"]}},
    "a free left end": {"ends": {"left": FREE}},
    "a clamped right end": {"ends": {"right": CLAMPED}},
    "the other way round": {"ends": {"left": FREE, "right": CLAMPED}},
    "a follower force": {"ends": {"right": load("planar", 1, 0, 0, 0, 0, 0)}},
    "a follower force across": {"ends": {"right": load("planar", 0, 1, 0, 0, 0, 0)}},
    "a dead force": {"ends": {"right": load("planar", 1, 0, 0, 0, 0, 0, frame="world")}},
    "a force on the other end": {"ends": {"left": load("planar", 1, 0, 0, 0, 0, 0)}},
    "a force in time": {"ends": {"right": load("planar", "t", 0, 0, 0, 0, 0)}},
    "another force in time": {"ends": {"right": load("planar", "2*t", 0, 0, 0, 0, 0)}},
    "a couple": {"ends": {"right": load("planar", 0, 0, 0, 0, 0, 1)}},
    "a pinned left end": {"ends": {"left": PINNED}},
    "a pinned right end": {"ends": {"right": PINNED}},
    "both ends pinned": {"ends": {"left": PINNED, "right": PINNED}},
    "a free left end, the other pinned": {"ends": {"left": FREE, "right": PINNED}},
    "a couple on a pinned end": {"ends": {"right": PINNED | {"torque": 1}}},
    "a driven left end": {"ends": {"left": {"kind": "driven", "twist": [1, 0, 0]}}},
    "an end driven another way": {"ends": {"left": {"kind": "driven", "twist": [0, 0, 1]}}},
    "an end driven in time": {"ends": {"left": {"kind": "driven", "twist": ["t", 0, 0]}}},
    "a driven right end": {"ends": {"left": FREE, "right": {"kind": "driven", "twist": [1, 0, 0]}}},
    "one frozen mode": {"rod": {"frozen": ["h1"]}},
    "another frozen mode": {"rod": {"frozen": ["Pi"]}},
    "two frozen modes": {"rod": {"frozen": ["h1", "h2"]}},
    "a frozen mode, both ends held": {"rod": {"frozen": ["h1"]}, "ends": {"right": CLAMPED}},
    "an active curvature": {"rod": {"reference": [1, 0, "t"]}},
    "another active curvature": {"rod": {"reference": [1, 0, "2*t"]}},
    "an active stretch": {"rod": {"reference": ["1 + t", 0, 0]}},
}


def test_every_change_of_what_there_is_makes_another_kernel() -> None:
    """No two of these rods may share one."""
    found = {what: identity(structure("planar plain", **tables)) for what, tables in OTHERS.items()}
    weights = {"down": (0, -1), "along": (1, 0), "varying": (0, "u"), "in time": (0, "t"), "both": (0, "u*t")}
    for what, force in weights.items():
        heavy = CAST["planar plain"] | {"effects": [weight("planar", *force)]}
        found[what] = identity(structure_of(load_scene(heavy).model))
    for kind, values in effects("planar").items():
        found[kind] = identity(structure_of(load_scene(CAST["planar plain"] | {"effects": [values]}).model))
    ring = CAST["planar plain"] | {"ends": {"joined": True}, "start": {"strain": [1, 0, 2 * np.pi / LENGTH]}}
    found["a ring"] = identity(structure_of(load_scene(ring).model))
    found["plain"], found["spatial"] = identity(structure("planar plain")), identity(structure("spatial plain"))
    assert len(set(found.values())) == len(found)


def test_identity_depends_on_templates_and_version(monkeypatch: pytest.MonkeyPatch) -> None:
    """A kernel written by other templates or another version is another kernel."""
    plain = structure("planar plain")
    before = identity(plain)
    monkeypatch.setattr("geocosserat.codegen.identity.VERSION", "0.0.0")
    other_version = identity(plain)
    monkeypatch.setattr("geocosserat.codegen.identity.templates_hash", lambda: "0")
    assert len({before, other_version, identity(plain)}) == 3


def test_a_page_for_people_is_no_kernel(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """What it looks like renames no kernel; the template of a kernel does."""

    def found() -> str:
        templates_hash.cache_clear()
        return templates_hash()

    monkeypatch.setattr("geocosserat.codegen.identity.shipped", lambda _: tmp_path)
    before = found()
    (tmp_path / "pages").mkdir()
    (tmp_path / "pages" / "page.html.j2").write_text("a page")
    with_page = found()
    (tmp_path / "rod.c.j2").write_text("a kernel")
    with_kernel = found()
    templates_hash.cache_clear()
    assert before == with_page != with_kernel


@pytest.mark.parametrize("name", NAMES)
def test_only_loads_fixed_in_the_world_see_the_world(name: str) -> None:
    """In the plane a couple is the same in both frames, and so needs no orientation; only what differs from place to
    place needs the place."""
    found = structure_of(scene(name).model)
    assert found.sight == ("pose" if name in PLACED else "direction" if name in WORLD else "nothing")
    directions, places = (1, 2) if name.startswith("planar") else (3, 3)
    assert found.increments == {"nothing": 0, "direction": directions, "pose": directions + places}[found.sight]


@pytest.mark.parametrize("motion", MOTIONS)
def test_every_effect_sees_what_it_must_and_no_more(motion: str) -> None:
    """On a rod that is held in one place only."""
    sight = {"follower": "nothing", "couple": "nothing", "field": "direction", "weight": "direction"}
    for kind, values in effects(motion).items():
        found = structure_of(load_scene(CAST[f"{motion} plain"] | {"effects": [values]}).model)
        assert found.sight == sight.get(kind, "pose")
    still = effects(motion)["flow"] | {"gradient": [[0] * len(row) for row in effects(motion)["flow"]["gradient"]]}
    assert structure_of(load_scene(CAST[f"{motion} plain"] | {"effects": [still]}).model).sight == "direction"


def test_a_planar_dead_torque_is_a_body_torque() -> None:
    """The same kernel serves both."""
    dead, body = (
        structure("planar plain", ends={"right": load("planar", 0, 0, 0, 0, 0, 1.0, frame=frame)})
        for frame in ("world", "body")
    )
    assert dead == body
    pulled = structure("planar plain", ends={"right": load("planar", 0.1, 0, 0, 0, 0, 1.0, frame="world")})
    assert pulled.sight == "direction"


@pytest.mark.parametrize("motion", MOTIONS)
def test_poses_are_marched_from_the_end_that_is_held_best(motion: str) -> None:
    """A driven one before a clamped one before a pinned one before a free one, the left one if both are alike. Unless
    the base is clamped, or driven on a course that is known ahead, its pose is carried: position and angle, or position
    and quaternion."""
    ends = {"driven": driven(motion), "clamped": CLAMPED, "pinned": PINNED, "free": FREE}
    order = list(ends)
    for left in ends:
        for right in ends:
            found = structure(f"{motion} plain", ends={"left": ends[left], "right": ends[right]})
            assert found.base == ("left" if order.index(left) <= order.index(right) else "right")
            best = left if found.base == "left" else right
            assert found.carried == (0 if best in ("clamped", "driven") else 3 if motion == "planar" else 7)
            assert found.prescribed == (best == "driven")


STIRRED: dict[str, dict[str, Any]] = {
    "a force that turns with the rod": {"effects": [{"kind": "follower", "force": [0, 1, 0]}]},
    "a weight that changes": {"effects": [{"kind": "weight", "force": ["sin(t)", 0, 0]}]},
    "a medium that flows": {"effects": [{"kind": "flow", "velocity": [1, 0, 0], "gradient": [[0] * 3] * 3}]},
    "a shape at rest that changes": {"rod": {"reference": ["1 + 0.1*sin(t)", 0, 0, 0, 0, 0]}},
}
SETTLING: dict[str, dict[str, Any]] = {
    "nothing": {},
    "a weight": {"effects": [{"kind": "weight", "force": [0, 1, 0]}]},
    "a trap": {"effects": [{"kind": "trap", "stiffness": 2, "centre": [0, 1, 0]}]},
    "a constant field": {"effects": [{"kind": "field", "moment": [1, 0, 0], "field": [0, 1, 0]}]},
}


@pytest.mark.parametrize("what", [*STIRRED, *SETTLING])
def test_a_far_held_end_is_drawn_home_only_where_something_may_stir_the_rod_for_ever(what: str) -> None:
    """Whatever settles travels a path of bounded length, on which an end strays no more than the scheme errs anyway;
    then no pose is marched for it, and no work is done on a passive rod. A driven end stirs; if both are driven, where
    the far one belongs follows from its twist."""
    stirred = what in STIRRED
    moving = driven("spatial")
    for left, right in [*product((moving, CLAMPED, PINNED, FREE), (CLAMPED, PINNED)), (moving, moving)]:
        ends = {"left": left, "right": right}
        values = CAST["spatial plain"] | {"ends": ends} | (STIRRED | SETTLING)[what]
        values["rod"] = CAST["spatial plain"]["rod"] | values["rod"]
        found = structure_of(load_scene(values).model)
        far, side = (found.right, "right") if found.base == "left" else (found.left, "left")
        homed = far.kind != "free" and (stirred or left["kind"] == "driven")
        assert found.guided == (far.kind == "driven")
        assert {c.name for c in found.coefficients if c.name.startswith((f"{side}_pull", f"{side}_home"))} == (
            homes(side, far.kind) if homed else set()
        )
        if what in ("nothing", "a shape at rest that changes"):
            assert found.sight == ("pose" if homed else "nothing")


def homes(side: str, kind: str) -> set[str]:
    """Names of what says where an end in space belongs."""
    if kind == "driven":
        return {f"{side}_pull"}
    frame = tuple(f"{i}{axis}" for i in (1, 2, 3) for axis in "xyz") if kind == "clamped" else ()
    return {f"{side}_pull", *(f"{side}_home_{x}" for x in (*"xyz", *frame))}


@pytest.mark.parametrize("motion", MOTIONS)
def test_a_held_end_needs_the_friction_only_where_its_drag_is_felt(motion: str) -> None:
    """A driven one always, the others in a medium that moves; all but a free one, which has that of every node."""
    ends = {"driven": driven(motion), "clamped": CLAMPED, "pinned": PINNED, "free": FREE}
    for kind, end in ends.items():
        for effect in ("flow", "trap"):
            values = CAST[f"{motion} plain"] | {"ends": {"left": end}, "effects": acting(motion, effect)}
            found = structure_of(load_scene(values).model)
            felt = kind == "driven" or (effect == "flow" and kind != "free")
            assert (found.left.friction is not None) == felt
            assert any(name.startswith("left_friction") for name in names(found)) == felt
            assert (found.left.mobility is not None) == (kind == "pinned")


def test_frozen_modes_leave_no_stiffness() -> None:
    """Neither their own entry nor what couples them to others; their reference stays."""
    K = [[3.0, 0.1, 0.2], [0.1, 2.0, 0.3], [0.2, 0.3, 1.5]]
    found = structure("planar plain", rod={"stiffness": K, "frozen": ["h2"], "reference": [1, 0.1, 0.2]})
    assert {name for name in names(found) if name.startswith("k_")} == {"k_1_1", "k_1_3", "k_3_3"}
    assert found.stiffness[1] == ("0", "0", "0")
    assert found.state_names == ("h1", "F2", "Pi")
    assert {"rest_h2", "rest_Pi"} <= names(found)


@pytest.mark.parametrize("name", FROZEN)
def test_frozen_modes_yield_only_where_both_ends_are_held(name: str) -> None:
    """One slack for each, where a stress might have no unique value."""
    found = structure_of(scene(name).model)
    held = name in JOINED or "free" not in (scene(name).model.left.kind, scene(name).model.right.kind)
    stresses = {s for s, frozen in zip(found.group.stress, found.frozen, strict=True) if frozen}
    assert {c for c in names(found) if c.startswith("slack")} == ({f"slack_{s}" for s in stresses} if held else set())
    assert found.indeterminate == held


@pytest.mark.parametrize("name", NAMES)
def test_only_a_reference_that_changes_has_a_rate(name: str) -> None:
    """And just those of its components that do; a law that changes is active, too, if it says what is stored."""
    found = structure_of(scene(name).model)
    for mode, e in zip(found.group.strain, scene(name).model.reference, strict=True):
        assert (f"rate_{mode}" in names(found)) == ("t" in symbols(e))
    law = scene(name).model.law
    changing = law is not None and law.energy is not None and "t" in symbols(law.energy)
    assert found.active == (changing or any("t" in symbols(e) for e in scene(name).model.reference))


def test_the_mobility_couples_what_the_friction_couples_directly_or_through_others() -> None:
    """1 with 2 and 2 with 3 gives a full inverse; 1 with 3 leaves 2 alone."""
    chain = structure("planar plain", rod={"friction": [[3.0, 0.1, 0], [0.1, 2.0, 0.1], [0, 0.1, 1.5]]})
    assert "0" not in {entry for row in chain.mobility for entry in row}
    skip = structure("planar plain", rod={"friction": [[3.0, 0, 0.1], [0, 2.0, 0], [0.1, 0, 1.5]]})
    assert [[entry != "0" for entry in row] for row in skip.mobility] == [
        [True, False, True], [False, True, False], [True, False, True],
    ]  # fmt: skip


@pytest.mark.parametrize("seed", range(20))
def test_the_mobility_is_zero_exactly_where_the_inverse_of_the_friction_is(seed: int) -> None:
    """For any pattern of couplings: a component answers to all those it is connected with, and to no other."""
    rng = np.random.default_rng(seed)
    coupled = rng.random((6, 6)) < 0.15
    coupled = coupled | coupled.T | np.eye(6, dtype=bool)
    connected = np.linalg.matrix_power(coupled.astype(int), 6) > 0
    friction = tuple(tuple(Number(float(entry)) for entry in row) for row in coupled)
    found = structure_of(replace(scene("spatial plain").model, friction=friction))
    np.testing.assert_array_equal([[entry != "0" for entry in row] for row in found.mobility], connected)


def test_names_of_parameters_cannot_meet_names_of_the_kernel() -> None:
    """Those that enter a kernel are prefixed, each once."""
    found = structure("planar everything")
    assert found.timed
    for c in found.timed:
        assert c.expression is not None
        assert all(name in ("t", "u") or name.startswith("p_") for name in symbols(c.expression))
    listed = [c.name for c in found.coefficients]
    assert len(set(listed)) == len(listed)
