"""Section V: work, conservative laws, boundary conditions."""

from geocosserat.referee.statement import Section

SECTION = Section("Work, constitutive laws and boundary conditions")
