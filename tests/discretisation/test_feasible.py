"""Motions that nothing resists are refused before anything is computed; all others are not."""

from __future__ import annotations

from typing import Any

import pytest

from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.model.errors import InputError
from geocosserat.model.scene import load_scene

FREE, PINNED, CLAMPED = {"kind": "free"}, {"kind": "pinned"}, {"kind": "clamped"}
STRAIGHT, CURLED = [1, 0, 0, 0, 0, 0], [1, 0, 0, 0, 0, 2]


def build(left: Any, right: Any, reference: list[float], friction: list[float], **rod: Any) -> None:
    """Discretises a spatial rod with these ends."""
    material = {"stiffness": [900, 400, 400, 0.7, 1, 1], "friction": friction, "reference": reference}
    values = {"rod": {"motion": "spatial", "length": 1.0, **material, **rod}, "run": {"until": 1.0}}
    discretise(load_scene(values | {"ends": {"left": left, "right": right}}), 1, 6)


@pytest.mark.parametrize("ends", [(FREE, FREE), (PINNED, FREE), (FREE, PINNED), (PINNED, PINNED)])
def test_a_straight_rod_that_may_spin_about_itself_without_friction_is_refused(ends: tuple[Any, Any]) -> None:
    """Any torque would spin it infinitely fast."""
    wording = r"rod.friction: expected a friction that resists every motion of the whole rod, found a way to turn that "
    with pytest.raises(InputError, match=wording + r"meets none \(no friction against Omega1\); give the rotation"):
        build(*ends, STRAIGHT, [1, 2, 2, 0, 0.01, 0.01])


@pytest.mark.parametrize(
    ("ends", "reference", "friction"),
    [
        ((FREE, FREE), STRAIGHT, [1, 2, 2, 0.01, 0, 0]),  # turned any other way it is dragged sideways
        ((FREE, FREE), CURLED, [1, 2, 2, 0, 0, 0]),
        ((PINNED, PINNED), CURLED, [1, 2, 2, 0, 0, 0]),
        ((CLAMPED, FREE), STRAIGHT, [1, 2, 2, 0, 0, 0]),
        ((PINNED, CLAMPED), STRAIGHT, [1, 2, 2, 0, 0, 0]),
    ],
)
def test_a_rod_whose_every_motion_is_resisted_is_not(
    ends: tuple[Any, Any], reference: list[float], friction: list[float]
) -> None:
    """By the friction of its translations, or by a clamp."""
    build(*ends, reference, friction)


def test_a_twist_without_friction_is_refused_as_the_only_mode() -> None:
    """Frozen but for twist the rod has nothing that takes time; with a bend it has."""
    frozen = ["h1", "h2", "h3", "Pi2", "Pi3"]
    with pytest.raises(InputError, match="a friction that resists the one mode that is left, found none against"):
        build(CLAMPED, FREE, STRAIGHT, [1, 2, 2, 0, 0.01, 0.01], frozen=frozen)
    build(CLAMPED, FREE, STRAIGHT, [1, 2, 2, 0.01, 0, 0], frozen=frozen)
    build(CLAMPED, FREE, STRAIGHT, [1, 2, 2, 0, 0.01, 0.01], frozen=frozen[:-1])
