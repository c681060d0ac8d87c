"""Long steps pass over what turns by more than a radian in one, or should leave an unstable state: such runs do not
count, whatever they agree on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import geocosserat
from benchmarks.torture.case import planar, spatial
from benchmarks.torture.cases import unstable
from benchmarks.torture.judge import apart
from geocosserat.conductor import search
from geocosserat.conductor.scene import load_any
from geocosserat.kernel.compile import compiler
from geocosserat.solver.integrate import LAST_RESORTS

SPUN: dict[str, Any] = {
    "ends__left": {"kind": "driven", "twist": [0, 0, 0, "200*pi", 0, 0]},
    "run__until": 1.0,
    "start__strain": None,
    "rod__reference": [1, 0, 0, 0, 0.5, 0],
}
"""A bent rod whose base is spun by a hundred turns: its bend stays behind, and is passed over by steps of a turn."""


@pytest.mark.slow
@pytest.mark.skipif(compiler() is None, reason="Radau is compiled")
@pytest.mark.parametrize(("frozen", "method", "accuracy"), [
    (["h1", "h2", "h3"], None, 1e-3), ([], "radau", 1e-3), ([], "radau", 1e-4), ([], "radau", 1e-5),
])  # fmt: skip
def test_a_rod_that_is_spun_is_as_accurate_as_it_says(frozen: list[str], method: str | None, accuracy: float) -> None:
    """Two runs by Radau with steps as long as turns agree on an end that is wrong by up to 400 times the accuracy."""
    scene = spatial(**SPUN, rod__frozen=frozen)
    settings = [] if method is None else [f"run.method={method}"]
    found = geocosserat.run(scene, settings=[*settings, f"run.accuracy={accuracy}"])
    known = geocosserat.run(scene, settings=["run.accuracy=1e-7", "run.frames=2"])
    assert found.reached
    assert found.method == "radau"
    assert np.linalg.norm(np.subtract(found.tip["position"], known.tip["position"])) < accuracy


@pytest.mark.slow
@pytest.mark.skipif(compiler() is None, reason="Radau is compiled")
@pytest.mark.parametrize(("frozen", "method"), [(["h1", "h2", "h3"], None), ([], "radau")])
def test_a_ring_that_leaves_its_plane_is_not_left_in_it(frozen: list[str], method: str | None) -> None:
    """Overcurved by three: long steps damp what grows, and two such runs agree on a ring that stays as it was."""
    start = ["1", "0", "0", "1e-6*cos(4*pi*s)", "1e-6*sin(4*pi*s)", "2*pi"]
    scene = spatial(
        rod__frozen=frozen, rod__reference=[1, 0, 0, 0, 0, "6*pi"], start__strain=start, ends={"joined": True}
    )
    found = geocosserat.run(scene, settings=["run.accuracy=1e-4", *([f"run.method={method}"] if method else [])])
    known = geocosserat.run(scene, settings=["run.accuracy=1e-6", "run.method=cvode", "run.frames=2"])
    assert known.reached
    left = found.solution.energy[-1] - known.solution.energy[-1]
    assert not found.reached or abs(left) < 1e-2 * found.solution.energy[0]
    assert found.reached or found.reason


@pytest.mark.slow
@pytest.mark.parametrize("method", [*LAST_RESORTS, "lsoda"])
def test_a_ring_on_its_way_out_of_its_plane_is_where_it_says(method: str) -> None:
    """What grows from a millionth is not seen by a first run of few steps, and by the next one too early."""
    scene = next(case.scene for case in unstable() if "halfway out" in case.name)
    found = geocosserat.run(scene, settings=[f"run.method={method}"])
    known = geocosserat.run(scene, settings=["run.accuracy=1e-6", "run.method=cvode", "run.frames=2"])
    assert known.reached
    assert found.error["estimated"] + 1e-6 > apart(load_any(scene), found.solution, known.solution)
    assert found.reached or found.reason


def _runs(monkeypatch: pytest.MonkeyPatch, angle: float) -> int:
    """How many runs a plan takes for a rod at rest that seems to turn by so many radians in a step."""
    monkeypatch.setattr(search, "turned", lambda _: angle)
    scene = planar(run__backend="numpy", run__method="radau", run__frames=3, run__accuracy=1e-3)
    return len(geocosserat.run(scene).solution.plan)


def test_steps_that_turn_a_rod_far_are_refined(monkeypatch: pytest.MonkeyPatch) -> None:
    """Until their tolerance is a close one, and not where they are short."""
    assert _runs(monkeypatch, 2.0) > _runs(monkeypatch, 0.5)
