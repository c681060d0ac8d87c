"""The rod at one Gauss point and at one node, symbolically.

The scheme applies two linear maps between nodes and points, which are the same for every rod; all that
a model decides happens at a single point or node. These are the expressions that code is generated from.
Whole-rod expressions are never formed.

With U and W the slope and the value of the twist at a Gauss point (both (d,)), E the turn and S the stress:

    strain rate   U + ad_E W                       compatibility
    pull          (ad_E)^T S                       what the stress does through the turning of the frame
    tangent       T = dS/dE,  P = d(pull)/dE
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import Group
from geocosserat.discretisation.structure import ONE, ZERO, Matrix, RodStructure

Named = Mapping[str, sp.Expr]


@dataclass(frozen=True)
class Pointwise:
    """Named expressions, component by component (1-based in the names).

    stress: F1, ..., in terms of the turn and coefficients
    pull: pull_i, in terms of the turn and the stress
    strain_rate: rate_i, in terms of the turn, slope_i (of the twist) and value_i
    velocity: v1, ... in terms of drive_i (force density that friction balances) and mobility
    energy: energy, elastic energy density, in terms of the turn and the stress
    advection: advection_i_j = d rate_i / d E_j at fixed twist, in terms of value_i
    bracket: ad_i_j, the matrix of ad_E
    pose: position and angle, or position and quaternion, of a carried frame
    carry: rate_i of the pose, from the twist (components v1, ... in the moving frame)
    spin: spin_i_j, the rotation (a vector in the moving frame) that a change of pose entry j makes
    """

    group: Group
    turn: tuple[sp.Symbol, ...]
    stress: Named
    pull: Named
    strain_rate: Named
    velocity: Named
    energy: Named
    advection: Named
    bracket: Named
    pose: tuple[sp.Symbol, ...]
    carry: Named
    spin: Named


def _symbols(stem: str, d: int) -> np.ndarray:
    return np.array([sp.Symbol(f"{stem}_{i + 1}") for i in range(d)], dtype=object)


def _entry(name: str) -> sp.Expr:
    return sp.Integer(0) if name == ZERO else sp.Integer(1) if name == ONE else sp.Symbol(name)


def _matrix(names: Matrix) -> np.ndarray:
    return np.array([[_entry(name) for name in row] for row in names], dtype=object)


def _named(stem: str, matrix: np.ndarray) -> dict[str, sp.Expr]:
    return {f"{stem}_{i + 1}_{j + 1}": matrix[i, j] for i, j in np.ndindex(matrix.shape) if matrix[i, j] != 0}


def _pose(group: Group) -> tuple[tuple[sp.Symbol, ...], Named, Named]:
    """A frame carried along with a twist: phi_dot = phi V in position and angle, or position and quaternion.

    The rotation of a quaternion divides by its squared norm, so a drifting norm turns nothing.
    """
    twist = [sp.Symbol(name) for name in group.twist]
    if group.rotations == 1:
        pose = sp.symbols("pose_x pose_y pose_angle")
        c, s = sp.cos(pose[2]), sp.sin(pose[2])
        rates = [c * twist[0] - s * twist[1], s * twist[0] + c * twist[1], twist[2]]
        return pose, {f"rate_{i + 1}": e for i, e in enumerate(rates)}, {"spin_1_3": sp.Integer(1)}
    pose = sp.symbols("pose_x pose_y pose_z pose_a pose_b pose_c pose_d")
    a, b, c, d = pose[3:]
    norm = a * a + b * b + c * c + d * d
    v, w = twist[:3], twist[3:]
    q = np.array([b, c, d], dtype=object)
    # v turned by the quaternion: v + 2 q x (q x v + a v) / norm
    inner = np.cross(q, v) + a * np.array(v, dtype=object)
    moved = np.array(v, dtype=object) + 2 * np.cross(q, inner) / norm
    turned = [-(q @ w) / 2, *((a * np.array(w, dtype=object) + np.cross(q, w)) / 2)]
    # twice the vector part of conj(q) dq / norm
    columns = [[-b, a, d, -c], [-c, -d, a, b], [-d, c, -b, a]]
    spin = {f"spin_{i + 1}_{j + 4}": 2 * e / norm for i, row in enumerate(columns) for j, e in enumerate(row)}
    return pose, {f"rate_{i + 1}": e for i, e in enumerate([*moved, *turned])}, spin


def pointwise(structure: RodStructure) -> Pointwise:
    """The pointwise expressions of a rod with this structure."""
    group = structure.group
    d = group.dimension
    turn = np.array([sp.Symbol(name) for name in group.strain], dtype=object)
    stress = np.array([sp.Symbol(name) for name in group.stress], dtype=object)
    slope, value, drive = _symbols("slope", d), _symbols("value", d), _symbols("drive", d)
    strain = turn - np.array([_entry(name) for name in structure.reference], dtype=object)
    law = _matrix(structure.stiffness) @ strain
    ad = group.ad(turn)
    pose, carry, spin = _pose(group)
    return Pointwise(
        group=group,
        turn=tuple(turn),
        stress=dict(zip(group.stress, law, strict=True)),
        pull={f"pull_{i + 1}": e for i, e in enumerate(-(group.coad(turn) @ stress))},
        strain_rate={f"rate_{i + 1}": e for i, e in enumerate(slope + ad @ value)},
        velocity=dict(zip(group.twist, _matrix(structure.mobility) @ drive, strict=True)),
        energy={"energy": sp.Rational(1, 2) * (strain @ stress)},
        # d(ad_E W)/dE = -ad_W
        advection=_named("advection", -group.ad(value)),
        bracket=_named("ad", ad),
        pose=pose,
        carry=carry,
        spin=spin,
    )
