"""A short paper with a statement of each kind."""

from __future__ import annotations

from functools import cache

import numpy as np
import sympy as sp

from geocosserat.referee.motion import Motion, cross
from geocosserat.referee.statement import Check, Section

FIRST, SECOND = Section("Kinematics & signs"), Section("Squares")
SECTIONS = (FIRST, SECOND)
ZERO = 0
LONG = "U1 [f < g] as a long name in a table"


@cache
def _rod() -> Motion:
    return Motion()


def _nothing(n: int) -> np.ndarray:
    return np.full(n, ZERO, dtype=object)


@FIRST.states("(1)", "the slope", r"\boldsymbol{r}'=R\,\underline{h}", part="(1a)", affects=["(2)", "(9)"])
def slope() -> Check:
    rod = _rod()
    h, _ = rod.split(rod.turn)
    return Check(printed=rod.world(h), derived=rod.du(rod.position), defines=True, fields=rod)


@FIRST.states(
    "(1)",
    "the sign of Pi x Omega",
    r"\dot\Pi-\Omega'=\Omega\times\Pi",
    r"\dot\Pi-\Omega'=\Pi\times\Omega",
    part="(1b)",
    remark="Of components; see (1a) & $\\boldsymbol{e}_i'=\\boldsymbol{\\Pi}\\times\\boldsymbol{e}_i$.",
    affects=["(1)"],
)
def spin() -> Check:
    rod = _rod()
    (_, Pi), (_, Omega) = rod.split(rod.turn), rod.split(rod.twist)
    change = rod.dt(Pi) - rod.du(Omega)
    also = ("and nothing else", _nothing(3), change - cross(Pi, Omega))
    return Check(printed=cross(Omega, Pi), derived=change, corrected=cross(Pi, Omega), also=[also], fields=rod)


@SECOND.states("I01", "a square of a sum", r"(x+y)^2=x^2+2xy+y^2")
def square() -> Check:
    x, y = sp.symbols("x y")
    return Check((x + y) ** 2, x**2 + 2 * x * y + y**2)


@SECOND.states(
    LONG,
    "a square, shortened <for small y>",
    r"(x+y)^2=x^2\quad\text{to first order}",
    r"(x+y)^2=x^2+2xy+y^2",
    remark="Only without y.",
)
def shortened() -> Check:
    x, y = sp.symbols("x y")
    return Check(x**2, (x + y) ** 2, condition=("y vanishes & nothing else", {y: sp.S.Zero}))


def failing() -> Section:
    """A statement that is wrong, with no other form: not part of the paper."""
    section = Section("Wrong")

    @section.states("(3)", "a wrong square", "(x+y)^2=x^2+y^2")
    def wrong() -> Check:
        x, y = sp.symbols("x y")
        return Check((x + y) ** 2, x**2 + y**2)

    return section


def broken() -> Check:
    """Two sides of two shapes."""
    return Check([0, 0], 0)
