"""Random scene files, settings, solution files and checkpoints: python -m benchmarks.fuzz_scenes [--seconds N].

Scenes and settings are found by atheris, if it is installed, which is led by what code each input reaches; else they
are mutations of the examples. They are read and checked as `run` does, and what is accepted is made ready to run;
nothing is simulated. Files are damaged at random, and every second one gets a right checksum, as whoever means harm
would make it. An input may be accepted or refused (InputError, ExpressionError, FileError, one line); anything else is
a failure and is printed, as is what takes the processor longer than a second, a scene file ten (each ten times as long
where atheris follows it). Ends with code 1 on failures.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
import time
import warnings
from pathlib import Path

import numpy as np

from benchmarks.faults.trials import damage
from benchmarks.fuzzing import SLOW, SLOW_WHEN_FOLLOWED, Tally, atheris, led, mutated, pieces, quoted
from geocosserat.conductor.run import run
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.model import (
    bounds,
    checks,
    ends,
    evaluation,
    features,
    fields,
    material,
    parameters,
    parser,
    place,
    reading,
    ring,
    scene,
    seen,
    settings,
    start,
    steps,
    tree,
)
from geocosserat.model.effects import reading as effect_reading
from geocosserat.model.records import Scene
from geocosserat.model.scene import load_scene
from geocosserat.planning.resolution import Resolution, instants
from geocosserat.results import seal
from geocosserat.results.checkpoint import NAME as CHECKPOINT
from geocosserat.results.checkpoint import Checkpoint, load_checkpoint, save_checkpoint
from geocosserat.results.netcdf import load

EXAMPLES = Path(__file__).parent.parent / "examples"
SCENES = sorted((*EXAMPLES.glob("*.toml"), *EXAMPLES.glob("stability/*.toml")))
MODULES = (
    bounds, checks, ends, evaluation, features, fields, material, parameters, parser, place, reading, ring, scene, seen,
    settings, start, steps, tree, effect_reading,
)  # fmt: skip
PIECES = pieces(r"""
rod start ends effects run parameters title motion length stiffness friction reference frozen law strain position angle
rotation kind force torque frame twist until frames accuracy elements degree method rtol atol backend joined left right
clamped free pinned driven weight follower couple field flow trap planar spatial body world cvode radau [[effects]]
[ends] [ends.left] [rod] [run] u t s pi sin( exp( log( sqrt( abs( heaviside( tanh( ( ) ** * / + - 9**9**9 1e308 1e-308
1e999 0 -1 0.1 nan inf -inf 99999999999999999999 __class__ __import__('os') lambda u.real [ ] { } = ''' ' \u0000 . , #
\U0010ffff true 1979-05-27 0x1f (1+u)**1000000 a.a.a.a.a.a.a.a.a (((((((((((((((( heaviside(sin(1/u)) sin(1e9*u)
1/(u-0.5) exp(1/t) exp(-1e9*(u-0.3)**2)
""")
DRIVEN = 10.0
"""Times as long as all else a scene may take: two driven ends, each of which changes as often as can be followed, take
four seconds each."""
SETTINGS = (b"rod.length=2", b"run.accuracy=1e-3", b"ends.right.force=[0, -1]", b"kappa=3", b"rod.stiffness.2=u")
SMALL_SCENE = {
    "rod": {"motion": "planar", "length": 1.0, "stiffness": [10.0, 10.0, 1.0], "friction": [1.0, 2.0, 0.1]},
    "effects": [{"kind": "weight", "force": [0.0, -1.0]}],
    "run": {"until": 0.01, "frames": 3, "elements": 1, "degree": 2, "backend": "numpy"},
}


def read_scene(content: bytes) -> Scene:
    """As a file would be read and made ready to run; the scene then reads back from its own text."""
    found = load_scene(content.decode("utf-8-sig", "replace") + "\n")
    str(found)
    load_scene(found.source + "\n")
    ready(found)
    return found


def ready(found: Scene) -> None:
    """All that a run does before it needs a kernel."""
    instants(found)
    Resolution(found).sees_all(1, 4, 1e-3)
    discretise(found, 1, 2)


def read_setting(content: bytes) -> None:
    """As --set has it."""
    load_scene(EXAMPLES / "cantilever.toml", [content.decode("utf-8", "replace")])


def resealed(content: bytes) -> bytes:
    """With a right checksum, if there is still one place for it."""
    at = content.find(seal.MARK.encode())
    if at < 0 or content.count(seal.MARK.encode()) != 1:
        return content
    begin = at + len(seal.MARK)
    return seal.seal(content[:begin] + b"0" * 64 + content[begin + 64 :])


def _files(seconds: float, solutions: Tally, checkpoints: Tally) -> None:
    chance = random.Random(time.time_ns())
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(SMALL_SCENE, folder)
        path = folder / "solution.nc"
        solution = path.read_bytes()
        states = np.linspace(0.0, 1.0, 60).reshape(3, 20)
        save_checkpoint(Checkpoint("a" * 64, 1, (1, 2, 3), states, (np.ones((3, 2)),)), folder)
        checkpoint = (folder / CHECKPOINT).read_bytes()

        def load_solution(content: bytes) -> object:
            path.write_bytes(content)
            return load(path)

        def resume(content: bytes) -> object:
            (folder / CHECKPOINT).write_bytes(content)
            return load_checkpoint(folder)

        end = time.monotonic() + seconds
        while time.monotonic() < end:
            kinds = [(solution, solutions, load_solution), *[(checkpoint, checkpoints, resume)] * 20]
            for good, tally, use in kinds:
                bad = damage(good, chance)
                honest = tally.counts["inputs"] % 2 == 0
                found = tally.take(bad if honest else resealed(bad), use)
                if honest and found is not None:
                    tally.fail("damage was not noticed", bad)


def _mutate(seconds: float, scenes: Tally, changes: Tally) -> None:
    chance = random.Random(time.time_ns())
    seeds = [path.read_bytes() for path in SCENES]
    texts = [*quoted(seeds), *PIECES, *SETTINGS * 20]
    end = time.process_time() + seconds
    while time.process_time() < end:
        content = mutated(seeds, PIECES, chance)
        if scenes.take(content, read_scene) is not None and chance.random() < 0.1 and len(seeds) < 2000:
            seeds.append(content)
        changes.take(mutated(texts, PIECES, chance), read_setting)


def main() -> None:
    """Runs and prints counts."""
    words = argparse.ArgumentParser(description=__doc__.partition("\n")[0] if __doc__ else None)
    words.add_argument("--seconds", type=float, default=60.0, help="of the processor, and half as many for files")
    words.add_argument("--own", action="store_true", help="mutate, even if atheris is installed")
    asked = words.parse_args()
    warnings.simplefilter("error")  # a warning on the terminal is no answer either
    follow = atheris is not None and not asked.own
    slow = SLOW_WHEN_FOLLOWED if follow else SLOW
    files = Tally("solution files", SLOW), Tally("checkpoints", SLOW)
    _files(asked.seconds / 2, *files)
    print(*files, sep="\n", flush=True)
    tallies = Tally("scene files", DRIVEN * slow), Tally("settings", slow)
    if follow:
        seeds = [*(b"\x01" + path.read_bytes() for path in SCENES), *(b"\x00" + setting for setting in SETTINGS)]
        led(asked.seconds, {b"\x01": (tallies[0], read_scene), b"\x00": (tallies[1], read_setting)}, seeds, MODULES)
    if atheris is None:
        print("atheris is not installed (pip install atheris): mutating the scenes under examples instead")
    _mutate(asked.seconds, *tallies)
    print(*tallies, sep="\n")
    if any(tally.failures for tally in (*files, *tallies)):
        sys.exit(1)


if __name__ == "__main__":
    main()
