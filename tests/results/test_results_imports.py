"""Results are light to import: a warm run must not pay for what it does not use."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
HEAVY = {"sympy", "scipy", "h5py", "h5netcdf", "matplotlib", "rich", "xarray", "pandas", "pydantic", "jinja2"}
ALLOWED = {
    "solution": set(), "ledger": set(), "atomic": set(), "seal": set(), "curves": set(),
    "recurrence": set(),
    "netcdf": {"h5py", "h5netcdf"}, "summary": {"rich"}, "progress": {"rich"}, "picture": {"matplotlib"},
}


def _imported(module: str) -> set[str]:
    # a package without the names it offers to users, which bring in the other stages
    code = (
        "import sys, types; package = types.ModuleType('geocosserat'); package.__path__ = ['geocosserat']; "
        f"sys.modules['geocosserat'] = package; import geocosserat.results.{module}; print(*sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT)
    return set(run.stdout.split())


@pytest.mark.parametrize("module", ALLOWED)
def test_a_module_of_results_imports_only_what_it_needs(module: str) -> None:
    """numpy always; the file library, matplotlib or rich only where they are used; never xarray or sympy."""
    found = _imported(module)
    assert found & HEAVY <= ALLOWED[module]
    assert "matplotlib.pyplot" not in found
