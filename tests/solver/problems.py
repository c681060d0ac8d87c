"""Stiff problems that are no rods, behind the kernel contract: with closed solutions or values from the literature."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass
class Problem:
    """y' = f(t, y) with dense linear algebra; notes every call.

    f(t, y) and J(t, y) return new arrays. instants: the times at which the rate was asked for.
    """

    size: int
    f: Callable[[float, Array], Array]
    J: Callable[[float, Array], Array]
    backend: str = "numpy"
    instants: list[float] = field(default_factory=list)
    jacobians: int = 0
    fixed: int = 0
    """How many entries, the last ones, are fixed by constraints."""
    quadratures: int = 0
    """How many of the last entries nothing depends on."""

    @property
    def algebraic(self) -> Array:
        return (np.arange(self.size) >= self.size - self.fixed).astype(float)

    def rate(self, t: float, y: Array, out: Array) -> None:
        self.instants.append(t)
        out[:] = self.f(t, y)

    def jacobian(self, t: float, y: Array) -> Array:
        self.jacobians += 1
        return self.J(t, y)

    def prepare(self, t: float, y: Array) -> None:
        self.jacobians += 1
        self.linear = self.J(t, y)

    def factor(self, gamma: float) -> None:
        moves = self.algebraic == 0
        self.inverse = np.linalg.inv(np.diag(moves.astype(float)) + np.where(moves, -gamma, 1.0)[:, None] * self.linear)

    def solve(self, b: Array, out: Array) -> None:
        out[:] = self.inverse @ b


def forced(size: int) -> Problem:
    """size variables that follow cos t, each at its own rate: y_i' = -rate_i (y_i - cos t)."""
    rates = forced_rates(size)
    return Problem(size, lambda t, y: -rates * (y - np.cos(t)), lambda t, y: np.diag(-rates))


def forced_rates(size: int) -> Array:
    """From 1 to a million."""
    return np.logspace(0, 6, size)


def forced_solution(size: int, times: Array, start: float = 1.0) -> Array:
    """(times, size), from y_i = start at times[0]."""
    rates, t = forced_rates(size), times[:, None]

    def driven(t: Array) -> Array:
        return (rates**2 * np.cos(t) + rates * np.sin(t)) / (rates**2 + 1)

    return driven(t) + (start - driven(t[:1])) * np.exp(-rates * (t - t[:1]))


def constrained(size: int) -> Problem:
    """The forced variables x, which follow not cos t but a z that a constraint makes so: (1 + x^2) (z - cos t) = 0."""
    rates = forced_rates(size)

    def f(t: float, y: Array) -> Array:
        x, z = np.split(y, 2)
        return np.concatenate([-rates * (x - z), (1 + x**2) * (z - np.cos(t))])

    def J(t: float, y: Array) -> Array:
        x, z = np.split(y, 2)
        return np.block([[np.diag(-rates), np.diag(rates)], [np.diag(2 * x * (z - np.cos(t))), np.diag(1 + x**2)]])

    return Problem(2 * size, f, J, fixed=size)


def diffusion(size: int) -> Problem:
    """The heat equation on a line of `size` points, both ends cold."""
    matrix = (size + 1) ** 2 * (np.eye(size, k=1) + np.eye(size, k=-1) - 2 * np.eye(size))
    return Problem(size, lambda t, y: matrix @ y, lambda t, y: matrix)


def diffusion_mode(size: int, number: int) -> tuple[Array, float]:
    """An eigenvector (size,) of the diffusion and the rate at which it decays."""
    shape = np.sin(np.pi * number * np.arange(1, size + 1) / (size + 1))
    return shape, 4 * (size + 1) ** 2 * np.sin(0.5 * np.pi * number / (size + 1)) ** 2


def robertson() -> Problem:
    """Robertson's chemistry: rates from 1e-2 to 1e9. Source: Hairer and Wanner (1996), section IV.1."""

    def f(t: float, y: Array) -> Array:
        a, b, c = y
        slow, fast, mixed = 0.04 * a, 3e7 * b * b, 1e4 * b * c
        return np.array([mixed - slow, slow - mixed - fast, fast])

    def J(t: float, y: Array) -> Array:
        _, b, c = y
        return np.array([[-0.04, 1e4 * c, 1e4 * b], [0.04, -1e4 * c - 6e7 * b, -1e4 * b], [0.0, 6e7 * b, 0.0]])

    return Problem(3, f, J)


ROBERTSON_END = 1e11
ROBERTSON = np.array([0.2083340149701255e-07, 0.8333360770334713e-13, 0.9999999791665050])
"""From (1, 0, 0) at t = 1e11. Source: F. Mazzia and C. Magherini, Test Set for IVP Solvers (2008), problem ROBER."""


def van_der_pol(stiffness: float = 1e6) -> Problem:
    """Van der Pol's oscillator in its slow time. Source: Hairer and Wanner (1996), section IV.10."""

    def f(t: float, y: Array) -> Array:
        return np.array([y[1], stiffness * ((1 - y[0] ** 2) * y[1] - y[0])])

    def J(t: float, y: Array) -> Array:
        return np.array([[0.0, 1.0], [stiffness * (-2 * y[0] * y[1] - 1), stiffness * (1 - y[0] ** 2)]])

    return Problem(2, f, J)


VAN_DER_POL = np.array([1.706167732170483, -0.8928097010247975])
"""From (2, 0) at t = 2. Source: F. Mazzia and C. Magherini, Test Set for IVP Solvers (2008), problem VDPOL."""
