"""The judge of the torture suite is not fooled: whatever a run may get wrong, it finds."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import geocosserat
from benchmarks.torture import __main__ as torture
from benchmarks.torture import judge as judging
from benchmarks.torture.case import Case, floating, planar, resting, sees_world
from benchmarks.torture.cases import cases
from benchmarks.torture.judge import CUT_OFF, FAILED, REFUSED, SURVIVED, Reference, Verdict, judge, reference
from benchmarks.torture.table import table
from geocosserat.conductor.run import Run
from geocosserat.model.errors import InputError
from geocosserat.results.solution import Solution

MESH: dict[str, Any] = {"run__elements": 2, "run__degree": 3, "run__rtol": 1e-7, "run__accuracy": None}
CASE = Case("quiet", "none", planar(run__backend="numpy", run__frames=6, **MESH))
FREE = Case(
    "free", "none",
    planar(run__backend="numpy", run__frames=6, ends={"left": {"kind": "free"}, "right": {"kind": "free"}}),
)  # fmt: skip


@pytest.fixture(scope="module")
def known() -> Reference:
    """The quiet case with tighter settings."""
    return reference(CASE)


def _changing(monkeypatch: pytest.MonkeyPatch, change: Callable[[Solution], Solution], **fields: Any) -> None:
    """Runs come out changed."""
    whole = geocosserat.run

    def run(*given: Any, **settings: Any) -> Run:
        found = whole(*given, **settings)
        return Run(change(found.solution), {**found.fields, **fields})

    monkeypatch.setattr(judging.geocosserat, "run", run)


def test_a_run_that_is_right_has_survived(known: Reference) -> None:
    """With its numbers."""
    found = judge(CASE, "auto", known)
    assert (found.outcome, found.why) == (SURVIVED, "")
    assert found.ledger is not None
    assert found.ledger < 1e-4
    assert found.rise == 0.0
    assert found.error is not None
    assert found.error < 1.0


def test_a_free_rod_that_is_right_has_survived() -> None:
    """Its drag adds up to nothing."""
    assert judge(FREE, "cvode", Reference(None)).outcome == SURVIVED


def _nan(found: Solution) -> Solution:
    turn = found.turn.copy()
    turn[-1, 0, 0] = np.nan
    return replace(found, turn=turn)


WRONG: dict[str, tuple[Callable[[Solution], Solution], str]] = {
    "NaN": (_nan, "not finite"),
    "an open ledger": (lambda s: replace(s, dissipated=1.01 * s.dissipated), "ledger"),
    "energy out of nothing": (
        lambda s: replace(s, energy=s.energy + np.where(np.arange(len(s.time)) == 3, s.energy[0], 0.0)), "grows"
    ),
    "another place": (lambda s: replace(s, position=s.position + 1e-4), "times the error"),
}  # fmt: skip


@pytest.mark.parametrize("what", WRONG)
def test_a_run_that_is_wrong_has_failed(what: str, known: Reference, monkeypatch: pytest.MonkeyPatch) -> None:
    """And the verdict says in what."""
    change, why = WRONG[what]
    _changing(monkeypatch, change)
    found = judge(CASE, "cvode", known)
    assert found.outcome == FAILED
    assert why in found.why


def test_drag_that_does_not_add_up_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """A rod that drifts with nothing to push it."""
    _changing(monkeypatch, lambda s: replace(s, twist=s.twist + np.array([0.1, 0.0, 0.0])))
    found = judge(FREE, "cvode", Reference(None))
    assert found.outcome == FAILED
    assert "drag" in found.why


def test_a_run_that_depends_on_the_place_is_found(known: Reference, monkeypatch: pytest.MonkeyPatch) -> None:
    """The scene moved as a whole must end moved as a whole."""
    whole = geocosserat.run

    def run(scene: Any, settings: Any = ()) -> Run:
        found = whole(scene, settings=settings)
        bent = found.solution.position * (1.001 if any("start.position" in s for s in settings) else 1.0)
        return Run(replace(found.solution, position=bent), found.fields)

    monkeypatch.setattr(judging.geocosserat, "run", run)
    assert "moved as a whole" in judge(CASE, "auto", known).why


def test_a_refusal_is_one_only_with_a_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run that stops and does not say why has failed; wrong input is refused."""
    _changing(monkeypatch, lambda s: s, reached=False, reason="it is too hard")
    assert judge(CASE, "cvode", Reference(None)).outcome == REFUSED
    _changing(monkeypatch, lambda s: s, reached=False, reason="")
    assert judge(CASE, "cvode", Reference(None)).outcome == FAILED

    def refuse(*_: Any, **__: Any) -> Run:
        raise InputError("a rod", "none", "write one", key="rod")

    monkeypatch.setattr(judging.geocosserat, "run", refuse)
    assert judge(CASE, "cvode", Reference(None)).outcome == REFUSED


