"""Radau IIA collocation in time, for the references that move: any number of stages, order 2 stages - 1.

Integrates d moved(y) / dt = residual(t, y), where `moved` may be nonlinear and may leave some entries out: those of
the residual are then constraints (index 1). The method is stiffly accurate, so they hold at the end of each step.
Newton's method uses Jacobians of the middle of the step that are renewed now and then; in the eigenvectors of the
collocation matrix each stage has a linear system of its own. Source: E. Hairer and G. Wanner, *Solving Ordinary
Differential Equations II*, sections IV.5, IV.8 and VI.1.
"""

import itertools
from typing import Protocol

import numpy as np
import numpy.typing as npt
from numpy.polynomial import legendre

Array = npt.NDArray[np.float64]


class System(Protocol):
    """States y (..., size): any number of them at once."""

    def moved(self, y: Array) -> Array:
        """What the residuals are the rates of, (..., size)."""

    def residual(self, t: float, y: Array) -> Array:
        """Rates, or what is left of constraints, (..., size)."""

    def jacobians(self, t: float, y: Array) -> tuple[Array, Array]:
        """Derivatives of both at one state, (size, size)."""


def tables(stages: int) -> tuple[Array, Array]:
    """Nodes (stages,) in (0, 1], the last one 1, and the collocation matrix (stages, stages)."""
    right = legendre.legsub(np.eye(stages + 1)[stages], np.eye(stages + 1)[stages - 1])
    x = np.sort(legendre.legroots(right).real)
    x[-1] = 1.0
    values = legendre.legvander(x, stages)
    integrals = [x + 1.0] + [(values[:, k + 1] - values[:, k - 1]) / (2 * k + 1) for k in range(1, stages)]
    return 0.5 * (x + 1.0), 0.5 * np.stack(integrals, axis=1) @ np.linalg.inv(values[:, :stages])


def instants(until: float, first: float, growth: float, longest: float) -> Array:
    """Ends of the time steps, from 0: growing, never above `longest`, the last ones equal."""
    ends = [0.0]
    step = first
    while step < longest and ends[-1] + step < until:
        ends.append(ends[-1] + step)
        step *= growth
    rest = until - ends[-1]
    return np.concatenate([ends[:-1], ends[-1] + np.linspace(0.0, rest, max(1, int(np.ceil(rest / longest))) + 1)])


def integrate(system: System, state: Array, steps: Array, stages: int, goal: float) -> Array:
    """The state (size,) at steps[-1] from that at steps[0]; Newton's method stops at changes below `goal`.

    Raises ArithmeticError if Newton's method fails.
    """
    nodes, matrix = tables(stages)
    factors, vectors = np.linalg.eig(matrix)
    inverse = np.linalg.inv(vectors)
    for begin, end in itertools.pairwise(steps):
        step, start, y = end - begin, system.moved(state), np.tile(state, (stages, 1))
        for iteration in range(60):
            if iteration % 4 == 0:
                mass, slope = system.jacobians(begin + step * nodes[stages // 2], y[stages // 2])
                solvers = np.linalg.inv(mass - step * factors[:, None, None] * slope)
            rates = np.stack([system.residual(begin + step * c, now) for c, now in zip(nodes, y, strict=True)])
            left = inverse @ (system.moved(y) - start - step * matrix @ rates)
            change = (vectors @ np.einsum("sij,sj->si", solvers, left)).real
            y = y - change
            if np.abs(change).max() < goal:
                break
        else:
            raise ArithmeticError(f"Newton's method left {np.abs(change).max():.1e}; expected shorter time steps")
        state = y[-1]
    return state
