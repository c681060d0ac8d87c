"""A statement of a paper as a record, and the verdict on it, which is computed."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import sympy as sp

from geocosserat.referee.decide import Decision, decide
from geocosserat.referee.jets import Jets

Verdict = Literal["holds", "misprint", "conditional", "definition", "fails"]


@dataclass(frozen=True, eq=False)
class Check:
    """What decides a statement: expressions, or arrays of them, for one and the same quantity.

    printed: as the paper has it. derived: as it follows. corrected: if the printed form is wrong, one in its place.
    condition: in words, and the values it gives to symbols: with it the printed form holds, without it it does not.
    defines: the printed form is a definition, or an assumption: what is decided is that all else uses it as it stands.
    also: in words, two expressions that must agree: what follows, or supports the verdict.
    fields: whose constraints hold.
    """

    printed: Any
    derived: Any
    corrected: Any = None
    condition: tuple[str, Mapping[Any, Any]] | None = None
    defines: bool = False
    also: Sequence[tuple[str, Any, Any]] = ()
    fields: Jets | None = None


@dataclass(frozen=True)
class Statement:
    """One statement or part of one: its id in the paper, what it says in a line, printed and derived form (LaTeX), what
    to know about it, and which others suffer if it is wrong. check: builds what decides it."""

    id: str
    part: str | None
    says: str
    printed: str
    derived: str
    check: Callable[[], Check]
    remark: str = ""
    affects: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Of the part, or of the whole."""
        return self.part or self.id

    @property
    def code(self) -> str:
        """The lines that decide it."""
        source = textwrap.dedent(inspect.getsource(self.check))
        return source[source.index("def ") :]


@dataclass(frozen=True)
class Finding:
    """A statement and what became of it. how: how that was decided, in words."""

    statement: Statement
    verdict: Verdict
    how: str
    condition: str = ""

    @property
    def fields(self) -> dict[str, Any]:
        """As JSON."""
        s = self.statement
        part = {"part": s.part} if s.part else {}
        found = {"verdict": self.verdict, "says": s.says, "printed": s.printed, "derived": s.derived}
        more = {"condition": self.condition} if self.condition else {}
        return {"id": s.id, **part, **found, **more, "remark": s.remark, "affects": list(s.affects), "how": self.how}


class Section:
    """The statements of one section, in their order; `states` adds one."""

    def __init__(self, title: str) -> None:
        self.title = title
        self.statements: list[Statement] = []

    def states(
        self, id: str, says: str, printed: str, derived: str = "", remark: str = "", affects: Sequence[str] = (),
        part: str | None = None,
    ) -> Callable[[Callable[[], Check]], Callable[[], Check]]:
        """Records the function that follows as what decides this statement."""

        def record(check: Callable[[], Check]) -> Callable[[], Check]:
            self.statements.append(
                Statement(id, part, says, printed, derived or printed, check, remark, tuple(affects))
            )
            return check

        return record


def judge(statement: Statement) -> Finding:
    """The verdict on a statement: what cannot be made sense of fails, and says why."""
    check = statement.check()
    verdict, how = verdict_on(check)
    return Finding(statement, verdict, how, check.condition[0] if check.condition else "")


def verdict_on(check: Check) -> tuple[Verdict, str]:
    """The verdict, and how it was reached."""
    for words, left, right in check.also:
        also = compare(left, right, check.fields)
        if not also.vanishes:
            return "fails", f"expected {words}: {also.how}"
    plain = compare(check.printed, check.derived, check.fields)
    notes = "".join(f"; {words}" for words, _, _ in check.also)
    if plain.vanishes:
        if check.corrected is not None or check.condition is not None:
            return "fails", f"the printed form needs no correction and no condition, it holds: {plain.how}"
        return "definition" if check.defines else "holds", plain.how + notes
    if check.condition is not None:
        words, values = check.condition
        with_it = compare(check.printed, check.derived, check.fields, values)
        if with_it.vanishes:
            mended = _mended(check)
            if mended is not None and not mended.vanishes:
                return "fails", f"the corrected form does not follow: {mended.how}"
            return "conditional", f"with the condition {with_it.how}; without it {plain.how}{notes}"
        return "fails", f"not even if {words}: {with_it.how}"
    mended = _mended(check)
    if mended is None:
        return "fails", f"the printed form does not follow, and no other is given: {plain.how}"
    if not mended.vanishes:
        return "fails", f"the corrected form does not follow either: {mended.how}"
    return "misprint", f"printed {plain.how}; corrected {mended.how}{notes}"


def _mended(check: Check) -> Decision | None:
    return None if check.corrected is None else compare(check.corrected, check.derived, check.fields)


def compare(left: Any, right: Any, fields: Jets | None = None, values: Mapping[Any, Any] | None = None) -> Decision:
    """Whether two expressions, or arrays of them of one shape, are equal for all fields; those in `values` have these.

    Raises ValueError if their shapes differ.
    """
    a, b = (np.asarray(x, dtype=object) for x in (left, right))
    if a.shape != b.shape:
        raise ValueError(f"expected two sides of one shape, found {a.shape} and {b.shape}; bring them to one")
    entries = [sp.sympify(x - y, strict=True) for x, y in zip(a.ravel().tolist(), b.ravel().tolist(), strict=True)]
    if values:
        given = {x: sp.sympify(value, strict=True) for x, value in values.items()}
        entries = [e.xreplace(given) for e in entries]
    if fields is None:
        return decide(entries)
    return decide(entries, fields.parameters, fields.rules)
