"""One picture of a run: the rod over time, its energy and its strain."""

from __future__ import annotations

import io
import os
import textwrap
import warnings
from pathlib import Path

import matplotlib
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from geocosserat.results import style
from geocosserat.results.atomic import write_bytes
from geocosserat.results.curves import moments, way
from geocosserat.results.errors import FileError
from geocosserat.results.panels import draw_ledger, draw_turn, liveliest
from geocosserat.results.shapes import draw_planar, draw_spatial
from geocosserat.results.solution import Solution

SUFFIXES = (".png", ".svg", ".pdf")
_SHAPES, _CURVES = {"planar": 24, "spatial": 14}, 9


def picture(solution: Solution, path: str | os.PathLike[str]) -> Path:
    """Draw the solution and write it, atomically, as PNG, SVG or PDF, by the suffix of the path.

    Raises FileError for any other suffix and when the file cannot be written.
    """
    target = Path(path)
    if target.suffix.lower() not in SUFFIXES:
        raise FileError(target, f"a name that ends in {', '.join(SUFFIXES)}", repr(target.suffix),
                        "rename the picture")
    image = io.BytesIO()
    kind = target.suffix.lower()[1:]
    # no date inside, so that the same run gives the same bytes
    metadata = {} if kind == "png" else {"Date" if kind == "svg" else "CreationDate": None}
    with matplotlib.rc_context(style.RC), warnings.catch_warnings():
        # a title in a script that no font at hand has
        warnings.filterwarnings("ignore", message="Glyph", category=UserWarning)
        _draw(solution).savefig(image, format=kind, metadata=metadata)
    return write_bytes(target, image.getvalue())


def figure(solution: Solution) -> Figure:
    """The matplotlib figure behind `picture`, to change it before saving."""
    with matplotlib.rc_context(style.RC):
        return _draw(solution)


def _draw(solution: Solution) -> Figure:
    result = Figure(figsize=style.SIZE, dpi=style.DPI)
    FigureCanvasAgg(result)
    power = style.time_power(solution.time, way(solution))
    colours = style.time_colours(solution.time, power)
    planar = solution.motion == "planar"
    shown = liveliest(solution, 1 if planar else 2)
    shapes, curves = moments(solution, _SHAPES[solution.motion]), moments(solution, _CURVES)
    if planar:
        draw_planar(result.add_axes((0.065, 0.11, 0.48, 0.77)), solution, shapes, colours)
    else:
        draw_spatial(result.add_axes((0.01, 0.02, 0.54, 0.9), projection="3d"), solution, shapes, colours)
    _colour_bar(result, colours, power)
    right = _stack(result, 1 + len(shown))
    draw_ledger(right[0], solution)
    for axes, component in zip(right[1:], shown, strict=True):
        draw_turn(axes, solution, component, curves, colours)
        if axes is not right[-1]:
            axes.tick_params(labelbottom=False)
            axes.set_xlabel("")
    for axes in result.axes:
        style.fold_powers(axes)
    # a title may hold dollar signs and is not mathematics
    result.text(0.02, 0.965, textwrap.shorten(solution.title, 90, placeholder=" ..."), fontsize=12,
                fontweight="bold", va="top", parse_math=False)
    return result


def _colour_bar(result: Figure, colours: ScalarMappable, power: float) -> None:
    bar = result.colorbar(colours, cax=result.add_axes((0.57, 0.2, 0.01, 0.6)))
    if power < 1:
        ticks = style.time_ticks(*bar.ax.get_ylim(), power)
        bar.set_ticks(ticks, labels=[f"{time:.3g}" for time in ticks])
        bar.ax.minorticks_off()
    bar.outline.set_visible(False)
    bar.ax.set_title("$t$", pad=6)


def _stack(result: Figure, count: int) -> list[Axes]:
    """Panels below each other at the right; the lower ones share the place on the rod."""
    left, width, bottom, top, gap = 0.71, 0.27, 0.11, 0.83, 0.04
    upper = 0.33 if count == 2 else 0.25
    lower = (top - upper - bottom - 0.13 - gap * (count - 2)) / (count - 1)
    panels = [result.add_axes((left, top - upper, width, upper))]
    for number in range(count - 1):
        panels.append(result.add_axes((left, bottom + (count - 2 - number) * (lower + gap), width, lower)))
    return panels
