"""Scenes: what is read is what was written, and everything wrong is refused with one message that says what to do."""

from __future__ import annotations

import datetime
import math
from typing import Any

import numpy as np
import pytest

from geocosserat.algebra.groups import SE2, SE3
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import Number, evaluate, parse
from geocosserat.model.records import End, RunSettings, Weight
from geocosserat.model.scene import load_scene
from tests.model.scenes import MISSING, PLANAR, SPATIAL, changed


def load(path: str, value: Any, scene: dict[str, Any] = PLANAR) -> Any:
    """The scene with one entry changed."""
    return load_scene(changed(scene, path, value))


def expression(text: str | float) -> Any:
    """The expected expression of a field."""
    return parse(text, {"u", "t", "kappa", "load"})


def test_every_field_of_a_planar_scene_is_read() -> None:
    """A scene that sets every key arrives complete in the records."""
    scene = load_scene(
        {
            "title": "all keys",
            "parameters": {"kappa": 1e4, "load": "kappa/5000"},
            "rod": {
                "motion": "planar",
                "length": "2*load",
                "stiffness": ["kappa", "2*kappa", "1 + u"],
                "friction": [[1, 0.1, 0], [0.1, 2, 0], [0, 0, "load/100"]],
                "reference": ["1", "0", "s"],
                "frozen": [],
            },
            "start": {"strain": [1, 0, "u"], "position": [1, "-load"], "angle": "pi/2"},
            "ends": {
                "left": {"kind": "free", "force": ["cos(t)", 0], "torque": "load*t", "frame": "world"},
                "right": {"kind": "clamped"},
            },
            "effects": [{"kind": "weight", "force": ["u*t", -1]}, {"kind": "weight", "force": [0, "-load"]}],
            "run": {
                "until": "load/2",
                "frames": 5,
                "accuracy": 1e-4,
                "elements": 8,
                "degree": "load",
                "method": "radau",
                "rtol": 1e-5,
                "atol": 1e-9,
                "backend": "numpy",
            },
        }  # fmt: skip
    )
    model = scene.model
    zero, one = Number(0.0), Number(1.0)
    assert scene.title == "all keys"
    assert model.group is SE2
    assert model.parameters == {"kappa": 1e4, "load": 2.0}
    assert model.length == 4.0
    assert model.stiffness == (
        (expression("kappa"), zero, zero), (zero, expression("2*kappa"), zero), (zero, zero, expression("1+u")),
    )  # fmt: skip
    assert model.friction[0] == (one, Number(0.1), zero)
    assert model.friction[2] == (zero, zero, expression("load/100"))
    assert model.reference == (one, zero, expression("u/4"))
    assert model.frozen == ()
    assert model.left == End("free", (expression("cos(t)"), zero), (expression("load*t"),), "world")
    assert model.right == End("clamped")
    assert model.effects == (
        Weight((expression("u*t"), Number(-1.0))), Weight((zero, expression("-load"))),
    )  # fmt: skip
    assert scene.start.strain == (one, zero, expression("u"))
    assert scene.start.position == (1.0, -2.0)
    assert scene.start.rotation == (math.pi / 2,)
    assert scene.run == RunSettings(1.0, 5, 1e-4, 8, 2, "radau", 1e-5, 1e-9, "numpy")


def test_every_field_of_a_spatial_scene_is_read() -> None:
    """In space: six strains, a torque of three components, a rotation vector."""
    scene = load("start", {"position": [1, 2, 3], "rotation": [0.1, 0.2, "load"]}, SPATIAL)
    assert scene.model.group is SE3
    assert len(scene.model.stiffness) == len(scene.model.friction[5]) == 6
    assert scene.model.right.torque == (Number(0.0), Number(0.0), Number(1.0))
    assert scene.start.position == (1.0, 2.0, 3.0)
    assert scene.start.rotation == (0.1, 0.2, 2.0)


