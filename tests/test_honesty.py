"""The table of what was asked for and what was got counts every run."""

from __future__ import annotations

import pytest

from benchmarks import honesty
from benchmarks.honesty import COMPUTED, LEFT_OUT, NOT_REACHED, REFUSED, Row, shown
from geocosserat.conductor.scene import load_any

ROD = {"motion": "planar", "length": 1.0, "stiffness": [100, 100, 1], "friction": [1, 2, 0.01]}


def test_runs_that_gave_no_error_are_counted_and_shown() -> None:
    """Each in its column; statistics are of those that claim the accuracy; what failed is listed with its reason."""
    rows = [
        Row("good", 1e-3, COMPUTED, "radau", 0.2, 3.0, 0.5),
        Row("bad", 1e-3, COMPUTED, "cvode", 2.5, 0.4, 0.7),
        Row("hard", 1e-3, NOT_REACHED, "its steps go nowhere"),
        Row("harder", 1e-3, NOT_REACHED, "below round-off", 7.0, 1.0, 0.1),
        Row("wrong", 1e-3, REFUSED, "expected a rod"),
        Row("rough", 1e-3, LEFT_OUT, "exact to 1e-2 only"),
    ]
    text = shown([1e-3], rows)
    assert "| 1e-03 | 2 | 2 | 1 | 1 | 1.350 | 2.50 | 50.0 % | 0.40 | 1.7 | 0.60 |" in text
    for line in (
        "* bad at 1e-03: 2.50 times it; cvode",
        "* hard at 1e-03: not reached: its steps go nowhere",
        "* harder at 1e-03: 7.00 times it; not reached: below round-off",
        "* wrong at 1e-03: refused: expected a rod",
    ):
        assert line in text.splitlines()
    assert "good" not in text


@pytest.mark.parametrize("accuracies", [(), (1e-3,)])
def test_a_table_of_nothing_is_a_table(accuracies: tuple[float, ...]) -> None:
    """No run, no statistics, no warning."""
    assert "| all | 0 | 0 | 0 | 0 | - | - | - | - | - | - |" in shown(accuracies, [])


def test_a_scene_that_is_refused_has_a_row_for_each_accuracy(monkeypatch: pytest.MonkeyPatch) -> None:
    """As one has whose fine rod does not get to its end."""
    huge = {"rod": ROD, "run": {"until": 1.0, "frames": 100_000, "backend": "numpy"}}
    monkeypatch.setattr(honesty, "FINE", (2000, 4, 1e-3))
    monkeypatch.setattr(honesty, "FINER", (2000, 4, 1e-3))
    monkeypatch.setattr(honesty, "scenes", lambda: [("huge", load_any(huge))])
    assert [row.came for row in honesty.measure([1e-2, 1e-3])] == [REFUSED, REFUSED]
    monkeypatch.setattr(honesty, "at", lambda *_: None)
    monkeypatch.setattr(honesty, "scenes", lambda: [("torn", load_any({"rod": ROD, "run": {"until": 1.0}}))])
    assert [row.came for row in honesty.measure([1e-2, 1e-3])] == [LEFT_OUT, LEFT_OUT]
