"""Section IX: the equations as the conclusion has them."""

from geocosserat.referee.statement import Section

SECTION = Section("Discussion and conclusion")