def test_what_a_scene_leaves_out_has_the_documented_default() -> None:
    """Straight at rest and at the start, clamped left, free right, at the origin along x."""
    scene = load_scene({"rod": PLANAR["rod"] | {"stiffness": [1, 1, 1]}, "run": {"until": 2}})
    straight = (Number(1.0), Number(0.0), Number(0.0))
    assert scene.title == "untitled"
    assert scene.model.reference == scene.start.strain == straight
    assert (scene.model.left, scene.model.right) == (End("clamped"), End("free"))
    assert (scene.start.position, scene.start.rotation) == ((0.0, 0.0), (0.0,))
    assert scene.model.effects == ()
    assert scene.run == RunSettings(2.0, 51, 1e-6)


def test_the_start_is_the_reference_unless_given() -> None:
    """A rod with curvature at rest starts with it."""
    scene = load("rod.reference", [1, 0, "2*u"])
    assert scene.start.strain == scene.model.reference == (Number(1.0), Number(0.0), expression("2*u"))


def test_choosing_the_mesh_is_choosing_not_to_ask_for_an_accuracy() -> None:
    """With elements given there is no default accuracy; an accuracy that is given stays."""
    assert load("run.elements", 4).run.accuracy is None
    assert load("run.degree", 4).run.accuracy == 1e-6
    assert load("run", {"until": 1, "elements": 4, "accuracy": 1e-3}).run.accuracy == 1e-3


def test_a_rod_may_be_held_nowhere() -> None:
    """Free at both ends is a rod that swims or sinks."""
    scene = load("ends", {"left": {"kind": "free"}})
    assert scene.model.left.kind == scene.model.right.kind == "free"


def test_a_load_of_zeros_is_no_load() -> None:
    """Zeros leave no term; a parameter that happens to be zero does, for it may be swept."""
    assert load("ends.right", {"force": [0, "-0.0"], "torque": 0}).model.right == End("free")
    scene = load("parameters.load", 0.0)
    assert scene.model.right.force == (Number(0.0), expression("-load"))


def test_s_runs_from_zero_to_one_whatever_the_length() -> None:
    """``s`` becomes ``u/length``."""
    scene = load_scene(changed(changed(PLANAR, "rod.length", 4), "rod.reference", [1, 0, "s**2"]))
    assert evaluate(scene.model.reference[2], {"u": 4.0}) == 1.0
    assert evaluate(scene.model.reference[2], {"u": 2.0}) == 0.25


def test_numpy_numbers_and_tuples_are_welcome_in_a_mapping() -> None:
    """From Python, arrays and tuples stand for lists."""
    scene = load("rod.stiffness", np.diag([1e4, 1e4, 1.0]))
    assert scene.model.stiffness[0][0] == Number(1e4)
    assert load("rod.length", np.float64(2.0)).model.length == 2.0
    assert load("run.frames", np.int64(7)).run.frames == 7
    assert load("start.position", (1, 2)).start.position == (1.0, 2.0)


def test_the_mapping_given_is_left_as_it_was() -> None:
    """Loading with settings copies first."""
    scene = changed(PLANAR, "rod.length", 1.0)
    load_scene(scene, ["rod.length=3", "kappa=5"])
    assert scene == PLANAR


NOT_FINITE = [float("nan"), float("inf"), "9**9**9**9", "1/0", "log(-1)", "exp(1000)"]


@pytest.mark.parametrize("value", NOT_FINITE)
@pytest.mark.parametrize(
    "path",
    [
        "parameters.kappa", "rod.length", "rod.stiffness.0", "rod.friction.2", "start.position.1", "start.angle",
        "ends.right.force.0", "ends.right.torque", "effects.0.force.1", "run.until", "run.accuracy", "run.frames",
    ],
)  # fmt: skip
def test_no_number_may_be_infinite_or_nan(path: str, value: Any) -> None:
    """Wherever a number stands, written or computed, it must be finite."""
    scene = changed(changed(PLANAR, "start.position", [0, 0]), path, value)
    with pytest.raises(InputError, match=r"expected a (finite|positive) number, found .*(nan|inf)"):
        load_scene(scene)


