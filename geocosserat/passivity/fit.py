"""Rational solutions of linear equations whose numbers are known to many digits."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, Final

import numpy as np
from flint import arb, arb_mat, fmpq

BITS: Final = 320
"""The precision that the numbers are to have, and at which they are to be solved."""

_LONGEST: Final = 140  # bits of a solution's numerator and denominator
_TINY: Final = 1e-8
_SEEN: Final = 1e-7


def rational_solution(rows: Sequence[Sequence[arb]], right: Sequence[arb]) -> list[Fraction] | None:
    """Rational c with rows . c = right, (m, n) and (m,); columns that the earlier ones make up have none.

    None if there is none, or it is not found at this precision.
    """
    matrix = np.array([[float(x.mid()) for x in row] for row in rows])
    target = np.array([float(x.mid()) for x in right])
    scale = np.abs(matrix).max(axis=0)
    kept = _independent(matrix / np.where(scale > 0, scale, 1.0))
    solution, *_ = np.linalg.lstsq(matrix[:, kept] / scale[kept], target, rcond=None)
    off = np.abs(matrix[:, kept] / scale[kept] @ solution - target).max()
    if not off <= 1e-6 * max(np.abs(target).max(), 1e-300):
        return None
    # those that floats see first; all, for what is too small to be seen
    seen = [k for k, c in zip(kept, solution, strict=True) if abs(c) > _SEEN * np.abs(solution).max()]
    for columns in ([seen, kept] if len(seen) < len(kept) else [kept]):
        exact = _exactly(rows, right, columns)
        if exact is not None:
            out = [Fraction(0)] * matrix.shape[1]
            for k, number in zip(columns, exact, strict=True):
                out[k] = number
            return out
    return None


def _exactly(
    rows: Sequence[Sequence[arb]], right: Sequence[arb], columns: Sequence[int]
) -> list[Fraction] | None:
    """Rational coefficients of these columns alone, by least squares; None if they do not fit."""
    design, target = arb_mat([[row[k] for k in columns] for row in rows]), arb_mat([[x] for x in right])
    turned = design.transpose()
    try:
        found = (turned * design).solve(turned * target)
    except ZeroDivisionError:
        return None
    off = (design * found - target).tolist()
    if not all(x.contains(0) for (x,) in off):
        return None
    numbers = [_rational(x) for (x,) in found.tolist()]
    return [n for n in numbers if n is not None] if None not in numbers else None


def _independent(matrix: Any) -> list[int]:
    """Columns that are no sums of the columns before them."""
    kept: list[int] = []
    base = np.zeros((matrix.shape[0], 0))
    for k in range(matrix.shape[1]):
        column = matrix[:, k]
        size = np.linalg.norm(column)
        if size == 0:
            continue
        rest = column - base @ (base.T @ column)
        rest = rest - base @ (base.T @ rest)
        if np.linalg.norm(rest) > _TINY * size:
            kept.append(k)
            base = np.column_stack([base, rest / np.linalg.norm(rest)])
    return kept


def _rational(x: arb) -> Fraction | None:
    """The one short rational number in a ball."""
    if not x.is_finite() or x.rad() > arb(2) ** -(BITS // 3):
        return None
    if abs(x) < arb(2) ** -(BITS // 2):
        return Fraction(0)
    middle: Any = x.mid().fmpq()
    exact = Fraction(int(middle.p), int(middle.q))
    near = exact.limit_denominator(2**_LONGEST)
    off = abs(near - exact)
    close = off <= Fraction(1, 2 ** (BITS // 2 + 20)) or x.contains(arb(fmpq(near.numerator, near.denominator)))
    return near if close else None
