"""Motions whose period is known are given it; motions that do not recur, or are shown too rarely, are given none."""

from __future__ import annotations

import dataclasses
import io
import json
import time
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from rich.console import Console

import geocosserat
from geocosserat.results.recurrence import LEAST, TOLERANCE, Recurrence, recurrence
from geocosserat.results.solution import SHAPES, Solution
from geocosserat.results.summary import print_summary, summary
from tests.marks import slow
from tests.results.motions import Array, rod

PERIOD = 0.7
TWO_PI = 2 * np.pi
Course = Callable[[Array], Array]


def rate_of(course: Course) -> Course:
    """The derivative of an analytic function, to round-off, by a step off the real axis."""
    return lambda t: course(t + 1e-30j).imag / 1e-30


def bending(course: Course, *, until: float = 6.3 * PERIOD, frames: int = 241, motion: str = "planar",
            **changes: Any) -> Solution:
    """A clamped rod of curvature 2 + course(t): planar, or a helix."""
    darboux = (0.0, 0.0, 1.0) if motion == "planar" else (0.5, 0.3, 1.0)
    return rod(motion, darboux, lambda t: 2 + course(t), rate_of(course), until=until, frames=frames, **changes)


def wave(t: Array) -> Array:
    """A period of PERIOD, not sinusoidal."""
    phase = TWO_PI * t / PERIOD
    return np.sin(phase) + 0.3 * np.cos(2 * phase + 0.4)


def carried(solution: Solution, poses: Array, twists: Array) -> Solution:
    """The rod on a base that moves by poses (T, size, size), with body twists (T, d)."""
    group = solution.group
    own = group.pose(solution.position, solution.rotation)
    moved = poses[:, None] @ own
    twist = solution.twist + (group.Ad(group.inverse(own)) @ twists[:, None, :, None])[..., 0]
    angle = solution.angle
    if angle is not None:
        turned = np.unwrap(np.arctan2(poses[:, 2, 1], poses[:, 1, 1]))
        angle = angle + turned[:, None]
    return dataclasses.replace(solution, position=group.position(moved), rotation=group.rotation(moved),
                               twist=twist, angle=angle)


def gliding(solution: Solution, velocity: tuple[float, ...], spin: float = 0.0) -> Solution:
    """The rod on a base that goes at a constant velocity in the world, turning about the last axis."""
    group, t = solution.group, solution.time
    turned = np.zeros((len(t), group.space, group.space)) + np.eye(group.space)
    c, s = np.cos(spin * t), np.sin(spin * t)
    turned[:, 0, 0], turned[:, 0, 1], turned[:, 1, 0], turned[:, 1, 1] = c, -s, s, c
    if group.space == 3:  # about e_3, so that columns 1 and 2 turn
        turned[:, 2, 2] = 1.0
    twists = np.zeros((len(t), group.dimension))
    twists[:, : group.space] = np.swapaxes(turned, 1, 2) @ np.array(velocity)
    twists[:, -1] = spin
    return carried(solution, group.pose(t[:, None] * np.array(velocity), turned), twists)


def found(solution: Solution) -> Recurrence:
    result = recurrence(solution)
    assert result is not None
    return result


@pytest.mark.parametrize("motion", ["planar", "spatial"])
def test_a_motion_of_known_period_is_given_it_to_far_less_than_its_frames(motion: str) -> None:
    """39 frames a period and a second harmonic: ten digits. It recurs from the start and does not drift."""
    result = found(bending(wave, motion=motion))
    assert result.period == pytest.approx(PERIOD, rel=1e-10)
    assert result.error < 1e-8
    assert result.start < 0.03
    assert result.drift is None


def test_the_amplitude_is_the_furthest_of_a_node_from_its_mean_place() -> None:
    """Here that of the tip, by the closed form on a fine grid of times."""
    fine = bending(wave, until=PERIOD * (1 - 1 / 4000), frames=4000)
    tip = fine.position[:, -1]
    expected = np.linalg.norm(tip - tip.mean(axis=0), axis=1).max()
    assert found(bending(wave)).amplitude == pytest.approx(expected, rel=2e-3)  # 64 places a period


