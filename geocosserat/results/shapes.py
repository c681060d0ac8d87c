"""The rod itself: its shapes over time, in the plane and in space."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d import Axes3D, proj3d
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from numpy.typing import NDArray

from geocosserat.results import style
from geocosserat.results.curves import smooth
from geocosserat.results.solution import Array, Solution

_THIN, _THICK = 0.9, 2.6
_FILLED = np.array([0.84, 0.78])  # of the axes, by the box in space: the rest is for numbers and names


def draw_planar(axes: Axes, solution: Solution, frames: NDArray[np.intp], colours: ScalarMappable) -> None:
    """Shapes in the colours of their times, first and last thick, the way of the tip, and both ends."""
    _, shapes = smooth(solution, solution.position[frames])
    x, y = solution.position[..., 0], solution.position[..., 1]
    axes.plot(x[:, -1], y[:, -1], color=style.FAINT, linewidth=0.8, linestyle=(0, (1, 1.5)), zorder=1)
    for number, (moment, shape) in enumerate(zip(solution.time[frames], shapes, strict=True)):
        emphasised = number in (0, len(frames) - 1)
        axes.plot(shape[:, 0], shape[:, 1], color=colours.to_rgba(moment), zorder=3 if emphasised else 2,
                  linewidth=_THICK if emphasised else _THIN, solid_capstyle="round")
    for frame, fill in ((0, "white"), (-1, style.INK)):
        for node, marker, size in ((0, "s", 5.0), (-1, "o", 4.5)):
            axes.plot(x[frame, node], y[frame, node], marker=marker, markersize=size, color=style.INK,
                      markerfacecolor=fill, markeredgewidth=0.9, linestyle="none", zorder=4)
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(0.06)
    axes.set_xlabel("$x$")
    axes.set_ylabel("$y$", rotation=0, labelpad=8)


def draw_spatial(axes: Axes3D, solution: Solution, frames: NDArray[np.intp], colours: ScalarMappable) -> None:
    """Shapes in the colours of their times, the first and last with ribbons along e_2 that show the twist."""
    axes.computed_zorder = False  # by depth, the markers would sink into the ribbons
    _, shapes = smooth(solution, solution.position[frames])
    tip = solution.position[:, -1]
    axes.plot(*tip.T, color=style.FAINT, linewidth=0.8, linestyle=(0, (1, 1.5)), zorder=1)
    for number, (moment, shape) in enumerate(zip(solution.time[frames], shapes, strict=True)):
        emphasised = number in (0, len(frames) - 1)
        axes.plot(*shape.T, color=colours.to_rgba(moment), zorder=3 if emphasised else 2,
                  linewidth=1.8 if emphasised else _THIN)
    for frame, fill in ((0, "white"), (-1, style.INK)):
        _draw_ribbon(axes, solution, frame, colours)
        for node, marker, size in ((0, "s", 5.0), (-1, "o", 4.5)):
            axes.plot(*solution.position[frame, node][:, None], marker=marker, markersize=size, zorder=4,
                      color=style.INK, markerfacecolor=fill, markeredgewidth=0.9, linestyle="none")
    frame_box(axes, shapes.reshape(-1, 3))


def _draw_ribbon(axes: Axes3D, solution: Solution, frame: int, colours: ScalarMappable) -> None:
    """A band about the rod between the tips of short vectors along e_2 and -e_2."""
    fields = np.concatenate((solution.position[frame], solution.rotation[frame][..., 1]), axis=-1)
    _, drawn = smooth(solution, fields[None], pieces=150)
    centre, across = drawn[0, :, :3], 0.025 * solution.length * drawn[0, :, 3:]
    one, other = centre - across, centre + across
    quads = np.stack((one[:-1], one[1:], other[1:], other[:-1]), axis=1)
    colour = colours.to_rgba(solution.time[frame])
    axes.add_collection3d(Poly3DCollection(quads, facecolors=colour, edgecolors="none", alpha=0.35, zorder=1))


def frame_box(axes: Axes3D, points: Array) -> None:
    """Equal scales, a box no flatter than a third of its longest side, a view across the motion."""
    points = points[np.all(np.isfinite(points), axis=1)]
    low, high = (points.min(axis=0), points.max(axis=0)) if len(points) else (np.zeros(3), np.ones(3))
    longest = max(float((high - low).max()), 1e-12 * float(np.abs([low, high]).max()), 1e-300)
    sides = np.maximum(1.08 * (high - low), longest / 3)
    start, end = (low + high - sides) / 2, (low + high + sides) / 2
    axes.set(xlim=(start[0], end[0]), ylim=(start[1], end[1]), zlim=(start[2], end[2]))
    axes.set_proj_type("ortho")  # lengths in the picture then compare, wherever they are
    axes.view_init(elev=24, azim=_azimuth(points))
    axes.set_box_aspect(sides)
    corners = np.array(np.meshgrid(*zip(start, end, strict=True))).reshape(3, 8)
    across, up, _ = proj3d.proj_transform(*corners, axes.get_proj())
    drawn = np.ptp(axes.transData.transform(np.column_stack((across, up))), axis=0)
    axes.set_box_aspect(sides, zoom=float(np.min(_FILLED * [axes.bbox.width, axes.bbox.height] / drawn)))
    for axis, name, side in zip((axes.xaxis, axes.yaxis, axes.zaxis), "xyz", sides, strict=True):
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
        axis._axinfo["grid"] |= {"color": "#dddddd", "linewidth": 0.5}
        axis.line.set_color(style.FAINT)
        axis.set_label_text(f"${name}$")
        axis.set_major_locator(MaxNLocator(max(2, round(4 * side / sides.max()))))
        axis.set_tick_params(pad=0)
        axis.labelpad = 0


def _azimuth(points: Array) -> float:
    """Look along the horizontal direction in which the motion is thinnest, a little from the side.

    Of the two sides, the one from which the longer of x and y runs to the right.
    """
    if len(points) < 2:
        return -60.0
    horizontal = points[:, :2] - points[:, :2].mean(axis=0)
    _, directions = np.linalg.eigh(horizontal.T @ horizontal)
    thin = directions[:, 0]
    right = np.array([-thin[1], thin[0]])
    if right[np.abs(right).argmax()] < 0:
        thin = -thin
    return float(np.degrees(np.arctan2(thin[1], thin[0]))) + 25.0
