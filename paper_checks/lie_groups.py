"""Section IV.A: configurations, turns and twists as elements of SE(3) and se(3)."""

from geocosserat.referee.statement import Section

SECTION = Section("Geometric field theory: Lie groups")
