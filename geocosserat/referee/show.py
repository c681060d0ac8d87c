"""A report for people: in a terminal, where verdicts have colours, or in a pipe, one statement a line."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table
from rich.text import Text

from geocosserat.referee.report import VERDICTS, Report
from geocosserat.referee.statement import Finding

STYLES = {"holds": "green", "definition": "cyan", "conditional": "yellow", "misprint": "magenta", "fails": "bold red"}
GAP, UNFOLDED = 2, 10_000


def print_report(report: Report, console: Console) -> None:
    """Every statement with its verdict, how many have which, and what is right in place of what is not."""
    width = console.width
    if not console.is_terminal:  # a pipe has no width: each statement is one line there, to search in
        console.width = UNFOLDED
    try:
        _print_tables(report, console)
    finally:
        console.width = width
    if report.errata:
        console.print()
        console.print(Text("What is not so as printed", style="bold"))
    for finding in report.errata:
        _print_erratum(finding, console)


def _print_tables(report: Report, console: Console) -> None:
    for title, findings in report.sections:
        console.print(Text(title, style="bold"))
        grid = Table.grid(padding=(0, GAP))
        grid.add_column(no_wrap=True)
        grid.add_column(min_width=max(map(len, VERDICTS)), no_wrap=True)
        grid.add_column(overflow="fold")
        for f in findings:
            grid.add_row(Text(f.statement.name), Text(f.verdict, style=STYLES[f.verdict]), Text(f.statement.says))
        console.print(grid)
        console.print()
    console.print(_summary(report))


def _summary(report: Report) -> Table:
    table = Table(box=None, padding=(0, GAP, 0, 0))
    table.add_column("section")
    for verdict in VERDICTS:
        table.add_column(verdict, style=STYLES[verdict], justify="right", no_wrap=True)
    for title, counts in report.summary.items():
        table.add_row(Text(title), *(str(counts[verdict] or "") for verdict in VERDICTS))
    table.add_row(Text("all", style="bold"), *(str(report.total[verdict]) for verdict in VERDICTS))
    return table


def _print_erratum(finding: Finding, console: Console) -> None:
    """LaTeX as it stands, unfolded: to be copied."""
    s = finding.statement
    console.print()
    head = Text.assemble((s.name, "bold"), "  ", (finding.verdict, STYLES[finding.verdict]), "  ", s.says)
    console.print(head, soft_wrap=True)
    rows = [("printed", s.printed)]
    if s.derived != s.printed:
        rows.append(("corrected" if finding.verdict == "misprint" else "derived", s.derived))
    if finding.condition:
        rows.append(("holds if", finding.condition))
    if s.remark:
        rows.append(("remark", s.remark))
    if s.affects:
        rows.append(("affects", ", ".join(s.affects)))
    if finding.verdict == "fails":
        rows.append(("decided", finding.how))
    for name, value in rows:
        console.print(Text.assemble((f"{name:<11}", "dim"), value), soft_wrap=True)
