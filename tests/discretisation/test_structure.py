"""The structure of a kernel: what a model calls for and nothing else; numbers are never part of it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from geocosserat.codegen.identity import identity
from geocosserat.discretisation.structure import RodStructure
from geocosserat.discretisation.structuring import structure_of
from geocosserat.model.expressions import Number, symbols
from geocosserat.model.scene import load_scene
from tests.discretisation.rods import CAST, CLAMPED, FREE, NAMES, WORLD, changed, load, scene, weight


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
    """Uniform without u and t, time with t; with u entries of the law at points, the weight at nodes."""
    found = structure_of(scene(name).model)
    for c in found.coefficients:
        if c.expression is None:
            assert c.name.startswith("mobility")
            assert c.place in ("uniform", "node")
            continue
        used = symbols(c.expression)
        if "t" in used:
            assert c.place == "time"
        elif "u" in used:
            assert c.place == ("node" if c.name.startswith(("weight", "step")) else "point")
        else:
            assert c.place == "uniform"


@pytest.mark.parametrize("name", NAMES)
def test_numbers_are_no_part_of_an_identity(name: str) -> None:
    """Other parameters, lengths, starts and meshes take the same kernel."""
    values = CAST[name]
    parameters = {key: x + 0.01 for key, x in values.get("parameters", {}).items()}
    other = changed(
        name, parameters=parameters, rod={"length": 1.7}, start={"position": values["start"]["position"][::-1]}
    )
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
}


def test_every_change_of_what_there_is_makes_another_kernel() -> None:
    """No two of these rods may share one."""
    found = {what: identity(structure("planar plain", **tables)) for what, tables in OTHERS.items()}
    weights = {"down": (0, -1), "along": (1, 0), "varying": (0, "u"), "in time": (0, "t"), "both": (0, "u*t")}
    for what, force in weights.items():
        heavy = CAST["planar plain"] | {"effects": [weight("planar", *force)]}
        found[what] = identity(structure_of(load_scene(heavy).model))
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


@pytest.mark.parametrize("name", NAMES)
def test_only_loads_fixed_in_the_world_see_the_world(name: str) -> None:
    """In the plane a couple is the same in both frames, and so needs no orientation."""
    assert structure_of(scene(name).model).world == (name in WORLD)


def test_a_planar_dead_torque_is_a_body_torque() -> None:
    """The same kernel serves both."""
    dead, body = (
        structure("planar plain", ends={"right": load("planar", 0, 0, 0, 0, 0, 1.0, frame=frame)})
        for frame in ("world", "body")
    )
    assert dead == body
    pulled = structure("planar plain", ends={"right": load("planar", 0.1, 0, 0, 0, 0, 1.0, frame="world")})
    assert pulled.world


def test_poses_are_marched_from_a_held_end_or_else_carried() -> None:
    """The left one if both are held; a rod held nowhere carries position and angle, or position and quaternion."""
    ends = {"left": (CLAMPED, FREE), "right": (FREE, CLAMPED), "carried": (FREE, FREE)}
    for motion, carried in (("planar", 3), ("spatial", 7)):
        for base, (left, right) in ends.items():
            found = structure(f"{motion} plain", ends={"left": left, "right": right})
            assert (found.base, found.carried) == (base, carried if base == "carried" else 0)
        both = structure(f"{motion} plain", ends={"left": CLAMPED, "right": CLAMPED})
        assert (both.base, both.held) == ("left", (True, True))


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
    times = found.at("time")
    assert times
    for c in times:
        assert c.expression is not None
        assert all(name in ("t", "u") or name.startswith("p_") for name in symbols(c.expression))
    listed = [c.name for c in found.coefficients]
    assert len(set(listed)) == len(listed)


def test_an_effect_that_is_not_known_is_refused() -> None:
    """Nothing is silently left out."""
    model = replace(scene("planar plain").model, effects=("magic",))  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="expected effects of kind weight, found str"):
        structure_of(model)
