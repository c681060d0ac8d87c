"""Random expressions, as trees and as texts, for the laws that hold for all of them."""

from __future__ import annotations

from hypothesis import strategies as st

from geocosserat.model.expressions import FUNCTIONS, Binary, Call, Expression, Negate, Number, Symbol

NAMES = frozenset({"u", "t", "kappa", "k_3"})

finite = st.floats(allow_nan=False, allow_infinity=False)
leaves: st.SearchStrategy[Expression] = st.one_of(
    finite.map(Number),
    st.integers(-3, 10).map(lambda n: Number(float(n))),
    st.sampled_from(sorted(NAMES)).map(Symbol),
)


def _grow(inner: st.SearchStrategy[Expression]) -> st.SearchStrategy[Expression]:
    return st.one_of(
        st.builds(Binary, st.sampled_from(["+", "-", "*", "/", "**"]), inner, inner),
        st.builds(Negate, inner),
        st.builds(Call, st.sampled_from(FUNCTIONS), inner),
    )


trees: st.SearchStrategy[Expression] = st.recursive(leaves, _grow, max_leaves=20)
moderate: st.SearchStrategy[Expression] = st.recursive(
    st.one_of(st.floats(-10, 10).map(Number), st.sampled_from(sorted(NAMES)).map(Symbol)), _grow, max_leaves=8
)
"""Trees of moderate numbers, whose values can be compared."""

pieces = st.sampled_from(
    [
        *sorted(NAMES),
        *FUNCTIONS,
        "pi",
        "1",
        "2.5",
        ".5",
        "3.",
        "1e3",
        "2E-2",
        "+",
        "-",
        "*",
        "/",
        "**",
        "(",
        ")",
        " ",
    ]
)
texts = st.lists(pieces, max_size=30).map("".join)
"""Strings of the right tokens in any order: many parse, many nearly do."""


def _join(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    return st.one_of(
        st.tuples(inner, st.sampled_from(["+", "-", "*", "/", "**", " + ", " ** "]), inner).map("".join),
        st.tuples(st.sampled_from(["-", "+", "- "]), inner).map("".join),
        st.tuples(st.sampled_from(["(", "( ", *(f"{name}(" for name in FUNCTIONS)]), inner, st.just(")")).map("".join),
    )


atoms = st.sampled_from([*sorted(NAMES), "pi", "1", "2.5", ".5", "3.", "1e3", "2E-2"])
arithmetic = st.recursive(atoms, _join, max_leaves=20)
"""Valid texts whose grouping is left to the precedence of what happens to stand side by side."""
