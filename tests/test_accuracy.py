"""An error that is asked for is an error that is found, or the run says that it was not."""

import re
from pathlib import Path

import numpy as np
import pytest

import geocosserat
from geocosserat.model.expressions import parse, switch_times
from geocosserat.model.scene import load_scene
from geocosserat.planning.resolution import Resolution
from geocosserat.planning.settings import SIZES
from tests.marks import slow

ROD = {"motion": "planar", "length": 1.0, "stiffness": [1e4, 1e4, 1.0], "friction": [1.0, 1.0, 0.01]}


def test_a_feature_between_the_points_is_noticed() -> None:
    """A coarse mesh that has no point on a narrow bump would agree with another one that has none."""
    narrow = {**ROD, "reference": ["1", "0", "60*exp(-((u-0.5)/0.01)**2)"]}
    scene = load_scene({"rod": narrow, "start": {"strain": ["1", "0", "0"]}, "run": {"until": 0.02}})
    seen = [Resolution(scene).sees_all(*size, 1e-6) for size in SIZES]
    assert not any(seen[:2])
    assert seen[-1]
    run = geocosserat.run({"rod": narrow, "start": {"strain": ["1", "0", "0"]}, "run": {"until": 0.02, "frames": 2}})
    fine = ["run.elements=64", "run.degree=8", "run.rtol=1e-9"]
    exact = geocosserat.run(
        {"rod": narrow, "start": {"strain": ["1", "0", "0"]}, "run": {"until": 0.02, "frames": 2}}, settings=fine
    )
    np.testing.assert_allclose(run.tip["position"], exact.tip["position"], rtol=0, atol=2e-6)


def test_a_feature_too_fine_for_all_is_not_reported_as_solved() -> None:
    """Code 3 and the reason, not a small error."""
    soft = {**ROD, "stiffness": [1e4, 1e4, "1-0.999*exp(-((u-0.5)/0.0005)**2)"]}
    ends = {"right": {"kind": "free", "force": [0.0, 0.5], "frame": "body"}}
    run = geocosserat.run({"rod": soft, "ends": ends, "run": {"until": 0.2, "frames": 2}})
    assert not run.reached
    assert "too narrow for the finest mesh; see run.elements" in run.reason


@pytest.mark.parametrize("accuracy", [slow(1e-2), 1e-4])
def test_a_narrow_feature_counts_by_what_it_does_at_loose_accuracies_too(accuracy: float) -> None:
    """A hinge of a thousandth of the length bends by half a radian; small as it is, all turns about it."""
    hinge = {**ROD, "stiffness": [1e4, 1e4, "1-0.9995*exp(-((u-0.3)/0.001)**2)"]}
    ends = {"right": {"kind": "free", "force": [0.0, 0.3], "frame": "body"}}
    scene = {"rod": hinge, "ends": ends, "run": {"until": 0.5, "frames": 2}}
    run = geocosserat.run(scene, accuracy=accuracy)
    fine = geocosserat.run(scene, settings=["run.elements=200", "run.degree=8", "run.rtol=1e-6"])
    away = np.linalg.norm(np.subtract(run.tip["position"], fine.tip["position"]))
    assert away < accuracy or not run.reached


@pytest.mark.parametrize("width", [slow(1e-4), 1e-9])
def test_what_no_mesh_sees_is_not_reported_as_solved(width: float) -> None:
    """Two meshes without a point on it would agree to all digits."""
    bump = {"kind": "follower", "force": [0.0, f"exp(-((u-0.4321)/{width})**2)/{width}"]}
    run = geocosserat.run({"rod": ROD, "effects": [bump], "run": {"until": 0.1, "frames": 2, "accuracy": 1e-3}})
    assert not run.reached
    assert "too narrow for the finest mesh" in run.reason


STRESS = {"F1": "1e3*(h1-1)", "F2": "1e3*h2", "M": "Pi"}
LAW = {"motion": "planar", "stress": STRESS, "friction": {"matrix": [1, 2, 0.01]}}


