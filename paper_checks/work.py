"""Section V: work, conservative laws, boundary conditions."""

from itertools import combinations, pairwise
from typing import Any

import numpy as np
import sympy as sp

from geocosserat.algebra import symbolic
from geocosserat.algebra.fields import derivatives
from geocosserat.algebra.groups import SE2, SE3, Array, Group
from geocosserat.derivation.convert import to_sympy
from geocosserat.model.scene import load_scene
from geocosserat.referee.jets import Jets
from geocosserat.referee.motion import Motion, cross, dot
from geocosserat.referee.statement import Check, Section
from paper_checks.elastohydrodynamics import DerivedRod, DrivenRod

SECTION = Section("Work, constitutive laws and boundary conditions")
ZERO = np.zeros(3, dtype=int)


def elastic_energy(rod: Motion) -> sp.Expr:
    """Any energy of the turn, to second order: at a point its gradient and its second derivatives are what they are."""
    E = rod.turn
    return rod.constants("a", len(E)) @ E + E @ rod.symmetric("A", len(E)) @ E / 2


def potential_energy(rod: Motion) -> sp.Expr:
    """An energy of the configuration of any gradient. All others are, to second order, sums of such energies."""
    entries = rod.configuration[1:].ravel()
    p, q = rod.constants("p", len(entries)), rod.constants("q", len(entries))
    return p @ entries + (q @ entries) ** 2 / 2


def gradient(f: sp.Expr, by: Array) -> Array:
    """df/dx for each x; of entries that are numbers, zero."""
    return np.array([f.diff(x) if isinstance(x, sp.Symbol) else 0 for x in by.ravel()]).reshape(by.shape)


def by_twist(rod: Motion, f: sp.Expr) -> Array:
    """How fast f changes for each unit of the twist: as much as V moves the configuration."""
    return gradient(rod.dt(f), rod.twist)


def along_frame(rod: Motion, f: sp.Expr) -> Array:
    """The same by geocosserat's left-invariant fields."""
    return derivatives(rod.group, f, rod.configuration)


def basis(group: Group) -> Array:
    """b_a, (d, size, size)."""
    return np.stack(group.basis).astype(object)


@SECTION.states(
    "(45)",
    "the power of all forces and moments vanishes",
    r"\int_0^L(\underline{F}'+\underline{\Pi}\times\underline{F}+\underline{f})\cdot\underline{v}"
    r"+(M'+\underline{\Pi}\times\underline{M}+\underline{h}\times\underline{F}+\underline{m})\cdot\underline{\Omega}\,du=0",
    remark="The integrand vanishes everywhere. M' lacks its underline: as in (20) the components are meant.",
)
def power_of_the_balance() -> Check:
    rod = DrivenRod()
    (h, Pi), (v, Omega) = rod.split(rod.turn), rod.split(rod.twist)
    (F, M), (f, m) = rod.split(rod.stress), rod.split(rod.push)
    return Check(
        printed=dot(rod.du(F) + cross(Pi, F) + f, v) + dot(rod.du(M) + cross(Pi, M) + cross(h, F) + m, Omega),
        derived=dot(rod.push - rod.wrench, rod.twist),  # 0 where the wrench balances the stress
        fields=rod,
    )


@SECTION.states(
    "(46)",
    "the same on the Lie algebra",
    r"\int_0^L(\underline{\Sigma}'+\mathrm{ad}_E^{*}\underline{\Sigma}+\underline{j})\underline{V}\,du=0",
)
def power_on_the_algebra() -> Check:
    rod = DrivenRod()
    E, V, Sigma, j, coad = rod.turn, rod.twist, rod.stress, rod.push, rod.group.coad
    return Check(
        printed=(rod.du(Sigma) + coad(E) @ Sigma + j) @ V,
        derived=dot(j - rod.wrench, V),  # 0 where the wrench balances the stress
        fields=rod,
    )


