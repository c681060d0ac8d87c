"""A rod whose ends are joined: its turn alone says nothing of whether they meet."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geocosserat.algebra.exponential import log
from geocosserat.discretisation.mesh import Array
from geocosserat.discretisation.motions import strain_rates
from geocosserat.discretisation.semidiscrete import SemiDiscrete


@dataclass(frozen=True, eq=False)
class Closed:
    """What closes the rod (`statics.system.Closure`); lengths relative to its own."""

    rod: SemiDiscrete

    def gap(self, y: Array) -> Array:
        """(d,) the pose of the last node seen from the first."""
        poses = self.rod.poses(y)
        length, group = float(self.rod.mesh.edges[-1]), self.rod.structure.group
        first, last = (group.pose(poses.position[i] / length, poses.rotation[i]) for i in (0, -1))
        found: Array = log(group, group.inverse(first) @ last)
        return found

    def slope(self, y: Array, kept: NDArray[np.intp]) -> Array:
        """(d, n) how it changes with entries of the state, for a rod that is as good as closed: the twist of the last
        node while the first one stays, as the scheme has it."""
        structure, mesh = self.rod.structure, self.rod.mesh
        d, points = structure.group.dimension, mesh.elements * mesh.degree
        A = strain_rates(mesh, structure.group, self.rod.turn(y))
        found = np.zeros((d, len(y)))
        found[:, : d * points] = np.linalg.solve(A[:, d:].T, np.eye(d * points)[:, -d:]).T
        found[: structure.group.translations] /= float(mesh.edges[-1])
        found[:, : d * points][:, np.repeat(structure.frozen, points)] = 0.0  # these entries are stresses
        return found[:, kept]

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