@pytest.mark.parametrize("weak", [1.0, 0.1, 0.003])
def test_the_period_is_that_of_the_fundamental_however_weak(weak: float) -> None:
    """At 0.003 the halves of a period differ by less than the tolerance: but they do not come to differ less."""
    result = found(bending(lambda t: np.sin(2 * TWO_PI * t / PERIOD) + weak * np.sin(TWO_PI * t / PERIOD + 0.2)))
    assert result.period == pytest.approx(PERIOD, rel=1e-7)


@pytest.mark.parametrize("seen", [2.02, 2.5, 3.1, 9.7])
def test_two_periods_that_agree_are_enough(seen: float) -> None:
    """And the shortest is found of any number of them, never two periods for one."""
    assert found(bending(wave, until=seen * PERIOD)).period == pytest.approx(PERIOD, rel=1e-8)


@pytest.mark.parametrize("seen", [0.4, 1.0, 1.95, 1.996])
def test_less_than_two_periods_show_nothing(seen: float) -> None:
    """What might recur has not been seen to."""
    assert recurrence(bending(wave, until=seen * PERIOD)) is None


@pytest.mark.parametrize(("course", "why"), [
    (lambda t: 0 * t, "at rest"),
    (lambda t: 1e-11 * np.sin(9 * t), "a motion below what counts"),
    (lambda t: np.exp(-2 * t), "relaxing"),
    (lambda t: 0.3 * t, "bending further and further"),
    (lambda t: np.exp(-t) * np.sin(9 * t), "ringing down fast"),
    (lambda t: np.exp(-0.01 * t) * np.sin(9 * t), "by a hundredth in a period and a half"),
    (lambda t: np.exp(-0.004 * t) * np.sin(9 * t), "ringing down slowly, by less than the tolerance a period"),
    (lambda t: np.exp(-0.004 * t) * np.sin(9 * t) + 0.2 * np.exp(-2 * t), "and at first something dies out faster"),
    (lambda t: np.exp(0.004 * t) * np.sin(9 * t) / 2, "growing slowly"),
    (lambda t: np.sin(9 * t) + 0.02 * t, "swinging about a place that moves"),
    (lambda t: np.sin(9 * t * (1 + 0.03 * t)), "faster and faster"),
    (lambda t: np.sin(9 * t * (1 + 0.0003 * t)), "slowly faster, by less than the tolerance a period"),
    (lambda t: 0.5 * np.sin(9 * t) + 0.5 * np.sin(9 * np.sqrt(2) * t), "two frequencies without a common period"),
    (lambda t: np.sin(9 * t) + 0.004 * np.sin(9 * np.sqrt(2) * t), "and one of the two is weak"),
])
@pytest.mark.parametrize("until", [4.3, 17.0])
def test_what_does_not_recur_is_given_no_period(course: Course, why: str, until: float) -> None:
    """In space as in the plane; 'less than the tolerance a period' needs to be told from an approach to a cycle."""
    frames = 1 + round(60 * until)
    assert recurrence(bending(course, until=until, frames=frames)) is None, why
    assert recurrence(bending(course, until=until, frames=frames, motion="spatial")) is None, why


def test_round_off_is_no_motion() -> None:
    """Nor is what the accuracy asked for leaves doubtful: a wave of 1e-5 of the length counts at 1e-9, not at 1e-6."""
    noise = np.random.default_rng(1)
    at_rest = bending(lambda t: 0 * t)
    shaken = dataclasses.replace(at_rest, position=at_rest.position + 1e-15 * noise.standard_normal((241, 13, 2)))
    assert recurrence(shaken) is None
    small = bending(lambda t: 1e-5 * wave(t), requested=1e-6)
    assert recurrence(small) is None
    assert found(dataclasses.replace(small, requested=1e-9)).period == pytest.approx(PERIOD, rel=1e-8)