@SECTION.states(
    "I22",
    "the coadjoint action takes an element of the algebra and one of its dual",
    r"\mathrm{ad}^{*}:\mathfrak{se}(3)\rightarrow\mathfrak{se}^{*}(3)",
    r"\mathrm{ad}^{*}:\mathfrak{se}(3)\times\mathfrak{se}^{*}(3)\rightarrow\mathfrak{se}^{*}(3)",
    remark="The argument in the dual is missing; I21, which introduces the action, has it. Nothing depends on it.",
)
def arguments_of_the_coadjoint_action() -> Check:
    rod = Motion()
    value = rod.group.coad(rod.turn) @ rod.stress
    arguments = set().union(*(e.free_symbols for e in value))
    return Check(printed=[6, 6], derived=[len(arguments), len(value)], corrected=[6 + 6, 6])


@SECTION.states("I23", "compatibility with the adjoint action", r"\dot{E}-V'=\mathrm{ad}_EV")
def compatibility() -> Check:
    rod = Motion()
    E, V, ad = rod.turn, rod.twist, rod.group.ad
    return Check(printed=ad(E) @ V, derived=rod.dt(E) - rod.du(V), fields=rod)


@SECTION.states(
    "(47)",
    "stress works on the turn, the wrench on the twist, the ends on theirs",
    r"\int_0^L(-\langle\Sigma,\dot{E}\rangle+\langle j,V\rangle)\,du+\langle\Sigma,V\rangle\big|_0^L=0",
    remark="The term of the ends is written as the integral of its derivative along the rod.",
)
def work() -> Check:
    rod = DrivenRod()
    E, V, Sigma, j = rod.turn, rod.twist, rod.stress, rod.push
    return Check(
        printed=-dot(Sigma, rod.dt(E)) + dot(j, V) + rod.du(dot(Sigma, V)),
        derived=dot(j - rod.wrench, V),  # 0 where the wrench balances the stress
        fields=rod,
    )


@SECTION.states(
    "I24",
    "the stress is a function of the turn",
    r"\Sigma=\Sigma(E)",
    remark="Narrower than (39), which allows the configuration too.",
)
def stress_of_the_turn() -> Check:
    rod = DerivedRod()
    law = rod.seen(e.right for e in rod.equations.stress_law)
    return Check(
        printed=[6, 0, 0],
        derived=[_count(law, x) for x in (rod.turn, rod.twist, rod.configuration)],
        defines=True,
    )


@SECTION.states(
    "I25",
    "the external wrench is a function of the configuration",
    r"j=j(\varphi)",
    remark="Narrower than (39), which allows the twist too, and so without friction.",
)
def wrench_of_the_configuration() -> Check:
    rod = Motion()
    j = -by_twist(rod, potential_energy(rod))
    return Check(
        printed=[12, 0, 0],
        derived=[_count(j, x) for x in (rod.configuration, rod.turn, rod.twist)],
        defines=True,
    )


@SECTION.states(
    "P10",
    "the integral in (47) is minus the rate of the stored energy",
    r"\int(-\langle\Sigma,\dot{E}\rangle+\langle j,V\rangle)\,du=-\dot{\mathcal{E}}",
    r"\int(-\langle\Sigma,\dot{E}\rangle+\langle j,V\rangle)\,du=-\dot{\mathcal{E}}-\int\langle\Gamma V,V\rangle\,du",
    remark="Without friction, as I25 has it. In (47) the wrench is all that acts, friction too: the stored energy then "
    "changes by the work at the ends less what friction takes.",
)
def conservative_work() -> Check:
    rod = Motion()
    E, V, Gamma = rod.turn, rod.twist, rod.symmetric("G", 6)
    elastic, potential = elastic_energy(rod), potential_energy(rod)
    Sigma, j = gradient(elastic, E), -Gamma @ V - by_twist(rod, potential)
    push = Gamma @ V - rod.du(rod.stress) - rod.group.coad(E) @ rod.stress  # (41)
    rate = dot(rod.stress, rod.dt(E)) - dot(push, V)
    return Check(
        printed=-rod.dt(elastic) - rod.dt(potential),
        derived=-dot(Sigma, rod.dt(E)) + dot(j, V),
        corrected=-rod.dt(elastic) - rod.dt(potential) - V @ Gamma @ V,
        condition=("there is no friction", {x: sp.S.Zero for x in Gamma.ravel()}),
        also=[("with it: work at the ends less what friction takes", rate, rod.du(rod.stress @ V) - V @ Gamma @ V)],
    )


