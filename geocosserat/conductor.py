"""The one module that sees all stages: from a scene to a solution.

    scene -> structure -> kernel text (shipped, cached, or generated) -> kernel -> trajectory -> solution

Symbolic algebra, code generation and plotting are imported only when they are needed: a run whose kernel is
already built starts in a fraction of a second.
"""

import hashlib
import json
import os
import platform
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np

from geocosserat.accuracy import DEFAULT_ACCURACY, Setting, ladder, position_gap
from geocosserat.codegen.identity import identity
from geocosserat.discretisation.mesh import Mesh
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.discretisation.structure import RodStructure, structure_of
from geocosserat.kernel.compile import CompileError, compiler
from geocosserat.kernel.contract import Array
from geocosserat.kernel.library import KernelText, find, store
from geocosserat.kernel.load import load
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod
from geocosserat.model.errors import InputError
from geocosserat.model.records import Scene
from geocosserat.model.scene import load_scene
from geocosserat.results.atomic import write_bytes
from geocosserat.results.checkpoint import NAME as CHECKPOINT
from geocosserat.results.checkpoint import Checkpoint, load_checkpoint, save_checkpoint
from geocosserat.results.netcdf import save
from geocosserat.results.progress import progress
from geocosserat.results.solution import Solution
from geocosserat.results.summary import summary, write_summary
from geocosserat.solver.integrate import integrate
from geocosserat.solver.trajectory import Trajectory
from geocosserat.version import VERSION

SceneLike = str | os.PathLike[str] | Mapping[str, Any] | Scene
SOLUTION, PICTURE, SUMMARY = "solution.nc", "picture.png", "summary.json"


@dataclass(frozen=True)
class Run:
    """What `run` returns: the solution, and the fields of ``run --json`` as attributes (tip, ledger, error, ...)."""

    solution: Solution
    fields: Mapping[str, Any]

    def __getattr__(self, name: str) -> Any:
        try:
            return self.__dict__["fields"][name]
        except KeyError:
            raise AttributeError(f"a run has no field {name!r}; it has {', '.join(self.fields)}") from None


class _Clock:
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
class _Attempt:
    """One simulation at one setting."""

    setting: Setting
    rod: SemiDiscrete
    kernel: NativeRod | NumpyRod
    trajectory: Trajectory
    origin: str


def load_any(scene: SceneLike, settings: Sequence[str] = ()) -> Scene:
    """The scene itself, or the one that a path, TOML text or mapping describes, with `settings` applied.

    Raises InputError as `load_scene`.
    """
    if isinstance(scene, Scene):
        return load_scene(scene.source, settings) if settings else scene
    return load_scene(scene, settings)


def kernel_text(structure: RodStructure) -> KernelText:
    """The kernel of a structure: shipped, cached, or generated now (the only case that needs symbolic algebra)."""
    name = identity(structure)
    found = find(name)
    if found is not None:
        return found
    from geocosserat.codegen.source import generate as generate_source

    source = generate_source(structure)
    return store(name, source.c, source.numpy, source.signature)


def choose_backend(asked: str, tell: Callable[[str], None]) -> str:
    """ "c" or "numpy"; says so when numpy takes over for want of a compiler.

    Raises InputError if C was asked for and there is no compiler.
    """
    if asked == "numpy":
        return "numpy"
    if compiler() is not None:
        return "c"
    if asked == "c":
        raise InputError("a C compiler", "none on the path", 'install one, or set backend = "numpy"', key="run.backend")
    tell("no C compiler found: running on numpy, with the same results in more time")
    return "numpy"


def tolerances(rod: SemiDiscrete, rtol: float, atol: float | None, energy: float) -> Array:
    """Absolute tolerance of each state entry, (size,): `atol` for strains, or rtol where none is given.

    Strains count by the displacement they make: stretches as they are, curvatures in units of 1 / length, and so
    for the carried pose. The two energies count by the energy stored at the start, or that of bending by a radian.
    """
    strain = rtol if atol is None else atol
    length, group = float(rod.mesh.edges[-1]), rod.structure.group
    points = rod.mesh.elements * rod.mesh.degree
    turn = np.repeat([strain] * group.translations + [strain / length] * group.rotations, points)
    carried = [strain * length] * group.translations + [strain] * (rod.structure.carried - group.translations)
    return np.concatenate([turn, carried[: rod.structure.carried], [strain * energy] * 2])


