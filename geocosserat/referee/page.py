"""A report as one page of HTML that needs nothing else: no network, no fonts or programs from elsewhere."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import jinja2
from markupsafe import Markup, escape

from geocosserat.referee.excerpt import runnable
from geocosserat.referee.mathml import typeset
from geocosserat.referee.report import VERDICTS, Report
from geocosserat.referee.statement import Finding
from geocosserat.shipped import shipped
from geocosserat.version import VERSION

MEANING = {
    "holds": "follows as printed",
    "definition": "a definition or an assumption, used as it stands",
    "conditional": "holds as printed under a condition, and not without",
    "misprint": "does not follow as printed; the form beside it does",
    "fails": "does not follow, and no form is known that does",
}


@dataclass(frozen=True)
class Entry:
    """A finding, ready to be shown."""

    finding: Finding
    anchor: str
    printed: Markup
    derived: Markup
    remark: Markup
    affects: Markup
    code: str
    words: str


def page(report: Report, title: str, authors: str = "", command: str = "geocosserat paper") -> str:
    """The page. command: what makes it again.

    Raises ValueError if a formula cannot be shown, or a check cannot be cut out of its module.
    """
    anchors = _anchors(report)
    sections = [
        (heading, f"section-{k}", [_entry(f, anchors) for f in findings])
        for k, (heading, findings) in enumerate(report.sections, 1)
    ]
    return _template().render(
        title=title,
        authors=authors,
        command=command,
        version=VERSION,
        verdicts=VERDICTS,
        meaning=MEANING,
        sections=sections,
        summary=report.summary,
        total=report.total,
    )


@lru_cache(maxsize=1)
def _template() -> jinja2.Template:
    found = jinja2.Environment(
        loader=jinja2.FileSystemLoader(shipped("templates")),
        undefined=jinja2.StrictUndefined,
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return found.get_template("pages/referee.html.j2")


def _anchors(report: Report) -> dict[str, str]:
    """Where a name is on the page: a part, a whole, or the first part of it."""
    found: dict[str, str] = {}
    for k, finding in enumerate(report.findings, 1):
        statement = finding.statement
        anchor = f"s{k}-" + re.sub(r"[^a-z0-9]+", "-", statement.name.lower()).strip("-")
        found[statement.name] = anchor
        found.setdefault(statement.id, anchor)
    return found


def _entry(finding: Finding, anchors: Mapping[str, str]) -> Entry:
    s = finding.statement
    try:
        printed, derived, remark = _formula(s.printed), _formula(s.derived), _prose(s.remark, anchors)
        code = runnable(s.check)
    except ValueError as error:
        error.add_note(f"in {s.name}")
        raise
    links = Markup(", ").join(_link(name, anchors) for name in s.affects)
    words = " ".join([s.id, s.name, s.says, s.printed, s.derived, s.remark, finding.condition, finding.how]).lower()
    return Entry(finding, anchors[s.name], printed, derived, remark, links, code, words)


def _formula(latex: str) -> Markup:
    pieces = (Markup(content) if kind == "math" else escape(content) for kind, content in typeset(latex))
    return Markup(" ").join(Markup('<span class="piece">{}</span>').format(piece) for piece in pieces)


def _prose(text: str, anchors: Mapping[str, str]) -> Markup:
    """Words with formulas between dollar signs; statements that are named are linked."""
    parts = text.split("$")
    if len(parts) % 2 == 0:
        raise ValueError(f"expected dollar signs in pairs, found {len(parts) - 1} in {text!r}; write what they enclose")
    return Markup("").join(_formula(part) if k % 2 else _linked(part, anchors) for k, part in enumerate(parts))


def _linked(text: str, anchors: Mapping[str, str]) -> Markup:
    parts = re.split(r"(\(\d+\w?\)|\b[A-Z]\d\d\b)", text)
    return Markup("").join(_link(part, anchors) if part in anchors else escape(part) for part in parts)


def _link(name: str, anchors: Mapping[str, str]) -> Markup:
    if name not in anchors:
        return escape(name)
    return Markup('<a href="#{}">{}</a>').format(anchors[name], name)
