"""The linear equations are the slope of the nonlinear ones by the size of the displacement, to 30 digits."""

from __future__ import annotations

from functools import lru_cache

import pytest
import sympy as sp

from geocosserat.derivation.equations import derive
from geocosserat.derivation.linear import LinearEquations, linearise
from geocosserat.derivation.notation import is_field
from tests.derivation.displaced import CLOSE, MODELS, Displaced, precise

ALL = pytest.mark.parametrize("name", MODELS)


@lru_cache(maxsize=50)
def linear(name: str) -> LinearEquations:
    """The linear equations of that rod."""
    return linearise(derive(MODELS[name]))


@lru_cache(maxsize=50)
def displaced(name: str) -> Displaced:
    """A random base of that rod, moving and under stress, and a displacement."""
    return Displaced(linear(name).base.equations, 17)


def near(a: sp.Expr, b: sp.Expr) -> bool:
    """Whether two numbers are the same."""
    return bool(abs(a - b) < CLOSE * (1 + abs(a)))


@ALL
def test_the_turn_changes_by_the_kinematics(name: str) -> None:
    """phi^-1 phi' of the displaced configuration; frozen modes stay."""
    rod, found = displaced(name), linear(name)
    known = rod.at(0) | rod.unknowns
    turn = found.base.equations.turn
    slopes = rod.slope(lambda at: [at[e] if is_field(e) else sp.S.Zero for e in turn])
    for row, slope in zip(found.kinematics, slopes, strict=True):
        assert near(precise(row.right, known), slope), row


@ALL
def test_the_stress_changes_by_the_tangent(name: str) -> None:
    """Of every law; of a frozen mode it is unknown."""
    rod, found = displaced(name), linear(name)
    known = rod.at(0) | rod.unknowns
    known |= {f: precise(e.right, known) for f, e in zip(found.base.turn_change, found.kinematics, strict=True)}
    laws = found.base.equations.stress_law
    slopes = rod.slope(lambda at: [at[law.left] for law in laws])
    assert len(found.stress) == len(laws)
    for row, slope in zip(found.stress, slopes, strict=True):
        assert near(precise(row.right, known), slope), row


@ALL
def test_the_balance_is_the_slope_of_the_nonlinear_motion(name: str) -> None:
    """Friction less push, of a rod that moves and is under stress: left less right of each row, and of each frozen."""
    rod, found = displaced(name), linear(name)
    motion = found.base.equations.motion
    slopes = rod.slope(lambda at: [precise(e.residual, at) for e in motion]) + [sp.S.Zero] * len(found.base.frozen)
    known = rod.at(0) | rod.unknowns
    for row, slope in zip(found.balance.rows, slopes, strict=True):
        assert near(precise(row.residual, known), slope), row
    assert max(abs(slope) for slope in slopes) > 0.01
