"""A derivation laid out to be read: titled sections of equations, the same for text and for LaTeX."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from geocosserat.derivation.records import Equations


@dataclass(frozen=True)
class Formula:
    """A formula of a heading, written three times; ``text`` with ' and - for primes and minus signs."""

    text: str
    ascii: str
    latex: str


@dataclass(frozen=True)
class Names:
    """What a letter stands for: the turn E = (h1, h2, Pi)."""

    meaning: str
    letter: Formula
    fields: tuple[sp.Expr, ...]


@dataclass(frozen=True)
class Section:
    """A heading, the vector form of what follows if there is one, the equations, and a closing remark.

    ``inline``: short equations that go on one line.
    """

    heading: str
    equations: Equations
    formula: Formula | None = None
    inline: bool = False
    remark: str = ""


@dataclass(frozen=True)
class Document:
    """A set of equations to print; ``parameters`` with their values."""

    title: str
    names: tuple[Names, ...]
    parameters: tuple[tuple[sp.Symbol, sp.Expr], ...]
    sections: tuple[Section, ...]
