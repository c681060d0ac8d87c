"""Pictures show the rod, its energy and its strain, to scale, and whatever the numbers are."""

from __future__ import annotations

import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.text import Text

from geocosserat.results import style
from geocosserat.results.curves import moments, smooth, way
from geocosserat.results.errors import FileError
from geocosserat.results.panels import liveliest
from geocosserat.results.picture import figure, picture
from geocosserat.results.solution import Solution
from tests.results.motions import rod, rolling, unrolling, unwinding


def _still(**changes: Any) -> Solution:
    return rod("spatial", (0.1, 0.0, 1e-3), lambda t: 1 + 0 * t, lambda t: 0 * t, title="still", **changes)


def _broken() -> Solution:
    solution = unwinding(title="broken")
    position, turn = np.array(solution.position), np.array(solution.turn)
    position[20:], turn[20:] = np.nan, np.nan
    return replace(solution, position=position, turn=turn, energy=np.full(41, np.nan))


def _first_frame() -> Solution:
    solution = rolling(frames=2, title="first frame")
    names = ("time", "position", "rotation", "angle", "twist", "turn", "stress", "energy", "dissipated", "work")
    return replace(solution, **{name: getattr(solution, name)[:1] for name in names})


CASES = {
    "rolling": rolling, "unrolling": unrolling, "unwinding": unwinding, "still": _still, "broken": _broken,
    "first frame": _first_frame,
    "coarse": lambda: rolling(elements=16, degree=1),
    "tiny": lambda: replace(unwinding(length=1e-6), time=unwinding().time * 1e-9),
    "huge": lambda: replace(rolling(length=1e6), time=rolling().time * 1e9),
    "mathematics": lambda: rolling(title="a rod of $x_{ \\frac$"),
    "no font": lambda: rolling(title="曲がる棒"),
    "long": lambda: rolling(title="a long title\n" * 30),
    "empty": lambda: rolling(title="", energy=np.zeros(41), dissipated=np.zeros(41), work=np.zeros(41)),
}


def _curves(axes: Any) -> list[Any]:
    return [line for line in axes.lines if len(line.get_xdata()) > 1]


