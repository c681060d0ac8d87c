"""The picture of what was found of a law: the curl around its witness, and where its tangent is stable."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from geocosserat.model.expressions import Number, substitute
from geocosserat.passivity.check import Check
from geocosserat.passivity.loop import Loop, curl_on_grid
from geocosserat.passivity.picture import Curl, draw


def portrait(check: Check) -> Figure | None:
    """A figure with a panel for each of the two maps; None if there is neither."""
    stress, stability = check.stress, check.stability
    curl = _curl(check, stress.witness) if stress and stress.witness else None
    chart = stability.map if stability else None
    if curl is None and chart is None:
        return None
    lost = next((dict(loss.where) for loss in stability.lost if loss.what == "definite"), None) if stability else None
    return draw(curl=curl, stability=chart, lost=lost, title=f"{check.law.name}: {check.verdict}")


def _curl(check: Check, loop: Loop) -> Curl:
    assert check.stress is not None
    names = check.law.group.strain
    at = {name: Number(float(x)) for name, x in loop.parameters.items()}
    stress = [substitute(e, at) for e in check.stress.stress]
    first, second, values = curl_on_grid(stress, names, loop)
    angle = 2 * np.pi * np.linspace(0.0, 1.0, 181)
    return Curl(
        names=(names[loop.first], names[loop.second]),
        x=first[:, 0],
        y=second[0],
        values=-values.T,
        loop_x=float(loop.centre[loop.first]) + float(loop.radii[0]) * np.cos(angle),
        loop_y=float(loop.centre[loop.second]) + float(loop.radii[1]) * np.sin(angle),
        text=f"gives {loop.work:.6g} a cycle",
    )
