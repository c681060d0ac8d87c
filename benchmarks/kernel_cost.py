"""What a rate costs: the generated C kernel beside a loop written by hand, nanoseconds and operations a Gauss point.

Both run the same rod in the same process, alternating; ratios are of medians. The generated kernel also books the
energies (dissipated and work), which the hand-written loop does not.
"""

import statistics
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import cffi
import numpy as np

from geocosserat.codegen.source import generate
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.kernel.compile import FLAGS, compiler
from geocosserat.kernel.native import DECLARATIONS
from geocosserat.model.scene import load_scene

HAND = """
typedef struct hand {
    int elements;
    double half;
    double stiffness[6], mobility[6];
    const double *values, *slopes, *pull, *push, *share;
    double *work;
} hand;
void hand_planar(const hand *h, const double *y, double *dy);
void hand_spatial(const hand *h, const double *y, double *dy);
double time_rod(const rod *r, const double *y, double *dy, int repeats);
double time_hand_planar(const hand *h, const double *y, double *dy, int repeats);
double time_hand_spatial(const hand *h, const double *y, double *dy, int repeats);
"""
TIMERS = """
#define _POSIX_C_SOURCE 199309L
#include <time.h>
#include "hand_written.c"
typedef struct rod rod;
int rod_rate(const rod *r, double t, const double *y, double *dy);
static double now(void) { struct timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }
#define TIMER(name, type, call) \\
    double name(const type *r, const double *y, double *dy, int repeats) \\
    { const double start = now(); for (int i = 0; i < repeats; ++i) call; return (now() - start) / repeats; }
TIMER(time_rod, rod, rod_rate(r, 0.0, y, dy))
TIMER(time_hand_planar, hand, hand_planar(r, y, dy))
TIMER(time_hand_spatial, hand, hand_spatial(r, y, dy))
"""
FIELDS = ("half", "scale", "mass", "share", "u", "tables", "uniform", "point", "node", "base")
STIFFNESS = {"planar": [900.0, 700.0, 1.5], "spatial": [900.0, 700.0, 600.0, 0.8, 1.5, 1.2]}
FRICTION = {"planar": [1.0, 2.0, 0.01], "spatial": [1.0, 2.0, 1.9, 0.01, 0.02, 0.03]}


def _build(source: str, degree: int, folder: Path) -> tuple[cffi.FFI, Any]:
    """Both kernels as two objects of one library: nothing is inlined across."""
    (folder / "rod.c").write_text(source)
    (folder / "timers.c").write_text(TIMERS)
    tool = compiler()
    if tool is None:
        raise SystemExit("expected a C compiler, found none; this benchmark compares compiled code")
    target = folder / f"both_{degree}.so"
    subprocess.run(
        [tool, *FLAGS, f"-DDEGREE={degree}", f"-I{Path(__file__).parent}", "rod.c", "timers.c", "-o", target, "-lm"],
        check=True,
        cwd=folder,
    )
    ffi = cffi.FFI()
    ffi.cdef(DECLARATIONS + HAND)
    return ffi, ffi.dlopen(str(target))


