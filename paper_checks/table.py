"""Table I: the four representations beside each other, row by row.

A one-form is its coefficients times the symbols du and dt. What a form is does not depend on how the cross-sections are
numbered: with other numbers n, u = lambda n, a function stays as it is, and lambda times the coefficient of du is that
of dn.
"""

from typing import Any

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import SE3, Array
from geocosserat.referee.motion import Motion, cross, dot, epsilon
from geocosserat.referee.statement import Check, Section
from paper_checks.lie_groups import RIGHT_HAT, change, signed_hat

SECTION = Section("Table I")

du, dt, lam = sp.symbols("du dt lambda")


@SECTION.states("TI.Configuration.Vector", "a point and three vectors", r"\boldsymbol{r},\boldsymbol{e}_i")
def configuration_as_vectors() -> Check:
    rod = Motion()
    origin_and_axes = np.eye(4, dtype=int).astype(object)
    return Check(
        printed=[rod.position, *rod.frame],
        derived=[(rod.configuration @ x)[1:] for x in origin_and_axes],
        defines=True,
    )


@SECTION.states(
    "TI.Configuration.Moving Frame",
    "the same point and vectors",
    r"\boldsymbol{r},\boldsymbol{e}_i",
    remark="Vectors in this column too: it is their changes that are written in components.",
)
def configuration_with_moving_frame() -> Check:
    rod = Motion()
    axes = np.eye(3, dtype=int).astype(object)
    return Check(
        printed=[rod.position, *rod.frame],
        derived=[rod.world(rod.body(rod.position)), *(rod.world(x) for x in axes)],
        defines=True,
        fields=rod,
    )


@SECTION.states("TI.Configuration.Lie Group", "a rigid motion", r"\varphi")
def configuration_in_the_group() -> Check:
    rod = Motion()
    return Check(
        printed=rod.configuration, derived=SE3.pose(rod.position, np.column_stack(rod.frame)), defines=True
    )


@SECTION.states(
    "TI.Configuration.Differential Form", "a function: a form of degree zero", r"\varphi",
    remark="Other numbers for the cross-sections leave it as it is.",
)  # fmt: skip
def configuration_as_a_form() -> Check:
    rod = Motion()
    phi, E = rod.configuration, SE3.hat(rod.turn)
    return Check(
        printed=rod.configuration,
        derived=SE3.pose(rod.position, np.column_stack(rod.frame)),
        defines=True,
        also=[("and its differential is phi E du", lam * change(rod, rod.turn) * (du / lam), phi @ E * du)],
        fields=rod,
    )


@SECTION.states("TI.Deformation.Vector", "vectors", r"\boldsymbol{h},\boldsymbol{\Pi}")
def deformation_as_vectors() -> Check:
    rod = Motion()
    half = sp.Rational(1, 2)
    return Check(
        printed=[rod.world(x) for x in rod.split(rod.turn)],
        derived=[rod.du(rod.position), half * sum(cross(e, rod.du(e)) for e in rod.frame)],
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "TI.Deformation.Moving Frame", "their components in the moving frame", r"\underline{h},\ \underline{\Pi}"
)
def deformation_in_components() -> Check:
    rod = Motion()
    return Check(printed=[*rod.split(rod.turn)], derived=_components(rod, rod.du), defines=True, fields=rod)


@SECTION.states(
    "TI.Deformation.Lie Group",
    "the turn, a matrix",
    r"E=\begin{pmatrix}0&0\\ \underline{h}&\hat{\Pi}\end{pmatrix}",
    remark="As (23): with the hat of I09 the turning has the wrong sign.",
)
def deformation_as_a_matrix() -> Check:
    rod, sign = Motion(), sp.Symbol("sign")
    h, Pi = rod.split(rod.turn)
    return Check(
        printed=np.block([[0, np.zeros(3, dtype=int)], [h[:, None], signed_hat(Pi, sign)]]),
        derived=SE3.inverse(rod.configuration) @ change(rod, rod.turn),
        condition=(RIGHT_HAT, {sign: -1}),
        fields=rod,
    )


