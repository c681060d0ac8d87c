"""The linear equations of motion against the nonlinear ones, with many digits: a curved rod under stress in space."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, cached_property
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

from geocosserat.algebra.groups import SE3, Array
from geocosserat.referee.statement import Check
from paper_checks.linearisation import SECTION

STATEMENTS = {s.name: s for s in SECTION.statements}
RATES = ("(64a)", "(64b)", "(65)")
DIGITS, STEP, TINY = 100, mp.mpf("1e-20"), mp.mpf("1e-20")
HERE = mp.mpf(3) / 7


@pytest.fixture(autouse=True)
def _digits() -> Iterator[None]:
    with mp.workdps(DIGITS):
        yield


@cache
def check(name: str) -> Check:
    return STATEMENTS[name].check()


class Rod:
    """A rod of a cubic law whose stiffness varies, held anywhere: what its velocity is, and would be if displaced.

    stressed: whether the base state differs from the one at rest.
    """

    def __init__(self, stressed: bool = True) -> None:
        numbers = np.random.default_rng(7)
        random = np.vectorize(lambda n: mp.mpf(int(n)) / 100, otypes=[object])
        self.K, self.more, self.cubic = (random(numbers.integers(-99, 99, (6, 6))) for _ in range(3))
        self.mobility = random(numbers.integers(50, 99, 6))
        self.base, self.shape, self.rest = (random(numbers.integers(-99, 99, (6, 3))) for _ in range(3))
        self.rest = self.rest if stressed else self.base
        self.place, self.weight, self.moment, self.field = random(numbers.integers(-99, 99, (4, 3)))
        self.rotation = exp(np.concatenate([0 * self.place, random(numbers.integers(-99, 99, 3))]))[1:, 1:]

    def stress(self, u: Any, E: Array) -> Array:
        """(K + u L) e + C e^3, e what E differs from rest."""
        e = E - waves(self.rest, u)
        return (self.K + u * self.more) @ e + self.cubic @ e**3

    def tangent(self, u: Any) -> Array:
        """Its derivative by E, at the base state."""
        e = waves(self.base - self.rest, u)
        return self.K + u * self.more + self.cubic * 3 * e**2

    def wrench(self, displaced: Array) -> Array:
        """A spring and a weight, and the moment of a magnet in a field, at HERE."""
        phi = SE3.pose(self.place, self.rotation) @ displaced
        r, R = SE3.position(phi), SE3.rotation(phi)
        return np.concatenate([R.T @ (self.weight - r), np.cross(self.moment, R.T @ self.field)])

    def wrench_slope(self) -> Array:
        """What it gains by a displacement of one along, and about, each vector of the frame."""
        force, field = (self.rotation.T @ x for x in (self.weight - self.place, self.field))
        hats = [SE3.hat(np.concatenate([0 * x, x]))[1:, 1:] for x in (force, field, self.moment)]
        spring = -np.eye(3, dtype=int).astype(object)
        return np.block([[spring, hats[0]], [0 * spring, hats[2] @ hats[1]]])

    def turn(self, u: Any, epsilon: Any) -> Array:
        """Of phi_0 exp(epsilon eta), whose turn without the displacement is the base state."""

        def moved(x: Any) -> Array:
            return exp(epsilon * waves(self.shape, x))

        back = SE3.inverse(moved(u))
        return SE3.vee(back @ SE3.hat(waves(self.base, u)) @ moved(u) + back @ slope(moved, u))

    def velocity(self, epsilon: Any) -> Array:
        """The nonlinear equation at HERE."""
        S = self.stress(HERE, self.turn(HERE, epsilon))
        S_u = slope(lambda u: self.stress(u, self.turn(u, epsilon)), HERE)
        j = self.wrench(exp(epsilon * waves(self.shape, HERE)))
        return self.mobility * (S_u + SE3.coad(self.turn(HERE, epsilon)) @ S + j)

    @cached_property
    def rate(self) -> Array:
        """How the velocity changes with the displacement."""
        return slope(self.velocity, mp.mpf(0))

    def value(self, expressions: Any) -> Array:
        """Of expressions in the fields of the linear equations: base state, tangent, displacement."""
        e = waves(self.base, HERE)
        arrays = {
            "turn": (SE3.strain, e, slope(lambda u: waves(self.base, u), HERE)),
            "stress": (SE3.stress, self.stress(HERE, e), None),
            "eta": (names("eta", 6), *(waves(self.shape, HERE, order) for order in range(3))),
            "tangent": (names("T", 6, 6), self.tangent(HERE), slope(self.tangent, HERE)),
            "wrench": (names("S", 6, 6), self.wrench_slope()),
            "mobility": (names("Y", 6), self.mobility),
        }
        known = {
            sp.Symbol(name + suffix): x
            for labels, *values in arrays.values()
            for suffix, value in zip(("", "_u", "_uu"), values, strict=False)
            if value is not None
            for name, x in zip(labels, value.ravel(), strict=True)
        }
        found = np.asarray(expressions, dtype=object)
        function = sp.lambdify(list(known), list(found.ravel()), "mpmath")
        return np.array(function(*known.values()), dtype=object).reshape(found.shape)


def waves(coefficients: Array, u: Any, order: int = 0) -> Array:
    """Six fields a + b sin(u) + c u^2, and their derivatives."""
    forms = [(mp.mpf(1), mp.sin(u), u**2), (mp.mpf(0), mp.cos(u), 2 * u), (mp.mpf(0), -mp.sin(u), mp.mpf(2))]
    return coefficients @ np.array(forms[order], dtype=object)


def exp(X: Array) -> Array:
    """The exponential of the matrix of X."""
    return np.array(mp.expm(mp.matrix(SE3.hat(X).tolist())).tolist(), dtype=object)


def slope(f: Any, x: Any) -> Array:
    """The derivative, to about 40 digits."""
    return (f(x + STEP) - f(x - STEP)) / (2 * STEP)


def names(letter: str, *shape: int) -> list[str]:
    return [letter + "".join(str(i + 1) for i in index) for index in np.ndindex(*shape)]


def largest(x: Array) -> Any:
    return max(abs(y) for y in x.ravel())


def in_parts(rod: Rod, form: str) -> Array:
    """D eta'' + A eta' + R eta, with A and R of that form."""
    eta = [waves(rod.shape, HERE, order) for order in range(3)]
    D = rod.value(check("(66-D)").printed)
    A, R = (rod.value(getattr(check(part), form)) for part in ("(66-A)", "(66-R)"))
    return D @ eta[2] + A @ eta[1] + R @ eta[0]


