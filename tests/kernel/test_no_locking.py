"""Stiff stretch and shear make the scheme neither stiffer in bending nor less accurate: nothing locks."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.load import load
from geocosserat.model.scene import load_scene
from geocosserat.solver.integrate import integrate

Array = NDArray[np.float64]
STIFF = ("1e2", "1e4", "1e6")
TIP = np.array([0.82507706946494, 0.51831043029012])
"""Of the paper's planar rod at k = 1e4 and t = 0.05, to ten digits (measured; see the design)."""


def tip(kappa: str, friction: str, elements: int, degree: int) -> Array:
    """Where the paper's hooked cantilever has its tip at t = 0.05."""
    scene = load_scene(
        {
            "parameters": {"kappa": float(kappa)},
            "rod": {
                "motion": "planar", "length": 1.0, "stiffness": ["kappa", "kappa", 1.0],
                "friction": [1.0, 1.0, friction],
            },
            "start": {"strain": ["1", "0", "3*(1-u)**2*(1+2*u)"]},
            "run": {"until": 0.05},
        }
    )  # fmt: skip
    r = discretise(scene, elements, degree)
    k = load(kernel_text(r.structure), r, "numpy")
    done = integrate(k, r.state, np.array([0.0, 0.05]), rtol=1e-9, atol=1e-11)
    assert done.reached
    found: Array = r.poses(done.states[-1]).position[-1]
    return found


@cache
def error(kappa: str, degree: int) -> float:
    """Of the tip, one element, relative to the length, when the rotational friction is 1/kappa."""
    return float(np.linalg.norm(tip(kappa, "1/kappa", 1, degree) - converged(kappa)))


@cache
def converged(kappa: str) -> Array:
    return tip(kappa, "1/kappa", 1, 14)


@pytest.mark.parametrize(("degree", "most"), [(3, 6e-4), (5, 1e-5), (8, 5e-8)])
def test_one_element_is_as_accurate_at_any_stiffness(degree: int, most: float) -> None:
    """The same tip error at k = 1e2, 1e4 and 1e6: a scheme that locks would lose a factor of 100 each."""
    errors = [error(kappa, degree) for kappa in STIFF]
    assert max(errors) < most
    assert max(errors) < 3 * min(errors) + 1e-8


def test_the_cantilever_of_the_design_ends_where_it_was_measured() -> None:
    """Ten digits, on one element of degree 12."""
    np.testing.assert_allclose(tip("1e4", "0.01", 1, 12), TIP, rtol=0, atol=1e-9)  # the tolerance in time


@pytest.mark.parametrize(("degree", "elements", "order"), [(1, 12, 2), (2, 8, 4)])
@pytest.mark.parametrize("kappa", STIFF)
def test_the_tip_converges_with_order_2p_at_any_stiffness(kappa: str, degree: int, elements: int, order: int) -> None:
    """Twice the elements, a fourth or a sixteenth of the error."""
    coarse, fine = (
        np.linalg.norm(tip(kappa, "1/kappa", n, degree) - converged(kappa)) for n in (elements, 2 * elements)
    )
    assert 0.7 * 2**order < coarse / fine < 1.35 * 2**order
