"""How a rod is brought to rest: by Newton's method, or by letting it relax in ever longer steps."""

from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from geocosserat.kernel.contract import Array
from geocosserat.statics.linear import Linear
from geocosserat.statics.sparse import Sparse
from geocosserat.statics.system import System

REACH = 1.0
"""Longest step in natural sizes: strains of 1, bends by a radian over the length."""

SMALL, ROUND_OFF = 1e-8, 1e-14
"""Steps below the first are taken as they come; below the second there is nothing left to do."""

SHORTEST = 1e-4

LEFT = 1e-3
"""Speed in natural sizes, relative to the rate at which a rod relaxes, that a rest may have in directions in which
nothing resists: what a scheme leaves of balances that are exact in theory."""

SLOWEST = 1e-2
"""Rate of the longest steps of relaxation, relative to that at which the rod relaxes: a rod that nothing keeps from
turning as a whole drifts by as much of its imbalance as one over it."""


class NotAtRest(Exception):
    """No state of rest was found from there; the text says why."""


@dataclass(frozen=True, eq=False)
class Rest:
    """A state of rest: its coordinates, the equations linearised there, the step that one more round would take (in
    natural sizes), and how many rounds there were."""

    x: Array
    linear: Linear | Sparse
    left: float
    rounds: int


def size(step: Array) -> float:
    """The largest entry."""
    return float(np.abs(step).max(initial=0.0))


def newton(system: System, x: Array, most: int = 50) -> Rest:
    """The state of rest that Newton's method leads to from x.

    A step is cut until the next one, by the same matrix, would be shorter (Deuflhard, "Newton Methods for Nonlinear
    Problems", section 3.3: a test that does not depend on how the equations are scaled).

    Raises NotAtRest if it leads nowhere.
    """
    last = np.inf
    for rounds in range(1, most + 1):
        linear = system.linear(x)
        try:
            residual = system.residual(x)
            step = linear.step(residual)
        except np.linalg.LinAlgError as error:
            raise NotAtRest(str(error)) from error
        now = size(step)
        if now < ROUND_OFF or (now < SMALL and now > 0.1 * last):
            if size(linear.unmet(residual, step)) > LEFT * system.rate:
                raise NotAtRest("what is left of the forces is in directions in which nothing gives way")
            return Rest(x, linear, now, rounds)
        x = system.moved(x, step) if now < SMALL else _cut(system, x, linear, step)
        last = now
    raise NotAtRest(f"Newton's method still takes steps of {last:.1g} after {most} rounds")


def _cut(system: System, x: Array, linear: Linear | Sparse, step: Array) -> Array:
    """x after as much of the step as brings it nearer to rest."""
    length = size(step)
    part = min(1.0, REACH / length)
    while part > SHORTEST:
        trial = system.moved(x, part * step)
        try:
            next_length = size(linear.step(system.residual(trial)))
        except np.linalg.LinAlgError:
            next_length = np.inf
        if next_length <= (1 - part / 4) * length:
            return trial
        part /= 2
    raise NotAtRest("no step of Newton's method brings the rod nearer to rest")


def relax(system: System, x: Array, most: int = 150) -> Rest:
    """The state of rest that the rod settles to from x: implicit Euler steps, ever longer ones, then Newton's method.

    Raises NotAtRest if it does not settle.
    """
    now = max(size(system.residual(x)) / 0.1, system.rate)
    for _ in range(most):
        linear, f = system.linear(x), system.residual(x)
        try:
            step = linear.step(f, now)
            while size(step) > 0.3:
                now *= 4.0
                step = linear.step(f, now)
        except np.linalg.LinAlgError as error:
            raise NotAtRest(str(error)) from error
        x = system.moved(x, step)
        if size(step) < 1e-3 and now <= SLOWEST * system.rate:
            with suppress(NotAtRest):
                return newton(system, x)
        now = max(0.4 * now, SLOWEST * system.rate)
    raise NotAtRest(f"the rod does not settle in {most} steps")