@SECTION.states(
    "U1 [energy]",
    "the stored energy is elastic energy of the turn and potential energy of the configuration",
    r"\mathcal{E}=\int(\varepsilon_{\mathrm{el}}(E)+\varepsilon_{\mathrm{pot}}(\varphi))\,du",
)
def stored_energy() -> Check:
    rod = Motion()
    E, V, elastic, potential = rod.turn, rod.twist, elastic_energy(rod), potential_energy(rod)
    Sigma, j = gradient(elastic, E), -along_frame(rod, potential)
    return Check(
        printed=rod.dt(elastic + potential),
        derived=dot(Sigma, rod.dt(E)) - dot(j, V),  # what (47) takes
        defines=True,
    )


@SECTION.states(
    "I26",
    "the two energies change each by itself",
    r"\dot{\mathcal{E}}=\dot{\mathcal{E}}_{\mathrm{el}}+\dot{\mathcal{E}}_{\mathrm{pot}}",
)
def rates_add() -> Check:
    rod = Motion()
    elastic, potential = elastic_energy(rod), potential_energy(rod)
    return Check(printed=rod.dt(elastic) + rod.dt(potential), derived=rod.dt(elastic + potential))


@SECTION.states(
    "(48)",
    "rate of the elastic energy",
    r"\dot{\mathcal{E}}_{\mathrm{el}}=\int\langle\partial\varepsilon_{\mathrm{el}}/\partial E,\dot{E}\rangle\,du",
    part="(48a)",
)
def elastic_rate() -> Check:
    rod = Motion()
    energy = elastic_energy(rod)
    return Check(printed=dot(gradient(energy, rod.turn), rod.dt(rod.turn)), derived=rod.dt(energy))


@SECTION.states(
    "(48)",
    "rate of the potential energy",
    r"\dot{\mathcal{E}}_{\mathrm{pot}}=\int(\partial\varepsilon_{\mathrm{pot}}/\partial\varphi_{ij})\dot{\varphi}_{ij}\,du",
    part="(48b)",
)
def potential_rate() -> Check:
    rod = Motion()
    phi, energy = rod.configuration, potential_energy(rod)
    return Check(printed=np.einsum("ij,ij->", gradient(energy, phi), rod.dt(phi)), derived=rod.dt(energy))


@SECTION.states(
    "I27",
    "a conservative stress is the gradient of the elastic energy",
    r"\underline{\Sigma}=\partial\varepsilon_{\mathrm{el}}/\partial\underline{E}",
)
def conservative_stress() -> Check:
    rod = Motion()
    energy = elastic_energy(rod)
    return Check(
        printed=gradient(energy, rod.turn),
        derived=gradient(rod.dt(energy), rod.du(rod.twist)),  # <Sigma, dE/dt> for all V', as dE/dt = V' + ...
    )


@SECTION.states(
    "P11",
    "without equal mixed derivatives a stress is not conservative",
    r"\text{conservative}\;\Rightarrow\;\partial\Sigma_i/\partial E_j=\partial\Sigma_j/\partial E_i",
    remark="Decided by the work around a small square in the plane of E_i and E_j, which is the difference of the two. "
    "The condition is sufficient too where the law holds for all turns: these have no holes.",
)
def mixed_derivatives_must_agree() -> Check:
    law = Jets()
    K, E, s = law.constants("K", 6, 6), law.array("E", 6), sp.Symbol("s")
    S = law.symmetric("S", 6)
    along_rays = sp.integrate(sp.expand(s * (E @ S @ E)), (s, 0, 1))
    return Check(
        printed=K.T - K,
        derived=[[_work_around(K, i, j) for j in range(6)] for i in range(6)],
        also=[("if they agree, the work along rays is the energy", gradient(along_rays, E), S @ E)],
    )