def _unit_of_energy(scene: Scene, rod: SemiDiscrete, kernel: NativeRod | NumpyRod) -> float:
    """Energy stored at the start, or that of bending the softest way by a radian if that is more."""
    from geocosserat.model.expressions import evaluate

    model, group = scene.model, scene.model.group
    middle = {**model.parameters, "u": model.length / 2}
    soft = min(float(evaluate(model.stiffness[i][i], middle)) for i in range(group.translations, group.dimension))
    return max(kernel.observe(0.0, rod.state)[2], soft / model.length)


def _chosen(scene: Scene) -> Setting | None:
    """The setting the scene fixes, if it fixes any part of one."""
    run = scene.run
    if run.elements is None and run.degree is None and run.rtol is None:
        return None
    rtol = run.rtol if run.rtol is not None else (run.accuracy or DEFAULT_ACCURACY) / 10
    return Setting(run.elements or 1, run.degree or 8, rtol)


class _Simulation:
    """Simulates a scene at its setting, or at finer and finer ones until two agree; keeps checkpoints on the way."""

    def __init__(self, scene: Scene, backend: str, clock: _Clock, keeper: "_Keeper") -> None:
        self.scene, self.backend, self.clock, self.keeper = scene, backend, clock, keeper

    def solve(self) -> tuple[_Attempt, float | None]:
        """The attempt to report, and the estimate of its error relative to the length (None at a fixed setting)."""
        chosen = _chosen(self.scene)
        if chosen is not None:
            return self._attempt(0, chosen, np.empty((0, 0))), None
        accuracy = self.scene.run.accuracy or DEFAULT_ACCURACY
        resumed = self.keeper.resumed
        before: tuple[Mesh, Array] | None = None
        estimate: float | None = None
        for rung, setting in enumerate(ladder(accuracy)):
            if resumed is not None and rung < resumed.rung:
                if rung == resumed.rung - 1:
                    before = discretise(self.scene, setting.elements, setting.degree).mesh, resumed.before
                continue
            self.clock.plan_ends()  # what was solved before this one turns out to be planning
            now = self._attempt(rung, setting, before[1] if before else np.empty((0, 0)))
            positions = now.rod.poses(now.trajectory.states[-1]).position
            if not now.trajectory.reached:
                break
            if before is not None:
                estimate = position_gap(*before, now.rod.mesh, positions) / self.scene.model.length
                if estimate <= accuracy:
                    break
            before = now.rod.mesh, positions
        return now, estimate

    def _attempt(self, rung: int, setting: Setting, before: Array) -> _Attempt:
        scene = self.scene
        with self.clock("derive"):
            rod = discretise(scene, setting.elements, setting.degree)
            text = kernel_text(rod.structure)
        with self.clock("compile"):
            kernel = load(text, rod, self.backend)
        times = np.linspace(0.0, scene.run.until, scene.run.frames)
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
                )
                states = np.concatenate([done[:-1], rest.states])
                trajectory = replace(rest, times=times[: len(states)], states=states)
        return _Attempt(setting, rod, kernel, trajectory, text.origin)


