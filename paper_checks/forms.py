"""Section IV.B: differential forms, duals, constitutive laws."""

from geocosserat.referee.statement import Section

SECTION = Section("Geometric field theory: differential forms")
