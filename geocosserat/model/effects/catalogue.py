"""The effects that scenes may name: those that come with the program, and those that were registered."""

from geocosserat.model.effects.couple import Couple
from geocosserat.model.effects.field import Field
from geocosserat.model.effects.flow import Flow
from geocosserat.model.effects.follower import Follower
from geocosserat.model.effects.registry import kind, kinds
from geocosserat.model.effects.trap import Trap
from geocosserat.model.effects.weight import Weight

__all__ = ["EFFECTS", "kind", "kinds"]

EFFECTS = (Weight, Follower, Couple, Field, Flow, Trap)
"""Those that come with the program, in the order of the documentation; importing them made them known."""
