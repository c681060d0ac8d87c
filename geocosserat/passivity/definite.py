"""Proofs that matrices are definite, or that their eigenvalues have positive real parts: at points, over boxes.

All in exact numbers or Arb's balls. Over a box: matrices are brought near to the unit matrix, or near to a diagonal
one, by a congruence or similarity that is only approximately right but certainly regular, and then Gershgorin's discs
decide (S. M. Rump, Acta Numerica 19, 287 (2010)). At a point: principal minors, Hurwitz's determinants, and a vector x
with x T x < 0.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, Final, TypeAlias

import numpy as np
from flint import acb, acb_mat, arb, arb_mat, fmpq

from geocosserat.model.expressions import Expression, Number
from geocosserat.model.law import Matrix
from geocosserat.passivity.balls import ball_of, precision, rational
from geocosserat.passivity.exactly import exact_value
from geocosserat.passivity.tangent import Floats, Range, blocks, enclosure, names_in, part, parts

WORK: Final = 250_000
"""Nodes of expressions that a proof over boxes may enclose: about a second. A count, so that answers do not depend on
the machine."""

_BITS: Final = 400

Test: TypeAlias = Callable[[Mapping[str, arb]], bool]


def definite_over(matrix: Matrix, ranges: Sequence[Range], weights: Floats) -> bool:
    """Whether a symmetric matrix of expressions is proved positive definite over the whole box, block by block.

    ``weights``: how much the matrix varies along each range, (n,), which only says what to divide first.
    """
    left = WORK
    for block in sorted(blocks(matrix), key=len):
        piece = part(matrix, block)

        def test(values: Mapping[str, arb], piece: Matrix = piece) -> bool:
            return is_definite(enclosure(piece, values))

        left = _cover(test, piece, ranges, weights, left)
        if left <= 0:
            return False
    return True


def rates_over(tangent: Matrix, friction: Matrix, ranges: Sequence[Range], weights: Floats) -> bool:
    """Whether all eigenvalues of friction^-1 T are proved to have positive real parts over the whole box."""
    left = WORK
    d = range(len(tangent))
    pattern = tuple(tuple(tangent[i][j] if friction[i][j] == Number(0.0) else friction[i][j] for j in d) for i in d)
    for block in sorted(blocks(pattern), key=len):
        t, f = part(tangent, block), part(friction, block)

        def test(values: Mapping[str, arb], t: Matrix = t, f: Matrix = f) -> bool:
            moved = _moved(enclosure(t, values), enclosure(f, values))
            return moved is not None and has_positive_rates(moved)

        left = _cover(test, (*t, *f), ranges, weights, left)
        if left <= 0:
            return False
    return True


def _cover(
    test: Test, matrix: Sequence[Sequence[Expression]], ranges: Sequence[Range], weights: Floats, work: int
) -> int:
    """Divides the box until the test holds in all of it: the work that is left, at most 0 if that was not reached."""
    entries = [e for row in matrix for e in row]
    used = names_in(entries)
    moving = [(i, r) for i, r in enumerate(ranges) if r.name in used]
    each = sum(1 for _ in parts(entries)) + len(entries) ** 2
    waiting = [{r.name: (r.low, r.high) for _, r in moving}]
    while waiting:
        work -= each
        if work <= 0:
            return 0
        box = waiting.pop()
        if test({name: _interval(low, high) for name, (low, high) in box.items()}):
            continue
        if not moving:
            return 0
        shares = [(weights[i] * (box[r.name][1] - box[r.name][0]) / (r.high - r.low), r) for i, r in moving]
        _, widest = max(shares, key=lambda pair: pair[0])
        low, high = box[widest.name]
        # first at the reference, where laws have their kinks
        whole = (low, high) == (widest.low, widest.high)
        middle = widest.rest if whole and low < widest.rest < high else (low + high) / 2
        if not low < middle < high:
            return 0
        waiting += [{**box, widest.name: (low, middle)}, {**box, widest.name: (middle, high)}]
    return work


def _interval(low: float, high: float) -> arb:
    return ball_of(low).union(ball_of(high))


def is_definite(matrix: Any) -> bool:
    """Whether every symmetric matrix in a ball matrix is proved positive definite: (d, d) arb_mat."""
    middle = _floats(matrix)
    if middle is None:
        return False
    try:
        lower = np.linalg.inv(np.linalg.cholesky((middle + middle.T) / 2))
    except np.linalg.LinAlgError:
        return False
    if not np.isfinite(lower).all() or not np.diag(lower).all():
        return False
    # triangular without a zero on the diagonal: a regular congruence, whatever its rounding
    change = arb_mat(np.tril(lower).tolist())
    near_one = (change * matrix * change.transpose()).tolist()
    return all(row[i] - _sum(abs(x) for j, x in enumerate(row) if j != i) > 0 for i, row in enumerate(near_one))


def is_not_definite(matrix: Any) -> bool:
    """Whether x S x < 0 is proved for some x and every S in a ball matrix."""
    middle = _floats(matrix)
    if middle is None:
        return False
    size = np.sqrt(np.where(np.diag(middle) != 0, np.abs(np.diag(middle)), 1.0))
    _, vectors = np.linalg.eigh((middle + middle.T) / 2 / size[:, None] / size)
    x = arb_mat([[value] for value in (vectors[:, 0] / size).tolist()])
    return bool((x.transpose() * matrix * x)[0, 0] < 0)


def has_positive_rates(matrix: Any) -> bool:
    """Whether the eigenvalues of every matrix in a ball matrix are proved to have positive real parts."""
    middle = _floats(matrix)
    if middle is None:
        return False
    try:
        _, vectors = np.linalg.eig(middle)
        change = acb_mat([[acb(z.real, z.imag) for z in row] for row in vectors.astype(complex).tolist()])
        diagonal = (change.inv() * acb_mat(matrix) * change).tolist()
    except (np.linalg.LinAlgError, ZeroDivisionError):
        return False
    discs = (row[i].real - _sum(abs(z) for j, z in enumerate(row) if j != i) for i, row in enumerate(diagonal))
    return all(disc > 0 for disc in discs)


def hurwitz(coefficients: Sequence[Any]) -> list[Any]:
    """Leading determinants of Hurwitz's matrix of s^n + c[1] s^(n-1) + ... + c[n], c = coefficients.

    All roots have negative real parts if and only if all are positive (A. Hurwitz, Math. Ann. 46, 273 (1895)).
    """
    n = len(coefficients) - 1
    rows = [[coefficients[2 * j - i + 1] if 0 <= 2 * j - i + 1 <= n else 0 for j in range(n)] for i in range(n)]
    return [_determinant([row[:k] for row in rows[:k]]) for k in range(1, n + 1)]


def _determinant(rows: list[list[Any]]) -> Any:
    """By expansion, without division: for matrices of up to six rows of any numbers."""
    if len(rows) == 1:
        return rows[0][0]
    total: Any = 0
    for j, x in enumerate(rows[0]):
        if isinstance(x, int) and x == 0:
            continue
        total = total + (-1) ** j * x * _determinant([row[:j] + row[j + 1:] for row in rows[1:]])
    return total


def characteristic(rows: Sequence[Sequence[Any]]) -> list[Any]:
    """Coefficients of det(s + M), from s^n down, for a matrix of numbers or expressions (Faddeev and Leverrier)."""
    n = len(rows)
    coefficients: list[Any] = [1]
    power = [[0] * n for _ in range(n)]
    for k in range(1, n + 1):
        power = [[power[i][j] + (coefficients[-1] if i == j else 0) for j in range(n)] for i in range(n)]
        power = [[-_sum(rows[i][m] * power[m][j] for m in range(n)) for j in range(n)] for i in range(n)]
        coefficients.append(-_sum(power[i][i] for i in range(n)) / k)
    return coefficients


def definite_at(matrix: Matrix, point: Mapping[str, float]) -> bool | None:
    """Whether a symmetric matrix of expressions is positive definite at a point, proved; None if not decided."""
    with precision(_BITS):
        numbers = _numbers_at(matrix, point)
        if numbers is not None:
            minors = [_determinant([row[:k] for row in numbers[:k]]) for k in range(1, len(numbers) + 1)]
            return all(minor > 0 for minor in minors)
        balls = enclosure(matrix, {name: ball_of(value) for name, value in point.items()})
        return True if is_definite(balls) else False if is_not_definite(balls) else None


def semidefinite_at(matrix: Matrix, point: Mapping[str, float]) -> bool | None:
    """Whether it is positive semidefinite, where its entries are rational numbers there; None elsewhere."""
    numbers = _numbers_at(matrix, point)
    return None if numbers is None else all(c >= 0 for c in characteristic(numbers))


def rates_at(tangent: Matrix, friction: Matrix, point: Mapping[str, float]) -> bool | None:
    """Whether all eigenvalues of friction^-1 T have positive real parts at a point, proved; None if not decided."""
    with precision(_BITS):
        balls = {name: ball_of(value) for name, value in point.items()}
        moved = _moved(enclosure(tangent, balls), enclosure(friction, balls))
        if moved is None:
            return None
        t, f = _numbers_at(tangent, point), _numbers_at(friction, point)
        rows = _solved(f, t) if t is not None and f is not None else moved.tolist()
        minors = [] if rows is None else hurwitz(characteristic(rows))
        if minors and all(minor > 0 for minor in minors):
            return True
        # numbers decide when they are exact, balls when they are to one side of zero
        exact = t is not None and f is not None
        return False if any(minor <= 0 if exact else minor < 0 for minor in minors) else None


def _solved(f: list[list[Any]], t: list[list[Any]]) -> list[list[Any]] | None:
    """f^-1 t in rationals, by Gauss and Jordan."""
    n = len(f)
    rows = [[*f[i], *t[i]] for i in range(n)]
    for k in range(n):
        pivot = next((i for i in range(k, n) if rows[i][k] != 0), None)
        if pivot is None:
            return None
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [x / rows[k][k] for x in rows[k]]
        rows = [r if i == k else [x - r[k] * y for x, y in zip(r, rows[k], strict=True)] for i, r in enumerate(rows)]
    return [row[n:] for row in rows]


def _numbers_at(matrix: Matrix, point: Mapping[str, float]) -> list[list[Any]] | None:
    """The entries at a point as rational numbers, if that is what they are."""
    ratios = {name: rational(value) for name, value in point.items()}
    seen: dict[int, Fraction | None] = {}
    values = [[exact_value(e, ratios, seen) for e in row] for row in matrix]
    if any(value is None for row in values for value in row):
        return None
    return [[fmpq(value.numerator, value.denominator) for value in row if value is not None] for row in values]


def _moved(tangent: Any, friction: Any) -> Any:
    """friction^-1 T in balls, None if the friction is not certainly regular."""
    try:
        return friction.solve(tangent)
    except ZeroDivisionError:
        return None


def _floats(matrix: Any) -> Floats | None:
    rows = matrix.tolist()
    if not all(x.is_finite() for row in rows for x in row):
        return None
    return np.array([[float(x.mid()) for x in row] for row in rows])


def _sum(values: Any) -> Any:
    total: Any = 0
    for value in values:
        total = total + value
    return total
