"""Section VI: small motions about an equilibrium."""

from functools import cache, cached_property
from typing import Any

import numpy as np
import sympy as sp

from geocosserat.algebra import symbolic
from geocosserat.algebra.fields import derivatives
from geocosserat.algebra.groups import SE2, SE3, Array, Group
from geocosserat.referee.jets import Jets
from geocosserat.referee.motion import Motion
from geocosserat.referee.statement import Check, Section
from paper_checks.elastohydrodynamics import DrivenRod

SECTION = Section("Linearisation")
EPS = sp.Symbol("epsilon")
STRESSED = (
    "The stress of the base state also acts along the perturbed turn: the variation of D* adds ad*_{delta E} Sigma_0, "
    "which is the geometric stiffness."
)


class Displaced(Motion):
    """A moving rod, the base state, and the same one displaced by a small field eta."""

    def __init__(self) -> None:
        super().__init__()
        self.eta = self.array("eta", 6)
        self.displaced = self.configuration @ (np.eye(4, dtype=int) + EPS * self.group.hat(self.eta))

    def turn_of(self, phi: Array) -> Array:
        """Components of phi^-1 phi'."""
        return self.group.vee(self.group.inverse(phi) @ self.du(phi))

    def twist_of(self, phi: Array) -> Array:
        """Components of phi^-1 d(phi)/dt."""
        return self.group.vee(self.group.inverse(phi) @ self.dt(phi))


class Perturbed(Jets):
    """The velocity of a rod whose turn is that of a base state, E, plus epsilon (eta' + [E, eta]).

    stress: Sigma_0 of the base state, of any law; tangent: T; slope: S, what the wrench gains by eta; mobility: the
    inverse of the friction. All but the mobility and S are fields along the rod, S is one too but its derivative
    does not occur.
    """

    def __init__(self, group: Group = SE3) -> None:
        super().__init__()
        d = group.dimension
        self.group = group
        self.turn, self.stress, self.eta = self.fields(group.strain), self.fields(group.stress), self.array("eta", d)
        self.tangent, self.slope = self.array("T", d, d), self.array("S", d, d)
        self.mobility = np.diag(self.constants("Y", d))

    @cached_property
    def strain(self) -> Array:
        """delta E."""
        return np.asarray(self.du(self.eta) + self.group.bracket(self.turn, self.eta))

    @cached_property
    def rate(self) -> Array:
        """delta V: the slope of mobility [Sigma' + ad*_E Sigma + j] at the base state."""
        E, Sigma = self.turn + EPS * self.strain, self.stress + EPS * self.tangent @ self.strain
        balance = self.du(Sigma) + self.group.coad(E) @ Sigma + EPS * self.slope @ self.eta
        return self.mobility @ _first_order(balance)

    def dual_derivative(self, stress: Array) -> Array:
        """D* of the base state: Sigma' + ad*_E Sigma."""
        return np.asarray(self.du(stress) + self.group.coad(self.turn) @ stress)

    @cached_property
    def geometric(self) -> Array:
        """B with ad*_X Sigma_0 = B X: what the stress of the base state adds to the tangent."""
        units = np.eye(self.group.dimension, dtype=int).astype(object)
        return np.column_stack([self.group.coad(unit) @ self.stress for unit in units])

    @property
    def unstressed(self) -> tuple[str, dict[sp.Symbol, Any]]:
        """The condition that the base state has no stress."""
        return "the base state has no stress", {x: sp.S.Zero for x in self.stress}

    def by(self, field: Array) -> Array:
        """The matrix that multiplies eta, or a derivative of it, in the velocity."""
        return np.array(sp.Matrix(self.rate).jacobian(list(field)))


@cache
def _perturbed() -> Perturbed:
    """In space; one for all statements, since its velocity takes a second."""
    return Perturbed()


def _first_order(expressions: Array) -> Array:
    """The coefficients of epsilon."""
    return np.array([e.diff(EPS).xreplace({EPS: sp.S.Zero}) for e in expressions.ravel()]).reshape(expressions.shape)


def _at_base(expressions: Array) -> Array:
    return np.array([sp.sympify(e).xreplace({EPS: sp.S.Zero}) for e in expressions.ravel()]).reshape(expressions.shape)


