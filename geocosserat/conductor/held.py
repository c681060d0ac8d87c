"""Small motions of a rod that is held and rests, node by node: lambda drag u = the change of force by u.

The unknowns are the motions u of the nodes and, of frozen modes, the changes of their stress. So the ends stay where
they are held, frozen modes change nothing, and a friction may be zero: it makes the matrix of drag singular, no more.
"""

from dataclasses import dataclass

import numpy as np

from geocosserat.discretisation.mesh import Array
from geocosserat.discretisation.motions import strain_rates
from geocosserat.discretisation.quaternions import spun
from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod
from geocosserat.statics.pencil import Complex, growth
from geocosserat.statics.system import System

SLACK = 1e-11
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
        rod, kernel, system, drag = self.rod, self.kernel, self.system, self.drag
        linear = system.linear(x)
        mesh, structure = rod.mesh, rod.structure
        d, points = structure.group.dimension, mesh.elements * mesh.degree
        frozen = np.repeat(structure.frozen, points)
        state = system.state(x)
        A = strain_rates(mesh, structure.group, rod.turn(state))
        moving, free = _motions(rod)
        # what twists of the nodes do to the coordinates, which is square: so it is known what the nodes do
        makes = np.concatenate([A, _turns_of_base(rod, system, x)])
        scaled, natural = linear.basis.T / system.scale, system.scale[:, None] * linear.basis
        own, _, _ = kernel.observe(0.0, state)
        changes = linear.J + scaled @ _of_geometry(rod, own, len(makes)) @ natural
        twists = np.linalg.solve(scaled @ makes[:, moving], changes)[free[moving]]
        forces = _inverse_mobility(rod)[free][:, None] * twists
        # the coordinates, by motions of the nodes and changes of stress
        stresses = np.zeros((len(makes), int(frozen.sum())))
        stresses[np.flatnonzero(frozen), np.arange(stresses.shape[1])] = 1.0
        by_motions = makes[:, free].copy()
        by_motions[np.flatnonzero(frozen)] = 0.0
        by = scaled @ np.concatenate([by_motions, stresses], axis=1)
        K, M = np.zeros((by.shape[1], by.shape[1])), np.zeros((by.shape[1], by.shape[1]))
        n = int(free.sum())
        heavy = mesh.mass[:, None, None] * drag
        K[:n] = forces @ by
        K[:n, :n] -= _block_diagonal(heavy @ structure.group.ad(twist))[np.ix_(free, free)]
        K[n:, :n] = A[frozen][:, free]
        if structure.indeterminate:
            K[n:, n:] = -SLACK * np.diag(1.0 / system.scale[: d * points][frozen])
        M[:n, :n] = _block_diagonal(heavy)[np.ix_(free, free)]
        found, z = growth(K, M, rate)
        return found, linear.basis @ (by @ z)


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
    """(d nodes,) booleans: twists that the scheme has in the nodes, and of those which are free: the ends that are held
    return to where they belong, by twists of their own."""
    structure = rod.structure
    group, nodes = structure.group, rod.mesh.elements * rod.mesh.degree + 1
    moving, free = np.ones((nodes, group.dimension), dtype=bool), np.ones((nodes, group.dimension), dtype=bool)
    base = 0 if structure.base == "left" else -1
    for node, end in ((0, structure.left), (-1, structure.right)):
        held = {"clamped": group.dimension, "pinned": group.translations}.get(end.kind, 0)
        free[node, :held] = False
        if node == base:
            moving[node, :held] = False
    return moving.ravel(), free.ravel()


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


def _inverse_mobility(rod: SemiDiscrete) -> Array:
    """(d nodes,) mass times the friction of the kernel's rod, whose motions do not feel each other's."""
    structure = rod.structure
    names = [c.name for c in structure.at("uniform")]
    mobility = [rod.uniform[names.index(structure.mobility[i][i])] for i in range(structure.group.dimension)]
    found: Array = (rod.mesh.mass[:, None] / np.array(mobility)).ravel()
    return found


def _block_diagonal(blocks: Array) -> Array:
    n, d = blocks.shape[:2]
    found = np.zeros((n, d, n, d))
    found[np.arange(n), :, np.arange(n)] = blocks
    return found.reshape(n * d, n * d)