class _Keeper:
    """Writes a checkpoint now and then, if there is a folder to write to."""

    EVERY = 5.0  # seconds

    def __init__(self, folder: Path | None, key: str, resume: bool) -> None:
        self.folder, self.key = folder, key
        self.resumed: Checkpoint | None = None
        if resume:
            assert folder is not None
            self.resumed = load_checkpoint(folder)
            if self.resumed.key != key:
                raise InputError(
                    "the scene and settings of the interrupted run",
                    f"others than those of the checkpoint in {folder}",
                    "resume with the same scene, or start without --resume",
                    key="--resume",
                )
        self.rung, self.states, self.before = 0, [np.empty(0)], np.empty((0, 0))
        self.saved = time.monotonic()

    def begin(self, rung: int, start: Array, before: Array) -> Array:
        """States (frames, size) of this rung that are there already; at least the start."""
        resumed = self.resumed
        done = resumed.states if resumed is not None and resumed.rung == rung else start[None]
        if done.shape[1] != len(start):
            raise InputError(f"states of {len(start)} numbers", f"{done.shape[1]}", "start without --resume")
        self.rung, self.states, self.before = rung, list(done), before
        return np.array(done)

    def frame(self, _: int, state: Array) -> None:
        """Notes a state that was reached."""
        self.states.append(state.copy())
        if time.monotonic() - self.saved > self.EVERY:
            self.save()

    def save(self) -> None:
        """Writes the checkpoint now."""
        if self.folder is not None:
            save_checkpoint(Checkpoint(self.key, self.rung, np.array(self.states), self.before), self.folder)
        self.saved = time.monotonic()

    def finish(self) -> None:
        """The run is complete: nothing to go on from."""
        if self.folder is not None:
            (self.folder / CHECKPOINT).unlink(missing_ok=True)


def _solution(scene: Scene, attempt: _Attempt, estimate: float | None, clock: _Clock) -> Solution:
    rod, kernel, trajectory = attempt.rod, attempt.kernel, attempt.trajectory
    seen = [kernel.observe(float(t), y) for t, y in zip(trajectory.times, trajectory.states, strict=True)]
    poses = rod.poses(trajectory.states)
    accuracy = scene.run.accuracy
    missed = estimate is not None and estimate > (accuracy or DEFAULT_ACCURACY)
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
        turn=rod.turn(trajectory.states).swapaxes(-1, -2),
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
        provenance=_provenance(rod, attempt),
        reached=trajectory.reached and not missed,
        reason=trajectory.reason or ("the accuracy asked for was not reached by refinement" if missed else ""),
    )


def _provenance(rod: SemiDiscrete, attempt: _Attempt) -> dict[str, str]:
    return {
        "geocosserat": VERSION,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "platform": platform.platform(),
        "kernel": identity(rod.structure),
        "kernel_origin": attempt.origin,
        "rtol": repr(attempt.setting.rtol),
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
    }