def test_noise_in_the_frames_does_not_hide_a_period() -> None:
    """What the accuracy asked for allows, one period may differ from the next by."""
    noise = np.random.default_rng(2)
    exact = bending(wave)
    shaken = dataclasses.replace(exact, requested=1e-3,
                                 position=exact.position + 3e-4 * noise.standard_normal(exact.position.shape))
    result = found(shaken)
    assert result.period == pytest.approx(PERIOD, rel=1e-4)
    assert 1e-4 < result.error < 3e-3


def test_a_cycle_that_is_approached_is_told_with_its_error() -> None:
    """Transients that shrink by 0.55 a period: an error of what is left, and the time since when it is tolerable."""
    still = np.log(1 / 0.55) / PERIOD
    result = found(bending(lambda t: wave(t) * (1 + 0.4 * np.exp(-still * t)), until=8.3 * PERIOD, frames=401))
    left = 0.4 * 0.55 ** 7.8 * (1 / 0.55 - 1)
    assert left / 2 < result.error < 2 * left
    assert result.period == pytest.approx(PERIOD, rel=result.error)
    assert 3 * PERIOD < result.start < 6.3 * PERIOD


def test_it_recurs_from_when_it_does() -> None:
    """A sudden start's transient is over when what is left of it is a hundredth of the excursion."""
    result = found(bending(lambda t: np.sin(TWO_PI * t / PERIOD) + np.exp(-5 * t), until=7 * PERIOD))
    gone = np.log(1 / TOLERANCE) / 5  # give or take a factor of 2 in what is left
    assert abs(result.start - gone) < np.log(2) / 5
    assert result.period == pytest.approx(PERIOD, rel=1e-6)


@pytest.mark.parametrize("frames", [8.3, 9.5, 11.0, 13.7, 20.5])
def test_few_frames_a_period_are_enough_for_a_smooth_motion(frames: float) -> None:
    """A single harmonic, a little more than the least number of frames a period."""
    count = round(6.3 * frames) + 1
    result = found(bending(lambda t: 0.2 * np.sin(TWO_PI * t / PERIOD), until=(count - 1) * PERIOD / frames,
                           frames=count))
    assert result.period == pytest.approx(PERIOD, rel=1e-4)


@settings(max_examples=100, deadline=None)
@example(frames=7.625, shift=0.0, pure=False)
@given(frames=st.floats(0.03, 2 * LEAST), shift=st.floats(0.0, 6.0), pure=st.booleans())
def test_too_few_frames_a_period_give_the_period_or_nothing(frames: float, shift: float, pure: bool) -> None:
    """Aliases are slow motions in the values, but not in the rates; multiples of a short period are none."""
    step = PERIOD / frames
    course = (lambda t: 0.2 * np.sin(TWO_PI * t / PERIOD)) if pure else wave
    result = recurrence(bending(lambda t: course(t + shift), until=120 * step, frames=121))
    assert result is None or (result.period == pytest.approx(PERIOD, rel=1e-3) and frames > LEAST - 0.01)


@pytest.mark.parametrize("frames", [3.0, 3.93, 5.2, 7.9])
def test_where_a_period_has_too_few_frames_its_double_is_not_taken_for_it(frames: float) -> None:
    """Two periods would have enough, and fit."""
    assert recurrence(bending(lambda t: 0.2 * np.sin(TWO_PI * t / PERIOD), until=100 * PERIOD / frames,
                              frames=101)) is None


@pytest.mark.parametrize("frames", [70, 140, 160, 190, 250, 310, 500])
def test_a_cycle_that_is_approached_has_its_shortest_period_in_a_long_run_too(frames: int) -> None:
    """Found with every frame, or with every second or fourth one."""
    still = np.log(1 / 0.6) / PERIOD
    result = found(bending(lambda t: wave(t) * (1 + 0.4 * np.exp(-still * t)), until=9.0 * PERIOD, frames=9 * frames))
    assert result.error > 1e-3
    assert result.period == pytest.approx(PERIOD, rel=1e-2)


