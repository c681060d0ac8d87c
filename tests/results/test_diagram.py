"""A diagram of cost: which points no other one beats, and how it is shown."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ElementTree
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from geocosserat.results.diagram import AS_GIVEN, Diagram, ModelError, Point, Reference
from geocosserat.results.diagram_picture import picture
from geocosserat.results.diagram_table import notes, print_diagram


def point(error: float | None, seconds: float, **other: Any) -> Point:
    """A way that took so long."""
    values: dict[str, Any] = {
        "model": AS_GIVEN, "method": "radau", "elements": 1, "degree": 8, "rtol": 1e-3, "unknowns": 24,
        "median": 1.1 * seconds, "repeats": 5, "rates": 100, "jacobians": 9, "steps": 10, "reason": "",
    }  # fmt: skip
    if error is None:
        values["reason"] = "Radau stopped at t = 0.1 after 7 steps: no step small enough"
    return Point(error=error, seconds=seconds, **(values | other))


def diagram(*points: Point, models: tuple[ModelError, ...] = (), left_out: int = 0) -> Diagram:
    """With a reference that is exact to 1e-12."""
    reference = Reference("radau", 2, 16, 1e-8, 1e-12)
    return Diagram("rod.toml", "a rod", points, models, reference, left_out, {"a computer": "", "numpy": "2.4"})


SOME = diagram(
    point(1e-3, 0.001),
    point(1e-6, 0.01),
    point(1e-5, 0.02),
    point(None, 0.0001, method="cvode"),
    point(1e-2, 0.0005, model="unshearable"),
    point(3e-13, 0.1),
    point(1e-13, 0.2),
    models=(
        ModelError("unshearable", ("h2",), 1e-2, ""),
        ModelError("stiff", ("h1", "h2"), None, "not possible here: all is held"),
    ),
    left_out=7,
)


@given(st.lists(st.tuples(st.floats(1e-12, 1.0), st.floats(1e-6, 10.0)), min_size=1, max_size=30))
def test_every_point_is_beaten_by_one_of_the_front_or_in_it(pairs: list[tuple[float, float]]) -> None:
    """In both error and seconds; and no point of the front beats another one."""
    found = diagram(*(point(error, seconds) for error, seconds in pairs))
    front = [found.points[i] for i in found.front]
    for error, seconds in pairs:
        assert any(max(p.error or 0, found.floor) <= max(error, found.floor) and p.seconds <= seconds for p in front)
    assert all(np.diff([p.seconds for p in front]) >= 0)
    assert all(np.diff([max(p.error or 0, found.floor) for p in front]) < 0)


def test_failures_and_what_the_reference_cannot_tell_are_kept_but_win_nothing() -> None:
    """The fast failure is not in the front; of two errors below the floor the faster one is."""
    assert SOME.front == (4, 0, 1, 5)
    assert len(SOME.fields["points"]) == 7
    assert SOME.fields["reference"]["floor"] == pytest.approx(1e-10)
    json.dumps(SOME.fields, allow_nan=False)


def test_a_terminal_shows_the_front_and_says_the_rest() -> None:
    """Models, failures, what was left out, the reference and the machine, each in a line."""
    out = StringIO()
    print_diagram(SOME, Console(file=out, width=100), ["cost.png"])
    text = out.getvalue()
    for part in (
        "< 1.0e-10", "1 x 8", "unshearable: 1.0e-02 from the scene as given", "stiff: not possible here",
        "failed 1 times: cvode: no step small enough", "not tried for want of time: 7", "its own error at most 1.0e-12",
        "a computer, numpy 2.4", "wrote cost.png",
    ):  # fmt: skip
        assert part in text
    assert "failed" not in "".join(notes(diagram(point(1e-3, 1.0))))


@pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf"])
def test_a_picture_has_all_of_it(suffix: str, tmp_path: Path) -> None:
    """The same bytes each time; the points are there, the failed one too."""
    one, other = (picture(SOME, tmp_path / f"{name}{suffix}").read_bytes() for name in "ab")
    if suffix != ".pdf":  # which counts its objects
        assert one == other
    if suffix == ".svg":
        text = " ".join(ElementTree.fromstring(one).itertext())
        for part in ("milliseconds of the integration", "unknowns", "failed", "unshearable", "its own error at most"):
            assert part in text or part.encode() in one
