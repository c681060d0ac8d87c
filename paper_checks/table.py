"""Table I: the four representations beside each other."""

from geocosserat.referee.statement import Section

SECTION = Section("Table I")
