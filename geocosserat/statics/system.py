"""A rod that is to rest, as a system of equations f(x) = 0 in coordinates of natural size."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from geocosserat.kernel.contract import Array, Kernel
from geocosserat.statics.linear import Linear
from geocosserat.statics.sparse import Sparse

Mask = NDArray[np.bool_]

LARGEST = 1600
"""Unknowns with which dense matrices are still a matter of seconds."""


class Closure(Protocol):
    """What closes a rod: how far it is from closed, and what of its rates says nothing, since it stays so."""

    def gap(self, y: Array) -> Array:
        """(k,) what is to vanish of a state."""

    def slope(self, y: Array, kept: NDArray[np.intp]) -> Array:
        """(k, n) how that changes with these entries."""

    def lost(self, y: Array, kept: NDArray[np.intp]) -> Array:
        """(n, k) by columns, combinations of the rates of these entries that are zero whatever the rod does."""


@dataclass(frozen=True, eq=False)
class System:
    """The equations f(y) = 0 of a kernel at time 0, in those entries of its state that matter.

    start (size,): a state, from which what does not matter is taken. kept (n,): indices of the entries that matter.
    scale (n,): their natural sizes; x = y[kept] / scale. round (n,): True for entries that form a unit vector, which
    every step leaves one. rate: about how fast the rod relaxes (1 / time). closure: of a rod whose ends are joined.
    """

    kernel: Kernel
    start: Array
    kept: NDArray[np.intp]
    scale: Array
    round: Mask
    rate: float
    closure: Closure | None = None

    @property
    def x(self) -> Array:
        """(n,) the coordinates of the start."""
        return self.start[self.kept] / self.scale

    def state(self, x: Array) -> Array:
        """(size,) the whole state."""
        y = self.start.copy()
        y[self.kept] = x * self.scale
        return y

    def residual(self, x: Array) -> Array:
        """(n + k,) what is to vanish: f in natural sizes (1 / time), and the gap of a closed rod."""
        y = self.state(x)
        rate = np.empty_like(y)
        with np.errstate(all="ignore"):  # numbers that are not finite are found later
            self.kernel.rate(0.0, y, rate)
        gap = np.empty(0) if self.closure is None else self.closure.gap(y)
        return np.concatenate([rate[self.kept] / self.scale, gap])

    def linear(self, x: Array) -> Linear | Sparse:
        """The equations linearised at x, with dense matrices if those are not too large."""
        if len(x) > LARGEST and self.closure is None:
            return Sparse(self.kernel, self.state(x), self.kept, self.scale, self.rate)
        return self.dense(x)

    def dense(self, x: Array) -> Linear:
        """The same as matrices, on the motions that leave unit vectors so."""
        y = self.state(x)
        with np.errstate(all="ignore"):
            J = self.kernel.jacobian(0.0, y)[np.ix_(self.kept, self.kept)]
        J = J / self.scale[:, None] * self.scale
        moves = self.kernel.algebraic[self.kept] == 0.0
        basis = np.eye(len(x))
        if self.round.any():
            q = x[self.round]
            across = np.linalg.svd(q[None])[2][1:].T
            basis = basis[:, ~self.round]
            around = np.zeros((len(x), len(q) - 1))
            around[self.round] = across
            basis = np.concatenate([basis, around], axis=1)
            moves = np.concatenate([moves[~self.round], np.ones(len(q) - 1, dtype=bool)])
            J = basis.T @ J @ basis
        if self.closure is None:
            return Linear(J, moves, basis, np.empty((0, len(x))), np.empty((len(J), 0)))
        closing = self.closure.slope(y, self.kept) * self.scale
        lost = basis.T @ (self.closure.lost(y, self.kept) * self.scale[:, None])
        return Linear(J, moves, basis, closing, lost)

    def moved(self, x: Array, step: Array) -> Array:
        """x after a step (n,)."""
        x = x + step
        if self.round.any():
            x[self.round] /= np.linalg.norm(x[self.round])
        return x
