"""Rods whose constraints determine no stress: refused with what is wrong; computed where it does not matter."""

from __future__ import annotations

import re
from typing import Any

import pytest

import geocosserat
from benchmarks.torture.case import planar, spatial
from benchmarks.torture.cases import constrained
from geocosserat.conductor import search
from geocosserat.conductor.simulate import Attempt

BY_NAME = {case.name: dict(case.scene) for case in constrained()}
HELD = {"left": {"kind": "clamped"}, "right": {"kind": "clamped"}}
STRAIGHT = {
    "straight, inextensible, held at both ends": BY_NAME["straight, inextensible, held at both ends"],
    "nearly straight": BY_NAME["nearly straight, inextensible, held at both ends"],
    "pinned": BY_NAME["inextensible, ends pinned, twice as stiff as nothing"],
    "driven against its constraint": BY_NAME["frozen, driven against its constraint"],
    "in space": spatial(
        rod__frozen=["h1", "h2", "h3"], ends=HELD, start__strain=None,
        effects=[{"kind": "weight", "force": [0, 1, -3]}],
    ),
}  # fmt: skip
WHY = (
    r"expected constraints that determine the stress of each frozen mode, found a rod .* so straight that F1 may have "
    r"any value; take h1 out of rod\.frozen and give it a stiffness, free an end, or begin with a rod that is bent"
)


@pytest.mark.parametrize("name", STRAIGHT)
def test_a_rod_whose_tension_nothing_determines_is_refused_with_that_reason(name: str) -> None:
    """Straight, or next to it, held at both ends, and pushed aside: no accuracy is too high, the scene is singular."""
    run = geocosserat.run(STRAIGHT[name])
    assert not run.reached
    assert re.search(WHY, run.reason)
    assert "below round-off" not in run.reason


def test_what_stays_as_it_is_needs_no_unique_tension() -> None:
    """A straight rod that is twisted, held at both ends, does not bend: it is computed, and nothing is told."""
    run = geocosserat.run(BY_NAME["Kirchhoff rod, both ends held, twisted"])
    assert run.reached
    assert run.reason == ""


BENT: dict[str, dict[str, Any]] = {
    "curved": dict(BY_NAME["curved, inextensible, held at both ends"]),
    "one end free": planar(rod__frozen=["h1", "h2"], start__strain=None),
    "ring": dict(BY_NAME["inextensible ring"]),
}


@pytest.mark.parametrize("name", BENT)
def test_a_rod_whose_stresses_are_determined_is_refused_for_other_reasons(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What it may be refused for, it is not for its constraints."""
    told: list[str] = []
    whole = search.undetermined

    def undetermined(attempt: Attempt) -> str:
        told.append(whole(attempt))
        return told[-1]

    monkeypatch.setattr(search, "undetermined", undetermined)
    run = geocosserat.run(BENT[name], settings=["run.accuracy=1e-15"])
    assert not run.reached
    assert run.reason
    assert told == [""]
