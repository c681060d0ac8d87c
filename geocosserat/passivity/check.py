"""All that is found of a law, in one record: for programs (JSON types) and for those who show it."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from geocosserat.model.expressions import ExpressionError, steps, to_text
from geocosserat.model.law import Law
from geocosserat.passivity.friction import FrictionAnswer, friction_answer, viscous_answer
from geocosserat.passivity.loop import Loop
from geocosserat.passivity.machine import configuration_machine, strain_machine
from geocosserat.passivity.stability import StabilityAnswer, stability
from geocosserat.passivity.stress import StressAnswer, check_stress
from geocosserat.passivity.symmetry import SymmetryAnswer, symmetry
from geocosserat.passivity.vanish import Grade
from geocosserat.passivity.verdict import (
    Part,
    Verdict,
    conditions_of,
    friction_part,
    stress_part,
    verdict_of,
    wrench_part,
)
from geocosserat.passivity.wrench import WrenchAnswer, wrench_answer

ASSUMED = (
    "stress and turn are work-conjugate: power per length is stress times the rate of the turn, in the moving frame",
    "passive means: no closed cycle of strain or configuration gives work, and friction never does",
)


@dataclass(frozen=True)
class Check:
    """What `check` returns. None: the law has no such part, or what could not be looked at (``failed`` says why).

    ``seconds``: what deciding took. ``brief``: whether stability and symmetry were left out.
    """

    law: Law
    stress: StressAnswer | None
    viscous: FrictionAnswer | None
    friction: FrictionAnswer | None
    wrench: WrenchAnswer | None
    stability: StabilityAnswer | None
    symmetry: SymmetryAnswer | None
    failed: Mapping[str, str]
    seconds: float
    brief: bool = False

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """Each part of the law that may give energy, with its verdict."""
        found = [stress_part(self.stress)] if self.stress else []
        found += [friction_part("viscous stress", self.viscous)] if self.viscous else []
        found += [friction_part("friction", self.friction)] if self.friction else []
        found += [wrench_part(self.wrench)] if self.wrench else []
        found += [
            Part(what, "undecided", None, f"the {what} was not decided: {why}")
            for what, why in self.failed.items() if what not in ("stability", "symmetry")
        ]  # fmt: skip
        return tuple(found)

    @property
    def verdict(self) -> Verdict:
        """Of the whole law."""
        return verdict_of(self.parts)[0]

    @property
    def grade(self) -> Grade | None:
        """How certain the verdict is."""
        return verdict_of(self.parts)[1]

    @property
    def conditions(self) -> tuple[str, ...]:
        """On open parameters."""
        return conditions_of(self.parts)

    @property
    def assumptions(self) -> tuple[str, ...]:
        """What was taken for granted, each once."""
        found = [*ASSUMED, *self._prestress()]
        if self.law.energy is not None and steps(self.law.energy):
            found.append("the stress is the gradient of the energy beside its steps: a jump of the energy is not in it")
        for answer in (self.viscous, self.friction, self.wrench, self.stability, self.symmetry):
            found += answer.assumptions if answer else ()
        return tuple(dict.fromkeys(found))

    def _prestress(self) -> tuple[str, ...]:
        text = ", ".join(f"{name} = {x:g}" for name, x in zip(self.law.group.strain, self.law.reference, strict=True))
        return (f"energies are counted from the reference {text}; the stress there may be other than zero",)

    @property
    def not_checked(self) -> tuple[str, ...]:
        """What the law does not say, and what could not be looked at."""
        law = self.law
        lacking = [
            ("stress", law.stress), ("friction", law.friction), ("wrench", law.wrench),
        ]  # fmt: skip
        found = [f"{name}: the law has none" for name, part in lacking if part is None]
        found += [f"{what}: {why}" for what, why in self.failed.items()]
        found += ["stability and symmetry were left out"] if self.brief else []
        return (*found, *(self.stability.not_checked if self.stability else ()))

    @property
    def scenes(self) -> dict[str, str]:
        """The witnesses as scenes that run (TOML), by the part of the law that they are about."""
        found = {}
        if self.stress and self.stress.witness:
            found["stress"] = strain_machine(self.law, self.stress.witness)
        if self.wrench and self.wrench.witness and not self.wrench.timed:
            found["wrench"] = configuration_machine(self.law, self.wrench.witness)
        return found

    @property
    def fields(self) -> dict[str, Any]:
        """The fields of ``check --json``."""
        return {
            "law": self.law.path or self.law.name,
            "name": self.law.name,
            "motion": "planar" if self.law.group.rotations == 1 else "spatial",
            "verdict": self.verdict,
            "grade": self.grade,
            "conditions": list(self.conditions),
            "reasons": [
                {"part": p.what, "verdict": p.verdict, "grade": p.grade, "why": p.why} for p in self.parts
            ],
            "stress": self._stress() if self.stress else None,
            "viscous": _friction(self.viscous) if self.viscous else None,
            "wrench": self._wrench() if self.wrench else None,
            "friction": _friction(self.friction) if self.friction else None,
            "stability": self.stability.fields() if self.stability else None,
            "symmetry": self.symmetry.fields() if self.symmetry else None,
            "assumptions": list(self.assumptions),
            "not_checked": list(self.not_checked),
            "seconds": self.seconds,
        }  # fmt: skip

    def _stress(self) -> dict[str, Any]:
        answer, names = self.stress, self.law.group.strain
        assert answer is not None
        return {
            "conservative": answer.conservative,
            "grade": answer.grade,
            "how": answer.how,
            "energy": None if answer.energy is None else str(answer.energy.density),
            "curl": [{"of": [names[i], names[j]], "is": str(e)} for (i, j), e in answer.curl],
            "split": None if answer.split is None else {
                "energy": str(answer.split.energy),
                "remainder": [str(e) for e in answer.split.remainder],
                "relative_to": answer.split.how,
            },
            "singular": [{"zero": str(s.expression), "shape": s.shape} for s in answer.singular],
            "steps": [str(e) for e in answer.steps.surfaces] if answer.steps else [],
            "timed": answer.timed,
            "witness": None if answer.witness is None else loop_fields(answer.witness, names),
        }  # fmt: skip

    def _wrench(self) -> dict[str, Any]:
        answer = self.wrench
        assert answer is not None
        witness = answer.witness
        return {
            "closed": answer.closed,
            "exact": answer.exact,
            "grade": answer.grade,
            "how": answer.how,
            "energy": answer.energy if answer.exact else None,
            "periods": [
                {"loop": p.words, "text": p.text, "work": p.value, "low": p.low, "high": p.high} for p in answer.periods
            ],
            "singular": [str(s) for s in answer.singular],
            "timed": answer.timed,
            "witness": None if witness is None else {
                "loop": witness.words,
                "coordinates": [to_text(e) for e in witness.coordinates],
                "twist": [to_text(e) for e in witness.twist],
                "work": witness.work,
                "low": witness.low,
                "high": witness.high,
                "parameters": dict(witness.values),
            },
        }  # fmt: skip


def loop_fields(loop: Loop, names: tuple[str, ...]) -> dict[str, Any]:
    """A loop of strain as JSON types; numbers that must be exact are texts of fractions."""
    return {
        "loop": {
            "kind": loop.kind,
            "centre": {name: str(c) for name, c in zip(names, loop.centre, strict=True)},
            "along": [names[loop.first], names[loop.second]],
            "radii": [str(r) for r in loop.radii],
        },
        "work": loop.work,
        "low": loop.low,
        "high": loop.high,
        "parameters": {name: str(x) for name, x in loop.parameters.items()},
    }


def _friction(answer: FrictionAnswer) -> dict[str, Any]:
    return {
        "dissipative": answer.dissipative,
        "grade": answer.grade,
        "how": answer.how,
        "margin": answer.margin,
        "scaled_margin": answer.scaled,
        "skew": list(answer.skew),
        "conditions": list(answer.conditions or ()),
        "gains": list(answer.direction) if answer.direction else None,
        "at": dict(answer.at) if answer.at else None,
    }


def check(law: Law, brief: bool = False) -> Check:
    """Is the law passive? Every part of it is looked at; ``brief`` leaves out what has no say in the verdict."""
    start = time.perf_counter()
    failed: dict[str, str] = {}

    def asked(what: str, question: Any, *more: Any) -> Any:
        try:
            return question(law, *more)
        except (MemoryError, RecursionError):
            raise
        except Exception as error:  # of a question that meets what nobody thought of: no answer, and no verdict
            foreseen = isinstance(error, ExpressionError | TypeError)
            failed[what] = str(error) if foreseen else f"{type(error).__name__}: {error}"
            return None

    stress = asked("stress", check_stress) if law.stress is not None else None
    conservative = stress.conservative if stress else None
    return Check(
        law=law,
        stress=stress,
        viscous=asked("viscous stress", viscous_answer),
        friction=asked("friction", friction_answer),
        wrench=asked("wrench", wrench_answer),
        stability=None if brief else asked("stability", stability, conservative),
        symmetry=None if brief else asked("symmetry", symmetry),
        failed=failed,
        seconds=time.perf_counter() - start,
        brief=brief,
    )
