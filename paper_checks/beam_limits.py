"""Section VIII, and what the introduction says of it: the rod that neither stretches nor shears."""

from geocosserat.referee.statement import Section

SECTION = Section("Beam limits")
