"""All statements of a paper judged, section by section: for programs (JSON types) and for those who show them."""

from __future__ import annotations

import multiprocessing
import signal
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import islice
from typing import Any

from geocosserat.referee.statement import Finding, Section, Statement, Verdict, judge

VERDICTS: tuple[Verdict, ...] = ("holds", "definition", "conditional", "misprint", "fails")
MANY = 40
"""Statements: fewer are judged before another process has started."""


@dataclass(frozen=True)
class Report:
    """sections: title and findings, in the order of the paper. seconds: what judging took."""

    sections: tuple[tuple[str, tuple[Finding, ...]], ...]
    seconds: float

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Of all sections."""
        return tuple(finding for _, findings in self.sections for finding in findings)

    @property
    def rows(self) -> list[tuple[str, Verdict, str]]:
        """Part or id, verdict, and what the statement says in a line."""
        return [(f.statement.name, f.verdict, f.statement.says) for f in self.findings]

    @property
    def summary(self) -> dict[str, dict[str, int]]:
        """How many statements of each section have which verdict."""
        return {title: _counts(findings) for title, findings in self.sections}

    @property
    def total(self) -> dict[str, int]:
        """The same of the whole paper."""
        return _counts(self.findings)

    @property
    def errata(self) -> tuple[Finding, ...]:
        """What is not so as printed: misprints, what holds under a condition only, and what fails."""
        return tuple(f for f in self.findings if f.verdict not in ("holds", "definition"))

    @property
    def passed(self) -> bool:
        """Whether no statement fails: each holds, or it is known what holds in its place."""
        return self.total["fails"] == 0

    @property
    def fields(self) -> dict[str, Any]:
        """As JSON."""
        statements = [f.fields | {"section": title} for title, findings in self.sections for f in findings]
        summary = {"total": self.total, "sections": self.summary}
        return {"statements": statements, "summary": summary, "seconds": round(self.seconds, 3)}


def review(
    sections: Sequence[Section], progress: Callable[[int, int], None] | None = None, processes: int = 1
) -> Report:
    """Judges every statement of these sections, in their order.

    `progress` is called with how many statements were judged so far, and how many there are. `processes` work side by
    side if there are many statements: the checks must then be functions at the top of modules, and the program one
    that may be imported (``if __name__ == "__main__"``). What a check raises is raised, with a note of whose it was.
    """
    start = time.perf_counter()
    work = [(statement, section.title) for section in sections for statement in section.statements]
    findings = []
    for finding in _judged(work, processes):
        findings.append(finding)
        if progress is not None:
            progress(len(findings), len(work))
    rest = iter(findings)
    judged = tuple((section.title, tuple(islice(rest, len(section.statements)))) for section in sections)
    return Report(judged, time.perf_counter() - start)


def _judged(work: Sequence[tuple[Statement, str]], processes: int) -> Iterator[Finding]:
    """In order, as they come."""
    if processes == 1 or len(work) < MANY:
        yield from (_judge(*item) for item in work)
        return
    # children that start anew share no locks with this process, and leave Ctrl-C to it
    fresh = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(processes, fresh, signal.signal, (signal.SIGINT, signal.SIG_IGN))
    try:
        waiting = [pool.submit(_judge, *item) for item in work]
        for future in waiting:
            yield future.result()
    finally:
        pool.shutdown(cancel_futures=True)


def _judge(statement: Statement, title: str) -> Finding:
    try:
        return judge(statement)
    except Exception as error:
        error.add_note(f"while judging {statement.name} of the section {title!r}")
        raise


def _counts(findings: Iterable[Finding]) -> dict[str, int]:
    found = Counter(f.verdict for f in findings)
    return {verdict: found[verdict] for verdict in VERDICTS}
