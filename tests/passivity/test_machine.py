"""Witnesses as scenes: the strain of the rod follows the loop, and nothing but the law does work worth mention."""

from __future__ import annotations

import tomllib
from typing import Any

import numpy as np
import pytest

import geocosserat
from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.model.expressions import Number, evaluate, symbols
from geocosserat.model.law import load_law, rates
from geocosserat.model.scene import load_scene
from geocosserat.passivity.check import Check, check
from geocosserat.passivity.machine import LENGTH, grip
from tests.passivity.zoo import OPEN, ZOO, planar

STRESSES = ("prestressed and odd", "odd, bend and twist", "odd with an open modulus", "odd in the middle",
            "Kelvin-Voigt, odd", "vortex about another state")  # fmt: skip
WRENCHES = ("couple", "trap that swirls", "follower in space", "open couple")


def found(name: str) -> Check:
    """What is found of a law of the zoo."""
    return check(load_law({"name": name, **ZOO[name].law}), brief=True)


def twist_at(scene: Any, t: Any, side: str = "right") -> Any:
    """The twist of a driven end at times t, (d, times)."""
    return np.stack([np.broadcast_to(evaluate(e, {"t": t}), np.shape(t)) for e in getattr(scene.model, side).twist])


@pytest.mark.parametrize("group", [SE2, SE3], ids=lambda group: group.name)
def test_the_grip_makes_the_strain_change_as_asked(group: Group) -> None:
    """dE/dt = V / L + ad_E V / 2 with the group's own ad, at random strains and rates."""
    chance = np.random.default_rng(3)
    for _ in range(50):
        turn, rate = chance.normal(size=(2, group.dimension)) * 2
        numbers = [tuple(Number(float(x)) for x in v) for v in (turn, rate)]
        twist = np.array([float(evaluate(e, {})) for e in grip(group, *numbers)])
        reached = twist / LENGTH + group.ad(turn) @ twist / 2
        np.testing.assert_allclose(reached, rate, rtol=0, atol=1e-13 * max(1.0, float(np.abs(twist).max()) * 5))


@pytest.mark.parametrize("name", STRESSES)
def test_the_strain_that_the_twist_makes_is_the_loop(name: str) -> None:
    """At random times, the scene's own text: V / L + ad_E V / 2 is the rate of the ellipse; it begins on it."""
    answer = found(name)
    assert answer.stress is not None
    loop, scene, group = answer.stress.witness, load_scene(answer.scenes["stress"]), answer.law.group
    assert loop is not None
    t = np.random.default_rng(4).uniform(0, 1, 20)
    a, b = (float(r) for r in loop.radii)
    turn = np.repeat(np.array([[float(c)] for c in loop.centre]), t.size, axis=1)
    rate = np.zeros_like(turn)
    turn[loop.first] += a * np.cos(2 * np.pi * t)
    turn[loop.second] += b * np.sin(2 * np.pi * t)
    rate[loop.first], rate[loop.second] = -2 * np.pi * a * np.sin(2 * np.pi * t), 2 * np.pi * b * np.cos(2 * np.pi * t)
    twist = twist_at(scene, t)
    reached = twist.T / LENGTH + np.einsum("tij,jt->ti", group.ad(turn.T), twist) / 2
    np.testing.assert_allclose(reached, rate.T, rtol=0, atol=1e-13 * (1 + np.abs(twist).max()))
    begins = np.array([float(c) for c in loop.centre])
    begins[loop.first] += a
    starts = np.array([float(evaluate(e, {"u": 0.5})) for e in scene.start.strain])
    np.testing.assert_allclose(starts, begins, rtol=1e-15)


@pytest.mark.parametrize("name", ["prestressed and odd", "odd, bend and twist"])
def test_the_rod_goes_round_the_loop(name: str) -> None:
    """The turn in the solution is that of the ellipse at every frame, and the stress is the law's."""
    answer = found(name)
    assert answer.stress is not None
    loop = answer.stress.witness
    assert loop is not None
    solution = geocosserat.run(answer.scenes["stress"], settings=["run.backend=numpy", "run.frames=11"]).solution
    t = np.asarray(solution.time)
    path = loop.path(answer.law.group.strain)
    expected = np.stack([np.broadcast_to(evaluate(e, {"s": t}), t.shape) for e in path.values()], axis=-1)
    np.testing.assert_allclose(solution.turn[:, 0], expected, atol=1e-9)
    env = dict(zip(answer.law.group.strain, expected.T, strict=True))
    stress = [np.broadcast_to(evaluate(e, env), t.shape) for e in answer.law.stress or ()]
    np.testing.assert_allclose(solution.stress[:, 0], np.stack(stress, axis=-1), atol=1e-7)


