"""From a scene to what accuracy costs in it: many ways to compute it, each measured."""

from __future__ import annotations

import json
import os
import platform
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from geocosserat.conductor.folder import claimed
from geocosserat.conductor.kernels import choose_backend, kernel_text, on_backend
from geocosserat.conductor.scene import SceneLike, load_any
from geocosserat.conductor.search import planned
from geocosserat.conductor.simulate import Attempt, Clock, Simulator
from geocosserat.discretisation.mesh import Array, Mesh
from geocosserat.kernel.compile import compiler
from geocosserat.model.errors import InputError
from geocosserat.model.records import Scene
from geocosserat.planning.gap import position_gap
from geocosserat.planning.settings import HABITS, Setting
from geocosserat.results.atomic import write_bytes
from geocosserat.results.checkpoint import Keeper
from geocosserat.results.diagram import AS_GIVEN, Diagram, ModelError, Point, Reference
from geocosserat.results.progress import progress
from geocosserat.solver.integrate import METHODS
from geocosserat.version import VERSION

PICTURE, VECTORS, FINDINGS = "cost.png", "cost.svg", "cost.json"
COST_FILES = (PICTURE, VECTORS, FINDINGS)

MESHES = ((1, 4), (1, 6), (1, 8), (1, 12), (16, 1), (1, 16), (2, 12), (64, 1), (4, 12), (256, 1), (8, 12))
MODEL_MESHES = ((1, 4), (1, 6), (1, 8), (1, 12))
DECADES = {"radau": (1, 9), "cvode": (2, 12), "bdf": (2, 11), "lsoda": (2, 11)}
LARGEST = {"radau": 300}
"""Unknowns beyond which a method is not tried: its matrices are dense."""

EXACT, OWN = 1e-11, 1e-8
"""Accuracies that are asked for of the reference, and of a model by itself."""

MOST_SECONDS = 60.0
FAILURES = 3


@dataclass(frozen=True)
class Cost:
    """What `cost` returns: the diagram, the files written, and the fields of ``cost --json`` as attributes."""

    diagram: Diagram
    files: tuple[Path, ...]

    @property
    def fields(self) -> dict[str, Any]:
        return {**self.diagram.fields, "files": [str(file) for file in self.files]}

    def __getattr__(self, name: str) -> Any:
        diagram = self.__dict__.get("diagram")  # missing while a copy is being made
        if diagram is not None and name in diagram.fields:
            return diagram.fields[name]
        raise AttributeError(f"a cost has no field {name!r}")


def cost(
    scene: SceneLike,
    out: str | os.PathLike[str] | None = None,
    *,
    settings: Sequence[str] = (),
    methods: Sequence[str] = ("cvode", "radau"),
    seconds: float = MOST_SECONDS,
    overwrite: bool = False,
) -> Cost:
    """What accuracy costs in time: error against seconds over methods, meshes, tolerances and models.

    Each way is timed several times, warm: the integration alone. seconds: for all of that, besides the reference and
    what has to be compiled. out: a folder for the diagram as cost.png, cost.svg and cost.json. A scene that no run
    follows to its end is returned too, with `reached` false and the reason.

    Raises InputError for a wrong scene, method or folder.
    """
    for method in methods:
        if method not in METHODS:
            known = f"methods out of {', '.join(METHODS)}"
            raise InputError(known, repr(method), "choose some of these", key="--methods")
    if not 0.0 < seconds < float("inf"):
        raise InputError("a number of seconds above zero", repr(seconds), "leave it out for 60", key="--seconds")
    read = _unset(load_any(scene, settings))
    backend = choose_backend(read.run.backend)
    folder = None if out is None else Path(out)
    with claimed(folder, overwrite, COST_FILES):
        chosen = tuple(dict.fromkeys(methods))
        diagram = on_backend(read.run.backend, backend, lambda used: _Measured(read, used, chosen, seconds).diagram())
        return Cost(diagram, () if folder is None else _write(diagram, folder))


def _unset(scene: Scene) -> Scene:
    """The scene without a setting of its own; what is left of friction is that of the finest runs."""
    run = replace(scene.run, elements=None, degree=None, rtol=None, atol=None, method=None, accuracy=EXACT)
    return replace(scene, run=run)


class _NoReference(Exception):
    """Nothing counts as exact; ``str()`` says why."""


