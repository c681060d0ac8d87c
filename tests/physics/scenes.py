"""Scenes of the physics tests, and runs of them at a fixed mesh."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import geocosserat
from geocosserat.conductor.kernels import kernel_text
from geocosserat.conductor.run import Run
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.kernel.load import load
from geocosserat.kernel.pure import NumpyRod
from geocosserat.model.scene import load_scene

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Scene = dict[str, Any]
EXAMPLES = Path(__file__).parents[2] / "examples"
NAMES = sorted(path.stem for path in EXAMPLES.glob("*.toml"))


def example(name: str) -> Scene:
    """An example as a mapping."""
    with open(EXAMPLES / f"{name}.toml", "rb") as file:
        return tomllib.load(file)


def changed(scene: Mapping[str, Any], changes: Mapping[str, Any]) -> Scene:
    """A copy of a scene with the entries at dotted paths set."""
    result = copy.deepcopy(dict(scene))
    for path, value in changes.items():
        *tables, last = path.split(".")
        target = result
        for table in tables:
            target = target.setdefault(table, {})
        target[last] = value
    return result


def simulate(
    scene: Mapping[str, Any], elements: int, degree: int, rtol: float = 1e-11, backend: str = "numpy", **run: Any
) -> Run:
    """The scene at a fixed mesh and tolerance; in numpy, which needs no compiling and gives what C gives."""
    settings = {"elements": elements, "degree": degree, "rtol": rtol, "backend": backend, "frames": 2, **run}
    return geocosserat.run(changed(scene, {f"run.{key}": value for key, value in settings.items()}))


def tip(run: Run) -> Array:
    """Position of the right end at the end."""
    return np.array(run.tip["position"])


def semidiscrete(scene: Mapping[str, Any], elements: int, degree: int) -> tuple[SemiDiscrete, NumpyRod]:
    """The semi-discrete rod of a scene and its kernel."""
    rod = discretise(load_scene(scene), elements, degree)
    kernel = load(kernel_text(rod.structure), rod, "numpy")
    assert isinstance(kernel, NumpyRod)
    return rod, kernel


def gap(found: ArrayLike, expected: ArrayLike) -> float:
    """Largest difference of any entry."""
    return float(np.abs(np.asarray(found) - np.asarray(expected)).max())


def growths(scene: Mapping[str, Any], elements: int, degree: int) -> Complex:
    """Growths (1 / time) of small changes of the rod about its start: the slow ones to most digits.

    Solutions of J x = growth M x, M without the constraints, by inverting J - shift M.
    """
    rod, kernel = semidiscrete(scene, elements, degree)
    size = rod.unknowns
    moves = 1.0 - rod.algebraic[:size]
    shift = 0.3 + 0.7j  # no growth of any rod here
    inverse = np.linalg.solve(kernel.jacobian(0.0, rod.state)[:size, :size] - shift * np.diag(moves), np.diag(moves))
    found = np.linalg.eigvals(inverse)
    return np.asarray(shift + 1.0 / found[np.abs(found) > 1e-14 * np.abs(found).max()], dtype=complex)


def farthest(wanted: ArrayLike, among: ArrayLike) -> float:
    """How far, relative to itself, a wanted number is at most from the nearest one among the others."""
    return max(float(np.abs(np.asarray(among) / x - 1.0).min()) for x in np.asarray(wanted))


def straight(
    stiffness: list[Any], friction: list[Any], left: str = "clamped", right: str = "free", length: float = 1.0
) -> Scene:
    """A rod that is straight at rest, without loads; planar or spatial by the number of its coefficients."""
    motion = "planar" if len(stiffness) == 3 else "spatial"
    return {
        "rod": {"motion": motion, "length": length, "stiffness": stiffness, "friction": friction},
        "start": {},
        "ends": {"left": {"kind": left}, "right": {"kind": right}},
        "run": {"until": 1.0},
    }


def polynomial(u: Array, values: Array, degree: int) -> str:
    """An expression of u that fits the values, in powers of (u - middle) so that it keeps its digits."""
    middle = float(0.5 * (u[0] + u[-1]))
    fit = np.polynomial.Polynomial.fit(u, values, degree, domain=[u[0], u[-1]], window=[u[0] - middle, u[-1] - middle])
    terms = [f"({c!r})*(u - {middle!r})**{k}" for k, c in enumerate(map(float, fit.coef))]
    return " + ".join(terms)
