"""`python -m paper_checks` writes docs/errata.md of a checkout again."""

from pathlib import Path

from geocosserat.referee.errata import errata
from geocosserat.referee.report import review
from paper_checks import SECTIONS
from paper_checks.title import AUTHORS, COMMAND, TITLE

ERRATA = Path(__file__).parents[1] / "docs" / "errata.md"

if __name__ == "__main__":
    ERRATA.write_text(errata(review(SECTIONS), TITLE, AUTHORS, COMMAND), encoding="utf-8")
