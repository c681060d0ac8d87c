"""Everything that is measured, one after the other, into benchmarks/RESULTS.md: python -m benchmarks."""

import os
import platform
from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path

from benchmarks import (
    bindings,
    convergence,
    growth,
    homing,
    honesty,
    kernel_cost,
    linear_solvers,
    profile,
    pruning,
    startup,
)
from benchmarks.peers import __main__ as peers
from geocosserat.kernel.compile import FLAGS, compiler

LIBRARIES = ("numpy", "scipy", "sympy", "scikit-sundae", "cffi", "matplotlib")


def _machine() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        name = next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        name = platform.processor()
    versions = ", ".join(f"{library} {version(library)}" for library in LIBRARIES)
    return (
        f"{name}, {os.cpu_count()} cores, {platform.system()}; Python {platform.python_version()}, {versions}; "
        f"{Path(compiler() or 'no compiler').name} {' '.join(FLAGS)}"
    )


SECTIONS: tuple[tuple[str, str, Callable[[], str]], ...] = (
    (
        "A rate of a generated kernel, beside one written by hand",
        "kernel_cost",
        lambda: kernel_cost.table(kernel_cost.measure()),
    ),
    ("Bindings", "bindings", bindings.table),
    ("Linear solvers", "linear_solvers", linear_solvers.table),
    ("Whole runs from the shell, in seconds (minimum, median)", "startup", startup.table),
    ("What each mode and each effect costs", "pruning", pruning.report),
    ("Time to an error, beside other programs", "peers", peers.tables),
    ("Where the time of short runs goes", "profile", profile.table),
    ("Growth with the number of elements", "growth", growth.tables),
    ("The error asked for and the error got", "honesty", honesty.table),
    ("How far a held end strays from its place, relative to the length", "homing", homing.table),
    ("Error of the tip, relative to the length", "convergence", convergence.tables),
)


def _parts() -> Iterator[str]:
    """The page, part by part as it is measured."""
    yield f"# Measured\n\nOn {_machine()}.\n\n`make bench` measures all of it again. Shared machines are noisy:"
    yield "trust ratios and minima rather than single times.\n"
    for title, module, table in SECTIONS:
        yield f"## {title}\n\n`python -m benchmarks.{module}`\n\n{table()}"


def main() -> None:
    """Runs all, prints each part as soon as it is measured, and writes the page when all are."""
    parts = []
    for part in _parts():
        print(part, flush=True)
        parts.append(part)
    (Path(__file__).parent / "RESULTS.md").write_text("\n".join(parts))


if __name__ == "__main__":
    main()
