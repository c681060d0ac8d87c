"""The result of a simulation as the record that is kept."""

import platform
from datetime import UTC, datetime
from typing import Any

import numpy as np

from geocosserat.conductor.search import Found
from geocosserat.conductor.simulate import Attempt, Clock
from geocosserat.model.records import Scene
from geocosserat.results.solution import Solution
from geocosserat.version import VERSION


def solution_of(scene: Scene, found: Found, clock: Clock) -> Solution:
    """The result of an attempt as the record that is kept: fields over time, with their provenance."""
    attempt = found.attempt
    rod, kernel, trajectory = attempt.rod, attempt.kernel, attempt.trajectory
    seen = [kernel.observe(float(t), y) for t, y in zip(trajectory.times, trajectory.states, strict=True)]
    poses = rod.poses(trajectory.states, trajectory.times)
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
        method=attempt.setting.method,
        elements=rod.mesh.elements,
        degree=rod.mesh.degree,
        unknowns=rod.unknowns,
        backend=kernel.backend,
        requested=scene.run.accuracy,
        estimated=found.estimate,
        evaluations={"rate": trajectory.rates, "jacobian": trajectory.jacobians, "steps": trajectory.steps},
        seconds=clock.seconds,
        contents=_contents(scene, attempt),
        provenance=_provenance(attempt),
        reached=found.reached,
        reason=found.reason,
        plan=found.plan,
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
