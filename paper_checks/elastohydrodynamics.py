"""Section IV.C: drag, and the closed equations of motion."""

from collections.abc import Iterable
from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp
from sympy.core.function import AppliedUndef

from geocosserat.algebra.groups import SE3, Array, Group
from geocosserat.derivation.coordinates import in_chart
from geocosserat.derivation.equations import derive
from geocosserat.derivation.notation import U
from geocosserat.derivation.records import FieldEquations
from geocosserat.model.effects.couple import Couple
from geocosserat.model.effects.follower import Follower
from geocosserat.model.expressions import Expression, parse
from geocosserat.model.records import RodModel
from geocosserat.referee.motion import Motion, cross
from geocosserat.referee.statement import Check, Section

SECTION = Section("Elastohydrodynamics")


class DrivenRod(Motion):
    """A moving rod with friction, and something else that acts on it.

    mobility: the inverse of the friction, here diagonal. push: j(phi), the wrench that is not friction.
    """

    def __init__(self, group: Group = SE3) -> None:
        super().__init__(group)
        d = group.dimension
        self.mobility, self.push = np.diag(self.constants("Y", d)), self.fields(group.wrench)

    @property
    def balanced_twist(self) -> Array:
        """The twist whose drag, with the push, is the wrench that the balance of force and moment asks for."""
        return np.asarray(self.mobility @ (self.push - self.wrench))


class DerivedRod(Motion):
    """What geocosserat derives for a rod with S = K (E - reference) and j = -Gamma V + push, in the fields of a motion.

    stiffness, reference: numbers or symbols; by default a symbol for each entry. The left end is clamped, the right
    one free.
    """

    def __init__(self, group: Group = SE3, stiffness: Any = None, reference: Any = None) -> None:
        super().__init__(group)
        d = group.dimension
        self.friction, self.push = self.symmetric("G", d), self.fields(group.wrench)
        self.stiffness = self.symmetric("K", d) if stiffness is None else np.asarray(stiffness)
        self.reference = self.constants("Ebar", d) if reference is None else np.asarray(reference)

    @cached_property
    def equations(self) -> FieldEquations:
        """As derived, in functions of u and t."""
        n = self.group.translations
        push = _expressions(self.push)
        effects = (Follower(push[:n]), Couple(push[n:]))
        K, friction = (tuple(_expressions(row) for row in matrix) for matrix in (self.stiffness, self.friction))
        return derive(RodModel(self.group, 1.0, K, friction, _expressions(self.reference), effects=effects))

    def seen(self, expressions: Iterable[sp.Expr]) -> Array:
        """The same expressions in the symbols of the motion."""
        found = []
        for e in expressions:
            names = {x: sp.Symbol(x.func.__name__) for x in e.atoms(AppliedUndef)}
            slopes = {x: self.du(names[x.expr]) for x in e.atoms(sp.Derivative) if x.variables == (U,)}
            numbers = {x: sp.Symbol(x.name) for x in e.free_symbols}
            found.append(e.xreplace(slopes).xreplace(names).xreplace(numbers))
        return np.array(found, dtype=object)


def _expressions(values: Iterable[Any]) -> tuple[Expression, ...]:
    return tuple(parse(str(x), frozenset(map(str, sp.sympify(x).free_symbols))) for x in values)


@SECTION.states(
    "(40)",
    "the wrench is friction, linear in the twist, and what else acts",
    r"\underline{j}(\varphi,V)=-\underline{\underline{\Gamma}}\cdot\underline{V}+\underline{j}(\varphi)",
)
def wrench_with_friction() -> Check:
    rod = DerivedRod()
    Gamma, V, j = rod.friction, rod.twist, rod.push
    return Check(printed=-Gamma @ V + j, derived=rod.seen(e.right for e in rod.equations.wrench_law), defines=True)


