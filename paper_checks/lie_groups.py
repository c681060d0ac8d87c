"""Section IV.A: configurations, turns and twists as elements of SE(3) and se(3)."""

from typing import Any

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3, Array
from geocosserat.referee.jets import Jets
from geocosserat.referee.motion import Motion, cross, dot, epsilon, hat, rotation_of
from geocosserat.referee.statement import Check, Section

SECTION = Section("Geometric field theory: Lie groups")


@SECTION.states(
    "I07",
    "phi is a rigid motion",
    r"\varphi\in SE(3)",
    remark="The frame must be right-handed, as (8) has it too: a left-handed one makes phi a reflection.",
)
def configuration_is_rigid() -> Check:
    rod = Motion()
    e_1, e_2, e_3 = rod.frame
    products = [dot(a, b) for a in rod.frame for b in rod.frame]
    return Check(
        printed=[1, 0, 0, 0, *np.eye(3, dtype=int).ravel(), 1],
        derived=[*rod.configuration[0], *products, dot(e_1, cross(e_2, e_3))],
        defines=True,
        also=[("a left-handed frame has the determinant -1", dot(e_2, cross(e_1, e_3)), -1)],
        fields=rod,
    )


@SECTION.states(
    "(21)",
    "the columns of phi are the centreline and the frame",
    r"\varphi=\begin{bmatrix}1&0&0&0\\ \boldsymbol{r}&\boldsymbol{e}_1&\boldsymbol{e}_2&\boldsymbol{e}_3\end{bmatrix}",
)
def configuration_matrix() -> Check:
    rod = Motion()
    e_1, e_2, e_3 = rod.frame
    x = rod.array("x", 3)
    return Check(
        printed=np.column_stack([[1, *rod.position], [0, *e_1], [0, *e_2], [0, *e_3]]),
        derived=rod.configuration,
        defines=True,
        also=[("it takes x to r + x_i e_i", rod.configuration @ [1, *x], [1, *(rod.position + rod.world(x))])],
        fields=rod,
    )


@SECTION.states("(22)", "E says how phi changes along the rod", r"\varphi'=\varphi E", part="(22a)")
def turn_of_the_configuration() -> Check:
    rod = Motion()
    return Check(printed=rod.configuration @ SE3.hat(rod.turn), derived=change(rod, rod.turn), fields=rod)


@SECTION.states("(22)", "V says how phi changes in time", r"\dot{\varphi}=\varphi V", part="(22b)")
def twist_of_the_configuration() -> Check:
    rod = Motion()
    return Check(printed=rod.configuration @ SE3.hat(rod.twist), derived=change(rod, rod.twist), fields=rod)


@SECTION.states("I08", "turn and twist are infinitesimal rigid motions", r"E,V\in\mathfrak{se}(3)")
def turn_and_twist_are_in_the_algebra() -> Check:
    path = Jets()
    q = path.array("q", 4)
    phi = SE3.pose(path.array("r", 3), rotation_of(q) / dot(q, q))
    E, V = SE3.inverse(phi) @ path.du(phi), SE3.inverse(phi) @ path.dt(phi)
    return Check(
        printed=[-E[1:, 1:].T, -V[1:, 1:].T],
        derived=[E[1:, 1:], V[1:, 1:]],
        also=[("their first rows vanish", [E[0], V[0]], np.zeros((2, 4), dtype=int))],
    )


@SECTION.states(
    "(23)",
    "the turn as a matrix",
    r"E=\begin{bmatrix}0&0\\ \underline{h}&\hat{\Pi}\end{bmatrix}",
    remark="With the hat as I09 has it this is not the E of (22): the sign of the turning would be the opposite one. "
    "(68) has the right signs.",
    part="(23a)",
)
def turn_matrix() -> Check:
    rod, sign = Motion(), sp.Symbol("sign")
    h, Pi = rod.split(rod.turn)
    return Check(
        printed=np.block([[0, np.zeros(3, dtype=int)], [h[:, None], signed_hat(Pi, sign)]]),
        derived=SE3.inverse(rod.configuration) @ change(rod, rod.turn),
        condition=(RIGHT_HAT, {sign: -1}),
        fields=rod,
    )


