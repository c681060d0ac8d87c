"""What accuracy costs in a scene: measured points, a front, files, and refusals."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

import geocosserat
from geocosserat.conductor import cost as module
from geocosserat.conductor.cost import Cost
from geocosserat.model.errors import InputError
from tests.test_cli import call, refused

pytestmark = pytest.mark.slow


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


def test_a_model_that_leaves_something_out_cannot_have_less_error_than_that(cantilever: Cost) -> None:
    """The inextensible rod is 1.1e-4 away from one with k = 1e4, as the ratio of stiffness lets expect."""
    found = cantilever
    errors = {model["model"]: model["error"] for model in found.models}
    assert errors["inextensible, unshearable"] == pytest.approx(1.1e-4, rel=0.1)
    for point in found.points:
        if point["model"] != "as given" and point["error"] is not None and point["degree"] == 4:
            assert point["error"] > 0.3 * errors[point["model"]]


def test_a_scene_with_frozen_modes_is_compared_with_itself_only(examples: Path, c_compiler: str) -> None:
    """There is no fuller model in the file to compare with."""
    found = geocosserat.cost(examples / "inextensible.toml", methods=("radau",), seconds=5.0)
    assert found.models == []
    assert {p["method"] for p in found.points} == {"radau"}


def test_time_that_is_up_is_said(examples: Path, c_compiler: str) -> None:
    """What was measured until then is there."""
    found = geocosserat.cost(examples / "cantilever.toml", seconds=1e-6)
    assert found.left_out > 10
    assert len(found.points) == 1


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
    assert "stiffness" in refused(call("cost", str(examples / "cantilever.toml"), "--set", "rod.stiffness=[-1,1,1]"))
    with pytest.raises(InputError, match="a scene that can be run to its end"):
        geocosserat.cost(
            {
                "rod": {"motion": "planar", "length": 1.0, "stiffness": [1, 1, 1], "friction": [1, 1, 1]},
                "effects": [{"kind": "follower", "force": ["1/(0.0987654-t)**2", 0.0]}],
                "run": {"until": 0.2},
            },
            tmp_path / "out",
        )
    assert not (tmp_path / "out").exists()
