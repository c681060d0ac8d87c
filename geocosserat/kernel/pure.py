"""A numpy kernel behind the kernel contract: the way without a C compiler."""

import types
from typing import Any

from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.kernel.contract import ENERGIES, Array


class NumpyRod:
    """The generated numpy kernel of a semi-discrete rod."""

    backend = "numpy"
    quadratures = ENERGIES

    def __init__(self, module: types.ModuleType, rod: SemiDiscrete) -> None:
        mesh = rod.mesh
        self._rod: Any = module.Rod(
            mesh.elements,
            mesh.degree,
            mesh.half,
            mesh.mass,
            mesh.u,
            mesh.u_point,
            rod.tables,
            rod.uniform,
            rod.point,
            rod.node,
            rod.base,
        )
        self.size = len(rod.state)
        self.algebraic = rod.algebraic
        self._linear: Any = None
        self._factors: Any = None

    def rate(self, t: float, y: Array, out: Array) -> None:
        self._rod.rate(t, y, out)

    def observe(self, t: float, y: Array) -> tuple[Array, Array, float]:
        """Twist (d, nodes), stress (d, points), stored energy."""
        twist, stress, energy = self._rod.observe(t, y)
        return twist, stress, float(energy)

    def blocks(self, t: float, y: Array) -> tuple[Array, Array, Array]:
        """The block-tridiagonal Jacobian, (elements, block, block) each."""
        lower, diagonal, upper = self._rod.blocks(t, y)
        return lower, diagonal, upper

    def jacobian(self, t: float, y: Array) -> Array:
        J: Array = self._rod.jacobian(t, y)
        return J

    def prepare(self, t: float, y: Array) -> None:
        self._linear = self._rod.linearise(t, y)

    def factor(self, gamma: float) -> None:
        assert self._linear is not None, "prepare comes before factor"
        self._factors = self._rod.factor(gamma, *self._linear)

    def solve(self, b: Array, out: Array) -> None:
        out[:] = self._rod.solve(self._factors, b)
