"""States of rest as pictures: the rod, the motions that grow or decay most slowly, and what becomes of them."""

from __future__ import annotations

import io
import os
import textwrap
import warnings
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D

from geocosserat.results import style
from geocosserat.results.atomic import write_bytes
from geocosserat.results.curves import smooth
from geocosserat.results.shapes import frame_box
from geocosserat.results.solution import Array, Solution
from geocosserat.results.stability import Complex, Followed, Map, Modes, Stability
from geocosserat.results.summary import count

COLOURS = ("#0072b2", "#d55e00", "#009e73")
"""Of the motions shown, and of the branches."""

SWING = 0.18
"""How far a motion is drawn from the rod, relative to its length."""


def rest_picture(
    solution: Solution, modes: Modes, further: Sequence[Solution], path: str | os.PathLike[str]
) -> Path:
    """Draws a state of rest, its leading motions and further states of rest, and writes it as `picture` does."""
    with matplotlib.rc_context(style.RC):
        result = _page(solution.title)
        _draw_rod(result, (0.07, 0.11, 0.5, 0.76), solution, modes, further)
        _draw_rates(result.add_axes((0.68, 0.13, 0.29, 0.7)), modes)
        return _save(result, path)


def picture(record: Stability, path: str | os.PathLike[str]) -> Path:
    """Draws what `stability` found, and writes it, atomically, as PNG, SVG or PDF by the suffix.

    Raises FileError when the file cannot be written.
    """
    if record.followed is None and record.map is None:
        return rest_picture(record.solution, record.modes, (), path)
    with matplotlib.rc_context(style.RC):
        result = _page(record.solution.title)
        _draw_rod(result, (0.07, 0.11, 0.35, 0.76), record.solution, record.modes, ())
        if record.followed is not None:
            bottom = result.add_axes((0.54, 0.11, 0.43, 0.36))
            top = result.add_axes((0.54, 0.53, 0.43, 0.36), sharex=bottom)
            top.tick_params(labelbottom=False)
            _draw_branches(top, record.followed)
            _draw_growth(bottom, record.followed)
        elif record.map is not None:
            _draw_map(result, record.map)
        return _save(result, path)


def _page(title: str) -> Figure:
    result = Figure(figsize=style.SIZE, dpi=style.DPI)
    FigureCanvasAgg(result)
    # a title may hold dollar signs and is not mathematics
    result.text(0.02, 0.965, textwrap.shorten(title, 90, placeholder=" ..."), fontsize=12, fontweight="bold",
                va="top", parse_math=False)
    return result


def _save(result: Figure, path: str | os.PathLike[str]) -> Path:
    target, image = Path(path), io.BytesIO()
    kind = target.suffix.lower()[1:]
    with warnings.catch_warnings():
        # a title in a script that no font at hand has
        warnings.filterwarnings("ignore", message="Glyph", category=UserWarning)
        result.savefig(image, format=kind, metadata={} if kind == "png" else {"Date": None})
    return write_bytes(target, image.getvalue())


def _draw_rod(
    result: Figure,
    where: tuple[float, float, float, float],
    solution: Solution,
    modes: Modes,
    further: Sequence[Solution],
) -> None:
    """The rod, thick; its leading motions to either side, thin; further states of rest, grey."""
    planar = solution.motion == "planar"
    curves = [(_smooth(solution, solution.position[0]), style.INK, 2.4, "-")]
    curves += [(_smooth(other, other.position[0]), style.FAINT, 1.2, "-") for other in further]
    for colour, (growth, shape) in zip(COLOURS, _distinct(modes), strict=False):
        for turn in (1, -1) if abs(growth.imag) == 0 else (1, 1j, -1, -1j):
            moved = solution.position[0] + SWING * solution.length * (shape * turn).real
            curves.append((_smooth(solution, moved), colour, 0.9, "-" if turn == 1 else "--"))
    if planar:
        axes = result.add_axes(where)
        for points, colour, width, dashes in curves:
            axes.plot(*points.T, color=colour, linewidth=width, linestyle=dashes)
        axes.set_aspect("equal", adjustable="datalim")
        axes.margins(0.06)
        axes.set_xlabel("$x$")
        axes.set_ylabel("$y$", rotation=0, labelpad=6)
        return
    space: Axes3D = result.add_axes(where, projection="3d")
    for points, colour, width, dashes in curves:
        space.plot(*points.T, color=colour, linewidth=width, linestyle=dashes)
    frame_box(space, np.concatenate([points for points, *_ in curves]))


def _distinct(modes: Modes) -> list[tuple[complex, Complex]]:
    """Rates and shapes, without the second one of a pair."""
    return [(g, shape) for g, shape in zip(modes.growth.tolist(), modes.shapes, strict=True) if g.imag >= 0]


def _smooth(solution: Solution, positions: Array) -> Array:
    points: Array = smooth(solution, positions[None])[1][0]
    return points