@SECTION.states(
    "(49)",
    "mixed derivatives of a conservative stress agree",
    r"\partial\Sigma_i/\partial E_j=\partial\Sigma_j/\partial E_i",
)
def integrable_stress() -> Check:
    rod = Motion()
    E, energy = rod.turn, elastic_energy(rod) + sp.Symbol("c") * np.prod(rod.turn)
    Sigma = gradient(rod.dt(energy), rod.du(rod.twist))
    return Check(printed=[gradient(F, E) for F in Sigma], derived=np.array([gradient(F, E) for F in Sigma]).T)


@SECTION.states(
    "(50)",
    "rate of the potential energy by the twist",
    r"\dot{\mathcal{E}}_{\mathrm{pot}}=\int(\partial\varepsilon_{\mathrm{pot}}/\partial\varphi_{ij})\varphi_{ik}V_{kj}\,du",
    part="(50a)",
)
def potential_rate_by_twist() -> Check:
    rod = Motion()
    phi, V, energy = rod.configuration, rod.group.hat(rod.twist), potential_energy(rod)
    return Check(printed=np.einsum("ij,ik,kj->", gradient(energy, phi), phi, V), derived=rod.dt(energy))


@SECTION.states(
    "(50)",
    "the same by the components of the twist",
    r"\int(\partial\varepsilon_{\mathrm{pot}}/\partial\varphi_{ij})\varphi_{ik}(b_\alpha)_{kj}V_\alpha",
    r"\int(\partial\varepsilon_{\mathrm{pot}}/\partial\varphi_{ij})\varphi_{ik}(b_\alpha)_{kj}V_\alpha\,du",
    remark="Only the measure is missing, du; (51) is right.",
    part="(50b)",
)
def potential_rate_by_components() -> Check:
    rod = Motion()
    phi, b, V, energy, du = rod.configuration, basis(SE3), rod.twist, potential_energy(rod), sp.Symbol("du")
    return Check(
        printed=np.einsum("ij,ik,akj,a->", gradient(energy, phi), phi, b, V),
        derived=rod.dt(energy) * du,
        corrected=np.einsum("ij,ik,akj,a->", gradient(energy, phi), phi, b, V) * du,
    )


@SECTION.states(
    "(51)",
    "a conservative wrench is how the potential falls along the moving frame",
    r"j_\alpha=-\varphi_{ik}(b_\alpha)_{kj}\,\partial\varepsilon_{\mathrm{pot}}/\partial\varphi_{ij}"
    r"\equiv-X_\alpha[\varepsilon_{\mathrm{pot}}]",
)
def conservative_wrench() -> Check:
    rod = Motion()
    phi, b, energy = rod.configuration, basis(SE3), potential_energy(rod)
    return Check(
        printed=-np.einsum("ik,akj,ij->a", phi, b, gradient(energy, phi)),
        derived=gradient(-rod.dt(energy), rod.twist),  # <j, V> is what the potential loses, for all V
    )


@SECTION.states(
    "U2 [X_alpha]",
    "the derivative along the moving frame",
    r"X_\alpha=\varphi_{ik}(b_\alpha)_{kj}\,\partial/\partial\varphi_{ij}",
)
def frame_derivative() -> Check:
    rod = Motion()
    phi, b, f = rod.configuration, basis(SE3), potential_energy(rod)
    return Check(
        printed=np.einsum("ik,akj,ij->a", phi, b, gradient(f, phi)),
        derived=by_twist(rod, f),
        defines=True,
        also=[("as geocosserat has it", along_frame(rod, f), by_twist(rod, f))],
    )


