"""The command line: `geocosserat COMMAND SCENE`, and `geocosserat paper`.

Exit codes: 0 done; 1 the answer is no; 2 the input is wrong (one message); 3 undecided or not reached.
"""

import json
import math
import os
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import wraps
from pathlib import Path
from typing import Any, TypeVar

import click
from rich.console import Console

from geocosserat.conductor.check import check as check_law
from geocosserat.conductor.cost import MOST_SECONDS
from geocosserat.conductor.cost import cost as measure_cost
from geocosserat.conductor.derive import derive as derive_equations
from geocosserat.conductor.derive import generate as generate_kernels
from geocosserat.conductor.paper import paper as review_paper
from geocosserat.conductor.run import run as run_scene
from geocosserat.kernel.compile import CompileError
from geocosserat.model.errors import InputError
from geocosserat.results.atomic import write_bytes
from geocosserat.results.checkpoint import NAME as CHECKPOINT
from geocosserat.results.diagram_table import print_diagram
from geocosserat.results.errors import FileError
from geocosserat.results.progress import progress
from geocosserat.results.summary import print_summary
from geocosserat.version import VERSION

NO, WRONG_INPUT, NOT_REACHED = 1, 2, 3
MOST_PROCESSES = 4
Found = TypeVar("Found")

SETTINGS = click.option(
    "--set", "settings", metavar="KEY=VALUE", multiple=True, help="Change any key, e.g. rod.length=2."
)
JSON = click.option("--json", "as_json", is_flag=True, help="Print one JSON object and nothing else.")
OVERWRITE = click.option("--overwrite", is_flag=True, help="Replace files of an earlier call in the folder.")


def _one_message(command: Callable[..., None]) -> Callable[..., None]:
    """Wrong input ends with code 2 and one line on standard error, an interrupt with code 3 and another."""

    @wraps(command)
    def guarded(*args: Any, **options: Any) -> None:
        try:
            command(*args, **options)
        except (InputError, FileError, CompileError) as error:
            _complain(error)
            sys.exit(WRONG_INPUT)
        except KeyboardInterrupt:
            click.echo("geocosserat: interrupted", err=True)
            sys.exit(NOT_REACHED)
        except BrokenPipeError:  # the reader of our output left
            _say_no_more()

    return guarded


def program() -> None:
    """The command line, where it goes wrong as well: what it prints may go to a full disk."""
    try:
        code = main(standalone_mode=False)
        sys.exit(code if isinstance(code, int) else 0)
    except click.Abort:  # an interrupt before any command has begun
        click.echo("geocosserat: interrupted", err=True)
        sys.exit(NOT_REACHED)
    except click.ClickException as error:
        error.show()
        sys.exit(error.exit_code)
    except OSError as error:
        _complain(f"expected files and output that can be written, found {error.strerror or error}; make room for them")
        _say_no_more()
        sys.exit(WRONG_INPUT)
    except MemoryError:
        _complain("not reached: there is too little memory")
        sys.exit(NOT_REACHED)


def _complain(error: object) -> None:
    """In one line, whatever is in the names of files."""
    line = "".join(c if c.isprintable() else repr(c)[1:-1] for c in str(error))
    click.echo(f"geocosserat: {line}", err=True)


