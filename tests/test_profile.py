"""The table of where time goes, as far as no clock is needed."""

from __future__ import annotations

import pytest

from benchmarks import profile

REPORT = """
# Overhead  Symbol
    12.50%  [.] solve_shifted
     7.25%  [.] rod_blocks
     0.25%  [.] rod_dense
    30.00%  [.] _PyEval_EvalFrameDefault
     1.00%  [k] clear_page_erms
"""


def test_samples_are_counted_with_the_part_of_their_function() -> None:
    """What belongs to none is Python, what it calls, and the system."""
    found = profile.shares(REPORT)
    assert found.pop("linear solves") == pytest.approx(12.5)
    assert found.pop("Jacobians") == pytest.approx(7.5)
    assert found.pop(profile.REST) == pytest.approx(31.0)
    assert set(found.values()) == {0.0}


def test_no_function_is_in_two_parts() -> None:
    """Else its time would be counted with one of them only, whichever comes last."""
    functions = " ".join(profile.PARTS.values()).split()
    assert len(functions) == len(set(functions))
