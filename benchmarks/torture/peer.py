"""The method of lines in numpy with LSODA of scipy (benchmarks/peers/lines.py) on those cases that it can run.

It knows a straight rod at rest, clamped on the left and free on the right, with constant diagonal stiffness and
friction, on which nothing acts. Planar cases are run in space. As a user would, it doubles its cells, the tolerance of
its steps being a tenth of the accuracy, until two ends agree to the accuracy.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import odeint

from benchmarks.peers.lines import MOST_STEPS, spatial_rate
from benchmarks.torture.case import Case, resting
from benchmarks.torture.judge import (
    CUT_OFF,
    FAILED,
    REFUSED,
    SURVIVED,
    TIGHTER,
    Reference,
    Verdict,
    accuracy_of,
    mesh_of,
)
from benchmarks.torture.table import PEER
from geocosserat.discretisation.mesh import Array, Mesh, make_mesh
from geocosserat.discretisation.pose import march
from geocosserat.discretisation.sampling import along
from geocosserat.model.expressions import symbols
from geocosserat.model.records import Scene
from geocosserat.planning.gap import position_gap

CELLS = (32, 64, 128, 256, 512, 1024)


@dataclass(frozen=True)
class _Rod:
    """What the method of lines takes of a scene."""

    stiffness: tuple[float, ...]
    friction: tuple[float, ...]


def knows(scene: Scene) -> bool:
    """Whether it can run a scene at all."""
    model = scene.model
    straight = [float(i == 0) for i in range(model.group.dimension)]
    constant = not any(symbols(e) for matrix in (model.stiffness, model.friction) for row in matrix for e in row)
    if not (resting(scene) and constant and model.length == 1.0 and not model.frozen and not model.joined):
        return False
    if any(symbols(e) for e in model.reference) or (model.left.kind, model.right.kind) != ("clamped", "free"):
        return False
    rest = [float(along(e, {}, np.zeros(1))[0]) for e in model.reference]
    stiff, drag = _matrix(model.stiffness), _matrix(model.friction)
    diagonal = all(np.count_nonzero(a - np.diag(np.diag(a))) == 0 for a in (stiff, drag))
    return rest == straight and diagonal and bool(np.all(np.diag(drag) > 0.0))


def _matrix(entries: Any) -> Array:
    return np.array([[float(along(e, {}, np.zeros(1))[0]) for e in row] for row in entries])


def _rod(scene: Scene) -> _Rod:
    stiff, drag = (tuple(float(x) for x in np.diag(_matrix(m))) for m in (scene.model.stiffness, scene.model.friction))
    if len(stiff) == 3:  # the plane in space
        stiff, drag = ((a, b, b, c, c, c) for a, b, c in (stiff, drag))
    return _Rod(stiff, drag)


def _end(scene: Scene, cells: int) -> tuple[Mesh, Array]:
    """Positions at the end, of so many cells. Raises ArithmeticError where the integrator gives up."""
    mesh = make_mesh(1.0, cells, 1)
    strains = np.array([along(e, scene.model.parameters, mesh.u_point) for e in scene.start.strain])
    if len(strains) == 3:
        strains = np.stack([strains[0], strains[1], 0 * strains[0], 0 * strains[0], 0 * strains[0], strains[2]])
    rate, rtol = spatial_rate(_rod(scene), cells), accuracy_of(scene) / 10  # type: ignore[arg-type]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found, told = odeint(lambda y, _: rate(y), strains.T.ravel(), (0.0, scene.run.until), rtol=rtol, atol=rtol,
                             ml=11, mu=11, mxstep=MOST_STEPS, full_output=True)  # fmt: skip
    if told["message"] != "Integration successful.":
        raise ArithmeticError(told["message"])
    turn = found[-1].reshape(cells, 6).T
    position = march(mesh, turn, np.zeros(3), np.eye(3)).position
    return mesh, position[:, : scene.model.group.space]


def judge_peer(case: Case, known: Reference) -> Verdict:
    """What the method of lines makes of a case."""
    scene = case.read()
    if not knows(scene):
        return Verdict(case.name, PEER, REFUSED, "it has no such rods")
    accuracy, before = accuracy_of(scene), None
    for cells in CELLS:
        try:
            mesh, position = _end(scene, cells)
        except ArithmeticError as error:
            return Verdict(case.name, PEER, FAILED, f"at {cells} cells: {error}")
        if not np.isfinite(position).all():
            return Verdict(case.name, PEER, FAILED, "numbers that are not finite")
        if before is not None and position_gap(*before, mesh, position) <= accuracy:
            break
        before = mesh, position
    else:
        return Verdict(case.name, PEER, CUT_OFF, f"{CELLS[-1]} cells do not have the accuracy")
    if known.solution is None:
        return Verdict(case.name, PEER, SURVIVED)
    error = position_gap(mesh, position, mesh_of(scene, known.solution), known.solution.position[-1]) / accuracy
    if error > 1.0 + 1.0 / TIGHTER:
        return Verdict(case.name, PEER, FAILED, f"{error:.1f} times the error asked for", error=error)
    return Verdict(case.name, PEER, SURVIVED, error=error)
