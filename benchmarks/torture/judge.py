"""What came of a case, and whether that is right."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

import geocosserat
from benchmarks.torture.case import Case, floating, resting, sees_world
from geocosserat.algebra.exponential import rotation_from_vector
from geocosserat.discretisation.mesh import Mesh
from geocosserat.discretisation.quadrature import reference_element
from geocosserat.discretisation.sampling import along, stiffnesses
from geocosserat.model.errors import InputError
from geocosserat.model.records import Scene
from geocosserat.planning.gap import position_gap
from geocosserat.planning.settings import DEFAULT_ACCURACY
from geocosserat.results.solution import Array, Solution

SURVIVED, REFUSED, FAILED, CUT_OFF = OUTCOMES = ("survived", "refused", "failed", "cut off")
AUTO = "auto"
"""The program's own choice of a method."""

TIGHTER = 30.0
"""By how much the reference is more accurate than what is judged by it."""

LEDGER, LOOSER = 10.0, 100.0
"""What the ledger may lack, in accuracies; what errors may be that no plan controls, in tolerances of a step."""

ROUND_OFF = 256 * np.finfo(float).eps

AWAY: dict[str, Any] = {"planar": ([7.0, -3.0], 2.5), "spatial": ([7.0, -3.0, 5.0], [1.1, -2.0, 0.4])}
"""Where the scene is moved as a whole, in lengths of the rod and radians."""


@dataclass(frozen=True)
class Verdict:
    """What came of a case by a method. why: of a refusal or a failure. ledger: what the balance of energy lacks,
    relative to its largest term. rise: the largest rise of the energy of a rod on which nothing acts, between two
    frames, relative to what it had. error: over the one that was asked for. fell_back: whether the safe method took
    over. None where there is no such number."""

    case: str
    method: str
    outcome: str
    why: str = ""
    ledger: float | None = None
    rise: float | None = None
    error: float | None = None
    seconds: float = 0.0
    fell_back: bool = False


@dataclass(frozen=True, eq=False)
class Reference:
    """Where a case ends according to a run with tighter settings; `why` says why there is none."""

    solution: Solution | None
    why: str = ""


def accuracy_of(scene: Scene) -> float:
    """The error that a run may have, relative to the length."""
    run = scene.run
    if run.elements or run.degree or run.rtol:
        return LOOSER * (run.rtol or (run.accuracy or DEFAULT_ACCURACY) / 10)
    return run.accuracy or DEFAULT_ACCURACY


def reference(case: Case) -> Reference:
    """The case with tighter settings."""
    try:
        scene = case.read()
    except InputError as error:
        return Reference(None, str(error))
    changes = [f"run.frames={2}"]
    if scene.run.rtol is not None:
        changes.append(f"run.rtol={scene.run.rtol / TIGHTER!r}")
    else:
        changes.append(f"run.accuracy={accuracy_of(scene) / TIGHTER!r}")
    try:
        run = geocosserat.run(case.scene, settings=changes)
    except InputError as error:
        return Reference(None, str(error))
    return Reference(run.solution if run.reached else None, run.reason)


def judge(case: Case, method: str, known: Reference) -> Verdict:
    """Computes a case by a method, AUTO being the program's own choice, and looks at what comes of it."""
    changes = [] if method == AUTO else [f"run.method={method}"]
    try:
        run = geocosserat.run(case.scene, settings=changes)
    except InputError as error:
        return Verdict(case.name, method, REFUSED, str(error))
    scene, found = case.read(), run.solution
    accuracy = accuracy_of(scene)
    told: dict[str, Any] = {
        "seconds": sum(found.seconds.values()),
        "fell_back": bool(run.fields.get("fell_back")),
    }
    if not _finite(found):
        return Verdict(case.name, method, FAILED, "numbers that are not finite", **told)
    if not run.reached:
        outcome, why = (REFUSED, run.reason) if run.reason else (FAILED, "not reached, and no reason")
        return Verdict(case.name, method, outcome, why, **told)
    told["ledger"] = unbalanced(scene, found)
    wrong = []
    if told["ledger"] > LEDGER * accuracy:
        wrong.append(f"the ledger lacks {told['ledger']:.1e}")
    if resting(scene):
        told["rise"], allowed = rise(found), accuracy
        if method == "safe":
            allowed = ROUND_OFF * noise(scene, found)
        if told["rise"] > allowed:
            wrong.append(f"the energy grows by {told['rise']:.1e} of it")
    if floating(scene) and scene.run.elements is None:  # on a mesh that is too coarse it does not
        left = unmet(scene, found)
        if left > LEDGER * accuracy:
            wrong.append(f"the drag of a free rod adds up to {left:.1e} of it")
    if known.solution is not None:
        told["error"] = apart(scene, found, known.solution) / accuracy
        if told["error"] > 1.0 + 1.0 / TIGHTER:
            wrong.append(f"{told['error']:.1f} times the error asked for")
    if method == AUTO and not sees_world(scene):
        moved = _moved(case, scene, changes, found)
        if moved > 2.0 * accuracy:
            wrong.append(f"moved as a whole it ends {moved:.1e} of its length elsewhere")
    return Verdict(case.name, method, FAILED if wrong else SURVIVED, "; ".join(wrong), **told)


