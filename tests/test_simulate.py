"""What a simulation says of its own errors."""

from __future__ import annotations

import numpy as np
import pytest

from geocosserat.conductor.simulate import drift
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.model.scene import load_scene
from geocosserat.solver.trajectory import Trajectory

CLAMPED, PINNED, FREE = {"kind": "clamped"}, {"kind": "pinned"}, {"kind": "free"}
ALONG = {"kind": "driven", "twist": ["0.3", 0, 0]}


def straight(left: dict[str, object], right: dict[str, object]) -> SemiDiscrete:
    """A straight rod of length 2 between these ends."""
    rod = {"motion": "planar", "length": 2.0, "stiffness": [3, 2, 1], "friction": [1, 2, 0.1]}
    scene = load_scene({"rod": rod, "ends": {"left": left, "right": right}, "run": {"until": 5.0}})
    return discretise(scene, 2, 3)


def stretched(rod: SemiDiscrete, by: float) -> Trajectory:
    """From the start to a state at t = 2 in which the rod has grown by so much."""
    last = rod.state.copy()
    last[: rod.mesh.elements * rod.mesh.degree] += by / rod.mesh.edges[-1]
    return Trajectory(np.array([0.0, 2.0]), np.stack([rod.state, last]), 0, 0, 0, True)


HELD = {"clamped": (CLAMPED, CLAMPED), "pinned": (PINNED, CLAMPED), "driven": (ALONG, ALONG)}


@pytest.mark.parametrize("ends", HELD.values(), ids=list(HELD))
def test_a_rod_that_grew_between_held_ends_has_strayed_by_that_much(ends: tuple[dict[str, object], ...]) -> None:
    """Whether these stay or go along together."""
    rod = straight(*ends)
    assert drift(rod, stretched(rod, 0.25)) == pytest.approx(0.25, rel=1e-12)
    assert drift(rod, stretched(rod, 0.0)) < 1e-14


def test_an_end_that_is_driven_away_should_have_gone_along() -> None:
    """From a clamped one at 0.3 in a unit of time: not what grows by 0.6 by then has strayed but what does not."""
    rod = straight({"kind": "driven", "twist": [0, 0, 0]}, ALONG)
    assert drift(rod, stretched(rod, 0.6)) < 1e-14
    assert drift(rod, stretched(rod, 0.0)) == pytest.approx(0.6, rel=1e-12)


@pytest.mark.parametrize("ends", [(CLAMPED, FREE), (FREE, ALONG), (FREE, FREE)], ids=["clamped", "driven", "free"])
def test_a_free_end_belongs_nowhere(ends: tuple[dict[str, object], ...]) -> None:
    """Wherever it went, it did not stray."""
    rod = straight(*ends)
    assert drift(rod, stretched(rod, 0.25)) == 0.0