@SECTION.states(
    "P06",
    "friction is a symmetric, positive definite matrix that a rigid motion of the whole does not change",
    r"\underline{\underline{\Gamma}}=\underline{\underline{\Gamma}}^{T}>0",
    remark="An assumption. Symmetry is Onsager's relation: only the symmetric part takes power. Positive definite, it "
    "has an inverse, without which (42) gives no twist.",
)
def friction_is_symmetric() -> Check:
    rod = DerivedRod()
    V, phi, shift = rod.twist, rod.configuration, rod.constants("g", 3)
    loss = rod.seen([rod.equations.dissipation])[0]
    moved = rod.group.pose(shift, np.roll(np.eye(3, dtype=int), 1, axis=0)) @ phi
    return Check(
        printed=rod.friction,
        derived=[[loss.diff(x, y) / 2 for x in V] for y in V],
        defines=True,
        also=[
            ("the power lost is V.Gamma V", loss, V @ rod.friction @ V),
            ("a rod moved as a whole has the same V", rod.group.vee(rod.group.inverse(moved) @ rod.dt(moved)), V),
        ],
        fields=rod,
    )


@SECTION.states(
    "(41)",
    "drag balances stress and what else acts",
    r"\underline{\underline{\Gamma}}\cdot\underline{V}=\mathcal{D}^{*}\underline{\Sigma}(E)+\underline{j}(\varphi)",
)
def overdamped_balance() -> Check:
    rod = DrivenRod()
    E, Sigma, j = rod.turn, rod.stress, rod.push
    return Check(
        printed=rod.du(Sigma) + rod.group.coad(E) @ Sigma + j,
        derived=j - rod.wrench,  # -Gamma V + j is the wrench that balances the stress
        fields=rod,
    )


@SECTION.states(
    "(42)",
    "turn and configuration give the twist at once",
    r"\underline{V}(\varphi)=\underline{\underline{\Gamma}}^{-1}"
    r"[\mathcal{D}^{*}\underline{\Sigma}(E)+\underline{j}(\varphi)]",
)
def twist_at_once() -> Check:
    rod = DrivenRod()
    E, Sigma, j = rod.turn, rod.stress, rod.push
    return Check(
        printed=rod.mobility @ (rod.du(Sigma) + rod.group.coad(E) @ Sigma + j),
        derived=rod.balanced_twist,
        fields=rod,
    )


@SECTION.states(
    "P07",
    "twelve equations for the twelve components of the configuration",
    r"12\text{ equations for the components of }\varphi(u,t)",
    remark="Six of the twelve are independent: the others keep the frame orthonormal, P01.",
)
def twelve_equations() -> Check:
    rod = Motion()
    rates = rod.configuration @ rod.group.hat(rod.twist)
    unknowns = {x for x in rod.configuration.ravel() if x in rod.parameters or x in set(rod.position)}
    slopes = sp.Matrix(rates.ravel()).jacobian(list(rod.twist))
    turned = dict(zip(sp.symbols("q0:4"), (sp.Rational(x, 15) for x in (2, 5, 14, 0)), strict=True))
    return Check(
        printed=[12, 12],
        derived=[np.count_nonzero(rates), len(unknowns)],
        also=[("six of them are independent", slopes.xreplace(rod.parameters).xreplace(turned).rank(), 6)],
    )


@SECTION.states(
    "(43)",
    "the twist moves the configuration",
    r"\dot{\varphi}=\varphi V(\varphi)",
    part="(43a)",
)
def configuration_rate() -> Check:
    rod = Motion()
    (v, Omega), V = rod.split(rod.twist), rod.group.hat(rod.twist)
    v, Omega = rod.world(v), rod.world(Omega)
    moved = np.column_stack([v, *(cross(Omega, e) for e in rod.frame)])  # (2)
    return Check(
        printed=rod.configuration @ V,
        derived=np.vstack([np.zeros(4, dtype=int), moved]),
        fields=rod,
    )