def _exponential(eta: Array, order: int) -> Array:
    """The coefficient of epsilon to that power in exp(epsilon eta)."""
    full = symbolic.exp(SE3, EPS * eta)
    return np.array([[_derivative(e, order) / sp.factorial(order) for e in row] for row in full])


def _derivative(e: sp.Expr, order: int) -> sp.Expr:
    """That derivative by epsilon, at 0."""
    for _ in range(order):
        e = e.diff(EPS)
    return e.subs(EPS, 0)


def _still(rod: Displaced) -> tuple[str, dict[sp.Symbol, Any]]:
    return "the base state does not move, V_0 = 0", {x: sp.S.Zero for x in rod.twist}


@SECTION.states("I34", "the base state is at rest", r"V_0=0")
def base_state_at_rest() -> Check:
    rod = DrivenRod()
    E, Sigma, j = rod.turn, rod.stress, rod.wrench  # without friction: an equilibrium
    V = rod.mobility @ (rod.du(Sigma) + rod.group.coad(E) @ Sigma + j)  # (42)
    return Check(printed=np.zeros(6, dtype=int), derived=V, defines=True, fields=rod)


@SECTION.states("I35", "the displacement is small", r"\epsilon\ll1")
def small_parameter() -> Check:
    rod = Displaced()
    phi, eta = rod.configuration, rod.group.hat(rod.eta)
    neglected = phi @ _exponential(rod.eta, order=2)
    return Check(printed=phi @ eta @ eta / 2, derived=neglected, defines=True)


@SECTION.states(
    "(58)",
    "the displaced configuration, and to first order",
    r"\varphi=\varphi_0\exp(\epsilon\eta)=\varphi_0(I+\epsilon\eta)+O(\epsilon^2)",
)
def displaced_configuration() -> Check:
    rod = Displaced()
    phi, eta, one = rod.configuration, rod.group.hat(rod.eta), np.eye(4, dtype=int)
    return Check(
        printed=phi @ (one + EPS * eta),
        derived=phi @ (_exponential(rod.eta, order=0) + EPS * _exponential(rod.eta, order=1)),
    )


@SECTION.states("I36", "the displacement is in the algebra", r"\eta\in\mathfrak{se}(3)")
def displacement_in_the_algebra() -> Check:
    rod = Displaced()
    X, phi = rod.array("X", 4, 4), rod.configuration
    moved = phi @ (np.eye(4, dtype=int) + EPS * X)
    R = rod.group.rotation(moved)
    kept = np.concatenate([moved[0], (R.T @ R).ravel()])  # what all of SE(3) has in common
    constraints = sp.Matrix(_first_order(kept)).jacobian(list(X.ravel()))
    turned = dict(zip(sp.symbols("q0:4"), (sp.Rational(x, 15) for x in (2, 5, 14, 0)), strict=True))
    bound = constraints.xreplace(rod.parameters).xreplace(turned)
    components = dict(zip(X.ravel(), rod.group.hat(rod.eta).ravel(), strict=True))
    inside = np.array([e.xreplace(components) for e in _first_order(kept)])
    return Check(
        printed=6,
        derived=X.size - bound.rank(),
        defines=True,
        also=[("such displacements stay in SE(3)", inside, np.zeros(13, dtype=int))],
        fields=rod,
    )


@SECTION.states("I37", "the turn of a configuration", r"E=\varphi^{-1}\varphi'")
def turn_of_the_configuration() -> Check:
    rod = Motion()
    group, phi, E = rod.group, rod.configuration, rod.turn
    return Check(printed=group.inverse(phi) @ rod.du(phi), derived=group.hat(E), fields=rod)


@SECTION.states("I38", "the twist of a configuration", r"V=\varphi^{-1}\dot{\varphi}")
def twist_of_the_configuration() -> Check:
    rod = Motion()
    group, phi, V = rod.group, rod.configuration, rod.twist
    return Check(printed=group.inverse(phi) @ rod.dt(phi), derived=group.hat(V), fields=rod)


@SECTION.states(
    "(59)",
    "the twist is small",
    r"V=\epsilon\,\delta V+O(\epsilon^2)",
    r"V=V_0+\epsilon\,\delta V+O(\epsilon^2)",
    remark="The base state is at rest, as the paper says, I34.",
    part="(59a)",
)
def small_twist() -> Check:
    rod = Displaced()
    V = rod.twist_of(rod.displaced)
    delta_V = _first_order(V)
    return Check(
        printed=EPS * delta_V,
        derived=_at_base(V) + EPS * delta_V,
        corrected=rod.twist + EPS * delta_V,
        condition=_still(rod),
        fields=rod,
    )