def test_what_a_law_varies_is_noticed_as_what_a_stiffness_does() -> None:
    """A narrow soft place, and a narrow viscous one."""
    for moment in ("(1-0.99*exp(-((u-0.5123)/0.005)**2))*Pi", "Pi+5*exp(-((u-0.5123)/0.005)**2)*Pi_dot"):
        law = {**LAW, "name": "narrow", "stress": {**STRESS, "M": moment}}
        scene = load_scene({"rod": {"motion": "planar", "length": 1.0, "law": law}, "run": {"until": 0.1}})
        assert not any(Resolution(scene).sees_all(*size, 1e-6) for size in SIZES[:3])


@pytest.mark.slow
def test_a_pulse_of_a_law_is_not_stepped_over() -> None:
    """A wrench that pushes for a moment moves the rod as a weight does that pushes as long."""
    pulse = "50*(heaviside(t-0.1)-heaviside(t-0.1005))"
    law = {**LAW, "name": "pulse", "wrench": {"f1": f"{pulse}*sin(theta)", "f2": f"{pulse}*cos(theta)"}}
    run = {"until": 0.101, "frames": 2}
    pushed = geocosserat.run({"rod": {"motion": "planar", "length": 1.0, "law": law}, "run": run})
    weight = {"kind": "weight", "force": [0, pulse]}
    rod = {"motion": "planar", "length": 1.0, "stiffness": [1e3, 1e3, 1], "friction": [1, 2, 0.01]}
    heavy = geocosserat.run({"rod": rod, "effects": [weight], "run": run})
    assert heavy.tip["position"][1] > 5e-3
    np.testing.assert_allclose(pushed.tip["position"], heavy.tip["position"], rtol=0, atol=2e-6)


@pytest.mark.slow
def test_an_accuracy_that_a_limit_of_friction_cannot_have_is_said_at_once(examples: Path) -> None:
    """What is left of friction is an error of the model: nothing is computed more finely than that."""
    run = geocosserat.run(examples / "euler_bernoulli.toml", accuracy=1e-12, settings=["run.frames=2"])
    assert not run.reached
    assert "rotations without friction are a limit" in run.reason
    assert len(run.plan) <= 5
    assert min(step["rtol"] for step in run.plan) > 1e-9
    assert geocosserat.run(examples / "euler_bernoulli.toml", accuracy=1.2e-10, settings=["run.frames=2"]).reached


@pytest.mark.slow
def test_an_accuracy_below_round_off_is_answered_with_the_floor(examples: Path) -> None:
    """How far it went, and that no tolerance goes further."""
    run = geocosserat.run(examples / "cantilever.toml", accuracy=3e-15, settings=["run.frames=2"])
    assert not run.reached
    found = re.search(r"below round-off: at the least tolerance, about (\S+) is left", run.reason)
    assert found is not None
    assert 1e-14 < float(found[1]) < 1e-9
    assert float(found[1]) == pytest.approx(run.error["estimated"], rel=0.5)


def test_uniform_rods_are_seen_by_the_coarsest_mesh() -> None:
    """Nothing varies, nothing can be missed."""
    assert Resolution(load_scene({"rod": ROD, "run": {"until": 1.0}})).sees_all(1, 1, 1e-12)


@pytest.mark.parametrize("method", ["cvode", "radau", "bdf", "lsoda"])
def test_a_pulse_on_a_rod_at_rest_is_not_stepped_over(method: str) -> None:
    """At rest, steps grow without bound; the pulse is short, and what it did is still there just after it."""
    ends = {"right": {"kind": "free", "force": [0.0, "20*(heaviside(t-1.0)-heaviside(t-1.0-1e-3))"], "frame": "world"}}
    late = geocosserat.run({"rod": ROD, "ends": ends, "run": {"until": 1.002, "method": method, "frames": 2}})
    ends = {"right": {"kind": "free", "force": [0.0, "20*(1-heaviside(t-1e-3))"], "frame": "world"}}
    early = geocosserat.run({"rod": ROD, "ends": ends, "run": {"until": 0.002, "method": method, "frames": 2}})
    assert early.tip["position"][1] > 0.02
    np.testing.assert_allclose(late.tip["position"], early.tip["position"], rtol=0, atol=2e-6)
    assert late.ledger["residual"] < 1e-5


