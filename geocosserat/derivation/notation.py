"""The symbols of the field equations: coordinates, parameters, and fields of (u, t)."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

import sympy as sp


@lru_cache(maxsize=1024)
def symbol(name: str) -> sp.Symbol:
    """The real symbol of a parameter or a coordinate."""
    return sp.Symbol(name, real=True)


U, T = symbol("u"), symbol("t")
"""Material coordinate (length) and time."""


@lru_cache(maxsize=1024)
def field(name: str) -> sp.Expr:
    """A real field of that name, a function of (u, t)."""
    return sp.Function(name, real=True)(U, T)


def fields(names: Iterable[str]) -> tuple[sp.Expr, ...]:
    """Real fields of those names."""
    return tuple(field(name) for name in names)


def is_field(e: sp.Expr) -> bool:
    """Whether an expression is a field or a derivative of one."""
    return isinstance(e.expr if isinstance(e, sp.Derivative) else e, sp.core.function.AppliedUndef)


def has_fields(e: sp.Expr) -> bool:
    """Whether any field occurs in an expression."""
    return bool(e.has(sp.core.function.AppliedUndef))


def field_names(expressions: Iterable[sp.Expr]) -> frozenset[str]:
    """Names of the fields that occur."""
    return frozenset(f.func.__name__ for e in expressions for f in e.atoms(sp.core.function.AppliedUndef))


def parameter_names(expressions: Iterable[sp.Expr]) -> frozenset[str]:
    """Names of the symbols that occur, the coordinates left out."""
    return frozenset(s.name for e in expressions for s in e.free_symbols - {U, T})