def _finite(found: Solution) -> bool:
    arrays = (found.position, found.rotation, found.twist, found.turn, found.stress, found.energy, found.dissipated)
    return all(bool(np.isfinite(a).all()) for a in (*arrays, found.work))


def unbalanced(scene: Scene, found: Solution) -> float:
    """What the balance of energy lacks, relative to its largest term, to what there is, or to a bit of a bend."""
    stored, dissipated, work = (float(x[-1] - x[0]) for x in (found.energy, found.dissipated, found.work))
    group = scene.model.group
    stiff = stiffnesses(scene.model)[group.translations :]
    scale = max(abs(stored), abs(dissipated), abs(work), 1e-3 * min(stiff) / scene.model.length)
    return abs(stored + dissipated - work) / scale


def rise(found: Solution) -> float:
    """The largest rise of the energy from frame to frame, relative to the energy at the start."""
    up = np.diff(found.energy, prepend=found.energy[0]).max()
    return float(max(up, 0.0) / max(found.energy[0], np.finfo(float).tiny))


def noise(scene: Scene, found: Solution) -> float:
    """What rounding the strains may do to the energy, in units of the least relative number and of the energy at the
    start."""
    weight = mesh_of(scene, found).weight
    power = np.abs(found.stress * found.turn).sum(axis=-1) @ weight
    return float(power.max() / max(found.energy[0], np.finfo(float).tiny)) + 1.0


def mesh_of(scene: Scene, found: Solution) -> Mesh:
    """The mesh of a solution, as its nodes have it."""
    return Mesh(found.u[:: found.degree], reference_element(found.degree), scene.model.joined)


def unmet(scene: Scene, found: Solution) -> float:
    """The sum of the drag of all nodes, relative to the largest sum of its absolute values."""
    mesh, model = mesh_of(scene, found), scene.model
    n = model.group.translations
    friction = np.array([[along(e, model.parameters, mesh.u) for e in row[:n]] for row in model.friction[:n]])
    drag = np.einsum("abn,tnb->tna", friction, found.twist[..., :n])
    world = np.einsum("tnaf,tnf->tna", found.rotation, drag)
    total = np.linalg.norm(np.einsum("n,tna->ta", mesh.mass, world), axis=-1)
    size = np.einsum("n,tn->t", mesh.mass, np.linalg.norm(world, axis=-1))
    return float(total.max() / max(size.max(), np.finfo(float).tiny))


def apart(scene: Scene, one: Solution, other: Solution) -> float:
    """How far the rods are apart at the end, relative to the length."""
    gap = position_gap(mesh_of(scene, one), one.position[-1], mesh_of(scene, other), other.position[-1])
    return gap / scene.model.length


def _moved(case: Case, scene: Scene, changes: list[str], found: Solution) -> float:
    """How far the case ends from where it should, moved as a whole; relative to the length."""
    place, turn = AWAY[found.motion]
    place = [x * scene.model.length for x in place]
    key = "angle" if found.motion == "planar" else "rotation"
    again = geocosserat.run(case.scene, settings=[*changes, f"start.position={place}", f"start.{key}={turn}"])
    if not again.reached:
        return math.inf
    if isinstance(turn, float):
        rotation: Array = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    else:
        rotation = rotation_from_vector(np.array(turn))
    expected = found.position[-1] @ rotation.T + np.array(place)
    there = again.solution
    return position_gap(mesh_of(scene, found), expected, mesh_of(scene, there), there.position[-1]) / scene.model.length