@SECTION.states(
    "TI.Deformation.Differential Form", "the part of xi along the rod", r"E\,du",
    remark="The same in all numbers of the cross-sections; E alone is not.",
)  # fmt: skip
def deformation_as_a_form() -> Check:
    rod = Motion()
    return Check(
        printed=SE3.hat(rod.turn) * du,
        derived=SE3.inverse(rod.configuration) @ (lam * change(rod, rod.turn)) * (du / lam),
        defines=True,
        fields=rod,
    )


@SECTION.states("TI.Velocity.Vector", "vectors", r"\boldsymbol{v},\boldsymbol{\Omega}")
def velocity_as_vectors() -> Check:
    rod = Motion()
    half = sp.Rational(1, 2)
    return Check(
        printed=[rod.world(x) for x in rod.split(rod.twist)],
        derived=[rod.dt(rod.position), half * sum(cross(e, rod.dt(e)) for e in rod.frame)],
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "TI.Velocity.Moving Frame", "their components in the moving frame", r"\underline{v},\ \underline{\Omega}"
)
def velocity_in_components() -> Check:
    rod = Motion()
    return Check(printed=[*rod.split(rod.twist)], derived=_components(rod, rod.dt), defines=True, fields=rod)


@SECTION.states(
    "TI.Velocity.Lie Group",
    "the twist, a matrix",
    r"V=\begin{pmatrix}0&0\\ \underline{v}&\hat{\Omega}\end{pmatrix}",
    remark="As (23): with the hat of I09 the turning has the wrong sign.",
)
def velocity_as_a_matrix() -> Check:
    rod, sign = Motion(), sp.Symbol("sign")
    v, Omega = rod.split(rod.twist)
    return Check(
        printed=np.block([[0, np.zeros(3, dtype=int)], [v[:, None], signed_hat(Omega, sign)]]),
        derived=SE3.inverse(rod.configuration) @ change(rod, rod.twist),
        condition=(RIGHT_HAT, {sign: -1}),
        fields=rod,
    )


@SECTION.states("TI.Velocity.Differential Form", "the part of xi in time", r"V\,dt")
def velocity_as_a_form() -> Check:
    rod = Motion()
    return Check(
        printed=SE3.hat(rod.twist) * dt,
        derived=SE3.inverse(rod.configuration) @ (lam * change(rod, rod.twist)) * (dt / lam),
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "TI.Kinematics.Vector",
    "(1) and (2)",
    r"\boldsymbol{r}'=\boldsymbol{h},\ \boldsymbol{e}_i'=\boldsymbol{\Pi}\times\boldsymbol{e}_i;\quad"
    r"\dot{\boldsymbol{r}}=\boldsymbol{v},\ \dot{\boldsymbol{e}}_i=\boldsymbol{\Omega}\times\boldsymbol{e}_i",
)
def kinematics_of_vectors() -> Check:
    rod = Motion()
    h, Pi = (rod.world(x) for x in rod.split(rod.turn))
    v, Omega = (rod.world(x) for x in rod.split(rod.twist))
    return Check(
        printed=[[h, *(cross(Pi, e) for e in rod.frame)], [v, *(cross(Omega, e) for e in rod.frame)]],
        derived=_rates(rod),
        fields=rod,
    )


@SECTION.states(
    "TI.Kinematics.Moving Frame",
    "the same with components",
    r"\boldsymbol{r}'=h_i\boldsymbol{e}_i,\ \boldsymbol{e}_i'=\epsilon_{ijk}\Pi_j\boldsymbol{e}_k;\quad"
    r"\dot{\boldsymbol{r}}=v_i\boldsymbol{e}_i,\ \dot{\boldsymbol{e}}_i=\epsilon_{ijk}\Omega_j\boldsymbol{e}_k",
    r"\boldsymbol{r}'=h_i\boldsymbol{e}_i,\ \boldsymbol{e}_i'=-\epsilon_{ijk}\Pi_j\boldsymbol{e}_k;\quad"
    r"\dot{\boldsymbol{r}}=v_i\boldsymbol{e}_i,\ \dot{\boldsymbol{e}}_i=-\epsilon_{ijk}\Omega_j\boldsymbol{e}_k",
    remark="The signs of (12) and (13), and wrong as they are there: e_j x e_i has the components -epsilon_ijk. The "
    "column of vectors is right.",
)
def kinematics_with_components() -> Check:
    rod = Motion()
    (h, Pi), (v, Omega) = rod.split(rod.turn), rod.split(rod.twist)
    e, eps = np.array(rod.frame), epsilon()
    return Check(
        printed=[
            [h @ e, *np.einsum("ijk,j,kl->il", eps, Pi, e)],
            [v @ e, *np.einsum("ijk,j,kl->il", eps, Omega, e)],
        ],
        derived=_rates(rod),
        corrected=[
            [h @ e, *-np.einsum("ijk,j,kl->il", eps, Pi, e)],
            [v @ e, *-np.einsum("ijk,j,kl->il", eps, Omega, e)],
        ],
        fields=rod,
    )