@SECTION.states(
    "(59)",
    "the turn is that of the base state and a small one",
    r"E=E_0+\epsilon\,\delta E+O(\epsilon^2)",
    part="(59b)",
)
def small_strain() -> Check:
    rod = Displaced()
    E = rod.turn_of(rod.displaced)
    delta_E = _first_order(E)
    return Check(
        printed=rod.turn + EPS * delta_E,
        derived=_at_base(E) + EPS * delta_E,
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "(60)",
    "the twist to first order",
    r"\delta V=\dot{\eta}",
    r"\delta V=\dot{\eta}+[V_0,\eta]",
    remark="The base state is at rest, as the paper says, I34. About a moving one there is a second term.",
)
def linear_twist() -> Check:
    rod = Displaced()
    V0, eta = rod.twist, rod.eta
    return Check(
        printed=rod.dt(eta),
        derived=_first_order(rod.twist_of(rod.displaced)),
        corrected=rod.dt(eta) + rod.group.bracket(V0, eta),
        condition=_still(rod),
        fields=rod,
    )


@SECTION.states("(61)", "the turn to first order", r"\delta E=\eta'+[E_0,\eta]")
def linear_strain() -> Check:
    rod = Displaced()
    E0, eta = rod.turn, rod.eta
    return Check(
        printed=rod.du(eta) + rod.group.bracket(E0, eta),
        derived=_first_order(rod.turn_of(rod.displaced)),
        fields=rod,
    )


@SECTION.states(
    "I39",
    "the stress is a function of the turn",
    r"\Sigma=\Sigma(E)",
    remark="So a rod displaced as a whole has no other stress.",
)
def stress_of_the_turn() -> Check:
    rod = Displaced()
    rod.law(rod.eta, u=rod.group.bracket(rod.eta, rod.turn))  # the whole rod by phi_0 eta phi_0^-1
    T = np.diag(rod.constants("T", 6))
    return Check(
        printed=np.zeros(6, dtype=int),
        derived=T @ _first_order(rod.turn_of(rod.displaced)),
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "I40",
    "the external wrench is a function of the configuration",
    r"j=j(\varphi)",
    remark="So it changes with the displacement, not with its slope.",
)
def wrench_of_the_configuration() -> Check:
    rod = Displaced()
    change = _first_order(_wrench(rod.displaced))
    used = set().union(*(e.free_symbols for e in change))
    return Check(
        printed=[6, 0, 0],
        derived=[len(used & set(x)) for x in (rod.eta, rod.du(rod.eta), rod.dt(rod.eta))],
        defines=True,
    )


@SECTION.states("(62)", "the stress to first order", r"\delta\Sigma=T\,\delta E", part="(62a)")
def linear_stress() -> Check:
    rod = Jets()
    E0, dE = rod.array("E", 3), rod.array("dE", 3)
    T = np.array(sp.Matrix(_stress(E0)).jacobian(list(E0)))
    return Check(printed=T @ dE, derived=_first_order(_stress(E0 + EPS * dE)))


@SECTION.states("(62)", "the external wrench to first order", r"\delta j=S\eta", part="(62b)")
def linear_wrench() -> Check:
    rod = Displaced()
    phi, eta = rod.configuration, rod.eta
    S = np.array([derivatives(rod.group, e, phi) for e in _wrench(phi)])
    return Check(printed=S @ eta, derived=_first_order(_wrench(rod.displaced)))


@SECTION.states("(63)", "the tangent of the law", r"T:=\partial\Sigma/\partial E|_{E_0}", part="(63a)")
def tangent() -> Check:
    rod = Jets()
    E0, dE = rod.array("E", 3), rod.array("dE", 3)
    change = _first_order(_stress(E0 + EPS * dE))
    return Check(
        printed=[[F.diff(x) for x in E0] for F in _stress(E0)],
        derived=np.array([[F.diff(x) for F in change] for x in dE]).T,
        defines=True,
    )


