"""Slender bodies in slow viscous flow: overdamped Cosserat rods on SE(2) and SE(3)."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from geocosserat.version import VERSION as __version__

if TYPE_CHECKING:
    from geocosserat.conductor.check import check
    from geocosserat.conductor.cost import cost
    from geocosserat.conductor.derive import derive, generate
    from geocosserat.conductor.equilibrium import equilibrium
    from geocosserat.conductor.paper import paper
    from geocosserat.conductor.run import run
    from geocosserat.conductor.stability import stability
    from geocosserat.results.netcdf import load

__all__ = ["__version__", "check", "cost", "derive", "equilibrium", "generate", "load", "paper", "run", "stability"]

_WHERE = {
    "check": "conductor.check",
    "cost": "conductor.cost",
    "derive": "conductor.derive",
    "equilibrium": "conductor.equilibrium",
    "generate": "conductor.derive",
    "load": "results.netcdf",
    "paper": "conductor.paper",
    "run": "conductor.run",
    "stability": "conductor.stability",
}


def __getattr__(name: str) -> Any:
    """Public functions, imported when asked for: the program listens for Ctrl-C before it imports what is slow."""
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}; it has {', '.join(__all__)}")
    found = globals()[name] = getattr(import_module(f"{__name__}.{_WHERE[name]}"), name)
    return found


def __dir__() -> list[str]:
    return [*globals(), *_WHERE]
