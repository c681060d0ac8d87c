"""From a scene to its equations, and to code that can be taken away."""

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geocosserat.conductor.folder import claimed
from geocosserat.conductor.scene import SceneLike, load_any
from geocosserat.conductor.simulate import chosen_setting
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.discretisation.structuring import structure_of
from geocosserat.model.errors import InputError
from geocosserat.planning.settings import Setting
from geocosserat.results.atomic import write_bytes


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
    with claimed(folder, overwrite, tuple(files)):
        for name, content in files.items():
            write_bytes(folder / name, content.encode())
    return Generated(backend, tuple(folder / name for name in files), json.loads(files["signature.json"]))
