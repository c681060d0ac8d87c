"""Some cases of the torture suite, by the default and by the safe method: none may fail. `make torture` takes all."""

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
OF_EACH_FAMILY = (
    "spatial, stiffness 1:1e+10", "spatial, rotational friction 0", "reference with jumps", "white noise, spatial",
    "stretched ten times", "step load on and off", "a million relaxation times, frozen", "microns, spatial, loaded",
    "base turned by a hundred turns, planar", "one element of degree 1", "column buckles", "inextensible ring",
    "weight and follower, planar", "couple and couple, spatial", "hardening rod", "noise too fine to be seen",
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
@pytest.mark.parametrize("name", OF_EACH_FAMILY)
def test_no_case_is_failed(name: str) -> None:
    """Survived, or refused with a reason; never NaN, never a wrong answer, never a hang."""
    assert _failures([BY_NAME[name]], PATIENT) == []


def test_there_is_one_of_each_family() -> None:
    """No kind of hardness is left to `make torture` alone."""
    assert {BY_NAME[name].family for name in OF_EACH_FAMILY} == {case.family for case in BY_NAME.values()}
