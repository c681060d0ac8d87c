"""The rod at one Gauss point and at one node, symbolically.

The scheme applies two linear maps between nodes and points, which are the same for every rod; all that
a model decides happens at a single point or node. These are the expressions that code is generated from.
Whole-rod expressions are never formed.

With U and W the slope and the value of the twist at a Gauss point (both (d,)), E the turn and S the stress:

    strain rate   U + ad_E W                       compatibility
    pull          (ad_E)^T S                       what the stress does through the turning of the frame
    tangent       T = dS/dE,  P = d(pull)/dE
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import Group
from geocosserat.discretisation.material import entries, entry, formula, material
from geocosserat.discretisation.structure import RodStructure
from geocosserat.model.expressions import Expression, Number

Named = Mapping[str, sp.Expr]


@dataclass(frozen=True)
class Pointwise:
    """Named expressions, component by component (1-based in the names).

    state: what the state holds at a point: the turn, of frozen modes the stress (their turn is the reference); then the
    stress of viscous modes
    turn: turn_i, in terms of the state, of frozen modes the reference
    stress: F1, ... of the modes that are free and not viscous, in terms of the state and coefficients
    pull: pull_i, in terms of the state and the stress
    strain_rate: rate_i, in terms of the state, slope_i (of the twist) and value_i; for frozen modes what must vanish
    gap: gap_i, what must vanish of viscous modes (counted by themselves): their stress by its law, in terms of the
    state and rate_i, less the one in the state
    velocity: v1, ... in terms of drive_i (force density that friction balances) and mobility; slip_i, relative to
    the medium, and medium_i as a name, if the medium moves
    energy: energy, elastic energy density, in terms of the state and the stress
    supply: power density of the reference that moves, in terms of the stress, or of a law that changes in time
    loss: power density of the part of the stress that stores nothing, in terms of the state and rate_i
    advection: advection_i_j = d rate_i / d state_j at fixed twist, in terms of value_i
    bracket: ad_i_j, the matrix of ad_E
    surroundings: wrench_i and medium_i (not the zeros), in terms of coefficients and what is seen
    own: own_i, the part of the wrench whose work is a loss of the rod (not the zeros), likewise
    loads, twists: load_i and twist_i of the left and of the right end, likewise
    pose: position and angle, or position and quaternion, of a carried frame
    carry: rate_i of the pose, from the twist (components v1, ... in the moving frame)
    shift: shift_i_j, the small motion (rotation, then translation, in the moving frame) that a change of pose entry j
    makes
    """

    group: Group
    state: tuple[sp.Symbol, ...]
    turn: Named
    stress: Named
    pull: Named
    strain_rate: Named
    gap: Named
    velocity: Named
    energy: Named
    supply: Named
    loss: Named
    advection: Named
    bracket: Named
    surroundings: Named
    own: Named
    loads: tuple[Named, Named]
    twists: tuple[Named, Named]
    pose: tuple[sp.Symbol, ...]
    carry: Named
    shift: Named


def _symbols(stem: str, d: int) -> np.ndarray:
    return np.array([sp.Symbol(f"{stem}_{i + 1}") for i in range(d)], dtype=object)


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
        shift = {"shift_1_3": sp.Integer(1), "shift_2_1": c, "shift_2_2": s, "shift_3_1": -s, "shift_3_2": c}
        return pose, {f"rate_{i + 1}": e for i, e in enumerate(rates)}, shift
    pose = sp.symbols("pose_x pose_y pose_z pose_a pose_b pose_c pose_d")
    a, b, c, d = pose[3:]
    norm = a * a + b * b + c * c + d * d
    v, w = twist[:3], twist[3:]
    q = np.array([b, c, d], dtype=object)

    def turned(vector: np.ndarray, sign: int) -> np.ndarray:
        """The vector turned by the quaternion, or back: v + 2 q x (q x v + a v) / norm."""
        return np.asarray(vector + 2 * np.cross(q, np.cross(q, vector) + sign * a * vector) / norm)

    moved = turned(np.array(v, dtype=object), 1)
    spun = [-(q @ w) / 2, *((a * np.array(w, dtype=object) + np.cross(q, w)) / 2)]
    # twice the vector part of conj(q) dq / norm
    columns = [[-b, a, d, -c], [-c, -d, a, b], [-d, c, -b, a]]
    shift = {f"shift_{i + 1}_{j + 4}": 2 * e / norm for i, row in enumerate(columns) for j, e in enumerate(row)}
    for j, axis in enumerate(np.eye(3, dtype=int).astype(object)):
        seen = turned(np.array([sp.Integer(x) for x in axis], dtype=object), -1)
        shift |= {f"shift_{i + 4}_{j + 1}": e for i, e in enumerate(seen)}
    return pose, {f"rate_{i + 1}": e for i, e in enumerate([*moved, *spun])}, shift


def _formulas(stem: str, formulas: Iterable[Expression]) -> Named:
    """Formulas of the structure as symbolic ones, the zeros left out."""
    return {f"{stem}_{i}": formula(e) for i, e in enumerate(formulas, start=1) if e != Number(0.0)}


def pointwise(structure: RodStructure) -> Pointwise:
    """The pointwise expressions of a rod with this structure."""
    group, frozen, viscous = structure.group, structure.frozen, structure.viscous
    d = group.dimension
    state = [sp.Symbol(name) for name in structure.state_names]
    rest = [entry(name) for name in structure.reference]
    turn = np.array([r if held else s for s, r, held in zip(state[:d], rest, frozen, strict=True)], dtype=object)
    stress = np.array([sp.Symbol(name) for name in group.stress], dtype=object)
    slope, value, drive = _symbols("slope", d), _symbols("value", d), _symbols("drive", d)
    made_of = material(structure, turn, stress)
    given = [held or here for held, here in zip(frozen, viscous, strict=True)]  # by the state
    gaps = (e - s for e, s, here in zip(made_of.stress, stress, viscous, strict=True) if here)
    ad = group.ad(turn)
    rates = slope + ad @ value
    moving = np.array([entry(name) for name in structure.reference_rate], dtype=object)
    # d(ad_E W)/dE = -ad_W, and frozen modes do not change
    advection = -group.ad(value) * np.array([0 if held else 1 for held in frozen], dtype=object)
    for i in (i for i, held in enumerate(frozen) if held):
        rates[i] -= moving[i]
        if structure.indeterminate:
            slack = sp.Symbol(f"slack_{group.stress[i]}")
            rates[i] -= slack * stress[i]
            advection[i, i] -= slack
    slip = entries(structure.mobility) @ drive
    velocity = dict(zip(group.twist, slip, strict=True))
    if structure.dragged:
        velocity = {f"slip_{i}": e for i, e in enumerate(slip, start=1)}
        for i, (name, medium) in enumerate(zip(group.twist, structure.medium, strict=True), start=1):
            drift = sp.Integer(0) if medium == Number(0.0) else sp.Symbol(f"medium_{i}")
            velocity[name] = sp.Symbol(f"slip_{i}") + drift
    pose, carry, shift = _pose(group)
    return Pointwise(
        group=group,
        state=tuple(state),
        turn={f"turn_{i + 1}": e for i, e in enumerate(turn)},
        stress={name: e for name, e, known in zip(group.stress, made_of.stress, given, strict=True) if not known},
        pull={f"pull_{i + 1}": e for i, e in enumerate(-(group.coad(turn) @ stress))},
        strain_rate={f"rate_{i + 1}": e for i, e in enumerate(rates)},
        gap={f"gap_{i}": e for i, e in enumerate(gaps, start=1)},
        velocity=velocity,
        energy={"energy": made_of.energy},
        supply={} if made_of.supply is None else {"supply": made_of.supply},
        loss={} if made_of.loss is None else {"loss": made_of.loss},
        advection=_named("advection", advection),
        bracket=_named("ad", ad),
        surroundings={**_formulas("wrench", structure.wrench), **_formulas("medium", structure.medium)},
        own=_formulas("own", structure.own),
        loads=(_formulas("load", structure.left.load), _formulas("load", structure.right.load)),
        twists=(_formulas("twist", structure.left.twist), _formulas("twist", structure.right.twist)),
        pose=pose,
        carry=carry,
        shift=shift,
    )
