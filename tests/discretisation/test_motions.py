"""The matrix that turns twists of the nodes into rates of the turn is that of the kernels."""

from __future__ import annotations

import numpy as np
import pytest

from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.motions import strain_rates
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.load import load
from geocosserat.model.scene import load_scene


@pytest.mark.parametrize("name", ["hanging", "elastica"])
def test_twists_make_the_rates_that_the_kernel_makes(name: str, examples: object) -> None:
    """V' + ad_E V, with the kernel's own twist, to round-off."""
    rod = discretise(load_scene(f"{examples}/{name}.toml"), 3, 5)
    kernel = load(kernel_text(rod.structure), rod, "numpy")
    twist, _, _ = kernel.observe(0.0, rod.state)
    rate = np.empty_like(rod.state)
    kernel.rate(0.0, rod.state, rate)
    A = strain_rates(rod.mesh, rod.structure.group, rod.turn(rod.state))
    assert A @ twist.T.ravel() == pytest.approx(rate[: len(A)], abs=1e-12 * np.abs(rate).max())
