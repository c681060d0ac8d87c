"""Hundreds of periods, and ten thousand: rods whose ends are held or driven do not forget where these are."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import BarycentricInterpolator
from scipy.spatial.transform import Rotation

from geocosserat.results.solution import Solution
from tests.physics.scenes import Array, Scene, changed, gap, simulate, straight

pytestmark = pytest.mark.slow

COEFFICIENTS = ([60.0, 50.0, 40.0, 0.9, 1.2, 1.0], [1.5, 2.0, 1.8, 0.03, 0.02, 0.025])
PERIODS = 200
MESHES = [(8, 1), (1, 6)]


def _stirred(left: str, right: str) -> Scene:
    """A curl held at both ends, under a force that goes round once in a unit of time."""
    force = [0.0, "20*cos(2*pi*t)", "20*sin(2*pi*t)"]
    return changed(
        straight(*COEFFICIENTS, left, right),
        {
            "rod.reference": ["1", "0", "0", "1", "0", "4*u"],
            "effects": [{"kind": "weight", "force": force}],
            "run.until": float(PERIODS),
        },
    )


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize("ends", [("clamped", "clamped"), ("clamped", "pinned"), ("pinned", "clamped")], ids="-".join)
@pytest.mark.parametrize(("elements", "degree"), MESHES)
def test_a_rod_held_at_both_ends_and_stirred_keeps_its_ends_where_they_are(
    elements: int, degree: int, ends: tuple[str, str]
) -> None:
    """200 rounds, at degree 1 too: both ends in their places and, if clamped, turned as they were, to the tolerance."""
    solution = simulate(_stirred(*ends), elements, degree, 1e-6, backend="c").solution
    for node, kind in ((0, ends[0]), (-1, ends[1])):
        assert gap(solution.position[-1, node], solution.position[0, node]) < 1e-6
        if kind == "clamped":
            assert gap(solution.rotation[-1, node], solution.rotation[0, node]) < 1e-6


def _shaken(**changes: Any) -> Scene:
    """A heavy rod whose base goes to and fro, aside and about an axis: at whole times it is where it was."""
    angle, speed = "0.4*sin(2*pi*t)", "0.4*pi*cos(2*pi*t)"
    twist = [f"{speed}*cos({angle})", f"-{speed}*sin({angle})", "0.2*pi*cos(2*pi*t)", "0", "0", "0.8*pi*cos(2*pi*t)"]
    return changed(
        straight(*COEFFICIENTS),
        {
            "ends.left": {"kind": "driven", "twist": twist},
            "effects": [{"kind": "weight", "force": [0.0, 1.0, -4.0]}],
            "run.until": float(PERIODS),
        }
        | changes,
    )


def _rocked() -> Scene:
    """The same in the plane, where it is the right end that is shaken."""
    return changed(
        straight([60.0, 50.0, 1.0], [1.5, 2.0, 0.03]),
        {
            "ends": {
                "left": {"kind": "free"},
                "right": {"kind": "driven", "twist": ["0.3*pi*cos(2*pi*t)", "0", "0.8*pi*cos(2*pi*t)"]},
            },
            "effects": [{"kind": "weight", "force": [1.0, -4.0]}],
            "run.until": float(PERIODS),
        },
    )


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize(("elements", "degree"), MESHES)
@pytest.mark.parametrize(("scene", "node"), [(_shaken(), 0), (_rocked(), -1)], ids=["spatial", "planar"])
def test_a_driven_base_is_where_its_twist_takes_it_whatever_the_tolerance(
    scene: Scene, node: int, elements: int, degree: int
) -> None:
    """Back at its place after 200 periods, to round-off, though the rod is computed to 1e-4 only."""
    solution = simulate(scene, elements, degree, 1e-4, backend="c").solution
    assert gap(solution.position[-1, node], solution.position[0, node]) < 1e-12
    assert gap(solution.rotation[-1, node], solution.rotation[0, node]) < 1e-12


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize(("elements", "degree"), MESHES)
@pytest.mark.parametrize("scene", [_shaken(), _rocked()], ids=["spatial", "planar"])
def test_ends_driven_at_both_sides_go_where_their_twists_take_them(scene: Scene, elements: int, degree: int) -> None:
    """One is shaken, the other swings in its own way: 200 periods, to the tolerance, places and turns; and the estimate
    of a run counts what the far one strays."""
    spatial = scene["rod"]["motion"] == "spatial"
    twist = [0, 0, "0.1*pi*cos(2*pi*t)", 0, "0.4*pi*cos(2*pi*t)", 0] if spatial else [0, "pi*sin(2*pi*t)/10", 0]
    far = "right" if spatial else "left"
    both = changed(scene, {f"ends.{far}": {"kind": "driven", "twist": twist}})
    solution = simulate(both, elements, degree, 1e-6, backend="c").solution
    assert gap(solution.position[-1, [0, -1]], solution.position[0, [0, -1]]) < 1e-6
    assert gap(solution.rotation[-1, [0, -1]], solution.rotation[0, [0, -1]]) < 1e-6


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize(("elements", "degree"), MESHES)
@pytest.mark.parametrize("seeing", [False, True], ids=["blind", "heavy"])
def test_the_strains_of_a_shaken_rod_repeat_however_long_it_is_shaken(elements: int, degree: int, seeing: bool) -> None:
    """After 200 periods as after 20, whether it sees the world or not: nothing strays.

    Strains at an end are off by up to a hundred tolerances of CVODE, by chance and however long the run was.
    """
    scene = _shaken() if seeing else _shaken(effects=[])
    early, late = (
        simulate(changed(scene, {"run.until": float(n)}), elements, degree, 1e-9, backend="c").solution.turn[-1]
        for n in (PERIODS // 10, PERIODS)
    )
    assert gap(late, early) < 1e-6


EARLY, MANY = 500, 10_000
"""By the first of them what was in the beginning is gone."""


def _trapped() -> Scene:
    """A free curl in a trap and a field, under a force that goes round: its place and frame are part of the state."""
    stirring = [2.0 * x for x in (1.0, 0.5)]
    return changed(
        straight(*COEFFICIENTS, "free", "free"),
        {
            "rod.reference": ["1", "0", "0", "1", "0", "4*u"],
            "effects": [
                {"kind": "weight", "force": [f"{stirring[0]}*cos(2*pi*t)", f"{stirring[1]}*sin(2*pi*t)", "1"]},
                {"kind": "trap", "stiffness": 5.0, "centre": [0.3, 0.1, 0.0]},
                {"kind": "field", "moment": [1.0, 0.5, 0.0], "field": [3.0, 1.0, "sin(2*pi*t)"]},
            ],
        },
    )


def _marched(solution: Solution, elements: int, degree: int) -> tuple[Array, Array]:
    """Places and frames of both ends of elements (elements + 1, .), of the last frame, from its strains and its base.

    In each element strains are polynomials through their points; R' = R Pi^ and r' = R h by an integrator that knows
    nothing else. A single point: the midpoint rule, whose R is the Cayley transform of the bend, an exact rotation.
    """
    turn, length = solution.turn[-1].reshape(elements, degree, 6), 1.0 / elements
    r, R = solution.position[-1, 0], solution.rotation[-1, 0]
    places, frames = [r], [R]
    for strain in turn:
        if degree == 1:
            bend = 0.5 * length * strain[0, 3:]
            size = np.linalg.norm(bend)
            before, R = R, R @ Rotation.from_rotvec(2.0 * np.arctan(size) * bend / size).as_matrix()
            r = r + 0.5 * length * (before + R) @ strain[0, :3]
        else:
            x = 0.5 * length * (1.0 + np.polynomial.legendre.leggauss(degree)[0])
            series = BarycentricInterpolator(x, strain)

            def rate(u: float, y: Array, series: BarycentricInterpolator = series) -> Array:
                strain, R = series(u), y[3:].reshape(3, 3)
                return np.concatenate([R @ strain[:3], np.cross(R, strain[3:]).ravel()])

            y = solve_ivp(rate, (0.0, length), np.append(r, R), method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
            r, R = y[:3], y[3:].reshape(3, 3)
        places.append(r)
        frames.append(R)
    return np.array(places), np.array(frames)


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize(("elements", "degree"), [(8, 1), (1, 10)])
@pytest.mark.parametrize(
    "scene", [_shaken(), _stirred("clamped", "clamped"), _trapped()], ids=["shaken", "held", "trapped"]
)
def test_after_ten_thousand_periods_poses_and_strains_are_what_they_were_after_hundreds(
    scene: Scene, elements: int, degree: int
) -> None:
    """Whether a base is driven, both ends are clamped, or a free pose is carried: nothing strays, and the poses are
    those that strains, integrated anew, lead to: to the tolerance, at degree 1 to round-off."""
    early, late = (
        simulate(changed(scene, {"run.until": float(n)}), elements, degree, 1e-6, "c", method="radau").solution
        for n in (EARLY, MANY)
    )
    assert gap(late.turn[-1], early.turn[-1]) < 1e-6
    assert gap(late.position[-1], early.position[-1]) < 1e-6
    assert gap(late.rotation[-1], early.rotation[-1]) < 1e-6
    for values, marched, before in zip(
        ("position", "rotation"), _marched(late, elements, degree), _marched(early, elements, degree), strict=True
    ):
        missed = marched - getattr(late, values)[-1, ::degree]
        assert gap(missed, before - getattr(early, values)[-1, ::degree]) < 1e-6
        assert gap(missed, 0.0) < (1e-12 if degree == 1 else 1e-6)
    for node, end in ((0, scene["ends"]["left"]), (-1, scene["ends"]["right"])):
        if end["kind"] != "free":  # at whole times it is where it was
            assert gap(late.position[-1, node], late.position[0, node]) < 1e-6
            assert gap(late.rotation[-1, node], late.rotation[0, node]) < 1e-6
