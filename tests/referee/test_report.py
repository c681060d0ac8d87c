"""All statements of a paper, judged in order: as numbers for programs, as a table for people, as code that runs."""

from __future__ import annotations

import contextlib
import io
import json
import re
from typing import get_args

import pytest
from rich.console import Console

from geocosserat.referee.errata import errata
from geocosserat.referee.excerpt import runnable
from geocosserat.referee.report import VERDICTS, Report, review
from geocosserat.referee.show import STYLES, print_report
from geocosserat.referee.statement import Finding, Section, Verdict
from tests.referee import paper


@pytest.fixture(scope="module")
def report() -> Report:
    return review([*paper.SECTIONS, paper.failing()])


def shown(report: Report, width: int = 80, terminal: bool = False) -> str:
    colours = "standard" if terminal else None
    console = Console(file=io.StringIO(), width=width, force_terminal=terminal, color_system=colours)
    print_report(report, console)
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue()


def test_statements_come_in_the_order_of_the_paper(report: Report) -> None:
    """By section; a row has the name of the part, or of the whole."""
    assert [row[:2] for row in report.rows] == [
        ("(1a)", "definition"), ("(1b)", "misprint"), ("I01", "holds"), (paper.LONG, "conditional"), ("(3)", "fails"),
    ]  # fmt: skip
    assert report.rows[2][2] == "a square of a sum"


def test_verdicts_are_counted_by_section_and_in_all(report: Report) -> None:
    """Each of the five, also where there are none."""
    assert set(get_args(Verdict)) == set(VERDICTS) == set(STYLES)
    none = dict.fromkeys(VERDICTS, 0)
    assert report.summary["Kinematics & signs"] == none | {"definition": 1, "misprint": 1}
    assert report.total == dict.fromkeys(VERDICTS, 1)


def test_a_paper_passes_unless_a_statement_fails(report: Report) -> None:
    """Misprints that are understood, and conditions that are known, are no failures."""
    assert not report.passed
    assert review(paper.SECTIONS).passed
    assert [f.statement.name for f in report.errata] == ["(1b)", paper.LONG, "(3)"]


def test_the_fields_are_json(report: Report) -> None:
    """As agreed, with the section beside."""
    fields = json.loads(json.dumps(report.fields, allow_nan=False))
    assert set(fields) == {"statements", "summary", "seconds"}
    assert fields["summary"]["total"] == report.total
    assert list(fields["summary"]["sections"]) == ["Kinematics & signs", "Squares", "Wrong"]
    for statement in fields["statements"]:
        assert set(statement) >= {"id", "verdict", "printed", "derived", "remark", "how", "section"}
    assert fields["statements"][0]["part"] == "(1a)"
    assert "part" not in fields["statements"][2]
    assert fields["seconds"] >= 0


def test_progress_is_told_after_each_statement() -> None:
    """How many are done, of how many."""
    seen: list[tuple[int, int]] = []
    review(paper.SECTIONS, lambda done, total: seen.append((done, total)))
    assert seen == [(1, 4), (2, 4), (3, 4), (4, 4)]


def test_a_check_that_breaks_says_whose_it_is() -> None:
    """The error itself, with a note."""
    section = Section("broken")
    section.states("(4)", "no sense", "0=0")(paper.broken)
    with pytest.raises(ValueError, match="expected two sides of one shape") as raised:
        review([section])
    assert raised.value.__notes__ == ["while judging (4) of the section 'broken'"]


@pytest.mark.slow
def test_processes_side_by_side_reach_the_same_verdicts(monkeypatch: pytest.MonkeyPatch) -> None:
    """In the same order; an error comes through with its note."""
    monkeypatch.setattr("geocosserat.referee.report.MANY", 1)
    seen: list[tuple[int, int]] = []
    alone = review(paper.SECTIONS)
    together = review([*paper.SECTIONS, Section("empty")], lambda done, total: seen.append((done, total)), processes=2)
    assert together.findings == alone.findings
    assert together.sections == (*alone.sections, ("empty", ()))
    assert seen == [(1, 4), (2, 4), (3, 4), (4, 4)]
    section = Section("broken")
    section.states("(4)", "no sense", "0=0")(paper.broken)
    with pytest.raises(ValueError, match="expected two sides of one shape") as raised:
        review([section], processes=2)
    assert "while judging (4) of the section 'broken'" in raised.value.__notes__


