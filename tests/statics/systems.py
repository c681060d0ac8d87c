"""Small systems with states of rest that are known, in place of rods."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from geocosserat.kernel.contract import Array
from geocosserat.statics.linear import Linear
from geocosserat.statics.system import System

Rate = Callable[[Array], Array]


@dataclass(frozen=True, eq=False)
class Small:
    """A kernel of a few numbers; the Jacobian by steps into the complex plane, which lose no digits."""

    f: Rate
    size: int
    fixed: tuple[int, ...] = ()
    backend: str = field(default="numpy")

    @property
    def algebraic(self) -> Array:
        found = np.zeros(self.size)
        found[list(self.fixed)] = 1.0
        return found

    def rate(self, t: float, y: Array, out: Array) -> None:
        out[:] = self.f(y)

    def jacobian(self, t: float, y: Array) -> Array:
        h = 1e-100
        return np.stack([np.imag(self.f(y + h * 1j * e)) / h for e in np.eye(self.size)], axis=1)

    def prepare(self, t: float, y: Array) -> None:
        raise NotImplementedError

    def factor(self, gamma: float) -> None:
        raise NotImplementedError

    def solve(self, b: Array, out: Array) -> None:
        raise NotImplementedError


def system(f: Rate, start: list[float], scale: float = 1.0, fixed: tuple[int, ...] = ()) -> System:
    """f(y) = 0 from a start."""
    y, n = np.array(start), len(start)
    return System(Small(f, n, fixed), y, np.arange(n), np.full(n, scale), np.zeros(n, dtype=bool), 1.0)


@dataclass(frozen=True, eq=False)
class Varied:
    """A family of them, f(y, p) = 0."""

    f: Callable[[Array, float], Array]
    size: int

    def at(self, p: float) -> System:
        return system(lambda y: self.f(y, p), [0.0] * self.size)

    def residual(self, x: Array, p: float) -> Array:
        return self.f(x, p)

    def linear(self, x: Array, p: float) -> Linear:
        return self.at(p).linear(x)

    def slope(self, x: Array, p: float) -> Array:
        return (self.f(x, p + 1e-6) - self.f(x, p - 1e-6)) / 2e-6

    def moved(self, x: Array, step: Array) -> Array:
        return x + step
