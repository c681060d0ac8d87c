"""Balances that steps are made to keep: for energies that are no square, on systems that are no rods."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pytest

from geocosserat.solver.diagonal import GAMMAS, Diverged, Stepper
from geocosserat.solver.integrate import LAST_RESORTS, integrate
from geocosserat.solver.kept import NOISE, kept
from tests.solver.problems import Array, Problem

STIFFNESS = np.array([1.0, 30.0, 1e3])
FORCE = np.array([0.3, -2.0, 1.0])


def _mobility(y: Array) -> Array:
    B = np.eye(3) + 0.2 * np.outer(np.sin(y), np.cos(y[::-1]))
    return B @ B.T


@dataclass
class Hardening:
    """y' = G(y) (force - S(y)) with S the gradient of y K y / 2 + y^4 + a hill, what that dissipates, and the work;
    its balance, and the correction there is. loaded: whether there is a force."""

    loaded: bool = False
    correction: Array = field(default_factory=lambda: np.zeros(3))
    direction: Array = field(default_factory=lambda: np.zeros(3))
    corrected: int = 0

    def stress(self, y: Array) -> Array:
        return STIFFNESS * y + 4.0 * y**3 - 6.0 * np.sin(2.0 * y)

    def energy(self, y: Array) -> float:
        return float(0.5 * y @ (STIFFNESS * y) + (y**4).sum() + 3.0 * np.cos(2.0 * y).sum())

    def problem(self) -> Problem:
        force = FORCE if self.loaded else np.zeros(3)

        def f(t: float, y: Array) -> Array:
            pushed = force - self.stress(y[:3]) - self.correction
            velocity = _mobility(y[:3]) @ pushed
            return np.append(velocity, [pushed @ velocity, force @ velocity])

        def J(t: float, y: Array) -> Array:
            return np.column_stack([f(t, y + 1e-30j * unit).imag / 1e-30 for unit in np.eye(5)])

        return Problem(5, f, J, quadratures=2)

    def stored(self, t: float, y: Array) -> tuple[float, float]:
        return self.energy(y[:3]), float(abs(self.energy(y[:3])) + np.abs(self.stress(y[:3])) @ (np.abs(y[:3]) + 1.0))

    def aim(self, t: float, before: Array, after: Array) -> float:
        size, change = np.abs(self.stress(after[:3]) - self.stress(before[:3])), (after - before)[:3]
        self.direction = size * np.sign(change)
        return float(size @ np.abs(change))

    def correct(self, share: float) -> None:
        self.corrected += share != 0.0
        self.correction = share * self.direction


START = np.array([0.3, -0.2, 0.01, 0.0, 0.0])
"""Near the top of the hill: what moves away from there makes energy, if it may."""

STEPS = (1e-7, 1e-5, 1e-3, 1e-2, 0.1, 1.0, 1e3)


def _made(law: Hardening, method: str, h: float) -> list[tuple[float, float]]:
    """Of up to four steps: the energy made of nothing, and what rounding may make of it."""
    stepper = Stepper(law.problem(), GAMMAS[method], 0.0, START, 1e-6, np.full(5, 1e-6), law)
    told = []
    for _ in range(4):
        stepper.linearise(stepper.t, stepper.y)
        try:
            end = stepper.end(h)
        except Diverged:
            break
        (was, size), (stored, other) = law.stored(0.0, stepper.y), law.stored(0.0, end)
        booked = end[3:] - stepper.y[3:]
        told.append((stored - was + booked[0] - booked[1], 2 * NOISE * (size + other + np.abs(end[3:]).sum())))
        stepper.t, stepper.y = stepper.t + h, end
    return told


@pytest.mark.parametrize("loaded", [False, True])
def test_the_safe_method_makes_no_energy_that_is_no_square(loaded: bool) -> None:
    """In no step, whatever its length; and some of them had to be made again."""
    law = Hardening(loaded)
    told = [step for h in STEPS for step in _made(law, "safe", h)]
    assert len(told) >= 16
    assert law.corrected > 0
    assert all(made <= noise for made, noise in told)


@pytest.mark.parametrize("loaded", [False, True])
def test_the_midpoint_rule_keeps_the_balance_of_an_energy_that_is_no_square(loaded: bool) -> None:
    """It closes in each step, to round-off, whatever its length."""
    law = Hardening(loaded)
    told = [step for h in STEPS for step in _made(law, "midpoint", h)]
    assert len(told) >= 16
    assert law.corrected > 0
    assert all(abs(made) <= noise for made, noise in told)


@pytest.mark.parametrize("method", LAST_RESORTS)
def test_steps_that_keep_a_balance_are_of_second_order(method: str) -> None:
    """Half the step, a quarter of the error."""
    ends = []
    for steps in (60, 120, 2400):
        law = Hardening()
        stepper = Stepper(law.problem(), GAMMAS[method], 0.0, START, 1e-6, np.full(5, 1e-6), law)
        for _ in range(steps):
            stepper.linearise(stepper.t, stepper.y)
            stepper.y = stepper.end(0.3 / steps)
        assert law.corrected > 0 or steps > 120
        ends.append(stepper.y[:3])
    coarse, fine = (np.abs(y - ends[-1]).max() for y in ends[:2])
    assert 3.5 < coarse / fine < 4.5


@pytest.mark.parametrize("method", LAST_RESORTS)
def test_a_run_by_a_last_resort_keeps_the_balance_it_is_given(method: str) -> None:
    """From the start to the end, at a tolerance that is no accuracy at all."""
    law = Hardening()
    found = integrate(law.problem(), START, np.linspace(0.0, 3.0, 7), method, 1e-2, 1e-2, balance=law)
    assert found.reached
    assert law.corrected > 0
    np.testing.assert_array_equal(law.correction, 0.0)
    made = np.diff([law.energy(y[:3]) + y[3] - y[4] for y in found.states])
    scale = law.stored(0.0, START)[1]
    assert made.max() <= 1e-11 * scale
    if method == "midpoint":
        assert made.min() >= -1e-11 * scale


def test_a_correction_ends_with_its_step() -> None:
    """However the step ends: kept, not to be kept, or with an error."""
    law = Hardening()

    def wrong() -> Array:
        return START + 1.0

    assert kept(law, 0.0, START, wrong, loses=False) is None
    np.testing.assert_array_equal(law.correction, 0.0)
    tries = iter([START + np.array([0.1, 0.0, 0.0, 0.4, 0.0])])  # a little more booked than lost

    def breaks() -> Array:
        try:
            return next(tries)
        except StopIteration:
            raise Diverged from None

    with pytest.raises(Diverged):
        kept(law, 0.0, START, breaks, loses=False)
    np.testing.assert_array_equal(law.correction, 0.0)


def test_a_step_that_keeps_its_balance_is_made_once() -> None:
    """And is not looked at any further."""
    law = Hardening()
    count: list[int] = []

    def step() -> Array:
        count.append(1)
        return START.copy()

    found = kept(law, 0.0, START, step, loses=False)
    assert found is not None
    np.testing.assert_array_equal(found, START)
    assert len(count) == 1
    assert law.corrected == 0


def test_an_energy_that_is_not_a_number_keeps_no_balance() -> None:
    """Such a step is not taken."""
    law = Hardening()
    assert kept(law, 0.0, START, lambda: np.full(5, np.nan), loses=True) is None
