"""Small motions of a rod that is held and rests, node by node: lambda drag u = the change of force by u.

The unknowns are the motions u of the nodes and, of frozen modes, the changes of their stress. So the ends stay where
they are held, frozen modes change nothing, and a friction may be zero: it makes the matrix of drag singular, no more.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lstsq

from geocosserat.discretisation.mesh import Array
from geocosserat.discretisation.motions import strain_rates
from geocosserat.discretisation.quaternions import spun
from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod
from geocosserat.statics.pencil import Complex, growth
from geocosserat.statics.system import System

SLACK = 1e-13
"""How much frozen modes yield between two held ends, in natural sizes, so that their stress is unique."""


@dataclass(frozen=True, eq=False)
class Held:
    """A rod that is held, with friction that is the same for all its motions; drag (nodes, d, d): its own. driven: it
    has a clamp in place of an end that is driven."""

    rod: SemiDiscrete
    kernel: NativeRod | NumpyRod
    system: System
    drag: Array
    driven: bool

    def spectrum(self, x: Array, twist: Array, rate: float) -> tuple[Complex, Complex]:
        """Growth rates (k,) of small motions about the state of rest x, the fastest growing first, and the motions
        (n, k) in its coordinates. twist (nodes, d): how it moves as a whole; rate: about that of the slowest motion."""
        rod, system = self.rod, self.system
        mesh, structure, linear, state = rod.mesh, rod.structure, system.dense(x), system.state(x)
        d, points = structure.group.dimension, mesh.elements * mesh.degree
        frozen = np.repeat(structure.frozen, points)
        nodes = slice(0, -1) if structure.joined else slice(None)  # joined ends are one node
        A = strain_rates(mesh, structure.group, rod.turn(state))
        if structure.joined:
            A[:, :d] += A[:, -d:]
            A = A[:, :-d]
        moving, free = (part[nodes].ravel() for part in _motions(rod))
        makes = np.concatenate([A, _turns_of_base(rod, system, x)[:, : A.shape[1]]])
        scaled, natural = linear.basis.T / system.scale, system.scale[:, None] * linear.basis
        heavy = _block_diagonal((mesh.mass[:, None, None] * self.drag)[nodes])
        # what the nodes do as the coordinates change
        own, _, _ = self.kernel.observe(0.0, state)
        changes = linear.J + scaled @ _of_geometry(rod, own, len(makes)) @ natural
        rigid = _rigid(A, d) if structure.joined else np.empty((A.shape[1], 0))
        resistance = _resistance(rod)[nodes].ravel()
        twists = _solved(scaled @ makes[:, moving], changes, (resistance[:, None] * rigid).T)[free[moving]]
        # the coordinates, by motions of the nodes and changes of stress
        by_motions, by_stress = makes[:, free].copy(), np.zeros((len(makes), int(frozen.sum())))
        by_motions[np.flatnonzero(frozen)] = 0.0
        by_stress[np.flatnonzero(frozen), np.arange(by_stress.shape[1])] = 1.0
        by = scaled @ np.concatenate([by_motions, by_stress], axis=1)
        n, m, k = int(free.sum()), by.shape[1], rigid.shape[1]
        K, M = np.zeros((m + k, m + k)), np.zeros((m + k, m + k))
        K[:n, :m] = resistance[free][:, None] * twists @ by
        K[:n, :n] -= (heavy @ _block_diagonal(structure.group.ad(twist[nodes])))[np.ix_(free, free)]
        K[n:m, :n] = A[frozen][:, free]
        if structure.indeterminate:
            K[n:m, n:m] = -SLACK * np.diag(1.0 / system.scale[: d * points][frozen])
        # nothing pushes a closed rod as a whole, so it does not move as a whole
        K[:n, m:] = (heavy @ rigid)[free]
        K[m:, :n] = K[:n, m:].T
        M[:n, :n] = heavy[np.ix_(free, free)]
        found, z = growth(K, M, rate)
        return found, linear.basis @ (by @ z[:m])


def _rigid(A: Array, d: int) -> Array:
    """(d nodes, d) the motions of a closed rod as a whole, which do not change its turn."""
    found: Array = np.linalg.svd(A)[2][-d:].T
    return found


def _solved(makes: Array, changes: Array, balance: Array) -> Array:
    """The twists that make the changes; of a closed rod those that push it nowhere."""
    if not len(balance):
        return np.linalg.solve(makes, changes).astype(np.float64)
    nothing = np.zeros((len(balance), changes.shape[1]))
    least: Array = lstsq(np.concatenate([makes, balance]), np.concatenate([changes, nothing]))[0]
    return least


def _of_geometry(rod: SemiDiscrete, twist: Array, size: int) -> Array:
    """(size, size) what the rates of the turn lose as the turn changes, for twists (d, nodes) that stay: ad_V of it."""
    mesh, structure = rod.mesh, rod.structure
    n, p, d = mesh.elements, mesh.degree, structure.group.dimension
    local = twist[:, np.arange(n)[:, None] * p + np.arange(p + 1)]
    ad = structure.group.ad((local @ mesh.reference.values.T).reshape(d, n * p).T)
    found = np.zeros((size, size))
    points = np.arange(n * p)
    for i in range(d):
        for j in range(d):
            if not structure.frozen[j]:
                found[i * n * p + points, j * n * p + points] = ad[:, i, j]
    return found


def _motions(rod: SemiDiscrete) -> tuple[Array, Array]:
    """(nodes, d) booleans: twists that the scheme has in the nodes, and of those which are free: the ends that are held
    return to where they belong, by twists of their own."""
    structure = rod.structure
    group, nodes = structure.group, rod.mesh.elements * rod.mesh.degree + 1
    moving, free = np.ones((nodes, group.dimension), dtype=bool), np.ones((nodes, group.dimension), dtype=bool)
    base = 0 if structure.base == "left" else -1
    for node, end in ((0, structure.left), (-1, structure.right)) if not structure.joined else ():
        held = {"clamped": group.dimension, "pinned": group.translations}.get(end.kind, 0)
        free[node, :held] = False
        if node == base:
            moving[node, :held] = False
    return moving, free


def _turns_of_base(rod: SemiDiscrete, system: System, x: Array) -> Array:
    """(k, d nodes) the rates of what the coordinates have of the pose of a pinned base, by twists of the nodes."""
    structure, mesh = rod.structure, rod.mesh
    group, nodes = structure.group, mesh.elements * mesh.degree + 1
    k = len(x) - group.dimension * mesh.elements * mesh.degree
    rows = np.zeros((k, nodes, group.dimension))
    base = 0 if structure.base == "left" else -1
    if k == 1:
        rows[0, base, 2] = 1.0
    elif k:
        rows[:, base, 3:] = np.stack([spun(x[-4:], axis) / 2 for axis in np.eye(3)], axis=1)
    return rows.reshape(k, nodes * group.dimension)


def _resistance(rod: SemiDiscrete) -> Array:
    """(nodes, d) mass times the friction of the kernel's rod, whose motions do not feel each other's."""
    structure = rod.structure
    names = [c.name for c in structure.at("uniform")]
    mobility = [rod.uniform[names.index(structure.mobility[i][i])] for i in range(structure.group.dimension)]
    found: Array = rod.mesh.mass[:, None] / np.array(mobility)
    return found


def _block_diagonal(blocks: Array) -> Array:
    n, d = blocks.shape[:2]
    found = np.zeros((n, d, n, d))
    found[np.arange(n), :, np.arange(n)] = blocks
    return found.reshape(n * d, n * d)
