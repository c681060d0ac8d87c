"""Whether friction resists every motion that is left to a rod: where it does not, there is no velocity to be found."""

import numpy as np

from geocosserat.discretisation.mesh import Array, Mesh
from geocosserat.discretisation.pose import Poses
from geocosserat.discretisation.sampling import QUASI_STATIC, friction_of, frictionless
from geocosserat.model.errors import InputError
from geocosserat.model.records import RodModel

LEAST = 1e3 * QUASI_STATIC[0]
"""Drag of a motion, relative to that along the rod, below which only what replaces no friction resists it."""


def check_feasible(model: RodModel, mesh: Mesh, start: Poses) -> None:
    """Raises InputError if a rotation without friction leaves a motion that nothing resists.

    Only in space: in the plane a rod that turns is dragged sideways. There a straight rod may spin about its own axis,
    and one whose every mode but twist is frozen may do nothing else.
    """
    group = model.group
    if group.rotations == 1:
        return
    without = [group.twist[i] for i in frictionless(model)]
    if not without:
        return
    left = [name for name, held in zip(group.strain, model.held, strict=True) if not held]
    if left == ["Pi1"] and "Omega1" in without:
        raise InputError(
            "a friction that resists the one mode that is left",
            "none against Omega1",
            "give it one",
            key="rod.friction",
        )
    motions = _rigid_motions(model, start)
    if motions.size == 0:
        return
    friction = friction_of(model, mesh, QUASI_STATIC[0])
    drag = np.einsum("nik,nij,njl,n->kl", motions, friction, motions, mesh.mass)
    if np.linalg.eigvalsh(drag)[0] < LEAST * (mesh.mass @ friction[:, 0, 0]):
        raise InputError(
            "a friction that resists every motion of the whole rod",
            f"a way to turn that meets none (no friction against {', '.join(without)})",
            "give the rotation a friction, or hold an end",
            key="rod.friction",
        )


def _rigid_motions(model: RodModel, start: Poses) -> Array:
    """(nodes, 6, k) the twist at the nodes of the k motions that change no strain and that the ends allow."""
    ends = {0: model.left.kind, -1: model.right.kind} if not model.joined else {0: "free", -1: "free"}
    if {"clamped", "driven"} & set(ends.values()):
        return np.empty((0, 0, 0))
    pins = [n for n, kind in ends.items() if kind == "pinned"]
    R, length = start.rotation, model.length
    centre = start.position[pins[0]] if pins else start.position.mean(axis=0)
    axes = np.eye(3)
    if len(pins) == 2:
        chord = start.position[-1] - start.position[0]
        if np.linalg.norm(chord) > 1e-9 * length:
            axes = (chord / np.linalg.norm(chord))[:, None]
    arm = (start.position - centre) / length
    turning = np.cross(axes.T[None, :, :], arm[:, None, :]).swapaxes(1, 2)
    back = R.swapaxes(1, 2)
    spins = np.concatenate([back @ turning, back @ np.broadcast_to(axes / length, (len(R), *axes.shape))], axis=1)
    if pins:
        return spins
    shifts = np.concatenate([back, np.zeros_like(R)], axis=1)
    return np.concatenate([shifts, spins], axis=2)
