"""Diagonally implicit Runge-Kutta with two stages: slow, and hard to bring down.

The formulas with weights 1/2, 1/2 and the matrix [[g, 0], [1 - 2 g, g]] are of order 2 for every g. A quadratic energy
changes in each step, however long, by exactly what its power was at the stages, less h²/2 Σ M_ij <k_i, k_j>, where
M = b A + Aᵀ b - b bᵀ = (g - 1/4) [[1, -1], [-1, 1]]:

    safe      g = 1 - 1/√2   L-stable, and M >= 0: a step may lose energy that nobody took, and never makes any
    midpoint  g = 1/4        two half steps of the midpoint rule, M = 0: the balance of energy closes in each step

An energy that is no square is kept by steps that are made again until they do (kept.py). Stages are solved to
round-off, for energies are exact only as far as they are; for any size of system and constraints by the kernel's own
elimination. Where Newton's method fails, also with damping, steps are shortened.

Source: E. Hairer and G. Wanner, "Solving Ordinary Differential Equations II" (1996), sections IV.8 and IV.12; of the
formula, L. Pareschi and G. Russo, J. Sci. Comput. 25 (2005) 129; of damping, P. Deuflhard, "Newton Methods for
Nonlinear Problems" (2004), section 3.3.
"""

from contextlib import suppress
from functools import partial

import numpy as np

from geocosserat.kernel.contract import Array, Balance, Kernel
from geocosserat.solver.consistent import consistent
from geocosserat.solver.kept import kept
from geocosserat.solver.reduced import Integrator
from geocosserat.solver.settings import LEAST_RTOL, SINGULAR, STANDSTILL, Hope, stands_still
from geocosserat.solver.trajectory import Frame, Progress, Trajectory

GAMMAS = {"safe": 1.0 - 0.5**0.5, "midpoint": 0.25}

SOON, FAR = 20_000, 500_000
"""After so many steps, a run whose end is so many more away at their pace will never get there."""

ROUND_OFF, SETTLED = 4 * float(np.finfo(float).eps), 1e-12
"""Of the natural sizes: changes of Newton's method below the first are none; those below the second are as small as
round-off lets them, once they do not fall any further."""

QUICK, ROUNDS, LEAST = 0.5, 40, 1e-3
"""Share of a change that the next one may be, if a matrix is to serve on; rounds at most; the least part of a damped
change."""

FIRST = 0.1
"""Share of its natural size by which the first step may change an entry, times the root of the tolerance."""

SHORTEST = 1e-30
"""Of the time span: where the time is still zero, steps that short are given up."""

CONSTANT = 0.05
"""About what the error of a step is, in units of h cubed times the third derivative (0.02 to 0.04)."""

GROWTH, SHRINK, MARGIN, KEPT, DIVERGED = 2.0, 0.2, 0.85, 1.3, 0.25
"""Bounds of what a step is to the last one; of its error; growth that is not worth new factors; where there is no
solution."""


class Diverged(Exception):
    """A stage was not found."""