@SECTION.states(
    "(63)",
    "how the external wrench changes along the moving frame",
    r"S:=\partial j/\partial\varphi|_{\varphi_0}\,\varphi_0",
    remark="To be read with the basis, S_ab = (dj_a/dphi_ij) phi_ik (b_b)_kj = X_b[j_a]: only six combinations of the "
    "entries of phi are free.",
    part="(63b)",
)
def slope_of_the_wrench() -> Check:
    rod = Displaced()
    phi, b = rod.configuration, np.stack(SE3.basis).astype(object)
    by_phi = np.zeros((6, 4, 4), dtype=object)
    by_phi[:, 1:] = [[[e.diff(x) for x in row] for row in phi[1:]] for e in _wrench(phi)]
    change = sp.Matrix(_first_order(_wrench(rod.displaced)))
    return Check(
        printed=np.einsum("aij,ik,bkj->ab", by_phi, phi, b),
        derived=np.array(change.jacobian(list(rod.eta))),
        defines=True,
    )


@SECTION.states(
    "I41",
    "the displacement moves with the twist",
    r"\dot{\eta}=\delta V",
    r"\dot{\eta}=\delta V-[V_0,\eta]",
    remark="The base state is at rest, as in (60).",
)
def rate_of_the_displacement() -> Check:
    rod = Displaced()
    V0, eta = rod.twist, rod.eta
    delta_V = _first_order(rod.twist_of(rod.displaced))
    return Check(
        printed=delta_V,
        derived=rod.dt(eta),
        corrected=delta_V - rod.group.bracket(V0, eta),
        condition=_still(rod),
        fields=rod,
    )


@SECTION.states(
    "I42",
    "the twist by the configuration, again",
    r"\underline{V}=\underline{\underline{\Gamma}}^{-1}"
    r"[\mathcal{D}^{*}\underline{\Sigma}(\varphi^{-1}\varphi')+\underline{j}(\varphi)]",
)
def twist_again() -> Check:
    rod = DrivenRod()
    phi, Sigma, j, coad = rod.configuration, rod.stress, rod.push, rod.group.coad
    E = rod.group.vee(rod.group.inverse(phi) @ rod.du(phi))
    return Check(
        printed=rod.mobility @ (rod.du(Sigma) + coad(E) @ Sigma + j),
        derived=rod.balanced_twist,
        fields=rod,
    )


@SECTION.states(
    "(64)",
    "the twist to first order, by stress and wrench",
    r"\delta V=\Gamma^{-1}[\mathcal{D}^{*}(T\delta E)+S\eta]",
    r"\delta V=\Gamma^{-1}[\mathcal{D}^{*}(T\delta E)+\mathrm{ad}^{*}_{\delta E}\Sigma_0+S\eta]",
    remark=STRESSED + " Without it a straight rod does not buckle, see (65).",
    affects=("(64b)", "(65)", "(66-A)", "(66-R)"),
    part="(64a)",
)
def linear_twist_by_stress() -> Check:
    rod = _perturbed()
    dE, Sigma0, T, S, eta = rod.strain, rod.stress, rod.tangent, rod.slope, rod.eta
    D, coad = rod.dual_derivative, rod.group.coad
    return Check(
        printed=rod.mobility @ (D(T @ dE) + S @ eta),
        derived=rod.rate,
        corrected=rod.mobility @ (D(T @ dE) + coad(dE) @ Sigma0 + S @ eta),
        condition=rod.unstressed,
    )


@SECTION.states(
    "(64)",
    "the same by the displacement",
    r"\delta V=\Gamma^{-1}[\mathcal{D}^{*}(T(\eta'+\mathrm{ad}_{E_0}\eta))+S\eta]",
    r"\delta V=\Gamma^{-1}[\mathcal{D}^{*}(T(\eta'+\mathrm{ad}_{E_0}\eta))"
    r"+\mathrm{ad}^{*}_{\eta'+\mathrm{ad}_{E_0}\eta}\Sigma_0+S\eta]",
    remark="As (64a): only about a base state without stress.",
    affects=("(65)", "(66-A)", "(66-R)"),
    part="(64b)",
)
def linear_twist_by_displacement() -> Check:
    rod = _perturbed()
    E0, Sigma0, T, S, eta = rod.turn, rod.stress, rod.tangent, rod.slope, rod.eta
    D, ad, coad, slope = rod.dual_derivative, rod.group.ad, rod.group.coad, rod.du(eta)
    return Check(
        printed=rod.mobility @ (D(T @ (slope + ad(E0) @ eta)) + S @ eta),
        derived=rod.rate,
        corrected=rod.mobility @ (D(T @ (slope + ad(E0) @ eta)) + coad(slope + ad(E0) @ eta) @ Sigma0 + S @ eta),
        condition=rod.unstressed,
    )


