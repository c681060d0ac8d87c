"""The rates of several states in one call, each in a lane of its own."""

from __future__ import annotations

import cffi
import numpy as np
import pytest
from numpy.typing import NDArray

from geocosserat.kernel.contract import LANES, NativeKernel
from tests.discretisation.rods import random_state, rod
from tests.kernel.kernels import Case, T, cases, kernel

Array = NDArray[np.float64]
CASES = cases(("c",))


def rates(case: Case, t: Array, states: Array, count: int = LANES) -> Array:
    """Of the first `count` states (count, size), as an integrator asks for them; the other lanes hold no numbers."""
    k = kernel(case)
    assert isinstance(k, NativeKernel)
    ffi, functions = cffi.FFI(), k.functions()
    call = ffi.cast("int (*)(void *, int, const double *, const double *, double *)", functions.rates)
    at, out = np.full((k.size, LANES), np.nan), np.full((k.size, LANES), np.nan)
    instants = np.full(LANES, T)
    at[:, :count], instants[:count] = states[:count].T, t[:count]
    addresses = (ffi.cast("double *", array.ctypes.data) for array in (instants, at, out))
    assert call(ffi.cast("void *", functions.data), count, *addresses) == 0
    return out[:, :count].T


def one_by_one(case: Case, t: Array, states: Array) -> Array:
    """The same, a call for each."""
    out = np.empty_like(states)
    for instant, y, rate in zip(t, states, out, strict=True):
        kernel(case).rate(float(instant), y, rate)
    return out


@pytest.mark.parametrize("case", CASES, ids=str)
def test_states_side_by_side_have_the_rates_that_they_have_by_themselves(case: Case) -> None:
    """Different states at different instants, every rod of the cast: to the round-off of sums in another order."""
    states = np.array([random_state(rod(*case[:3]), seed) for seed in range(LANES)])
    t = T * np.linspace(0.5, 1.5, LANES)
    wanted, found = one_by_one(case, t, states), rates(case, t, states)
    assert np.abs(found - wanted).max() <= 1e-12 * np.abs(wanted).max()
    assert len(np.unique(found[:, 0])) > 1, "all lanes have the same rate: this compares nothing"


@pytest.mark.parametrize("count", [1, 3, 5])
@pytest.mark.parametrize("name", ["planar everything", "spatial everything"])
def test_lanes_that_are_not_in_use_change_nothing(name: str, count: int) -> None:
    """Whatever stands in them, here NaN, the others have the rates of a full call, to round-off."""
    case = next(case for case in CASES if case.name == name)
    states = np.array([random_state(rod(*case[:3]), seed) for seed in range(LANES)])
    t = np.linspace(0.1, 0.4, LANES)
    wanted = rates(case, t, states)[:count]
    assert np.abs(rates(case, t, states, count) - wanted).max() <= 1e-13 * np.abs(wanted).max()