def _claim(folder: Path, overwrite: bool, names: Sequence[str] = (SOLUTION, PICTURE, SUMMARY)) -> None:
    """Makes sure, before anything is computed, that results can be written and that none are lost."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        writable = os.access(folder, os.W_OK | os.X_OK)
    except OSError as error:
        raise InputError("a folder to write to", str(error), "choose another --out", key="--out") from error
    if not writable:
        raise InputError("a folder that can be written", f"{folder}, read-only", "choose another --out", key="--out")
    kept = [name for name in names if (folder / name).exists()]
    if kept and not overwrite:
        raise InputError(
            f"none of these files in {folder} yet",
            ", ".join(kept),
            "choose another --out, or say --overwrite",
            key="--out",
        )


def _tell(message: str) -> None:
    print(message, file=sys.stderr)


def run(
    scene: SceneLike,
    out: str | os.PathLike[str] | None = None,
    *,
    settings: Sequence[str] = (),
    accuracy: float | None = None,
    overwrite: bool = False,
    resume: bool = False,
) -> Run:
    """Simulates a scene; writes solution.nc, picture.png and summary.json to `out` if given.

    scene: a path, TOML text, a mapping or a Scene. settings: "key=value" changes to it. accuracy: position error at
    the end, relative to the length. resume: go on from the checkpoint in `out`. A run that could not finish is
    returned too, with `reached` false and the reason.

    Raises InputError for a wrong scene, setting or folder; nothing is computed or written then. Interrupted
    (Ctrl-C), it leaves a checkpoint in `out` and raises KeyboardInterrupt.
    """
    changes = [*settings, *([] if accuracy is None else [f"run.accuracy={accuracy!r}"])]
    read = load_any(scene, changes)
    folder = None if out is None else Path(out)
    if resume and folder is None:
        raise InputError("the folder of the interrupted run", "none", "name it with --out", key="--resume")
    if folder is not None:
        _claim(folder, overwrite or resume)
        # plotting starts slowly, and an integration in C leaves the interpreter idle
        Thread(target=import_module, args=["geocosserat.results.picture"], daemon=True).start()
    clock = _Clock()
    backend = choose_backend(read.run.backend, _tell)
    keeper = _Keeper(folder, _key(read), resume)
    try:
        attempt, estimate = _Simulation(read, backend, clock, keeper).solve()
    except CompileError as error:
        if read.run.backend == "c":
            raise
        _tell(f"{error}\nrunning on numpy instead")
        attempt, estimate = _Simulation(read, "numpy", clock, keeper).solve()
    except KeyboardInterrupt:
        keeper.save()
        raise
    solution = _solution(read, attempt, estimate, clock)
    files: list[Path] = []
    if folder is not None:
        files = [folder / SOLUTION, folder / PICTURE, folder / SUMMARY]
        _write(solution, files, summary(solution, files, scene=read.path))
        keeper.finish()
    return Run(solution, summary(solution, files, scene=read.path))


def _key(scene: Scene) -> str:
    """What a checkpoint belongs to: the scene and the program."""
    return hashlib.sha256(f"{VERSION}\0{scene.source}".encode()).hexdigest()


@dataclass(frozen=True)
class Equations:
    """What `derive` returns: the equations a scene will solve, readable and as LaTeX, and what they consist of."""

    form: str
    text: str
    latex: str
    fields: Mapping[str, Any]

    def __str__(self) -> str:
        return self.text


def derive(
    scene: SceneLike, form: str = "intrinsic", *, settings: Sequence[str] = (), unicode: bool = True
) -> Equations:
    """The equations of motion of a scene, derived symbolically and specialised to it.

    Raises InputError for a wrong scene or an unknown form.
    """
    from geocosserat.derivation.equations import derive as derive_equations
    from geocosserat.derivation.forms import FORMS, document
    from geocosserat.derivation.printing import to_latex, to_text

    read = load_any(scene, settings)
    if form not in FORMS:
        raise InputError(f"one of {', '.join(FORMS)}", repr(form), "choose one of these", key="--form")
    equations = derive_equations(read.model)
    laid_out = document(equations, form)
    structure = structure_of(read.model)
    fields = {
        "scene": read.path or read.title,
        "motion": structure.motion,
        "form": form,
        "fields": list(equations.fields),
        "parameters": dict(read.model.parameters),
        "coefficients": [c.name for c in structure.coefficients],
        "sees_the_world": structure.world,
    }
    return Equations(form, to_text(laid_out, unicode), to_latex(laid_out), fields)


@dataclass(frozen=True)
class Generated:
    """What `generate` returns: the files written, and the kernel's signature."""

    backend: str
    files: tuple[Path, ...]
    signature: Mapping[str, Any]


def generate(
    scene: SceneLike,
    backend: str,
    out: str | os.PathLike[str],
    *,
    settings: Sequence[str] = (),
    overwrite: bool = False,
) -> Generated:
    """Writes the kernel of a scene, its signature, the scene's numbers and a small driver to the folder `out`.

    backend: "c" (then `make && ./driver` there) or "numpy" (then `python driver.py`); neither needs geocosserat.

    Raises InputError for a wrong scene, backend or folder, or files there that would be overwritten.
    """
    from geocosserat.codegen.driver import take_away
    from geocosserat.codegen.source import generate as generate_source

    read = load_any(scene, settings)
    if backend not in ("c", "numpy"):
        raise InputError('"c" or "numpy"', repr(backend), "choose one of these", key="--backend")
    chosen = _chosen(read) or Setting(1, 8, 0.0)
    rod = discretise(read, chosen.elements, chosen.degree)
    files = take_away(generate_source(rod.structure, read.title), rod, read.run.until, read.title, backend)
    folder = Path(out)
    _claim(folder, overwrite, tuple(files))
    for name, content in files.items():
        write_bytes(folder / name, content.encode())
    return Generated(backend, tuple(folder / name for name in files), json.loads(files["signature.json"]))


def _write(solution: Solution, files: Sequence[Path], fields: Mapping[str, Any]) -> None:
    from geocosserat.results.picture import picture

    save(solution, files[0])
    picture(solution, files[1])
    write_summary(fields, files[2])
