"""Slender bodies in slow viscous flow: overdamped Cosserat rods on SE(2) and SE(3)."""

from geocosserat.conductor import check, derive, generate, paper, run
from geocosserat.results.netcdf import load
from geocosserat.version import VERSION as __version__

__all__ = ["__version__", "check", "derive", "generate", "load", "paper", "run"]
