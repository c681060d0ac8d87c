"""Section VII: the planar rod in coordinates."""

from geocosserat.referee.statement import Section

SECTION = Section("Coordinatised equations")
