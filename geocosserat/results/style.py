"""How pictures look: sizes, fonts, colours and the names of components in print."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import matplotlib
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize

from geocosserat.results.solution import Array

SIZE = (9.0, 4.6)  # inches
DPI = 200
INK, FAINT = "#222222", "#9a9a9a"
# Okabe and Ito's colours, which the colour-blind tell apart
STORED, DISSIPATED, WORK = "#0072b2", "#d55e00", "#009e73"

RC: dict[str, Any] = {
    "font.size": 9, "axes.titlesize": 9, "axes.labelsize": 9, "xtick.labelsize": 8, "ytick.labelsize": 8,
    "legend.fontsize": 8, "font.family": "STIXGeneral", "mathtext.fontset": "stix", "axes.linewidth": 0.7, "lines.linewidth": 1.4,
    "xtick.major.width": 0.7, "ytick.major.width": 0.7, "xtick.direction": "out", "ytick.direction": "out",
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": INK, "axes.labelcolor": INK,
    "xtick.color": INK, "ytick.color": INK, "text.color": INK, "legend.frameon": False, "axes.formatter.limits": (-3, 4),
    "axes.formatter.use_mathtext": True, "svg.hashsalt": "geocosserat", "pdf.fonttype": 42,
}


def time_colours(time: Array) -> ScalarMappable:
    """Viridis over the run, without its palest part, which does not print on white."""
    shades = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.9, 256))
    end = float(time[-1]) if time[-1] > time[0] else float(time[0]) + 1.0
    return ScalarMappable(Normalize(float(time[0]), end), ListedColormap(shades))


def colour_of(colours: ScalarMappable) -> Callable[[float], tuple[float, float, float, float]]:
    """The colour of a moment."""
    return lambda moment: colours.to_rgba(moment)  # type: ignore[return-value]


_LETTERS = {"Pi": r"\Pi", "Omega": r"\Omega"}


def in_print(component: str) -> str:
    """A component in mathematical type: "Pi2" -> "$\\Pi_2$"."""
    match = re.fullmatch(r"([A-Za-z]+)(\d*)", component)
    letter, index = match.groups() if match else (component, "")
    letter = _LETTERS.get(letter, letter)
    return f"${letter}_{index}$" if index else f"${letter}$"
