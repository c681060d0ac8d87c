"""One simulation of a scene at one setting: how exactly, from where, past which instants."""

import math
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from geocosserat.conductor.rescue import SAFE, FellBack, rescued
from geocosserat.discretisation.correcting import correctable, corrected
from geocosserat.discretisation.mesh import Array
from geocosserat.discretisation.sampling import stiffnesses
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.discretisation.structure import RodStructure
from geocosserat.kernel.balance import RodBalance
from geocosserat.kernel.library import KernelText
from geocosserat.kernel.load import load
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod
from geocosserat.model.errors import InputError
from geocosserat.model.records import Scene
from geocosserat.planning.gap import position_gap
from geocosserat.planning.resolution import instants
from geocosserat.planning.settings import DEFAULT_ACCURACY, HABITS, Setting
from geocosserat.results.progress import progress
from geocosserat.solver.integrate import LAST_RESORTS, integrate
from geocosserat.solver.legs import in_legs
from geocosserat.solver.trajectory import Frame, Progress, Trajectory

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


@dataclass(frozen=True, eq=False)
class Attempt:
    """One simulation at one setting; seconds: of the integration alone; fell_back: if its method failed and the safe
    one went on."""

    setting: Setting
    rod: SemiDiscrete
    kernel: NativeRod | NumpyRod
    trajectory: Trajectory
    text: KernelText
    seconds: float
    fell_back: FellBack | None = None


MOST_UNKNOWNS = 400
"""Of which the rates of all small motions are looked for."""


def at_start(start: Array, times: Array) -> Trajectory:
    """Of a run that has not begun."""
    return Trajectory(times[:1].copy(), start[None].copy(), 0, 0, 0, False)


def _nothing(_: Trajectory) -> None:
    pass


class _OutOfTime(Exception):
    """An integration took longer than it may."""


class Simulator:
    """Simulates a scene on a backend at any setting; the clock says what for. seconds: after which an integration is
    cut off; rescue: whether the safe method takes over where another one fails that the scene did not ask for."""

    def __init__(
        self,
        scene: Scene,
        backend: str,
        kernel_text: Callable[[RodStructure], KernelText],
        clock: Clock,
        seconds: float = math.inf,
        rescue: bool = True,
    ) -> None:
        self.scene, self.backend, self.kernel_text, self.clock = scene, backend, kernel_text, clock
        self.seconds, self.rescue = seconds, rescue and scene.run.method is None
        self.instants = instants(scene)
        self._last: tuple[tuple[int, int], SemiDiscrete, NativeRod | NumpyRod, KernelText] | None = None

    def __call__(
        self,
        setting: Setting,
        frames: int,
        begin: Callable[[Array, Array], Trajectory] = at_start,
        kept: Callable[[Trajectory], None] = _nothing,
    ) -> Attempt:
        """A simulation that keeps so many states. begin: of the start (size,) and the times (frames,) what is there
        already; kept: is told of what one may go on from."""
        scene = self.scene
        rod, kernel, text = self._on(setting.elements, setting.degree)
        times = np.linspace(0.0, scene.run.until, frames)
        _check_room(frames, len(rod.state))
        atol = tolerances(rod, setting.rtol, scene.run.atol, unit_of_energy(scene, rod, kernel))
        done = begin(rod.state, times)
        own = self._for(setting.method, rod, kernel)
        start, fell_back = time.perf_counter(), None
        with progress(scene.title) as report:
            told = _no_longer(self.seconds, report)

            def integrated(
                method: str, rtol: float, done: Trajectory, kept: Callable[[Trajectory], None] = _nothing
            ) -> Trajectory:
                of_each = rtol / setting.rtol * atol
                its, balance = own if method == setting.method else self._for(method, rod, kernel)

                def leg(before: Trajectory, to_come: Array, frame: Frame) -> Trajectory:
                    part, start = partial(_of_the_rest, told, before, scene.run.until), before.states[-1]
                    return integrate(its, start, to_come, method, rtol, of_each, part, frame, self.instants, balance)

                return in_legs(leg, done, times, kept)

            try:
                trajectory = integrated(setting.method, setting.rtol, done, kept)
                if self.rescue and not trajectory.reached:  # from here on nothing is kept: whoever goes on fails again
                    by_safe = partial(integrated, SAFE, max(setting.rtol, HABITS[SAFE].least))
                    trajectory, fell_back = rescued(trajectory, setting.method, by_safe)
            except _OutOfTime:
                trajectory = replace(done, reason=f"cut off after {self.seconds:.3g} seconds")
        return Attempt(setting, rod, kernel, trajectory, text, time.perf_counter() - start, fell_back)

    def _on(self, elements: int, degree: int) -> tuple[SemiDiscrete, NativeRod | NumpyRod, KernelText]:
        """The rod on a mesh, its kernel, and that kernel's text; kept until another mesh is wanted."""
        size = elements, degree
        if self._last is None or self._last[0] != size:
            with self.clock("derive"):
                rod = discretise(self.scene, elements, degree)
                text = self.kernel_text(rod.structure)
            with self.clock("compile"):
                self._last = size, rod, load(text, rod, self.backend), text
        return self._last[1:]

    def _for(
        self, method: str, rod: SemiDiscrete, kernel: NativeRod | NumpyRod
    ) -> tuple[NativeRod | NumpyRod, RodBalance | None]:
        """The kernel for a method: where it keeps a balance of energy only if it is made to, one of the same states
        that can be corrected, and that balance; else the same."""
        if method not in LAST_RESORTS or not correctable(rod.structure):
            return kernel, None
        rod = corrected(rod)
        with self.clock("derive"):
            text = self.kernel_text(rod.structure)
        with self.clock("compile"):
            its = load(text, rod, self.backend)
        return its, RodBalance(its, rod)


