"""The course of a driven end: its pose at any time, against closed forms and another integrator."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from geocosserat.algebra.exponential import exp
from geocosserat.algebra.groups import SE2, SE3
from geocosserat.discretisation import course as module
from geocosserat.discretisation.cells import POINTS
from geocosserat.discretisation.course import Course, course_of, follow
from geocosserat.discretisation.quaternions import product, turn
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import parse

Array = NDArray[np.float64]


def course(twist: list[str], until: float, **parameters: float) -> Course:
    """The course of an end with this twist, of a rod of unit length."""
    names = {"t", *parameters}
    return course_of(tuple(parse(e, names) for e in twist), tuple(parameters.items()), until, 1.0)


def matrix(pose: Array) -> Array:
    """Configurations (n, 3, 3) or (n, 4, 4) from poses (n, 3 or 7)."""
    space = 2 if pose.shape[-1] == 3 else 3
    out = np.zeros((len(pose), space + 1, space + 1))
    out[..., 0, 0] = 1.0
    out[..., 1:, 0] = pose[..., :space]
    if space == 2:
        c, s = np.cos(pose[..., 2]), np.sin(pose[..., 2])
        out[..., 1:, 1:] = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)
    else:
        for i, axis in enumerate(np.eye(3)):
            out[..., 1:, 1 + i] = turn(pose[..., 3:].T, np.broadcast_to(axis, (len(pose), 3)).T).T
    return out


TIMES = np.concatenate([[0.0], np.sort(np.random.default_rng(1).uniform(0, 400, 50)), [400.0]])
PULSE = np.array([0.3, -0.2, 0.5, 1.1, -0.7, 0.4])


@pytest.mark.parametrize("group", [SE2, SE3], ids=lambda group: group.name)
def test_a_twist_along_one_direction_goes_along_the_exponential_of_its_integral(group: object) -> None:
    """A screw, or a turn about a point, that swings with amplitude 2 and goes on besides, 400 times and more."""
    direction = PULSE[[0, 1, 5]] if group is SE2 else PULSE
    found = course([f"({x})*(1 + 2*2*pi*cos(2*pi*t))" for x in direction.tolist()], 400.0)
    travelled = TIMES + 2 * np.sin(2 * np.pi * TIMES)
    wanted = exp(group, direction * travelled[:, None])  # type: ignore[arg-type]
    np.testing.assert_allclose(matrix(found.at(TIMES)), wanted, rtol=0, atol=1e-10)


def test_an_end_that_goes_to_and_fro_comes_back_after_ten_thousand_periods() -> None:
    """In the plane and in space, to 1e-9 of the length and of a radian; in between it is where its integral says."""
    for count, kept in ((3, [0, 1, 5]), (6, list(range(6)))):
        turning = ["3*cos(60*t)", "0", "24*cos(60*t)", "0", "0", "30*cos(60*t)"]
        found = course([turning[i] for i in kept], 10_000 * 2 * np.pi / 60)
        times = np.arange(10_001) * (2 * np.pi / 60)
        start = np.zeros(3) if count == 3 else np.array([0, 0, 0, 1.0, 0, 0, 0])
        np.testing.assert_allclose(found.at(times), np.tile(start, (len(times), 1)), rtol=0, atol=1e-9)
        angle = found.at(times + 0.3)[:-20]
        wanted = 0.5 * np.sin(60 * (times + 0.3))[:-20]
        half = angle[:, 2] if count == 3 else 2 * np.arcsin(angle[:, 6])
        np.testing.assert_allclose(half, wanted, rtol=0, atol=1e-9)


TUMBLING = ["cos(3*t)", "0.3", "sin(t)", "2*cos(t)", "3*sin(2*t)", "1 + a*t"]


@pytest.mark.parametrize("motion", ["planar", "spatial"])
def test_a_twist_whose_instants_do_not_commute_is_followed_as_by_another_integrator(motion: str) -> None:
    """A tumbling end against DOP853 at 1e-13, at any time on the way."""
    twist = TUMBLING if motion == "spatial" else [TUMBLING[i] for i in (0, 2, 5)]

    def rate(t: float, y: Array) -> Array:
        V = np.array([np.cos(3 * t), 0.3, np.sin(t), 2 * np.cos(t), 3 * np.sin(2 * t), 1 + 0.2 * t])
        if motion == "planar":
            c, s = np.cos(y[2]), np.sin(y[2])
            return np.array([c * V[0] - s * V[2], s * V[0] + c * V[2], V[5]])
        return np.concatenate([turn(y[3:], V[:3]), product(y[3:], np.append(0.0, V[3:] / 2))])

    start = np.zeros(3) if motion == "planar" else np.array([0, 0, 0, 1.0, 0, 0, 0])
    times = np.linspace(0.0, 25.0, 41)
    exact = solve_ivp(rate, (0.0, 25.0), start, method="DOP853", rtol=1e-13, atol=1e-14, t_eval=times)
    np.testing.assert_allclose(course(twist, 25.0, a=0.2).at(times), exact.y.T, rtol=0, atol=2e-12)


@pytest.mark.parametrize("motion", ["planar", "spatial"])
def test_the_pose_moves_with_the_twist_at_every_instant(motion: str) -> None:
    """phi^-1 dphi/dt = V, by differences of fourth order, inside cells and across their edges."""
    kept = [0, 2, 5] if motion == "planar" else list(range(6))
    found = course([TUMBLING[i] for i in kept], 25.0, a=0.2)
    edges = found.edges[1:-1]
    t = np.concatenate([edges, (edges[1:] + 2 * edges[:-1]) / 3])
    step = 1e-3
    far, near = (matrix(found.at(t + k * step)) - matrix(found.at(t - k * step)) for k in (2, 1))
    slope = (8 * near - far) / (12 * step)
    group = SE2 if motion == "planar" else SE3
    V = np.stack([np.cos(3 * t), 0.3 + 0 * t, np.sin(t), 2 * np.cos(t), 3 * np.sin(2 * t), 1 + 0.2 * t])[kept].T
    np.testing.assert_allclose(slope, matrix(found.at(t)) @ group.hat(V), rtol=0, atol=1e-8)


def test_cells_meet_without_a_gap() -> None:
    """The polynomials of neighbours agree on the edge between them, to the last digits: no integrator sees it."""
    found = course(TUMBLING, 25.0, a=0.2)
    ends = found.powers.sum(axis=1)
    starts = (found.powers * (-1.0) ** np.arange(POINTS, -1, -1)[:, None]).sum(axis=1)
    np.testing.assert_allclose(starts[1:], ends[:-1], rtol=0, atol=2e-14)


def test_the_angle_counts_turns() -> None:
    """In the plane it is unwrapped; in space the quaternion goes round once for two turns."""
    spinning = course(["1", "0", "2*pi"], 1000.25).at(1000.25)
    np.testing.assert_allclose(spinning[2], 2 * np.pi * 1000.25, rtol=1e-15)
    np.testing.assert_allclose(spinning[:2], np.array([1, 1]) / (2 * np.pi), rtol=0, atol=1e-11)
    quaternion = course(["0", "0", "0", "0", "2*pi", "0"], 1001.0).at(1001.0)[3:]
    np.testing.assert_allclose(quaternion, [-1.0, 0, 0, 0], rtol=0, atol=1e-11)


@pytest.mark.parametrize("told", [True, False], ids=["told", "found"])
def test_a_twist_that_jumps_is_followed_from_jump_to_jump(told: bool) -> None:
    """A quarter turn, then a way straight on: exact, whether the instants are known or found by halving."""
    first, last = 0.3, 0.70314159  # near an edge, too

    def twist(t: Array) -> Array:
        going = (t > last).astype(float)
        turning = (t < first) * (np.pi / 2 / first)
        return np.stack([2 * going, 0 * t, turning])

    found = follow(twist, 1.0, 1.0, (first, last) if told else ())
    times = np.array([0.1, 0.3, 0.5, last, 0.9, 1.0])
    wanted = [[0, 2 * max(t - last, 0.0), np.pi / 2 * min(t / first, 1.0)] for t in times]
    np.testing.assert_allclose(found.at(times), wanted, rtol=0, atol=1e-14 if told else 1e-12)
    assert len(found.powers) < (70 if told else 200)
    switched = course([f"2*heaviside(t - {last!r})", "0", f"{np.pi / 2 / first!r}*heaviside({first!r} - t)"], 1.0)
    np.testing.assert_allclose(switched.at(times), wanted, rtol=0, atol=1e-14)
    assert np.abs(switched.edges - first).min() < 1e-15
    assert np.abs(switched.edges - last).min() < 1e-15


@pytest.mark.parametrize("width", [1e-3, 1e-6, 1e-9])
def test_a_short_smooth_push_is_followed(width: float) -> None:
    """However short: its integral is how far the end goes."""
    e = parse(f"0.3*exp(-((t-0.371)/{width})**2)/{width}", frozenset("t"))
    nothing = parse("0", frozenset("t"))
    course = course_of((nothing, e, nothing), (), 1.0, 1.0)
    np.testing.assert_allclose(course.at(0.3), 0.0, rtol=0, atol=1e-14)
    np.testing.assert_allclose(course.at(1.0), [0.0, 0.3 * np.sqrt(np.pi), 0.0], rtol=1e-6, atol=1e-14)


def test_there_is_no_pose_outside_the_run() -> None:
    """Beyond what rounding makes of its ends: not a number, rather than a polynomial gone astray."""
    found = course(["1", "0", "1"], 2.0)
    assert np.all(np.isfinite(found.at([0.0, 2.0, 2.0 + 1e-12, -1e-12])))
    assert np.all(np.isnan(found.at([-0.1, 2.1])))
    assert np.all(np.isfinite(found.at(1.0)))


def test_an_end_that_moves_too_often_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """With what to do; so is one that moves without bound."""
    monkeypatch.setattr(module, "MOST_CELLS", 4096)
    expected = r"ends: expected driven ends that can be followed .*, found one that moves .*; shorten run.until"
    for speed in ("cos(1e6*t)", "1/(t - 0.3)**2"):
        with pytest.raises(InputError, match=expected):
            course(["0", "0", speed], 1.0)


def test_a_twist_that_is_not_finite_makes_a_pose_that_is_not() -> None:
    """From then on; whoever integrates will stop there."""
    found = course(["sqrt(1 - t)", "0", "0"], 2.0)
    np.testing.assert_allclose(found.at(0.5)[0], 2 / 3 * (1 - 0.5**1.5), rtol=1e-13)
    assert np.isnan(found.at(1.5)[0])