@pytest.mark.parametrize("value", [True, [1.0], {"a": 1}, datetime.date(2000, 1, 1), None])
@pytest.mark.parametrize(
    "path",
    [
        "parameters.kappa", "rod.length", "rod.stiffness.0", "start.position.1", "start.angle", "ends.right.force.0",
        "ends.right.torque", "effects.0.force.1", "run.until", "run.accuracy", "run.frames", "run.rtol",
    ],
)  # fmt: skip
def test_no_number_may_be_anything_else(path: str, value: Any) -> None:
    """Booleans, lists, tables and dates are not numbers; the message names the place."""
    scene = changed(changed(PLANAR, "start.position", [0, 0]), path, value)
    with pytest.raises(
        InputError, match=rf"^scene: {path.replace('.', '[.]')}.*: expected .*, found "
    ) as caught:
        load_scene(scene)
    assert "\n" not in str(caught.value)


REFUSALS = [
    # path, value, wording
    ("rodd", {}, r"scene: rodd: expected one of title, .*, found an unknown key; did you mean rod\?"),
    ("rod", MISSING, r"rod: expected a table, found nothing; write \[rod\] above its keys"),
    ("run", MISSING, r"run: expected a table, found nothing; write \[run\]"),
    ("rod", 3, "rod: expected a table, found 3"),
    ("start", [], "start: expected a table, found"),
    ("ends", True, "ends: expected a table, found the boolean true"),
    ("ends.right", "free", r"ends.right: expected a table, found 'free'; write \[ends.right\]"),
    ("run", "fast", "run: expected a table, found 'fast'"),
    ("title", 3, "title: expected one line of at most 200 characters, found 3"),
    ("title", "two\nlines", "title: expected one line"),
    ("title", "\x1b[31m", r"title: expected one line .*, found '\\x1b\[31m'"),
    ("title", "x" * 201, "title: expected one line of at most 200"),
    # parameters
    ("parameters", [1], r"parameters: expected a table of numbers, found \[1\]; write \[parameters\]"),
    ("parameters.kappa", "kapa", "parameters.kappa: .* the name kapa is not known; did you mean kappa"),
    ("parameters.kappa", "kappa + 1", "kappa: expected a value that does not depend on itself, found kappa -> kappa"),
    ("parameters", {"a": "b", "b": "2*c", "c": "a", "kappa": 1, "load": 1}, r"itself, found (\w -> ){3}\w; break it"),
    ("parameters.load", "u", "the name u is not known"),
    ("parameters.u", 1, "parameters.u: expected a name of your own, found u, which every expression knows; rename"),
    ("parameters.t", 1, "parameters.t: expected a name of your own"),
    ("parameters.s", 1, "parameters.s: expected a name of your own"),
    ("parameters.pi", 3, "parameters.pi: expected a name of your own"),
    ("parameters.heaviside", 1, "parameters.heaviside: expected a name of your own"),
    ("parameters.2a", 1, "parameters.2a: expected a name, found '2a'"),
    ("parameters.a-b", 1, "expected a name, found 'a-b'; use at most 64 of"),
    ("parameters.\N{GREEK SMALL LETTER KAPPA}", 1, r"parameters.'\\u03ba': expected a name"),
    ("parameters." + "a" * 65, 1, "expected a name, found 'a"),
    # rod
    ("rod.motion", MISSING, "rod.motion: expected one of planar, spatial, found nothing"),
    ("rod.motion", "planer", r"rod.motion: .*, found 'planer'; did you mean planar\?"),
    ("rod.motion", 2, "rod.motion: expected one of planar, spatial, found 2"),
    ("rod.length", MISSING, "rod.length: expected a positive number, found nothing; add it"),
    ("rod.length", 0, "rod.length: expected a positive number, found 0"),
    ("rod.length", "-load", "rod.length: expected a positive number, found '-load' = -2.0"),
    ("rod.length", "u", "rod.length: .* found 'u', which depends on u; remove u"),
    ("rod.length", "2*t", "rod.length: expected a number or an expression of the parameters, .* depends on t"),
    ("rod.length", "kapa", r"did you mean kappa\?"),
    ("rod.lenght", 1, r"rod.lenght: expected one of motion, length.*; did you mean length\?"),
    ("rod.stiffness", MISSING, r"rod.stiffness: expected a list of 3 \(h1, h2, Pi\) or of as many rows, found nothing"),
    ("rod.friction", MISSING, r"rod.friction: expected a list of 3 \(v1, v2, Omega\)"),
    ("rod.stiffness", 3, r"rod.stiffness: expected a list of 3 .*, found 3; write \[..\] with 3 entries"),
    ("rod.stiffness", [1, 2], "rod.stiffness: expected a list of 3 .*, found a list of 2; write 3 entries"),
    ("rod.stiffness", [[1, 0, 0], [0, 1, 0]], "rod.stiffness: .*, found a list of 2"),
    ("rod.stiffness", [[1, 0, 0], [0, 1], [0, 0, 1]], r"rod.stiffness.1: expected a list of 3 .*, found a list of 2"),
    ("rod.stiffness", [[1, 0, 0], 1, [0, 0, 1]], r"rod.stiffness.1: expected a list of 3 .*, found 1"),
    ("rod.stiffness.0", "kappa*t", "rod.stiffness.0: .* of u, s and the parameters, found .* depends on t; remove t"),
    ("rod.friction.0", "1+t", "rod.friction.0: .* depends on t"),
    ("rod.stiffness.0", -1, r"rod.stiffness: expected a positive definite matrix, found \(h1, h1\) = -1 at u = 0; a pas"),
    ("rod.stiffness.2", 0, r"\(Pi, Pi\) = 0 at u = 0; a passive rod resists every deformation"),
    ("rod.friction.2", 0.0, r"\(Omega, Omega\) = 0 .*no friction for a rotation is not available in this version"),
    ("rod.friction.0", "1 - 2*u", r"rod.friction: .* definite matrix, found \(v1, v1\) = 0 at u = 0.5; every motion"),
    ("rod.stiffness.2", "1 - 2*heaviside(u - 0.123)", r"\(Pi, Pi\) = -1 at u = 0.123"),
    ("rod.stiffness.2", "1 - 2*(heaviside(u-0.4001) - heaviside(u-0.4002))", r"\(Pi, Pi\) = -1 at u = 0.400"),
    ("rod.stiffness.2", "1/(u - 0.5)**2", r"rod.stiffness: expected a finite matrix, found \(Pi, Pi\) = inf at u = 0.5"),
    ("rod.stiffness", [[1, 2, 0], [2, 1, 0], [0, 0, 1]], "a positive definite matrix, found the eigenvalue -1 "),
    ("rod.stiffness", [[1, 1, 0], [1, 1, 0], [0, 0, 1]], "a positive definite matrix, found the eigenvalue"),
    ("rod.stiffness", [[1, 0, 0], [0, 1, "2*u"], [0, "2*u", 1]], "definite matrix, found the eigenvalue .* at u = 0.5"),
    ("rod.stiffness", [[1, 0, 1e308], [0, 1, 0], [1e308, 0, 1e-300]], "positive definite matrix, found the eigenvalue"),
    ("rod.stiffness", [[1, 0, 0.1], [0, 1, 0], [0.2, 0, 1]],
     r"a symmetric matrix, found \(h1, Pi\) = 0.1 but \(Pi, h1\) = 0.2 at u = 0; make the two equal"),
    ("rod.friction", [[1, 0, "u/9"], [0, 1, 0], [0, 0, 1]], r"rod.friction: expected a symmetric matrix, found \(v1, Om"),
    ("rod.stiffness.0", "heaviside(sin(9*u))+1", "rod.stiffness: expected steps at known places, .* not a step at one"),
    ("rod.reference", [1, 0], r"rod.reference: expected a list of 3 \(h1, h2, Pi\), found a list of 2"),
    ("rod.reference", [1, 0, "sin(t)"], "rod.reference.2: expected a reference that does not change in time, found "
     r"'sin\(t\)', which is not available in this version; write an expression of u"),
    ("rod.reference", [1, 0, "1/(u-0.5)"], "rod.reference.2: expected a finite value, found inf at u = 0.5"),
    ("rod.reference", [1, 0, "log(u - 1)"], "rod.reference.2: expected a finite value, found nan at u = 0;"),
    ("rod.reference", [1, 0, "heaviside(u*u - 0.2)"], "rod.reference.2: expected steps at known places"),
    ("rod.frozen", ["h1", "h2"], r"rod.frozen: expected no frozen mode, found \['h1', 'h2'\], which is not available"),
    ("rod.frozen", ["h3"], r"rod.frozen.0: expected one of h1, h2, Pi, found 'h3'; write one of the words"),
    ("rod.frozen", [1], "rod.frozen.0: expected one of h1, h2, Pi, found 1"),
    ("rod.frozen", "h1", "rod.frozen: expected a list of modes, found 'h1'; choose from h1, h2, Pi"),
    ("rod.law", "odd.toml", "rod.law: expected no law file, found 'odd.toml', which is not available in this version; "
     "write rod.stiffness instead"),
    # start
    ("start.strain", [1, 0, "t"], "start.strain.2: .* depends on t; remove t"),
    ("start.strain", [1, 0], "start.strain: expected a list of 3"),
    ("start.strain", [1, 0, "1/u"], "start.strain.2: expected a finite value, found inf at u = 0"),
    ("start.position", [0, 0, 0], r"start.position: expected a list of 2 \(x, y\), found a list of 3; write 2"),
    ("start.position", ["u", 0], "start.position.0: .* depends on u"),
    ("start.rotation", [0, 0, 1], "start.rotation: expected angle, found rotation; this motion takes angle = a number"),
    ("start.angel", 1, r"start.angel: .* did you mean angle\?"),
    # ends
    ("ends.middle", {}, "ends.middle: expected one of left, right, found an unknown key"),
    ("ends.right.kind", "pinned", "ends.right.kind: expected clamped or free, found 'pinned', which is not available "
     "in this version; change the kind of this end"),
    ("ends.left.kind", "joined", "found 'joined', which is not available in this version"),
    ("ends.left", {"kind": "driven", "twist": [0, 0, "cos(t)"]}, "found 'driven', which is not available in this version"),
    ("ends.left", {"kind": "driven"}, r"ends.left.twist: expected a list of 3 \(v1, v2, Omega\), found nothing"),
    ("ends.left", {"kind": "driven", "twist": [0, 0, "u"]}, "ends.left.twist.2: .* depends on u"),
    ("ends.left", {"kind": "driven", "force": [0, 0]}, "ends.left.force: expected no load on a driven end"),
    ("ends.right.twist", [0, 0, 0], "ends.right.twist: expected no twist of a free end, found one; only kind = .driven."),
    ("ends.left.force", [0, 1], "ends.left.force: expected no load on a clamped end, found one; a load cannot move it"),
    ("ends.left.torque", 1, "ends.left.torque: expected no load on a clamped end"),
    ("ends.left.frame", "body", "ends.left.frame: expected no load on a clamped end"),
    ("ends.right.kind", "fixed", "ends.right.kind: expected one of clamped, free, .*, found 'fixed'"),
    ("ends.right.kind", "clamp", r"did you mean clamped\?"),
    ("ends.right.frame", "lab", "ends.right.frame: expected one of body, world, found 'lab'; write one of the words"),
    ("ends.right.frame", "World", r"found 'World'; did you mean world\?"),
    ("ends.right.forse", [0, 1], r"ends.right.forse: .* did you mean force\?"),
    ("ends.right.force", [0, 1, 2], r"ends.right.force: expected a list of 2 \(f1, f2\), found a list of 3"),
    ("ends.right.force", ["u", 0], "ends.right.force.0: .* of t and the parameters, found 'u', which depends on u"),
    ("ends.right.force", ["s", 0], "found 's', which depends on s; remove s"),
    ("ends.right.force", ["1/t", 0], "ends.right.force.0: expected a finite value, found inf at t = 0; change"),
    ("ends.right.force", ["sqrt(0.5 - t)", 0], "ends.right.force.0: expected a finite value, found nan at t = 0.5"),
    ("ends.right.torque", [1.0], r"ends.right.torque: expected one number or expression .*, found \[1.0\]; write it wit"),
    ("ends.right.torque", "1/t", "ends.right.torque: expected a finite value, found inf at t = 0"),
    # effects
    ("effects", {"kind": "weight"}, r"effects: expected a list of tables, found a table; write \[\[effects\]\]"),
    ("effects", [1], r"effects: expected a list of tables"),
    ("effects", [{"kind": "weight", "force": [0, 1]}] * 101, "effects: expected at most 100 effects, found a list of 101"),
    ("effects.0.kind", MISSING, "effects.0.kind: expected one of weight, .*, found nothing"),
    ("effects.0.kind", "wieght", r"effects.0.kind: .* did you mean weight\?"),
    ("effects.0.force", MISSING, r"effects.0.force: expected a list of 2 \(x, y\), found nothing"),
    ("effects.0.force", [0, 0, -1], "effects.0.force: expected a list of 2"),
    ("effects.0.force", ["log(u - 0.5)", 0], "effects.0.force.0: expected a finite value, found nan at u = 0"),
    ("effects.0.force", ["1/(u + t)", 0], "effects.0.force.0: expected a finite value, found inf at u = 0 and t = 0"),
    ("effects.0.force", ["heaviside(u - t)", 0], "effects.0.force.0: expected steps at known places, .* must not move"),
    ("effects.0.torque", 1, "effects.0.torque: expected one of kind, force, found an unknown key"),
    ("effects.0", {"kind": "follower", "force": [0, "u*t"]}, "effects.0.kind: expected weight, found 'follower', which is "
     "not available in this version; remove this effect"),
    ("effects.0", {"kind": "follower"}, r"effects.0.force: expected a list of 2 \(f1, f2\), found nothing"),
    ("effects.0", {"kind": "couple", "torque": "u*t"}, "found 'couple', which is not available in this version"),
    ("effects.0", {"kind": "couple", "torque": [1]}, "effects.0.torque: expected one number or expression"),
    ("effects.0", {"kind": "field", "moment": [1, 0], "field": [0, "cos(t)"]}, "'field', which is not available"),
    ("effects.0", {"kind": "field", "moment": [1, 0], "field": [0, "u"]}, "effects.0.field.1: .* depends on u"),
    ("effects.0", {"kind": "flow", "gradient": [[0, 1], [0, 0]], "velocity": [1, 0]}, "'flow', which is not available"),
    ("effects.0", {"kind": "flow", "gradient": [[0, 1]], "velocity": [1, 0]}, "effects.0.gradient: expected a list of 2"),
    ("effects.0", {"kind": "trap", "stiffness": 1, "centre": [0, 0]}, "found 'trap', which is not available"),
    ("effects.0", {"kind": "trap", "stiffness": -1, "centre": [0, 0]}, "effects.0.stiffness: expected a positive number"),
    ("effects.0", {"kind": "trap", "stiffness": 1}, "effects.0.centre: expected a list of 2"),
    # run
    ("run.until", MISSING, "run.until: expected a positive number, found nothing; add it"),
    ("run.until", 0, "run.until: expected a positive number, found 0"),
    ("run.until", -1.5, "run.until: expected a positive number, found -1.5"),
    ("run.until", "t", "run.until: .* depends on t"),
    ("run.frames", 1, "run.frames: expected a whole number from 2 to 100000, found 1"),
    ("run.frames", 2.5, "run.frames: expected a whole number from 2"),
    ("run.frames", 10**40, "run.frames: expected a whole number from 2 to 100000, found an integer of 133 bits"),
    ("run.frames", 10**400, "run.frames: .* found an integer of 1329 bits; the number is too large"),
    ("run.accuracy", 0, "run.accuracy: expected a number between 1e-15 and 1, found 0"),
    ("run.accuracy", 1e-16, "run.accuracy: expected a number between 1e-15 and 1"),
    ("run.accuracy", 2.0, "run.accuracy: expected a number between 1e-15 and 1, found 2.0"),
    ("run.elements", 0, "run.elements: expected a whole number from 1 to 100000, found 0"),
    ("run.elements", 100_001, "run.elements: expected a whole number from 1 to 100000"),
    ("run.degree", 0, "run.degree: expected a whole number from 1 to 64, found 0"),
    ("run.degree", 65, "run.degree: expected a whole number from 1 to 64"),
    ("run.method", "euler", "run.method: expected one of cvode, radau, bdf, lsoda, found 'euler'; write one of"),
    ("run.backend", "cuda", "run.backend: expected one of auto, c, numpy, found 'cuda'"),
    ("run.rtol", 0, "run.rtol: expected a positive number, found 0"),
    ("run.atol", -1e-9, "run.atol: expected a positive number, found -1e-09"),
    ("run.untill", 1, r"run.untill: .* did you mean until\?"),
]  # fmt: skip