def _of_the_rest(progress: Progress, before: Trajectory, until: float, fraction: float, steps: int) -> None:
    """Progress of what is left as progress of the whole."""
    done = float(before.times[-1]) / until
    progress(done + (1.0 - done) * fraction, before.steps + steps)


def _no_longer(seconds: float, report: Progress) -> Progress:
    """Reports that end an integration when its time is up."""
    end = time.perf_counter() + seconds

    def told(fraction: float, steps: int) -> None:
        if time.perf_counter() > end:
            raise _OutOfTime
        report(fraction, steps)

    return told


def tolerances(rod: SemiDiscrete, rtol: float, atol: float | None, energy: float) -> Array:
    """Absolute tolerance of each state entry, (size,): `atol` for strains, or rtol where none is given.

    Strains count by the displacement they make: stretches as they are, curvatures in units of 1 / length, and so
    for the carried pose. Energies, and stresses that the state holds, count by the energy stored at the start, or that
    of bending by a radian.
    """
    strain = rtol if atol is None else atol
    length, group = float(rod.mesh.edges[-1]), rod.structure.group
    points = rod.mesh.elements * rod.mesh.degree
    turns = [strain] * group.translations + [strain / length] * group.rotations
    stresses = [strain * energy / length] * group.translations + [strain * energy] * group.rotations
    rows = [s if held else e for e, s, held in zip(turns, stresses, rod.structure.frozen, strict=True)]
    rows += [s for s, here in zip(stresses, rod.structure.viscous, strict=True) if here]
    along = np.repeat(rows, points)
    carried = [strain * length] * group.translations + [strain] * (rod.structure.carried - group.translations)
    return np.concatenate([along, carried[: rod.structure.carried], [strain * energy] * 2])


def unit_of_energy(scene: Scene, rod: SemiDiscrete, kernel: NativeRod | NumpyRod) -> float:
    """Energy stored at the start, or that of bending the softest way by a radian if that is more.

    Raises InputError where what is stored is more than any number.
    """
    model, group = scene.model, scene.model.group
    stiff = stiffnesses(model)
    free = [i for i in range(group.dimension) if not rod.structure.frozen[i]]
    # bending by a radian, stretching by the length
    units = [
        stiff[i] * model.length ** (1 if i < group.translations else -1)
        for i in ([i for i in free if i >= group.translations] or free)
    ]
    with np.errstate(all="ignore"):
        stored = kernel.observe(0.0, rod.state)[2]
    if not math.isfinite(stored):
        hint = "start from smaller strains"
        raise InputError("a finite energy at the start", f"{stored:g}", hint, key="start.strain")
    return max(stored, min(units))


