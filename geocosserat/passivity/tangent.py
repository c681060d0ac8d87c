"""The tangent of a law, T = d stress / d turn, over the strains that the law is meant for, in numbers and in balls."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any, Final, Literal, TypeAlias

import numpy as np
from flint import arb, arb_mat
from numpy.typing import NDArray
from scipy.stats import qmc

from geocosserat.algebra.groups import Group
from geocosserat.model.evaluation import children, walk
from geocosserat.model.expressions import Call, Expression, Number, Symbol, derivative, substitute, symbols
from geocosserat.model.law import Law, Matrix, Vector, at_rest
from geocosserat.passivity.balls import ball
from geocosserat.passivity.compiled import Compiled

Floats: TypeAlias = NDArray[np.float64]
Grade: TypeAlias = Literal["proved", "probable", "sampled"]

STRETCH, BEND, PLACE = 0.5, 1.0, (0.0, 1.0)
"""How far strains go from the reference where a law does not say, and the values of u and t then."""

POINTS: Final = 1024
"""Quasi-random points of a sample; the corners of the box and the ends of its axes are added."""

_ZERO: Final = Number(0.0)


@dataclass(frozen=True)
class Range:
    """Values low <= name <= high that a variable takes, through ``rest``; ``assumed``: not said by the law."""

    name: str
    low: float
    high: float
    rest: float
    assumed: bool


@dataclass(frozen=True)
class Tangent:
    """T and the friction of a law, with its parameters put in.

    ``matrix``: d x d, T[i][j] = d stress_i / d turn_j at rates zero (force, force x length, ...); ``friction``: d x d.
    ``ranges``: of the d strains, then of those of u and t that occur. ``open``: parameters without value that occur.
    """

    group: Group
    stress: Vector
    matrix: Matrix
    friction: Matrix
    ranges: tuple[Range, ...]
    open: tuple[str, ...]
    assumptions: tuple[str, ...]

    @property
    def rest(self) -> Floats:
        """The reference, with u and t: (n,)."""
        return np.array([r.rest for r in self.ranges])

    @property
    def low(self) -> Floats:
        """The least values: (n,)."""
        return np.array([r.low for r in self.ranges])

    @property
    def high(self) -> Floats:
        """The greatest values: (n,)."""
        return np.array([r.high for r in self.ranges])

    @cached_property
    def variables(self) -> tuple[str, ...]:
        """Names of what T and the friction depend on, in the order of the ranges."""
        used = names_in(e for rows in (self.matrix, self.friction) for row in rows for e in row)
        return tuple(r.name for r in self.ranges if r.name in used)

    @cached_property
    def _compiled(self) -> dict[int, tuple[Matrix, Compiled]]:
        return {}  # by identity, as long trees are slow to compare

    def values(self, matrix: Matrix, points: Floats) -> Floats:
        """A matrix at points (N, n): (N, d, d); not a number where it has no value."""
        env = {r.name: points[:, i] for i, r in enumerate(self.ranges)}
        if id(matrix) not in self._compiled:
            self._compiled[id(matrix)] = (matrix, Compiled([e for row in matrix for e in row]))
        out = self._compiled[id(matrix)][1](env, len(points)).reshape(-1, len(matrix), len(matrix))
        out[~np.isfinite(out)] = np.nan
        return out

    def sample(self, points: int = POINTS) -> Floats:
        """The reference, the corners, the ends of the axes, and points of Sobol's sequence: (N, n)."""
        used, rest = self.variables, self.rest
        ends = [(r.low, r.high) if r.name in used else (r.rest,) for r in self.ranges]
        axes = [np.where(np.arange(len(rest)) == i, end, rest) for i, pair in enumerate(ends) for end in pair]
        fill = qmc.Sobol(len(rest), rng=1).random(points)
        moving = np.array([r.name in used for r in self.ranges])
        inside = np.where(moving, self.low + fill * (self.high - self.low), rest)
        return np.concatenate([rest[None], np.array(list(product(*ends))), np.array(axes), inside])


def tangent_of(law: Law) -> Tangent | None:
    """The tangent of a law, None if it has no stress."""
    if law.stress is None:
        return None
    group, assumptions = law.group, []
    stress = with_values(law, law.stress)
    if law.viscous:
        assumptions.append("tangent at rates zero: the viscous part of the stress is left out")
    stress = tuple(at_rest(e, group) for e in stress)
    matrix = tuple(tuple(derivative(e, x) for x in group.strain) for e in stress)
    if law.energy is not None:
        # second derivatives are the same in either order, however they are written
        d = range(len(stress))
        matrix = tuple(tuple(matrix[min(i, j)][max(i, j)] for j in d) for i in d)
    if law.friction is None:
        friction: Matrix = tuple(tuple(Number(float(i == j)) for j in range(len(stress))) for i in range(len(stress)))
        assumptions.append("the law has no friction: that of the twist is taken to be the identity")
    else:
        friction = tuple(with_values(law, row) for row in law.friction)
    used = names_in(e for rows in (matrix, friction) for row in rows for e in row)
    ranges = [_range(law, i, name) for i, name in enumerate(group.strain)]
    ranges += [Range(name, *PLACE, PLACE[0], True) for name in ("u", "t") if name in used]
    assumptions += [f"{r.low:.6g} <= {r.name} <= {r.high:.6g}" for r in ranges if r.assumed and r.name in used]
    if _jumps(stress, group):
        assumptions.append("the stress has steps in the strain: the tangent is that of the pieces between them")
    return Tangent(
        group=group,
        stress=stress,
        matrix=matrix,
        friction=friction,
        ranges=tuple(ranges),
        open=tuple(name for name in law.open if name in used),
        assumptions=tuple(assumptions),
    )


