"""Section III: the same in components of the moving frame."""

from geocosserat.referee.statement import Section

SECTION = Section("Moving frames")