@SECTION.states(
    "(65)",
    "the linear equation of motion",
    r"\dot{\eta}=\Gamma^{-1}\mathcal{D}^{*}T\eta'+\Gamma^{-1}[\mathcal{D}^{*}T\,\mathrm{ad}_{E_0}+S]\eta",
    r"\dot{\eta}=\Gamma^{-1}(\mathcal{D}^{*}T+B)\eta'+\Gamma^{-1}[(\mathcal{D}^{*}T+B)\,\mathrm{ad}_{E_0}+S]\eta,"
    r"\quad BX:=\mathrm{ad}^{*}_X\Sigma_0",
    remark="As (64a): only about a base state without stress. D* acts on all that follows it, eta too. A straight "
    "planar rod under a thrust N, E_0 = (1 - N/k_1, 0, 0), shows the difference: with B it buckles with wave number q "
    "where k_3 q^2 = N (1 - N/k_1 + N/k_2), the load of Haringx with the shortening counted, that of Euler for stiff "
    "k_1 and k_2; as printed it does not buckle under any thrust.",
    affects=("(66-A)", "(66-R)"),
)
def linear_motion() -> Check:
    rod = _perturbed()
    E0, T, B, S, eta = rod.turn, rod.tangent, rod.geometric, rod.slope, rod.eta
    Y, D, ad, slope = rod.mobility, rod.dual_derivative, rod.group.ad, rod.du(eta)
    return Check(
        printed=Y @ D(T @ slope) + Y @ (D(T @ ad(E0) @ eta) + S @ eta),
        derived=rod.rate,
        corrected=Y @ (D(T @ slope) + B @ slope) + Y @ (D(T @ ad(E0) @ eta) + B @ ad(E0) @ eta + S @ eta),
        condition=rod.unstressed,
        also=_buckling(),
    )


@SECTION.states(
    "I43",
    "diffusion, advection, reaction",
    r"\dot{\eta}=D\eta''+A\eta'+R\eta",
)
def diffusion_advection_reaction() -> Check:
    rod = _perturbed()
    eta = rod.eta
    slope, curvature = rod.du(eta), rod.du(rod.du(eta))
    D, A, R = rod.by(curvature), rod.by(slope), rod.by(eta)
    return Check(printed=D @ curvature + A @ slope + R @ eta, derived=rod.rate)


@SECTION.states("(66)", "diffusion", r"D=\Gamma^{-1}T", part="(66-D)")
def diffusion() -> Check:
    rod = _perturbed()
    return Check(printed=rod.mobility @ rod.tangent, derived=rod.by(rod.du(rod.du(rod.eta))))


@SECTION.states(
    "(66)",
    "advection",
    r"A=\Gamma^{-1}(T'-\mathrm{ad}_ET+T\,\mathrm{ad}_{E_0})",
    r"A=\Gamma^{-1}(T'+\mathrm{ad}^{*}_{E_0}T+T\,\mathrm{ad}_{E_0}+B),\quad BX:=\mathrm{ad}^{*}_X\Sigma_0",
    remark="Wrong without stress too: in place of -ad_E belongs the coadjoint action, minus the transpose of ad_{E_0}. "
    "And as in (64) the stress of the base state is missing.",
    part="(66-A)",
)
def advection() -> Check:
    rod = _perturbed()
    E0, T, B, ad, coad = rod.turn, rod.tangent, rod.geometric, rod.group.ad, rod.group.coad
    return Check(
        printed=rod.mobility @ (rod.du(T) - ad(E0) @ T + T @ ad(E0)),
        derived=rod.by(rod.du(rod.eta)),
        corrected=rod.mobility @ (rod.du(T) + coad(E0) @ T + T @ ad(E0) + B),
    )