@SECTION.states(
    "(23)",
    "the twist as a matrix",
    r"V=\begin{bmatrix}0&0\\ \underline{v}&\hat{\Omega}\end{bmatrix}",
    remark="With the hat as I09 has it this is not the V of (22): the sign of the turning would be the opposite one.",
    part="(23b)",
)
def twist_matrix() -> Check:
    rod, sign = Motion(), sp.Symbol("sign")
    v, Omega = rod.split(rod.twist)
    return Check(
        printed=np.block([[0, np.zeros(3, dtype=int)], [v[:, None], signed_hat(Omega, sign)]]),
        derived=SE3.inverse(rod.configuration) @ change(rod, rod.twist),
        condition=(RIGHT_HAT, {sign: -1}),
        fields=rod,
    )


@SECTION.states(
    "I09",
    "the hat of a triple is the matrix of its vector product",
    r"\hat{A}_{ij}=\epsilon_{ijk}A_k",
    r"\hat{A}_{ij}=-\epsilon_{ijk}A_k",
    remark="Transposed. From (1), e_i.e_j' = e_i.(Pi x e_j), which is the right one: the matrix of A x. All that has a "
    "hat is right with this one; (68), written out, has its signs.",
    affects=("(23a)", "(23b)", "(29)", "TI.Deformation.Lie Group", "TI.Velocity.Lie Group"),
)
def hat_of_a_triple() -> Check:
    rod = Motion()
    _, A = rod.split(rod.turn)
    planar, A_3 = SE2.hat(np.array([0, 0, A[2]])), np.array([0, 0, A[2]])
    return Check(
        printed=np.einsum("ijk,k->ij", epsilon(), A),
        derived=[[dot(a, cross(rod.world(A), b)) for b in rod.frame] for a in rod.frame],
        corrected=-np.einsum("ijk,k->ij", epsilon(), A),
        also=[("(68) is part of the matrix of A x", planar[1:, 1:], hat(A_3)[:2, :2])],
        fields=rod,
    )


@SECTION.states(
    "I10",
    "a rigid motion of the whole leaves turn and twist as they are",
    r"\varphi\to g\varphi:\quad E\to E,\ V\to V",
    remark="g stands on the left. On the right it is a change of frame in each cross-section, and changes both.",
)
def turn_and_twist_are_invariant() -> Check:
    rod = Motion()
    E, V, a = rod.turn, rod.twist, np.array([*rod.constants("c", 3), 0, 0, 0])
    moved = rod.rigid_motion() @ rod.configuration
    shifted = rod.configuration @ SE3.pose(a[:3], np.eye(3, dtype=object))
    on_the_right = SE3.vee(SE3.inverse(shifted) @ rod.du(shifted))
    return Check(
        printed=[E, V],
        derived=[SE3.vee(SE3.inverse(moved) @ x) for x in (rod.du(moved), rod.dt(moved))],
        also=[("a shift a on the right adds [E, a]", on_the_right, E + SE3.bracket(E, a))],
        fields=rod,
    )


@SECTION.states("I11", "the algebra has six dimensions", r"\alpha=1,\ldots,6")
def dimension_of_the_algebra() -> Check:
    X = np.array(sp.symbols("X:16")).reshape(4, 4)
    conditions = sp.Matrix([*X[0], *(X + X.T)[1:, 1:].ravel()]).jacobian(list(X.ravel()))
    basis = sp.Matrix([b.ravel().tolist() for b in SE3.basis])
    return Check(
        printed=6,
        derived=16 - conditions.rank(),
        also=[("and as many matrices in the basis, independent", basis.rank(), 16 - conditions.rank())],
    )


@SECTION.states("I12", "the components of the turn", r"E=E_\alpha b_\alpha")
def turn_in_the_basis() -> Check:
    rod = Motion()
    b = np.array(SE3.basis, dtype=object)
    return Check(
        printed=np.einsum("a,aij->ij", rod.turn, b),
        derived=SE3.inverse(rod.configuration) @ change(rod, rod.turn),
        defines=True,
        fields=rod,
    )


