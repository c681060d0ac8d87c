"""Poses of rods in space whose elements turn far: marched without exchanges of rows in C, with them in numpy."""

from __future__ import annotations

import numpy as np
import pytest

from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.kernel.contract import Kernel
from geocosserat.kernel.load import load
from geocosserat.model.scene import load_scene

T = 0.2


def at_rest(turn: float, elements: int, degree: int, end: str) -> SemiDiscrete:
    """A rod without stress, each of whose elements turns by so many radians, about an axis that changes; it is moved by
    its weight and a trap alone, which act on what is seen of it."""
    rate = turn * elements
    strain = ["1", "0.1", "-0.2*u", f"{rate}*cos(2*u)", f"{rate}*sin(2*u)*0.8", f"{rate}*sin(2*u)*0.6"]
    held = {side: {"kind": "clamped" if side == end else "free"} for side in ("left", "right")}
    values = {
        "rod": {
            "motion": "spatial", "length": 1.0, "stiffness": [1.0] * 6, "friction": [1.0, 2.0, 2.0, 0.1, 0.1, 0.1],
            "reference": strain,
        },
        "start": {"strain": strain},
        "ends": held,
        "effects": [
            {"kind": "weight", "force": [0.3, -0.5, 0.2]},
            {"kind": "trap", "stiffness": 2.0, "centre": [0.1, 0.2, 0.3]},
        ],
        "run": {"until": 1.0},
    }  # fmt: skip
    return discretise(load_scene(values), elements, degree)


def of(kernel: Kernel, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Its rate and its Jacobian."""
    rate = np.empty_like(y)
    kernel.rate(T, y, rate)
    return rate, kernel.jacobian(T, y)


@pytest.mark.parametrize("end", ["left", "right"])
@pytest.mark.parametrize(("elements", "degree"), [(1, 1), (3, 4), (1, 12)])
@pytest.mark.parametrize("turn", [0.5, 3.0, 10.0, 30.0, 100.0])
def test_elements_may_turn_far(turn: float, elements: int, degree: int, end: str) -> None:
    """To round-off up to ten radians an element, and so much less beyond as they turn more."""
    rod = at_rest(turn, elements, degree, end)
    text = kernel_text(rod.structure)
    pairs = zip(*(of(load(text, rod, backend), rod.state) for backend in ("c", "numpy")), strict=True)
    for found, wanted in pairs:
        assert np.abs(found - wanted).max() <= 2e-14 * max(1.0, turn / 10.0) * np.abs(wanted).max()