@SECTION.states(
    "I28",
    "these derivatives commute as the basis does",
    r"[X_\alpha,X_\beta]=C_{\alpha\beta\gamma}X_\gamma",
)
def commutation_relations() -> Check:
    rod = Motion()
    C, f = rod.group.structure.astype(object), potential_energy(rod)
    X = by_twist(rod, f)
    twice = np.array([along_frame(rod, e) for e in X]).T  # X_a[X_b[f]]
    return Check(printed=np.einsum("abc,c->ab", C, X), derived=twice - twice.T)


@SECTION.states(
    "P13",
    "they translate along and turn about the vectors of the moving frame",
    r"X_{1,2,3}:\ \delta\boldsymbol{r}=\boldsymbol{e}_\alpha;\quad "
    r"X_{4,5,6}:\ \delta\boldsymbol{e}_i=\boldsymbol{e}_{\alpha-3}\times\boldsymbol{e}_i",
)
def generators() -> Check:
    rod, s = Motion(), sp.Symbol("s")
    units = np.eye(6, dtype=int)
    moved = [rod.configuration @ _slope(symbolic.exp(SE3, s * unit), s) for unit in units]
    return Check(
        printed=[
            *[[e, ZERO, ZERO, ZERO] for e in rod.frame],
            *[[ZERO, *[cross(axis, e) for e in rod.frame]] for axis in rod.frame],
        ],
        derived=[change[1:].T for change in moved],  # r, e_1, e_2, e_3 along phi exp(s b_a)
        fields=rod,
    )


@SECTION.states(
    "P12",
    "what the conditions (52) follow from",
    r"\text{from the antisymmetry of the bracket}",
    r"\text{from the commutation relations, I28}",
    remark="Antisymmetry alone leaves the constants open: with others, say those of the opposite sign, which are "
    "antisymmetric too, (52) fails.",
)
def what_makes_a_wrench_integrable() -> Check:
    rod = Motion()
    c = np.zeros((6, 6, 6), dtype=object)
    for a, b in combinations(range(6), 2):
        c[a, b] = sp.symbols(f"c{a}{b}(0:6)")
        c[b, a] = -c[a, b]
    C, j = rod.group.structure.astype(object), -by_twist(rod, potential_energy(rod))
    X = np.array([along_frame(rod, e) for e in j]).T  # X_a[j_b]
    return Check(printed=np.einsum("abc,c->ab", c, j), derived=X - X.T, corrected=np.einsum("abc,c->ab", C, j))


@SECTION.states(
    "(52)",
    "the derivatives of a conservative wrench",
    r"X_\alpha[j_\beta]-X_\beta[j_\alpha]=C_{\alpha\beta\gamma}j_\gamma",
    remark="Necessary, and in space sufficient if the law holds for all configurations. In the plane it is not: a "
    "constant couple satisfies it and works on every full turn.",
)
def integrable_wrench() -> Check:
    rod = Motion()
    C, j = rod.group.structure.astype(object), -by_twist(rod, potential_energy(rod))
    X = np.array([along_frame(rod, e) for e in j]).T  # X_a[j_b]
    couple = SE2.structure.astype(object) @ np.array([0, 0, sp.Symbol("m")])
    return Check(
        printed=np.einsum("abc,c->ab", C, j),
        derived=X - X.T,
        also=[("a constant couple in the plane satisfies it", couple, np.zeros((3, 3), dtype=int))],
    )


@SECTION.states(
    "U3 [X1-X3]",
    "the translational ones",
    r"X_\alpha=\boldsymbol{e}_\alpha\cdot\partial/\partial\boldsymbol{r}",
)
def translations() -> Check:
    rod = Motion()
    f = potential_energy(rod)
    by_r = gradient(f, rod.position)
    return Check(printed=[dot(e, by_r) for e in rod.frame], derived=by_twist(rod, f)[:3])


