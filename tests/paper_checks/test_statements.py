"""Every statement of the paper has a record, a verdict that is computed, and a transcription that matters."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import paper_checks
from geocosserat.referee.statement import Finding, Statement, judge, verdict_on
from paper_checks import SECTIONS
from tests.paper_checks.mutants import mutants

IDS = json.loads((Path(paper_checks.__file__).parent / "ids.json").read_text())
STATEMENTS = [statement for section in SECTIONS for statement in section.statements]
MOST = 8
"""Alterations of one statement that are tried."""


@cache
def finding(statement: Statement) -> Finding:
    return judge(statement)


def entries(value: Any) -> list[Any]:
    return list(np.asarray(value, dtype=object).ravel())


def test_every_statement_and_part_of_the_paper_has_one_record() -> None:
    """As its own list of ids has them: no more, no fewer."""
    wanted = {(row["id"], part) for row in IDS for part in row.get("parts", [None])}
    found = [(s.id, s.part) for s in STATEMENTS]
    assert set(found) == wanted
    assert len(found) == len(wanted)


@pytest.mark.parametrize("statement", STATEMENTS, ids=lambda s: s.name)
def test_a_statement_is_understood(statement: Statement) -> None:
    """Whatever the verdict, it follows, and was not merely asserted; what is wrong or conditional says more."""
    found = finding(statement)
    assert found.verdict != "fails", found.how
    assert ("proved" in found.how) or ("probable" in found.how)
    assert (statement.printed != statement.derived) == (found.verdict == "misprint") or found.verdict == "conditional"
    assert statement.remark or found.verdict in ("holds", "definition")
    assert set(statement.affects) <= {row["id"] for row in IDS} | {s.name for s in STATEMENTS}


@pytest.mark.slow
@pytest.mark.parametrize("statement", STATEMENTS, ids=lambda s: s.name)
def test_an_altered_transcription_is_caught(statement: Statement) -> None:
    """A sign, an index, a factor, an order or a name: of the printed form, or of the corrected one if it is wrong."""
    keyword = "corrected" if finding(statement).verdict == "misprint" else "printed"
    tried, kept = 0, []
    for words, check in mutants(statement, keyword):
        try:
            altered = check()
            same = entries(getattr(altered, keyword)) == entries(getattr(statement.check(), keyword))
            verdict, how = verdict_on(altered)
        except (AttributeError, IndexError, NameError, TypeError, ValueError):
            continue  # makes no sense: anyone would notice
        if same:
            continue
        tried += 1
        if verdict != "fails":
            kept.append(f"{words}: {verdict}, {how}")
        if tried == MOST:
            break
    assert tried > 0
    assert not kept, kept
