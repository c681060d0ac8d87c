"""The stress at a Gauss point, what it stores, loses and is supplied with: of a stiffness, or of a law."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp

from geocosserat.derivation.convert import to_sympy
from geocosserat.discretisation.structure import ONE, ZERO, LawStructure, Matrix, RodStructure
from geocosserat.model.expressions import Expression
from geocosserat.model.law import rates

Vector = tuple[sp.Expr, ...]


class step(sp.Function):  # type: ignore[misc]  # noqa: N801, RUF100
    """1 beyond zero, 0 before it, 1/2 there; its jump has no derivative."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return sp.S.Zero

    def _eval_evalf(self, prec: int) -> sp.Expr:
        return sp.Heaviside(self.args[0])._eval_evalf(prec)


class size(sp.Function):  # type: ignore[misc]  # noqa: N801, RUF100
    """The absolute value, whose derivative is a step."""

    nargs = 1

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        return 2 * step(self.args[0]) - 1

    def _eval_evalf(self, prec: int) -> sp.Expr:
        return sp.Abs(self.args[0])._eval_evalf(prec)


@dataclass(frozen=True)
class Material:
    """At one Gauss point, in terms of turn and coefficients; densities per length of the rod.

    stress (d; force, force x length), of viscous modes in terms of rate_i too. energy (force), in terms of turn and
    stress. supply, loss: power densities (force / time): of what moves the reference or changes the law in time, and of
    the stress that stores nothing, in terms of rate_i, of viscous modes of the stress itself; None where there is none.
    """

    stress: Vector
    energy: sp.Expr
    supply: sp.Expr | None
    loss: sp.Expr | None


def material(structure: RodStructure, turn: Iterable[sp.Expr], stress: Iterable[sp.Expr]) -> Material:
    """What the rod is made of at a turn (d); stress (d): the names under which its components are known."""
    if structure.law is not None:
        return _of_law(structure, structure.law, turn)
    strain = np.array([e - entry(name) for e, name in zip(turn, structure.reference, strict=True)], dtype=object)
    named, moving = np.array(stress, dtype=object), np.array([entry(n) for n in structure.reference_rate], dtype=object)
    return Material(
        stress=tuple(entries(structure.stiffness) @ strain),
        energy=sp.Rational(1, 2) * (strain @ named),
        supply=-(moving @ named) if structure.active else None,
        loss=None,
    )


def _of_law(structure: RodStructure, law: LawStructure, turn: Iterable[sp.Expr]) -> Material:
    rate = sp.symbols(f"rate_1:{structure.group.dimension + 1}")
    values = dict(zip((*structure.group.strain, *rates(structure.group)), (*turn, *rate), strict=True))
    lost = [formula(e, values) * x for e, x in zip(law.remainder, rate, strict=bool(law.remainder))]
    return Material(
        stress=tuple(formula(e, values) for e in law.stress),
        energy=formula(law.energy, values),
        supply=formula(law.supply, values) if structure.active else None,
        loss=sp.Add(*lost) if structure.losing else None,
    )


def formula(e: Expression, values: Mapping[str, sp.Expr] | None = None) -> sp.Expr:
    """A formula of the structure as a symbolic one: exact numbers, values put in, a dot in a name as an underscore."""
    exact = to_sympy(e)
    names = {s: (values or {}).get(s.name, sp.Symbol(s.name.replace(".", "_"))) for s in exact.free_symbols}
    return exact.replace(sp.Heaviside, lambda x, *_: step(x)).replace(sp.Abs, size).xreplace(names)


def entry(name: str) -> sp.Expr:
    """A named entry of a matrix."""
    return sp.Integer(0) if name == ZERO else sp.Integer(1) if name == ONE else sp.Symbol(name)


def entries(names: Matrix) -> np.ndarray:
    """A matrix of named entries."""
    return np.array([[entry(name) for name in row] for row in names], dtype=object)