@pytest.mark.parametrize("frames", [0.5, 1.0, 20 / 19, 20 / 21, 100 / 101, 2.0, 2.1])
def test_an_alias_is_not_taken_for_the_motion(frames: float) -> None:
    """About a frame a period the values look like a motion of 20 or 100 frames a period."""
    assert recurrence(bending(wave, until=600 * PERIOD / frames, frames=601)) is None


def test_a_fast_part_that_the_frames_miss_makes_them_too_few() -> None:
    """A slow wave alone is given its period; with a fast one on it that the frames alias, it is not."""
    slow_part = bending(wave)
    fast = TWO_PI / (slow_part.time[1] * 1.002)
    assert recurrence(slow_part) is not None
    assert recurrence(bending(lambda t: wave(t) + 0.1 * np.sin(fast * t))) is None


@pytest.mark.parametrize("motion", ["planar", "spatial"])
def test_a_swimmer_recurs_in_shape_and_is_told_its_drift(motion: str) -> None:
    """What a period adds, in the world; without the drift the amplitude is that of the rod in place."""
    in_place = bending(wave, motion=motion)
    velocity = (0.8, -0.3, 0.2)[: in_place.group.space]
    result = found(gliding(in_place, velocity))
    assert result.period == pytest.approx(PERIOD, rel=1e-9)
    assert result.drift is not None
    np.testing.assert_allclose(result.drift[0], np.array(velocity) * PERIOD, atol=1e-6)
    assert abs(result.drift[1]) < 1e-6
    assert result.amplitude == pytest.approx(found(in_place).amplitude, rel=1e-6)


@pytest.mark.parametrize("speed", [1e-3, 1e-5])
def test_a_slow_swimmer_drifts_and_one_in_place_does_not(speed: float) -> None:
    """A drift is told where it is more than the accuracy asked for leaves doubtful: 1e-6 of the length."""
    result = found(gliding(bending(wave), (speed, 0.0)))
    assert result.drift is not None
    assert result.drift[0][0] == pytest.approx(speed * PERIOD, rel=1e-2)
    assert found(gliding(bending(wave), (speed / 1e4, 0.0))).drift is None


@pytest.mark.parametrize("motion", ["planar", "spatial"])
def test_a_swimmer_in_circles_is_told_the_turn_of_a_period(motion: str) -> None:
    """In the plane with its sign, in space without."""
    result = found(gliding(bending(wave, motion=motion), (0.0,) * (2 if motion == "planar" else 3), spin=-1.3))
    assert result.period == pytest.approx(PERIOD, rel=1e-9)
    assert result.drift is not None
    assert result.drift[1] == pytest.approx((-1 if motion == "planar" else 1) * 1.3 * PERIOD, abs=1e-6)


@pytest.mark.parametrize("motion", ["planar", "spatial"])
@pytest.mark.parametrize("glides", [False, True])
def test_a_rod_of_constant_shape_that_turns_has_the_period_of_its_turning(motion: str, glides: bool) -> None:
    """As a magnet in a turning field, or a helix that sinks and turns; amplitude: the circle of the tip."""
    bent = bending(lambda t: 0 * t, motion=motion)
    velocity = (0.4, 0.0, 0.0)[: bent.group.space] if glides else (0.0, 0.0, 0.0)[: bent.group.space]
    result = found(gliding(bent, velocity, spin=TWO_PI / PERIOD))
    assert result.period == pytest.approx(PERIOD, rel=1e-9)
    assert (result.drift is not None) == glides
    assert result.amplitude == pytest.approx(np.linalg.norm(bent.position[0, :, :2], axis=1).max(), rel=1e-3)


