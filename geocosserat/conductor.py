"""The one module that sees all stages: from a scene to a solution.

    scene -> structure -> kernel text (shipped, cached, or generated) -> kernel -> trajectory -> solution

Symbolic algebra, code generation and plotting are imported only when they are needed: a run whose kernel is
already built starts in a fraction of a second.
"""

import hashlib
import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geocosserat.accuracy import Setting
from geocosserat.bounded import OutOfBounds, bounded
from geocosserat.codegen.identity import identity
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.discretisation.structure import RodStructure
from geocosserat.discretisation.structuring import structure_of
from geocosserat.kernel.compile import CompileError, compiler
from geocosserat.kernel.library import KernelText, find, store
from geocosserat.model.effects.law_wrench import LawWrench
from geocosserat.model.errors import InputError
from geocosserat.model.law import Law, load_law
from geocosserat.model.records import Scene
from geocosserat.model.scene import load_scene
from geocosserat.results.atomic import write_bytes
from geocosserat.results.checkpoint import NAME as CHECKPOINT
from geocosserat.results.checkpoint import Keeper
from geocosserat.results.netcdf import save
from geocosserat.results.solution import Solution
from geocosserat.results.summary import summary, write_summary
from geocosserat.simulation import Attempt, Clock, Simulation, chosen_setting, solution_of
from geocosserat.version import VERSION

if TYPE_CHECKING:
    from geocosserat.passivity.check import Check
    from geocosserat.referee.report import Report

SceneLike = str | os.PathLike[str] | Mapping[str, Any] | Scene
LawLike = str | os.PathLike[str] | Mapping[str, Any] | Law
SOLUTION, PICTURE, SUMMARY = "solution.nc", "picture.png", "summary.json"
LAW_PICTURE, PASSAGE, FINDINGS = "law.png", "law.tex", "check.json"
CHECK_FILES = ("witness_stress.toml", "witness_wrench.toml", LAW_PICTURE, PASSAGE, FINDINGS)
MOST_SECONDS = 30.0
"""What the question whether a law is passive may take; it is undecided then."""


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


def load_any(scene: SceneLike, settings: Sequence[str] = ()) -> Scene:
    """The scene itself, or the one that a path, TOML text or mapping describes, with `settings` applied.

    Raises InputError as `load_scene`.
    """
    if isinstance(scene, Scene):
        return _stored(load_scene(scene.source, settings) if settings else scene)
    return _stored(load_scene(scene, settings))


def _stored(scene: Scene) -> Scene:
    """The scene, with what is found of the energy and the potential of a law that is written as stress and wrench."""
    model = scene.model
    if all(law.energy is not None and law.wrench is None for law in _laws(scene)):
        return scene
    from geocosserat.passivity.storing import stored

    with suppress(OutOfBounds):  # then all that the law does counts as lost
        model = bounded(partial(stored, model), MOST_SECONDS)
    return replace(scene, model=model)


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