def chosen_setting(scene: Scene) -> Setting | None:
    """The setting the scene fixes, if it fixes any part of one."""
    run = scene.run
    if run.elements is None and run.degree is None and run.rtol is None and run.atol is None:
        return None
    rtol = run.rtol if run.rtol is not None else (run.accuracy or DEFAULT_ACCURACY) / 10
    return Setting(run.elements or 1, run.degree or 8, rtol, run.method or "cvode")


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


def misplaced(rod: SemiDiscrete, trajectory: Trajectory) -> float:
    """How far nodes are from where their strains put them, at the start or at the end; a length. Meshes on which a rod
    turns more often in an element than its points can tell may agree with each other on a motion that is none."""
    return max(_misplaced(rod, trajectory.states[i], float(trajectory.times[i])) for i in (0, -1))


def _misplaced(rod: SemiDiscrete, state: Array, t: float) -> float:
    mesh, poses = rod.finer_poses(state, t)
    return position_gap(rod.mesh, rod.poses(state, t).position, mesh, poses.position)


def unbalanced(scene: Scene, attempt: Attempt) -> float:
    """What the balance of energy lacks over a run, relative to its largest term, or to a thousandth of a bend by a
    radian if that is more: of a rod at rest there is nothing to balance."""
    kernel, trajectory = attempt.kernel, attempt.trajectory
    first, last = (
        np.array([kernel.observe(float(t), y)[2], *y[-2:]])
        for t, y in ((trajectory.times[i], trajectory.states[i]) for i in (0, -1))
    )
    stored, dissipated, work = last - first
    scale = max(abs(stored), abs(dissipated), abs(work), 1e-3 * unit_of_energy(scene, attempt.rod, kernel))
    return float(abs(stored + dissipated - work) / scale)


def turned(attempt: Attempt) -> float:
    """By how many radians the rod turns in a step, at the pace it has at the end, where it turns fastest."""
    trajectory, group = attempt.trajectory, attempt.rod.structure.group
    end = float(trajectory.times[-1])
    twist = attempt.kernel.observe(end, trajectory.states[-1])[0]
    pace = float(np.linalg.norm(twist[group.translations :], axis=0).max())
    return pace * (end - float(trajectory.times[0])) / max(trajectory.steps, 1)


def growth(attempt: Attempt) -> float:
    """By which power of e over the time of the run that small motion grows which grows fastest where the run ends; zero
    where none does, or where that takes too long to find out."""
    kernel, trajectory = attempt.kernel, attempt.trajectory
    size, end = kernel.size - kernel.quadratures, float(trajectory.times[-1])
    if size > MOST_UNKNOWNS:
        return 0.0
    J = kernel.jacobian(end, trajectory.states[-1])[:size, :size]
    held = np.flatnonzero(kernel.algebraic[:size])
    moves = np.flatnonzero(kernel.algebraic[:size] == 0.0)
    try:
        follow = np.linalg.solve(J[np.ix_(held, held)], J[np.ix_(held, moves)])
        rates = np.linalg.eigvals(J[np.ix_(moves, moves)] - J[np.ix_(moves, held)] @ follow)
    except np.linalg.LinAlgError:
        return 0.0
    return float(max(rates.real.max(initial=0.0), 0.0)) * (end - float(trajectory.times[0]))


def _check_room(frames: int, size: int) -> None:
    """Raises InputError if the states of all frames would not fit into memory."""
    if frames * size > MOST_NUMBERS:
        raise InputError(
            f"at most {MOST_NUMBERS} numbers in a solution",
            f"{frames} frames of {size} unknowns",
            "keep fewer frames, or compute on fewer elements",
            key="run.frames",
        )