@pytest.mark.parametrize("name", [*STRESSES, *WRENCHES])
def test_scenes_are_whole(name: str) -> None:
    """Text alone, which loads and says the same when it is written again; numbers stand for what was left open."""
    (text,) = found(name).scenes.values()
    scene = load_scene(text)
    assert load_scene(scene.source).model == scene.model
    law = tomllib.loads(text)["rod"]["law"]
    assert isinstance(law, dict)
    assert not load_law(law).open


@pytest.mark.parametrize("name", [*STRESSES, *WRENCHES])
def test_drag_takes_next_to_nothing(name: str) -> None:
    """More than nothing, which a rod must have, and less than 1e-9 of the work, all along the rod."""
    answer = found(name)
    ((part, text),) = answer.scenes.items()
    about = answer.stress if part == "stress" else answer.wrench
    assert about is not None
    assert about.witness is not None
    work = about.witness.work
    scene = load_scene(text)
    friction = [float(evaluate(row[i], {"u": 0.5})) for i, row in enumerate(scene.model.friction)]
    speeds = twist_at(scene, np.arange(200) / 200)
    taken = float(np.mean(np.array(friction) @ speeds**2))
    assert min(friction) > 0
    assert 0 < taken < 1e-9 * work


def test_terms_with_rates_are_left_out() -> None:
    """The witness is about slow cycles: viscosity has no part in its scene, the rest of the stress has."""
    answer = found("Kelvin-Voigt, odd")
    law = load_law(tomllib.loads(answer.scenes["stress"])["rod"]["law"])
    assert law.stress is not None
    assert not set(rates(SE2)) & {name for e in law.stress for name in symbols(e)}
    at = {"h1": 1.3, "h2": 0.2, "Pi": -0.4}
    assert [evaluate(e, at) for e in law.stress] == pytest.approx([3.0, 1.6, -0.6])


def test_a_scene_keeps_the_parameters_of_the_law() -> None:
    """Those with a value by name, so that they can be changed; the open ones with the witness's value."""
    given = planar({"F1": "10*(h1 - 1)", "F2": "10*h2 + a*Pi", "M": "k*Pi - a*h2"}, parameters={"k": 2.5, "a": OPEN})
    answer = check(load_law(given), brief=True)
    assert answer.stress is not None
    assert answer.stress.witness is not None
    law = tomllib.loads(answer.scenes["stress"])["rod"]["law"]
    assert law["parameters"] == {"k": 2.5, "a": float(answer.stress.witness.parameters["a"])}
    assert "a" in law["stress"]["F2"]


@pytest.mark.parametrize("name", WRENCHES)
def test_a_bead_begins_where_the_loop_does(name: str) -> None:
    """Position and frame of the scene's start are the loop's at t = 0; both ends are driven alike."""
    answer = found(name)
    assert answer.wrench is not None
    loop, scene = answer.wrench.witness, load_scene(answer.scenes["wrench"])
    assert loop is not None
    assert scene.model.left == scene.model.right
    pose = {key: float(evaluate(e, {"t": 0.0})) for key, e in loop.pose.items()}
    assert list(scene.start.position) == pytest.approx([pose[a] for a in "xyz"[: loop.group.space]])
    solution = geocosserat.run(scene, settings=["run.backend=numpy", "run.frames=2"]).solution
    frame = solution.rotation[0, 0]
    if loop.group is SE2:
        np.testing.assert_allclose(frame[:, 0], [np.cos(pose["theta"]), np.sin(pose["theta"])], atol=1e-12)
    else:
        expected = np.array([[pose[f"e{i}{a}"] for i in (1, 2, 3)] for a in "xyz"])
        np.testing.assert_allclose(frame, expected, atol=1e-12)
    np.testing.assert_allclose(solution.position[-1], solution.position[0], atol=1e-7)
    np.testing.assert_allclose(solution.rotation[-1], solution.rotation[0], atol=1e-7)
