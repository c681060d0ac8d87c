"""What is not so as printed, as Markdown: for the authors, and for whoever reads the paper."""

from __future__ import annotations

import re

from geocosserat.referee.report import Report
from geocosserat.referee.statement import Finding

ORDER = ("misprint", "conditional", "fails")
HEADINGS = {"misprint": "Misprints", "conditional": "True under a condition", "fails": "Open"}


def errata(report: Report, title: str, authors: str, command: str) -> str:
    """The list, in the order of the paper within each verdict. command: what writes it again."""
    lines = [f"# Errata of {title}", "", authors, ""]
    counts = ", ".join(f"{report.total[v]} {v}" for v in ORDER if report.total[v])
    lines += [f"Of {len(report.findings)} statements: {counts or 'none'}. The other {report.total['holds']} hold and "
              f"{report.total['definition']} are definitions or assumptions. Written by `{command}`; the code that "
              "decides each is in `geocosserat paper --html FILE`.", ""]  # fmt: skip
    for verdict in ORDER:
        found = [(section, f) for section, findings in report.sections for f in findings if f.verdict == verdict]
        if found:
            lines += [f"## {HEADINGS[verdict]}", ""]
        for section, finding in found:
            lines += _entry(section, finding)
    return "\n".join(lines).rstrip("\n") + "\n"


def _entry(section: str, finding: Finding) -> list[str]:
    s = finding.statement
    items = [("Printed", _formula(s.printed))]
    if s.derived != s.printed:
        items.append(("Corrected" if finding.verdict == "misprint" else "In general", _formula(s.derived)))
    if finding.condition:
        items.append(("Holds if", _plain(finding.condition)))
    if s.remark:
        items.append(("Remark", _plain(s.remark)))
    if s.affects:
        items.append(("Affects", ", ".join(map(_plain, s.affects))))
    if finding.verdict == "fails":
        items.append(("Decided", _plain(finding.how)))
    head = f"### {_plain(s.name)} {_plain(s.says)}"
    return [head, "", f"{section}.", "", *(f"- {name}: {value}" for name, value in items), ""]


def _formula(latex: str) -> str:
    return f"${' '.join(latex.split())}$"


def _plain(text: str) -> str:
    """Words in which Markdown finds nothing to set; formulas between dollar signs stay."""
    parts = text.split("$")
    return "$".join(part if k % 2 else re.sub(r"([\\`*_<>\[\]])", r"\\\1", part) for k, part in enumerate(parts))
