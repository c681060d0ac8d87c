"""Stretching rods: balances by collocation, approaches to rest by the matrix exponential."""

import math

import numpy as np
import pytest
from scipy.linalg import expm

from tests.references import axial, chebyshev
from tests.references.axial import Array, Ends

K1, FRICTION1, LENGTH, DEGREE = 3.0, 0.7, 1.6, 40
U, SLOPE = chebyshev.points(DEGREE, LENGTH), chebyshev.derivative(DEGREE, LENGTH)


def _moved(start: Array, t: float, source: float, growth: float, held: tuple[bool, bool]) -> Array:
    """x at the points at t, from friction1 x_t = k1 x'' + source + friction1 growth x, by a matrix exponential.

    A held end keeps its x; a free one keeps x' = 1: its value follows from those inside.
    """
    size = DEGREE + 1
    ends = np.array([0, DEGREE])
    conditions = np.stack([np.eye(size)[k] if fixed else SLOPE[k] for k, fixed in zip(ends, held, strict=True)])
    wanted = np.array([start[k] if fixed else 1.0 for k, fixed in zip(ends, held, strict=True)])
    inner = np.arange(1, DEGREE)
    back = np.linalg.inv(conditions[:, ends])
    fill = np.zeros((size, size))  # from inner values, and 1, to all values
    fill[inner, inner] = 1.0
    fill[np.ix_(ends, inner)] = -back @ conditions[:, inner]
    fill[ends, -1] = back @ wanted
    fill = fill[:, [*inner, DEGREE]]
    rate = np.zeros((DEGREE, DEGREE))
    rate[:-1] = ((K1 / FRICTION1 * SLOPE @ SLOPE + growth * np.eye(size)) @ fill)[1:-1]
    rate[:-1, -1] += source / FRICTION1
    return np.asarray(fill @ (expm(rate * t) @ np.append(start[1:-1], 1.0)))


@pytest.mark.parametrize("ends", ["held-free", "held-held"])
def test_weight_stretches_the_rod_in_time_as_the_matrix_exponential_says(ends: Ends) -> None:
    """From rest to a sagging rod, one time early, one late; the stretch is the slope."""
    for t in (0.02, 0.4):
        expected = _moved(U, t, 0.8, 0.0, (True, ends == "held-held"))
        position, stretch = axial.sagging(U, t, 0.8, K1, FRICTION1, LENGTH, ends)
        np.testing.assert_allclose(position, expected, atol=1e-11)
        np.testing.assert_allclose(stretch, SLOPE @ expected, atol=1e-9)


@pytest.mark.parametrize("ends", ["held-free", "held-held"])
def test_the_hanging_rod_carries_its_weight(ends: Ends) -> None:
    """F1' = -w, the free end carries nothing, held ends stay L apart."""
    position, stretch = axial.hanging(U, 0.8, K1, LENGTH, ends)
    np.testing.assert_allclose(SLOPE @ position, stretch, atol=1e-12)
    np.testing.assert_allclose(K1 * SLOPE @ stretch, -0.8, atol=1e-11)
    assert position[0] == 0.0
    if ends == "held-free":
        assert stretch[-1] == pytest.approx(1.0, abs=1e-15)
    else:
        assert position[-1] == pytest.approx(LENGTH, abs=1e-15)


def test_a_falling_rod_has_drag_equal_to_its_weight() -> None:
    """The velocity times the friction is the weight."""
    assert FRICTION1 * axial.falling(0.8, FRICTION1) == pytest.approx(0.8)


@pytest.mark.parametrize("extension", [2.0, 0.0, -5.0])
def test_the_rod_in_a_flow_along_it_is_in_balance(extension: float) -> None:
    """k1 x'' = -friction1 e x, x' = 1 at both ends, x = 0 in the middle; drawn out, or compressed."""
    position, stretch = axial.extended(U, extension, K1, FRICTION1, LENGTH)
    np.testing.assert_allclose(SLOPE @ position, stretch, atol=1e-11)
    np.testing.assert_allclose(K1 * SLOPE @ stretch, -FRICTION1 * extension * position, atol=1e-10)
    np.testing.assert_allclose(stretch[[0, -1]], 1.0, atol=1e-15)
    assert position[DEGREE // 2] == pytest.approx(0.0, abs=1e-15)
    assert (stretch[DEGREE // 2] - 1.0) * extension >= 0.0


def test_from_the_critical_extension_on_there_is_no_such_state() -> None:
    """Just below, the stretch is huge; at it, refused; the slowest mode of the free rod then has no decay."""
    critical = axial.critical_extension(K1, FRICTION1, LENGTH)
    assert axial.extended(U, (1.0 - 1e-6) * critical, K1, FRICTION1, LENGTH)[1].max() > 1e5
    with pytest.raises(ValueError, match="expected an extension below"):
        axial.extended(U, critical, K1, FRICTION1, LENGTH)
    assert critical == pytest.approx(K1 / FRICTION1 * (math.pi / LENGTH) ** 2, rel=1e-15)


@pytest.mark.parametrize("extension", [2.0, -5.0])
def test_a_rod_put_into_the_flow_moves_as_the_matrix_exponential_says(extension: float) -> None:
    """Off the centre, so that it is carried away, or drawn back by a trap to a point (e = -trap / friction1)."""
    for t in (0.02, 0.4):
        expected = _moved(U - 0.5 * LENGTH + 0.3, t, 0.0, extension, (False, False))
        position, stretch = axial.carried(U, t, extension, 0.3, K1, FRICTION1, LENGTH)
        np.testing.assert_allclose(position, expected, atol=1e-11)
        np.testing.assert_allclose(stretch, SLOPE @ expected, atol=1e-9)


def test_a_trap_brings_each_component_back_at_its_own_rate() -> None:
    """friction d/dt displacement = -trap displacement, for each axis; by a small step of time."""
    friction, trap, step = np.array([0.7, 1.9]), 1.3, 1e-6
    before, now, after = (axial.returning([0.4, -0.2], 0.5 + k * step, trap, friction) for k in (-1, 0, 1))
    np.testing.assert_allclose(friction * (after - before) / (2.0 * step), -trap * now, rtol=1e-8)
    np.testing.assert_array_equal(axial.returning([0.4, -0.2], 0.0, trap, friction), [0.4, -0.2])
