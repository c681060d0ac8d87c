"""What is published of the paper's verdicts is what is computed, and all of it can be shown."""

from __future__ import annotations

import ast
from functools import cache
from html.parser import HTMLParser

import pytest

from geocosserat.referee.errata import errata
from geocosserat.referee.excerpt import runnable
from geocosserat.referee.mathml import typeset
from geocosserat.referee.page import page
from geocosserat.referee.report import Report, review
from geocosserat.referee.statement import Section, Statement
from paper_checks import SECTIONS
from paper_checks.__main__ import ERRATA
from paper_checks.title import AUTHORS, COMMAND, TITLE

STATEMENTS = [statement for section in SECTIONS for statement in section.statements]


@cache
def report() -> Report:
    return review(SECTIONS)


@pytest.mark.slow
def test_the_list_of_errata_is_what_is_computed() -> None:
    """docs/errata.md; `python -m paper_checks` writes it again."""
    assert ERRATA.read_text(encoding="utf-8") == errata(report(), TITLE, AUTHORS, COMMAND)


@pytest.mark.slow
def test_the_page_has_every_statement_and_links_that_lead_somewhere() -> None:
    """Those of remarks and of what suffers, too."""
    text = page(report(), TITLE, AUTHORS)
    ids, links = set[str](), set[str]()

    class Reader(HTMLParser):
        def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
            found = dict(attrs)
            ids.add(found.get("id") or "")
            links.add(found.get("href") or "")

    Reader().feed(text)
    assert text.count("<article") == len(STATEMENTS)
    assert {link.removeprefix("#") for link in links} <= ids
    assert "http" not in text


@pytest.mark.parametrize("statement", STATEMENTS, ids=lambda s: s.name)
def test_the_formulas_of_a_statement_can_be_set(statement: Statement) -> None:
    """And its code cut out: all it uses is there."""
    assert typeset(statement.printed)
    assert typeset(statement.derived)
    assert statement.remark.count("$") % 2 == 0
    tree = ast.parse(runnable(statement.check))
    compile(tree, statement.name, "exec")


@pytest.mark.parametrize("section", SECTIONS, ids=lambda s: s.title)
def test_the_code_of_a_section_runs_as_it_stands(section: Section, capsys: pytest.CaptureFixture[str]) -> None:
    """The one that needs most of its module: it prints its verdict."""
    codes = sorted((runnable(s.check) for s in section.statements), key=lambda code: code.count("\ndef "))
    exec(compile(codes[-1], "<copied>", "exec"), {"__name__": "copied"})
    printed, how = ast.literal_eval(capsys.readouterr().out)
    assert printed in ("holds", "definition", "conditional", "misprint")
    assert how