@pytest.mark.parametrize("name", RATES)
def test_corrected_the_linear_velocity_is_the_slope_of_the_nonlinear_one(name: str) -> None:
    """About a curved base state under stress, to 20 digits."""
    rod = Rod()
    assert largest(rod.value(check(name).corrected) - rod.rate) < TINY


@pytest.mark.parametrize("name", RATES)
def test_printed_it_misses_what_the_stress_of_the_base_state_does(name: str) -> None:
    """By an amount of order one, with stress; not at all without."""
    stressed, unstressed = Rod(), Rod(stressed=False)
    assert largest(stressed.value(check(name).printed) - stressed.rate) > 0.1
    assert largest(unstressed.value(check(name).printed) - unstressed.rate) < TINY


@pytest.mark.parametrize("stressed", [True, False], ids=["stressed", "unstressed"])
def test_diffusion_advection_and_reaction_add_up_only_if_corrected(stressed: bool) -> None:
    """With the printed A and R the velocity is off by an amount of order one, even without stress."""
    rod = Rod(stressed)
    assert largest(in_parts(rod, "corrected") - rod.rate) < TINY
    assert largest(in_parts(rod, "printed") - rod.rate) > 0.1


def test_the_base_state_is_stressed_or_not_as_said() -> None:
    """Without stress nothing is left of it, with it there is some."""
    with_it, without = (rod.stress(HERE, waves(rod.base, HERE)) for rod in (Rod(), Rod(stressed=False)))
    assert largest(with_it) > 0.1
    assert largest(without) == 0


def test_a_displacement_moves_the_turn_by_its_covariant_slope() -> None:
    """eta' + [E_0, eta], which the linear equations start from."""
    rod = Rod()
    eta, eta_u = (waves(rod.shape, HERE, order) for order in (0, 1))
    found = slope(lambda epsilon: rod.turn(HERE, epsilon), mp.mpf(0))
    assert largest(found - eta_u - SE3.bracket(waves(rod.base, HERE), eta)) < TINY
