"""What the tests of solvers share."""

from __future__ import annotations

import pytest

from geocosserat.solver import cvode


@pytest.fixture(autouse=True)
def _krylov_for_the_larger_of_two_sizes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Problems of 7 are solved with dense matrices, those of 30 by GMRES; both are quick."""
    monkeypatch.setattr(cvode, "DENSE_LIMIT", 20)
