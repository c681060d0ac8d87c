"""A kernel to take away: its text, the numbers of one scene, and a small program that uses both."""

import json
from collections.abc import Iterable

import numpy as np

from geocosserat.codegen.source import KernelSource, environment, one_line
from geocosserat.discretisation.mesh import Array
from geocosserat.discretisation.semidiscrete import SemiDiscrete


def _arrays(rod: SemiDiscrete) -> dict[str, Array]:
    return {
        "half": rod.mesh.half,
        "mass": rod.mesh.mass,
        "u": rod.mesh.u,
        "u_point": rod.mesh.u_point,
        "tables": rod.tables,
        "uniform": rod.uniform,
        "point": rod.point.ravel(),
        "node": rod.node.ravel(),
        "base": rod.base,
        "start": rod.state,
    }


def _c_array(name: str, values: Iterable[float]) -> str:
    numbers = [repr(float(v)) for v in values] or ["0.0"]  # C knows no empty arrays
    rows = [", ".join(numbers[i : i + 4]) for i in range(0, len(numbers), 4)]
    return f"static const double {name}[] = {{\n    " + ",\n    ".join(rows) + "\n};\n"


def _header(rod: SemiDiscrete, until: float) -> str:
    mesh = rod.mesh
    arrays = {**_arrays(rod), "scale": 1 / mesh.half, "share": 1 / mesh.mass}
    names = ", ".join(f'"{name}"' for name in rod.structure.state_names)
    return (
        "/* The numbers of one scene, for the kernel rod.c. */\n"
        f"enum {{ ELEMENTS = {mesh.elements}, POINTS = {mesh.elements * mesh.degree}, SIZE = {len(rod.state)} }};\n"
        f"static const double UNTIL = {until!r};\n"
        f"static const char *const names[] = {{ {names} }};\n"
        + "".join(_c_array(name, np.ravel(values)) for name, values in arrays.items())
    )


def take_away(source: KernelSource, rod: SemiDiscrete, until: float, title: str, backend: str) -> dict[str, str]:
    """Files by name: the kernel, its signature, the scene's numbers and a driver; needs no geocosserat.

    backend "c": build with `make`; "numpy": run `python driver.py`.
    """
    signature = json.dumps(source.signature, indent=2) + "\n"

    def render(template: str) -> str:
        known = {"title": one_line(title), "degree": rod.mesh.degree}
        frozen = [int(fixed) for fixed in rod.structure.constrained]
        return environment().get_template(template).render(**known, d=rod.structure.group.dimension, frozen=frozen)

    if backend == "c":
        return {
            "rod.c": source.c,
            "rod.h": render("rod.h.j2"),
            "scene.h": _header(rod, until),
            "driver.c": render("driver.c.j2"),
            "Makefile": render("Makefile.j2"),
            "signature.json": signature,
        }
    scene = {
        "elements": rod.mesh.elements,
        "degree": rod.mesh.degree,
        "until": until,
        "state": list(rod.structure.state_names),
        "arrays": {name: [float(v) for v in np.ravel(values)] for name, values in _arrays(rod).items()},
    }
    return {
        "rod.py": source.numpy,
        "scene.json": json.dumps(scene) + "\n",
        "driver.py": render("driver.py.j2"),
        "signature.json": signature,
    }