class Stepper:
    """One integration: where it is, the step to try, and the factors it has. balance: that of an energy which is no
    square, if there is one to be kept."""

    def __init__(
        self,
        kernel: Kernel,
        gamma: float,
        t: float,
        y: Array,
        rtol: float,
        atol: Array,
        balance: Balance | None = None,
    ) -> None:
        self.kernel, self.gamma, self.rtol, self.atol, self.balance = kernel, gamma, rtol, atol, balance
        self.moves = kernel.algebraic == 0.0
        self.constrained = not self.moves.all()
        self.inner = kernel.size - kernel.quadratures
        self.t, self.y = t, y.copy()
        self.unit = np.maximum(atol / rtol, np.finfo(float).tiny)
        self.rates = self.jacobians = self.tries = 0
        self.bend = np.zeros_like(y)  # h² times about the second derivative in the last step
        self.past: list[tuple[float, Array]] = []  # instants and states before this one, the latest first
        self.linear_at, self.factored = np.nan, np.nan
        self.h = FIRST * rtol**0.5 / max(self._size(self._rate(t, y) * self.moves), np.finfo(float).tiny)

    def _size(self, x: Array) -> float:
        """The largest entry in its natural size, of those that others depend on: quadratures follow from these."""
        return float(np.max((np.abs(x) / np.maximum(self.unit, np.abs(self.y)))[: self.inner]))

    def _rate(self, t: float, y: Array) -> Array:
        self.rates += 1
        out = np.empty_like(y)
        self.kernel.rate(t, y, out)
        return out

    def linearise(self, t: float, y: Array) -> None:
        self.jacobians += 1
        self.kernel.prepare(t, y)
        self.linear_at, self.factored = t, np.nan

    def _change(self, t: float, base: Array, share: float, Y: Array) -> Array:
        """Newton's change of a stage Y = base + share f(t, Y), by the Jacobian there is."""
        if self.factored != share:
            self.kernel.factor(share)
            self.factored = share
        f, change = self._rate(t, Y), np.empty_like(Y)
        self.kernel.solve(np.where(self.moves, base + share * f - Y, -f), change)
        return change

    def _simplified(self, t: float, base: Array, share: float, Y: Array) -> Array:
        """The stage, from a guess, by one Jacobian."""
        last = np.inf
        for _ in range(ROUNDS):
            change = self._change(t, base, share, Y)
            now = self._size(change)
            if not now <= QUICK * last:  # NaN too
                if last <= SETTLED:
                    return Y
                break
            Y = Y + change
            if now <= ROUND_OFF:
                return Y
            last = now
        raise Diverged

    def _renewed(self, t: float, base: Array, share: float, Y: Array) -> Array:
        """The same by the Jacobian at the start of the step, unless that was it."""
        if self.linear_at == self.t:
            raise Diverged
        self.linearise(self.t, self.y)
        return self._simplified(t, base, share, Y)

    def _damped(self, t: float, base: Array, share: float, Y: Array) -> Array:
        """The same by a new Jacobian wherever the last one leads nowhere, and then as much of its change as makes the
        next one smaller."""
        for _ in range(ROUNDS):
            self.linearise(t, Y)
            with suppress(Diverged):
                return self._simplified(t, base, share, Y)
            change = self._change(t, base, share, Y)
            now, part = self._size(change), 1.0
            while not self._size(self._change(t, base, share, Y + part * change)) <= (1.0 - 0.25 * part) * now:
                part *= 0.5
                if part < LEAST:
                    raise Diverged
            Y = Y + part * change
        raise Diverged

    def _stage(self, t: float, base: Array, share: float, guess: Array) -> Array:
        """The stage, by whatever way leads there.

        Raises Diverged.
        """
        for way in (self._simplified, self._renewed, self._damped):
            try:
                found = way(t, base, share, guess)
            except (Diverged, np.linalg.LinAlgError, ArithmeticError):
                continue
            found[self.inner :] = (base + share * self._rate(t, found))[self.inner :]
            if np.isfinite(found).all():
                return found
        raise Diverged

    def end(self, h: float) -> Array:
        """The state after a step.

        Raises Diverged.
        """
        if self.balance is None:
            end = self._made(h)
        else:
            found = kept(self.balance, self.t, self.y, partial(self._made, h), loses=self.gamma > 0.25)
            if found is None:
                raise Diverged
            end = found
        if self.constrained:
            try:
                end = consistent(self.kernel, self.t + h, end, blocks=True)
            except np.linalg.LinAlgError:
                raise Diverged from None
            self.linear_at = self.factored = np.nan  # the kernel forgot them
        return end

    def _made(self, h: float) -> Array:
        """The same, but for what constraints fix.

        Raises Diverged.
        """
        g, y, moves = self.gamma, self.y, self.moves
        ahead = np.zeros_like(y)
        if self.past:
            then, before = self.past[0]
            ahead = (y - before) / (self.t - then) * moves
        share, rest = g * h, (1.0 - 2.0 * g) * h
        first = self._stage(self.t + share, y, share, y + share * ahead)
        slope = (first - y) / share * moves  # not the rate there, in which stiffness magnifies round-off
        base = y + rest * slope
        second = self._stage(self.t + h - share, base, share, first + rest * slope)
        other = (second - base) / share * moves
        end: Array = y + 0.5 * h * (slope + other)
        self.bend = h * (other - slope)
        end[~moves] = second[~moves]
        return end

    def _error(self, t: float, end: Array) -> float:
        """The error of a step in units of what it may be: by the third derivative, from divided differences of the
        states, or by the second where less is known."""
        points = [(t, end), (self.t, self.y), *self.past]
        times, differences = [then for then, _ in points], [state for _, state in points]
        order = len(points) - 1
        for k in range(1, order + 1):
            differences = [
                (differences[i] - differences[i + 1]) / (times[i] - times[i + k]) for i in range(order + 1 - k)
            ]
        missed = self.bend if order < 3 else 6.0 * CONSTANT * (t - self.t) ** 3 * differences[0]
        share = (missed / (self.atol + self.rtol * np.maximum(np.abs(self.y), np.abs(end))))[self.moves]
        return float(np.sqrt(np.mean(share**2)))

    def advance(self, end: float) -> bool:
        """Tries one step, not over `end`; whether it was made."""
        left = end - self.t
        h = left if self.h >= 0.999 * left else min(self.h, 0.5 * left) if self.h > 0.5 * left else self.h
        self.tries += 1
        if np.isnan(self.linear_at):
            self.linearise(self.t, self.y)
        t = end if h == left else self.t + h
        try:
            state = self.end(h)
            error = self._error(t, state)
        except Diverged:
            error = np.nan
        if not np.isfinite(error):
            self.h = DIVERGED * h
            return False
        change = min(GROWTH, max(SHRINK, MARGIN * max(error, 1e-10) ** (-1 / 3)))
        if error > 1.0:
            self.h = min(change, MARGIN) * h
            return False
        if change > KEPT or change < 1.0:
            self.h = change * h if h >= 0.5 * self.h else max(self.h, change * h)
        self.past = [(self.t, self.y), *self.past][:2]
        self.t, self.y = t, state
        return True


