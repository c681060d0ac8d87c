"""The effects that come with the program; importing this module makes them known."""

from geocosserat.model.effects.couple import Couple
from geocosserat.model.effects.field import Field
from geocosserat.model.effects.flow import Flow
from geocosserat.model.effects.follower import Follower
from geocosserat.model.effects.trap import Trap
from geocosserat.model.effects.weight import Weight

EFFECTS = (Weight, Follower, Couple, Field, Flow, Trap)
