"""The verdicts on all statements of the paper."""

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from geocosserat.referee.report import Report


def paper(progress: Callable[[int, int], None] | None = None, processes: int = 1) -> "Report":
    """Judges every statement of the paper this program was made from; each verdict is computed.

    `progress` is called with how many statements were judged so far, and how many there are; `processes` work side by
    side.
    """
    from geocosserat.referee.report import review
    from paper_checks import SECTIONS

    return review(SECTIONS, progress, processes)