def _claim(folder: Path, overwrite: bool, names: Sequence[str] = (SOLUTION, PICTURE, SUMMARY, CHECKPOINT)) -> None:
    """Makes sure, before anything is computed, that results can be written and that none are lost."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        writable = os.access(folder, os.W_OK | os.X_OK)
    except OSError as error:
        found = f"{folder}: {error.strerror or error}"
        raise InputError("a folder to write to", found, "choose another --out", key="--out") from error
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


def _give_back(folder: Path) -> None:
    """Removes a folder in which nothing was written."""
    with suppress(OSError):
        folder.rmdir()


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
    backend = choose_backend(read.run.backend, _tell)
    keeper = Keeper(folder, _key(read), resume)
    if folder is not None:
        _claim(folder, overwrite or resume)
    clock = Clock()
    try:
        attempt, estimate = _simulate(read, backend, clock, keeper)
    except (CompileError, InputError):
        if folder is not None:
            _give_back(folder)
        raise
    except KeyboardInterrupt:
        keeper.save()
        raise
    solution = solution_of(read, attempt, estimate, clock)
    for law in _laws(read):
        solution = replace(solution, contents={**solution.contents, "law": _said_of(law)})
    files: list[Path] = []
    if folder is not None:
        files = [folder / SOLUTION, folder / PICTURE, folder / SUMMARY]
        _write(solution, files, summary(solution, files, scene=read.path))
        keeper.finish()
    return Run(solution, summary(solution, files, scene=read.path))


def _laws(scene: Scene) -> list[Law]:
    """The law of the rod, or none."""
    found = [effect.law for effect in scene.model.effects if isinstance(effect, LawWrench)]
    return [scene.model.law] if scene.model.law else found


def _said_of(law: Law) -> dict[str, Any]:
    """Name, verdict and grade of a rod's law; says so where it may feed the rod."""
    from geocosserat.passivity.check import check as check_law

    with suppress(OutOfBounds):
        found = bounded(partial(check_law, law, brief=True), MOST_SECONDS)
        if found.verdict != "passive":
            _tell(
                f"the law {law.name} is {found.verdict}: "
                "the rod may gain energy from it, and no method can promise that energy only falls"
            )
        return {"name": law.name, "verdict": found.verdict, "grade": found.grade}
    return {"name": law.name, "verdict": "undecided", "grade": None}


