"""What accuracy costs in a scene: measured points, a front, files, and refusals."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

import geocosserat
from geocosserat.conductor import cost as module
from geocosserat.conductor.cost import Cost
from geocosserat.conductor.kernels import kernel_text
from geocosserat.conductor.simulate import Clock, Simulator
from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.kernel.compile import CompileError
from geocosserat.kernel.library import KernelText
from geocosserat.kernel.load import load
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod
from geocosserat.model.errors import InputError
from geocosserat.model.scene import load_scene
from geocosserat.model.toml_text import to_toml
from geocosserat.planning.settings import Setting
from tests.test_cli import call, refused


@pytest.fixture(scope="module", autouse=True)
def few() -> Iterator[None]:
    """Degrees 4 and 8 only."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "MESHES", ((1, 4), (1, 8)))
        patch.setattr(module, "MODEL_MESHES", ((1, 4),))
        yield


@pytest.fixture(scope="module")
def cantilever(few: None, c_compiler: str) -> Cost:
    """What accuracy costs for a rod with everything in it."""
    return geocosserat.cost(Path(__file__).parents[1] / "examples" / "cantilever.toml", seconds=3.0)


@pytest.mark.slow
def test_finer_settings_have_less_error_and_the_front_has_the_best(cantilever: Cost) -> None:
    """At degree 8 the tightest tolerance is some hundred times as exact as at degree 4."""
    found = cantilever
    best = {
        degree: min(p["error"] for p in found.points if p["degree"] == degree and p["model"] == "as given")
        for degree in (4, 8)
    }
    assert best[8] < 1e-2 * best[4] < 1e-4
    front = [found.points[i] for i in found.front]
    assert front[-1]["error"] == pytest.approx(best[8], rel=0.5)
    assert all(p["seconds"] <= p["median"] for p in found.points)
    assert found.reference["error"] < 1e-10


@pytest.mark.slow
def test_a_model_that_leaves_something_out_cannot_have_less_error_than_that(cantilever: Cost) -> None:
    """The inextensible rod is 1.1e-4 away from one with k = 1e4, as the ratio of stiffness lets expect."""
    found = cantilever
    errors = {model["model"]: model["error"] for model in found.models}
    assert errors["inextensible, unshearable"] == pytest.approx(1.1e-4, rel=0.1)
    for point in found.points:
        if point["model"] != "as given" and point["error"] is not None and point["degree"] == 4:
            assert point["error"] > 0.3 * errors[point["model"]]


@pytest.mark.slow
def test_a_scene_with_frozen_modes_is_compared_with_itself_only(examples: Path, c_compiler: str) -> None:
    """There is no fuller model in the file to compare with."""
    found = geocosserat.cost(examples / "inextensible.toml", methods=("radau",), seconds=5.0)
    assert found.models == []
    assert {p["method"] for p in found.points} == {"radau"}


@pytest.mark.slow
def test_time_that_is_up_is_said(examples: Path, c_compiler: str) -> None:
    """What was measured until then is there."""
    found = geocosserat.cost(examples / "cantilever.toml", seconds=1e-6)
    assert found.left_out > 10
    assert len(found.points) == 1


@pytest.mark.slow
def test_the_command_writes_a_picture_a_table_and_numbers(examples: Path, tmp_path: Path, c_compiler: str) -> None:
    """And does not write over them unasked."""
    arguments = ("cost", str(examples / "inextensible.toml"), "--methods", "radau", "--seconds", "1")
    result = call(*arguments, "--out", str(tmp_path), "--json")
    assert result.exit_code == 0
    fields = json.loads(result.stdout)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["cost.json", "cost.png", "cost.svg"]
    assert {"points", "front", "reference", "machine", "models", "files"} <= set(fields)
    assert "none of these files" in refused(call(*arguments, "--out", str(tmp_path)))
    shown = call(*arguments)
    assert shown.exit_code == 0
    assert "that no other one beats" in shown.stdout


def test_wrong_methods_and_scenes_are_refused(examples: Path, tmp_path: Path) -> None:
    """One message; no folder is left."""
    with pytest.raises(InputError, match=r"--methods: expected methods out of cvode, radau, bdf, lsoda, found 'euler'"):
        geocosserat.cost(examples / "cantilever.toml", methods=("euler",))
    assert "stiffness" in refused(call("cost", str(examples / "cantilever.toml"), "--out", str(tmp_path / "out"),
                                       "--set", "rod.stiffness=[-1,1,1]"))  # fmt: skip
    assert not (tmp_path / "out").exists()


SINGULAR = {
    "rod": {"motion": "planar", "length": 1.0, "stiffness": [1, 1, 1], "friction": [1, 1, 1]},
    "effects": [{"kind": "follower", "force": ["1/(0.0987654-t)**2", 0.0]}],
    "run": {"until": 0.2, "backend": "numpy"},
}


@pytest.fixture
def hurried(monkeypatch: pytest.MonkeyPatch) -> None:
    """No run of a reference takes longer than a moment."""
    monkeypatch.setattr(module, "MOST_SECONDS", 0.3)


def test_a_scene_that_no_run_follows_to_its_end_ends_with_three(tmp_path: Path, hurried: None) -> None:
    """The reason on standard error; what is known as JSON, and no picture, not even an earlier one."""
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(to_toml(SINGULAR), encoding="utf-8")
    out.mkdir()
    (out / "cost.png").write_bytes(b"of an earlier call")
    words = ("cost", str(scene), "--seconds", "0.3")
    result = call(*words, "--out", str(out), "--overwrite", "--json")
    assert result.exit_code == 3
    assert result.stderr.startswith("geocosserat: not reached: no run to compare with: ")
    fields = json.loads(result.stdout)
    assert (fields["reached"], fields["reference"], fields["points"]) == (False, None, [])
    assert [path.name for path in out.iterdir()] == ["cost.json"]
    shown = call(*words)
    assert (shown.exit_code, "0 ways measured" in shown.stdout) == (3, True)


def test_an_integration_that_takes_too_long_is_cut_off(examples: Path) -> None:
    """As one that failed, with what it has and the reason; the longest cannot outlast the time that is given."""
    scene = load_scene(examples / "cantilever.toml", ["run.backend=numpy"])
    attempt = Simulator(scene, "numpy", kernel_text, Clock(), seconds=0.0)(Setting(1, 4, 1e-3, "radau"), 5)
    assert (attempt.trajectory.reached, attempt.trajectory.reason) == (False, "cut off after 0 seconds")
    assert attempt.trajectory.states.shape == (1, len(attempt.rod.state))


def test_kernels_that_do_not_compile_are_measured_on_numpy(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], hurried: None
) -> None:
    """As in a run, and as it says; unless C was asked for."""

    def broken(text: KernelText, rod: SemiDiscrete, backend: str) -> NativeRod | NumpyRod:
        if backend == "c":
            raise CompileError("no kernel today")
        return load(text, rod, backend)

    monkeypatch.setattr(module, "choose_backend", lambda _: "c")
    monkeypatch.setattr("geocosserat.conductor.simulate.load", broken)
    found = geocosserat.cost(SINGULAR | {"run": {"until": 0.2}}, seconds=0.3)
    assert found.machine["kernels in"] == "numpy"
    assert capfd.readouterr().err == "no kernel today; running on numpy instead\n"
    with pytest.raises(CompileError):
        geocosserat.cost(SINGULAR | {"run": {"until": 0.2, "backend": "c"}}, seconds=0.3)
