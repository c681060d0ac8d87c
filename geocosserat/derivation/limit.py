"""The limit of a rod with frozen modes: what its equations come down to once all that can be is eliminated.

In the plane the bend is the slope of an angle, and the spin its rate. A row of the motion that holds no unknown
velocity gives a Lagrange multiplier; friction gives the velocities; constraints give the spins that have no friction.
What remains is a closed system for the free modes and the multipliers that are left: of the planar rod that neither
stretches nor shears the nonlinear Euler-Bernoulli equations, of the spatial one those of Kirchhoff.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import sympy as sp

from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.distribute import distributed, terms
from geocosserat.derivation.elimination import Row, Solved, System, occur, put_in
from geocosserat.derivation.notation import T, U, field, fields, has_fields, is_field
from geocosserat.derivation.pairing import pairing
from geocosserat.derivation.records import EndConditions, Equation, Equations, FieldEquations, Vector
from geocosserat.model.errors import InputError

ANGLE, FRICTION, UNDRIVEN = "angle", "friction", "nothing drives it"
"""Where a value comes from, besides rows of the motion and constraints."""


@dataclass(frozen=True)
class LimitEquations:
    """The limit equations of one rod, all in terms of ``unknowns``.

    ``rows``: the closed system, an equation for each unknown. ``fixes``: which of them each is matched with.
    ``solved``: what was eliminated, in that order. ``divided``: whether by the stretch, which is positive.
    ``left``, ``right``: the ends; of joined ends in terms of what they share.
    """

    equations: FieldEquations
    unknowns: Vector
    rows: Equations
    fixes: Vector
    solved: tuple[Solved, ...]
    divided: bool
    left: EndConditions
    right: EndConditions

    @property
    def multipliers(self) -> Vector:
        """The Lagrange multipliers among the unknowns."""
        return tuple(f for f in self.unknowns if f in self.equations.multipliers)


def limit(equations: FieldEquations) -> LimitEquations:
    """The limit equations of a rod with frozen modes; algebra only, below a second.

    Raises InputError for a rod that has none.
    """
    model = equations.model
    if not model.frozen:
        raise InputError(
            "a rod with frozen modes",
            "none",
            f'name some under [rod], as in frozen = ["{model.group.strain[0]}"], or choose the form intrinsic',
            key="rod.frozen",
        )
    system = _angle(_start(equations), equations)
    system = _balances(system, equations)
    system = _friction(system, equations)
    system = _spins(system, equations)
    system = _undriven(system, equations)
    fixes = pairing(system)
    return LimitEquations(
        equations=equations,
        unknowns=system.unknowns,
        rows=tuple(_arranged(row.equation, f) for row, f in zip(system.rows, fixes, strict=True)),
        fixes=fixes,
        solved=system.solved,
        divided=system.divided,
        left=_end(equations.left, system, equations),
        right=_end(equations.right, system, equations),
    )


def _start(equations: FieldEquations) -> System:
    """The closed system as it is derived."""
    group, turn, twist = equations.group, equations.turn, equations.twist
    stress = fields(group.stress)
    rows = [
        Row(_constraint(name) if held else f"the rate of {name}", e, S if held else E)
        for name, held, e, S, E in zip(
            group.strain, equations.model.held, equations.compatibility, stress, turn, strict=True
        )
    ]
    rows += [Row(_balance(v), e, v) for v, e in zip(twist, equations.motion, strict=True)]
    rows += [Row(f"the law of {e.left.func}", e, e.left) for e in equations.stress_law if equations.keeps_stress]
    carried = (*equations.orientation.fields, *equations.position.fields)
    rates = (*equations.orientation_rates, *equations.position_rates)
    rows += [Row(f"the rate of {f.func}", e, f) for f, e in zip(carried, rates, strict=True)]
    return System(tuple(rows), equations.unknowns, turn[0])


def _balance(velocity: sp.Expr) -> str:
    return f"the row of {velocity.func}"


def _constraint(mode: str) -> str:
    return f"the constraint on {mode}"


def _angle(system: System, equations: FieldEquations) -> System:
    """In the plane a free bend is the slope of an angle and the spin its rate, which makes them compatible."""
    turn, twist = equations.turn[-1], equations.twist[-1]
    if equations.group.space != 2 or not is_field(turn):
        return system
    theta = field("theta")
    values = {turn: theta.diff(U), twist: theta.diff(T)}
    return system.replaced(values, [f"the rate of {turn.func}", f"the rate of {theta.func}"], (theta,), ANGLE)


def _balances(system: System, equations: FieldEquations) -> System:
    """Rows of the motion without an unknown velocity give multipliers, a force along the rod last."""
    multipliers = sorted(equations.multipliers, key=lambda f: f == fields(equations.group.stress)[0])
    for v in equations.twist:
        row = system.row(_balance(v))
        if row and not (occur(row.equation.left) | occur(row.equation.right)).intersection(equations.twist):
            system = system.solve(row, multipliers)
    return system


def _friction(system: System, equations: FieldEquations) -> System:
    """Friction gives the velocities that it acts on."""
    matrix = {
        (v, w): to_sympy(x)
        for v, entries in zip(equations.twist, equations.model.friction, strict=True)
        for w, x in zip(equations.twist, entries, strict=True)
    }
    moving = [v for v in equations.twist if v in system.unknowns and matrix[v, v] != 0]
    rows = {v: row for v in moving if (row := system.row(_balance(v)))}
    return system.solve_friction(rows, lambda v, w: matrix[v, w])


def _spins(system: System, equations: FieldEquations) -> System:
    """Constraints give the velocities that friction does not."""
    for name, held in zip(equations.group.strain, equations.model.held, strict=True):
        row = system.row(_constraint(name))
        if held and row:
            system = system.solve(row, equations.twist)
    return system


def _undriven(system: System, equations: FieldEquations) -> System:
    """Without the multipliers that vanish because everything that they have to keep keeps itself.

    Friction makes the motion unique, so if it satisfies their constraints and the ends without them, it is the motion.
    """
    fixed = dict(zip(pairing(system), system.rows, strict=True))
    still = [f for f in system.unknowns if f in equations.multipliers]
    while still:
        zero = dict.fromkeys(still, sp.S.Zero)
        driven = [f for f in still if distributed(put_in(fixed[f].equation.residual, zero)) != 0]
        if not driven:
            break
        still = [f for f in still if f not in driven]
    if not still:
        return system
    without = system.replaced(zero, [fixed[f].origin for f in still], (), UNDRIVEN)
    d = equations.group.dimension
    for end in (equations.left, equations.right):
        conditions = _conditions(end, without, equations)
        if any(e.left == 0 and e.right != 0 for e in conditions) or len(conditions) > d - len(still):
            return system
    return without


def _end(end: EndConditions, system: System, equations: FieldEquations) -> EndConditions:
    return end if end.kind == "joined" else replace(end, equations=_conditions(end, system, equations))


def _conditions(end: EndConditions, system: System, equations: FieldEquations) -> Equations:
    """What remains to be said at an end, in terms of the unknowns."""
    if end.kind == "joined":
        return ()
    laws = {e.left: e.right for e in equations.stress_law if e.left not in system.unknowns}
    values = system.values
    found = []
    for e in end.equations:
        left, right = (distributed(put_in(put_in(side, laws), values)) for side in (e.left, e.right))
        if left != 0 or right != 0:
            found.append(given(left, right, system.stretch))
    return tuple(dict.fromkeys(found))


def given(left: sp.Expr, right: sp.Expr, stretch: sp.Expr) -> Equation:
    """left = right, or if one product of fields is all that it holds, that product by itself and what it is."""
    parts = terms(left)
    products = [product for product in parts if product != 1]
    if len(products) != 1 or has_fields(right):
        return Equation(left, right)
    (product,) = products
    value = distributed((right - parts.get(sp.S.One, sp.S.Zero)) / parts[product])
    if value == 0 and product != stretch:
        product = sp.Mul(*(f for f in sp.Mul.make_args(product) if f.as_base_exp()[0] != stretch))
    return Equation(product, value)


def _arranged(equation: Equation, fixes: sp.Expr) -> Equation:
    """What a row has on its left stays there; a row without that fixes a mode has the rates of that mode there."""
    if equation.left != 0:
        return equation
    moved, rest = sp.S.Zero, sp.S.Zero
    for product, c in terms(equation.right).items():
        if fixes == field("theta") and _rates_in(product, fixes):
            moved -= c * product
        else:
            rest += c * product
    return Equation(moved, rest)


def _rates_in(product: sp.Expr, f: sp.Expr) -> Iterable[sp.Expr]:
    return [d for d in product.atoms(sp.Derivative) if d.expr == f and T in d.variables]
