"""The cases of the torture suite, by the default and by the safe method: none may fail."""

from __future__ import annotations

import pytest

from benchmarks.torture.__main__ import PATIENT, verdicts
from benchmarks.torture.case import Case
from benchmarks.torture.cases import FAMILIES
from benchmarks.torture.judge import FAILED, SURVIVED

BY_NAME = {case.name: case for family in FAMILIES for case in family()}
QUICK = (
    "planar, stiffness 1:1e+10", "planar, rotational friction 1e-08", "stretch -0.5 at the start", "next to no time",
)  # fmt: skip
REFUSALS = ("noise too fine to be seen",)
"""Cases that nobody should claim to have computed."""


def _failures(cases: list[Case], methods: tuple[str, ...]) -> list[str]:
    return [
        f"{v.case}, {v.method}: {v.outcome}: {v.why}"
        for v in verdicts(cases, methods)
        if v.outcome == FAILED or (v.outcome == SURVIVED and v.case in REFUSALS)
    ]


@pytest.mark.parametrize("name", QUICK)
def test_some_hard_cases_are_survived_by_the_default(name: str) -> None:
    """Those whose kernels are shipped."""
    (found,) = verdicts([BY_NAME[name]], PATIENT[:1])
    assert (found.outcome, found.why) == (SURVIVED, "")


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.__name__)
def test_no_case_is_failed(family) -> None:
    """Survived, or refused with a reason; never NaN, never a wrong answer, never a hang."""
    assert _failures(list(family()), PATIENT) == []
