"""The fields of a rod on a group, with what follows from phi' = phi E and d(phi)/dt = phi V alone.

How the turn changes in time is not put in: it is what makes the mixed derivatives of phi agree.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3, Array, Group
from geocosserat.referee.jets import Jets


class Motion(Jets):
    """A moving rod, on any group whose basis is given.

    turn, twist, stress (d,): fields, components in the moving frame. configuration (size, size): its matrix, of fields
    whose derivatives are those of the configuration. Rotations satisfy R^T R = 1, det R = 1.
    """

    def __init__(self, group: Group = SE3) -> None:
        super().__init__()
        self.group = group
        self.turn, self.twist = self.fields(group.strain), self.fields(group.twist)
        self.stress = self.fields(group.stress)
        self.configuration = self._configuration()
        slopes, rates = (self.configuration @ group.hat(x) for x in (self.turn, self.twist))
        for part in (group.position, group.rotation):
            self.law(part(self.configuration), u=part(slopes), t=part(rates))
        self.law(self.turn, t=self._compatible())

    def _configuration(self) -> Array:
        group = self.group
        position = self.array("r", group.space)
        rotation = self.array("R", group.space, group.space)
        self._turns(rotation, "q")
        return np.asarray(group.pose(position, rotation))

    def rigid_motion(self) -> Array:
        """(size, size) a constant element of the group, any: how the world may be moved."""
        rotation = self.constants("G", self.group.space, self.group.space)
        self._turns(rotation, "p")
        return np.asarray(self.group.pose(self.constants("g", self.group.space), rotation))

    def _turns(self, matrix: Array, name: str) -> None:
        """Constrains a matrix of fields to rotations: those of unit quaternions, or of cosine and sine."""
        q = np.array(sp.symbols(f"{name}0:{4 if len(matrix) == 3 else 2}"), dtype=object)
        values = rotation_of(q) if len(q) == 4 else np.array([[q[0], -q[1]], [q[1], q[0]]], dtype=object)
        self.bound(dict(zip(matrix.ravel(), values.ravel(), strict=True)), [dot(q, q) - 1])

    def _compatible(self) -> Array:
        """dE/dt from d(phi E)/dt = d(phi V)/du: of matrices, phi cancels and dE/dt = V' + E V - V E is left."""
        group = self.group
        E, V = group.hat(self.turn), group.hat(self.twist)
        return np.asarray(group.vee(group.hat(self.du(self.twist)) + E @ V - V @ E))

    @property
    def position(self) -> Array:
        """(space,) r, components in the world; a length."""
        return self.group.position(self.configuration)

    @property
    def rotation(self) -> Array:
        """(space, space) R, the frame in its columns."""
        return self.group.rotation(self.configuration)

    @property
    def frame(self) -> list[Array]:
        """e_1, e_2(, e_3), components in the world."""
        return list(self.rotation.T)

    def split(self, components: Array) -> tuple[Array, Array]:
        """Linear and angular part: h and Pi of the turn, v and Omega of the twist, F and M of the stress."""
        n = self.group.translations
        return components[:n], components[n:]

    def world(self, body: Array) -> Array:
        """The vector with these components in the moving frame."""
        return np.asarray(self.rotation @ body)

    def body(self, vector: Array) -> Array:
        """Components in the moving frame of a vector."""
        return np.asarray(self.rotation.T @ vector)

    @cached_property
    def wrench(self) -> Array:
        """(d,) what acts on a piece of the rod, per length, components in the moving frame.

        From the balance of force and moment of every piece: the resultants n = R F and m (in space R M) of the stress
        give n' + f = 0 and, about the origin, (m + r x n)' + l + r x f = 0. On a group other than SE(2) and SE(3) from
        the balance of power of every piece in all motions that change no shape: -S' - ad*_E S.
        """
        if self.group not in (SE2, SE3):
            return np.asarray(-self.du(self.stress) - self.group.coad(self.turn) @ self.stress)
        F, M = self.split(self.stress)
        turned = self.group is SE3
        n, m = self.world(F), self.world(M) if turned else M
        f = -self.du(n)
        couple = -self.du(m + cross(self.position, n)) - cross(self.position, f)
        return np.concatenate([self.body(f), self.body(couple) if turned else couple])


def rotation_of(q: Any) -> Array:
    """(3, 3) the rotation of a quaternion, real part first, times its squared length."""
    a, v = q[0], np.asarray(q[1:], dtype=object)
    return np.asarray(np.eye(3, dtype=int).astype(object) * (a * a - v @ v) + 2 * np.outer(v, v) + 2 * a * hat(v))


def cross(a: Any, b: Any) -> Array:
    """The vector product, of components or of vectors; of the plane its one component, (1,)."""
    if len(a) == 2:
        return np.array([a[0] * b[1] - a[1] * b[0]], dtype=object)
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], dtype=object)


def dot(a: Any, b: Any) -> Any:
    """The scalar product."""
    return sum(x * y for x, y in zip(a, b, strict=True))


def hat(a: Any) -> Array:
    """The matrix of a x."""
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]], dtype=object)


def epsilon() -> Array:
    """The antisymmetric symbol of three indices, (3, 3, 3), integers."""
    found = np.zeros((3, 3, 3), dtype=object)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[i, j, k], found[i, k, j] = 1, -1
    return found