def _say_no_more() -> None:
    """Whatever is still to be written to standard output would fail once more at the end of the program."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _print_json(fields: Mapping[str, Any]) -> None:
    click.echo(json.dumps(fields, allow_nan=False))


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(VERSION, prog_name="geocosserat")
def main() -> None:
    """Slender bodies in slow viscous flow: derive, simulate, generate kernels."""


@main.command()
@click.argument("scene", type=click.Path())
@click.option("--out", type=click.Path(), help="Folder for solution.nc, picture.png and summary.json.")
@click.option("--accuracy", type=float, help="Position error at the end, relative to the length of the rod.")
@SETTINGS
@OVERWRITE
@click.option("--resume", is_flag=True, help="Go on from the checkpoint that an interrupted run left in --out.")
@JSON
@_one_message
def run(
    scene: str,
    out: str | None,
    accuracy: float | None,
    settings: tuple[str, ...],
    overwrite: bool,
    resume: bool,
    as_json: bool,
) -> None:
    """Simulate SCENE (a TOML file)."""
    try:
        result = run_scene(scene, out, settings=settings, accuracy=accuracy, overwrite=overwrite, resume=resume)
    except KeyboardInterrupt:
        if not out or not (Path(out) / CHECKPOINT).exists():
            raise
        click.echo(f"geocosserat: interrupted; go on with --out {out} --resume", err=True)
        sys.exit(NOT_REACHED)
    if as_json:
        _print_json(result.fields)
    else:
        print_summary(result.solution, Console(), files=result.files)
    if not result.reached:
        click.echo(f"geocosserat: not reached: {result.reason}", err=True)
        sys.exit(NOT_REACHED)


@main.command()
@click.argument("scene", type=click.Path())
@click.option("--out", type=click.Path(), help="Folder for equilibrium.nc, .png and .json.")
@click.option("--accuracy", type=float, help="Position error, relative to the length of the rod.")
@click.option("--all", "every", is_flag=True, help="Search for further states of rest.")
@SETTINGS
@OVERWRITE
@JSON
@_one_message
def equilibrium(
    scene: str,
    out: str | None,
    accuracy: float | None,
    every: bool,
    settings: tuple[str, ...],
    overwrite: bool,
    as_json: bool,
) -> None:
    """Where SCENE rests, found directly, and whether it stays there."""
    from geocosserat.conductor.equilibrium import equilibrium as find_equilibrium
    from geocosserat.results.stability_table import print_rest

    found = _reached(
        lambda: find_equilibrium(
            scene, out, settings=settings, accuracy=accuracy, every=every, overwrite=overwrite
        )
    )
    if as_json:
        _print_json(found.fields)
        return
    print_rest(found.solution, found.residual, found.modes, Console(), [str(file) for file in found.files])
    for number, other in enumerate((found.solutions or ())[1:], start=2):
        print_rest(other.solution, other.residual, other.modes, Console(), title=f"state of rest {number}")


@main.command()
@click.argument("scene", type=click.Path())
@click.option("--out", type=click.Path(), help="Folder for stability.png, .svg and .json.")
@click.option("--over", metavar="KEY=A:B", multiple=True, help="Follow the state while a value changes; twice: a map.")
@click.option("--count", type=int, default=6, show_default=True, help="How many growth rates to tell.")
@SETTINGS
@OVERWRITE
@JSON
@_one_message
def stability(
    scene: str,
    out: str | None,
    over: tuple[str, ...],
    count: int,
    settings: tuple[str, ...],
    overwrite: bool,
    as_json: bool,
) -> None:
    """Do small motions about the rest of SCENE grow, and from which value of a key on?"""
    from geocosserat.conductor.stability import stability as find_stability
    from geocosserat.results.stability_table import print_stability

    found = _reached(
        lambda: find_stability(scene, out, over=over, count=count, settings=settings, overwrite=overwrite)
    )
    if as_json:
        _print_json(found.fields)
    else:
        print_stability(found.record, Console())


def _reached(find: Callable[[], Found]) -> Found:
    """What is found; ends with code 3 if nothing is."""
    from geocosserat.conductor.equilibrium import NotReached

    try:
        return find()
    except NotReached as error:
        click.echo(f"geocosserat: not reached: {error}", err=True)
        sys.exit(NOT_REACHED)


@main.command()
@click.argument("scene", type=click.Path())
@click.option("--out", type=click.Path(), help="Folder for cost.png, cost.svg and cost.json.")
@click.option("--methods", default="cvode,radau", show_default=True, help="Which integrators, with commas between.")
@click.option("--seconds", type=float, default=MOST_SECONDS, show_default=True, help="For all that is timed.")
@SETTINGS
@OVERWRITE
@JSON
@_one_message
def cost(
    scene: str,
    out: str | None,
    methods: str,
    seconds: float,
    settings: tuple[str, ...],
    overwrite: bool,
    as_json: bool,
) -> None:
    """What accuracy costs in time: SCENE computed in many ways, each timed."""
    chosen = [name.strip() for name in methods.split(",")]
    found = measure_cost(scene, out, settings=settings, methods=chosen, seconds=seconds, overwrite=overwrite)
    if as_json:
        _print_json(found.fields)
    else:
        print_diagram(found.diagram, Console(), [str(file) for file in found.files])
    if not found.reached:
        click.echo(f"geocosserat: not reached: {found.reason}", err=True)
        sys.exit(NOT_REACHED)


@main.command()
@click.argument("scene", type=click.Path())
@click.option("--form", default="intrinsic", show_default=True, help="intrinsic, coordinates, linearised or limit.")
@click.option("--chart", metavar="NAME", help="Coordinates for --form coordinates, e.g. rotation-vector or euler.")
@click.option("--latex", is_flag=True, help="Print LaTeX (for amsmath).")
@SETTINGS
@JSON
@_one_message
def derive(
    scene: str, form: str, chart: str | None, latex: bool, settings: tuple[str, ...], as_json: bool
) -> None:
    """Print the equations that SCENE will solve."""
    encoding = getattr(sys.stdout, "encoding", None) or "ascii"  # None: closed
    unicode = as_json or "utf" in encoding.lower()
    equations = derive_equations(scene, form, chart=chart, settings=settings, unicode=unicode)
    if as_json:
        _print_json({**equations.fields, "text": equations.text, "latex": equations.latex})
    else:
        click.echo(equations.latex if latex else equations.text, nl=False)


@main.command()
@click.argument("scene", type=click.Path())
@click.option("--backend", required=True, metavar="c|numpy", help="Language of the kernels.")
@click.option("--out", required=True, type=click.Path(), help="Folder for the files.")
@SETTINGS
@OVERWRITE
@JSON
@_one_message
def generate(scene: str, backend: str, out: str, settings: tuple[str, ...], overwrite: bool, as_json: bool) -> None:
    """Write the kernels of SCENE, their signature and a driver that uses them."""
    done = generate_kernels(scene, backend, out, settings=settings, overwrite=overwrite)
    if as_json:
        _print_json({"backend": backend, "files": [str(f) for f in done.files], "signature": dict(done.signature)})
        return
    for path in done.files:
        click.echo(path)
    how = f"make -C {out} && {out}/driver" if backend == "c" else f"python {out}/driver.py"
    click.echo(f"try it: {how}")


@main.command()
@click.argument("law", type=click.Path())
@click.option("--out", type=click.Path(), help="Folder for witnesses that run, a picture and a passage for a paper.")
@click.option("--set", "settings", metavar="NAME=VALUE", multiple=True, help="A value of a parameter, e.g. a=0.3.")
@OVERWRITE
@JSON
@_one_message
def check(law: str, out: str | None, settings: tuple[str, ...], overwrite: bool, as_json: bool) -> None:
    """Is the constitutive law in LAW (a TOML file) passive? With a proof, or a counter-example that runs."""
    result = check_law(law, out, values=dict(map(_value, settings)), overwrite=overwrite)
    if as_json:
        _print_json(result.fields)
    elif result.found is None:
        click.echo(f"{result.name}: undecided; not checked: {'; '.join(result.not_checked)}")
    else:
        from geocosserat.passivity.show import print_check

        print_check(result.found, Console(), [str(file) for file in result.files])
    if result.verdict != "passive":
        sys.exit(NOT_REACHED if result.verdict == "undecided" else NO)


def _value(setting: str) -> tuple[str, float]:
    name, equals, text = setting.partition("=")
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not equals or not name.strip() or not math.isfinite(value):
        raise InputError("NAME=VALUE with a finite number", repr(setting), "write for example a=0.3", key="--set")
    return name.strip(), value


@main.command()
@click.option("--html", metavar="FILE", type=click.Path(), help="Write a page with all formulas and the code, too.")
@click.option("--overwrite", is_flag=True, help="Replace FILE if it is there.")
@JSON
@_one_message
def paper(html: str | None, overwrite: bool, as_json: bool) -> None:
    """Check every statement of the paper: verdict by verdict."""
    target = None if html is None else _claim_file(Path(html), "--html", overwrite)
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    with progress("judging", unit="statements") as bar:
        report = review_paper(lambda done, total: bar(done / total, done), min(cores, MOST_PROCESSES))
    files = []
    if target is not None:
        from geocosserat.referee.page import page
        from paper_checks.title import AUTHORS, TITLE

        files = [str(write_bytes(target, page(report, TITLE, AUTHORS).encode()))]
    if as_json:
        _print_json({**report.fields, "files": files})
    else:
        from geocosserat.referee.show import print_report

        print_report(report, Console())
        for file in files:
            click.echo(f"wrote {file}")
    if not report.passed:
        sys.exit(NO)


def _claim_file(path: Path, key: str, overwrite: bool) -> Path:
    """Makes sure, before anything is computed, that the file can be written and that none is lost."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        there, folder, writable = path.exists(), path.is_dir(), os.access(path.parent, os.W_OK | os.X_OK)
    except OSError as error:
        found = f"{path}: {error.strerror or error}"
        raise InputError("a file to write", found, f"choose another {key}", key=key) from error
    if folder:
        raise InputError("a file to write", f"{path}, a folder", "name a file in it", key=key)
    if not writable:
        raise InputError("a folder that can be written", f"{path.parent}, read-only", f"choose another {key}", key=key)
    if there and not overwrite:
        raise InputError("no such file yet", str(path), f"choose another {key}, or say --overwrite", key=key)
    return path
