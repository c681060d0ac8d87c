"""From what was found of each part of a law to one verdict: passive only if every part is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal, TypeAlias

from geocosserat.model.expressions import steps, symbols
from geocosserat.passivity.conditions import Conditions
from geocosserat.passivity.friction import FrictionAnswer
from geocosserat.passivity.stress import StressAnswer
from geocosserat.passivity.vanish import Grade
from geocosserat.passivity.wrench import WrenchAnswer

Verdict: TypeAlias = Literal["passive", "active", "driven", "undecided"]

GRADES: Final[tuple[Grade, ...]] = ("sampled", "probable", "proved")
"""The least certain first."""


@dataclass(frozen=True)
class Part:
    """One part of a law: what it is, its verdict and grade, why, and the condition under which it is passive."""

    what: str
    verdict: Verdict
    grade: Grade | None
    why: str
    condition: str | None = None


def stress_part(answer: StressAnswer) -> Part:
    """Active where the stress has no energy; driven where it has one that depends on time."""
    if answer.conservative is False:
        why = f"the stress has no energy: {answer.how}"
        return Part("stress", "active", answer.grade, why, _stress_condition(answer))
    if answer.conservative is None or answer.timed is None:
        return Part("stress", "undecided", None, f"the stress: {answer.how}")
    if answer.timed:
        why = "the stress depends on time: what changes it does work"
        return Part("stress", "driven", answer.grade, why)
    return Part("stress", "passive", answer.grade, f"the stress is the gradient of an energy: {answer.how}")


def _stress_condition(answer: StressAnswer) -> str | None:
    """On open parameters; none for what may be driven as well.

    Conditions under which the curl vanishes are necessary. Where there are steps or singular sets they need not be
    sufficient: those may do work all the same.
    """
    found = answer.conditions
    if found is None or not found.alternatives or answer.timed is not False:
        return None
    stepped = any(symbols(step) - {"u", "t"} for e in answer.stress for step in steps(e))
    if answer.curl and (stepped or answer.steps or answer.singular):
        return f"only if {found}" if found.exact else None
    return _in_words(found)


def _in_words(found: Conditions) -> str | None:
    return f"{'if and only if' if found.exact else 'if'} {found}" if found.alternatives else None


def friction_part(what: str, answer: FrictionAnswer) -> Part:
    """Active where a motion gains energy by friction."""
    if answer.dissipative:
        return Part(what, "passive", answer.grade, f"the {what} never gives energy: {answer.how}")
    if answer.dissipative is False:
        return Part(what, "active", answer.grade, f"the {what} gives energy: {answer.how}")
    if not answer.conditions:
        return Part(what, "undecided", None, f"the {what}: {answer.how}")
    # minors above zero leave out matrices that are singular and dissipative all the same
    needed = all(">=" in condition for condition in answer.conditions)
    condition = f"{'if and only if' if needed else 'if'} {' and '.join(answer.conditions)}"
    return Part(what, "undecided", None, f"the {what}: {answer.how}", condition)


def wrench_part(answer: WrenchAnswer) -> Part:
    """Driven where the wrench has no potential, or depends on time."""
    if answer.timed and answer.exact is not None:
        return Part("wrench", "driven", answer.grade, "the wrench depends on time: what changes it does work")
    if answer.exact:
        return Part("wrench", "passive", answer.grade, f"the wrench has a potential: {answer.how}")
    if answer.exact is False or answer.closed is False:
        return Part("wrench", "driven", answer.grade, f"the wrench has no potential: {answer.how}")
    found = answer.exact_if or answer.closed_if
    if found is not None:
        why = f"the wrench has no potential: {answer.how}"
        return Part("wrench", "driven", answer.grade or "proved", why, None if answer.timed else _in_words(found))
    return Part("wrench", "undecided", None, f"the wrench: {answer.how}")


def verdict_of(parts: Sequence[Part]) -> tuple[Verdict, Grade | None]:
    """Of a whole law: what is certainly wrong with one part is wrong with it; passive if all parts are.

    A law without parts that could give energy is passive. One that is so at the samples only is not called passive:
    what was not met there may still give energy.
    """
    for verdict in ("active", "driven"):
        grades = [part.grade for part in parts if part.verdict == verdict]
        if grades:
            return verdict, max((g for g in grades if g), key=GRADES.index, default=None)
    if any(part.verdict == "undecided" or part.grade == "sampled" for part in parts):
        return "undecided", None
    return "passive", min((part.grade for part in parts if part.grade), key=GRADES.index, default="proved")


def conditions_of(parts: Sequence[Part]) -> tuple[str, ...]:
    """When the law is passive, or each part of it, where that depends on open parameters."""
    waiting = [part for part in parts if part.verdict != "passive"]
    conditional = [part for part in waiting if part.condition]
    if len(waiting) == 1 and conditional:
        return (f"passive {waiting[0].condition}",)
    return tuple(f"the {part.what} is passive {part.condition}" for part in conditional)