@SECTION.states(
    "(43)",
    "the twist in terms of the configuration alone",
    r"\underline{V}=\underline{\underline{\Gamma}}^{-1}"
    r"[\mathcal{D}^{*}\underline{\Sigma}(\varphi^{-1}\varphi')+\underline{j}(\varphi)]",
    part="(43b)",
)
def twist_of_the_configuration() -> Check:
    rod = DrivenRod()
    group, phi, T = rod.group, rod.configuration, np.diag(rod.constants("T", 6))
    rod.law(rod.stress, u=T @ rod.du(rod.turn))  # of any S(E) only the tangent here matters
    E = group.vee(group.inverse(phi) @ rod.du(phi))
    Sigma, j = rod.stress, rod.push
    return Check(
        printed=rod.mobility @ (T @ rod.du(E) + group.coad(E) @ Sigma + j),
        derived=rod.balanced_twist,
        fields=rod,
    )


@SECTION.states(
    "P08",
    "in local coordinates these are six equations, one for each dimension of SE(3)",
    r"6\text{ equations, one for each dimension of }SE(3)",
    remark="A chart of all of SE(3) by six coordinates does not exist: each has its singular set.",
)
def six_equations_in_coordinates() -> Check:
    rod = DerivedRod()
    chart = in_chart(rod.equations, "rotation-vector")
    rates = sp.Matrix([e.right for e in chart.rates]).jacobian(list(rod.equations.twist))
    somewhere = {x: sp.Rational((k + 1) ** 2, 7) for k, x in enumerate(sorted(rates.atoms(AppliedUndef), key=str))}
    return Check(
        printed=[6, 6],
        derived=[len(chart.rates), rates.xreplace(somewhere).rank()],
        also=[("as many coordinates", len(chart.coordinates), rod.group.dimension)],
    )


@SECTION.states(
    "(44)",
    "the turn changes by the twist",
    r"\dot{E}=\partial_{u}V+[E,V]",
    part="(44a)",
)
def turn_rate() -> Check:
    rod = Motion()
    E, V = rod.turn, rod.twist
    return Check(printed=rod.du(V) + rod.group.bracket(E, V), derived=rod.dt(E), fields=rod)


@SECTION.states(
    "(44)",
    "the twist in terms of the turn alone",
    r"V=\underline{\underline{\Gamma}}^{-1}[\mathcal{D}^{*}\underline{\Sigma}(E)]",
    r"V=\underline{\underline{\Gamma}}^{-1}[\mathcal{D}^{*}\underline{\Sigma}(E)+\underline{j}]",
    remark="As the paper says, nothing may depend on the configuration. A wrench j that turns with the rod may stay: "
    "with it the equations are closed too.",
    part="(44b)",
)
def twist_of_the_turn() -> Check:
    rod = DrivenRod()
    E, Sigma, j = rod.turn, rod.stress, rod.push
    return Check(
        printed=rod.mobility @ (rod.du(Sigma) + rod.group.coad(E) @ Sigma),
        derived=rod.balanced_twist,
        corrected=rod.mobility @ (rod.du(Sigma) + rod.group.coad(E) @ Sigma + j),
        condition=("nothing acts on the rod but friction", {x: sp.S.Zero for x in j}),
        fields=rod,
    )


@SECTION.states(
    "P09",
    "six equations for the turn, closed",
    r"6\text{ equations for the 6 components of }E\text{, and nothing else in them}",
    remark="Closed if nothing depends on the configuration, as the paper says. A weight does not close: its components "
    "in the moving frame depend on the frame.",
)
def closed_for_the_turn() -> Check:
    rod = DrivenRod()
    E, Sigma, coad, weight = rod.turn, rod.stress, rod.group.coad, rod.constants("w", 3)
    j = np.concatenate([rod.body(weight), np.zeros(3, dtype=int)])
    V = rod.mobility @ (rod.du(Sigma) + coad(E) @ Sigma + j)
    rates = rod.du(V) + rod.group.bracket(E, V)
    by_frame = sp.Matrix(rates).jacobian(list(rod.rotation.ravel()))
    return Check(
        printed=[6, 6, *np.zeros(6 * 9, dtype=int)],
        derived=[len(rates), len(E), *by_frame],
        condition=("no wrench depends on the configuration: no weight", {x: sp.S.Zero for x in weight}),
        fields=rod,
    )
