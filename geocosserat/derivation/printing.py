"""Print a Document: as plain text for a terminal, or as a LaTeX fragment (needs amsmath)."""

from __future__ import annotations

import textwrap
import unicodedata
from collections.abc import Iterable

from geocosserat.derivation.document import Document, Formula, Section
from geocosserat.derivation.notation import field_names
from geocosserat.derivation.records import Equation
from geocosserat.derivation.writing import MINUS, PRIME, Latex, Script, Text

_TERMS_A_ROW = 6
_WIDEST_LEFT = 12
_NARROWEST = 40


def to_text(document: Document, unicode: bool = True, width: int = 100) -> str:
    """The document as text; without ``unicode`` in ASCII (h1_t in time, v1_u along the rod).

    Long equations are broken between terms at ``width`` characters.
    """
    script = Text(_taken(document), unicode)
    lines = [document.title, ""]
    for names in document.names:
        vector = ", ".join(script.write(f) for f in names.fields)
        lines.append(f"  {names.meaning:<8}{_spelt(names.letter, unicode)} = ({vector})")
    if document.parameters:
        values = [f"{script.write(name)} = {script.write(value)}" for name, value in document.parameters]
        lines.append(f"  {'with':<8}{', '.join(values)}")
    for section in document.sections:
        formula = f":  {_spelt(section.formula, unicode)}" if section.formula else ""
        lines += ["", f"{section.heading}{formula}", *_text_body(section, script, width)]
    return "\n".join(lines) + "\n"


def to_latex(document: Document) -> str:
    """The document as LaTeX, to be included in a text that loads amsmath."""
    script = Latex(_taken(document))
    lines = [rf"\section*{{{_escaped(document.title)}}}", r"\noindent"]
    for names in document.names:
        vector = r",\, ".join(script.write(f) for f in names.fields)
        lines.append(rf"{names.meaning} ${names.letter.latex} = ({vector})$;")
    values = [f"${script.write(name)} = {script.write(value)}$" for name, value in document.parameters]
    lines[-1] = lines[-1].rstrip(";") + (";" if values else ".")
    if values:
        lines.append(f"with {', '.join(values)}.")
    for section in document.sections:
        formula = f" ${section.formula.latex}$" if section.formula else ""
        lines += ["", rf"\paragraph{{{_escaped(section.heading)}}}{formula}", *_latex_body(section, script)]
    return "\n".join(lines) + "\n"


def _text_body(section: Section, script: Script, width: int) -> Iterable[str]:
    if section.inline:
        conditions = (f"{script.write(e.left)} = {script.write(e.right)}" for e in section.equations)
        yield "  " + ",  ".join(conditions)
    else:
        lefts = [script.write(e.left) for e in section.equations]
        # aligned at the equals sign unless a left-hand side is itself a long sum
        column = max((_width(left) for left in lefts), default=0)
        column = column if column <= _WIDEST_LEFT else 0
        for equation, left in zip(section.equations, lefts, strict=True):
            yield from _broken(equation, left, column, script, width)
    for line in section.remark.splitlines():
        yield from textwrap.wrap(line, max(width, _NARROWEST), initial_indent="  ", subsequent_indent="  ")


def _broken(equation: Equation, left: str, column: int, script: Script, width: int) -> Iterable[str]:
    if column:
        line, rest = f"  {' ' * (column - _width(left))}{left} =", script.terms(equation.right)
        hang = " " * (column + 5)
    else:
        right = script.terms(equation.right)
        terms = [*script.terms(equation.left), f"= {right[0]}", *right[1:]]
        line, rest, hang = f"  {terms[0]}", terms[1:], " " * 6
    for term in rest:
        if _width(line) + 1 + _width(term) > width:
            yield line
            line = f"{hang}{term}"
        else:
            line = f"{line} {term}"
    yield line


def _latex_body(section: Section, script: Script) -> Iterable[str]:
    if section.equations and section.inline:
        conditions = (f"{script.write(e.left)} = {script.write(e.right)}" for e in section.equations)
        yield from (r"\begin{equation*}", r",\quad ".join(conditions), r"\end{equation*}")
    elif section.equations:
        rows = (row for e in section.equations for row in _rows(e, script))
        yield from (r"\begin{align*}", " \\\\\n".join(rows), r"\end{align*}")
    if section.remark:
        yield _escaped(section.remark)


def _rows(equation: Equation, script: Script) -> list[str]:
    """An equation in rows of a few terms."""
    left, right = script.terms(equation.left), script.terms(equation.right)
    if len(left) > _TERMS_A_ROW:
        head, *others = _chunks(left)
        others[-1] += f" = {' '.join(right)}"
        return [f"& {head}", *(rf"&\quad {row}" for row in others)]
    first, *others = _chunks(right)
    return [f"{' '.join(left)} &= {first}", *(rf"&\quad {row}" for row in others)]


def _chunks(terms: list[str]) -> list[str]:
    return [" ".join(terms[k : k + _TERMS_A_ROW]) for k in range(0, len(terms), _TERMS_A_ROW)]


def _taken(document: Document) -> frozenset[str]:
    sides = [side for s in document.sections for e in s.equations for side in (e.left, e.right)]
    return field_names(sides)


def _spelt(formula: Formula, unicode: bool) -> str:
    return formula.text.replace("'", PRIME).replace("-", MINUS) if unicode else formula.ascii


def _width(text: str) -> int:
    """Columns that a text takes: a combining dot takes none."""
    return sum(not unicodedata.combining(c) for c in text)


def _escaped(words: str) -> str:
    return words.replace("_", r"\_").replace("%", r"\%").replace("&", r"\&")
