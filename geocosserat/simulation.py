"""Simulating a scene: at its own setting, or finer and finer until two rods agree."""

import platform
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import Any

import numpy as np

from geocosserat.accuracy import DEFAULT_ACCURACY, Setting, ladder, position_gap, sees_all
from geocosserat.discretisation.mesh import Array, Mesh
from geocosserat.discretisation.sampling import frictionless, left_of_friction, stiffnesses
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.discretisation.structure import RodStructure
from geocosserat.kernel.library import KernelText
from geocosserat.kernel.load import load
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import switch_times
from geocosserat.model.records import Scene
from geocosserat.results.checkpoint import Keeper
from geocosserat.results.progress import progress
from geocosserat.results.solution import Solution
from geocosserat.solver.integrate import integrate
from geocosserat.solver.trajectory import Trajectory
from geocosserat.version import VERSION

MOST_NUMBERS = 2**28
"""States of all frames, in numbers: 2 GiB, and about as much again for the fields made of them."""


class Clock:
    """Seconds spent on each kind of work."""

    def __init__(self) -> None:
        self.seconds = dict.fromkeys(("derive", "compile", "plan", "solve"), 0.0)

    @contextmanager
    def __call__(self, kind: str) -> Iterator[None]:
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[kind] += time.perf_counter() - start

    def plan_ends(self) -> None:
        """Books what counted as solving so far as planning."""
        self.seconds["plan"] += self.seconds["solve"]
        self.seconds["solve"] = 0.0


@dataclass(frozen=True, eq=False)
class Attempt:
    """One simulation at one setting."""

    setting: Setting
    rod: SemiDiscrete
    kernel: NativeRod | NumpyRod
    trajectory: Trajectory
    text: KernelText


def tolerances(rod: SemiDiscrete, rtol: float, atol: float | None, energy: float) -> Array:
    """Absolute tolerance of each state entry, (size,): `atol` for strains, or rtol where none is given.

    Strains count by the displacement they make: stretches as they are, curvatures in units of 1 / length, and so
    for the carried pose. Energies, and stresses of frozen modes, count by the energy stored at the start, or that of
    bending by a radian.
    """
    strain = rtol if atol is None else atol
    length, group = float(rod.mesh.edges[-1]), rod.structure.group
    points = rod.mesh.elements * rod.mesh.degree
    turns = [strain] * group.translations + [strain / length] * group.rotations
    stresses = [strain * energy / length] * group.translations + [strain * energy] * group.rotations
    held = rod.structure.frozen
    turn = np.repeat([s if frozen else e for e, s, frozen in zip(turns, stresses, held, strict=True)], points)
    carried = [strain * length] * group.translations + [strain] * (rod.structure.carried - group.translations)
    return np.concatenate([turn, carried[: rod.structure.carried], [strain * energy] * 2])


def _unit_of_energy(scene: Scene, rod: SemiDiscrete, kernel: NativeRod | NumpyRod) -> float:
    """Energy stored at the start, or that of bending the softest way by a radian if that is more."""
    model, group = scene.model, scene.model.group
    stiff = stiffnesses(model)
    free = [i for i in range(group.dimension) if not rod.structure.frozen[i]]
    # bending by a radian, stretching by the length
    units = [
        stiff[i] * model.length ** (1 if i < group.translations else -1)
        for i in ([i for i in free if i >= group.translations] or free)
    ]
    return max(kernel.observe(0.0, rod.state)[2], min(units))


def chosen_setting(scene: Scene) -> Setting | None:
    """The setting the scene fixes, if it fixes any part of one."""
    run = scene.run
    if run.elements is None and run.degree is None and run.rtol is None and run.atol is None:
        return None
    rtol = run.rtol if run.rtol is not None else (run.accuracy or DEFAULT_ACCURACY) / 10
    return Setting(run.elements or 1, run.degree or 8, rtol)


