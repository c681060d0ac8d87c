"""The command of docs/linearised.md prints what docs/linearised.md says."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

from click.testing import CliRunner

from geocosserat.cli import main

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "docs" / "linearised.md").read_text(encoding="utf-8")
BLOCKS = dict(re.findall(r"^```(\w+)\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL))


def test_the_column_is_printed_as_the_page_shows_it(tmp_path: Path) -> None:
    """Line by line, in that order, with parts left out in between."""
    scene = tmp_path / "column.toml"
    scene.write_text(BLOCKS["toml"], encoding="utf-8")
    words = [str(scene) if word == "column.toml" else word for word in shlex.split(BLOCKS["sh"])]
    assert words[0] == "geocosserat"
    done = CliRunner().invoke(main, words[1:])
    assert done.exit_code == 0
    printed = iter(done.stdout.splitlines())
    for line in filter(None, BLOCKS["text"].splitlines()):
        assert line in printed, line
