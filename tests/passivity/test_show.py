"""What is shown of a law, in a terminal and for a paper: all that was found, and no more."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping
from typing import Any

import pytest
from rich.console import Console

from geocosserat.model.law import load_law
from geocosserat.passivity.check import Check, check
from geocosserat.passivity.show import STYLES, lines, loop_in_words, passage, print_check, stability_in_words
from tests.passivity.zoo import ZOO, planar

SHOWN = (
    "diagonal", "odd, shear and bend", "odd with an open modulus", "vortex", "couple", "trap in space",
    "friction, skew", "friction with an open coupling", "Kelvin-Voigt, negative", "all parts", "active curvature",
)  # fmt: skip


def found(name: str, law: Mapping[str, Any] | None = None) -> Check:
    """What is found of a law, by default one of the zoo."""
    return check(load_law({"name": name, **(law or ZOO[name].law)}))


def printed(answer: Check, files: tuple[str, ...] = ()) -> str:
    """What a wide terminal shows, without colours."""
    out = io.StringIO()
    print_check(answer, Console(file=out, width=2000, color_system=None), files)
    return out.getvalue()


@pytest.mark.parametrize("name", SHOWN)
def test_the_first_line_is_name_verdict_and_grade(name: str) -> None:
    """What is not proved is said not to be."""
    answer = found(name)
    first = printed(answer).splitlines()[0]
    assert first == f"{name}: {answer.verdict}" + (", proved" if answer.grade else "")


@pytest.mark.parametrize("name", SHOWN)
def test_all_that_is_assumed_or_was_not_checked_is_shown(name: str) -> None:
    """Conditions, reasons, assumptions, and what the law does not say."""
    answer = found(name)
    texts = [text for _, text in lines(answer)]
    for text in (*answer.conditions, *(part.why for part in answer.parts), *answer.assumptions, *answer.not_checked):
        assert text in texts
    shown = printed(answer, ("out/law.png",))
    assert all(text in shown for text in texts)
    assert "out/law.png" in shown


def test_markup_in_a_name_is_text() -> None:
    """A name is shown as it is written, brackets and all."""
    answer = found("[red]x[/red]", ZOO["diagonal"].law)
    assert printed(answer).startswith("[red]x[/red]: passive")


def test_every_verdict_has_a_style() -> None:
    """One for each."""
    assert set(STYLES) == {"passive", "active", "driven", "undecided"}


def test_a_loop_is_said_in_full() -> None:
    """Both components with their radii, the centre, the work and its bounds."""
    answer = found("odd with an open modulus")
    assert answer.stress is not None
    loop = answer.stress.witness
    assert loop is not None
    names = answer.law.group.strain
    text = loop_in_words(loop, names)
    assert text.startswith(f"{names[loop.first]} by {loop.radii[0]} cos(2 pi s), {names[loop.second]} by ")
    assert all(f"{name} = {c}" in text for name, c in zip(names, loop.centre, strict=True))
    assert f"gives {loop.work:.10g} a cycle" in text
    assert all(f"{name} = {x}" in text for name, x in loop.parameters.items())
    low, high = (float(x) for x in re.findall(r"between (\S+) and (\S+?),? ", f"{text} ")[0])
    assert low <= loop.work <= high


def test_stability_says_what_is_not_decided_apart_from_no() -> None:
    """Yes, no and not decided are three answers."""
    answer = found("indefinite K")
    assert answer.stability is not None
    text = stability_in_words(answer.stability)
    assert "symmetric part definite: no" in text
    assert "energy convex: no" in text
    fine = found("diagonal")
    assert fine.stability is not None
    assert "symmetric part definite: yes" in stability_in_words(fine.stability)


@pytest.mark.parametrize("name", SHOWN)
def test_a_passage_is_balanced_latex(name: str) -> None:
    """Braces, brackets of mathematics and environments close; no mark of LaTeX stands bare in the prose."""
    text = passage(found(name))
    assert text.count("{") == text.count("}")
    assert text.count("\\(") == text.count("\\)")
    assert text.count("\\begin{align*}") == text.count("\\end{align*}")
    prose = re.sub(r"\\begin\{align\*\}.*?\\end\{align\*\}|\\\(.*?\\\)", "", text, flags=re.DOTALL)
    prose = "\n".join(line for line in prose.splitlines() if not line.startswith("%"))
    assert not re.search(r"(?<!\\)[&#$%_^~]", prose)


def test_a_passage_has_the_verdict_and_its_proof() -> None:
    """The energy of a passive law, curl and loop of an active one."""
    passive, active = passage(found("diagonal")), passage(found("odd, shear and bend"))
    assert "\\emph{passive} (proved)" in passive
    assert "It is the gradient of the energy density" in passive
    assert "\\Pi" in passive
    assert "\\emph{active} (proved)" in active
    assert "The tangent is not symmetric" in active
    assert "\\partial M / \\partial h_{2} - \\partial F_{2} / \\partial \\Pi &= -6" in active
    assert "Once round the loop" in active
    assert "gradient of the energy" not in active


def test_the_curl_of_a_passage_is_the_derivative_that_it_says() -> None:
    """d Sigma_j / d E_i minus d Sigma_i / d E_j for the two named components: here d F2 / d h1 alone."""
    text = passage(found("one-way", planar({"F1": "h1 - 1", "F2": "3*(h1 - 1) + h2", "M": "Pi"})))
    assert "\\partial F_{2} / \\partial h_{1} - \\partial F_{1} / \\partial h_{2} &= 3" in text


def test_a_name_cannot_break_a_passage() -> None:
    """Marks of LaTeX in a name are escaped or left out."""
    text = passage(found("50% & \\input{x} #1 $y_2^3~$", ZOO["diagonal"].law))
    assert "\\input" not in text
    assert "50\\% \\& inputx \\#1 \\$y\\_2\\textasciicircum{}3\\textasciitilde{}\\$" in text
