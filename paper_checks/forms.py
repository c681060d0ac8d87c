"""Section IV.B: differential forms, duals, constitutive laws.

A one-form is written out: its coefficients times the symbols du and dt. A two-form is its coefficient of du and dt.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import sympy as sp

from geocosserat.algebra.fields import act
from geocosserat.algebra.groups import SE3, Array
from geocosserat.referee.jets import Jets
from geocosserat.referee.motion import Motion, dot
from geocosserat.referee.statement import Check, Section
from paper_checks.lie_groups import change

SECTION = Section("Geometric field theory: differential forms")

du, dt = sp.symbols("du dt")


@SECTION.states("(30)", "the differential of phi", r"d\varphi=\varphi'du+\dot{\varphi}\,dt", part="(30a)")
def differential() -> Check:
    plane = Jets()
    u, t, eps = plane.scalar("u"), plane.scalar("t"), sp.Symbol("eps")
    plane.law(np.array([u, t]), u=np.array([1, 0]), t=np.array([0, 1]))
    a, b, c, d, e, f = plane.constants("c", 6, 4, 4)
    phi = a + b * u + c * t + d * u**2 + e * u * t + f * t**2
    step = {u: u + eps * du, t: t + eps * dt}
    return Check(
        printed=plane.du(phi) * du + plane.dt(phi) * dt,
        derived=[[x.subs(step, simultaneous=True).diff(eps).subs(eps, 0) for x in row] for row in phi],
        defines=True,
    )


@SECTION.states("(30)", "turn and twist in one form", r"\xi=E\,du+V\,dt", part="(30b)")
def turn_and_twist_as_a_form() -> Check:
    rod = Motion()
    E, V, inverse = SE3.hat(rod.turn), SE3.hat(rod.twist), SE3.inverse(rod.configuration)
    return Check(
        printed=E * du + V * dt,
        derived=inverse @ (change(rod, rod.turn) * du + change(rod, rod.twist) * dt),
        defines=True,
        fields=rod,
    )


@SECTION.states("(31)", "the kinematics in one equation", r"d\varphi=\varphi\,\xi", part="(31a)")
def kinematics_as_forms() -> Check:
    rod = Motion()
    phi, E, V = rod.configuration, SE3.hat(rod.turn), SE3.hat(rod.twist)
    return Check(
        printed=phi @ (E * du + V * dt),
        derived=change(rod, rod.turn) * du + change(rod, rod.twist) * dt,
        fields=rod,
    )


@SECTION.states("(31)", "the compatibility as Cartan's equation of structure", r"d\xi+\xi\wedge\xi=0", part="(31b)")
def structure_equation() -> Check:
    rod = Motion()
    xi = SE3.hat(rod.turn), SE3.hat(rod.twist)
    return Check(printed=-_wedge(xi, xi), derived=_exterior(rod, xi))


@SECTION.states(
    "I17",
    "the wedge of matrices is that of rows and columns",
    r"(\xi\wedge\xi)_{\alpha\beta}=\xi_{\alpha\gamma}\wedge\xi_{\gamma\beta}",
    remark="It is this product that makes d(d phi) = 0. The indices are the four of a matrix here, not the six of the "
    "basis.",
)
def wedge_of_matrices() -> Check:
    rod = Motion()
    phi, E, V = rod.configuration, SE3.hat(rod.turn), SE3.hat(rod.twist)
    d_phi = rod.du(phi), rod.dt(phi)
    product_rule = _wedge(d_phi, (E, V)) + phi @ _exterior(rod, (E, V))
    return Check(
        printed=np.einsum("ac,cb->ab", E, V) - np.einsum("ac,cb->ab", V, E),
        derived=-_exterior(rod, (E, V)),
        defines=True,
        also=[("d(d phi) = d phi ^ xi + phi d xi", _exterior(rod, d_phi), product_rule)],
        fields=rod,
    )


@SECTION.states(
    "I18",
    "a dual basis element is a linear function on the algebra",
    r"b_\alpha^*:\mathfrak{g}\to\mathbb{R}",
    remark="The six are a basis of the dual of the algebra, though the sentence says of the algebra.",
)
def dual_element_is_linear() -> Check:
    x, y = sp.symbols("x y")
    X, Y = (SE3.hat(np.array(sp.symbols(f"{name}1:7"))) for name in "XY")
    return Check(
        printed=[x * f(X) + y * f(Y) for f in _dual_basis()],
        derived=SE3.vee(x * X + y * Y),
        defines=True,
        also=[("six functions of one value each", np.shape([f(X) for f in _dual_basis()]), [6])],
    )


@SECTION.states(
    "(32)",
    "the dual basis",
    r"\langle b_\alpha^*,b_\beta\rangle=b_\alpha^*(b_\beta)=\begin{cases}1&\alpha=\beta\\0&\alpha\neq\beta\end{cases}",
)
def dual_basis() -> Check:
    return Check(
        printed=[[1 if alpha == beta else 0 for beta in range(6)] for alpha in range(6)],
        derived=[[f(b) for b in SE3.basis] for f in _dual_basis()],
        defines=True,
        also=[("they are the components", SE3.vee(np.array(SE3.basis)), np.eye(6, dtype=int))],
    )


@SECTION.states("I19", "the stress in the dual basis", r"\Sigma=\Sigma_\alpha b_\alpha^*")
def stress_in_the_dual_basis() -> Check:
    rod = Motion()
    X, Sigma = rod.array("X", 6), rod.stress
    dual = np.array([f(SE3.hat(X)) for f in _dual_basis()])
    return Check(printed=np.einsum("a,a->", Sigma, dual), derived=_work(rod, Sigma, X), defines=True, fields=rod)


@SECTION.states(
    "(33)",
    "the order of the components of the stress",
    r"\Sigma_\alpha\leftrightarrow\underline{\Sigma}=(F_1,F_2,F_3,M_1,M_2,M_3)",
)
def order_of_the_stress() -> Check:
    rod = Motion()
    F, M = rod.split(rod.stress)
    return Check(
        printed=[F[0], F[1], F[2], M[0], M[1], M[2]],
        derived=[_work(rod, rod.stress, b) for b in SE3.vee(np.array(SE3.basis))],
        defines=True,
        fields=rod,
    )


@SECTION.states("I20", "the wrench in the dual basis", r"j=j_\alpha b_\alpha^*")
def wrench_in_the_dual_basis() -> Check:
    rod = Motion()
    X, j = rod.array("X", 6), rod.array("j", 6)
    dual = np.array([f(SE3.hat(X)) for f in _dual_basis()])
    return Check(printed=np.einsum("a,a->", j, dual), derived=_work(rod, j, X), defines=True, fields=rod)


@SECTION.states(
    "(34)",
    "the order of the components of the wrench",
    r"j_\alpha\leftrightarrow\underline{j}=(f_1,f_2,f_3,m_1,m_2,m_3)",
)
def order_of_the_wrench() -> Check:
    rod = Motion()
    f, m = rod.array("f", 3), rod.array("m", 3)
    return Check(
        printed=[f[0], f[1], f[2], m[0], m[1], m[2]],
        derived=[_work(rod, np.array([*f, *m]), b) for b in SE3.vee(np.array(SE3.basis))],
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "(35)",
    "the covariant derivative along the rod",
    r"\mathcal{D}=\partial_u+\mathrm{ad}_E",
    remark="With it the compatibility (27) is dE/dt = D V.",
    part="(35a)",
)
def covariant_derivative() -> Check:
    rod = Motion()
    E, V = rod.turn, rod.twist
    return Check(printed=rod.du(V) + SE3.ad(E) @ V, derived=rod.dt(E), defines=True)


@SECTION.states(
    "(35)",
    "the exterior covariant derivative, along the rod",
    r"D=(\partial_u+\mathrm{ad}_E)\,du",
    remark="That of a function X is dX + [xi, X], which has a part along dt too. D is its part at a given time.",
    part="(35b)",
)
def exterior_covariant_derivative() -> Check:
    rod = Motion()
    E, V, X = rod.turn, rod.twist, rod.array("X", 6)
    xi, X_hat = SE3.hat(E) * du + SE3.hat(V) * dt, SE3.hat(X)
    whole = SE3.vee(rod.du(X_hat) * du + rod.dt(X_hat) * dt + xi @ X_hat - X_hat @ xi)
    return Check(
        printed=(rod.du(X) + SE3.ad(E) @ X) * du,
        derived=[x.subs(dt, 0) for x in whole],
        defines=True,
        also=[("with the part along dt", whole, (rod.du(X) + SE3.ad(E) @ X) * du + (rod.dt(X) + SE3.ad(V) @ X) * dt)],
    )


@SECTION.states(
    "(36)",
    "the covariant derivative of dual elements",
    r"\mathcal{D}^*=\partial_u+\mathrm{ad}_E^*",
    remark="The product rule for the pairing. So it is minus the adjoint of D, up to the ends.",
    part="(36a)",
)
def dual_derivative() -> Check:
    rod = Motion()
    E, S, X = rod.turn, rod.stress, rod.array("X", 6)
    return Check(
        printed=dot(rod.du(S) + SE3.coad(E) @ S, X),
        derived=rod.du(dot(S, X)) - dot(S, rod.du(X) + SE3.bracket(E, X)),
        defines=True,
    )


@SECTION.states(
    "(36)", "the same as a form", r"D^*=(\partial_u+\mathrm{ad}_E^*)\,du", part="(36b)",
    remark="As in (35), the part at a given time.",
)  # fmt: skip
def dual_exterior_derivative() -> Check:
    rod = Motion()
    E, S, X = rod.turn, rod.stress, rod.array("X", 6)
    differential, D_X = rod.du(dot(S, X)) * du, (rod.du(X) + SE3.bracket(E, X)) * du
    return Check(
        printed=dot((rod.du(S) + SE3.coad(E) @ S) * du, X), derived=differential - dot(S, D_X), defines=True
    )


@SECTION.states(
    "I21",
    "the coadjoint action takes an element and a dual one to a dual one",
    r"\mathrm{ad}^*:\mathfrak{se}(3)\times\mathfrak{se}^*(3)\to\mathfrak{se}^*(3)",
)
def type_of_the_coadjoint_action() -> Check:
    X, S = (np.array(sp.symbols(f"{name}1:7")) for name in "XS")
    value = SE3.coad(X) @ S
    enters = {s for e in value for s in e.free_symbols}
    return Check(printed=[6, 6, 6], derived=[len(enters & set(X)), len(enters & set(S)), len(value)])


@SECTION.states(
    "(37)",
    "the sign of the coadjoint action",
    r"\langle\mathrm{ad}_X^*\sigma,Y\rangle=-\langle\sigma,\mathrm{ad}_XY\rangle",
    remark="The sign that the balance needs, and that makes it an action. Some books define ad* without the minus.",
)
def sign_of_the_coadjoint_action() -> Check:
    rod = Motion()
    E, V, S, Y = rod.turn, rod.twist, rod.stress, rod.array("Y", 6)
    commutator = SE3.coad(E) @ SE3.coad(V) - SE3.coad(V) @ SE3.coad(E)
    return Check(
        printed=-dot(S, SE3.bracket(E, Y)),
        derived=dot(-rod.wrench - rod.du(S), Y),
        defines=True,
        also=[("it is an action: [ad*_X, ad*_Y] = ad*_[X, Y]", commutator, SE3.coad(SE3.bracket(E, V)))],
        fields=rod,
    )


@SECTION.states("(38)", "the balance as forms", r"D^*\underline{\Sigma}+\underline{j}\,du=0", part="(38a)")
def balance_as_forms() -> Check:
    rod = Motion()
    E, Sigma = rod.turn, rod.stress
    return Check(printed=-(rod.du(Sigma) + SE3.coad(E) @ Sigma) * du, derived=rod.wrench * du, fields=rod)


@SECTION.states("(38)", "the balance", r"\mathcal{D}^*\underline{\Sigma}+\underline{j}=0", part="(38b)")
def balance() -> Check:
    rod = Motion()
    E, Sigma = rod.turn, rod.stress
    return Check(printed=-(rod.du(Sigma) + SE3.coad(E) @ Sigma), derived=rod.wrench, fields=rod)


@SECTION.states(
    "(39)",
    "the stress is a function of configuration and turn",
    r"\underline{\Sigma}=\underline{\Sigma}(\varphi,E)",
    remark="Then all derivatives of the stress in the balance are those of phi and E, as here to first order. From "
    "(41) on, and in Table I, the stress is a function of E alone; only then is the law indifferent, P05.",
    part="(39a)",
)
def stress_is_a_function() -> Check:
    rod = Motion()
    phi, E = rod.configuration, rod.turn
    slope, T = rod.constants("G", 6, 4, 4), rod.constants("T", 6, 6)
    Sigma = np.einsum("aij,ij->a", slope, phi) + T @ E
    return Check(
        printed=np.einsum("ab,b->a", act(SE3, phi, slope), E) + T @ rod.du(E),
        derived=rod.du(Sigma),
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "(39)",
    "the wrench is a function of configuration and twist",
    r"\underline{j}=\underline{j}(\varphi,V)",
    remark="The function of phi are loads that the world makes: weight, traps, fields. The loads of an end are not in "
    "it.",
    part="(39b)",
)
def wrench_is_a_function() -> Check:
    rod = Motion()
    phi, V = rod.configuration, rod.twist
    slope, J = rod.constants("G", 6, 4, 4), rod.constants("J", 6, 6)
    j = np.einsum("aij,ij->a", slope, phi) + J @ V
    return Check(
        printed=np.einsum("ab,b->a", act(SE3, phi, slope), V) + J @ rod.dt(V),
        derived=rod.dt(j),
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "P05",
    "laws of this form are the same in all positions of the whole",
    r"\underline{\Sigma}(\varphi,E),\ \underline{j}(\varphi,V)\text{ are indifferent to }\varphi\to g\varphi",
    remark="E and V do not change, but phi does: a force fixed in the world has other components in the moving frame "
    "once the rod is turned. A law is indifferent exactly if it does not depend on phi at all, as some g takes any phi "
    "to any other. Loads from outside need not be; the material must.",
)
def laws_are_indifferent() -> Check:
    rod = Motion()
    phi, R, w, s = rod.configuration, rod.rotation, rod.constants("w", 3), rod.constants("s", 3)
    K, Gamma = rod.constants("K", 6), rod.constants("Gamma", 6)
    moved = rod.rigid_motion() @ phi
    E, V = (SE3.vee(SE3.inverse(moved) @ x) for x in (rod.du(moved), rod.dt(moved)))
    return Check(
        printed=[_law(K, R, s, rod.turn), _law(-Gamma, R, w, rod.twist)],
        derived=[_law(K, SE3.rotation(moved), s, E), _law(-Gamma, SE3.rotation(moved), w, V)],
        condition=("the laws do not depend on phi", {x: sp.S.Zero for x in (*s, *w)}),
        fields=rod,
    )


def _law(factors: Array, rotation: Array, vector: Array, components: Array) -> Array:
    """Linear in the components, and with a force that is a vector fixed in the world."""
    return np.asarray(factors * components + np.array([*(rotation.T @ vector), 0, 0, 0]))


def _wedge(a: Sequence[Array], b: Sequence[Array]) -> Array:
    """Of two one-forms of matrices, given by their coefficients of du and dt."""
    return np.asarray(a[0] @ b[1] - a[1] @ b[0])


def _exterior(rod: Jets, a: Sequence[Array]) -> Array:
    """The exterior derivative of a one-form."""
    return np.asarray(rod.du(a[1]) - rod.dt(a[0]))


def _dual_basis() -> list[Callable[[Array], Any]]:
    """b*_alpha as functions of a matrix: projections, as the basis is orthogonal in the trace of the product."""

    def projection(b: Array) -> Callable[[Array], Any]:
        return lambda X: np.trace(b.T @ X) / sp.Integer(np.trace(b.T @ b))

    return [projection(b) for b in SE3.basis]


def _work(rod: Motion, dual: Array, components: Array) -> sp.Expr:
    """That force and moment do, as vectors, on the vectors of these components of an element of se(3)."""
    return sum(dot(rod.world(a), rod.world(b)) for a, b in zip(rod.split(dual), rod.split(components), strict=True))