@pytest.mark.parametrize("case", CASES)
def test_any_solution_can_be_drawn(case: str, tmp_path: Path) -> None:
    """The file has the size of the page, and ink on it."""
    path = picture(CASES[case](), tmp_path / "picture.png")
    data = path.read_bytes()
    width, height = struct.unpack(">II", data[16:24])
    assert (width, height) == tuple(round(side * style.DPI) for side in style.SIZE)
    pixels = imread(path)[..., :3]
    inked = np.mean(np.any(pixels < 0.9, axis=2))
    assert 0.005 < inked < 0.3
    left = pixels[height // 8:, : width // 2]
    assert np.mean(np.any(left < 0.9, axis=2)) > 0.003


@pytest.mark.parametrize("case", CASES)
@pytest.mark.filterwarnings("ignore:Glyph")
def test_no_text_leaves_the_page(case: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is cut off: not the title, a legend, a label or a number."""
    drawn: list[Text] = []
    draw = Text.draw

    def record(text: Text, renderer: Any) -> None:
        drawn.append(text)
        draw(text, renderer)

    monkeypatch.setattr(Text, "draw", record)
    result = figure(CASES[case]())
    result.canvas.draw()
    page = result.bbox
    boxes = [(text.get_text(), text.get_window_extent()) for text in drawn if text.get_text().strip()]
    assert len(boxes) > 20
    assert [word for word, box in boxes
            if box.x0 < 0 or box.y0 < 0 or box.x1 > page.width or box.y1 > page.height] == []


@pytest.mark.parametrize("make", [rolling, unrolling])
def test_a_planar_rod_is_drawn_to_scale_over_time(make) -> None:
    """Equal axes; every chosen moment is one curve, through the nodes, in the colour of its time."""
    solution = make()
    drawn = figure(solution)
    rod_axes = drawn.axes[0]
    assert rod_axes.get_aspect() == 1.0
    frames = moments(solution, 24)
    of_the_tip, *shapes = _curves(rod_axes)
    np.testing.assert_array_equal(of_the_tip.get_xydata(), solution.position[:, -1])
    assert len(shapes) == len(frames) > 10
    colours = style.time_colours(solution.time, style.time_power(solution.time, way(solution)))
    for frame, shape in zip(frames, shapes, strict=True):
        assert shape.get_color() == colours.to_rgba(solution.time[frame])
        np.testing.assert_allclose(shape.get_xydata()[[0, -1]], solution.position[frame][[0, -1]], atol=1e-13)
    widths = [shape.get_linewidth() for shape in shapes]
    assert widths[0] == widths[-1] > 2 * max(widths[1:-1])


@pytest.mark.parametrize("make", [unwinding, _still])
def test_a_spatial_rod_is_drawn_to_scale(make) -> None:
    """A unit of length takes the same space along x, y and z, and the whole rod is in the box."""
    solution = make()
    axes: Any = figure(solution).axes[0]
    limits = np.array([axes.get_xlim(), axes.get_ylim(), axes.get_zlim()])
    box = axes._box_aspect / np.ptp(limits, axis=1)
    np.testing.assert_allclose(box, box[0], rtol=1e-12)
    points = solution.position[moments(solution, 14)].reshape(-1, 3)
    assert np.all(points >= limits[:, 0] - 1e-12)
    assert np.all(points <= limits[:, 1] + 1e-12)
    assert len(_curves(axes)) == 1 + len(moments(solution, 14))
    assert len(axes.collections) == 2  # the ribbons of the first and the last shape


@pytest.mark.parametrize(("make", "names"), [
    (unrolling, ["stored", "dissipated", "stored + dissipated"]),
    (rolling, ["stored", "dissipated", "work", r"stored + dissipated $-$ work"]),
])
def test_the_ledger_panel_shows_energies_whose_balance_is_level(make, names: list[str]) -> None:
    """The energies as they are, and a dashed line that must stay level; work only where some is done."""
    solution = make()
    panel = figure(solution).axes[2]
    lines = {line.get_label(): line for line in panel.lines}
    assert list(lines) == names
    np.testing.assert_array_equal(lines["stored"].get_ydata(), solution.energy)
    np.testing.assert_array_equal(lines["dissipated"].get_ydata(), solution.dissipated)
    level = np.asarray(lines[names[-1]].get_ydata())
    np.testing.assert_allclose(level, solution.energy[0], rtol=1e-12, atol=1e-12)
    assert lines[names[-1]].is_dashed()
    assert {text.get_text() for text in panel.get_legend().get_texts()} == set(names)


def test_the_strain_panels_show_what_changes() -> None:
    """The bend of a planar rod; twist and bend of a helix; the stretch of a rod that only stretches."""
    assert liveliest(rolling(), 1) == [2]
    assert liveliest(unwinding(), 2) == [3, 5]
    stretched = rolling()
    turn = np.array(stretched.turn)
    turn[..., 2] = 1e-9 * np.sin(stretched.u_point)
    turn[..., 0] = 1 + 0.1 * stretched.time[:, None]
    assert liveliest(replace(stretched, turn=turn), 2) == [0]
    assert liveliest(_still(), 2) == [5]
    # bent by half a radian and stretched by a hundredth: the bend counts for more, however long the rod
    turn = np.array(stretched.turn)
    turn[..., 2] = 5e-4 * stretched.u_point
    turn[..., 0] = 1 + 0.01 * stretched.time[:, None]
    assert liveliest(replace(stretched, turn=turn, length=1000.0), 1) == [2]
    labels = [axes.get_ylabel() for axes in figure(unwinding()).axes[3:]]
    assert labels == [r"twist $\Pi_1$", r"bend $\Pi_3$"]


def test_round_off_does_not_fill_a_panel() -> None:
    """A strain that is constant up to round-off is drawn level."""
    solution = _still()
    noise = 1e-13 * np.random.default_rng(3).standard_normal(solution.turn.shape)
    panel = figure(replace(solution, turn=solution.turn + noise)).axes[3]
    assert np.ptp(panel.get_ylim()) >= 1e-6


def test_the_colours_of_time_print_in_grey() -> None:
    """Perceptually even: lightness rises steadily with time, and the palest still shows on white."""
    colours = style.time_colours(np.array([0.0, 3.0]), 1.0)
    rgb = np.asarray(colours.to_rgba(np.linspace(0.0, 3.0, 64)))[:, :3]
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    lightness = 116 * np.cbrt(linear @ [0.2126, 0.7152, 0.0722]) - 16
    steps = np.diff(lightness)
    assert np.all(steps > 0)
    assert steps.max() < 2 * np.median(steps)
    assert lightness[-1] < 85


@pytest.mark.parametrize("make", [rolling, unrolling])
def test_the_colour_bar_spans_the_run(make) -> None:
    """From the first to the last time, with numbers that tell them."""
    bar = figure(make(until=1.5)).axes[1]
    assert bar.get_ylim() == (0.0, 1.5)
    assert bar.get_title() == "$t$"
    ticks = [tick for tick in bar.get_yticks() if 0.0 <= tick <= 1.5]
    assert ticks[0] == 0.0
    assert len(ticks) >= 5
    assert np.all(np.diff(ticks) > 0)


def test_colours_are_shared_out_along_the_way() -> None:
    """Evenly in time where the rod moves evenly; where it slows down, half the way gets half the colours."""
    time = np.linspace(3.0, 5.0, 1001)
    assert style.time_power(time, time - 3.0) == 1.0
    travelled = 1 - np.exp(-4 * (time - 3.0))
    power = style.time_power(time, travelled)
    shade = style.time_colours(time, power).norm(time)
    assert np.interp(travelled[-1] / 2, travelled, shade) == pytest.approx(0.5, abs=1e-3)
    assert style.time_power(time, 0 * time) == 1.0
    assert 0.25 <= style.time_power(time, 1 - np.exp(-1e9 * (time - 3.0))) < 0.3
    assert style.time_power(time, np.exp(4 * time)) == 1.0
    for one_time in style.time_ticks(0.0, 0.05, 0.4)[1:-1]:
        assert float(f"{one_time:.0e}") == pytest.approx(one_time)


def test_a_power_of_ten_stands_in_the_label() -> None:
    """Beside the axis it would meet the legend."""
    drawn = figure(CASES["tiny"]())
    assert drawn.axes[2].get_xlabel() == "time $t$ ($\\times\\mathdefault{10^{\N{MINUS SIGN}9}}\\mathdefault{}$)"
    drawn.canvas.draw()
    offsets = [axis.get_offset_text() for axes in drawn.axes for axis in (axes.xaxis, axes.yaxis)]
    assert [text.get_text() for text in offsets if text.get_visible() and text.get_text()] == []


@pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf", ".PNG"])
def test_the_same_run_gives_the_same_picture(suffix: str, tmp_path: Path) -> None:
    """In every format, byte for byte."""
    one, other = (picture(rolling(), tmp_path / f"{name}{suffix}").read_bytes() for name in "ab")
    assert one == other
    start = {".svg": b"<?xml", ".pdf": b"%PDF"}.get(suffix, b"\x89PNG")
    assert one.startswith(start)


def test_an_unknown_kind_of_picture_is_refused(tmp_path: Path) -> None:
    """Before anything is drawn, by the name of the file."""
    with pytest.raises(FileError, match=r"a\.gif: expected a name that ends in .*\.svg.*, found '\.gif'; rename"):
        picture(rolling(), tmp_path / "a.gif")


def test_drawing_leaves_the_settings_of_matplotlib_alone(tmp_path: Path) -> None:
    """A user's own pictures look as before."""
    before = dict(matplotlib.rcParams)
    picture(rolling(), tmp_path / "a.png")
    assert isinstance(figure(unwinding()), Figure)
    assert dict(matplotlib.rcParams) == before


@pytest.mark.parametrize(("elements", "degree"), [(1, 12), (3, 5), (40, 1)])
def test_smooth_curves_follow_the_rod_between_its_nodes(elements: int, degree: int) -> None:
    """For a circle they stay on it, to the accuracy of the scheme, and they pass through the nodes."""
    solution = rolling(elements=elements, degree=degree)
    places, drawn = smooth(solution, solution.position)
    circle = np.stack((np.sin(2 * np.pi * places), 1 - np.cos(2 * np.pi * places)), axis=-1) / (2 * np.pi)
    np.testing.assert_allclose(drawn[-1], circle, atol={12: 1e-6, 5: 5e-4, 1: 1e-3}[degree])
    for node, u in enumerate(solution.u[::degree]):
        nearest = np.abs(places - u).argmin()
        np.testing.assert_allclose(drawn[:, nearest], solution.position[:, node * degree], atol=1e-13)
    at_points, bends = smooth(solution, solution.turn)
    assert at_points[0] == 0.0
    assert at_points[-1] == pytest.approx(solution.length)
    np.testing.assert_allclose(bends[-1, :, 2], 2 * np.pi, rtol=1e-12)


@pytest.mark.parametrize("count", [1, 2, 9, 24, 400])
@pytest.mark.parametrize("case", ["rolling", "unrolling", "unwinding", "still", "broken", "first frame"])
def test_the_chosen_moments_are_few_ordered_and_hold_both_ends(case: str, count: int) -> None:
    """First and last frame always; never more than asked for, if that is at least these two."""
    solution = CASES[case]()
    frames = moments(solution, count)
    assert frames[0] == 0
    assert frames[-1] == len(solution.time) - 1
    assert np.all(np.diff(frames) > 0)
    assert len(frames) <= max(count, 2)


def test_the_chosen_moments_are_even_along_the_way() -> None:
    """Of many frames of a rod that relaxes ever more slowly, the shapes drawn lie about equally far apart."""
    solution = unrolling(frames=2001)
    frames = moments(solution, 20)
    shapes = solution.position[frames]
    gaps = np.sqrt(np.mean(np.sum(np.diff(shapes, axis=0) ** 2, axis=2), axis=1))
    assert len(frames) >= 18
    assert gaps[:-1].max() < 1.5 * gaps[:-1].min()