@pytest.mark.parametrize(("path", "value", "wording"), REFUSALS)
def test_what_is_wrong_is_refused_with_place_and_remedy(path: str, value: Any, wording: str) -> None:
    """Every key, every way to get it wrong: one line with what was expected, what was found and what to do."""
    with pytest.raises(InputError, match=wording) as caught:
        load(path, value)
    message = str(caught.value)
    assert message.startswith("scene: ")
    assert "\n" not in message
    assert message.isprintable()
    assert len(message) < 500


SPATIAL_REFUSALS = [
    (
        "rod.stiffness",
        [1, 2, 3],
        r"a list of 6 \(h1, h2, h3, Pi1, Pi2, Pi3\) or of as many rows, found a list of 3",
    ),
    ("rod.friction", [1] * 7, r"a list of 6 \(v1, v2, v3, Omega1, Omega2, Omega3\)"),
    (
        "start.angle",
        1.0,
        r"start.angle: expected rotation, found angle; this motion takes rotation = \[x, y, z\]",
    ),
    ("start.rotation", 1.0, r"start.rotation: expected a list of 3 \(x, y, z\), found 1.0"),
    ("ends.right.torque", 1.0, r"ends.right.torque: expected a list of 3 \(m1, m2, m3\), found 1.0"),
    ("ends.right.force", [0, 1], r"ends.right.force: expected a list of 3 \(f1, f2, f3\)"),
    (
        "effects.0",
        {"kind": "couple", "torque": 1.0},
        r"effects.0.torque: expected a list of 3 \(m1, m2, m3\)",
    ),
]


