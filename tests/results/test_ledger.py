"""The ledger balances for an exact motion, and says by how much it does not for any other."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocosserat.results.ledger import ledger
from tests.results.motions import rolling, unrolling, unwinding

ENERGY = st.floats(-1e12, 1e12)


@pytest.mark.parametrize("make", [rolling, unrolling, unwinding])
def test_the_ledger_of_an_exact_motion_balances(make) -> None:
    """Stored + dissipated = work, to round-off."""
    solution = make()
    found = ledger(solution)
    assert found.residual < 1e-15
    assert found.stored == solution.energy[-1] - solution.energy[0]
    assert found.dissipated > 0
    assert (found.work > 0) == (make is rolling)


def test_a_rod_that_does_nothing_has_no_residual() -> None:
    """Zero over zero is zero."""
    nothing = np.full(41, 3.0)
    found = ledger(rolling(energy=nothing, dissipated=0 * nothing, work=0 * nothing))
    assert (found.stored, found.dissipated, found.work, found.residual) == (0.0, 0.0, 0.0, 0.0)


@given(stored=ENERGY, dissipated=ENERGY, work=ENERGY)
def test_the_residual_is_relative_to_the_largest_term(stored: float, dissipated: float, work: float) -> None:
    """So it lies between 0 and 3 whatever the units, and does not change with them."""
    def residual(factor: float) -> float:
        ends = [np.array([0.0, x * factor]) for x in (stored, dissipated, work)]
        return ledger(rolling(frames=2, energy=ends[0], dissipated=ends[1], work=ends[2])).residual

    largest = max(abs(stored), abs(dissipated), abs(work))
    if largest > 1e-250:
        assert residual(1.0) == pytest.approx(abs(stored + dissipated - work) / largest, abs=1e-15)
        assert residual(1024.0) == pytest.approx(residual(1.0), abs=1e-12)
    assert 0.0 <= residual(1.0) <= 3.0


def test_what_came_before_the_first_frame_does_not_count() -> None:
    """A run that goes on from a checkpoint starts with work done and energy dissipated."""
    solution = rolling()
    later = rolling(energy=solution.energy + 5, dissipated=solution.dissipated + 7, work=solution.work + 11)
    assert ledger(later).residual < 1e-14
