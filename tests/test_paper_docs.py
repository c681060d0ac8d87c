"""The code of docs/paper.md does what docs/paper.md says."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest

from geocosserat.referee.report import VERDICTS

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "docs" / "paper.md").read_text(encoding="utf-8")
OWN, WRONG = re.findall(r"^```python\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)


def ran(code: str, folder: Path) -> str:
    """What a script of this code prints, in a process of its own."""
    script = folder / "mine.py"
    script.write_text(code, encoding="utf-8")
    paths = [str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    done = subprocess.run(
        [sys.executable, script], cwd=folder, env=environment, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.slow
def test_another_group_is_judged_by_the_same_code(tmp_path: Path) -> None:
    """Both laws of a filament on SO(3) hold; with a wrong sign they do not, and its page shows the code."""
    assert len(OWN.partition("NAMES =")[2].splitlines()) <= 20
    text = ran(OWN, tmp_path)
    assert re.search(r"^\(1\) +holds +mixed derivatives of the frame agree *$", text, re.MULTILINE)
    assert re.search(r"^\(2\) +holds +moments balance *$", text, re.MULTILINE)
    for right, wrong in (("cross(rod.turn, rod.twist)", "cross(rod.twist, rod.turn)"), (" + cross(", " - cross(")):
        assert right in OWN
        altered = OWN.replace(right, wrong).replace("assert report.passed", "assert not report.passed")
        assert "no other is given: refuted" in ran(altered, tmp_path)
    shown = "from geocosserat.referee.page import page\nprint(page(report, 'My derivation'))\n"
    assert "print(verdict_on(balance()))" in ran(OWN + shown, tmp_path)


def test_a_wrong_equation_is_refuted_at_a_point(tmp_path: Path) -> None:
    """Of rational numbers, as many as the equation has symbols."""
    proved, refuted, *point = ran(WRONG, tmp_path).splitlines()
    assert proved.startswith("proved")
    assert re.match(r"refuted: entry \d is off by \S+ at a random point \(exact\)", refuted)
    values = {name: Fraction(value) for name, value in (line.split(" = ") for line in point)}
    assert {"h1", "Omega2"} <= set(values)


def test_the_verdicts_and_their_order_are_those_of_the_program() -> None:
    """The table in docs/paper.md."""
    assert re.findall(r"^\| `(\w+)` \| [a-z]", TEXT, re.MULTILINE)[: len(VERDICTS)] == list(VERDICTS)
