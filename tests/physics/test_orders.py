"""Orders of accuracy with every effect and every kind of end, full and frozen: by degree, by elements, in time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from tests.physics.scenes import Array, Scene, changed, simulate, straight

pytestmark = pytest.mark.slow

PLANE = ([60.0, 40.0, 1.0], [1.0, 1.7, 0.05])
SPACE = ([60.0, 40.0, 30.0, 0.8, 1.2, 1.0], [1.5, 2.0, 1.8, 0.03, 0.05, 0.04])


def _all_effects(space: int) -> list[dict[str, Any]]:
    """One of each kind, varying along the rod and in time where they may."""

    def cut(*values: Any) -> list[Any]:
        return list(values[:space])

    rows = [[0.0, 2.0, 0.3], [-0.5, 0.2, 0.0], [0.4, 0.0, -0.2]]
    return [
        {"kind": "weight", "force": cut("1 + u", "-3*cos(5*t)", 1.0)},
        {"kind": "follower", "force": cut("sin(3*u)", "2*t", -0.5)},
        {"kind": "couple", "torque": "0.5*cos(2*u)" if space == 2 else ["0.3", "0.5*cos(2*u)", "-0.2"]},
        {"kind": "field", "moment": cut("1 + u", 0.3, 0.2), "field": cut("2*cos(8*t)", "2*sin(8*t)", 0.5)},
        {"kind": "flow", "gradient": [cut(*row) for row in rows[:space]], "velocity": cut("0.5*cos(4*t)", 0.3, -0.2)},
        {"kind": "trap", "stiffness": "4*(1 + u**2)", "centre": cut("0.5 + 0.1*sin(6*t)", 0.2, 0.1)},
    ]


def _plane(left: dict[str, Any], right: dict[str, Any], frozen: list[str], friction3: float = 0.05) -> Scene:
    scene = straight(PLANE[0], [*PLANE[1][:2], friction3])
    return changed(
        scene,
        {
            "rod.reference": ["1", "0", "2*u"],
            "rod.frozen": frozen,
            "ends": {"left": left, "right": right},
            "effects": _all_effects(2),
            "run.until": 0.2,
        },
    )


def _space(left: dict[str, Any], right: dict[str, Any], frozen: list[str]) -> Scene:
    return changed(
        straight(*SPACE),
        {
            "rod.reference": ["1", "0", "0", "1", "u", "2"],
            "rod.frozen": frozen,
            "start.rotation": [0.2, -0.3, 0.4],
            "ends": {"left": left, "right": right},
            "effects": _all_effects(3),
            "run.until": 0.2,
        },
    )


def _viscous(scene: Scene, stress: dict[str, str]) -> Scene:
    """The same with a law in place of the stiffness."""
    rod = {key: value for key, value in scene["rod"].items() if key != "stiffness"}
    return {**scene, "rod": {**rod, "law": {"motion": rod["motion"], "stress": stress}}}


def _ring() -> Scene:
    return changed(
        straight(*PLANE),
        {
            "rod.reference": ["1", "0", "2*pi*(1 + 0.5*cos(4*pi*u)*cos(10*t))"],
            "rod.frozen": ["h2"],
            "ends": {"joined": True},
            "effects": _all_effects(2),
            "run.until": 0.2,
        },
    )


TWIST = ["0.5*cos(6*t)", "sin(5*t)", "2*cos(7*t)"]
SCREW = ["0.5*cos(6*t)", "sin(5*t)", "0.3", "cos(4*t)", "-sin(3*t)", "2*cos(7*t)"]
SCENES = {
    "plane, driven and loaded": _plane(
        {"kind": "driven", "twist": TWIST},
        {"kind": "free", "force": ["sin(9*t)", 1.0], "torque": 0.3, "frame": "world"}, [],
    ),
    "plane, pinned and loaded, frozen": _plane(
        {"kind": "pinned", "torque": "0.5*sin(9*t)"}, {"kind": "free", "force": [0.2, "t"], "frame": "body"},
        ["h1", "h2"],
    ),
    "plane, free and clamped, no friction of the rotation": changed(
        _plane({"kind": "free", "force": [0.3, "t"]}, {"kind": "clamped"}, [], 0),
        # couples make it slow: the rotation has 1e-10 of the other friction, and its balance that much rounding
        {"effects": [effect for effect in _all_effects(2) if effect["kind"] not in ("couple", "field")]},
    ),
    "space, pinned and clamped": _space({"kind": "pinned", "torque": [0.1, "0.2*t", 0.0]}, {"kind": "clamped"}, []),
    "space, driven and loaded, frozen": _space(
        {"kind": "driven", "twist": SCREW},
        {"kind": "free", "force": [0.2, "t", -0.3], "torque": [0.0, 0.1, 0.2], "frame": "world"}, ["h1", "h2", "h3"],
    ),
    "space, free and loaded at both ends": _space(
        {"kind": "free", "force": ["t", 0.3, -0.2], "torque": [0.1, 0.0, "t"], "frame": "world"},
        {"kind": "free", "force": [0.2, "t", -0.3], "torque": [0.0, 0.1, 0.2], "frame": "body"}, [],
    ),
    "space, pinned at both ends": _space(
        {"kind": "pinned", "torque": [0.1, "0.2*t", 0.0]},
        {"kind": "pinned", "torque": ["t", 0.0, 0.2], "frame": "world"}, [],
    ),
    "plane, driven at both ends": _plane(
        {"kind": "driven", "twist": TWIST}, {"kind": "driven", "twist": ["0.3*sin(8*t)", "0.4", "cos(5*t)"]}, [],
    ),
    "ring": _ring(),
    "ring in space": changed(
        _space({}, {}, []),
        {"rod.reference": ["1", "0", "0", "0", "0", "2*pi"], "ends": {"joined": True},
         "start": {"rotation": [0.2, -0.3, 0.4], "strain": ["1", "0", "0", "0", "0", "2*pi*(1 + 0.4*cos(4*pi*u))"]}},
    ),
    "plane, viscous, free and loaded": _viscous(
        _plane({"kind": "free"}, {"kind": "free", "force": [0.2, "t"], "frame": "world"}, []),
        {
            "F1": "60*(h1 - 1) + 2*h1_dot + 0.3*Pi_dot", "F2": "40*h2",
            "M": "Pi - 2*u + 0.04*(1 + u)*Pi_dot - 0.2*h1_dot",
        },
    ),
    "space, viscous, driven and loaded, frozen": _viscous(
        _space(
            {"kind": "driven", "twist": SCREW},
            {"kind": "free", "force": [0.2, "t", -0.3], "torque": [0.0, 0.1, 0.2], "frame": "world"},
            ["h1", "h2", "h3"],
        ),
        {"M1": "0.8*(Pi1 - 1) + 0.03*Pi1_dot", "M2": "1.2*(Pi2 - u) + 0.05*(1 + Pi3**2)*Pi2_dot", "M3": "Pi3 - 2"},
    ),
}  # fmt: skip


@pytest.fixture(scope="module", params=SCENES)
def found(request: pytest.FixtureRequest) -> Callable[[int, int, float], Array]:
    """Places of both ends and of the middle at the end of a scene, by elements, degree and tolerance."""
    scene, kept = SCENES[request.param], {}

    def places(elements: int, degree: int, rtol: float = 1e-9) -> Array:
        if (elements, degree, rtol) not in kept:
            position = simulate(scene, elements, degree, rtol, backend="auto").solution.position[-1]
            kept[elements, degree, rtol] = position[[0, len(position) // 2, -1]]
        return np.asarray(kept[elements, degree, rtol])

    return places


def _error(places: Array, exact: Array) -> float:
    return float(np.linalg.norm(places - exact, axis=1).max())


def test_the_error_falls_by_orders_of_magnitude_with_the_degree(
    found: Callable[..., Array], request: pytest.FixtureRequest
) -> None:
    """Two elements of degree 4 and 8 against four of degree 8: by two orders of magnitude or more.

    Down to the error in time: 1e-8, and 2e-6 without friction of the rotation, whose balance rounds to no better.
    """
    exact = found(4, 8)
    friction = SCENES[request.node.callspec.params["found"]]["rod"]["friction"][-1]
    coarse, fine = _error(found(2, 4), exact), _error(found(2, 8), exact)
    assert coarse < 1e-2
    assert fine < 1e-2 * coarse + (2e-6 if friction == 0 else 1e-8)


def test_elements_of_degree_one_are_of_second_order(found: Callable[..., Array]) -> None:
    """32, 64 and 128 of them: four times nearer for twice as many, to the same places."""
    exact = found(4, 8)
    errors = [_error(found(n, 1), exact) for n in (32, 64, 128)]
    np.testing.assert_allclose(np.log2(errors[:-1]) - np.log2(errors[1:]), 2.0, atol=0.1)
    assert errors[-1] < 2e-3


def test_the_error_in_time_falls_with_the_tolerance(found: Callable[..., Array]) -> None:
    """On one mesh: each hundredth of the tolerance takes off nine tenths and more, or leaves no more than a few of the
    tightest; none is far above it."""
    exact = found(2, 4, 1e-11)
    errors = [_error(found(2, 4, rtol), exact) for rtol in (1e-4, 1e-6, 1e-8)]
    assert errors[1] < 0.1 * errors[0] + 1e-8
    assert errors[2] < 0.1 * errors[1] + 3e-8
    assert all(error < 100.0 * rtol for error, rtol in zip(errors, (1e-4, 1e-6, 1e-8), strict=True))
