"""What was found of a law, for people: in a terminal, and as a passage for a paper."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import sympy as sp
from rich.console import Console
from rich.table import Table
from rich.text import Text

from geocosserat.algebra.groups import Group
from geocosserat.derivation.convert import to_sympy
from geocosserat.passivity.check import Check
from geocosserat.passivity.loop import Loop
from geocosserat.passivity.stability import StabilityAnswer
from geocosserat.passivity.verdict import Verdict

STYLES: dict[Verdict, str] = {
    "passive": "bold green", "active": "bold red", "driven": "bold yellow", "undecided": "bold cyan",
}  # fmt: skip
_GRADES = {"proved": "proved", "probable": "probable, not proved", "sampled": "sampled, not proved"}


def print_check(check: Check, console: Console, files: Sequence[str] = ()) -> None:
    """The verdict, and what it rests on, line by line."""
    head = Text(f"{check.law.name}: ")
    head.append(check.verdict, STYLES[check.verdict])
    if check.grade:
        head.append(f", {_GRADES[check.grade]}")
    console.print(head, soft_wrap=True)
    grid = Table.grid(padding=(0, 2))
    grid.add_column(no_wrap=True)
    grid.add_column(overflow="fold")
    for name, text in lines(check):
        grid.add_row(name, Text(text))
    for file in files:
        grid.add_row("wrote", Text(file))
    console.print(grid)


def lines(check: Check) -> Iterator[tuple[str, str]]:
    """Headings and texts."""
    for condition in check.conditions:
        yield "condition", condition
    for part in check.parts:
        yield part.what, part.why
    stress, wrench = check.stress, check.wrench
    if stress and stress.energy:
        yield "energy", f"{stress.energy.density}  ({stress.energy.how})"
    if stress and stress.split:
        yield "energy part", f"{stress.split.energy}  ({stress.split.how})"
    if stress and stress.witness:
        yield "witness", loop_in_words(stress.witness, check.law.group.strain)
    if wrench and wrench.exact and wrench.energy:
        yield "potential", wrench.energy
    if wrench:
        for period in wrench.periods:
            yield "period", f"{period.words}: {period.text}"
    if wrench and wrench.witness:
        w = wrench.witness
        yield "witness", f"{w.words}: the wrench gives {w.work:.10g}, between {w.low:.12g} and {w.high:.12g}"
    for friction in (check.friction, check.viscous):
        if friction and friction.skew:
            yield "workless", f"the skew part ({'; '.join(friction.skew)}) does no work"
    if check.stability:
        yield "stability", stability_in_words(check.stability)
    if check.symmetry:
        s = check.symmetry
        yield "symmetry", f"{s.name}: {s.words}; its linear laws have {s.even} even and {s.odd} odd moduli"
        yield "objective", s.objective
    for text in check.assumptions:
        yield "assumed", text
    for text in check.not_checked:
        yield "not checked", text


def loop_in_words(loop: Loop, names: tuple[str, ...]) -> str:
    """The ellipse, what is given once round it, and for which values of what is open."""
    centre = ", ".join(f"{name} = {c}" for name, c in zip(names, loop.centre, strict=True))
    path = (
        f"{names[loop.first]} by {loop.radii[0]} cos(2 pi s), {names[loop.second]} by {loop.radii[1]} sin(2 pi s) "
        f"about {centre}"
    )
    at = ", ".join(f"{name} = {x}" for name, x in loop.parameters.items())
    bounds = f"between {loop.low:.12g} and {loop.high:.12g}"
    return f"{path}: the law gives {loop.work:.10g} a cycle, {bounds}" + (f", at {at}" if at else "")


def stability_in_words(answer: StabilityAnswer) -> str:
    """Well posed, definite, convex, and where that is lost first."""
    said = {True: "yes", False: "no", None: "not decided"}
    values = {"parabolic": answer.parabolic, "symmetric part definite": answer.definite, "energy convex": answer.convex}
    words = [f"{name}: {said[value]}" for name, value in values.items()]
    for what in ("definite", "parabolic"):
        first = next((loss for loss in answer.lost if loss.what == what), None)
        if first is not None:
            where = ", ".join(f"{name} = {x:.10g}" for name, x in first.where.items())
            words.append(f"{what} is lost first at {where}")
    return "; ".join(words)


def passage(check: Check) -> str:
    """A passage in LaTeX (for amsmath): law, verdict, and the proof or the counter-example."""
    law = check.law
    out = [
        "% Needs amsmath.",
        f"\\paragraph{{{_escaped(law.name)}}}",
        f"The law is \\emph{{{check.verdict}}}" + (f" ({_GRADES[check.grade]})." if check.grade else "."),
    ]
    for condition in check.conditions:
        out.append(f"It is {_escaped(condition)}.")
    stress = check.stress
    if stress and stress.stress:
        rows = [
            f"{_component(name)} &= {sp.latex(e)}"
            for name, e in zip(law.group.stress, map(to_sympy, stress.stress), strict=True)
        ]
        out += ["Its stress is", "\\begin{align*}", " \\\\\n".join(rows), "\\end{align*}"]
    if stress and stress.energy:
        out.append(f"It is the gradient of the energy density \\( {sp.latex(stress.energy.density)} \\).")
    if stress and stress.curl:
        rows = [
            f"{_slope(law.group, j, i)} - {_slope(law.group, i, j)} &= {sp.latex(e)}" for (i, j), e in stress.curl
        ]
        out += ["The tangent is not symmetric:", "\\begin{align*}", " \\\\\n".join(rows), "\\end{align*}"]
    if stress and stress.witness:
        out.append(_escaped(f"Once round the loop {loop_in_words(stress.witness, law.group.strain)}") + ".")
    wrench = check.wrench
    if wrench and wrench.exact and wrench.potential is not None:
        out.append(f"The wrench has the potential \\( {sp.latex(wrench.potential)} \\).")
    if wrench and wrench.witness:
        w = wrench.witness
        out.append(_escaped(f"Once round {w.words}, the wrench gives {w.work:.10g}") + ".")
    out.append("Assumed: " + _escaped("; ".join(check.assumptions)) + ".")
    return "\n".join(out) + "\n"


def _slope(group: Group, i: int, j: int) -> str:
    return f"\\partial {_component(group.stress[i])} / \\partial {_component(group.strain[j])}"


def _component(name: str) -> str:
    letters = name.rstrip("0123456789")
    index = name[len(letters) :]
    return ("\\Pi" if letters == "Pi" else letters) + (f"_{{{index}}}" if index else "")


def _escaped(text: str) -> str:
    for mark in "\\{}":
        text = text.replace(mark, "")
    for mark in "&%$#_":
        text = text.replace(mark, f"\\{mark}")
    return text.replace("^", "\\textasciicircum{}").replace("~", "\\textasciitilde{}")
