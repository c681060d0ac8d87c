"""The table of verdicts: reasons that are one are told once, and nothing of a failure is left out."""

from __future__ import annotations

from benchmarks.torture.judge import CUT_OFF, FAILED, REFUSED, SURVIVED, Verdict
from benchmarks.torture.table import PEER, table

CAUSE = "expected constraints that determine the stress, found a straight rod; free an end"


def _told(*verdicts: Verdict) -> list[str]:
    """What follows the table and its legend."""
    lines = table(verdicts).split("\n")
    return lines[[k for k, line in enumerate(lines) if not line][1] + 1 :]


def test_a_cause_is_told_once_whatever_each_solver_said_before_it() -> None:
    """With its methods and cases together."""
    told = _told(
        Verdict("held", "auto", REFUSED, CAUSE),
        Verdict("driven", "auto", REFUSED, f"IDA stopped at t = 0; expected short steps, found none; {CAUSE}"),
        Verdict("driven", "safe", REFUSED, f"safe stopped at t = 0: no step is short enough; {CAUSE}"),
    )
    assert told == [f"* refused: {CAUSE}", "  * auto (1): held", "  * auto, safe (1): driven"]


def test_reasons_that_differ_in_numbers_alone_are_one() -> None:
    """Told without these, but with what is the same in both."""
    told = _told(Verdict("a", "radau", CUT_OFF, "60 s, 4 GiB"), Verdict("b", "radau", CUT_OFF, "180 s, 4 GiB"))
    assert told == ["* cut off: … s, 4 GiB", "  * radau (2): a; b"]


def test_failures_are_told_one_by_one_and_whole() -> None:
    """Whatever is common to them."""
    told = _told(Verdict("a", "auto", FAILED, f"2 wrong; {CAUSE}"), Verdict("b", "auto", FAILED, f"3 wrong; {CAUSE}"))
    assert told == [
        f"* failed: 2 wrong; {CAUSE}", "  * auto (1): a", f"* failed: 3 wrong; {CAUSE}", "  * auto (1): b",
    ]  # fmt: skip


def test_what_is_survived_needs_no_reason_and_a_peer_may_refuse() -> None:
    """Counts alone."""
    assert _told(Verdict("a", "auto", SURVIVED), Verdict("a", PEER, REFUSED, "it has no such rods")) == []
