"""The result of a simulation, or a state of rest, as the record that is kept."""

import platform
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np

from geocosserat.conductor.rescue import SAFE
from geocosserat.conductor.search import Found
from geocosserat.conductor.simulate import Clock
from geocosserat.discretisation.mesh import Array
from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.discretisation.structure import RodStructure
from geocosserat.kernel.library import KernelText
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod
from geocosserat.model.records import Scene
from geocosserat.results.solution import Solution
from geocosserat.version import VERSION

if TYPE_CHECKING:
    from geocosserat.conductor.standing import Standing  # needs linear algebra that a run does without


def solution_of(scene: Scene, found: Found, clock: Clock) -> Solution:
    """The result of an attempt as the record that is kept: fields over time, with their provenance."""
    attempt = found.attempt
    trajectory = attempt.trajectory
    return Solution(
        **_fields(scene, attempt.rod, attempt.kernel, attempt.text, trajectory.times, trajectory.states),
        method=attempt.setting.method if attempt.fell_back is None else SAFE,
        requested=scene.run.accuracy,
        estimated=found.estimate,
        evaluations={"rate": trajectory.rates, "jacobian": trajectory.jacobians, "steps": trajectory.steps},
        seconds=clock.seconds,
        provenance=_provenance(attempt.text, {"rtol": repr(attempt.setting.rtol)}),
        reached=found.reached,
        reason=found.reason,
        plan=found.plan,
        fell_back=None if attempt.fell_back is None else attempt.fell_back.fields,
    )


def rest_of(standing: "Standing", x: Array, estimated: float | None, rounds: int, clock: Clock) -> Solution:
    """A state of rest as the record that is kept: fields at one time, with their provenance."""
    rod, state = standing.rod, standing.system.state(x)
    return Solution(
        **_fields(standing.scene, rod, standing.kernel, standing.text, np.zeros(1), state[None]),
        method="newton",
        requested=standing.scene.run.accuracy,
        estimated=estimated,
        evaluations={"rate": rounds, "jacobian": rounds, "steps": rounds},
        seconds=clock.seconds,
        provenance=_provenance(standing.text, {}),
        reached=True,
        reason="",
    )


def _fields(
    scene: Scene, rod: SemiDiscrete, kernel: NativeRod | NumpyRod, text: KernelText, times: Array, states: Array
) -> dict[str, Any]:
    """What the states of a rod say, and what it was computed with."""
    seen = [kernel.observe(float(t), y) for t, y in zip(times, states, strict=True)]
    poses = rod.poses(states, times)
    return {
        "scene": scene.source,
        "title": scene.title,
        "motion": rod.structure.motion,
        "length": scene.model.length,
        "time": times,
        "u": rod.mesh.u,
        "u_point": rod.mesh.u_point,
        "position": poses.position,
        "rotation": poses.rotation,
        "angle": poses.angle,
        "twist": np.stack([twist.T for twist, _, _ in seen]),
        "turn": rod.turn(states, times).swapaxes(-1, -2),
        "stress": np.stack([stress.T for _, stress, _ in seen]),
        "energy": np.array([energy for _, _, energy in seen]),
        "dissipated": states[:, -2],
        "work": states[:, -1],
        "elements": rod.mesh.elements,
        "degree": rod.mesh.degree,
        "unknowns": rod.unknowns,
        "backend": kernel.backend,
        "contents": _contents(scene, rod.structure, text),
    }


def _contents(scene: Scene, structure: RodStructure, text: KernelText) -> dict[str, Any]:
    """What the kernel of the scene consists of; whatever the scene does not call for is not in it."""
    model = scene.model
    ends = (("left", model.left), ("right", model.right))
    loads = [f"load on the {side} end" for side, end in ends if end.force or end.torque]
    return {
        "fields": [*structure.state_names, *(["pose of the base"] if structure.carried else [])],
        "terms": [
            "elasticity",
            *(["viscosity"] if any(structure.viscous) else []),
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
        "operations": dict(text.signature["operations"]),
    }


def _provenance(text: KernelText, more: Mapping[str, str]) -> dict[str, str]:
    return {
        "geocosserat": VERSION,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "platform": platform.platform(),
        "kernel": text.identity,
        "kernel_origin": text.origin,
        **more,
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
    }