@SECTION.states("TI.Kinematics.Lie Group", "(22)", r"\varphi'=\varphi E;\quad\dot{\varphi}=\varphi V")
def kinematics_in_the_group() -> Check:
    rod = Motion()
    phi, E, V = rod.configuration, SE3.hat(rod.turn), SE3.hat(rod.twist)
    return Check(printed=[phi @ E, phi @ V], derived=[change(rod, x) for x in (rod.turn, rod.twist)], fields=rod)


@SECTION.states("TI.Kinematics.Differential Form", "(30) and (31)", r"d\varphi=\varphi\,\xi;\quad\xi=E\,du+V\,dt")
def kinematics_of_forms() -> Check:
    rod = Motion()
    phi, E, V = rod.configuration, SE3.hat(rod.turn), SE3.hat(rod.twist)
    return Check(
        printed=phi @ (E * du + V * dt),
        derived=change(rod, rod.turn) * du + change(rod, rod.twist) * dt,
        fields=rod,
    )


@SECTION.states(
    "TI.Compatibility.Vector",
    "mixed derivatives agree, as vectors",
    r"\dot{\boldsymbol{h}}-\boldsymbol{v}'=0;\quad"
    r"\dot{\boldsymbol{\Pi}}-\boldsymbol{\Omega}'=\boldsymbol{\Omega}\times\boldsymbol{\Pi}",
    remark="Right here, and the opposite of (3), which is wrong.",
)
def compatibility_of_vectors() -> Check:
    rod = Motion()
    h, Pi = (rod.world(x) for x in rod.split(rod.turn))
    v, Omega = (rod.world(x) for x in rod.split(rod.twist))
    return Check(
        printed=[0 * h, cross(Omega, Pi)],
        derived=[rod.dt(h) - rod.du(v), rod.dt(Pi) - rod.du(Omega)],
        fields=rod,
    )


@SECTION.states(
    "TI.Compatibility.Moving Frame",
    "mixed derivatives agree, in components",
    r"\dot{\underline{h}}-\underline{v}'=\underline{\Pi}\times\underline{v}-\underline{\Omega}\times\underline{h};\quad"
    r"\dot{\underline{\Pi}}-\underline{\Omega}'=\underline{\Omega}\times\underline{\Pi}",
    r"\dot{\underline{h}}-\underline{v}'=\underline{\Pi}\times\underline{v}-\underline{\Omega}\times\underline{h};\quad"
    r"\dot{\underline{\Pi}}-\underline{\Omega}'=\underline{\Pi}\times\underline{\Omega}",
    remark="The first is right. The second has the sign of the vectors: of components it is (18).",
)
def compatibility_of_components() -> Check:
    rod = Motion()
    (h, Pi), (v, Omega) = rod.split(rod.turn), rod.split(rod.twist)
    return Check(
        printed=[cross(Pi, v) - cross(Omega, h), cross(Omega, Pi)],
        derived=[rod.dt(h) - rod.du(v), rod.dt(Pi) - rod.du(Omega)],
        corrected=[cross(Pi, v) - cross(Omega, h), cross(Pi, Omega)],
    )


@SECTION.states("TI.Compatibility.Lie Group", "(27)", r"\dot{E}-V'=[E,V]")
def compatibility_in_the_group() -> Check:
    rod = Motion()
    E, V = SE3.hat(rod.turn), SE3.hat(rod.twist)
    return Check(printed=E @ V - V @ E, derived=rod.dt(E) - rod.du(V))


