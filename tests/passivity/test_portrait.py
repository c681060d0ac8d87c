"""The picture of a check: the curl round the witness where there is one, stability where it varies."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

from geocosserat.model.law import load_law
from geocosserat.passivity.check import Check, check
from geocosserat.passivity.portrait import _curl, portrait
from tests.passivity.zoo import ZOO, planar


def found(name: str) -> Check:
    """What is found of a law of the zoo."""
    return check(load_law({"name": name, **ZOO[name].law}))


def titles(figure: Figure) -> list[str]:
    """Of the panels."""
    return [ax.get_title() for ax in figure.axes]


def test_there_is_no_picture_of_what_has_no_map() -> None:
    """Friction alone has neither curl nor tangent."""
    assert portrait(found("friction, definite")) is None


def test_the_title_is_name_and_verdict() -> None:
    """As in the terminal."""
    figure = portrait(found("odd, shear and bend"))
    assert figure is not None
    assert figure.get_suptitle() == "odd, shear and bend: active"


@pytest.mark.parametrize("name", ["odd, shear and bend", "a curl that vanishes at rest", "odd, bend and twist"])
def test_what_the_picture_shows_inside_the_loop_is_the_work(name: str) -> None:
    """The values summed over the inside of the loop, times the area of a cell, are the work: sign and axes agree."""
    answer = found(name)
    assert answer.stress is not None
    loop = answer.stress.witness
    assert loop is not None
    shown = _curl(answer, loop)
    assert shown.values.shape == (shown.y.size, shown.x.size)
    x, y = np.meshgrid(shown.x, shown.y)
    a, b = (float(r) for r in loop.radii)
    inside = ((x - float(loop.centre[loop.first])) / a) ** 2 + ((y - float(loop.centre[loop.second])) / b) ** 2 < 1
    area = (shown.x[1] - shown.x[0]) * (shown.y[1] - shown.y[0])
    assert float(shown.values[inside].sum() * area) == pytest.approx(loop.work, rel=0.02)
    # the loop that is drawn: its area by the shoelace formula, above zero as it goes round from the first to the second
    x, y = shown.loop_x, shown.loop_y
    assert 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])) == pytest.approx(np.pi * a * b, rel=1e-3)
    assert f"{loop.work:.6g}" in shown.text


def test_axes_are_not_exchanged() -> None:
    """A curl of 2 h1 alone varies along the axis of h1, and there as it should: the loop gains where it is shown to."""
    given = planar({"F1": "h1 - 1", "F2": "h2 + h1**2", "M": "Pi"})
    answer = check(load_law(given), brief=True)
    assert answer.stress is not None
    assert answer.stress.witness is not None
    shown = _curl(answer, answer.stress.witness)
    x, y = np.meshgrid(shown.x, shown.y)
    h1 = x if shown.names[0] == "h1" else y
    sign = -1 if shown.names[0] == "h1" else 1
    np.testing.assert_allclose(shown.values, sign * 2 * h1, rtol=1e-12)


def test_open_parameters_have_the_values_of_the_witness() -> None:
    """The curl is drawn for the values at which the work was certified."""
    answer = found("odd with an open modulus")
    assert answer.stress is not None
    loop = answer.stress.witness
    assert loop is not None
    shown = _curl(answer, loop)
    a, b = (float(r) for r in loop.radii)
    np.testing.assert_allclose(shown.values, loop.work / (np.pi * a * b), rtol=1e-12)


def test_a_passive_law_that_loses_its_stability_has_a_picture() -> None:
    """One map, of stability."""
    figure = portrait(found("a density"))
    assert figure is not None
    assert len([ax for ax in figure.axes if ax.images and ax.get_xlabel()]) == 1
