"""The summary of a run: the agreed fields in JSON, and the same for people."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from geocosserat.results.summary import print_summary, summary, write_summary
from tests.results.motions import rolling, unrolling, unwinding

FIELDS = {
    "scene", "motion", "unknowns", "method", "elements", "degree", "until", "tip", "base", "energy", "ledger",
    "error", "evaluations", "seconds", "files",
}
MAKERS = [rolling, unrolling, unwinding]


def _leaves(value: Any) -> list[Any]:
    if isinstance(value, dict):
        return [leaf for inner in value.values() for leaf in _leaves(inner)]
    if isinstance(value, list):
        return [leaf for inner in value for leaf in _leaves(inner)]
    return [value]


@pytest.mark.parametrize("make", MAKERS)
def test_the_summary_is_valid_json_of_plain_types(make) -> None:
    """It goes through a strict encoder and comes back equal; no numpy type is left."""
    fields = summary(make(), files=[Path("a/solution.nc"), "a/picture.png"])
    assert json.loads(json.dumps(fields, allow_nan=False)) == fields
    assert {type(leaf) for leaf in _leaves(fields)} <= {str, int, float, bool, type(None)}
    assert fields["files"] == ["a/solution.nc", "a/picture.png"]


@pytest.mark.parametrize("make", MAKERS)
def test_the_summary_has_the_agreed_fields(make) -> None:
    """Names and inner names are a contract with those who read `run --json`."""
    fields = summary(make())
    assert set(fields) >= FIELDS
    assert set(fields["ledger"]) == {"stored", "dissipated", "work", "residual"}
    assert set(fields["energy"]) == {"start", "end"}
    assert set(fields["error"]) == {"requested", "estimated"}
    assert set(fields["evaluations"]) >= {"rate", "jacobian", "steps"}
    assert set(fields["seconds"]) >= {"derive", "compile", "plan", "solve"}
    planar = fields["motion"] == "planar"
    for end in ("tip", "base"):
        assert set(fields[end]) == {"position", "rotation"} | ({"angle"} if planar else set())


def test_a_rod_rolled_up_has_its_tip_at_its_base_after_one_turn() -> None:
    """The tip is the right end at the last time, its angle is unwrapped, the rotation is R by rows."""
    fields = summary(rolling())
    np.testing.assert_allclose(fields["tip"]["position"], [0.0, 0.0], atol=1e-15)
    assert fields["tip"]["angle"] == pytest.approx(2 * np.pi)
    assert fields["base"]["angle"] == 0.0
    assert fields["until"] == 2.0
    quarter = summary(rolling(until=(0.25 - 0.02) / 0.49))
    np.testing.assert_allclose(quarter["tip"]["rotation"], [[0.0, -1.0], [1.0, 0.0]], atol=1e-14)
    np.testing.assert_allclose(quarter["tip"]["position"], [2 / np.pi, 2 / np.pi], rtol=1e-14)


def test_the_ends_of_a_helix_are_right_handed_frames() -> None:
    """In space the rotation of an end is a proper rotation matrix."""
    fields = summary(unwinding())
    for end in ("tip", "base"):
        rotation = np.array(fields[end]["rotation"])
        np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-14)
        assert np.linalg.det(rotation) == pytest.approx(1.0)
    assert fields["base"]["position"] == [0.0, 0.0, 0.0]


def test_numbers_that_are_not_finite_become_null() -> None:
    """A run that broke down still has a summary that any JSON reader takes."""
    broken = np.full(41, np.nan)
    solution = rolling(energy=broken, work=broken + np.inf, estimated=np.inf, requested=None, reached=False,
                       reason="the state is not finite", position=np.full((41, 13, 2), np.nan))
    fields = summary(solution)
    text = json.dumps(fields, allow_nan=False)
    assert "NaN" not in text
    assert fields["energy"] == {"start": None, "end": None}
    assert fields["ledger"]["residual"] is None
    assert fields["error"] == {"requested": None, "estimated": None}
    assert fields["tip"]["position"] == [None, None]
    assert (fields["reached"], fields["reason"]) == (False, "the state is not finite")


def test_the_scene_is_named_by_its_path_when_that_is_known() -> None:
    """And by its title otherwise."""
    assert summary(rolling())["scene"] == "rolling up"
    assert summary(rolling(), scene="scenes/rolling.toml")["scene"] == "scenes/rolling.toml"


def test_the_written_summary_is_the_summary(tmp_path: Path) -> None:
    """The file holds one JSON object."""
    fields = summary(unwinding())
    path = write_summary(fields, tmp_path / "summary.json")
    assert json.loads(path.read_text()) == fields


def _printed(solution: Any, **options: Any) -> str:
    stream = io.StringIO()
    print_summary(solution, Console(file=stream, width=120), **options)
    return stream.getvalue()


@pytest.mark.parametrize("make", MAKERS)
def test_the_ledger_is_always_printed(make) -> None:
    """Along with the tip, the error and what it cost."""
    solution = make()
    text = _printed(solution, files=["out/solution.nc"])
    ledger = summary(solution)["ledger"]
    for name in ("stored", "dissipated", "work"):
        assert f"{name} {ledger[name]:.6g}" in text
    for part in (solution.title, "tip", "estimated 0.3", "requested 1e-06", "31 steps", "7 Jacobians",
                 "out/solution.nc"):
        assert part in text


def test_what_is_unknown_or_unfinished_is_said() -> None:
    """An error that nobody estimated, a run that stopped early, a title in brackets."""
    text = _printed(rolling(estimated=None, reached=False, reason="step too small", title="[red]a[/red] :smile:"))
    assert "estimated unknown" in text
    assert "not reached: step too small" in text
    assert "[red]a[/red] :smile:" in text