@SECTION.states("TI.Compatibility.Differential Form", "(31)", r"d\xi+\xi\wedge\xi=0")
def compatibility_of_forms() -> Check:
    rod = Motion()
    E, V = SE3.hat(rod.turn), SE3.hat(rod.twist)
    return Check(printed=-(E @ V - V @ E) * du * dt, derived=(rod.du(V) - rod.dt(E)) * du * dt)


@SECTION.states("TI.Stress-Moment.Vector", "vectors", r"\boldsymbol{F},\boldsymbol{M}")
def stress_as_vectors() -> Check:
    rod = Motion()
    (F, M), x = rod.split(rod.stress), rod.array("x", 6)
    work = dot(rod.stress, np.concatenate([rod.body(x[:3]), rod.body(x[3:])]))
    return Check(printed=[*rod.world(F), *rod.world(M)], derived=_gradient(work, x), defines=True)


@SECTION.states(
    "TI.Stress-Moment.Moving Frame", "their components in the moving frame", r"\underline{F},\ \underline{M}"
)
def stress_in_components() -> Check:
    rod = Motion()
    F, M = rod.split(rod.stress)
    vectors = rod.world(F), rod.world(M)
    return Check(
        printed=[F, M], derived=[[dot(e, x) for e in rod.frame] for x in vectors], defines=True, fields=rod
    )


@SECTION.states("TI.Stress-Moment.Lie Group", "six components of a dual element", r"\underline{\Sigma}")
def stress_in_the_dual() -> Check:
    rod = Motion()
    (F, M), X = rod.split(rod.stress), rod.array("X", 6)
    return Check(printed=[*F, *M], derived=_gradient(_work(rod, F, M, X), X), defines=True, fields=rod)


@SECTION.states(
    "TI.Stress-Moment.Differential Form", "a function: a form of degree zero", r"\underline{\Sigma}",
    remark="The work <Sigma, E du> does not depend on the numbers of the cross-sections, and E du does not.",
)  # fmt: skip
def stress_as_a_form() -> Check:
    rod, dn = Motion(), sp.Symbol("dn")
    per_number = rod.array("X", 6)
    E, du_of_n = per_number / lam, lam * dn
    work = dot(rod.stress, E) * du_of_n
    return Check(printed=rod.stress, derived=[x / dn for x in _gradient(work, per_number)], defines=True)


@SECTION.states(
    "TI.Force-Torque.Vector",
    "force and torque per length are vectors",
    r"\boldsymbol{j},\boldsymbol{m}",
    r"\boldsymbol{f},\boldsymbol{m}",
    remark="j is the wrench of (34), force and torque together. (4), (5) and the balance in this column have f.",
)
def force_as_vectors() -> Check:
    rod = Motion()
    j, (f, m) = rod.wrench, rod.split(rod.wrench)
    force, moment = _balancing(rod)
    return Check(
        printed=[len(j), len(m)],
        derived=[len(force), len(moment)],
        corrected=[len(f), len(m)],
    )


@SECTION.states(
    "TI.Force-Torque.Moving Frame", "their components in the moving frame", r"\underline{f},\ \underline{m}"
)
def force_in_components() -> Check:
    rod = Motion()
    f, m = rod.split(rod.wrench)
    force, moment = _balancing(rod)
    return Check(printed=[f, m], derived=[rod.body(force), rod.body(moment)], defines=True, fields=rod)


@SECTION.states("TI.Force-Torque.Lie Group", "the wrench: six components of a dual element", r"\underline{j}")
def force_in_the_dual() -> Check:
    rod = Motion()
    f, m, X = rod.array("f", 3), rod.array("m", 3), rod.array("X", 6)
    return Check(printed=[*f, *m], derived=_gradient(_work(rod, f, m, X), X), defines=True, fields=rod)


@SECTION.states(
    "TI.Force-Torque.Differential Form", "a one-form along the rod", r"\underline{j}\,du",
    remark="The wrench is per length, so it is j du that does not depend on the numbers of the cross-sections.",
)  # fmt: skip
def force_as_a_form() -> Check:
    rod = Motion()
    E, Sigma, j = rod.turn, rod.stress, rod.wrench
    per_number = -(lam * rod.du(Sigma) + SE3.coad(lam * E) @ Sigma)
    return Check(printed=j * du, derived=per_number * (du / lam), defines=True, fields=rod)