@SECTION.states("I13", "the components of the twist", r"V=V_\alpha b_\alpha")
def twist_in_the_basis() -> Check:
    rod = Motion()
    b = np.array(SE3.basis, dtype=object)
    return Check(
        printed=np.einsum("a,aij->ij", rod.twist, b),
        derived=SE3.inverse(rod.configuration) @ change(rod, rod.twist),
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "(24)",
    "the order of the components of the turn",
    r"E_\alpha\leftrightarrow\underline{E}=(h_1,h_2,h_3,\Pi_1,\Pi_2,\Pi_3)",
    remark="This fixes the basis, which the paper does not write down: b_1, b_2, b_3 translate along the frame, "
    "b_4, b_5, b_6 turn about it.",
)
def order_of_the_turn() -> Check:
    rod = Motion()
    h, Pi = rod.split(rod.turn)
    return Check(
        printed=[h[0], h[1], h[2], Pi[0], Pi[1], Pi[2]],
        derived=SE3.vee(SE3.inverse(rod.configuration) @ change(rod, rod.turn)),
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "(25)",
    "the order of the components of the twist",
    r"V_\alpha\leftrightarrow\underline{V}=(v_1,v_2,v_3,\Omega_1,\Omega_2,\Omega_3)",
)
def order_of_the_twist() -> Check:
    rod = Motion()
    v, Omega = rod.split(rod.twist)
    return Check(
        printed=[v[0], v[1], v[2], Omega[0], Omega[1], Omega[2]],
        derived=SE3.vee(SE3.inverse(rod.configuration) @ change(rod, rod.twist)),
        defines=True,
        fields=rod,
    )


@SECTION.states("I14", "the bracket is the commutator of matrices", r"[X,Y]=XY-YX")
def bracket() -> Check:
    x, y = _two_elements()
    X, Y = SE3.hat(x), SE3.hat(y)
    return Check(printed=X @ Y - Y @ X, derived=SE3.hat(SE3.bracket(x, y)), defines=True)


@SECTION.states(
    "(26)",
    "the structure constants",
    r"[b_\alpha,b_\beta]=C_{\alpha\beta\gamma}b_\gamma,\quad\alpha,\beta,\gamma=1,\ldots,6",
)
def structure_constants() -> Check:
    b, C = np.array(SE3.basis, dtype=object), SE3.structure.astype(object)
    return Check(
        printed=np.einsum("abc,cij->abij", C, b),
        derived=[[x @ y - y @ x for y in b] for x in b],
        defines=True,
        also=[
            ("translations commute", C[:3, :3], np.zeros((3, 3, 6), dtype=int)),
            ("turns make a turn: [b_4, b_5] = b_6", C[3:, 3:, 3:], epsilon()),
            ("a turn and a translation make a translation: [b_4, b_2] = b_3", C[3:, :3, :3], epsilon()),
        ],
    )


@SECTION.states("(27)", "mixed derivatives of phi agree", r"\dot{E}-V'=[E,V]")
def compatibility() -> Check:
    rod = Motion()
    phi, E, V = rod.configuration, SE3.hat(rod.turn), SE3.hat(rod.twist)
    return Check(
        printed=E @ V - V @ E,
        derived=rod.dt(E) - rod.du(V),
        also=[("this makes the mixed derivatives of phi agree", rod.dt(rod.du(phi)), rod.du(rod.dt(phi)))],
        fields=rod,
    )


@SECTION.states(
    "(28)",
    "the same in components",
    r"\dot{E}_\alpha-V_\alpha'=C_{\alpha\beta\gamma}E_\beta V_\gamma",
    r"\dot{E}_\alpha-V_\alpha'=C_{\beta\gamma\alpha}E_\beta V_\gamma",
    remark="The order of the indices does not go with the constants of (26), which change when it does. As printed it "
    "lacks h x Omega in the rate of h, and has h x v, of another dimension, in the rate of Pi. The other places where "
    "the constants occur, I28 and (52), have the right order, and so has ad in (29).",
)
def compatibility_in_components() -> Check:
    rod = Motion()
    C, E, V = SE3.structure.astype(object), rod.turn, rod.twist
    (h, Pi), (v, Omega) = rod.split(E), rod.split(V)
    as_printed = np.concatenate([cross(Pi, v), cross(Pi, Omega) + cross(h, v)])
    as_it_is = np.concatenate([cross(Pi, v) + cross(h, Omega), cross(Pi, Omega)])
    return Check(
        printed=np.einsum("abc,b,c->a", C, E, V),
        derived=rod.dt(E) - rod.du(V),
        corrected=np.einsum("bca,b,c->a", C, E, V),
        also=[
            ("as printed: Pi x v, Pi x Omega + h x v", np.einsum("abc,b,c->a", C, E, V), as_printed),
            ("as it is: Pi x v + h x Omega, Pi x Omega", rod.dt(E) - rod.du(V), as_it_is),
        ],
        fields=rod,
    )