def _measure(motion: str, degree: int, points: int, rounds: int) -> dict[str, Any]:
    scene = load_scene(
        {
            "rod": {"motion": motion, "length": 1.0, "stiffness": STIFFNESS[motion], "friction": FRICTION[motion]},
            "run": {"until": 1.0},
        }
    )
    rod = discretise(scene, points // degree, degree)
    source = generate(rod.structure)
    with tempfile.TemporaryDirectory() as name:
        ffi, lib = _build(source.c, degree, Path(name))
        times, error = _alternate(ffi, lib, rod, motion, rounds)
    counts = source.signature["operations"]
    p = degree
    # at a point: the pointwise tapes; per component, the maps to and from the nodes are multiply-adds
    maps = 2 * rod.structure.group.dimension * (4 * (p + 1) if p > 1 else 4)
    return {
        "motion": motion,
        "degree": degree,
        "points": points,
        "operations": counts["stress"] + counts["strain_rate"] + counts["velocity"] + maps,
        "generated_ns": [1e9 * t / points for t in (min(times[0]), statistics.median(times[0]))],
        "hand_ns": [1e9 * t / points for t in (min(times[1]), statistics.median(times[1]))],
        "ratio": statistics.median(a / b for a, b in zip(*times, strict=True)),
        "difference": error,
    }


def _alternate(
    ffi: cffi.FFI, lib: Any, rod: SemiDiscrete, motion: str, rounds: int
) -> tuple[tuple[list[float], list[float]], float]:
    mesh, d = rod.mesh, rod.structure.group.dimension
    points = mesh.elements * mesh.degree

    def at(a: np.ndarray) -> Any:
        return ffi.cast("double *", a.ctypes.data)

    kept = [
        mesh.half,
        1 / mesh.half,
        mesh.mass,
        1 / mesh.mass,
        mesh.u,
        rod.tables,
        rod.uniform,
        rod.point,
        rod.node,
        rod.base,
    ]
    kept = [np.ascontiguousarray(a) for a in kept]
    work = np.zeros(lib.rod_work(mesh.elements))
    r = ffi.new("rod *", {"elements": mesh.elements})
    for field, array in zip(FIELDS, kept, strict=True):
        setattr(r, field, at(array))
    r.work = at(work)
    one = mesh.degree * (mesh.degree + 1)  # numbers of each of the first five tables
    tables = [np.ascontiguousarray(t) for t in rod.tables[: 5 * one].reshape(5, one)]
    share, hand_work = 1 / mesh.mass, np.zeros(4 * d * (points + 2))
    h = ffi.new("hand *", {"elements": mesh.elements, "half": mesh.half[0]})
    h.stiffness[0:d] = STIFFNESS[motion]
    h.mobility[0:d] = [1 / f for f in FRICTION[motion]]
    h.values, h.slopes, h.pull, h.push = (at(t) for t in tables[:4])
    h.share, h.work = at(share), at(hand_work)
    rng = np.random.default_rng(1)
    y = rod.state + 0.1 * rng.standard_normal(rod.state.shape)
    out, out_hand = np.zeros_like(y), np.zeros_like(y)
    time_hand = getattr(lib, f"time_hand_{motion}")
    repeats = max(3, 2_000_000 // points // d)
    times: tuple[list[float], list[float]] = ([], [])
    for _ in range(rounds):
        times[0].append(lib.time_rod(r, at(y), at(out), repeats))
        times[1].append(time_hand(h, at(y), at(out_hand), repeats))
    turn = slice(0, d * points)
    scale = np.abs(out[turn]).max()
    return times, float(np.abs(out[turn] - out_hand[turn]).max() / scale)


def measure(rounds: int = 15) -> list[dict[str, Any]]:
    """One row for each motion, degree and size (in cache, and far out of it)."""
    return [
        _measure(motion, degree, points, rounds)
        for motion in ("planar", "spatial")
        for degree in (1, 8)
        for points in (496, 250_000)  # no powers of two: those would favour the padded rows of the generated kernel
    ]


def table(rows: list[dict[str, Any]]) -> str:
    """The rows as a table in Markdown."""
    lines = [
        "| motion | degree | points | operations a point | generated, ns (min, median) | by hand, ns | ratio | gap |",
        "|---|---|---|---|---|---|---|---|",
    ]
    lines += [
        f"| {r['motion']} | {r['degree']} | {r['points']} | {r['operations']} "
        f"| {r['generated_ns'][0]:.2f}, {r['generated_ns'][1]:.2f} | {r['hand_ns'][0]:.2f}, {r['hand_ns'][1]:.2f} "
        f"| {r['ratio']:.2f} | {r['difference']:.0e} |"
        for r in rows
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(table(measure()))
