"""Numbers that several integrators share."""

DENSE_LIMIT = 120
"""Largest state that is solved with dense matrices (benchmarks/linear_solvers.py)."""

KRYLOV = 10
"""Krylov vectors that GMRES may keep; with the exact preconditioner it needs one or two."""

STEP_LIMIT = 1_000_000
"""Steps after which a run gives up."""