def _simulate(scene: Scene, backend: str, clock: Clock, keeper: Keeper) -> tuple[Attempt, float | None]:
    """The simulation, on numpy if C was not asked for and turns out not to compile."""
    try:
        return Simulation(scene, backend, kernel_text, clock, keeper).solve()
    except CompileError as error:
        if scene.run.backend == "c":
            raise
        _tell(f"{error}; running on numpy instead")
        return Simulation(scene, "numpy", kernel_text, clock, keeper).solve()


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
    scene: SceneLike,
    form: str = "intrinsic",
    *,
    chart: str | None = None,
    settings: Sequence[str] = (),
    unicode: bool = True,
) -> Equations:
    """The equations of motion of a scene, derived symbolically and specialised to it.

    chart: for the form "coordinates", "angle" in the plane; in space "rotation-vector" (the default),
    "quaternion", "cayley", "euler" or "matrix".

    Raises InputError for a wrong scene, an unknown form, the form "limit" of a rod without frozen modes, a chart that
    the motion has not, and a chart for a form that takes none.
    """
    from geocosserat.derivation.charts import chart_names
    from geocosserat.derivation.equations import derive as derive_equations
    from geocosserat.derivation.forms import CHARTED, FORMS, document
    from geocosserat.derivation.printing import to_latex, to_text

    read = load_any(scene, settings)
    if form not in FORMS:
        raise InputError(f"one of {', '.join(FORMS)}", repr(form), "choose one of these", key="--form")
    charts = chart_names(read.model.group) if form in CHARTED else ()
    if chart is not None and not charts:
        takes = " or ".join(f"--form {name}" for name in CHARTED)
        raise InputError(f"no chart for the form {form}", repr(chart), f"leave it out, or say {takes}", key="--chart")
    if chart is not None and chart not in charts:
        choices = f"one of {', '.join(charts)}" if charts[1:] else charts[0]
        expected = f"{choices}, for a {structure_of(read.model).motion} rod"
        raise InputError(expected, repr(chart), "choose one of these, or leave it out", key="--chart")
    equations = derive_equations(read.model)
    laid_out = document(equations, form, chart)
    structure = structure_of(read.model)
    fields = {
        "scene": read.path or read.title,
        "motion": structure.motion,
        "form": form,
        "chart": (chart or charts[0]) if charts else None,
        "fields": list(equations.fields),
        "terms": list(equations.terms),
        "multipliers": [f.func.__name__ for f in equations.multipliers],
        "algebraic": list(equations.algebraic),
        "parameters": dict(read.model.parameters),
        "coefficients": [c.name for c in structure.coefficients],
        "sees_the_world": structure.sight != "nothing",
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
    chosen = chosen_setting(read) or Setting(1, 8, 0.0)
    rod = discretise(read, chosen.elements, chosen.degree)
    files = take_away(generate_source(rod.structure, read.title), rod, read.run.until, read.title, backend)
    folder = Path(out)
    _claim(folder, overwrite, tuple(files))
    for name, content in files.items():
        write_bytes(folder / name, content.encode())
    return Generated(backend, tuple(folder / name for name in files), json.loads(files["signature.json"]))


@dataclass(frozen=True)
class Checked:
    """What `check` returns: all that was found of a law, and the fields of ``check --json`` as attributes.

    found: None if it took too long; files: those written.
    """

    found: "Check | None"
    files: tuple[Path, ...]
    fields: Mapping[str, Any]

    def __getattr__(self, name: str) -> Any:
        fields = self.__dict__.get("fields", {})  # empty while a copy is being made
        if name in fields:
            return fields[name]
        raise AttributeError(f"a check has no field {name!r}; it has {', '.join(fields)}")


def check(
    law: LawLike,
    out: str | os.PathLike[str] | None = None,
    *,
    values: Mapping[str, float] | None = None,
    overwrite: bool = False,
    seconds: float = MOST_SECONDS,
) -> Checked:
    """Is a constitutive law passive? With a proof, or with a counter-example that runs.

    law: a path, TOML text, a mapping or a Law. values: of its parameters. `out`: a folder for the witnesses as scenes,
    a picture, a passage for a paper and what was found as JSON. Takes at most `seconds`; then it is undecided.

    Raises InputError for a wrong law or folder.
    """
    read = law if isinstance(law, Law) else load_law(law, values)
    for name in values or ():
        if name not in read.parameters:
            known = ", ".join((*read.parameters, *read.open)) or "none"
            raise InputError(f"a parameter of the law ({known})", repr(name), "choose one of these", key="--set")
    folder = None if out is None else Path(out)
    if folder is not None:
        _claim(folder, overwrite, CHECK_FILES)
    try:
        found, fields, content = bounded(partial(_answered, read, folder is not None), seconds)
    except OutOfBounds as error:
        if folder is not None:
            _give_back(folder)
        why = {"verdict": "undecided", "grade": None, "conditions": [], "not_checked": [f"all: {error}"]}
        return Checked(None, (), {"law": read.path or read.name, "name": read.name, **why, "files": []})
    files = () if folder is None else tuple(write_bytes(folder / name, data) for name, data in content.items())
    if folder is not None:
        for name in set(CHECK_FILES) - set(content):  # of an earlier check, which are no more true
            (folder / name).unlink(missing_ok=True)
    return Checked(found, files, {**fields, "files": [str(file) for file in files]})


def _answered(law: Law, written: bool) -> "tuple[Check, dict[str, Any], dict[str, bytes]]":
    """All that is found of a law, its fields, and the files to write."""
    from geocosserat.passivity.check import check as check_law

    found = check_law(law)
    fields = found.fields
    if not written:
        return found, fields, {}
    from geocosserat.passivity.picture import image
    from geocosserat.passivity.portrait import portrait
    from geocosserat.passivity.show import passage

    content = {f"witness_{part}.toml": text.encode() for part, text in found.scenes.items()}
    content[PASSAGE] = passage(found).encode()
    content[FINDINGS] = (json.dumps(fields, indent=2, allow_nan=False) + "\n").encode()
    figure = portrait(found)
    if figure is not None:
        content[LAW_PICTURE] = image(figure, Path(LAW_PICTURE).suffix)
    return found, fields, content


def paper(progress: Callable[[int, int], None] | None = None, processes: int = 1) -> "Report":
    """Judges every statement of the paper this program was made from; each verdict is computed.

    `progress` is called with how many statements were judged so far, and how many there are; `processes` work side by
    side.
    """
    from geocosserat.referee.report import review
    from paper_checks import SECTIONS

    return review(SECTIONS, progress, processes)


def _write(solution: Solution, files: Sequence[Path], fields: Mapping[str, Any]) -> None:
    save(solution, files[0])
    write_summary(fields, files[2])
    from geocosserat.results.picture import picture  # last: whatever happens to it, the results are there

    picture(solution, files[1])
