"""A straight rod under load, moved a little aside: the linear problem all columns, filaments and shafts here share.

The rod lies along x, with tension T(u), stretch h1(u) and twisting moment M1(u), and has equal properties in all
directions across it. It is moved aside by y + i z = xi, and e_1 tilted by the complex angle theta, both as
exp(growth t); a vector across is a complex number, and e_1 x turns it by i. With the world's force Q and moment i M
across it, phi' = phi E and the law F = k (h - h0), M = K (Pi - Pi0) give

    xi'    = h1 theta + (Q - T theta) / k2
    theta' = (M + i M1 theta) / bend

(Q - T theta is the shear force in the section.) The balances n' + f = 0, m' + r' x n + c = 0 with drag across and
about the axes, a follower force density f1 along e_1 and dead ones that only change T, give

    Q' = friction2 growth xi - f1 theta
    M' = (T eta + friction5 growth) theta - i M1' theta - eta Q,      eta = h1 - T / k2,

M1' theta being the couple along e_1 that changes M1, seen from aside. In the plane M1 = 0 and all is real. The factor
eta is Haringx's: the moment of the shear force acts on h1, and shear lets the rod yield towards a compressive force.

Ends: clamped xi = theta = 0; pinned xi = M = 0; free under a dead force Q = M = 0; under a follower force Q = T theta.
A dead twisting moment leaves M = 0; one that turns with the end, M = -i M1 theta.

Source: S. S. Antman, *Nonlinear Problems of Elasticity*, chapters 4 and 8 (balances); J. A. Haringx, Philips Res. Rep.
3 (1948) 401 (shear under compression).

Dimensions: k2, T, Q force; bend, M1, M force x length (bend: x length again); friction2 force x time / length^2;
friction5 force x time.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from tests.references.stability.linear import Problem

Polynomial = Sequence[Any]  # of u, lowest power first
Start = Literal["clamped", "pinned"]
End = Literal["clamped", "pinned", "dead", "follower", "follower-torque"]
FREE: dict[Start, tuple[int, ...]] = {"clamped": (2, 3), "pinned": (1, 2)}


@dataclass(frozen=True)
class Rod:
    """Length, stiffnesses and frictions, across and of tilting; k1, k2 may be `math.inf`. In the plane bend is k3."""

    length: float = 1.0
    k1: float = math.inf
    k2: float = math.inf
    bend: float = 1.0
    friction2: float = 1.0
    friction5: float = 0.0


@dataclass(frozen=True)
class State:
    """T, h1 and M1 as polynomials of u, and the follower density f1. See `stretched` for h1."""

    tension: Polynomial = (0.0,)
    stretch: Polynomial = (1.0,)
    moment: Polynomial = (0.0,)
    follower: Any = 0.0


def added(*terms: Polynomial) -> list[Any]:
    """Sum of polynomials."""
    size = max(map(len, terms))
    return [sum(t[k] for t in terms if k < len(t)) for k in range(size)]


def _times(a: Polynomial, b: Polynomial) -> list[Any]:
    result: list[Any] = [0.0] * (len(a) + len(b) - 1)
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            result[i + j] += x * y
    return result


def stretched(rod: Rod, tension: Polynomial) -> list[Any]:
    """h1 of a rod whose h1 is 1 at rest."""
    return added([1.0], [x / np.longdouble(rod.k1) for x in tension])


def problem(rod: Rod, state: State, start: Start, end: End) -> Problem:
    """The equations above for Y = (xi, theta, Q, M)."""
    shear = np.longdouble(1) / rod.k2
    eta = added(state.stretch, [-shear * x for x in state.tension])
    turned = [-1j * k * x for k, x in enumerate(state.moment)][1:] or [0.0]
    entries = {
        (0, 1): eta,
        (0, 2): [shear],
        (1, 1): [1j * x / np.longdouble(rod.bend) for x in state.moment] if any(state.moment) else [0.0],
        (1, 3): [np.longdouble(1) / rod.bend],
        (2, 1): [-state.follower],
        (3, 1): added(_times(state.tension, eta), turned if any(state.moment) else [0.0]),
        (3, 2): [-x for x in eta],
    }
    coefficients = [np.zeros((4, 4), dtype=object) for _ in range(max(map(len, entries.values())))]
    for at, polynomial in entries.items():
        for k, x in enumerate(polynomial):
            coefficients[k][at] = x
    growing = np.zeros((4, 4), dtype=object)
    growing[2, 0], growing[3, 1] = rod.friction2, rod.friction5
    rows = np.zeros((2, 4), dtype=object)
    tip = sum(x * rod.length**k for k, x in enumerate(state.tension))
    twist = sum(x * rod.length**k for k, x in enumerate(state.moment))
    if end == "clamped":
        rows[0, 0] = rows[1, 1] = 1.0
    elif end == "pinned":
        rows[0, 0] = rows[1, 3] = 1.0
    else:
        rows[0, 2] = rows[1, 3] = 1.0
        if end == "follower":
            rows[0, 1] = -tip
        if end == "follower-torque":
            rows[1, 1] = 1j * twist
    return Problem(rod.length, tuple(coefficients), growing, FREE[start], rows)