def test_a_rod_of_constant_shape_that_is_shaken_has_the_period_of_its_places() -> None:
    """Neither shape nor direction changes."""
    bent = bending(lambda t: 0 * t)
    group, t = bent.group, bent.time
    path = np.stack([np.sin(TWO_PI * t / PERIOD), 0 * t], axis=1)
    speed = np.stack([np.cos(TWO_PI * t / PERIOD) * TWO_PI / PERIOD, 0 * t, 0 * t], axis=1)
    result = found(carried(bent, group.pose(path, np.zeros((len(t), 2, 2)) + np.eye(2)), speed))
    assert result.period == pytest.approx(PERIOD, rel=1e-9)
    assert result.amplitude == pytest.approx(1.0, rel=1e-3)
    assert result.drift is None


@settings(max_examples=20, deadline=None)
@given(angle=st.floats(-3.0, 3.0), away=st.tuples(st.floats(-5, 5), st.floats(-5, 5)))
def test_it_does_not_depend_on_where_the_world_has_its_axes(angle: float, away: tuple[float, float]) -> None:
    """Turned and moved, the rod has the same period, amplitude and error, and its drift is turned."""
    solution = gliding(bending(wave), (0.5, 0.1))
    c, s = np.cos(angle), np.sin(angle)
    pose = solution.group.pose(np.array(away), np.array([[c, -s], [s, c]]))
    moved = carried(solution, np.broadcast_to(pose, (len(solution.time), 3, 3)), np.zeros((len(solution.time), 3)))
    here, there = found(solution), found(moved)
    assert there.period == pytest.approx(here.period, rel=1e-12)
    assert there.amplitude == pytest.approx(here.amplitude, rel=1e-9)
    assert there.error == pytest.approx(here.error, rel=1e-3, abs=1e-12)
    assert here.drift is not None
    assert there.drift is not None
    np.testing.assert_allclose(there.drift[0], pose[1:, 1:] @ here.drift[0], atol=1e-9)


@settings(max_examples=20, deadline=None)
@given(unit=st.floats(1e-9, 1e9))
def test_it_does_not_depend_on_the_unit_of_time(unit: float) -> None:
    """Another unit changes the numbers of times, and nothing else."""
    solution = gliding(bending(wave), (0.5, 0.1))
    scaled = dataclasses.replace(solution, time=solution.time * unit, twist=solution.twist / unit)
    one, other = found(solution), found(scaled)
    assert other.period == pytest.approx(one.period * unit, rel=1e-12)
    assert other.start == pytest.approx(one.start * unit, rel=1e-12)
    assert (other.amplitude, other.error) == pytest.approx((one.amplitude, one.error), rel=1e-6)


@settings(max_examples=20, deadline=None)
@given(unit=st.floats(1e-9, 1e9))
def test_it_does_not_depend_on_the_unit_of_length(unit: float) -> None:
    """Another unit changes the amplitude and the drift, and nothing else; here of a cycle that is approached."""
    solution = gliding(bending(lambda t: wave(t) * (1 + 0.2 * np.exp(-t))), (0.5, 0.1))
    lengths = {name: getattr(solution, name) * unit for name in ("length", "u", "u_point", "position")}
    twist = solution.twist * np.array([unit, unit, 1.0])
    one, other = found(solution), found(dataclasses.replace(solution, **lengths, twist=twist))
    assert other.amplitude == pytest.approx(one.amplitude * unit, rel=1e-9)
    assert (other.period, other.start) == pytest.approx((one.period, one.start), rel=1e-9)
    assert one.error > 1e-3
    assert other.error == pytest.approx(one.error, rel=1e-6)


@settings(max_examples=30, deadline=None)
@given(frames=st.integers(150, 900), until=st.floats(2.1, 6.0))
def test_it_does_not_depend_on_the_number_of_frames(frames: int, until: float) -> None:
    """Nor on where the run ends, once there are enough."""
    assert found(bending(wave, frames=frames, until=until * PERIOD)).period == pytest.approx(PERIOD, rel=1e-8)


