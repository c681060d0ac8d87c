"""What accuracy costs, as a picture: error against seconds and against unknowns, the front, models as levels."""

from __future__ import annotations

import io
import os
import textwrap
from collections.abc import Callable
from pathlib import Path

import matplotlib
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from geocosserat.results import style
from geocosserat.results.atomic import write_bytes
from geocosserat.results.diagram import AS_GIVEN, Diagram, Point
from geocosserat.results.diagram_table import notes

# Okabe and Ito's colours for methods; shapes for models
COLOURS = {"cvode": "#0072b2", "radau": "#d55e00", "bdf": "#009e73", "lsoda": "#cc79a7"}
SHAPES = ("o", "s", "^", "D", "v")


def picture(diagram: Diagram, path: str | os.PathLike[str]) -> Path:
    """Draws the diagram and writes it, atomically, as PNG, SVG or PDF by the suffix. Raises FileError if it cannot."""
    kind = Path(path).suffix.lower()[1:]
    image = io.BytesIO()
    with matplotlib.rc_context(style.RC):
        _draw(diagram).savefig(image, format=kind, metadata={} if kind == "png" else {"Date": None})
    return write_bytes(Path(path), image.getvalue())


def _draw(diagram: Diagram) -> Figure:
    result = Figure(figsize=(9.0, 5.4), dpi=style.DPI)
    FigureCanvasAgg(result)
    left = result.add_axes((0.075, 0.25, 0.415, 0.62))
    right = result.add_axes((0.565, 0.25, 0.415, 0.62), sharey=left)
    shapes = dict(zip([AS_GIVEN, *(model.model for model in diagram.models)], SHAPES, strict=False))
    _points(left, diagram, shapes, lambda point: 1e3 * point.seconds)
    _points(right, diagram, shapes, lambda point: float(point.unknowns))
    front = [diagram.points[i] for i in diagram.front]
    errors = [max(point.error or 0.0, diagram.floor) for point in front]
    left.step([1e3 * point.seconds for point in front], errors, where="post", color=style.INK, linewidth=1.0, zorder=1)
    left.set_xlabel("milliseconds of the integration")
    right.set_xlabel("unknowns")
    left.set_ylabel("error of positions at the end / length")
    _legend(left, diagram, shapes)
    result.text(0.02, 0.965, textwrap.shorten(diagram.title, 90, placeholder=" ..."), fontsize=12, fontweight="bold",
                va="top", parse_math=False)  # fmt: skip
    foot = "\n".join(line for note in notes(diagram) for line in textwrap.wrap(note, 190))
    result.text(0.02, 0.015, foot, fontsize=5.5, color=style.FAINT, va="bottom", parse_math=False)
    return result


def _points(axes: Axes, diagram: Diagram, shapes: dict[str, str], along: Callable[[Point], float]) -> None:
    top = max((p.error for p in diagram.points if p.error is not None), default=1.0)
    for point in diagram.points:
        failed = point.error is None
        y = 3.0 * top if point.error is None else max(point.error, diagram.floor)
        axes.plot(along(point), y, marker="x" if failed else shapes.get(point.model, "P"), markersize=3.5, linestyle="",
                  color=COLOURS.get(point.method, style.INK), alpha=0.8, markeredgewidth=0.6,
                  markerfacecolor="none" if not failed and _hollow(point) else None)  # fmt: skip
    for model in diagram.models:
        if model.error is not None:
            axes.axhline(model.error, color=style.FAINT, linewidth=0.8, linestyle=(0, (4, 3)), zorder=0)
    axes.axhspan(0.2 * diagram.floor, diagram.floor, color="#eeeeee", zorder=0)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(0.5 * diagram.floor, 6.0 * top)


def _hollow(point: Point) -> bool:
    """Low degrees are hollow."""
    return point.degree == 1


def _legend(axes: Axes, diagram: Diagram, shapes: dict[str, str]) -> None:
    methods = list(dict.fromkeys(point.method for point in diagram.points))
    handles = [Line2D([], [], color=COLOURS.get(m, style.INK), marker="o", linestyle="", label=m) for m in methods]
    used = list(dict.fromkeys(point.model for point in diagram.points))
    handles += [
        Line2D([], [], color=style.INK, marker=shapes.get(m, "P"), linestyle="", label=m) for m in used if len(used) > 1
    ]
    handles.append(Line2D([], [], color=style.INK, linewidth=1.0, label="nothing better"))
    if any(point.degree == 1 for point in diagram.points):
        handles.append(Line2D([], [], color=style.INK, marker="o", mfc="none", linestyle="", label="degree 1"))
    if any(point.error is None for point in diagram.points):
        handles.append(Line2D([], [], color=style.INK, marker="x", linestyle="", label="failed"))
    axes.legend(handles=handles, loc="lower left", bbox_to_anchor=(-0.02, 1.0), ncols=7, borderaxespad=0.2,
                handlelength=1.0, columnspacing=1.0, handletextpad=0.4)  # fmt: skip
