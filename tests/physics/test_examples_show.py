"""The examples do what their first lines say."""

from __future__ import annotations

import numpy as np
import pytest

from geocosserat.results.solution import Solution
from tests.physics.scenes import Array, changed, example, simulate


def _solution(name: str, degree: int = 16, **changes: object) -> Solution:
    """An example on one or two elements, which its own accuracy takes too: no kernel is compiled for this alone."""
    scene = changed(example(name), {path.replace("__", "."): value for path, value in changes.items()})
    frames = scene["run"]["frames"]
    return simulate(scene, 2, degree, 1e-7, backend="auto", frames=frames).solution


def _middle(solution: Solution) -> Array:
    """The mean of the positions at every frame."""
    weight = np.gradient(solution.u)
    return np.asarray(np.einsum("n,tnx->tx", weight, solution.position) / weight.sum())


def test_the_cilium_goes_on_beating() -> None:
    """Its tip swings to either side, as far in the last quarter of the time as in the one before."""
    across = _solution("cilium").position[:, -1, 1]
    third, last = across[100:150], across[150:]
    assert min(third.min(), last.min()) < -0.1
    assert max(third.max(), last.max()) > 0.1
    np.testing.assert_allclose([last.min(), last.max()], [third.min(), third.max()], rtol=0.05)


def test_the_swimmer_swims_against_its_wave() -> None:
    """The wave runs towards larger u, which is to the right; over three beats the rod goes to the left."""
    middle = _middle(_solution("swimmer"))
    assert middle[-1, 0] < middle[0, 0] - 0.05


@pytest.mark.slow
def test_the_tumbling_rod_turns_over_and_buckles() -> None:
    """By half a turn; meanwhile its ends come much nearer to each other, and go apart again."""
    solution = _solution("tumbling")
    assert solution.angle is not None
    assert solution.angle[-1].mean() < solution.angle[0].mean() - 2.0
    span = np.linalg.norm(solution.position[:, -1] - solution.position[:, 0], axis=1)
    assert span.min() < 0.8
    assert span[-1] > 0.9


@pytest.mark.slow
def test_the_ring_becomes_round_and_sinks() -> None:
    """All its points end at the radius 1 / (2 pi) from its middle; it is closed throughout."""
    solution = _solution("ring")
    middle = _middle(solution)
    radius = np.linalg.norm(solution.position[-1] - middle[-1], axis=1)
    np.testing.assert_allclose(radius, 0.5 / np.pi, rtol=0.02)
    assert np.ptp(np.linalg.norm(solution.position[0] - middle[0], axis=1)) > 0.05
    assert middle[-1, 1] < middle[0, 1] - 0.01
    np.testing.assert_allclose(solution.position[:, -1], solution.position[:, 0], rtol=0, atol=1e-6)


@pytest.mark.slow
def test_the_magnetised_rod_follows_its_field() -> None:
    """In the end it turns as fast as the field does, behind it."""
    solution = _solution("magnetic")
    assert solution.angle is not None
    angle, time = solution.angle.mean(axis=1), solution.time
    speed = np.gradient(angle, time)[-20:]
    np.testing.assert_allclose(speed, 6.0, rtol=0.01)
    assert 0.0 < 6.0 * time[-1] - angle[-1] < np.pi / 2


def test_the_arch_swings_over() -> None:
    """Its middle goes from one side of the line between the pins to the other; the pins stay."""
    solution = _solution("pinned")
    start, line = solution.position[0, 0], solution.position[0, -1] - solution.position[0, 0]
    middle = solution.position[:, len(solution.u) // 2] - start
    side = line[0] * middle[:, 1] - line[1] * middle[:, 0]
    assert side[0] * side[-1] < 0.0
    np.testing.assert_allclose(solution.position[:, [0, -1]], np.stack([solution.position[0, [0, -1]]] * 101),
                               rtol=0, atol=1e-6)  # fmt: skip


@pytest.mark.slow
def test_the_spun_rod_is_wound_up_by_turns_and_stays_straight() -> None:
    """Several turns between base and tip."""
    solution = _solution("spun")
    twist = solution.turn[-1, :, 3]
    assert abs(twist.mean()) > 2 * 2 * np.pi
    np.testing.assert_allclose(solution.position[..., 1:], 0.0, atol=1e-12)


def test_the_towed_rod_does_not_turn_at_its_base_and_trails_behind() -> None:
    """The base goes along z; in the end all of the rod is behind it, and the tip has sagged."""
    solution = _solution("towed")
    assert np.abs(solution.rotation[:, 0] - np.eye(3)).max() < 1e-12
    behind = solution.position[-1, :, 2] - solution.position[-1, 0, 2]
    assert np.all(behind[1:] < 0.0)
    assert behind[-1] < -0.5
    assert solution.position[-1, -1, 1] < -0.02


def test_the_arc_that_cannot_shear_is_drawn_straight_and_longer() -> None:
    """Its ends go apart, from less than its length to more; nowhere is it sheared."""
    solution = _solution("unshearable")
    ends = solution.position[:, -1] - solution.position[:, 0]
    span = np.linalg.norm(ends, axis=1)
    assert span[0] < 0.9
    assert span[-1] > 1.0
    np.testing.assert_array_equal(solution.turn[:, :, 1], 0.0)


def test_the_band_stays_straight_while_its_end_goes_to_and_fro() -> None:
    """By a tenth of the length to either side; its other end stays."""
    solution = _solution("pure_stretch")
    assert np.abs(solution.position[..., 1]).max() < 1e-12
    assert solution.position[:, 0, 0].max() > 0.1
    assert solution.position[:, 0, 0].min() < -0.1
    assert np.abs(solution.position[:, -1] - [1.0, 0.0]).max() < 1e-12