def _draw_rates(axes: Axes, modes: Modes) -> None:
    """Growth rates in the complex plane; to the right of the line they grow."""
    axes.axvline(0.0, color=style.FAINT, linewidth=0.8)
    shown = [growth for growth, _ in _distinct(modes)]
    for growth in modes.growth.tolist():
        number = int(np.abs(np.array(shown) - complex(growth.real, abs(growth.imag))).argmin())
        colour = COLOURS[number] if number < len(COLOURS) else style.INK
        axes.plot(growth.real, growth.imag, marker="o", color=colour, markersize=5, zorder=3)
    axes.set_xlabel("growth rate (1 / time)")
    axes.set_ylabel("frequency (radians / time)")
    words = "stable" if modes.stable else f"unstable: {count(modes.unstable, 'small motion')} that grow"
    axes.set_title(words + (f", {modes.neutral} neutral" if modes.neutral else ""))
    sizes = np.abs(modes.growth.real[np.abs(modes.growth.real) > 0])
    if sizes.size and sizes.max() > 20 * sizes.min():
        axes.set_xscale("symlog", linthresh=float(sizes.min()))
    if not np.any(modes.growth.imag):
        axes.set_ylim(-1.0, 1.0)
        axes.set_yticks([0.0])


def _draw_branches(axes: Axes, followed: Followed) -> None:
    """How far the right end is from where it begins to be, along each branch; dashed where small motions grow."""
    start = np.array(followed.branches[0][0].tip)
    across = _widest(followed, start)
    for number, branch in enumerate(followed.branches):
        values = np.array([point.value for point in branch])
        heights = np.array([(np.array(point.tip) - start) @ across for point in branch])
        growing = np.array([point.growth > 0 for point in branch])
        colour = style.INK if number == 0 else COLOURS[(number - 1) // 2 % len(COLOURS)]
        for a, b in _pieces(growing):
            dashes = "--" if growing[a] else "-"
            axes.plot(values[a:b + 1], heights[a:b + 1], color=colour, linewidth=1.4, linestyle=dashes)
    for crossing in followed.crossings:
        axes.axvline(crossing.value, color=style.FAINT, linewidth=0.7, linestyle=(0, (1, 2)), zorder=0)
    axes.set_ylabel("right end, moved by")
    axes.set_title("dashed: not stable")


def _widest(followed: Followed, start: Array) -> Array:
    """The direction in which the right ends of the branches lie apart, or that in which the one there is moves most."""
    _, *sides = followed.branches
    moves = np.array([np.array(point.tip) - start for branch in followed.branches for point in branch])
    if len(sides) > 1:
        moves = np.array([np.array(a.tip) - np.array(b.tip) for a, b in zip(*sides[:2], strict=False)])
    found: Array = np.linalg.svd(moves, full_matrices=False)[2][0]
    return found if found[np.abs(found).argmax()] > 0 else -found


def _pieces(growing: Array) -> list[tuple[int, int]]:
    """Stretches of neighbours that are alike, each up to the first of the next."""
    edges = [0, *(np.flatnonzero(growing[1:] != growing[:-1]) + 1), len(growing)]
    return [(int(a), min(int(b), len(growing) - 1)) for a, b in pairwise(edges)]


def _draw_growth(axes: Axes, followed: Followed) -> None:
    """The leading growth rate along each branch, and the frequency of those that oscillate."""
    axes.axhline(0.0, color=style.FAINT, linewidth=0.8)
    for number, branch in enumerate(followed.branches):
        colour = style.INK if number == 0 else COLOURS[(number - 1) // 2 % len(COLOURS)]
        values = [point.value for point in branch]
        axes.plot(values, [point.growth for point in branch], color=colour, linewidth=1.2)
        if any(point.frequency for point in branch):
            axes.plot(values, [point.frequency for point in branch], color=colour, linewidth=0.9, linestyle=":")
    for crossing in followed.crossings:
        axes.plot(crossing.value, 0.0, marker="o", color="#d55e00", markersize=4)
    axes.set_xlabel(followed.key)
    axes.set_ylabel("growth (dotted: frequency)")
    style.fold_powers(axes)


def _draw_map(result: Figure, map: Map) -> None:
    """The sign of the leading growth rate over two values, and the line where it changes."""
    axes = result.add_axes((0.53, 0.11, 0.38, 0.76))
    largest = float(np.nanmax(np.abs(map.growth), initial=1e-300))
    drawn = axes.pcolormesh(map.first, map.second, map.growth, cmap="RdBu_r", vmin=-largest, vmax=largest,
                            shading="nearest")
    if np.nanmin(map.growth) < 0 < np.nanmax(map.growth):
        axes.contour(map.first, map.second, map.growth, levels=[0.0], colors=style.INK, linewidths=1.2)
    axes.set_xlabel(map.keys[0])
    axes.set_ylabel(map.keys[1])
    bar = result.colorbar(drawn, cax=result.add_axes((0.925, 0.2, 0.012, 0.58)))
    bar.outline.set_visible(False)
    bar.ax.set_title("growth", pad=6)
