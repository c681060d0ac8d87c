"""Checks of coefficients that vary: finite where they are used, symmetric and positive along the rod."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geocosserat.model.expressions import Expression, ExpressionError, evaluate, jump_positions, symbols
from geocosserat.model.fields import Names
from geocosserat.model.place import Found, Place

POINTS = 257
INSTANTS = 65
_ASYMMETRY = 1e-12  # both of the matrix scaled to a unit diagonal
_LEAST_EIGENVALUE = 1e-14  # a solve would have no correct digit

Array = NDArray[np.float64]


def points_along(place: Place, expressions: Sequence[Expression], names: Names) -> Array:
    """Values of ``u`` at which to look: both ends, evenly between, and both sides of every step.

    Raises InputError for steps that move or are at no one place.
    """
    beside = 1e-9 * names.length
    steps: set[float] = set()
    for e in expressions:
        try:
            steps.update(jump_positions(e, names.length, names.parameters))
        except ExpressionError as error:
            raise place.wrong("steps at known places", Found("others"), str(error)) from None
    sides = [side for step in steps for side in (step - beside, step + beside) if 0 <= side <= names.length]
    return np.unique(np.concatenate([np.linspace(0.0, names.length, POINTS), sides]))


def check_finite(place: Place, e: Expression, names: Names, until: float) -> None:
    """Raise InputError unless the expression is finite along the rod and from time 0 to ``until``."""
    used = symbols(e)
    u = points_along(place, [e], names) if "u" in used else np.zeros(1)
    t = np.linspace(0.0, until, INSTANTS) if "t" in used else np.zeros(1)
    values = np.broadcast_to(_at(e, names, u[:, None], t[None, :]), (u.size, t.size))
    for i, j in np.argwhere(~np.isfinite(values)):
        where = {"u": float(u[i]), "t": float(t[j])}
        at = " and ".join(f"{name} = {value:.6g}" for name, value in where.items() if name in used)
        found = Found(f"{float(values[i, j])} at {at}")
        raise place.wrong("a finite value", found, "change the expression there")


def check_all_finite(place: Place, vector: Sequence[Expression], names: Names, until: float = 0.0) -> None:
    """``check_finite`` of every component."""
    for i, e in enumerate(vector):
        check_finite(place.at(i), e, names, until)


def check_written(place: Place, value: Any, vector: Sequence[Expression], names: Names, until: float) -> None:
    """``check_finite`` of every component, each where it is written: in a list, or by itself."""
    for i, e in enumerate(vector):
        check_finite(place.at(i) if isinstance(value, list) else place, e, names, until)


def check_positive(
    place: Place, matrix: Sequence[Sequence[Expression]], names: Names, components: Sequence[str], hint: str
) -> None:
    """Raise InputError unless the matrix is finite, symmetric and positive definite all along the rod."""
    entries = [e for row in matrix for e in row]
    u = points_along(place, entries, names)
    if not any("u" in symbols(e) for e in entries):
        u = u[:1]
    size = len(components)
    values = np.empty((u.size, size, size))
    for i, row in enumerate(matrix):
        for j, e in enumerate(row):
            values[:, i, j] = _at(e, names, u, 0.0)
    for where, m in zip(u, values, strict=True):
        if problem := _problem(m, components):
            expected, found, do = problem
            raise place.wrong(expected, Found(f"{found} at u = {float(where):.6g}"), do or hint)


def _problem(m: Array, components: Sequence[str]) -> tuple[str, str, str | None] | None:
    """What is wrong with a stiffness or friction matrix: expected, found and, if special, what to do."""

    def entry(i: Any, j: Any) -> str:
        return f"({components[i]}, {components[j]}) = {float(m[i, j]):.6g}"

    for i, j in np.argwhere(~np.isfinite(m)):
        return "a finite matrix", entry(i, j), "change the expression there"
    for i in np.flatnonzero(np.diag(m) <= 0):
        return "a positive definite matrix", entry(i, i), None
    root = np.sqrt(np.diag(m))
    with np.errstate(over="ignore"):
        # unit diagonal: stretching is often a million times stiffer than bending
        scaled = np.clip(m / root[:, None] / root[None, :], -10.0, 10.0)
    for i, j in np.argwhere(np.abs(scaled - scaled.T) > _ASYMMETRY):
        return "a symmetric matrix", f"{entry(i, j)} but {entry(j, i)}", "make the two equal"
    least = float(np.linalg.eigvalsh(scaled)[0])
    if least <= _LEAST_EIGENVALUE:
        return "a positive definite matrix", f"the eigenvalue {least:.3g} (diagonal scaled to 1)", None
    return None


def _at(e: Expression, names: Names, u: Array | float, t: Array | float) -> Array | float:
    return evaluate(e, {**names.parameters, "u": u, "t": t})