class _Measured:
    """Measures the ways of a scene, from coarse to fine, until its time is up."""

    def __init__(self, scene: Scene, backend: str, methods: Sequence[str], seconds: float) -> None:
        self.scene, self.backend, self.methods, self.seconds = scene, backend, methods, seconds
        self.spent, self.left_out = 0.0, 0
        self.points: list[Point] = []

    def diagram(self) -> Diagram:
        try:
            mesh, positions, reference = self._reference(self.scene, EXACT)
        except _NoReference as error:
            return self._diagram((), None, f"no run to compare with: {error}")
        models = list(self._models(mesh, positions))
        sweeps = [(AS_GIVEN, self.scene, size, method) for size in MESHES for method in self.methods]
        sweeps += [
            (error.model, scene, size, method)
            for error, scene in models
            if error.error is not None
            for size in MODEL_MESHES
            for method in self.methods
        ]
        with progress("measuring", unit="ways") as report:
            for i, (model, scene, size, method) in enumerate(sweeps):
                report(i / len(sweeps), len(self.points))
                self._sweep(model, scene, size, method, mesh, positions, reference.error)
        failed = all(point.error is None for point in self.points)
        reason = f"none of {len(self.points)} ways came to the end of the scene" if failed else ""
        return self._diagram(tuple(error for error, _ in models), reference, reason)

    def _diagram(self, models: tuple[ModelError, ...], reference: Reference | None, reason: str) -> Diagram:
        return Diagram(
            scene=self.scene.path or self.scene.title,
            title=self.scene.title,
            points=tuple(self.points),
            models=models,
            reference=reference,
            left_out=self.left_out,
            machine=machine(self.backend),
            reason=reason,
        )

    def _simulator(self, scene: Scene, seconds: float) -> Simulator:
        return Simulator(scene, self.backend, kernel_text, Clock(), seconds, rescue=False)

    def _reference(self, scene: Scene, accuracy: float) -> tuple[Mesh, Array, Reference]:
        """The rod at the end as exactly as a plan gets it; none of its runs takes longer than all that is timed may."""
        simulate = self._simulator(scene, max(self.seconds, MOST_SECONDS))
        found = planned(simulate, Keeper(None, "", False), accuracy)
        attempt, setting = found.attempt, found.attempt.setting
        if not attempt.trajectory.reached or found.estimate is None:
            raise _NoReference(found.reason)
        error = max(found.estimate, np.finfo(float).eps)
        reference = Reference(setting.method, setting.elements, setting.degree, setting.rtol, error)
        return attempt.rod.mesh, _end(attempt), reference

    def _models(self, mesh: Mesh, positions: Array) -> Iterator[tuple[ModelError, Scene]]:
        """Models with less in them, and what they leave out."""
        model = self.scene.model
        if model.frozen:
            return
        stretch, *shear = model.group.strain[: model.group.translations]
        for name, frozen in (("unshearable", tuple(shear)), ("inextensible, unshearable", (stretch, *shear))):
            listed = ", ".join(f'"{mode}"' for mode in frozen)
            try:
                scene = _unset(load_any(self.scene, [f"rod.frozen=[{listed}]"]))
                own, end, _ = self._reference(scene, OWN)
            except (InputError, _NoReference) as error:
                yield ModelError(name, frozen, None, f"not possible here: {error}"), self.scene
                continue
            yield ModelError(name, frozen, _gap(self.scene, own, end, mesh, positions), ""), scene

    def _sweep(
        self, model: str, scene: Scene, size: tuple[int, int], method: str, mesh: Mesh, exact: Array, least: float
    ) -> None:
        """One mesh and method, from loose tolerances to tight ones, while that makes the error less."""
        simulate = self._simulator(scene, max(0.0, self.seconds - self.spent))
        first, last = DECADES[method]
        unknowns = size[0] * size[1] * scene.model.group.dimension
        if unknowns > LARGEST.get(method, unknowns):
            return
        errors: list[float] = []
        failures = 0
        for decade in range(first, last + 1):
            if self.spent > self.seconds:
                self.left_out += last + 1 - decade
                return
            setting = Setting(*size, max(10.0**-decade, HABITS[method].least), method)
            point = self._point(model, simulate, setting, mesh, exact)
            self.points.append(point)
            failures += point.error is None
            errors.append(np.inf if point.error is None else point.error)
            stuck = len(errors) > 3 and min(errors[-2:]) > 0.5 * min(errors[:-2])
            if failures == FAILURES or errors[-1] < least or stuck:
                return
            if point.seconds > self.seconds / 20:
                self.left_out += last - decade
                return

    def _point(self, model: str, simulate: Simulator, setting: Setting, mesh: Mesh, exact: Array) -> Point:
        attempt = simulate(setting, 2)
        times = [attempt.seconds]
        if attempt.trajectory.reached:
            more = 5 if times[0] < 0.02 else 2 if times[0] < 1.0 else 0
            times += [simulate(setting, 2).seconds for _ in range(more)]
            times = times[1:] or times  # the first one warms up
        self.spent += sum(times)
        trajectory, scene = attempt.trajectory, simulate.scene
        return Point(
            model=model,
            method=setting.method,
            elements=attempt.rod.mesh.elements,
            degree=setting.degree,
            rtol=setting.rtol,
            unknowns=attempt.rod.unknowns,
            error=_gap(scene, attempt.rod.mesh, _end(attempt), mesh, exact) if trajectory.reached else None,
            seconds=min(times),
            median=float(np.median(times)),
            repeats=len(times),
            rates=trajectory.rates,
            jacobians=trajectory.jacobians,
            steps=trajectory.steps,
            reason=trajectory.reason,
        )


def _end(attempt: Attempt) -> Array:
    """Positions (nodes, space) at the end."""
    return attempt.rod.poses(attempt.trajectory.states[-1], attempt.trajectory.times[-1]).position


def _gap(scene: Scene, mesh: Mesh, positions: Array, fine: Mesh, exact: Array) -> float:
    return position_gap(mesh, positions, fine, exact) / scene.model.length


def machine(backend: str) -> Mapping[str, str]:
    """What a time was measured on: processor and versions."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        name = next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        name = platform.processor() or platform.machine()
    found = {name: "", "cores": str(os.cpu_count()), platform.system(): platform.release(), "geocosserat": VERSION}
    found |= {"Python": platform.python_version(), **{x: version(x) for x in ("numpy", "scipy", "scikit-sundae")}}
    return {**found, "kernels in": f"C, {Path(compiler() or '').name}" if backend == "c" else "numpy"}


def _write(diagram: Diagram, folder: Path) -> tuple[Path, ...]:
    """The files; without the pictures where there is nothing to be seen."""
    from geocosserat.results.diagram_picture import picture

    found = [write_bytes(folder / FINDINGS, (json.dumps(diagram.fields, indent=2, allow_nan=False) + "\n").encode())]
    for name in (PICTURE, VECTORS):
        if diagram.points:
            found.append(picture(diagram, folder / name))
        else:
            (folder / name).unlink(missing_ok=True)  # of an earlier call
    return tuple(found)
