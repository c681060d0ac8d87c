"""Poses of the rod marched from its turn.

Gauss collocation of phi' = phi E in each element: order 2p at element ends, p + 1 inside, the order of the scheme
itself. In space the rotation over an element is orthogonal to round-off, because Gauss collocation keeps quadratic
invariants (Hairer, Lubich, Wanner, "Geometric Numerical Integration", section IV.2.1).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geocosserat.discretisation.mesh import Array, Mesh


@dataclass(frozen=True, eq=False)
class Poses:
    """position (..., nodes, space), a length; rotation (..., nodes, space, space), frame vectors in columns;
    angle (..., nodes) unwrapped, in the plane only."""

    position: Array
    rotation: Array
    angle: Array | None = None


def joined(parts: Sequence[Poses]) -> Poses:
    """Poses of successive frames as one."""
    angles = [part.angle for part in parts if part.angle is not None]
    return Poses(
        np.concatenate([part.position for part in parts]),
        np.concatenate([part.rotation for part in parts]),
        np.concatenate(angles) if angles else None,
    )


def cross_matrix(v: Array) -> Array:
    """The matrix of v x: (..., 3) -> (..., 3, 3)."""
    out = np.zeros((*v.shape, 3))
    for c in range(3):
        i, j = (c + 1) % 3, (c + 2) % 3
        out[..., j, i], out[..., i, j] = v[..., c], -v[..., c]
    return out


def plane_rotation(angle: Array) -> Array:
    """Rotation matrices of the plane: (...) -> (..., 2, 2)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)


def _relative(mesh: Mesh, turn: Array) -> tuple[Array, Array, Array | None]:
    """Per element, relative to its left end: (..., n, p+1, ...) rotation and position, and the angle in the plane."""
    table, half = mesh.reference, mesh.half
    planar = turn.shape[-1] == 3
    stretch = turn[..., :2] if planar else turn[..., :3]
    if planar:
        bend = turn[..., 2] * half[:, None]
        angle = bend @ table.running.T
        rotation = plane_rotation(angle)
        inside = plane_rotation(bend @ table.inner.T)
    else:
        angle = None
        p = mesh.degree
        hat = cross_matrix(turn[..., 3:] * half[:, None, None])
        system = np.einsum("qm,...qij->...qimj", table.values, hat) + np.einsum("qm,ij->qimj", table.slopes, np.eye(3))
        batch = system.shape[:-4]
        A = system[..., 1:, :].reshape(*batch, 3 * p, 3 * p)
        start = -system[..., 0, :].reshape(*batch, 3 * p, 3)
        rotation = np.empty((*batch, p + 1, 3, 3))
        rotation[..., 0, :, :] = np.eye(3)
        rotation[..., 1:, :, :] = np.linalg.solve(A, start).reshape(*batch, p, 3, 3).swapaxes(-1, -2)
        inside = np.einsum("qm,...mij->...qij", table.values, rotation)
    step = np.einsum("...qij,...qj->...qi", inside, stretch) * half[:, None, None]
    return rotation, np.einsum("mq,...qi->...mi", table.running, step), angle


def _products(steps: Array) -> Array:
    """Of the first one, the first two, ... of rotations (..., n, space, space); from pairs of them, so that no loop
    runs over elements."""
    n = steps.shape[-3]
    if n == 1:
        return steps
    even = _products(steps[..., : n - 1 : 2, :, :] @ steps[..., 1::2, :, :])
    out = np.empty_like(steps)
    out[..., 0, :, :], out[..., 1::2, :, :] = steps[..., 0, :, :], even
    out[..., 2::2, :, :] = even[..., : (n - 1) // 2, :, :] @ steps[..., 2::2, :, :]
    return out


def march(
    mesh: Mesh, turn: Array, position: Array, rotation: Array, angle: Array | None = None, end: str = "left"
) -> Poses:
    """Poses at the nodes, from the turn (..., d, points) and the pose of one end ("left" or "right").

    position (..., space), rotation (..., space, space), and in the plane also the angle (...), unwrapped.
    """
    n, p = mesh.elements, mesh.degree
    d = turn.shape[-2]
    space = 2 if d == 3 else 3
    local = np.moveaxis(turn, -2, -1).reshape(*turn.shape[:-2], n, p, d)
    relative, offset, gained = _relative(mesh, local)
    batch = turn.shape[:-2]
    R, r = np.empty((*batch, n + 1, space, space)), np.empty((*batch, n + 1, space))
    base = np.asarray(rotation)[..., None, :, :]
    if end == "left":
        R[..., 0, :, :], r[..., 0, :] = rotation, position
        R[..., 1:, :, :] = base @ _products(relative[..., p, :, :])
        r[..., 1:, :] = (R[..., :-1, :, :] @ offset[..., p, :, None])[..., 0]
        np.cumsum(r, axis=-2, out=r)
    else:
        R[..., n, :, :], r[..., n, :] = rotation, position
        R[..., n - 1 :: -1, :, :] = base @ _products(relative[..., ::-1, p, :, :].swapaxes(-1, -2))
        r[..., n - 1 :: -1, :] = -(R[..., n - 1 :: -1, :, :] @ offset[..., ::-1, p, :, None])[..., 0]
        np.cumsum(r[..., ::-1, :], axis=-2, out=r[..., ::-1, :])
    rotations = R[..., :-1, None, :, :] @ relative
    positions = r[..., :-1, None, :] + (R[..., :-1, None, :, :] @ offset[..., None])[..., 0]
    frames = np.concatenate([rotations[..., :p, :, :].reshape(*batch, n * p, space, space), R[..., -1:, :, :]], axis=-3)
    nodes_r = np.concatenate([positions[..., :p, :].reshape(*batch, n * p, space), r[..., -1:, :]], axis=-2)
    if gained is None:
        return Poses(nodes_r, frames)
    ends = np.concatenate([np.zeros((*batch, 1)), np.cumsum(gained[..., p], axis=-1)], axis=-1)
    shift = np.asarray(angle)[..., None] - (ends[..., -1:] if end == "right" else 0.0)
    ends = ends + shift
    inner = ends[..., :-1, None] + gained[..., :p]
    angles = np.concatenate([inner.reshape(*batch, n * p), ends[..., -1:]], axis=-1)
    # one angle for all: the frames agree with it to the last digit
    return Poses(nodes_r, plane_rotation(angles), angles)