@pytest.mark.parametrize("periods", [2.3, 4.1, 300.0])
def test_long_runs_are_searched_for_short_periods_and_for_long_ones(periods: float) -> None:
    """5001 frames, seen whole with frames left out, and in full at the end; it has recurred since the start."""
    began = time.process_time()
    result = found(bending(wave, until=periods * PERIOD, frames=5001))
    assert time.process_time() - began < 2.0
    assert result.period == pytest.approx(PERIOD, rel=1e-7)
    assert result.start < 0.1 * PERIOD


def test_many_frames_of_many_nodes_are_looked_at_in_bounded_time() -> None:
    """A hundred thousand frames, and a rod of 241 nodes: some of them are enough."""
    for options in ({"frames": 100_001, "elements": 1, "degree": 2}, {"frames": 2001, "elements": 40}):
        solution = bending(wave, until=50 * PERIOD, **options)
        began = time.process_time()
        assert found(solution).period == pytest.approx(PERIOD, rel=1e-7)
        assert time.process_time() - began < 2.0


def test_a_rod_that_rests_before_it_moves_raises_no_warning() -> None:
    """Of its last four periods the first two are without any motion, to the last bit."""
    start = 4.0 * PERIOD + 1e-9
    assert recurrence(bending(lambda t: np.where(t > start, wave(t) * (1 + 0.02 * np.exp(start - t)), 0 * t),
                              until=6.0 * PERIOD)) is None


def test_the_last_frame_may_come_early_and_others_may_not() -> None:
    """A run that could not finish ends between two frames; frames at any times are not looked at."""
    t = np.append(np.linspace(0.0, 6.0 * PERIOD, 240), 6.01 * PERIOD)
    assert found(_at(t)).period == pytest.approx(PERIOD, rel=1e-8)
    assert recurrence(_at(np.delete(t, 50))) is None
    assert recurrence(_at(np.sort(np.random.default_rng(0).uniform(0, 6 * PERIOD, 241)))) is None


def _at(t: Array) -> Solution:
    """The wave at times of one's own."""
    frames = [rod("planar", (0.0, 0.0, 1.0), lambda _, t=t: 2 + wave(t), lambda _, t=t: rate_of(wave)(t), frames=1)
              for t in (t[k : k + 1] for k in range(len(t)))]
    timed = [name for name, shape in SHAPES.items() if shape[0] == "time" and name != "time"]
    return dataclasses.replace(frames[0], time=t, **{n: np.concatenate([getattr(f, n) for f in frames]) for n in timed})


def test_numbers_that_are_not_finite_do_not_recur() -> None:
    """And raise no warning."""
    broken = bending(wave)
    for value in (np.nan, np.inf, 1e200):
        position = broken.position.copy()
        position[-3, 2, 0] = value
        assert recurrence(dataclasses.replace(broken, position=position)) is None


def test_the_summary_tells_it_in_json_and_in_words() -> None:
    """`periodic` with its fields and one line; null and no line for a motion that does not recur."""
    swimmer, resting = gliding(bending(wave), (0.5, 0.1)), bending(lambda t: np.exp(-2 * t))
    fields = json.loads(json.dumps(summary(swimmer), allow_nan=False))["periodic"]
    assert set(fields) == {"period", "amplitude", "from", "error", "drift"}
    assert set(fields["drift"]) == {"displacement", "angle"}
    assert summary(resting)["periodic"] is None
    assert summary(bending(wave))["periodic"]["drift"] is None
    line = next(line for line in _printed(swimmer).splitlines() if line.startswith("period"))
    assert "0.7" in line
    assert "amplitude" in line
    assert "adds (0.35" in _printed(swimmer)
    assert "adds" not in _printed(bending(wave))
    assert "\nperiod" not in _printed(resting)


