"""The same algebra with symbolic components: Stumpff functions that sympy can differentiate and evaluate."""

from __future__ import annotations

from typing import Any, cast

import mpmath
import numpy as np
import sympy as sp

from geocosserat.algebra import exponential
from geocosserat.algebra.groups import Array, Group


class Stumpff(sp.Function):  # type: ignore[misc]
    """c_k(s) = sum over n of (-s)^n / (2n + k)! with an integer k >= 0; closed under differentiation."""

    nargs = 2

    @classmethod
    def eval(cls, k: sp.Expr, s: sp.Expr) -> sp.Expr | None:
        if not (k.is_Integer and k >= 0):
            raise ValueError(f"k: expected an integer >= 0, found {k}; Stumpff functions start at c_0")
        return 1 / sp.factorial(k) if s.is_zero else None

    def fdiff(self, argindex: int = 2) -> sp.Expr:
        if argindex != 2:
            raise sp.ArgumentIndexError(self, argindex)
        k, s = self.args
        lower = Stumpff(k + 1, s)
        return (k * Stumpff(k + 2, s) - lower) / 2 if k else -lower / 2

    def elementary(self) -> sp.Expr:
        """The same function by cos and sin of sqrt(s), with the singularity at zero that these bring."""
        k, s = self.args
        root = sp.sqrt(s)
        if k < 2:
            return sp.cos(root) if k == 0 else sp.sin(root) / root
        return (1 / sp.factorial(k - 2) - Stumpff(k - 2, s).elementary()) / s

    def _eval_evalf(self, prec: int) -> sp.Expr:
        k, s = int(self.args[0]), self.args[1].evalf(int(prec / 3.3) + 5)
        if not s.is_number:
            return Stumpff(k, s)
        with mpmath.workprec(prec + 20):
            half = mpmath.mpf(k) / 2
            value = mpmath.hyp1f2(1, half + 0.5, half + 1, -s._to_mpmath(prec + 20) / 4) / mpmath.factorial(k)
            return sp.Expr._from_mpmath(value, prec)

    def _eval_is_extended_real(self) -> bool | None:
        return cast("bool | None", self.args[1].is_extended_real)

    def _sympystr(self, printer: Any) -> str:
        return f"c{self.args[0]}({printer.doprint(self.args[1])})"

    def _latex(self, printer: Any, exp: str | None = None) -> str:
        power = f"^{{{exp}}}" if exp else ""
        return rf"c_{{{self.args[0]}}}{power}\left({printer.doprint(self.args[1])}\right)"


def stumpff(k: int, s: Any) -> Any:
    """Symbolic c_k of an expression or of each entry of an object array: what `exponential` takes as `c`."""
    if isinstance(s, np.ndarray):
        return np.frompyfunc(lambda x: Stumpff(k, x), 1, 1)(s)
    return Stumpff(k, s)


def exp(group: Group, X: Array) -> Array:
    """Configuration exp(X) of symbolic components: object array (..., d) -> (..., size, size)."""
    return exponential.exp(group, _sympified(X), stumpff)


def dexp(group: Group, X: Array) -> Array:
    """Left-trivialised differential of exp at symbolic components: (..., d) -> (..., d, d)."""
    return exponential.dexp(group, _sympified(X), stumpff)


def dexp_inverse(group: Group, X: Array) -> Array:
    """Inverse of `dexp` at symbolic components: (..., d) -> (..., d, d)."""
    return exponential.dexp_inverse(group, _sympified(X), stumpff)


def components(names: tuple[str, ...]) -> Array:
    """Object array of real symbols with these names: (d,)."""
    return np.array([sp.Symbol(name, real=True) for name in names], dtype=object)


def configuration(group: Group) -> Array:
    """Configuration with a symbol for each free entry, x y (z) and e1x e1y ...: object array (size, size)."""
    axes = "xyz"[: group.space]
    position = components(tuple(axes))
    frame = components(tuple(f"e{i + 1}{axis}" for i in range(group.space) for axis in axes))
    return group.pose(position, frame.reshape(group.space, group.space).T)


def _sympified(X: Array) -> Array:
    """Every entry an expression, so that halves are exact rationals and not floats of Python."""
    out = np.empty(np.shape(X), dtype=object)
    for index, entry in np.ndenumerate(np.asarray(X, dtype=object)):
        out[index] = sp.Integer(0) + entry
    return out
