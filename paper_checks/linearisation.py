"""Section VI: small motions about an equilibrium."""

from geocosserat.referee.statement import Section

SECTION = Section("Linearisation")