def drift(rod: SemiDiscrete, trajectory: Trajectory) -> float:
    """How far an end strayed that is held in its place, though nothing but the march of poses says so; a length."""
    structure = rod.structure
    first, last = (rod.poses(trajectory.states[i], trajectory.times[i]).position for i in (0, -1))
    if structure.joined:
        return float(np.linalg.norm(last[-1] - last[0]))
    far = -1 if structure.base == "left" else 0
    kind = (structure.right if structure.base == "left" else structure.left).kind
    if kind == "free":
        return 0.0
    home = first[far] if rod.guide is None else rod.guide.at(trajectory.times[-1])[: first.shape[-1]]
    return float(np.linalg.norm(last[far] - home))


def switches_of(scene: Scene) -> tuple[float, ...]:
    """Instants at which a load of the scene switches."""
    model = scene.model
    loads = [end.force or () for end in (model.left, model.right)] + [
        end.torque or () for end in (model.left, model.right)
    ]
    loads += [end.twist or () for end in (model.left, model.right)]
    loads += [vector for effect in model.effects for vector in effect.values().values()]
    loads += [model.law.stress or ()] if model.law else []
    return tuple(t for load in loads for e in load for t in switch_times(e, scene.run.until, model.parameters))


def _check_room(frames: int, size: int) -> None:
    """Raises InputError if the states of all frames would not fit into memory."""
    if frames * size > MOST_NUMBERS:
        raise InputError(
            f"at most {MOST_NUMBERS} numbers in a solution",
            f"{frames} frames of {size} unknowns",
            "keep fewer frames, or compute on fewer elements",
            key="run.frames",
        )


class Simulation:
    """Simulates a scene at its setting, or at finer and finer ones until two agree; keeps checkpoints on the way."""

    def __init__(
        self,
        scene: Scene,
        backend: str,
        kernel_text: Callable[[RodStructure], KernelText],
        clock: Clock,
        keeper: Keeper,
    ) -> None:
        self.scene, self.backend, self.kernel_text, self.clock, self.keeper = scene, backend, kernel_text, clock, keeper

    def solve(self) -> tuple[Attempt, float | None]:
        """The attempt to report, and the estimate of its error relative to the length (None where there is none)."""
        chosen = chosen_setting(self.scene)
        if chosen is not None:
            return self._attempt(0, chosen, np.empty((0, 0))), None
        accuracy = self.scene.run.accuracy or DEFAULT_ACCURACY
        resumed = self.keeper.resumed
        before: tuple[Mesh, Array] | None = None
        estimate: float | None = None
        settings = ladder(accuracy)
        # of the model itself: rotations without friction keep a little of it
        modelled = left_of_friction(self.scene.run) if frictionless(self.scene.model) else 0.0
        for rung, setting in enumerate(settings):
            if resumed is not None and rung < resumed.rung:
                if rung == resumed.rung - 1 and resumed.before.size:
                    before = discretise(self.scene, setting.elements, setting.degree).mesh, resumed.before
                continue
            if setting is not settings[-1] and not sees_all(self.scene, setting, accuracy):
                continue  # too coarse to notice everything the scene varies along the rod
            self.clock.plan_ends()  # what was solved before this one turns out to be planning
            now = self._attempt(rung, setting, before[1] if before else np.empty((0, 0)))
            if not now.trajectory.reached:
                return now, None
            positions = now.rod.poses(now.trajectory.states[-1], now.trajectory.times[-1]).position
            if before is not None:
                gap = position_gap(*before, now.rod.mesh, positions)
                estimate = max(gap, drift(now.rod, now.trajectory)) / self.scene.model.length + modelled
                if estimate <= accuracy:
                    break
            before = now.rod.mesh, positions
        return now, estimate

    def _attempt(self, rung: int, setting: Setting, before: Array) -> Attempt:
        scene = self.scene
        with self.clock("derive"):
            rod = discretise(scene, setting.elements, setting.degree)
            text = self.kernel_text(rod.structure)
        with self.clock("compile"):
            kernel = load(text, rod, self.backend)
        times = np.linspace(0.0, scene.run.until, scene.run.frames)
        _check_room(scene.run.frames, len(rod.state))
        atol = tolerances(rod, setting.rtol, scene.run.atol, _unit_of_energy(scene, rod, kernel))
        done = self.keeper.begin(rung, rod.state, before)
        with self.clock("solve"), progress(scene.title) as report:
            if len(done) == len(times):  # stopped between this rung and the next
                trajectory = Trajectory(times, done, 0, 0, 0, True)
            else:
                rest = integrate(
                    kernel,
                    done[-1],
                    times[len(done) - 1 :],
                    scene.run.method or "cvode",
                    setting.rtol,
                    atol,
                    report,
                    self.keeper.frame,
                    switches_of(scene),
                )
                states = np.concatenate([done[:-1], rest.states])
                trajectory = replace(rest, times=times[: len(states)], states=states)
        return Attempt(setting, rod, kernel, trajectory, text)


