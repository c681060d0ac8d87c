"""Other states of rest than the one that is known."""

from collections.abc import Callable, Iterator
from contextlib import suppress

import numpy as np

from geocosserat.kernel.contract import Array
from geocosserat.statics.linear import Linear
from geocosserat.statics.newton import REACH, SMALL, NotAtRest, Rest, newton, relax, size
from geocosserat.statics.pencil import Complex
from geocosserat.statics.sparse import Sparse
from geocosserat.statics.system import System

MODES, PUSHES = 3, (0.5, 2.0)
"""Motions along which a known state is pushed, those that grow fastest or decay most slowly, and how far: strains, and
bends in radians over the length."""

NEAR = 1e-6
"""Distance in natural sizes within which a known state repels no more."""

Spectrum = Callable[[Linear | Sparse, Array], tuple[Complex, Complex]]
Same = Callable[[Array, Array], bool]


def others(
    system: System, first: Rest, spectrum: Spectrum, same: Same, most: int = 12
) -> Iterator[Rest]:
    """States of rest besides the first one, as they are found, `most` at most. same: whether two states are one.

    Each state that is known is pushed along its least stable motions. From there the rod relaxes to a stable state, and
    Newton's method, deflated by what is known (Farrell, Birkisson and Funke, "Deflation techniques for finding distinct
    solutions of nonlinear partial differential equations", 2015), goes to a state that may be unstable.
    """
    known, waiting = [first], [first]
    while waiting:
        rest = waiting.pop(0)
        for seed, settles in _pushed(system, rest, *spectrum(rest.linear, rest.x)):
            for found in _reached(system, seed, settles, known):
                if any(same(found.x, other.x) for other in known):
                    continue
                if len(known) > most:
                    return
                known.append(found)
                waiting.append(found)
                yield found


def _pushed(system: System, rest: Rest, growth: Complex, motions: Complex) -> Iterator[tuple[Array, bool]]:
    """The state pushed a little or far, and whether it may settle to another one from there."""
    for push in PUSHES:
        for i in range(min(MODES, len(growth))):
            for sign in (1.0, -1.0):
                seed = system.moved(rest.x, sign * push * motions[:, i].real)
                yield seed, growth[i].real > 0 or push == PUSHES[-1]


def _reached(system: System, seed: Array, settles: bool, known: list[Rest]) -> Iterator[Rest]:
    """States that are reached from there."""
    if settles:
        with suppress(NotAtRest):
            yield relax(system, seed)
    with suppress(NotAtRest):
        yield deflated(system, seed, [rest.x for rest in known])


def deflated(system: System, x: Array, known: list[Array], most: int = 30) -> Rest:
    """The state that Newton's method leads to when those that are known repel it."""
    for _ in range(most):
        linear = system.linear(x)
        try:
            step = linear.step(system.residual(x))
        except np.linalg.LinAlgError as error:
            raise NotAtRest(str(error)) from error
        # how much stronger the repulsion gets along the step, relative to itself
        gaps = [x - k for k in known]
        squares = [max(float(g @ g), NEAR**2) for g in gaps]
        stronger = sum(-2 * float(g @ step) / (s * (1 + s)) for g, s in zip(gaps, squares, strict=True))
        step = step / (1 - stronger) if abs(1 - stronger) > 1e-12 else step
        now = size(step)
        x = system.moved(x, step * (REACH / max(now, REACH)))
        if now < SMALL:
            return newton(system, x)
    raise NotAtRest(f"no other state was found in {most} steps")