def test_in_a_pipe_each_statement_is_one_line(report: Report) -> None:
    """Whatever its length: to be searched."""
    lines = shown(report, width=20).splitlines()
    assert any(line.split() == ["(1a)", "definition", "the", "slope"] for line in lines)
    assert any(line.startswith(f"{paper.LONG}  conditional  a square, shortened <for small y>") for line in lines)
    assert "\x1b" not in "".join(lines)


def test_on_a_terminal_verdicts_have_colours_and_names_stay_whole(report: Report) -> None:
    """However narrow it is."""
    text = shown(report, width=len(paper.LONG) + 20, terminal=True).split("What is not so")[0]
    assert paper.LONG in text
    assert "\x1b[1;31mfails" in text
    assert "\x1b[35mmisprint" in text


def test_what_is_not_so_is_listed_with_what_is(report: Report) -> None:
    """LaTeX unfolded, conditions, remarks, and why what fails fails."""
    listed = shown(report, width=30).split("What is not so as printed")[1]
    wrong, right = "\\dot\\Pi-\\Omega'=\\Omega\\times\\Pi", "\\dot\\Pi-\\Omega'=\\Pi\\times\\Omega"
    assert f"printed    {wrong}\ncorrected  {right}\n" in listed
    assert "holds if   y vanishes & nothing else" in listed
    assert "affects    (1)" in listed
    assert "decided    the printed form does not follow" in listed
    assert "I01" not in listed


def test_nothing_to_correct_is_not_listed() -> None:
    """A section of what holds."""
    section = Section("right")
    section.statements.append(paper.SECOND.statements[0])
    assert "What is not so" not in shown(review([section]))


def test_the_list_of_errata_has_printed_and_right_forms(report: Report) -> None:
    """As Markdown, in which names and remarks stay as they are."""
    text = errata(report, "A paper", "A. Author", "make errata")
    assert "$\\dot\\Pi-\\Omega'=\\Omega\\times\\Pi$\n- Corrected: $\\dot\\Pi-\\Omega'=\\Pi\\times\\Omega$\n" in text
    assert "Of 5 statements: 1 misprint, 1 conditional, 1 fails." in text
    assert "### U1 \\[f \\< g\\] as a long name in a table a square, shortened \\<for small y\\>" in text
    assert "see (1a) & $\\boldsymbol{e}_i'" in text
    assert text.index("## Misprints") < text.index("## True under a condition") < text.index("## Open")
    assert "a square of a sum" not in text


@pytest.mark.parametrize("finding", review(paper.SECTIONS).findings, ids=lambda f: f.statement.name)
def test_the_code_of_a_statement_runs_as_it_stands(finding: Finding) -> None:
    """With all it uses of its module and nothing else, and prints the verdict."""
    text = runnable(finding.statement.check)
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(compile(text, "<copied>", "exec"), {"__name__": "copied"})
    assert out.getvalue().strip() == repr((finding.verdict, finding.how))


def test_the_code_of_a_statement_holds_what_it_uses_and_no_more() -> None:
    """Helpers of helpers, constants, decorators that matter; not the heading, not other imports."""
    text = runnable(paper.spin)
    assert "@cache\ndef _rod()" in text
    assert "ZERO = 0" in text
    assert "from geocosserat.referee.motion import Motion, cross\n" in text
    assert "from geocosserat.referee.statement import Check, verdict_on\n" in text
    assert "sympy" not in text
    assert ".states" not in text
    assert text.endswith("\n\n\nprint(verdict_on(spin()))\n")
    assert "Motion" not in runnable(paper.square)


def test_a_check_that_is_no_function_of_a_module_is_refused() -> None:
    """It could not be cut out."""
    (statement,) = paper.failing().statements
    message = "expected a function at the top of its module, found failing.<locals>.wrong of tests.referee.paper"
    with pytest.raises(ValueError, match=re.escape(message)):
        runnable(statement.check)