def solution_of(scene: Scene, attempt: Attempt, estimate: float | None, clock: Clock) -> Solution:
    """The result of an attempt as the record that is kept: fields over time, with their provenance."""
    rod, kernel, trajectory = attempt.rod, attempt.kernel, attempt.trajectory
    seen = [kernel.observe(float(t), y) for t, y in zip(trajectory.times, trajectory.states, strict=True)]
    poses = rod.poses(trajectory.states, trajectory.times)
    accuracy = scene.run.accuracy
    # refined as far as it goes, and no two rods agree
    missed = chosen_setting(scene) is None and (estimate is None or estimate > (accuracy or DEFAULT_ACCURACY))
    return Solution(
        scene=scene.source,
        title=scene.title,
        motion=rod.structure.motion,
        length=scene.model.length,
        time=trajectory.times,
        u=rod.mesh.u,
        u_point=rod.mesh.u_point,
        position=poses.position,
        rotation=poses.rotation,
        angle=poses.angle,
        twist=np.stack([twist.T for twist, _, _ in seen]),
        turn=rod.turn(trajectory.states, trajectory.times).swapaxes(-1, -2),
        stress=np.stack([stress.T for _, stress, _ in seen]),
        energy=np.array([energy for _, _, energy in seen]),
        dissipated=trajectory.states[:, -2],
        work=trajectory.states[:, -1],
        method=scene.run.method or "cvode",
        elements=rod.mesh.elements,
        degree=rod.mesh.degree,
        unknowns=rod.unknowns,
        backend=kernel.backend,
        requested=accuracy,
        estimated=estimate,
        evaluations={"rate": trajectory.rates, "jacobian": trajectory.jacobians, "steps": trajectory.steps},
        seconds=clock.seconds,
        contents=_contents(scene, attempt),
        provenance=_provenance(attempt),
        reached=trajectory.reached and not missed,
        reason=trajectory.reason or ("the accuracy asked for was not reached by refinement" if missed else ""),
    )


def _contents(scene: Scene, attempt: Attempt) -> dict[str, Any]:
    """What the kernel of the scene consists of; whatever the scene does not call for is not in it."""
    model, structure = scene.model, attempt.rod.structure
    ends = (("left", model.left), ("right", model.right))
    loads = [f"load on the {side} end" for side, end in ends if end.force or end.torque]
    return {
        "fields": [*structure.state_names, *(["pose of the base"] if structure.carried else [])],
        "terms": [
            "elasticity",
            "friction",
            *(f"frozen {name}" for name in model.frozen),
            *(["active reference"] if structure.active else []),
            *dict.fromkeys(effect.kind for effect in model.effects),
            *(f"{end.kind} {side} end" for side, end in ends if end.kind != "free"),
            *loads,
            *(["joined ends"] if model.joined else []),
        ],
        "sees": structure.sight,
        "arguments": [c.name for c in structure.coefficients if not c.timed],
        "operations": dict(attempt.text.signature["operations"]),
    }


def _provenance(attempt: Attempt) -> dict[str, str]:
    return {
        "geocosserat": VERSION,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "platform": platform.platform(),
        "kernel": attempt.text.identity,
        "kernel_origin": attempt.text.origin,
        "rtol": repr(attempt.setting.rtol),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
    }
