"""Steps that keep the balance of an energy which is no square, to round-off, however long they are.

The rates of a kernel and its books agree for any stress: stored energy would change by what the stress does. What a
method books in a step is what the stress did at its stages, what is stored the difference of an energy; for a square
they differ by what the method says, else by a little more, of third order in the step, of any sign. So a step is made
again with a stress that is corrected by

    c |S1 - S0| sign(E1 - E0)

with S and E the stress and the strain at both ends of the first try, the same at all stages, and the share c such that
what is stored is what was booked. It resists the motion, if c > 0, with a power that is no stored energy and no loss:
that takes what had been made of nothing, or gives what had been lost. c is of first order in the step, the correction
of second: the order of the method, also 2, remains. For one stage this is a discrete gradient, as that of Gonzalez.

Source: O. Gonzalez, J. Nonlinear Sci. 6 (1996) 449; E. Hairer, C. Lubich and G. Wanner, "Geometric Numerical
Integration" (2006), sections IV.4 and V.5.
"""

from collections.abc import Callable

import numpy as np

from geocosserat.kernel.contract import Array, Balance

MOST, TRIES = 1.0, 12
"""A stress is not corrected by more than what it changes by; nor tried more often."""

NOISE = 1024 * float(np.finfo(float).eps)
"""What rounding leaves of a balance, relative to the work of stresses on whole strains."""


def kept(balance: Balance, t: float, before: Array, step: Callable[[], Array], loses: bool) -> Array | None:
    """The end (size,) of the step from `before` that keeps the balance; None if there is none.

    step: makes it, with the correction that there is. loses: whether a step may lose energy, though never make any.
    """
    was, rounded = balance.stored(t, before)

    def made(end: Array) -> tuple[float, bool]:
        """Energy made of nothing in a step, and whether that may be."""
        stored, rounding = balance.stored(t, end)
        dissipated, work = end[-2:] - before[-2:]
        found = stored - was + dissipated - work
        noise = NOISE * float(rounded + rounding + np.abs(end[-2:]).sum() + np.abs(before[-2:]).sum())
        return found, found <= noise and (loses or found >= -noise)

    end = step()
    found, keeps = made(end)
    if keeps:
        return end
    last, share = (0.0, found), found / max(balance.aim(t, before, end), np.finfo(float).tiny)
    try:
        for _ in range(TRIES):
            if not abs(share) <= MOST:  # NaN too
                return None
            balance.correct(share)
            end = step()
            found, keeps = made(end)
            if keeps:
                return end
            if found == last[1]:
                return None
            last, share = (share, found), share - found * (share - last[0]) / (found - last[1])
    finally:
        balance.correct(0.0)
    return None