def _integrate(
    name: str,
    kernel: Kernel,
    start: Array,
    times: Array,
    rtol: float,
    atol: Array,
    progress: Progress,
    frame: Frame,
    balance: Balance | None = None,
) -> Trajectory:
    """Integrates from times[0] through all of `times`; see `integrate`."""
    first, last = float(times[0]), float(times[-1])
    states = np.empty((len(times), kernel.size))
    states[0] = start
    now = Stepper(kernel, GAMMAS[name], first, start, max(rtol, LEAST_RTOL), atol, balance)
    done, steps, reason, hope, paused = 1, 0, "", Hope(SOON, FAR), False
    while done < len(times) and not reason and not paused:
        before, target = now.t, float(times[done])
        made = now.advance(target)
        fraction = (now.t - first) / (last - first)
        if made:
            steps += 1
            progress(fraction, steps)
        if now.t == target:
            states[done] = now.y
            paused = frame(done, states[done], now.tries)
            done += 1
        elif (made and stands_still(before, now.t)) or now.h <= max(STANDSTILL * abs(now.t), SHORTEST * (last - first)):
            reason = f"{name} stopped at t = {now.t:.6g}: no step is short enough; {SINGULAR}"
        elif hope.lost(now.tries, fraction):
            reason = f"{name} stopped at t = {now.t:.6g}: {now.tries} steps did not reach the end"
    reached = done == len(times)
    return Trajectory(times[:done].copy(), states[:done], now.rates, now.jacobians, now.tries, reached, reason)


def diagonal(name: str, balance: Balance | None = None) -> Integrator:
    """The method of that name. balance: see Stepper."""
    return partial(_integrate, name, balance=balance)
