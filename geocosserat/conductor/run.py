"""From a scene to a solution, and to its files.

    scene -> structure -> kernel text (shipped, cached, or generated) -> kernel -> trajectory -> solution
"""

import hashlib
import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from geocosserat.bounded import OutOfBounds, bounded
from geocosserat.conductor.folder import claimed
from geocosserat.conductor.kernels import choose_backend, kernel_text, on_backend, tell
from geocosserat.conductor.report import solution_of
from geocosserat.conductor.scene import MOST_SECONDS, SceneLike, laws_of, load_any
from geocosserat.conductor.search import search
from geocosserat.conductor.simulate import Clock, Simulator
from geocosserat.model.errors import InputError
from geocosserat.model.law import Law
from geocosserat.model.records import Scene
from geocosserat.results.checkpoint import NAME as CHECKPOINT
from geocosserat.results.checkpoint import Keeper, load_checkpoint
from geocosserat.results.errors import FileError
from geocosserat.results.netcdf import save
from geocosserat.results.solution import Solution
from geocosserat.results.summary import summary, write_summary
from geocosserat.version import VERSION

SOLUTION, PICTURE, SUMMARY = "solution.nc", "picture.png", "summary.json"


@dataclass(frozen=True)
class Run:
    """What `run` returns: the solution, and the fields of ``run --json`` as attributes (tip, ledger, error, ...)."""

    solution: Solution
    fields: Mapping[str, Any]

    def __getattr__(self, name: str) -> Any:
        fields = self.__dict__.get("fields", {})  # empty while a copy is being made
        if name in fields:
            return fields[name]
        raise AttributeError(f"a run has no field {name!r}; it has {', '.join(fields)}")


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
    changes = [*settings, *([] if accuracy is None else [f"run.accuracy={float(accuracy)!r}"])]
    read = load_any(scene, changes)
    folder = None if out is None else Path(out)
    if resume and folder is None:
        raise InputError("the folder of the interrupted run", "none", "name it with --out", key="--resume")
    backend = choose_backend(read.run.backend)
    if folder is not None and resume and backend == "c" and read.run.backend == "auto":  # it may not have compiled then
        backend = "numpy" if load_checkpoint(folder).key == _key(read, "numpy") else "c"
    with claimed(folder, overwrite or resume, (SOLUTION, PICTURE, SUMMARY, CHECKPOINT)):
        return on_backend(read.run.backend, backend, lambda used: _run(read, used, folder, resume))


def _run(scene: Scene, backend: str, folder: Path | None, resume: bool) -> Run:
    """The run of a scene on a backend, with its files."""
    clock, keeper = Clock(), Keeper(folder, _key(scene, backend), resume, tell)
    try:
        found = search(Simulator(scene, backend, kernel_text, clock), keeper)
    except KeyboardInterrupt:
        keeper.save()
        raise
    solution = solution_of(scene, found, clock)
    for law in laws_of(scene):
        solution = replace(solution, contents={**solution.contents, "law": _said_of(law)})
    files = [] if folder is None else [folder / SOLUTION, folder / PICTURE, folder / SUMMARY]
    fields = summary(solution, files, scene=scene.path)
    if folder is not None:
        try:
            _write(solution, files, fields)
        except KeyboardInterrupt:
            keeper.save()
            raise
        except FileError as error:
            raise FileError(error.file, error.expected, error.found, f"{error.hint}{_left_by(keeper)}") from None
        keeper.finish()
        from geocosserat.results.picture import picture  # last: whatever happens to it, the results are there

        picture(solution, files[1])
    return Run(solution, fields)


def _left_by(keeper: Keeper) -> str:
    """What is left of a run whose results could not be written."""
    try:
        keeper.save()
    except FileError:
        return ": what was computed is lost"
    return ", and go on with --resume: what was computed is kept"


def _said_of(law: Law) -> dict[str, Any]:
    """Name, verdict and grade of a rod's law; says so where it may feed the rod."""
    from geocosserat.passivity.check import check as check_law

    with suppress(OutOfBounds):
        found = bounded(partial(check_law, law, brief=True), MOST_SECONDS)
        if found.verdict != "passive":
            tell(
                f"the law {law.name} is {found.verdict}: "
                "the rod may gain energy from it, and no method can promise that energy only falls"
            )
        return {"name": law.name, "verdict": found.verdict, "grade": found.grade}
    return {"name": law.name, "verdict": "undecided", "grade": None}


def _key(scene: Scene, backend: str) -> str:
    """What a checkpoint belongs to: the scene, the program, and what it runs on, for plans differ by that."""
    return hashlib.sha256(f"{VERSION}\0{backend}\0{scene.source}".encode()).hexdigest()


def _write(solution: Solution, files: Sequence[Path], fields: Mapping[str, Any]) -> None:
    save(solution, files[0])
    for file in files[1:]:  # of an earlier run, if it is overwritten: they would belong to another solution
        with suppress(OSError):
            file.unlink()
    write_summary(fields, files[2])