def with_values(law: Law, expressions: Sequence[Expression]) -> Vector:
    """Expressions of a law with the numbers of those parameters that have one."""
    numbers = {name: Number(float(value)) for name, value in law.parameters.items()}
    return tuple(substitute(e, numbers) for e in expressions)


def names_in(expressions: Iterable[Expression]) -> frozenset[str]:
    """All names that occur."""
    return frozenset(node.name for node in parts(expressions) if isinstance(node, Symbol))


def parts(expressions: Iterable[Expression]) -> Iterator[Expression]:
    """All parts of expressions, each once, also if many hold it, as derivatives do."""
    waiting, seen = list(expressions), set[int]()
    while waiting:
        node = waiting.pop()
        if id(node) not in seen:
            seen.add(id(node))
            yield node
            waiting.extend(children(node))


def _range(law: Law, i: int, name: str) -> Range:
    rest = law.reference[i]
    if name in law.domain:
        return Range(name, *law.domain[name], rest, False)
    reach = STRETCH if i < law.group.space else BEND
    return Range(name, rest - reach, rest + reach, rest, True)


def _jumps(stress: Vector, group: Group) -> bool:
    steps = (node for e in stress for node in walk(e) if isinstance(node, Call) and node.function == "heaviside")
    return any(symbols(step) & set(group.strain) for step in steps)


def symmetric(matrix: Matrix) -> Matrix:
    """The symmetric part, what is the same in both halves written once."""

    def entry(a: Expression, b: Expression) -> Expression:
        if a == b:
            return a
        return _ZERO if a == -b else (a + b) / 2

    d = range(len(matrix))
    return tuple(tuple(entry(matrix[min(i, j)][max(i, j)], matrix[max(i, j)][min(i, j)]) for j in d) for i in d)


def blocks(matrix: Matrix) -> tuple[tuple[int, ...], ...]:
    """Indices that entries not literally zero couple, directly or by others."""
    left, found = list(range(len(matrix))), []
    while left:
        block, new = {left[0]}, {left[0]}
        while new:
            new = {j for i in new for j in left if matrix[i][j] != _ZERO or matrix[j][i] != _ZERO} - block
            block |= new
        left = [i for i in left if i not in block]
        found.append(tuple(sorted(block)))
    return tuple(found)


def part(matrix: Matrix, block: Sequence[int]) -> Matrix:
    """The rows and columns of a block."""
    return tuple(tuple(matrix[i][j] for j in block) for i in block)


def enclosure(matrix: Matrix, values: Mapping[str, arb]) -> Any:
    """The matrix over balls of its variables, an arb_mat; those literally equal are worked out once."""
    d = len(matrix)
    known: dict[int, arb] = {}

    def entry(e: Expression) -> arb:
        if id(e) not in known:
            known[id(e)] = ball(e, values)
        return known[id(e)]

    return arb_mat(d, d, [entry(matrix[i][j]) for i in range(d) for j in range(d)])


def least_definite(matrices: Floats, scale: Floats) -> Floats:
    """The least eigenvalue of the symmetric part, rows and columns scaled: (N, d, d), (d,) -> (N,)."""
    halves = (matrices + np.swapaxes(matrices, 1, 2)) / 2
    scaled = np.asarray(halves * scale[:, None] * scale, dtype=np.float64)
    return _finite(scaled, lambda m: np.asarray(np.linalg.eigvalsh(m)[:, 0], dtype=np.float64))


def least_rate(tangents: Floats, frictions: Floats) -> tuple[Floats, Floats]:
    """The least real part of the eigenvalues of friction^-1 T, and the largest imaginary part over the largest
    eigenvalue: (N, d, d) twice -> (N,), (N,)."""
    turned = np.full(len(tangents), np.nan)

    def least(m: Floats) -> Floats:
        values = np.linalg.eigvals(m)
        size = np.abs(values).max(axis=1)
        turned[good] = np.abs(values.imag).max(axis=1) / np.where(size > 0, size, 1.0)
        return np.asarray(values.real.min(axis=1))

    with np.errstate(all="ignore"):
        regular = np.abs(np.linalg.det(np.where(np.isfinite(frictions), frictions, 0.0))) > 0
    safe = np.where(regular[:, None, None], frictions, np.eye(frictions.shape[1]))
    moved: Floats = np.asarray(np.linalg.solve(safe, tangents), dtype=np.float64)
    moved[~regular] = np.nan
    good = np.isfinite(moved).all(axis=(1, 2))
    return _finite(moved, least), turned


def _finite(matrices: Floats, f: Callable[[Floats], Floats]) -> Floats:
    out = np.full(len(matrices), np.nan)
    good = np.isfinite(matrices).all(axis=(1, 2))
    if good.any():
        out[good] = f(matrices[good])
    return out