def _printed(solution: Solution) -> str:
    stream = io.StringIO()
    print_summary(solution, Console(file=stream, width=160))
    return stream.getvalue()


def _run(name: str, *changes: str) -> geocosserat.Run:
    return geocosserat.run(f"examples/{name}.toml", settings=changes)


def test_a_driven_rod_has_the_period_of_its_drive() -> None:
    """To 1e-6, once its transients are gone."""
    found = _run("driven", "run.until=3.2").periodic
    assert found["period"] == pytest.approx(TWO_PI / 20, rel=1e-6)
    assert found["drift"] is None
    assert _run("driven").periodic is None  # which runs for two periods, and the first is not like the second


@pytest.mark.parametrize(("name", "change", "period"), [
    slow("swimmer", "run.until=0.3", 0.1),
    slow("magnetic", "run.until=6", TWO_PI / 6),
    slow("spun", "run.frames=401", TWO_PI / 80),
])
def test_rods_that_are_driven_have_the_period_of_what_drives_them(name: str, change: str, period: float) -> None:
    """A wave of curvature, a turning field, a base that spins; the last approaches its speed slowly."""
    found = _run(name, change).periodic
    assert found["period"] == pytest.approx(period, rel=max(1e-6, found["error"]))
    assert (found["drift"] is None) == (name != "swimmer")


@pytest.mark.slow
def test_a_rod_in_a_shear_flow_tumbles_by_half_turns() -> None:
    """Its shape recurs when its ends have changed places, against the clock."""
    found = _run("tumbling", "run.until=0.1", "run.frames=501").periodic
    assert found["drift"]["angle"] == pytest.approx(-np.pi, abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("frames", [401, 201])
def test_a_cilium_beats_with_a_period_that_does_not_depend_on_the_frames(frames: int) -> None:
    """Its tip lashes: 21 frames a beat or 10.5, and the latter not a whole number."""
    found = _run("cilium", f"run.frames={frames}").periodic
    assert found["period"] == pytest.approx(0.0525622087, rel=1e-4 if frames == 201 else 1e-7)
    assert found["drift"] is None


@pytest.mark.slow
def test_just_above_its_flutter_a_rod_beats_with_the_frequency_of_the_linear_theory() -> None:
    """A follower load of 28.0711 at the tip makes it flutter with 63.18617944337097 radians per time.

    Above, the period changes in proportion to the load: by half a percent at 28.2 and by two at 28.5.
    """
    critical, expected = 28.071118097904833, TWO_PI / 63.18617944337097
    loads = (28.2, 28.5)
    periods = []
    for load in loads:
        beat = _run("stability/follower_tip", f"load={load}", 'start.strain=["1 - load/200", "0", "0.5*(1 - u)"]',
                    "run.until=30", "run.frames=9001", "run.accuracy=1e-5").periodic
        assert beat["drift"] is None
        periods.append(beat["period"])
    assert periods[0] == pytest.approx(expected, rel=0.008)
    assert periods[1] == pytest.approx(expected, rel=0.022)
    slope = (periods[1] - periods[0]) / (loads[1] - loads[0])
    assert periods[0] - slope * (loads[0] - critical) == pytest.approx(expected, rel=1e-3)


def test_looking_costs_milliseconds() -> None:
    """Of a usual run, whether or not it recurs: about ten, so less than fifty on any machine."""
    for course in (wave, lambda t: np.exp(-2 * t), lambda t: np.sin(9 * t) / 2 + np.sin(13.1 * t)):
        solution = bending(course, frames=201)
        spent = []
        for _ in range(3):
            began = time.process_time()
            recurrence(solution)
            spent.append(time.process_time() - began)
        assert min(spent) < 0.05


def test_it_raises_no_warning() -> None:
    """Of a rod at rest to the last bit, or of one frame."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert recurrence(bending(lambda t: 0 * t)) is None
        assert recurrence(bending(wave, frames=1)) is None