@SECTION.states(
    "U4 [X4]",
    "the rotational one about e1",
    r"X_4=\boldsymbol{e}_2\cdot\partial/\partial\boldsymbol{e}_3-\boldsymbol{e}_3\cdot\partial/\partial\boldsymbol{e}_2",
    r"X_4=\boldsymbol{e}_3\cdot\partial/\partial\boldsymbol{e}_2-\boldsymbol{e}_2\cdot\partial/\partial\boldsymbol{e}_3",
    remark="A turn about e1 takes e2 to e3 and e3 to -e2; printed is the opposite turn, as if by the hat of I09. With "
    "the printed three, I28 and (52) fail, and moments have the wrong sign. (51) is right.",
    affects=("I28", "(52)"),
)
def rotation_about_the_normal() -> Check:
    rod = Motion()
    f, (_, e2, e3) = potential_energy(rod), rod.frame
    by_e2, by_e3 = gradient(f, e2), gradient(f, e3)
    return Check(
        printed=dot(e2, by_e3) - dot(e3, by_e2),
        derived=by_twist(rod, f)[3],
        corrected=dot(e3, by_e2) - dot(e2, by_e3),
        also=[("with the printed signs [X_4, X_5] is -X_6", *_commutator_of_opposite_turns(rod, f))],
    )


@SECTION.states(
    "U5 [X5]",
    "the rotational one about e2",
    r"X_5=\boldsymbol{e}_3\cdot\partial/\partial\boldsymbol{e}_1-\boldsymbol{e}_1\cdot\partial/\partial\boldsymbol{e}_3",
    r"X_5=\boldsymbol{e}_1\cdot\partial/\partial\boldsymbol{e}_3-\boldsymbol{e}_3\cdot\partial/\partial\boldsymbol{e}_1",
    remark="The opposite turn, as X_4.",
    affects=("I28", "(52)"),
)
def rotation_about_the_second() -> Check:
    rod = Motion()
    f, (e1, _, e3) = potential_energy(rod), rod.frame
    by_e1, by_e3 = gradient(f, e1), gradient(f, e3)
    return Check(
        printed=dot(e3, by_e1) - dot(e1, by_e3),
        derived=by_twist(rod, f)[4],
        corrected=dot(e1, by_e3) - dot(e3, by_e1),
    )


@SECTION.states(
    "U6 [X6]",
    "the rotational one about e3",
    r"X_6=\boldsymbol{e}_1\cdot\partial/\partial\boldsymbol{e}_2-\boldsymbol{e}_2\cdot\partial/\partial\boldsymbol{e}_1",
    r"X_6=\boldsymbol{e}_2\cdot\partial/\partial\boldsymbol{e}_1-\boldsymbol{e}_1\cdot\partial/\partial\boldsymbol{e}_2",
    remark="The opposite turn, as X_4.",
    affects=("I28", "(52)"),
)
def rotation_about_the_third() -> Check:
    rod = Motion()
    f, (e1, e2, _) = potential_energy(rod), rod.frame
    by_e1, by_e2 = gradient(f, e1), gradient(f, e2)
    return Check(
        printed=dot(e1, by_e2) - dot(e2, by_e1),
        derived=by_twist(rod, f)[5],
        corrected=dot(e2, by_e1) - dot(e1, by_e2),
    )


@SECTION.states(
    "(53)",
    "the stress is linear in the strain",
    r"\underline{\Sigma}(\underline{E})=\underline{\underline{K}}(\underline{E}-\underline{\bar{E}})",
)
def linear_law() -> Check:
    rod = DerivedRod()
    E, Ebar, K = rod.turn, rod.reference, rod.stiffness
    return Check(printed=K @ (E - Ebar), derived=rod.seen(e.right for e in rod.equations.stress_law), defines=True)


@SECTION.states(
    "P14",
    "the stiffness is positive definite, and a rigid motion of the whole does not change it",
    r"\underline{\underline{K}}>0",
    remark="An assumption. It says nothing of an antisymmetric part, which stores no energy: (53) is conservative only "
    "if K is symmetric, (49).",
)
def stiffness_is_positive() -> Check:
    rod = DerivedRod()
    energy = rod.seen([rod.equations.energy])[0]
    x, odd = rod.array("x", 6), rod.constants("o", 6, 6)
    odd = odd - odd.T
    return Check(
        printed=rod.stiffness,
        derived=[gradient(slope, rod.turn) for slope in gradient(energy, rod.turn)],
        defines=True,
        also=[("an antisymmetric part stores no energy", x @ (rod.stiffness + odd) @ x, x @ rod.stiffness @ x)],
    )


