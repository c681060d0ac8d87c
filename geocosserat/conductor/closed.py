"""A rod whose ends are joined: its turn alone says nothing of whether they meet."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geocosserat.algebra.exponential import log
from geocosserat.discretisation.mesh import Array
from geocosserat.discretisation.motions import strain_rates
from geocosserat.discretisation.pose import Poses
from geocosserat.discretisation.semidiscrete import SemiDiscrete

STEP = 1e-6
"""Of a strain, or of a bend over the length: to see how the gap changes."""


@dataclass(frozen=True, eq=False)
class Closed:
    """What closes the rod (`statics.system.Closure`); lengths relative to its own."""

    rod: SemiDiscrete

    def gap(self, y: Array) -> Array:
        """(d,) the pose of the last node seen from the first."""
        found: Array = self._gaps(y[None])[0]
        return found

    def slope(self, y: Array, kept: NDArray[np.intp]) -> Array:
        """(d, n) how it changes with entries of the state."""
        length, group = float(self.rod.mesh.edges[-1]), self.rod.structure.group
        points = self.rod.mesh.elements * self.rod.mesh.degree
        rows = np.array([STEP] * group.translations + [STEP / length] * group.rotations)
        h = np.full(len(y), STEP)
        h[: len(rows) * points] = np.repeat(rows, points)
        h = h[kept]
        moved = np.zeros((len(kept), len(y)))
        moved[np.arange(len(kept)), kept] = h
        change: Array = (self._gaps(y + moved) - self._gaps(y - moved)) / (2 * h[:, None])
        return change.T

    def lost(self, y: Array, kept: NDArray[np.intp]) -> Array:
        """(n, d) the stresses that are balanced all round a closed rod: no motion of it changes the turn by them."""
        group, mesh = self.rod.structure.group, self.rod.mesh
        A = strain_rates(mesh, group, self.rod.turn(y))
        d = group.dimension
        A[:, :d] += A[:, -d:]  # the first node is the last
        left, _, _ = np.linalg.svd(A[:, :-d])
        found = np.zeros((len(y), d))
        found[: len(A)] = left[:, -d:]
        return found[kept]

    def _gaps(self, states: Array) -> Array:
        poses: Poses = self.rod.poses(states)
        length, group = float(self.rod.mesh.edges[-1]), self.rod.structure.group
        first, last = (group.pose(poses.position[:, i] / length, poses.rotation[:, i]) for i in (0, -1))
        found: Array = log(group, group.inverse(first) @ last)
        return found
