"""Hundreds of periods: rods whose ends are held or driven do not forget where these are."""

from __future__ import annotations

from typing import Any

import pytest

from tests.physics.scenes import Scene, changed, gap, simulate, straight

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
def test_the_strains_of_a_shaken_rod_repeat_however_long_it_is_shaken(
    elements: int, degree: int, seeing: bool
) -> None:
    """After 200 periods as after 20, whether it sees the world or not: nothing strays."""
    scene = _shaken() if seeing else _shaken(effects=[])
    early, late = (
        simulate(changed(scene, {"run.until": float(n)}), elements, degree, 1e-8, backend="c").solution.turn[-1]
        for n in (PERIODS // 10, PERIODS)
    )
    assert gap(late, early) < 1e-6
