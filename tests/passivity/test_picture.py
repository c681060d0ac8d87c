"""Pictures of laws: what they show, in which colours, and that they are the same each time."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.contour import QuadContourSet

from geocosserat.model.law import load_law
from geocosserat.passivity.maps import StabilityMap
from geocosserat.passivity.picture import Curl, draw, image
from geocosserat.passivity.stability import StabilityAnswer, stability

LOST = 'motion = "planar"\n[energy]\ndensity = "5*(h1 - 1)**2 + 5*h2**2 + Pi**2/2 - 4*h2**2*Pi**2"\n'


def curl(sign: float = 1.0, names: tuple[str, str] = ("h2", "Pi"), text: str = "net work 0.3") -> Curl:
    """A field that changes its sign, and a square loop."""
    x, y = np.linspace(-0.5, 0.5, 21), np.linspace(-1.0, 1.0, 31)
    values = sign * (2 * x[None] + y[:, None] ** 2)
    return Curl(names, x, y, values, np.array([-0.3, 0.3, 0.3, -0.3]), np.array([-0.5, -0.5, 0.5, 0.5]), text)


@pytest.fixture(scope="module")
def answer() -> StabilityAnswer:
    """A law that loses its stability in its domain."""
    found = stability(load_law(LOST))
    assert found is not None
    return found


def test_nothing_to_draw_is_refused() -> None:
    """There is no empty picture."""
    with pytest.raises(ValueError, match="give one"):
        draw()


def test_zero_is_the_middle_of_the_colours(answer: StabilityAnswer) -> None:
    """Whatever the values are, the neutral colour is that of zero."""
    figure = draw(curl=curl(), stability=answer.map)
    panels = [ax for ax in figure.axes if ax.images and ax.get_xlabel()]
    assert len(panels) == 2
    for ax in panels:
        mesh = ax.images[0]
        assert mesh.norm.vmin == -mesh.norm.vmax
        red, green, blue, _ = mesh.cmap(0.5)
        assert min(red, green, blue) > 0.9


def test_the_loop_is_closed_and_goes_round_as_it_was_given() -> None:
    """Its points in order, with the first at the end again."""
    (ax, _) = draw(curl=curl()).axes
    x, y = ax.lines[-1].get_data()
    assert x.tolist() == [-0.3, 0.3, 0.3, -0.3, -0.3]
    assert y.tolist() == [-0.5, -0.5, 0.5, 0.5, -0.5]
    assert ax.get_title() == "net work 0.3"


def test_axes_have_units() -> None:
    """Shears have none, bends are one over a length; the curl's follows from both."""
    for names, unit in ((("h2", "h3"), "(force)"), (("h2", "Pi2"), "length)"), (("Pi2", "Pi3"), "length$^2$)")):
        (ax, bar) = draw(curl=curl(names=names)).axes
        for name, label in zip(names, (ax.get_xlabel(), ax.get_ylabel()), strict=True):
            assert ("1 / length" if name.startswith("Pi") else "dimensionless") in label
        assert bar.get_ylabel().endswith(unit)
    (_, bar) = draw(curl=curl(names=("h2", "Pi"))).axes
    assert r"\partial F_2/\partial \Pi - \partial M/\partial h_2" in bar.get_ylabel()


def test_the_line_of_loss_is_where_the_eigenvalue_vanishes(answer: StabilityAnswer) -> None:
    """On h2 = 0 it is at 8 Pi^2 = 10, outside of the map; on Pi = 0 at 8 h2^2 = 1."""
    assert answer.map is not None
    (ax, _) = draw(stability=answer.map, lost=answer.lost[0].where).axes
    lines = [c for c in ax.collections if isinstance(c, QuadContourSet)]
    assert len(lines) == 2
    points = np.concatenate([path.vertices for path in lines[0].get_paths()])
    on_axis = points[np.abs(points[:, 1]) < 1e-9]
    assert np.abs(on_axis[:, 0]) == pytest.approx(np.full(2, 8**-0.5), abs=1e-3)
    legend = ax.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == [
        "no longer definite", "no longer parabolic", "lost first",
    ]  # fmt: skip


def test_titles_say_whether_stability_is_lost(answer: StabilityAnswer) -> None:
    """On the map, that is, and it may be lost everywhere."""
    x = np.linspace(-1.0, 1.0, 5)
    for value, words in ((1.0, "nowhere lost"), (-1.0, "lost everywhere")):
        (ax, _) = draw(stability=StabilityMap(("h1", "h2"), x, x, np.full((5, 5), value), np.full((5, 5), value))).axes
        assert words in ax.get_title()
    (ax, _) = draw(stability=answer.map).axes
    assert "on the lines" in ax.get_title()


def test_no_text_lies_over_another(answer: StabilityAnswer) -> None:
    """Titles, labels, ticks and legend of the fullest picture, in pixels."""
    figure = draw(curl=curl(), stability=answer.map, lost=answer.lost[0].where, title="A law that costs $5 and $6")
    figure.canvas.draw()
    texts = [figure._suptitle, *(t for ax in figure.axes for t in (ax.title, ax.xaxis.label, ax.yaxis.label))]
    texts += [t for ax in figure.axes for axis in (ax.xaxis, ax.yaxis) for t in axis.get_ticklabels()]
    texts += [t for ax in figure.axes if ax.get_legend() for t in ax.get_legend().get_texts()]
    boxes = [t.get_window_extent() for t in texts if t is not None and t.get_text() and t.get_visible()]
    width, height = figure.canvas.get_width_height()
    for i, a in enumerate(boxes):
        assert a.x0 >= 0
        assert a.y0 >= 0
        assert a.x1 <= width
        assert a.y1 <= height
        for b in boxes[:i]:
            assert not (a.x0 < b.x1 and b.x0 < a.x1 and a.y0 < b.y1 and b.y0 < a.y1)


def test_holes_and_poles_do_not_hide_the_rest() -> None:
    """Where the curl has no value it is grey; next to a pole the colours end before the values do."""
    part = curl()
    with np.errstate(divide="ignore"):
        values = 1 / np.hypot(part.x[None], part.y[:, None]) ** 4
    values[~np.isfinite(values)] = np.nan
    (ax, _) = draw(curl=Curl(part.names, part.x, part.y, values, part.loop_x, part.loop_y)).axes
    assert ax.images[0].norm.vmax < np.nanmax(values)
    assert np.ma.is_masked(ax.images[0].get_array())
    nothing = np.full_like(values, np.nan)
    empty = np.zeros(0)
    assert image(draw(curl=Curl(part.names, part.x, part.y, nothing, empty, empty)), ".png")


def test_a_curl_that_is_zero_everywhere_is_drawn() -> None:
    """In the neutral colour."""
    assert image(draw(curl=curl(0.0)), ".png").startswith(b"\x89PNG")


@pytest.mark.slow
def test_pictures_are_the_same_each_time() -> None:
    """Byte by byte, in each format."""
    for suffix, start in ((".png", b"\x89PNG"), (".svg", b"<?xml"), (".PDF", b"%PDF")):
        first, second = (image(draw(curl=curl()), suffix) for _ in range(2))
        assert first == second
        assert first.startswith(start)