@SECTION.states(
    "(66)",
    "reaction",
    r"R=\Gamma^{-1}(T\,\mathrm{ad}_{E_0'}+T'\mathrm{ad}_{E_0}-\mathrm{ad}_ET\,\mathrm{ad}_{E_0}+S)",
    r"R=\Gamma^{-1}(T\,\mathrm{ad}_{E_0'}+T'\mathrm{ad}_{E_0}+\mathrm{ad}^{*}_{E_0}T\,\mathrm{ad}_{E_0}"
    r"+B\,\mathrm{ad}_{E_0}+S)",
    remark="As in A: the coadjoint action in place of -ad_E, and the stress of the base state. Even about the straight "
    "rod at rest shear then does not turn the frame back.",
    part="(66-R)",
)
def reaction() -> Check:
    rod = _perturbed()
    E0, T, B, S, ad, coad = rod.turn, rod.tangent, rod.geometric, rod.slope, rod.group.ad, rod.group.coad
    return Check(
        printed=rod.mobility @ (T @ ad(rod.du(E0)) + rod.du(T) @ ad(E0) - ad(E0) @ T @ ad(E0) + S),
        derived=rod.by(rod.eta),
        corrected=rod.mobility @ (T @ ad(rod.du(E0)) + rod.du(T) @ ad(E0) + coad(E0) @ T @ ad(E0) + B @ ad(E0) + S),
        also=[_shear_and_frame()],
    )


def _stress(E: Array) -> Array:
    """Any law to second order: at a point its value, its tangent and how this changes are what they are."""
    d = len(E)
    a, A, B = (np.array(sp.symbols(f"{x}0:{d**n}")).reshape((d,) * n) for n, x in enumerate("aAB", 1))
    return np.asarray(a + A @ E + (B @ E) @ E)


def _wrench(phi: Array) -> Array:
    """Any wrench of the configuration to first order in its entries: at a point its slope is what it is."""
    entries = phi[1:].ravel()
    return np.array(sp.symbols(f"w0:{6 * len(entries)}")).reshape(6, -1) @ entries


def _straight_rod() -> tuple[Perturbed, dict[sp.Symbol, Any]]:
    """A planar rod, the same all along, and its values if it is straight under a thrust N, of unit friction."""
    rod, (N, k1, k2, k3) = Perturbed(SE2), sp.symbols("N k1:4")
    for field in (rod.turn, rod.tangent):
        rod.law(field, u=np.zeros(field.shape, dtype=int))
    values: list[tuple[Array, Any]] = [
        (rod.turn, [1 - N / k1, 0, 0]),
        (rod.stress, [-N, 0, 0]),
        (rod.tangent, np.diag([k1, k2, k3])),
        (rod.slope, np.zeros((3, 3), dtype=int)),
        (np.diag(rod.mobility), [1, 1, 1]),
    ]
    fields = np.concatenate([field.ravel() for field, _ in values])
    return rod, {
        x: sp.sympify(y) for x, y in zip(fields, np.concatenate([np.ravel(v) for _, v in values]), strict=True)
    }


def _buckling() -> list[tuple[str, Any, Any]]:
    """What decides on waves eta ~ exp(i q u) that do not move: a determinant, in which d/du is x, so x^2 = -q^2."""
    rod, straight = _straight_rod()
    x, N, k1, k2, k3 = sp.symbols("x N k1:4")
    slope = rod.du(rod.eta)
    balance = rod.by(rod.du(slope)) * x**2 + rod.by(slope) * x + rod.by(rod.eta)
    unstressed = {y: sp.S.Zero for y in rod.stress}
    with_B, without = (sp.Matrix(balance).xreplace(more).xreplace(straight).det() for more in ({}, unstressed))
    load = k1 * k2 * x**4 * (k3 * x**2 + N * (1 - N / k1 + N / k2))
    return [
        ("a straight rod under thrust N has static waves where k3 q^2 = N (1 - N/k1 + N/k2)", with_B, load),
        ("without B it has none under any thrust", without, k1 * k2 * k3 * x**6),
    ]


def _shear_and_frame() -> tuple[str, Any, Any]:
    """How a straight rod at rest answers to a frame that is turned against the centreline."""
    rod, straight = _straight_rod()
    k2, ad, T = sp.Symbol("k2"), rod.group.ad(rod.turn), rod.tangent
    follows, printed = (sp.Matrix(m).xreplace(straight).subs("N", 0) for m in (rod.by(rod.eta), -ad @ T @ ad))
    words = "shear turns the frame of a straight rod at rest back, by k2; by the printed form it does not"
    return words, [follows[2, 2], printed[2, 2]], [-k2, 0]
