"""The records print themselves so that a person can check what will be solved."""

from __future__ import annotations

import copy
import dataclasses
import pickle

import pytest

from geocosserat.model.scene import load_scene
from tests.model.scenes import PLANAR, SPATIAL, changed

PRINTED = """\
untitled
rod in SE(2), length 1
  stiffness  h1 = kappa, h2 = kappa, Pi = 1
  friction   v1 = 1, v2 = 2, Omega = 0.01
  reference  h1 = 1, h2 = 0, Pi = 0
  left end   clamped
  right end  free, force (0, -load), torque (0.5), fixed in the world
  effect     weight (0, -1) per length, fixed in the world
  parameters kappa = 10000, load = 2
  start      h1 = 1, h2 = 0, Pi = 0
             left end at (0, 0), rotation (0)
  run        until 1, 51 frames, accuracy 1e-06, backend auto"""


def test_a_scene_prints_everything_it_is() -> None:
    """All that the equations depend on, with the names of the components."""
    assert str(load_scene(PLANAR)) == PRINTED


def test_a_full_matrix_prints_by_rows() -> None:
    """Couplings are seen at their place."""
    rows = [[3, 0, 0], [0, 2, "u/9"], [0, "u/9", 1]]
    printed = str(load_scene(changed(PLANAR, "rod.stiffness", rows)).model)
    assert "stiffness  rows and columns h1, h2, Pi\n    h1       (3, 0, 0)\n    h2       (0, 2, u/9)\n" in printed


@pytest.mark.parametrize("scene", [PLANAR, SPATIAL])
def test_a_scene_is_a_value(scene: dict[str, object]) -> None:
    """Loaded twice, copied or sent to another process it is equal; it cannot be changed."""
    loaded = load_scene(scene)
    assert loaded == load_scene(scene) == copy.deepcopy(loaded) == pickle.loads(pickle.dumps(loaded))
    with pytest.raises(dataclasses.FrozenInstanceError):
        loaded.title = "other"  # type: ignore[misc]
    with pytest.raises(dataclasses.FrozenInstanceError):
        loaded.model.length = 2.0  # type: ignore[misc]
