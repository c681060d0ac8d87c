"""Random symbolic expressions that are finite everywhere near the places they are evaluated at."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import sympy as sp
from hypothesis import strategies as st

from tests.discretisation.oracle import MP

NAMES = ("x", "y", "z")

numbers = st.one_of(
    st.integers(-3, 5).map(sp.Integer),
    st.tuples(st.integers(-7, 7), st.integers(2, 9)).map(lambda pq: sp.Rational(*pq)),
)
leaves: st.SearchStrategy[sp.Expr] = st.one_of(st.sampled_from(NAMES).map(sp.Symbol), numbers)
FUNCTIONS: tuple[Callable[[sp.Expr], sp.Expr], ...] = (
    sp.sin,
    sp.cos,
    sp.tanh,
    lambda e: sp.exp(-(e**2)),
    lambda e: sp.sqrt(1 + e**2),
    lambda e: sp.log(2 + e**2),
    lambda e: 1 / (1 + e**2),
    lambda e: (2 + sp.sin(e)) ** sp.Rational(-3, 2),
    lambda e: (3 + sp.cos(e)) ** -4,
    lambda e: -e,
    lambda e: e**2,
    lambda e: e**3,
    lambda e: sp.tanh(e) ** 5,
)


def _grow(inner: st.SearchStrategy[sp.Expr]) -> st.SearchStrategy[sp.Expr]:
    return st.one_of(
        st.tuples(inner, inner).map(lambda ab: ab[0] + ab[1]),
        st.tuples(inner, inner).map(lambda ab: ab[0] - ab[1]),
        st.tuples(inner, inner).map(lambda ab: ab[0] * ab[1]),
        st.tuples(inner, inner).map(lambda ab: ab[0] / (2 + ab[1] ** 2)),
        st.tuples(st.sampled_from(FUNCTIONS), inner).map(lambda fe: fe[0](sp.tanh(fe[1]))),
        st.tuples(st.sampled_from(FUNCTIONS), leaves).map(lambda fe: fe[0](fe[1])),
    )


trees: st.SearchStrategy[sp.Expr] = st.recursive(leaves, _grow, max_leaves=8)


def point(seed: int) -> dict[sp.Symbol, Any]:
    """A random place, exact doubles as 40-digit numbers."""
    values = np.random.default_rng(seed).uniform(-1.5, 1.5, len(NAMES))
    return {sp.Symbol(name): MP.mpf(float(v)) for name, v in zip(NAMES, values, strict=True)}


def evaluate(e: sp.Expr | int, values: Mapping[sp.Symbol, Any]) -> Any:
    """The number that e is there, with 40 digits."""
    e = sp.sympify(e)
    if e.is_Symbol:
        return values[e]
    if e.is_Rational:
        return MP.mpf(int(e.p)) / int(e.q)
    if e.is_NumberSymbol:
        return MP.mpf(str(e.evalf(60)))
    parts = [evaluate(part, values) for part in e.args]
    if e.is_Add:
        return MP.fsum(parts)
    if e.is_Mul:
        return MP.fprod(parts)
    if e.is_Pow:
        return parts[0] ** (int(e.exp) if e.exp.is_Integer else parts[1])
    return getattr(MP, e.func.__name__)(*parts)


def close(found: Any, wanted: Any, digits: float = 1e-30) -> None:
    assert abs(found - wanted) <= digits * (1 + abs(wanted)), (found, wanted)