@SECTION.states(
    "TI.Balance law.Vector",
    "(5)",
    r"\boldsymbol{F}'+\boldsymbol{f}=0;\quad\boldsymbol{M}'+\boldsymbol{h}\times\boldsymbol{F}+\boldsymbol{m}=0",
)
def balance_of_vectors() -> Check:
    rod = Motion()
    F, M = (rod.world(x) for x in rod.split(rod.stress))
    h, _ = (rod.world(x) for x in rod.split(rod.turn))
    return Check(
        printed=[-rod.du(F), -(rod.du(M) + cross(h, F))],
        derived=[rod.world(x) for x in rod.split(rod.wrench)],
        fields=rod,
    )


@SECTION.states(
    "TI.Balance law.Moving Frame",
    "(20)",
    r"\underline{F}'+\underline{\Pi}\times\underline{F}+\underline{f}=0;\quad"
    r"\underline{M}'+\underline{\Pi}\times\underline{M}+\underline{h}\times\underline{F}+\underline{m}=0",
)
def balance_of_components() -> Check:
    rod = Motion()
    (F, M), (h, Pi) = rod.split(rod.stress), rod.split(rod.turn)
    return Check(
        printed=[-(rod.du(F) + cross(Pi, F)), -(rod.du(M) + cross(Pi, M) + cross(h, F))],
        derived=[*rod.split(rod.wrench)],
        fields=rod,
    )


@SECTION.states("TI.Balance law.Lie Group", "(38)", r"\mathcal{D}^*\underline{\Sigma}+\underline{j}=0")
def balance_in_the_dual() -> Check:
    rod = Motion()
    E, Sigma = rod.turn, rod.stress
    return Check(printed=-(rod.du(Sigma) + SE3.coad(E) @ Sigma), derived=rod.wrench, fields=rod)


@SECTION.states(
    "TI.Balance law.Differential Form", "(38), as a form", r"D^\star\underline{\Sigma}+\underline{j}\,du=0",
    remark="The star of D is another one here than in (36), and means the same.",
)  # fmt: skip
def balance_of_forms() -> Check:
    rod = Motion()
    E, Sigma = rod.turn, rod.stress
    return Check(printed=-(rod.du(Sigma) + SE3.coad(E) @ Sigma) * du, derived=rod.wrench * du, fields=rod)


@SECTION.states(
    "TI.Constitutive law.Vector",
    "the vectors of the stress are functions of those of the deformation",
    r"\boldsymbol{F}=\boldsymbol{F}(\boldsymbol{h},\boldsymbol{\Pi});\quad"
    r"\boldsymbol{M}=\boldsymbol{M}(\boldsymbol{h},\boldsymbol{\Pi})",
    r"\boldsymbol{F}=\boldsymbol{F}(\boldsymbol{h},\boldsymbol{\Pi},\boldsymbol{e}_i);\quad"
    r"\boldsymbol{M}=\boldsymbol{M}(\boldsymbol{h},\boldsymbol{\Pi},\boldsymbol{e}_i)",
    remark="If F depends on the vectors h and Pi alone it must not change when the frame is turned and they are kept. "
    "So no axis of the cross-section counts, not even the normal in F_1 = k_1 (h_1 - 1): (54) is no such law, nor is "
    "(53) unless it is isotropic and without a rest state. The frame must be an argument too.",
)
def law_of_vectors() -> Check:
    rod = Motion()
    R, e = rod.rotation, np.array(rod.frame)
    h, Pi = rod.array("a", 3), rod.array("b", 3)
    K, L, H, P = (rod.constants(name, 3) for name in "KLHP")
    isotropic = {x: y for k in (K, L) for x, y in ((k[1], k[0]), (k[2], k[0]))}
    return Check(
        printed=[_linear(K, H, h), _linear(L, P, Pi)],
        derived=[R @ _linear(K, H, R.T @ h), R @ _linear(L, P, R.T @ Pi)],
        corrected=[np.einsum("i,ij->j", _linear(K, H, e @ h), e), np.einsum("i,ij->j", _linear(L, P, e @ Pi), e)],
        condition=("the law singles out no axis of the frame", isotropic | {x: sp.S.Zero for x in (*H, *P)}),
        fields=rod,
    )


