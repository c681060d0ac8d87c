"""Slender bodies in slow viscous flow: overdamped Cosserat rods on SE(2) and SE(3)."""

from geocosserat.conductor.check import check
from geocosserat.conductor.cost import cost
from geocosserat.conductor.derive import derive, generate
from geocosserat.conductor.equilibrium import equilibrium
from geocosserat.conductor.paper import paper
from geocosserat.conductor.run import run
from geocosserat.conductor.stability import stability
from geocosserat.results.netcdf import load
from geocosserat.version import VERSION as __version__

__all__ = ["__version__", "check", "cost", "derive", "equilibrium", "generate", "load", "paper", "run", "stability"]