@pytest.mark.parametrize("method", ["cvode", "radau", "bdf", "lsoda"])
def test_a_smooth_pulse_is_not_stepped_over(method: str) -> None:
    """However narrow: what it did is what a short push does that is cut out of it."""
    pulse = "2e4*exp(-((t-0.37)/1e-6)**2)"
    scenes = [
        {"rod": ROD, "ends": {"right": {"kind": "free", "force": [0.0, force], "frame": "world"}},
         "run": {"until": until, "method": method, "frames": 2}}
        for force, until in ((pulse, 0.371), ("2e4*exp(-((t-1e-5)/1e-6)**2)*heaviside(2e-5-t)", 0.00101))
    ]  # fmt: skip
    late, early = (geocosserat.run(scene) for scene in scenes)
    assert early.tip["position"][1] > 0.02
    np.testing.assert_allclose(late.tip["position"], early.tip["position"], rtol=0, atol=2e-6)
    assert late.reached


def test_instants_of_output_on_switches_are_kept() -> None:
    """Frames before, on and after a switch all arrive, once each and in order."""
    ends = {"right": {"kind": "free", "force": [0.0, "heaviside(t-0.5)"], "frame": "body"}}
    run = geocosserat.run({"rod": ROD, "ends": ends, "run": {"until": 1.0, "frames": 5}})
    np.testing.assert_array_equal(run.solution.time, [0.0, 0.25, 0.5, 0.75, 1.0])
    tip = run.solution.position[:, -1, 1]
    np.testing.assert_allclose(tip[:3], 0.0, atol=1e-9)
    assert 0 < tip[3] < tip[4]


@pytest.mark.parametrize(
    ("text", "times"),
    [
        ("heaviside(t-1)-heaviside(t-1.0001)", [1.0, 1.0001]),
        ("heaviside(sin(pi*t))", [1.0]),
        ("k*heaviside(0.3*k - t)*heaviside(t+1)", [0.6]),
        ("t**2", []),
    ],
)
def test_switches_are_found_where_they_are(text: str, times: list[float]) -> None:
    """Affine arguments and periodic ones, inside the open interval only."""
    found = switch_times(parse(text, frozenset({"t", "k"})), 2.0, {"k": 2.0})
    np.testing.assert_allclose(found, times, rtol=0, atol=1e-9)


@pytest.mark.slow
def test_two_held_ends_count_what_the_far_one_strayed() -> None:
    """Coarsely, the right end leaves its clamp by the error of the scheme; the estimate of a fine run covers it."""
    rod = {
        "motion": "spatial",
        "length": 1.0,
        "stiffness": [900.0, 700.0, 600.0, 0.8, 1.5, 1.2],
        "friction": [1.0, 2.0, 1.9, 0.01, 0.02, 0.03],
    }
    scene = {
        "rod": rod,
        "start": {"strain": ["1", "0", "0", "4", "5*sin(3*u)", "3"]},
        "ends": {"left": {"kind": "clamped"}, "right": {"kind": "clamped"}},
        "run": {"until": 0.05, "frames": 2, "accuracy": 1e-7},
    }
    run = geocosserat.run(scene)
    ends = run.solution.position[:, -1]
    assert run.reached
    assert np.linalg.norm(ends[1] - ends[0]) <= run.error["estimated"] <= 1e-7


@pytest.mark.slow
def test_a_rod_rolled_up_more_often_than_a_mesh_can_tell_is_computed_on_a_finer_one() -> None:
    """A hundred turns on one element: two coarse meshes agree on a motion that is none, to within the accuracy."""
    scene = {
        "rod": {"motion": "planar", "length": 1.0, "stiffness": [1e4, 1e4, 1.0], "friction": [1.0, 2.0, 0.01]},
        "start": {"strain": ["1", "0", "200*pi"]},
        "run": {"until": 0.05, "frames": 2, "accuracy": 1e-4},
    }
    run, fine = (geocosserat.run(scene, accuracy=accuracy) for accuracy in (1e-4, 1e-6))
    assert run.reached
    assert np.linalg.norm(np.subtract(run.tip["position"], fine.tip["position"])) < 1e-4
