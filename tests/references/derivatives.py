"""Whether the Jacobians of a reference's equations are their derivatives."""

import numpy as np

from tests.references.radau import Array, System


def assert_derivatives(system: System, y: Array, share: float) -> None:
    """Both agree with central differences at the state y (size,), to this share of their largest entry."""
    step = 1e-6 * np.eye(y.size)
    functions = (system.moved, lambda y: system.residual(0.0, y))
    for function, jacobian in zip(functions, system.jacobians(0.0, y), strict=True):
        differences = (function(y + step) - function(y - step)).T / 2e-6
        np.testing.assert_allclose(jacobian, differences, atol=share * np.abs(jacobian).max())