@SECTION.states("I15", "the bracket is the adjoint action of the algebra on itself", r"\mathrm{ad}_XY=[X,Y]")
def adjoint_action() -> Check:
    (x, y), eps = _two_elements(), sp.Symbol("eps")
    X, Y = SE3.hat(x), SE3.hat(y)
    small = np.eye(4, dtype=int).astype(object) + eps * X
    return Check(
        printed=SE3.vee(X @ Y - Y @ X),
        derived=[e.diff(eps).subs(eps, 0) for e in SE3.Ad(small) @ y],
        also=[("that is the matrix ad_X on the components of Y", SE3.ad(x) @ y, SE3.vee(X @ Y - Y @ X))],
    )


@SECTION.states(
    "I16",
    "what ad takes and gives",
    r"\mathrm{ad}:\mathfrak{se}(3)\to\mathfrak{se}(3)",
    r"\mathrm{ad}:\mathfrak{se}(3)\times\mathfrak{se}(3)\to\mathfrak{se}(3),\quad"
    r"\mathrm{ad}_E:\mathfrak{se}(3)\to\mathfrak{se}(3)",
    remark="ad takes two elements, E and the one that it acts on. What goes from se(3) to se(3) and has the matrix "
    "(29) is ad_E. Only the name is at fault: nothing else depends on it.",
)
def type_of_ad() -> Check:
    x, y = _two_elements()
    value = SE3.bracket(x, y)
    takes = len({s for e in value for s in e.free_symbols})
    of_one_E = np.array(sp.Matrix(value).jacobian(list(y)))
    return Check(
        printed=[6, 6],
        derived=[takes, len(value)],
        corrected=[6 + 6, 6],
        also=[("for one E it is linear, with the matrix ad_E", of_one_E @ y, SE3.ad(x) @ y)],
    )


@SECTION.states(
    "(29)",
    "the matrix of ad_E",
    r"\mathrm{ad}_E=\begin{bmatrix}\hat{\Pi}&\hat{h}\\0&\hat{\Pi}\end{bmatrix}",
    remark="In the order of (24), and with the matrix of A x for the hat. With the hat as I09 has it, this is -ad_E.",
)
def matrix_of_ad() -> Check:
    rod, sign = Motion(), sp.Symbol("sign")
    h, Pi = rod.split(rod.turn)
    Y = rod.array("Y", 6)
    E_Y = SE3.vee(SE3.hat(rod.turn) @ SE3.hat(Y) - SE3.hat(Y) @ SE3.hat(rod.turn))
    matrix = np.array(sp.Matrix(E_Y).jacobian(list(Y)))
    return Check(
        printed=np.block([[signed_hat(Pi, sign), signed_hat(h, sign)], [0 * hat(h), signed_hat(Pi, sign)]]),
        derived=matrix,
        condition=(RIGHT_HAT, {sign: -1}),
        also=[("the same as from the structure constants", matrix, SE3.ad(rod.turn))],
        fields=rod,
    )


RIGHT_HAT = "the hat is the matrix of A x, not I09"


def signed_hat(A: Array, sign: Any) -> Array:
    """The hat with this sign before epsilon: 1 as I09 has it, -1 for the matrix of A x."""
    return np.asarray(sign * np.einsum("ijk,k->ij", epsilon(), A))


def change(rod: Motion, components: Array) -> Array:
    """What phi changes by if r' = a and e_i' = b x e_i, as (1) and (2) have it: a, b of these components."""
    a, b = (rod.world(x) for x in rod.split(components))
    return np.column_stack([[0, *a], *([0, *cross(b, e)] for e in rod.frame)])


def _two_elements() -> tuple[Array, Array]:
    """Components of two elements of se(3)."""
    return np.array(sp.symbols("x1:7")), np.array(sp.symbols("y1:7"))