@pytest.mark.parametrize(("path", "value", "wording"), SPATIAL_REFUSALS)
def test_space_has_other_lengths_than_the_plane(path: str, value: Any, wording: str) -> None:
    """What is right in the plane is refused in space, with the names of the components."""
    with pytest.raises(InputError, match=wording):
        load(path, value, SPATIAL)


def test_a_nearly_symmetric_matrix_is_symmetric() -> None:
    """Rounding in expressions is not asymmetry, even where an entry crosses zero."""
    rows = [[1, 0, "0.1*sin(pi*u)"], [0, 1, 0], ["0.1*sin(pi*(1-u))", 0, 1]]
    assert load("rod.stiffness", rows).model.stiffness


def test_stiffnesses_of_very_different_size_are_positive_definite() -> None:
    """Whether a matrix is positive definite does not depend on the units."""
    assert load("rod.stiffness", [[1e20, 0, 1e4], [0, 1e20, 0], [1e4, 0, 1e-10]]).model.stiffness
    with pytest.raises(InputError, match="positive definite"):
        load("rod.stiffness", [[1e20, 0, 1.1e5], [0, 1e20, 0], [1.1e5, 0, 1e-10]])


def test_an_error_has_its_parts_as_attributes() -> None:
    """For a caller that wants to do more than print."""
    with pytest.raises(InputError) as caught:
        load("rod.length", -1)
    error = caught.value
    assert (error.file, error.key, error.found) == ("scene", "rod.length", "-1")
    assert error.expected == "a positive number"
