"""Fields of u and t, and all their derivatives, as symbols: what an identity between fields is an identity of.

A field is a symbol; so is each of its derivatives, unless a law says what it is. Nothing depends on anything but
through such laws: two expressions are equal for all fields exactly if they are equal as expressions in these symbols.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import Array

ALONG = ("u", "t")


class Jets:
    """Fields of one problem: their symbols, their laws, and the constraints between them.

    ``rules``: polynomials that vanish. ``parameters``: of symbols that are bound by a constraint the polynomials that
    satisfy it, in new symbols: a rotation matrix in terms of a quaternion whose norm is one by a rule.
    """

    def __init__(self) -> None:
        self._jets: dict[sp.Symbol, tuple[sp.Symbol, int, int]] = {}
        self._laws: dict[tuple[sp.Symbol, str], sp.Expr] = {}
        self._derivatives: dict[tuple[sp.Symbol, str], sp.Expr] = {}
        self.rules: list[sp.Expr] = []
        self.parameters: dict[sp.Symbol, sp.Expr] = {}

    def scalar(self, name: str) -> sp.Symbol:
        """A field of u and t. Raises ValueError if there is one of that name."""
        found = sp.Symbol(name)
        if found in self._jets:
            raise ValueError(f"expected a new name for a field, found {name} again; take another one")
        self._jets[found] = (found, 0, 0)
        return found

    def constant(self, name: str) -> sp.Symbol:
        """A number that depends on neither u nor t."""
        found = self.scalar(name)
        self.law(found, u=sp.S.Zero, t=sp.S.Zero)
        return found

    def fields(self, names: Sequence[str]) -> Array:
        """Fields of these names, object array (n,)."""
        return np.array([self.scalar(name) for name in names], dtype=object)

    def constants(self, name: str, *shape: int) -> Array:
        """Numbers name1, ... or name11, ..., object array of that shape."""
        return self._numbered(self.constant, name, shape)

    def array(self, name: str, *shape: int) -> Array:
        """Fields name1, ... or name11, ..., object array of that shape."""
        return self._numbered(self.scalar, name, shape)

    def symmetric(self, name: str, n: int) -> Array:
        """Numbers in a symmetric matrix (n, n)."""
        found = np.empty((n, n), dtype=object)
        for i in range(n):
            for j in range(i, n):
                found[i, j] = found[j, i] = self.constant(f"{name}{i + 1}{j + 1}")
        return found

    def law(self, fields: Any, u: Any = None, t: Any = None) -> None:
        """What the derivatives of these fields are; what is not said stays free."""
        for along, values in (("u", u), ("t", t)):
            if values is not None:
                for field, value in zip(_flat(fields), _flat(values), strict=True):
                    self._laws[field, along] = sp.sympify(value, strict=True)

    def du(self, e: Any) -> Any:
        """The derivative along the rod, of an expression or an array of them."""
        return self._total(e, "u")

    def dt(self, e: Any) -> Any:
        """The derivative in time, likewise."""
        return self._total(e, "t")

    def _numbered(self, make: Callable[[str], sp.Symbol], name: str, shape: tuple[int, ...]) -> Array:
        found = np.empty(shape, dtype=object)
        for index in np.ndindex(*shape):
            found[index] = make(name + "".join(str(i + 1) for i in index))
        return found

    def _total(self, e: Any, along: str) -> Any:
        if isinstance(e, np.ndarray):
            out = np.empty(e.shape, dtype=object)
            for index in np.ndindex(*e.shape):
                out[index] = self._total(e[index], along)
            return out
        e = sp.sympify(e, strict=True)
        derivatives = {x: self._derivative(x, along) for x in sorted(e.free_symbols, key=str)}
        return sp.Add(*(e.diff(x) * derivative for x, derivative in derivatives.items() if derivative != 0))

    def _derivative(self, x: sp.Symbol, along: str) -> sp.Expr:
        if x not in self._jets:  # no field: a small parameter, say
            return sp.S.Zero
        if (x, along) not in self._derivatives:
            self._derivatives[x, along] = self._new_derivative(x, along)
        return self._derivatives[x, along]

    def _new_derivative(self, x: sp.Symbol, along: str) -> sp.Expr:
        base, *orders = self._jets[x]
        if (base, along) in self._laws:
            rate = self._laws[base, along]
            for other, order in zip(ALONG, orders, strict=True):
                for _ in range(order):
                    rate = self._total(rate, other)
            return rate
        orders[ALONG.index(along)] += 1
        found = sp.Symbol(f"{base.name}_{'u' * orders[0]}{'t' * orders[1]}")
        self._jets[found] = (base, orders[0], orders[1])
        return found

    def bound(self, values: Mapping[sp.Symbol, sp.Expr], rules: Sequence[sp.Expr]) -> None:
        """Constrains fields to these polynomials in new symbols, in which the rules vanish."""
        self.parameters.update(values)
        self.rules.extend(rules)


def _flat(values: Any) -> list[Any]:
    return list(values.ravel()) if isinstance(values, np.ndarray) else [values]
