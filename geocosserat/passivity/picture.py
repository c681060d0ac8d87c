"""Pictures of what makes a law active or unstable: the curl of its stress with a loop through it, and its stability."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from geocosserat.algebra.groups import SE2, SE3
from geocosserat.passivity.maps import StabilityMap
from geocosserat.passivity.tangent import Floats

INK, HALO, NOTHING, PARABOLIC = "#222222", "#ffffff", "#d9d9d9", "#009e73"
# orange to purple: told apart with any kind of colour blindness, and zero is near to white
DIVERGING: Final = "PuOr_r"

RC: Any = {
    "font.family": ["STIXGeneral", "DejaVu Sans"],
    "mathtext.fontset": "stix",
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.labelsize": 9,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "legend.fontsize": 8,
    "axes.linewidth": 0.7,
    "lines.linewidth": 1.4,
    "legend.frameon": False,
    "text.color": INK,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.formatter.limits": (-3, 4),
    "axes.formatter.use_mathtext": True,
    "svg.hashsalt": "geocosserat",
    "pdf.fonttype": 42,
}
_WIDTH, _HEIGHT, _DPI = 4.5, 3.9, 200  # inches for each panel
_MODES = {"h1": "stretch", "h2": "shear", "h3": "shear", "Pi": "bend", "Pi1": "twist", "Pi2": "bend", "Pi3": "bend"}
_STRESS = {**dict(zip(SE3.strain, SE3.stress, strict=True)), **dict(zip(SE2.strain, SE2.stress, strict=True))}


@dataclass(frozen=True)
class Curl:
    """The antisymmetric part of a tangent over two strain components, and a loop in their plane.

    ``names``: those two, x then y. ``x`` (m,), ``y`` (n,): their values, evenly spaced; ``values`` (n, m):
    d stress_x / d y - d stress_y / d x. ``loop_x``, ``loop_y``: points of the loop, empty if there is none, run
    through in their order; ``text``: its net work, say.
    """

    names: tuple[str, str]
    x: Floats
    y: Floats
    values: Floats
    loop_x: Floats
    loop_y: Floats
    text: str = ""


def draw(
    *,
    curl: Curl | None = None,
    stability: StabilityMap | None = None,
    lost: Mapping[str, float] | None = None,
    title: str = "",
) -> Figure:
    """A figure with a panel for each map that is given; ``lost``: strains where definiteness is lost first.

    Raises ValueError if there is nothing to draw.
    """
    panels = [part for part in (curl, stability) if part is not None]
    if not panels:
        raise ValueError("picture of a law: expected a map of the curl or of the stability, found neither; give one")
    with matplotlib.rc_context(RC):
        figure = Figure(figsize=(_WIDTH * len(panels), _HEIGHT), dpi=_DPI, layout="constrained")
        FigureCanvasAgg(figure)
        axes = figure.subplots(1, len(panels), squeeze=False)[0]
        for ax, part in zip(axes, panels, strict=True):
            if isinstance(part, Curl):
                _curl(ax, part)
            else:
                _stability(ax, part, lost or {})
        if title:
            figure.suptitle(_plain(title), fontsize=10)
    return figure


def image(figure: Figure, suffix: str) -> bytes:
    """The picture as a file of a kind: ".png", ".svg" or ".pdf"; the same bytes for the same picture."""
    kind = suffix.lstrip(".").lower()
    undated: dict[str, Any] = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}
    buffer = io.BytesIO()
    with matplotlib.rc_context(RC):
        figure.savefig(buffer, format=kind, dpi=_DPI, metadata=undated.get(kind))
    return buffer.getvalue()


def _curl(ax: Axes, part: Curl) -> None:
    first, second = part.names
    label = (
        rf"$\partial {_letter(_STRESS[first])}/\partial {_letter(second)}"
        rf" - \partial {_letter(_STRESS[second])}/\partial {_letter(first)}$"
    )
    _field(ax, part.names, part.x, part.y, part.values, f"{label}  ({_curl_unit(first, second)})")
    ax.set_title(_plain(part.text) if part.text else "curl of the stress")
    if len(part.loop_x) < 2:
        return
    x, y = (np.append(loop, loop[0]) for loop in (np.asarray(part.loop_x), np.asarray(part.loop_y)))
    ax.plot(x, y, color=HALO, linewidth=3.2, solid_joinstyle="round")
    ax.plot(x, y, color=INK, linewidth=1.5, solid_joinstyle="round")
    _arrow(ax, x, y)


def _arrow(ax: Axes, x: Floats, y: Floats) -> None:
    """Which way a loop is run through: an arrow in the middle of its longest stretch on the page."""
    width, height = np.ptp(ax.get_xlim()), np.ptp(ax.get_ylim())
    steps = np.hypot(np.diff(x) / width, np.diff(y) / height)
    k = int(steps.argmax())
    middle, way = np.array([x[k] + x[k + 1], y[k] + y[k + 1]]) / 2, np.array([x[k + 1] - x[k], y[k + 1] - y[k]])
    way = way / steps[k] * 0.01 if steps[k] > 0 else way
    # the head alone: its tail lies on the loop
    head = {"arrowstyle": "-|>", "color": INK, "mutation_scale": 16, "linewidth": 0.8, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", middle + way, middle - way, arrowprops=head)


def _stability(ax: Axes, part: StabilityMap, lost: Mapping[str, float]) -> None:
    _field(ax, part.names, part.x, part.y, part.definite, r"least eigenvalue of sym $T$, scaled  (dimensionless)")
    handles = []
    # the second over the first, of which its gaps show as much as there is where both are the same
    lines: tuple[tuple[Floats, Literal["-", "--"], str, str], ...] = (
        (part.definite, "-", INK, "definite"), (part.parabolic, "--", PARABOLIC, "parabolic"),
    )  # fmt: skip
    for values, style, colour, what in lines:
        finite = values[np.isfinite(values)]
        if finite.size and finite.min() < 0 < finite.max():
            ax.contour(part.x, part.y, values, levels=[0.0], colors=[colour], linestyles=[style], linewidths=[1.8])
            handles.append(Line2D([], [], color=colour, linestyle=style, linewidth=1.8, label=f"no longer {what}"))
    x, y = part.names
    if x in lost and y in lost:
        mark: dict[str, Any] = {"marker": "o", "markersize": 6, "markerfacecolor": HALO, "markeredgecolor": INK}
        ax.plot(lost[x], lost[y], linestyle="none", zorder=5, clip_on=False, **mark)
        handles.append(Line2D([], [], linestyle="none", label="lost first", **mark))
    lost_all = bool(handles) or np.nanmax(part.definite, initial=-np.inf) <= 0
    ax.set_title("stability, lost on the lines" if handles else
                 f"stability, {'lost everywhere' if lost_all else 'nowhere lost'} on this map")
    if not handles and np.isfinite(part.definite).all() and np.ptp(part.definite) > 1e-9:
        # of one sign the colours say little
        levels = ax.contour(part.x, part.y, part.definite, levels=6, colors=[_ink_on(part.definite)], linewidths=[0.8])
        ax.clabel(levels, fontsize=7)
    if handles:
        ax.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=len(handles))


def _ink_on(values: Floats) -> str:
    """White lines where all colours are deep."""
    sizes = np.abs(values)
    return HALO if sizes.min() > 0.5 * sizes.max() else INK


def _field(ax: Axes, names: tuple[str, str], x: Floats, y: Floats, values: Floats, label: str) -> None:
    """A diverging map around zero; grey where there is no value."""
    finite = np.abs(values[np.isfinite(values)])
    # a few large values, next to a singularity, would leave the rest white
    reach = float(np.quantile(finite, 0.98)) if finite.size else 0.0
    most = float(finite.max(initial=0.0))
    reach = most if most < 3 * reach or reach == 0 else reach
    reach = reach or 1.0
    whole = bool(np.isfinite(values).all())
    ax.set_facecolor(NOTHING)
    dx, dy = (x[-1] - x[0]) / (len(x) - 1) / 2, (y[-1] - y[0]) / (len(y) - 1) / 2
    mesh = ax.imshow(
        np.ma.masked_invalid(values), cmap=DIVERGING, norm=Normalize(-reach, reach), origin="lower", aspect="auto",
        extent=(x[0] - dx, x[-1] + dx, y[0] - dy, y[-1] + dy), interpolation="bilinear" if whole else "nearest",
    )  # fmt: skip
    ax.set_xlim(x[0], x[-1])
    ax.set_ylim(y[0], y[-1])
    beyond = "both" if most > reach else "neither"
    bar = ax.figure.colorbar(mesh, ax=ax, label=label, extend=beyond)
    bar.outline.set_linewidth(0.7)
    ax.set_xlabel(_axis(names[0]))
    ax.set_ylabel(_axis(names[1]))


def _axis(name: str) -> str:
    unit = "1 / length" if name.startswith("Pi") else "dimensionless"
    return f"{_MODES[name]} ${_letter(name)}$  ({unit})"


def _curl_unit(first: str, second: str) -> str:
    bends = first.startswith("Pi") + second.startswith("Pi")
    return ("force", "force x length", r"force x length$^2$")[bends]


def _letter(name: str) -> str:
    letter = name.rstrip("123")
    index = name[len(letter):]
    letter = {"Pi": r"\Pi"}.get(letter, letter)
    return f"{letter}_{index}" if index else letter


def _plain(text: str) -> str:
    """Text of a user's, in which a dollar is a dollar."""
    return text.replace("$", r"\$")
