"""Frozen modes of a rod held at both ends whose stress nothing determines: why such a rod was not computed.

A straight rod between two clamps that may not stretch carries any tension. The kernel takes the least one, by letting
frozen modes yield a little (sampling.SLACK). That is right where the rod stays as it is, but one that is pushed aside
does not move but by what it yields. It is looked for where a run was refused, or yielded by more than next to nothing.
"""

import numpy as np

from geocosserat.conductor.simulate import Attempt
from geocosserat.discretisation.mesh import Array
from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod

LITTLE = 1e6
"""A stress that what is frozen resists by less than so many times what it yields by, is determined by the latter."""

PART, ROUNDS = 0.1, 3
"""Of the largest stress, what is worth naming; of the inverse iteration."""


def yielded(attempt: Attempt) -> float:
    """How far aside a rod can go, relative to its length, by what its frozen modes have yielded to their stress: as an
    arc that is longer than its chord by that. Zero where none may yield."""
    rod, trajectory = attempt.rod, attempt.trajectory
    if not rod.structure.indeterminate:
        return 0.0
    points, length = len(rod.mesh.weight), float(rod.mesh.edges[-1])
    rows = slice(0, rod.structure.group.dimension * points)
    stresses = np.abs(trajectory.states[:, rows]).reshape(-1, rod.structure.group.dimension, points).max(axis=2)
    span = float(trajectory.times[-1] - trajectory.times[0])
    units = [1.0 if i < rod.structure.group.translations else length for i in range(rod.structure.group.dimension)]
    return float(np.sqrt((stresses * _slack(rod) * units).sum(axis=1).max() * span))


def _slack(rod: SemiDiscrete) -> Array:
    """By which each mode yields, zero for those that are not frozen."""
    structure = rod.structure
    names = [c.name for c in structure.at("uniform")]
    return np.array([
        rod.uniform[names.index(f"slack_{s}")] if held else 0.0
        for s, held in zip(structure.group.stress, structure.frozen, strict=True)
    ])  # fmt: skip


def undetermined(attempt: Attempt) -> str:
    """What is wrong with the frozen modes of a rod, and what to do; empty if nothing is, at its start and its end."""
    structure, trajectory = attempt.rod.structure, attempt.trajectory
    if not structure.indeterminate:
        return ""
    for i in (0, -1):
        modes = _free(attempt.rod, attempt.kernel, float(trajectory.times[i]), trajectory.states[i])
        if modes:
            group = structure.group
            stresses, strains = (" and ".join(names[k] for k in modes) for names in (group.stress, group.strain))
            return (
                f"expected constraints that determine the stress of each frozen mode, found a rod that is held at both "
                f"ends and so straight that {stresses} may have any value; take {strains} out of rod.frozen and give "
                f"it a stiffness, free an end, or begin with a rod that is bent"
            )
    return ""


def _free(rod: SemiDiscrete, kernel: NativeRod | NumpyRod, t: float, state: Array) -> list[int]:
    """Frozen modes with stresses that hardly move anything, but by what these modes yield."""
    structure, weight = rod.structure, rod.mesh.weight
    group, fixes, points = structure.group, rod.algebraic, len(weight)
    slack = _slack(rod)
    rows = slice(0, group.dimension * points)
    frozen = np.repeat(structure.frozen, points)

    def constraints(stress: Array) -> Array:
        """What stresses of frozen modes make of the constraints, where nothing else acts that depends on them."""
        made = np.empty_like(state)
        kernel.rate(t, np.where(fixes == 0.0, state, stress), made)
        return made

    stress, found = np.random.default_rng(0).standard_normal(len(state)) * fixes, np.empty_like(state)
    try:
        kernel.prepare(t, state)
        kernel.factor(0.0)  # leaves what moves as it is
        for _ in range(ROUNDS):
            kernel.solve(stress, found)
            stress = np.zeros_like(found)
            stress[rows] = np.where(frozen, found[rows], 0.0)
            stress /= np.abs(stress).max()
    except np.linalg.LinAlgError:
        return []
    answer = (constraints(stress) - constraints(np.zeros_like(stress)))[rows].reshape(-1, points)
    stresses = stress[rows].reshape(-1, points)
    resisted = abs(float((stresses * answer).sum(axis=0) @ weight))
    yielded = float((slack[:, None] * stresses**2).sum(axis=0) @ weight)
    if not resisted <= LITTLE * yielded:  # NaN too
        return []
    return [i for i, s in enumerate(stresses) if np.abs(s).max() > PART]
