"""The assembled rod: generated kernels add no work of their own to what a law says."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from geocosserat.kernel.pure import NumpyRod
from tests.discretisation.rods import LAWFUL, NAMES, SIZES, rod
from tests.kernel.kernels import Case, T, kernel

Array = NDArray[np.float64]
STORING = [name for name in NAMES if name not in LAWFUL or name.endswith("soft")]
"""Rods whose stress has an energy."""


def loop(name: str, size: tuple[int, int], steps: int) -> tuple[Array, Array]:
    """States on a smooth closed path through the turns of all points (of frozen modes, stresses), and the change of the
    turn (steps, d, points) along it, for each of ``steps`` equal parts of its period."""
    r = rod(name, *size)
    d, Q = r.structure.group.dimension, len(r.mesh.u_point)
    rng = np.random.default_rng(7)
    waves = rng.normal(scale=0.15, size=(2, 2, d, Q))
    s = 2 * np.pi * np.arange(steps) / steps
    k = np.arange(1, 3)[:, None]
    along = np.einsum("ks,kdq->sdq", np.cos(k * s), waves[0]) + np.einsum("ks,kdq->sdq", np.sin(k * s), waves[1])
    swings = k * np.cos(k * s), -k * np.sin(k * s)
    change = np.einsum("ks,kdq->sdq", swings[0], waves[1]) + np.einsum("ks,kdq->sdq", swings[1], waves[0])
    states = np.repeat(r.state[None], steps, axis=0)
    states[:, : d * Q] += along.reshape(steps, -1)
    change[:, np.array(r.structure.frozen)] = 0.0
    return states, change * 2 * np.pi / steps


def work(name: str, size: tuple[int, int], steps: int = 96) -> tuple[float, float]:
    """What the stress does once round, by the trapezoidal rule, and the sum of the sizes of its parts."""
    k = kernel(Case(name, *size, "numpy"))
    states, change = loop(name, size, steps)
    weight = rod(name, *size).mesh.weight
    parts = np.array([weight * k.observe(T, y)[1] * dE for y, dE in zip(states, change, strict=True)])
    return float(parts.sum()), float(np.abs(parts).sum())


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("name", STORING)
def test_once_round_a_closed_path_of_turns_the_stress_does_no_work(name: str, size: tuple[int, int]) -> None:
    """Whatever the law, the mesh and the frozen modes, as long as the stress has an energy; to round-off."""
    net, gross = work(name, size)
    assert abs(net) <= 1e-13 * gross


@pytest.mark.parametrize("name", [name for name in LAWFUL if name.endswith("odd")])
def test_the_stress_of_an_odd_rod_does_work_once_round(name: str) -> None:
    """Where there is no energy, what is gained is that of the law, and the measure sees it."""
    net, gross = work(name, (4, 2))
    assert abs(net) > 1e-6 * gross  # ten million times what is seen of the others


@pytest.mark.parametrize("name", STORING)
def test_the_tangent_of_a_stress_with_an_energy_is_symmetric(name: str) -> None:
    """As it is generated, at any state, to round-off; columns of frozen modes hold their own stress instead."""
    case = Case(name, 4, 2, "numpy")
    k, r = kernel(case), rod(name, 4, 2)
    assert isinstance(k, NumpyRod)
    y = loop(name, (4, 2), 8)[0][3]
    tangent, _ = k._rod.tangents(T, y)
    free = ~np.array(r.structure.frozen)
    T_free = tangent[..., free, :][..., free]
    np.testing.assert_allclose(T_free, T_free.swapaxes(-1, -2), rtol=0, atol=1e-14 * np.abs(T_free).max())
