"""Follower forces in drag: Beck's determinant, published thresholds, and the role of inertia."""

import math

import numpy as np
import pytest

from tests.references.stability import filament, linear
from tests.references.stability.straight import Rod
from tests.references.stability.table import value

BENDING = Rod()


def test_becks_determinant_has_the_zeros_of_the_series() -> None:
    """Flutter at 37.695 and 191.26, published as 37.7 and 191 for the filament in Stokes flow, to 13 digits."""
    load, frequency = filament.beck_flutter(37.0, 190.0)
    assert load == pytest.approx(37.7, abs=0.05)
    found = linear.flutter(lambda p: filament.pushed_at_tip(BENDING, p), 37.6, 191.0)
    assert found == pytest.approx((load, frequency), rel=1e-13)
    # the scene has twice the friction across
    assert value("follower_tip_limit").value == pytest.approx(load, rel=1e-13)
    assert value("follower_tip_limit").frequency == pytest.approx(0.5 * frequency, rel=1e-13)


def test_growths_meet_at_becks_load_and_only_then_swing() -> None:
    """At 20.05, where Beck's column with inertia flutters, the filament in drag still decays, and begins to swing."""
    meeting = filament.beck_meeting()
    assert meeting == pytest.approx(20.05, abs=0.005)
    below, above = (
        linear.growths(filament.pushed_at_tip(BENDING, meeting * (1.0 + shift)), 1)[0] for shift in (-1e-3, 1e-3)
    )
    assert abs(below.imag) < 1e-6
    assert abs(above.imag) > 0.1
    assert max(below.real, above.real) < -100.0


def test_a_push_all_along_agrees_with_a_ritz_method() -> None:
    """76.10: Galerkin's method with modes of the unloaded rod, their integrals by quadrature, to five digits."""
    betas = np.array([1.875104068711961, 4.694091132974174, 7.854757438237613, 10.995540734875467, 14.13716839104647])
    betas = np.concatenate([betas, (np.arange(6, 25) - 0.5) * math.pi])
    x, w = np.polynomial.legendre.leggauss(200)
    u, w = 0.5 * (x + 1.0), 0.5 * w
    b, at = betas[:, None], betas[:, None] * u
    # written with decaying exponentials: s (cosh - sinh) and the rest that grows with 1 - s
    s = (np.cosh(b) + np.cos(b)) / (np.sinh(b) + np.sin(b))
    rest = 2.0 * (np.sin(b) - np.cos(b) - np.exp(-b)) / (1.0 - np.exp(-2.0 * b) + 2.0 * np.exp(-b) * np.sin(b))
    grow = 0.5 * rest * np.exp(at - b)  # (1 - s) / 2 exp(b u)
    decay = 0.5 * (1.0 + s) * np.exp(-at)
    shape = grow + decay - np.cos(at) + s * np.sin(at)
    bend = b**2 * (grow + decay + np.cos(at) - s * np.sin(at))
    push = -((shape * w * (1.0 - u)) @ bend.T)
    found, frequency = 0.0, 0.0
    low, high = 70.0, 80.0
    for _ in range(50):
        found = 0.5 * (low + high)
        growths = np.linalg.eigvals(-np.diag(betas**4) + found * push)
        frequency = abs(growths[np.argmax(growths.real)].imag)
        low, high = (low, found) if growths.real.max() > 0.0 else (found, high)
    expected = linear.flutter(lambda f: filament.pushed_along(BENDING, f), 76.0, 196.0)
    assert found == pytest.approx(expected[0], rel=3e-6)
    assert frequency == pytest.approx(expected[1], rel=1e-5)


def test_dead_and_follower_forces_differ() -> None:
    """The tip under a force that turns with it passes no growth through zero; a dead one does at pi^2 / 4."""
    for load in np.linspace(1.0, 60.0, 8):
        assert abs(linear.determinant(filament.pushed_at_tip(BENDING, load), 0.0)) > 0.1
