"""The two groups of rigid motions and everything that follows from their bases.

A configuration is the matrix ``[[1, 0], [r, R]]``; the columns of R are the moving frame. All methods take
float arrays with any leading batch axes and, through the same lines, object arrays of symbolic expressions.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


@dataclass(frozen=True)
class Group:
    """A group of rigid motions of the plane or of space, given by a basis of its Lie algebra.

    Component order everywhere: translations first, then rotations, as the names say.
    """

    name: str
    space: int
    basis: tuple[Array, ...] = field(compare=False, repr=False)
    strain: tuple[str, ...]
    twist: tuple[str, ...]
    stress: tuple[str, ...]
    wrench: tuple[str, ...]

    @property
    def dimension(self) -> int:
        """Dimension of the group: 3 in the plane, 6 in space."""
        return len(self.basis)

    @cached_property
    def translations(self) -> int:
        """Number of translations: 2, 3, or none in a group of rotations."""
        return sum(bool(np.any(element[1:, 0])) for element in self.basis)

    @property
    def rotations(self) -> int:
        """Number of rotations: 1 or 3."""
        return self.dimension - self.space

    @property
    def size(self) -> int:
        """Rows of a configuration matrix: 3 or 4."""
        return self.space + 1

    @cached_property
    def structure(self) -> Array:
        """Structure constants C[a, b, c], integers, from the commutators: [b_a, b_b] = C_abc b_c."""
        d = self.dimension
        constants = np.zeros((d, d, d), dtype=np.int64)
        for a, x in enumerate(self.basis):
            for b, y in enumerate(self.basis):
                commutator = x @ y - y @ x
                constants[a, b] = self.vee(commutator)
                if np.any(self.hat(constants[a, b]) != commutator):
                    raise ValueError(
                        f"{self.name}: expected a basis closed under commutators, found that {a} and "
                        f"{b} leave its span; complete the basis"
                    )
        constants.setflags(write=False)
        return constants

    @cached_property
    def _stacked(self) -> Array:
        return np.stack(self.basis)

    @cached_property
    def _pivots(self) -> tuple[Array, Array]:
        """Row and column, for each basis element, of an entry where it alone is non-zero and equals one."""
        alone = (self._stacked == 1) & (np.count_nonzero(self._stacked, axis=0) == 1)
        # the rotation planes share their two entries with opposite signs, so the +1 of each is unique
        flat = alone.reshape(self.dimension, -1)
        if not flat.any(axis=1).all():
            raise ValueError(
                f"{self.name}: expected an entry 1 in each basis matrix where all the others are 0, found "
                f"none in some; choose such a basis"
            )
        rows, columns = np.unravel_index(flat.argmax(axis=1), (self.size, self.size))
        return np.asarray(rows), np.asarray(columns)

    def hat(self, X: Array) -> Array:
        """Matrix X_a b_a of the components X: (..., d) -> (..., size, size)."""
        X = np.asarray(X)
        return np.tensordot(X, _like(self._stacked, X), axes=(-1, 0))

    def vee(self, M: Array) -> Array:
        """Components of a matrix of the algebra, the inverse of `hat`: (..., size, size) -> (..., d)."""
        rows, columns = self._pivots
        return np.asarray(M)[..., rows, columns]

    def ad(self, X: Array) -> Array:
        """Matrix of Y -> [X, Y]: (..., d) -> (..., d, d); ad[c, b] = C_abc X_a."""
        X = np.asarray(X)
        return np.swapaxes(np.tensordot(X, _like(self.structure, X), axes=(-1, 0)), -1, -2)

    def coad(self, X: Array) -> Array:
        """Matrix of the dual action, <ad*_X s, Y> = -<s, [X, Y]>, so -(ad X)^T: (..., d) -> (..., d, d)."""
        return -np.swapaxes(self.ad(X), -1, -2)

    def bracket(self, X: Array, Y: Array) -> Array:
        """Components of the commutator [X, Y]: (..., d), (..., d) -> (..., d)."""
        product: Array = self.ad(X) @ np.asarray(Y)[..., None]
        return product[..., 0]

    def Ad(self, g: Array) -> Array:
        """Matrix of Y -> g Y g^-1 in components: (..., size, size) -> (..., d, d)."""
        g = np.asarray(g)
        moved = g[..., None, :, :] @ _like(self._stacked, g) @ self.inverse(g)[..., None, :, :]
        return np.swapaxes(self.vee(moved), -1, -2)

    def identity(self) -> Array:
        """The identity configuration, floats, (size, size)."""
        return np.eye(self.size)

    def inverse(self, g: Array) -> Array:
        """Inverse configuration [[1, 0], [-R^T r, R^T]]: (..., size, size) -> (..., size, size)."""
        transposed = np.swapaxes(self.rotation(g), -1, -2)
        return self.pose(-(transposed @ self.position(g)[..., None])[..., 0], transposed)

    def pose(self, position: Array, rotation: Array) -> Array:
        """Configuration from a position (..., space), a length, and a rotation matrix (..., space, space)."""
        position, rotation = np.asarray(position), np.asarray(rotation)
        batch = np.broadcast_shapes(position.shape[:-1], rotation.shape[:-2])
        g = np.zeros((*batch, self.size, self.size), dtype=np.result_type(position, rotation))
        g[..., 0, 0] = 1
        g[..., 1:, 0] = position
        g[..., 1:, 1:] = rotation
        return g

    def position(self, g: Array) -> Array:
        """Position r of a configuration: (..., size, size) -> (..., space), a length."""
        return np.asarray(g)[..., 1:, 0]

    def rotation(self, g: Array) -> Array:
        """Rotation matrix R, whose columns are the moving frame: (..., size, size) -> (..., space, space)."""
        return np.asarray(g)[..., 1:, 1:]


def _like(integers: Array, X: Array) -> Array:
    """Python integers beside symbolic expressions, which then stay exact and meet no numpy scalars."""
    return integers.astype(object) if X.dtype == object else integers


def _basis(space: int) -> tuple[Array, ...]:
    """Translations along e_1, ..., then rotations: of the plane, or about e_1, e_2, e_3 (v -> e_k x v)."""
    planes = [(0, 1)] if space == 2 else [(1, 2), (2, 0), (0, 1)]
    basis = []
    for i in range(space):
        element = np.zeros((space + 1, space + 1), dtype=np.int64)
        element[1 + i, 0] = 1
        basis.append(element)
    for i, j in planes:
        element = np.zeros((space + 1, space + 1), dtype=np.int64)
        element[1 + j, 1 + i], element[1 + i, 1 + j] = 1, -1
        basis.append(element)
    for element in basis:
        element.setflags(write=False)
    return tuple(basis)


SE2 = Group(
    name="SE(2)",
    space=2,
    basis=_basis(2),
    strain=("h1", "h2", "Pi"),
    twist=("v1", "v2", "Omega"),
    stress=("F1", "F2", "M"),
    wrench=("f1", "f2", "m"),
)
SE3 = Group(
    name="SE(3)",
    space=3,
    basis=_basis(3),
    strain=("h1", "h2", "h3", "Pi1", "Pi2", "Pi3"),
    twist=("v1", "v2", "v3", "Omega1", "Omega2", "Omega3"),
    stress=("F1", "F2", "F3", "M1", "M2", "M3"),
    wrench=("f1", "f2", "f3", "m1", "m2", "m3"),
)


def group_of(motion: str) -> Group:
    """The group of a motion: "planar" -> SE(2), "spatial" -> SE(3); ValueError for any other word."""
    groups = {"planar": SE2, "spatial": SE3}
    if motion not in groups:
        raise ValueError(f'motion: expected "planar" or "spatial", found {motion!r}; write one of the two')
    return groups[motion]
