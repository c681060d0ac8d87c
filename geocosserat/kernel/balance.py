"""The balance of energy of a rod whose law has one, and the handle by which a step is made to keep it."""

import numpy as np

from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.kernel.contract import Array
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod


class RodBalance:
    """See contract.Balance. rod: with corrections (discretisation/correcting.py); kernel: its own, which reads them
    where `rod` has them."""

    def __init__(self, kernel: NativeRod | NumpyRod, rod: SemiDiscrete) -> None:
        self._kernel, self._rod = kernel, rod
        group = rod.structure.group
        self._free = ~np.array(rod.structure.frozen)
        self._corrections = rod.point[-int(self._free.sum()) :]
        self._direction = np.zeros_like(self._corrections)
        natural = [1.0] * group.translations + [1.0 / float(rod.mesh.edges[-1])] * group.rotations
        self._natural = np.array(natural)[:, None]

    def stored(self, t: float, y: Array) -> tuple[float, float]:
        """See contract.Balance."""
        _, stress, energy = self._kernel.observe(t, y)
        strain = np.abs(self._rod.turn(y, t)) + self._natural
        return energy, abs(energy) + float((np.abs(stress) * strain).sum(axis=0) @ self._rod.mesh.weight)

    def aim(self, t: float, before: Array, after: Array) -> float:
        """See contract.Balance."""
        (_, was, _), (_, now, _) = self._kernel.observe(t, before), self._kernel.observe(t, after)
        strain, stress = self._rod.turn(after, t) - self._rod.turn(before, t), np.abs(now - was)
        self._direction = (stress * np.sign(strain))[self._free]
        return float((stress * np.abs(strain))[self._free].sum(axis=0) @ self._rod.mesh.weight)

    def correct(self, share: float) -> None:
        """See contract.Balance."""
        self._corrections[:] = share * self._direction
