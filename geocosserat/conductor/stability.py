"""From a scene to whether its rod stays at rest, and at which value of one number it no longer does."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from geocosserat.conductor.equilibrium import NotReached, at_rest, modes_of
from geocosserat.conductor.family import Over, Rods, read_over
from geocosserat.conductor.folder import claimed
from geocosserat.conductor.kernels import kernel_text
from geocosserat.conductor.report import rest_of
from geocosserat.conductor.resting import Stander, State
from geocosserat.conductor.scene import SceneLike, load_any
from geocosserat.conductor.simulate import Clock
from geocosserat.conductor.standing import Standing, check_standing
from geocosserat.discretisation.mesh import Array
from geocosserat.model.errors import InputError
from geocosserat.model.records import Scene
from geocosserat.planning.settings import SIZES
from geocosserat.results.atomic import write_bytes
from geocosserat.results.progress import progress
from geocosserat.results.stability import Critical, Followed, Map, Point, Stability
from geocosserat.statics.crossing import Crossing, Looked, Spot, branches
from geocosserat.statics.find import find
from geocosserat.statics.newton import NotAtRest, newton
from geocosserat.statics.path import Family, Place
from geocosserat.statics.system import LARGEST

PICTURE, VECTORS, FINDINGS = "stability.png", "stability.svg", "stability.json"
FILES = (PICTURE, VECTORS, FINDINGS)
COUNT = 6
RATES = 1e-8
"""To which growth rates are told, and the values at which they vanish: relative to each."""

ROUGH = 1e-4
"""To which positions and the leading rate are as exact, relatively, on the mesh on which states are followed."""

MOST = 100
"""States on a branch that leaves the path sideways, at most."""

AROUND = 0.02
"""Of the interval: how far around a crossing it is looked for on a finer mesh."""

GRID = 25
"""Values of each of two keys that a map is made of."""


@dataclass(frozen=True)
class Found:
    """What `stability` returns: the record, and the fields of ``stability --json`` as attributes."""

    record: Stability
    fields: dict[str, Any]

    def __getattr__(self, name: str) -> Any:
        fields = self.__dict__.get("fields", {})  # empty while a copy is being made
        if name in fields:
            return fields[name]
        raise AttributeError(f"a stability has no field {name!r}; it has {', '.join(fields)}")


def stability(
    scene: SceneLike,
    out: str | os.PathLike[str] | None = None,
    *,
    over: str | Sequence[str] = (),
    settings: Sequence[str] = (),
    count: int = COUNT,
    overwrite: bool = False,
) -> Found:
    """The growth rates of small motions about where the rod of a scene rests, the fastest growing first.

    over: "key=a:b" follows the state of rest while that value of the scene goes from a to b, and finds where small
    motions begin to grow; two of them map the leading growth rate. count: how many rates are told. out: a folder for
    stability.png, .svg and .json.

    Raises InputError for a wrong scene, setting or folder, and NotReached if there is no state of rest to begin with.
    """
    keys = [read_over(text) for text in ([over] if isinstance(over, str) else over)]
    if len(keys) > 2 or len({key.key for key in keys}) < len(keys):
        raise InputError("one key, or two different ones", f"{len(keys)}", "say --over once or twice", key="--over")
    if count < 1:
        raise InputError("at least 1 growth rate", repr(count), "ask for some", key="--count")
    read = load_any(scene, [*settings, *(key.setting(0.0) for key in keys)])
    for key in keys:  # whatever is wrong with the other end is told before anything is computed
        check_standing(load_any(read, [key.setting(1.0)]))
    check_standing(read)
    folder = None if out is None else Path(out)
    with claimed(folder, overwrite, FILES):
        try:
            record = _found(read, keys, count)
        except NotAtRest as error:
            raise NotReached(str(error)) from error
        if folder is not None:
            record = replace(record, files=[str(folder / name) for name in FILES])
            _write(record, folder)
    return Found(record, record.fields)


def _found(scene: Scene, keys: Sequence[Over], count: int) -> Stability:
    clock = Clock()
    stander = Stander(scene, kernel_text, clock)
    rough = at_rest(stander, ROUGH, ROUGH, 1)[1] if keys else None
    coarse, state = at_rest(stander, RATES, RATES, count)
    solution = rest_of(state.standing, state.rest.x, state.estimated, state.rest.rounds, clock)
    record = Stability(solution, state.rest.left, modes_of(coarse, state, count), scene.path)
    if rough is None:
        return record
    if len(keys) == 1:
        return replace(record, followed=_followed(scene, keys[0], rough, record.modes.neutral))
    return replace(record, map=_map(scene, keys[0], keys[1], rough, record.modes.neutral))


def _followed(scene: Scene, over: Over, state: State, neutral: int) -> Followed:
    """The branch of a state of rest, its crossings, and what leaves it sideways.

    Raises NotAtRest if there is no branch.
    """
    mesh = state.standing.rod.mesh
    looked, rest = _looked(scene, over, (mesh.elements, mesh.degree), neutral, state.standing, state.rest.x)
    spots, main, reason = _walked(looked, looked.path(rest, 0.0), over)
    if not spots:
        raise NotAtRest(reason)
    numbered: list[tuple[int, Crossing]] = []
    try:
        for found in looked.crossings(spots):
            numbered.append(found)
    except NotAtRest as error:
        reason = reason or f"a crossing was lost: {error}"
    crossings = [crossing for _, crossing in numbered]
    exact = [_refined(scene, over, state, looked, crossing) for crossing in crossings]
    points = list(main)
    for shift, (index, crossing) in enumerate(numbered):
        points.insert(index + 1 + shift, _point(looked, crossing.spot, over))
    followed = [tuple(points)]
    first = next((crossing for crossing in crossings if crossing.gains and crossing.number == 0), None)
    if first is not None and first.kind == "divergence" and not first.fold:
        for place in branches(first):
            _, side, _ = _walked(looked, islice(looked.switched(place), MOST), over)
            followed.append((_point(looked, first.spot, over), *side))
    return Followed(over.key, (over.first, over.last), tuple(followed), tuple(exact), reason)


def _looked(
    scene: Scene, over: Over, size: tuple[int, int], neutral: int, standing: Standing, x: Array, p: float = 0.0
) -> tuple[Looked, Array]:
    """A family on a mesh, looked at; and the state of rest there that one on another mesh stands for, at p."""
    rods = Rods(scene, over, size, kernel_text)
    guess = rods.first.from_mesh(standing, x)
    rest = newton(rods.at(p).system, guess)
    return Looked(rods, rods.spectrum, rods.first.system.rate, neutral), rest.x


def _walked(looked: Looked, path: Iterator[Spot], over: Over) -> tuple[list[Spot], tuple[Point, ...], str]:
    """The spots of a path, what is told of them, and why it ends before its time, or nothing."""
    spots: list[Spot] = []
    points: list[Point] = []
    with progress(f"{over.key} from {over.first:g} to {over.last:g}", unit="states") as report:
        try:
            for spot in path:
                spots.append(spot)
                points.append(_point(looked, spot, over))
                report(spot.place.p, len(spots))
        except NotAtRest as error:
            return spots, tuple(points), str(error)
    back = len(spots) > 1 and spots[-1].place.p <= 0.0
    return spots, tuple(points), "the branch turns back to where it began" if back else ""


def _point(looked: Looked, spot: Spot, over: Over) -> Point:
    rods: Any = looked.family
    place, growth = spot.place, spot.growth[0]
    tip = rods.at(place.p).poses(place.x).position[-1]
    return Point(over.at(place.p), float(growth.real), abs(float(growth.imag)), tuple(tip.tolist()))


def _refined(scene: Scene, over: Over, state: State, looked: Looked, crossing: Crossing) -> Critical:
    """The same crossing on ever finer meshes, until its value settles."""
    mesh, value, error = state.standing.rod.mesh, over.at(crossing.spot.place.p), None
    family, found = looked.family, crossing
    for size in _finer(scene, mesh.elements, mesh.degree):
        try:
            family, found = _again(scene, over, size, looked.neutral, family, found)
        except NotAtRest:
            break
        again = over.at(found.spot.place.p)
        error, value = abs(again - value), again
        if error <= RATES * max(abs(value), abs(over.last - over.first) * RATES):
            break
    return Critical(
        value=value,
        kind=found.kind,
        frequency=found.frequency,
        gains=crossing.gains,
        lost=crossing.gains and crossing.number == 0,
        fold=crossing.fold,
        error=error,
    )


def _finer(scene: Scene, elements: int, degree: int) -> list[tuple[int, int]]:
    if scene.run.elements is not None or scene.run.degree is not None:
        return []
    d = scene.model.group.dimension
    return [(n, p) for n, p in SIZES if elements * degree < n * p <= LARGEST // d]


def _again(
    scene: Scene, over: Over, size: tuple[int, int], neutral: int, rods: Any, crossing: Crossing
) -> tuple[Family, Crossing]:
    """A crossing on another mesh, looked for from the place before it on, and that mesh's family.

    Raises NotAtRest if it is not there.
    """
    before, there = crossing.before, crossing.spot.place
    looked, rest = _looked(scene, over, size, neutral, rods.at(before.p), before.x, before.p)
    low, high = min(before.p, there.p) - AROUND, max(before.p, there.p) + AROUND
    spots, _, _ = _walked(looked, looked.path(rest, before.p, 1.0 if before.onward > 0 else -1.0, low, high), over)
    for _, found in looked.crossings(spots):
        if (found.gains, found.number, found.kind) == (crossing.gains, crossing.number, crossing.kind):
            return looked.family, found
    raise NotAtRest("it is not there on another mesh")


def _map(scene: Scene, one: Over, two: Over, state: State, neutral: int) -> Map:
    """The leading growth rate over two values: each row of states follows its neighbours."""
    mesh = state.standing.rod.mesh
    size = (mesh.elements, mesh.degree)
    growth = np.full((GRID, GRID), np.nan)
    parts = np.linspace(0.0, 1.0, GRID)
    beside = state.rest.x
    with progress("mapping", unit="rows") as report:
        for j, part in enumerate(parts):
            try:
                rods = Rods(load_any(scene, [two.setting(float(part))]), one, size, kernel_text)
            except InputError:  # no such rod
                continue
            looked = Looked(rods, rods.spectrum, rods.first.system.rate, neutral)
            x = beside
            for i, p in enumerate(parts):
                try:
                    standing = rods.at(float(p))
                    rest = find(standing.system, x)
                except NotAtRest:
                    continue
                x = rest.x
                beside = x if i == 0 else beside
                growth[j, i] = looked.at(Place(x, float(p), np.zeros_like(x), 1.0)).growth[0].real
            report((j + 1) / GRID, j + 1)
    return Map((one.key, two.key), np.array([one.at(p) for p in parts]), np.array([two.at(p) for p in parts]), growth)


def _write(record: Stability, folder: Path) -> None:
    write_bytes(folder / FINDINGS, (json.dumps(record.fields, indent=2, allow_nan=False) + "\n").encode())
    from geocosserat.results.modes_picture import picture  # last: whatever happens to it, the results are there

    for name in (PICTURE, VECTORS):
        picture(record, folder / name)
