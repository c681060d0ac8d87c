"""Section IV.C: drag, and the closed equations of motion."""

from geocosserat.referee.statement import Section

SECTION = Section("Elastohydrodynamics")
