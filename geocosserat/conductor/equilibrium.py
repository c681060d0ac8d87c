"""From a scene to where its rod rests, found directly."""

from __future__ import annotations

import os
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from geocosserat.conductor.folder import claimed
from geocosserat.conductor.kernels import kernel_text
from geocosserat.conductor.report import rest_of
from geocosserat.conductor.resting import Stander, State
from geocosserat.conductor.scene import SceneLike, load_any
from geocosserat.conductor.simulate import Clock
from geocosserat.conductor.standing import check_standing
from geocosserat.planning.settings import DEFAULT_ACCURACY, ROUND_OFF
from geocosserat.results.netcdf import save
from geocosserat.results.progress import progress
from geocosserat.results.solution import Solution
from geocosserat.results.stability import Array, Complex, Modes, rest_fields
from geocosserat.results.summary import write_summary
from geocosserat.statics.newton import NotAtRest
from geocosserat.statics.search import others

SOLUTION, PICTURE, SUMMARY = "equilibrium.nc", "equilibrium.png", "equilibrium.json"
FILES = (SOLUTION, PICTURE, SUMMARY)
COUNT = 6
"""Growth rates that are told."""

ZERO = 1e-9
"""Growth rates below this, relative to that at which the rod relaxes, are none."""


LEAST = 1e-5
"""And rates above this are some, however little is known of them."""


class NotReached(Exception):
    """No state of rest was found, and why."""


@dataclass(frozen=True)
class Equilibrium:
    """What `equilibrium` returns: the state of rest, a solution of one frame, and the small motions about it; the
    fields of ``equilibrium --json`` as attributes. solutions: all states of rest that were found, if asked for."""

    solution: Solution
    modes: Modes
    residual: float
    scene: str | None
    solutions: tuple[Equilibrium, ...] | None = None
    files: tuple[Path, ...] = field(default=())

    @property
    def fields(self) -> dict[str, Any]:
        found = rest_fields(self.solution, self.residual, self.modes, self.files, self.scene)
        if self.solutions is not None:
            found["solutions"] = [state.fields for state in self.solutions]
        return found

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_") and "solution" in self.__dict__:  # it lacks all while a copy is being made
            fields = self.fields
            if name in fields:
                return fields[name]
        raise AttributeError(f"an equilibrium has no field {name!r}")


def equilibrium(
    scene: SceneLike,
    out: str | os.PathLike[str] | None = None,
    *,
    settings: Sequence[str] = (),
    accuracy: float | None = None,
    every: bool = False,
    overwrite: bool = False,
) -> Equilibrium:
    """Where the rod of a scene rests, found directly, and whether it stays there.

    scene: a path, TOML text, a mapping or a Scene that does not vary with t. accuracy: of positions, relative to the
    length. every: further states of rest are searched for. out: a folder for equilibrium.nc, .png and .json.

    A rod whose turn does not change though it moves as a whole (one that is spun, or sinks) rests in this sense.

    Raises InputError for a wrong scene, setting or folder, and NotReached if no state of rest is found.
    """
    changes = [*settings, *([] if accuracy is None else [f"run.accuracy={float(accuracy)!r}"])]
    read = load_any(scene, changes)
    check_standing(read)
    folder = None if out is None else Path(out)
    clock = Clock()
    with claimed(folder, overwrite, FILES):
        try:
            stander, wanted = Stander(read, kernel_text, clock), read.run.accuracy or DEFAULT_ACCURACY
            coarse, state = at_rest(stander, wanted)
            found = _told(coarse, state, clock)
            if every:
                found = replace(found, solutions=(found, *_others(stander, wanted, state)))
        except NotAtRest as error:
            raise NotReached(str(error)) from error
        return found if folder is None else _written(found, folder)


def at_rest(
    stander: Stander, accuracy: float, rates: float = np.inf, count: int = COUNT, first: State | None = None
) -> tuple[State | None, State]:
    """The state of rest on the last two of ever finer meshes, where positions are as accurate relative to the length,
    and the leading growth rates relative to each. first: a state to go on from, on finer ones.

    Raises NotAtRest if there is none.
    """
    coarse: State | None = None
    last = first
    for state in stander.states(first):
        coarse, last = last, state
        settled = state.estimated is not None and state.estimated <= max(accuracy, ROUND_OFF)
        if settled and (rates == np.inf or modes_of(coarse, state, count).errors.max(initial=0.0) <= rates):
            break
    assert last is not None
    return coarse, last


def modes_of(coarse: State | None, state: State, count: int = COUNT) -> Modes:
    """The leading small motions about a state of rest; coarse: the state on another mesh, which tells their error."""
    growth, motions = state.spectrum
    standing, length = state.standing, state.standing.scene.model.length
    before = None if coarse is None else coarse.spectrum[0]
    changes = None if before is None else _changes(before, growth)
    vanish = ZERO * standing.system.rate + (np.zeros(len(growth)) if changes is None else 10 * changes)
    neutral = (np.abs(growth) <= vanish) & (np.abs(growth) < LEAST * standing.system.rate)
    shapes = []
    for i in range(min(count, len(growth))):
        shape = standing.displaced(state.rest.x, motions[:, i])
        largest = np.linalg.norm(shape, axis=1).max()
        shapes.append(shape / (largest if largest > 1e-9 * length else 1.0))
    errors = np.full(len(growth), np.inf) if changes is None else changes / np.maximum(np.abs(growth), vanish)
    errors = np.where(neutral, 0.0, errors)  # what vanishes is known to
    return Modes(
        growth=growth[:count],
        shapes=np.array(shapes),
        errors=errors[:count],
        neutral=int(neutral.sum()),
        unstable=int(((growth.real > 0) & ~neutral).sum()),
    )


def _changes(before: Complex, growth: Complex) -> Array:
    """How far each rate lies from the nearest one of another mesh."""
    nearest: Array = np.abs(growth[:, None] - before[None, :]).min(axis=1)
    return nearest


def _told(coarse: State | None, state: State, clock: Clock) -> Equilibrium:
    solution = rest_of(state.standing, state.rest.x, state.estimated, state.rounds, clock)
    return Equilibrium(solution, modes_of(coarse, state), state.rest.left, state.standing.scene.path)


def _others(stander: Stander, accuracy: float, state: State) -> list[Equilibrium]:
    """Further states of rest, those of least energy first: found on the mesh of the first, then as exact as that."""
    standing = state.standing
    found = []
    with stander.clock("solve"), progress("searching", unit="states") as report:
        for rest in others(standing.system, state.rest, standing.spectrum, standing.same):
            found.append(State(standing, rest, None, rest.rounds))
            report(0.5, len(found))
    told = []
    for other in found:
        with suppress(NotAtRest):  # then it was one of the mesh alone
            told.append(_told(*at_rest(stander, accuracy, first=other), stander.clock))
    return sorted(told, key=lambda one: float(one.solution.energy[0]))


def _written(found: Equilibrium, folder: Path) -> Equilibrium:
    files = tuple(folder / name for name in FILES)
    found = replace(found, files=files)
    save(found.solution, files[0])
    write_summary(found.fields, files[2])
    from geocosserat.results.modes_picture import rest_picture  # last: whatever happens to it, the results are there

    rest_picture(found.solution, found.modes, [one.solution for one in (found.solutions or ())[1:]], files[1])
    return found


