"""The small panels beside a rod: its energy over time, and its strain along the rod at chosen moments."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from numpy.typing import NDArray

from geocosserat.results import style
from geocosserat.results.curves import smooth
from geocosserat.results.solution import Array, Solution

_VISIBLE = 1e-6  # a strain (rotations times the length) that changes by less is worth no panel and no scale


def draw_ledger(axes: Axes, solution: Solution) -> None:
    """Stored and dissipated energy and work over time, and stored + dissipated - work, which must stay level.

    Work is left out when none is done.
    """
    stored, dissipated, work = solution.energy, solution.dissipated, solution.work
    series = [("stored", stored, style.STORED), ("dissipated", dissipated, style.DISSIPATED)]
    balance = "stored + dissipated"
    if np.any(np.abs(work) > 1e-9 * np.max(np.nan_to_num(np.abs([stored, dissipated])))):
        series.append(("work", work, style.WORK))
        balance += r" $-$ work"
    for label, values, colour in series:
        axes.plot(solution.time, values, color=colour, label=label, marker=None if len(values) > 1 else "o")
    axes.plot(solution.time, stored + dissipated - work, color=style.INK, linewidth=1.0, label=balance,
              linestyle=(0, (4, 3)))
    if len(solution.time) > 1:
        axes.set_xlim(solution.time[0], solution.time[-1])
    axes.set_xlabel("time $t$")
    axes.set_ylabel("energy")
    axes.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.0), ncols=2, borderaxespad=0.2, handlelength=1.4,
                columnspacing=1.2, handletextpad=0.5, labelspacing=0.3)


def draw_turn(
    axes: Axes, solution: Solution, component: int, frames: NDArray[np.intp], colours: ScalarMappable
) -> None:
    """One strain component along the rod at the given frames, in the colours of their times."""
    places, values = smooth(solution, solution.turn[frames][..., component:component + 1])
    for moment, curve in zip(solution.time[frames], values[..., 0], strict=True):
        axes.plot(places, curve, color=colours.to_rgba(moment), linewidth=1.1)
    axes.set_xlim(0.0, solution.length)
    low, high = axes.get_ylim()
    least = _VISIBLE / _scale(solution)[component]
    if high - low < least:  # round-off is not to fill the panel
        axes.set_ylim((low + high - least) / 2, (low + high + least) / 2)
    axes.set_xlabel("place on the rod at rest $u$")
    axes.set_ylabel(style.strain_name(solution.group.strain[component]))


def liveliest(solution: Solution, count: int) -> list[int]:
    """The strain components, at most `count`, that change most over the rod and the run, in the order of E.

    Components that hardly change beside the first are left out. Of equals the last counts first, so that a
    rod that does nothing shows a bend.
    """
    flat = np.nan_to_num(solution.turn).reshape(-1, solution.group.dimension)
    change = np.ptp(flat, axis=0) * _scale(solution)
    order = np.lexsort((np.arange(len(change)), change))[::-1][:count]
    first, *others = (int(a) for a in order)
    return sorted([first, *(a for a in others if change[a] > _VISIBLE * change[first])])


def _scale(solution: Solution) -> Array:
    """What makes strains dimensionless: 1 for translations, the length for rotations."""
    group = solution.group
    return np.where(np.arange(group.dimension) < group.translations, 1.0, solution.length)