@SECTION.states(
    "TI.Constitutive law.Moving Frame",
    "the components of the stress are functions of those of the deformation",
    r"\underline{F}=\underline{F}(\underline{h},\underline{\Pi});\quad"
    r"\underline{M}=\underline{M}(\underline{h},\underline{\Pi})",
    remark="For any functions these laws are the same once the whole is moved. The column of vectors says less.",
)
def law_of_components() -> Check:
    rod = Motion()
    h, Pi = rod.split(rod.turn)
    K, L, H, P = (rod.constants(name, 3) for name in "KLHP")
    turned = SE3.rotation(rod.rigid_motion())
    e = turned @ rod.rotation
    return Check(
        printed=[_linear(K, H, h), _linear(L, P, Pi)],
        derived=[_linear(K, H, e.T @ (turned @ rod.world(h))), _linear(L, P, e.T @ (turned @ rod.world(Pi)))],
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "TI.Constitutive law.Lie Group",
    "the stress is a function of the turn",
    r"\underline{\Sigma}=\underline{\Sigma}(E)",
    remark="The laws of the column before it, all six at once. Of the turn alone: (39) has the configuration too, and "
    "is then not indifferent, P05.",
)
def law_in_the_dual() -> Check:
    rod = Motion()
    E, rest = SE3.hat(rod.turn), rod.constants("rest", 6)
    K = rod.constants("K", 6, 6)
    a, b = (x - y for x, y in zip(rod.split(rod.turn), rod.split(rest), strict=True))
    return Check(
        printed=K @ (SE3.vee(E) - rest),
        derived=[*(K[:3, :3] @ a + K[:3, 3:] @ b), *(K[3:, :3] @ a + K[3:, 3:] @ b)],
        defines=True,
    )


@SECTION.states(
    "TI.Constitutive law.Differential Form",
    "the stress is a function of the turn",
    r"\underline{\Sigma}=\underline{\Sigma}(E)",
    remark="Of E, not of the form E du: the law is one for the numbers u that the cross-sections have. With other "
    "numbers, u = lambda n, the stress is the same and the stiffness is divided by lambda.",
)
def law_of_forms() -> Check:
    rod = Motion()
    E, rest, K = rod.turn, rod.constants("rest", 6), rod.constants("K", 6, 6)
    per_number = SE3.vee(SE3.inverse(rod.configuration) @ (lam * change(rod, rod.turn)))
    X = rod.array("X", 6)
    return Check(
        printed=K @ (E - rest),
        derived=K @ (per_number / lam - rest),
        defines=True,
        also=[("the stiffness per number", np.array([_gradient(s, X) for s in K @ (X / lam - rest)]), K / lam)],
        fields=rod,
    )


def _rates(rod: Motion) -> list[list[Array]]:
    """Of centreline and frame, along the rod and in time."""
    return [[along(x) for x in (rod.position, *rod.frame)] for along in (rod.du, rod.dt)]


def _components(rod: Motion, along: Any) -> list[Array]:
    """Of a change of centreline and frame: e_i.r' and e_k.e_j' over i j k, with primes for either derivative."""
    e = np.array(rod.frame)
    return [e @ along(rod.position), np.einsum("ijk,kl,jl->i", epsilon(), e, along(e)) / sp.Integer(2)]


def _balancing(rod: Motion) -> tuple[Array, Array]:
    """The force and the moment per length that balance the stress, as (5) has it, in the world."""
    F, M, h = (rod.world(x) for x in (*rod.split(rod.stress), rod.split(rod.turn)[0]))
    return -rod.du(F), -rod.du(M) - cross(h, F)


def _work(rod: Motion, force: Array, moment: Array, X: Array) -> sp.Expr:
    """That force and moment do, as vectors, on the vectors of these components of an element of se(3)."""
    a, b = rod.split(X)
    return dot(rod.world(force), rod.world(a)) + dot(rod.world(moment), rod.world(b))


def _gradient(f: sp.Expr, x: Array) -> list[sp.Expr]:
    return [sp.diff(f, y) for y in x]


def _linear(stiffness: Array, rest: Array, components: Array) -> Array:
    return np.asarray(stiffness * (components - rest))
