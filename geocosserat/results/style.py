"""How pictures look: sizes, fonts, colours and the names of components in print."""

from __future__ import annotations

from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, PowerNorm
from matplotlib.ticker import ScalarFormatter

from geocosserat.results.solution import Array

SIZE = (9.0, 4.6)  # inches
DPI = 200
INK, FAINT = "#222222", "#9a9a9a"
# Okabe and Ito's colours, which the colour-blind tell apart
STORED, DISSIPATED, WORK = "#0072b2", "#d55e00", "#009e73"

RC: Any = {  # matplotlib's own type of this is a list of all its keys
    "font.family": ["STIXGeneral", "DejaVu Sans"],
    "mathtext.fontset": "stix",
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.labelsize": 9,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "legend.fontsize": 8,
    "axes.linewidth": 0.7,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "lines.linewidth": 1.4,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "text.color": INK,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.formatter.limits": (-3, 4),
    "svg.hashsalt": "geocosserat",
    "pdf.fonttype": 42,
}


def time_power(time: Array, travelled: Array) -> float:
    """The power of the time that colours follow, at most 1: it gives each half of the way travelled half of them.

    Both arguments are (T,). Most rods move fast at first and then hardly any more; evenly coloured in time, nearly
    all shapes would have the first colour.
    """
    if time[-1] <= time[0] or travelled[-1] <= 0:
        return 1.0
    half = (np.interp(travelled[-1] / 2, travelled, time) - time[0]) / (time[-1] - time[0])
    power = float(np.log(0.5) / np.log(np.clip(half, 1e-6, 0.5)))
    return 1.0 if power > 0.75 else max(power, 0.25)


def time_colours(time: Array, power: float) -> ScalarMappable:
    """Viridis over the run, following a power of the time, without its palest part, which is lost on white."""
    shades = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.9, 256))
    start = float(time[0])
    end = float(time[-1]) if time[-1] > start else start + 1.0
    return ScalarMappable(PowerNorm(power, start, end), ListedColormap(shades))


def time_ticks(start: float, end: float, power: float) -> list[float]:
    """Times of one digit, about even where colours follow a power of the time, and the two ends."""
    even = (end - start) * np.linspace(0.0, 1.0, 6)[1:-1] ** (1 / power)
    digit = 10.0 ** np.floor(np.log10(even))
    return [start, *(start + np.unique(np.round(even / digit) * digit)), end]


_LETTERS = {"Pi": r"\Pi"}
_MODES = {
    "h1": "stretch", "h2": "shear", "h3": "shear",
    "Pi": "bend", "Pi1": "twist", "Pi2": "bend", "Pi3": "bend",
}


def strain_name(component: str) -> str:
    """A strain component in words and mathematical type: "Pi2" -> "bend $\\Pi_2$"."""
    letter, index = component.rstrip("123"), component[len(component.rstrip("123")):]
    letter = _LETTERS.get(letter, letter)
    return f"{_MODES[component]} ${letter}_{index}$" if index else f"{_MODES[component]} ${letter}$"


def fold_powers(axes: Axes) -> None:
    """Move a common power of ten from the end of an axis, where legends are, into its label or the title."""
    for axis in (axes.xaxis, axes.yaxis, *([axes.zaxis] if hasattr(axes, "zaxis") else [])):
        formatter = axis.get_major_formatter()
        if not isinstance(formatter, ScalarFormatter):
            continue
        formatter.set_locs(axis.get_majorticklocs())
        formatter.set_useMathText(True)
        power = formatter.get_offset()
        formatter.set_useMathText(False)  # plain tick labels take a tenth of the time to set
        axis.get_offset_text().set_visible(False)
        for text in (axis.label, axes.title):
            if power and text.get_text():
                text.set_text(f"{text.get_text()} ({power})")
                break