@SECTION.states(
    "I29", "each mode of a planar rod has its own stiffness", r"\underline{\underline{K}}=\mathrm{diag}(k_1,k_2,k_3)"
)
def diagonal_stiffness() -> Check:
    rod, (k1, k2, k3) = _planar_rod()
    law = rod.seen(e.right for e in rod.equations.stress_law)
    return Check(printed=np.diag([k1, k2, k3]), derived=[gradient(F, rod.turn) for F in law], defines=True)


@SECTION.states("(54)", "stress of stretching", r"F_1=k_1(h_1-1)", part="(54a)")
def stretching() -> Check:
    rod, (k1, _, _) = _planar_rod()
    h1, _, _ = rod.turn
    return Check(printed=k1 * (h1 - 1), derived=rod.seen([rod.equations.stress_law[0].right])[0])


@SECTION.states("(54)", "stress of shearing", r"F_2=k_2h_2", part="(54b)")
def shearing() -> Check:
    rod, (_, k2, _) = _planar_rod()
    _, h2, _ = rod.turn
    return Check(printed=k2 * h2, derived=rod.seen([rod.equations.stress_law[1].right])[0])


@SECTION.states("(54)", "moment of bending", r"M=k_3\Pi", part="(54c)")
def bending() -> Check:
    rod, (_, _, k3) = _planar_rod()
    _, _, Pi = rod.turn
    return Check(printed=k3 * Pi, derived=rod.seen([rod.equations.stress_law[2].right])[0])


@SECTION.states(
    "P15",
    "the law (54) is hyperelastic",
    r"(k_1(h_1-1),k_2h_2,k_3\Pi)=\partial\varepsilon/\partial\underline{E}",
)
def hyperelastic() -> Check:
    rod, (k1, k2, k3) = _planar_rod()
    h1, h2, Pi = rod.turn
    energy = rod.seen([rod.equations.energy])[0]
    return Check(printed=[k1 * (h1 - 1), k2 * h2, k3 * Pi], derived=gradient(energy, rod.turn))


@SECTION.states(
    "(55)",
    "its energy",
    r"\mathcal{U}=\tfrac12\int k_1(h_1-1)^2+k_2h_2^2+k_3\Pi^2\,du",
)
def planar_energy() -> Check:
    rod, (k1, k2, k3) = _planar_rod()
    h1, h2, Pi = rod.turn
    stress, s = rod.seen(e.right for e in rod.equations.stress_law), sp.Symbol("s")
    strain = rod.turn - rod.reference
    there = dict(zip(rod.turn, rod.reference + s * strain, strict=True))
    work = sp.integrate(sp.expand(dot([F.xreplace(there) for F in stress], strain)), (s, 0, 1))
    return Check(
        printed=(k1 * (h1 - 1) ** 2 + k2 * h2**2 + k3 * Pi**2) / 2,
        derived=work,  # of the stress, from the reference state
        also=[("as geocosserat derives it", rod.seen([rod.equations.energy])[0], work)],
    )


@SECTION.states("I30", "the reference state", r"\bar{E}=(1,0,0)")
def reference_state() -> Check:
    rod = {"motion": "planar", "length": 1, "stiffness": [1, 1, 1], "friction": [1, 1, 1]}
    reference = load_scene({"rod": rod, "run": {"until": 1}}).model.reference
    return Check(printed=[1, 0, 0], derived=[to_sympy(e) for e in reference], defines=True)


@SECTION.states(
    "P16", "that is a rod without stretching, shearing and bending", r"\bar{E}=(1,0,0):\text{ straight, at rest}"
)
def straight_rod() -> Check:
    rod = _straight_rod()
    return Check(printed=[1, 0, 0], derived=_turn(rod), fields=rod)