def test_what_hangs_or_breaks_has_failed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The default must come to an end; others may be too slow. An exception is a failure of all."""
    monkeypatch.setattr(torture, "SECONDS", 0.3)
    monkeypatch.setattr(torture, "judge", lambda *_: time.sleep(60))
    outcomes = [v.outcome for v in torture.verdicts([CASE], ["auto", "safe", "bdf"])]
    assert outcomes == [FAILED, CUT_OFF, CUT_OFF]

    def broken(*_: Any) -> Verdict:
        raise ZeroDivisionError("a bug")

    monkeypatch.setattr(torture, "judge", broken)
    monkeypatch.setattr(torture, "SECONDS", 20.0)
    (found,) = torture.verdicts([CASE], ["bdf"])
    assert (found.outcome, found.why) == (FAILED, "ZeroDivisionError: a bug")


def test_the_table_counts_every_verdict() -> None:
    """Worst numbers are of what survived; what did not is listed with its reason."""
    some = [
        Verdict("a", "auto", SURVIVED, ledger=1e-6, rise=0.0, error=0.5),
        Verdict("b", "auto", SURVIVED, ledger=2e-6, rise=1e-9, fell_back=True),
        Verdict("c", "auto", REFUSED, "too hard"),
        Verdict("a", "bdf", FAILED, "NaN", ledger=1.0),
    ]
    lines = table(some).splitlines()
    assert "| auto | 3 | 2 | 1 | 0 | 0 | 1 | 2.0e-06 | 1.0e-09 | 5.0e-01 |" in lines
    assert "| bdf | 1 | 0 | 0 | 1 | 0 | 0 | - | - | - |" in lines
    assert lines[-4:] == ["* refused: too hard", "  * auto (1): c", "* failed: NaN", "  * bdf (1): a"]


def test_the_table_tells_a_reason_once() -> None:
    """Without numbers that differ; names of cases and methods stay apart."""
    some = [
        Verdict("a", "auto", CUT_OFF, "it took more than 180 seconds"),
        Verdict("a", "bdf", CUT_OFF, "it took more than 60 seconds"),
        Verdict("b", "bdf", CUT_OFF, "it took more than 6e+01 seconds"),
        Verdict("b", "auto", REFUSED, "h1 is less than h2"),
        Verdict("c", "auto", REFUSED, "h1 is less than h3"),
        Verdict("d", "auto", CUT_OFF, "it took more than 180 seconds"),
        Verdict("e", "bdf", CUT_OFF, "it took more than 60 seconds"),
    ]
    assert table(some).splitlines()[-8:] == [
        "* cut off: it took more than … seconds",
        "  * auto, bdf (1): a",
        "  * bdf (2): b; e",
        "  * auto (1): d",
        "* refused: h1 is less than h2",
        "  * auto (1): b",
        "* refused: h1 is less than h3",
        "  * auto (1): c",
    ]


def test_every_case_is_a_scene_that_the_program_reads() -> None:
    """None is refused for the way it is written, and there are as many as is claimed."""
    found = cases()
    assert len(found) >= 140
    for case in found:
        if case.family != "laws":  # reading those takes a while
            case.read()


def test_what_may_be_demanded_is_read_off_the_scene() -> None:
    """Rest, floating and the sight of the world."""
    by_name = {case.name: case for case in cases()}
    assert resting(CASE.read())
    assert not floating(CASE.read())
    assert floating(FREE.read())
    assert not sees_world(CASE.read())
    for name in ("step load", "weight and trap, planar"):
        assert not resting(by_name[name].read())
        assert sees_world(by_name[name].read())
    assert not resting(by_name["base spun by a hundred turns"].read())
    assert not resting(by_name["frozen reference that moves"].read())