@SECTION.states("I31", "no stretching", r"h_1=1")
def no_stretching() -> Check:
    rod = _straight_rod()
    return Check(printed=1, derived=_turn(rod)[0], fields=rod)


@SECTION.states("I32", "no shearing", r"h_2=0")
def no_shearing() -> Check:
    rod, g, gamma = _straight_rod(), sp.Symbol("g"), sp.Symbol("gamma")
    sheared = g * rod.frame[0] + gamma * rod.frame[1]
    rod.law(rod.position, u=sheared)
    return Check(
        printed=0,
        derived=_turn(rod)[1].subs(gamma, 0),
        also=[("h2 is the slope of the centreline across e1", _turn(rod)[1], gamma)],
        fields=rod,
    )


@SECTION.states("I33", "no bending", r"\Pi=0")
def no_bending() -> Check:
    rod, k = _straight_rod(), sp.Symbol("k")
    rod.law(rod.frame[0], u=k * rod.frame[1])
    return Check(
        printed=0,
        derived=_turn(rod)[2].subs(k, 0),
        also=[("Pi is the curvature of a rod without shear", _turn(rod)[2], k)],
        fields=rod,
    )


@SECTION.states("(56)", "a clamped end does not move", r"\varphi=\varphi_0=\mathrm{const}")
def clamped() -> Check:
    rod = DerivedRod()
    group, phi, end = rod.group, rod.configuration, rod.equations.left
    held = {e.left: e.right for e in end.equations}
    power = dot(rod.stress, rod.equations.twist).xreplace(held)
    return Check(
        printed=group.vee(group.inverse(phi) @ rod.dt(phi)),  # what vanishes at a clamped end
        derived=rod.seen(e.residual for e in end.equations),
        defines=True,
        also=[("no work is done there", power, 0)],
        fields=rod,
    )


@SECTION.states("(57)", "a free end has no stress", r"\Sigma=0")
def free() -> Check:
    rod = DerivedRod()
    end = rod.equations.right
    power = dot(rod.stress, rod.twist).xreplace({rod.seen([e.left])[0]: e.right for e in end.equations})
    return Check(
        printed=rod.stress,  # what vanishes at a free end
        derived=rod.seen(e.residual for e in end.equations),
        defines=True,
        also=[("no work is done there", power, 0)],
    )


def _count(expressions: Array, names: Array) -> int:
    """How many of these symbols the expressions depend on."""
    used = set().union(*(e.free_symbols for e in expressions))
    return len(used & set(names.ravel()))


def _work_around(K: Array, i: int, j: int) -> Any:
    """The work of S = K E around the unit square from 0 along E_i: the law is linear, midpoints are exact."""
    a, b = np.eye(len(K), dtype=int)[[i, j]]
    corners = [0 * a, a, a + b, b, 0 * a]
    return sum((K @ (x + y)) @ (y - x) for x, y in pairwise(corners)) / 2


def _slope(matrix: Array, s: sp.Symbol) -> Array:
    """d/ds at 0."""
    return np.array([[e.diff(s).subs(s, 0) for e in row] for row in matrix])


def _commutator_of_opposite_turns(rod: Motion, f: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """[X_4, X_5] f and -X_6 f if each X has the opposite sign."""
    first, second, third = -by_twist(rod, f)[3:]
    return -along_frame(rod, second)[3] + along_frame(rod, first)[4], -third


def _planar_rod() -> tuple[DerivedRod, tuple[sp.Symbol, ...]]:
    k = sp.symbols("k1:4")
    return DerivedRod(SE2, np.diag(k), [1, 0, 0]), k


def _straight_rod() -> Motion:
    """A planar rod whose centreline has length u, with cross-sections at a right angle to it."""
    rod = Motion(SE2)
    rod.law(rod.position, u=rod.frame[0])
    rod.law(rod.rotation, u=np.zeros((2, 2), dtype=int))
    return rod


def _turn(rod: Motion) -> Array:
    phi = rod.configuration
    return rod.group.vee(rod.group.inverse(phi) @ rod.du(phi))
