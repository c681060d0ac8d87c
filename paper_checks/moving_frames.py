"""Section III: the same in components of the moving frame."""

import numpy as np

from geocosserat.algebra.groups import SE2, SE3, Array
from geocosserat.referee.motion import Motion, cross, dot, epsilon
from geocosserat.referee.statement import Check, Section, compare

SECTION = Section("Moving frames")


@SECTION.states("(6)", "components add up to the vector", r"\boldsymbol{A}=\boldsymbol{e}_iA_i", part="(6a)")
def vector_of_components() -> Check:
    rod = Motion()
    A = rod.array("A", 3)
    return Check(printed=np.einsum("ij,i->j", rod.frame, A), derived=rod.world(A), defines=True, fields=rod)


@SECTION.states("(6)", "projections are components", r"\boldsymbol{e}_i\cdot\boldsymbol{A}=A_i", part="(6b)")
def components_of_vector() -> Check:
    rod = Motion()
    A = rod.array("A", 3)
    return Check(printed=np.einsum("ij,j->i", rod.frame, rod.world(A)), derived=A, fields=rod)


@SECTION.states("I04", "the triple of components, in order", r"\underline{A}=(A_1,A_2,A_3)")
def triple_of_components() -> Check:
    rod = Motion()
    (A1, A2, A3), (e1, e2, e3) = rod.array("A", 3), rod.frame
    return Check(printed=[A1, A2, A3], derived=rod.body(A1 * e1 + A2 * e2 + A3 * e3), defines=True, fields=rod)


@SECTION.states(
    "(7)",
    "the scalar product in components",
    r"\boldsymbol{A}\cdot\boldsymbol{B}=A_iB_i=\underline{A}\cdot\underline{B}",
)
def scalar_product() -> Check:
    rod = Motion()
    A, B = rod.array("A", 3), rod.array("B", 3)
    product = dot(rod.world(A), rod.world(B))
    return Check(printed=[np.einsum("i,i->", A, B), dot(A, B)], derived=[product, product], fields=rod)


@SECTION.states(
    "(8)",
    "the vector product in components",
    r"\boldsymbol{e}_i\cdot(\boldsymbol{A}\times\boldsymbol{B})=\epsilon_{ijk}A_jB_k"
    r"=(\underline{A}\times\underline{B})_i",
    remark="For right-handed frames, as those of SE(3) are; orthonormality alone leaves the sign open.",
)
def vector_product() -> Check:
    rod = Motion()
    A, B = rod.array("A", 3), rod.array("B", 3)
    product = rod.body(cross(rod.world(A), rod.world(B)))
    mirrored = rod.rotation @ np.diag([1, 1, -1]).astype(object)
    opposite = mirrored.T @ cross(mirrored @ A, mirrored @ B)
    return Check(
        printed=[np.einsum("ijk,j,k->i", epsilon(), A, B), cross(A, B)],
        derived=[product, product],
        also=[("in a left-handed frame the opposite", opposite, -cross(A, B))],
        fields=rod,
    )


@SECTION.states(
    "(9)",
    "derivative along the rod in the moving frame",
    r"\boldsymbol{e}_i\cdot\boldsymbol{A}'=A_i'+\epsilon_{ijk}\Pi_jA_k"
    r"=(\underline{A}'+\underline{\Pi}\times\underline{A})_i",
    part="(9a)",
)
def slope_of_vector() -> Check:
    rod = Motion()
    A, (_, Pi) = rod.array("A", 3), rod.split(rod.turn)
    slope = rod.body(rod.du(rod.world(A)))
    return Check(
        printed=[rod.du(A) + np.einsum("ijk,j,k->i", epsilon(), Pi, A), rod.du(A) + cross(Pi, A)],
        derived=[slope, slope],
        fields=rod,
    )


@SECTION.states(
    "(9)",
    "rate in time in the moving frame",
    r"\boldsymbol{e}_i\cdot\dot{\boldsymbol{A}}=\dot{A}_i+\epsilon_{ijk}\Omega_jA_k"
    r"=(\underline{\dot{A}}+\underline{\Omega}\times\underline{A})_i",
    part="(9b)",
)
def rate_of_vector() -> Check:
    rod = Motion()
    A, (_, Omega) = rod.array("A", 3), rod.split(rod.twist)
    rate = rod.body(rod.dt(rod.world(A)))
    return Check(
        printed=[rod.dt(A) + np.einsum("ijk,j,k->i", epsilon(), Omega, A), rod.dt(A) + cross(Omega, A)],
        derived=[rate, rate],
        fields=rod,
    )


@SECTION.states("(10)", "h in components", r"\boldsymbol{h}=\boldsymbol{e}_ih_i", part="(10a)")
def slope_in_components() -> Check:
    rod = Motion()
    h, _ = rod.split(rod.turn)
    return Check(printed=np.einsum("ij,i->j", rod.frame, h), derived=rod.du(rod.position), defines=True, fields=rod)


@SECTION.states("(10)", "Pi in components", r"\boldsymbol{\Pi}=\boldsymbol{e}_i\Pi_i", part="(10b)")
def curvature_in_components() -> Check:
    rod = Motion()
    _, Pi = rod.split(rod.turn)
    axis = sum(cross(e, rod.du(e)) for e in rod.frame) / 2
    return Check(printed=np.einsum("ij,i->j", rod.frame, Pi), derived=axis, defines=True, fields=rod)


@SECTION.states("(11)", "v in components", r"\boldsymbol{v}=\boldsymbol{e}_iv_i", part="(11a)")
def velocity_in_components() -> Check:
    rod = Motion()
    v, _ = rod.split(rod.twist)
    return Check(printed=np.einsum("ij,i->j", rod.frame, v), derived=rod.dt(rod.position), defines=True, fields=rod)


@SECTION.states("(11)", "Omega in components", r"\boldsymbol{\Omega}=\boldsymbol{e}_i\Omega_i", part="(11b)")
def angular_velocity_in_components() -> Check:
    rod = Motion()
    _, Omega = rod.split(rod.twist)
    axis = sum(cross(e, rod.dt(e)) for e in rod.frame) / 2
    return Check(printed=np.einsum("ij,i->j", rod.frame, Omega), derived=axis, defines=True, fields=rod)


@SECTION.states("(12)", "the centreline follows h", r"\boldsymbol{r}'=h_i\boldsymbol{e}_i", part="(12a)")
def centreline_slope() -> Check:
    rod = Motion()
    h, _ = rod.split(rod.turn)
    return Check(printed=np.einsum("i,ij->j", h, rod.frame), derived=rod.du(rod.position), fields=rod)


@SECTION.states(
    "(12)",
    "the frame turns along the rod about Pi",
    r"\boldsymbol{e}_i'=\epsilon_{ijk}\Pi_j\boldsymbol{e}_k",
    r"\boldsymbol{e}_i'=-\epsilon_{ijk}\Pi_j\boldsymbol{e}_k",
    remark="The opposite of (1): Pi x e_i is epsilon_kji Pi_j e_k. The sign is carried into (14); (9), (17), (18) and "
    "(20) have the right one.",
    affects=("(14b)",),
    part="(12b)",
)
def frame_slope() -> Check:
    rod = Motion()
    _, Pi = rod.split(rod.turn)
    return Check(
        printed=np.einsum("ijk,j,kl->il", epsilon(), Pi, rod.frame),
        derived=[rod.du(e) for e in rod.frame],
        corrected=-np.einsum("ijk,j,kl->il", epsilon(), Pi, rod.frame),
        fields=rod,
    )


@SECTION.states("(13)", "the centreline moves with v", r"\dot{\boldsymbol{r}}=v_i\boldsymbol{e}_i", part="(13a)")
def centreline_rate() -> Check:
    rod = Motion()
    v, _ = rod.split(rod.twist)
    return Check(printed=np.einsum("i,ij->j", v, rod.frame), derived=rod.dt(rod.position), fields=rod)


@SECTION.states(
    "(13)",
    "the frame turns in time about Omega",
    r"\dot{\boldsymbol{e}}_i=\epsilon_{ijk}\Omega_j\boldsymbol{e}_k",
    r"\dot{\boldsymbol{e}}_i=-\epsilon_{ijk}\Omega_j\boldsymbol{e}_k",
    remark="The opposite of (2), as (12) is of (1). The sign is carried into (15), and no further.",
    affects=("(15b)",),
    part="(13b)",
)
def frame_rate() -> Check:
    rod = Motion()
    _, Omega = rod.split(rod.twist)
    return Check(
        printed=np.einsum("ijk,j,kl->il", epsilon(), Omega, rod.frame),
        derived=[rod.dt(e) for e in rod.frame],
        corrected=-np.einsum("ijk,j,kl->il", epsilon(), Omega, rod.frame),
        fields=rod,
    )


@SECTION.states(
    "(14)", "h_i from the centreline and the frame", r"h_i=\boldsymbol{e}_i\cdot\boldsymbol{r}'", part="(14a)"
)
def components_of_slope() -> Check:
    rod = Motion()
    h, _ = rod.split(rod.turn)
    return Check(printed=np.einsum("ij,j->i", rod.frame, rod.du(rod.position)), derived=h, fields=rod)


@SECTION.states(
    "(14)",
    "Pi_i from the frame",
    r"\Pi_i=\epsilon_{ijk}\boldsymbol{e}_j\cdot\boldsymbol{e}_k'",
    r"\Pi_i=-\tfrac{1}{2}\epsilon_{ijk}\boldsymbol{e}_j\cdot\boldsymbol{e}_k'",
    remark="The printed sum is -2 Pi_i: each pair of j and k counts twice, and the sign is that of (12) as printed.",
    part="(14b)",
)
def components_of_curvature() -> Check:
    rod = Motion()
    _, Pi = rod.split(rod.turn)
    e, slopes = rod.frame, np.array([rod.du(e) for e in rod.frame])
    by_12 = np.einsum("ijk,j,kl->il", epsilon(), Pi, e)  # the slopes that (12) as printed gives
    return Check(
        printed=np.einsum("ijk,jl,kl->i", epsilon(), e, slopes),
        derived=Pi,
        corrected=-np.einsum("ijk,jl,kl->i", epsilon(), e, slopes) / 2,
        also=[("with (12) as printed the sum is 2 Pi_i", np.einsum("ijk,jl,kl->i", epsilon(), e, by_12), 2 * Pi)],
        fields=rod,
    )


@SECTION.states(
    "(15)", "v_i from the centreline and the frame", r"v_i=\boldsymbol{e}_i\cdot\dot{\boldsymbol{r}}", part="(15a)"
)
def components_of_velocity() -> Check:
    rod = Motion()
    v, _ = rod.split(rod.twist)
    return Check(printed=np.einsum("ij,j->i", rod.frame, rod.dt(rod.position)), derived=v, fields=rod)


@SECTION.states(
    "(15)",
    "Omega_i from the frame",
    r"\Omega_i=\epsilon_{ijk}\boldsymbol{e}_j\cdot\dot{\boldsymbol{e}}_k",
    r"\Omega_i=-\tfrac{1}{2}\epsilon_{ijk}\boldsymbol{e}_j\cdot\dot{\boldsymbol{e}}_k",
    remark="As in (14): the printed sum is -2 Omega_i; with (13) as printed it would be 2 Omega_i.",
    part="(15b)",
)
def components_of_angular_velocity() -> Check:
    rod = Motion()
    _, Omega = rod.split(rod.twist)
    e, rates = rod.frame, np.array([rod.dt(e) for e in rod.frame])
    by_13 = np.einsum("ijk,j,kl->il", epsilon(), Omega, e)  # the rates that (13) as printed gives
    return Check(
        printed=np.einsum("ijk,jl,kl->i", epsilon(), e, rates),
        derived=Omega,
        corrected=-np.einsum("ijk,jl,kl->i", epsilon(), e, rates) / 2,
        also=[("with (13) as printed the sum is 2 Omega_i", np.einsum("ijk,jl,kl->i", epsilon(), e, by_13), 2 * Omega)],
        fields=rod,
    )


@SECTION.states(
    "I05",
    "moving the rod as a whole leaves h_i and v_i",
    r"\boldsymbol{r}\to\boldsymbol{R}\cdot\boldsymbol{r}+\boldsymbol{a}",
    remark="R and a are the same for all u, and also for all t: a translation that goes on in time keeps h_i, and adds "
    "to v_i.",
)
def moved_centreline() -> Check:
    rod = Motion()
    (h, _), (v, _), r = rod.split(rod.turn), rod.split(rod.twist), rod.position
    R, a, b = SE3.rotation(rod.rigid_motion()), rod.constants("a", 3), rod.array("b", 3)
    rod.law(b, u=np.zeros(3, dtype=int))
    moved = (R @ rod.rotation).T
    gained = moved @ rod.dt(b)
    return Check(
        printed=[np.einsum("ij,j->i", moved, rod.du(R @ r + a)), np.einsum("ij,j->i", moved, rod.dt(R @ r + a))],
        derived=[h, v],
        also=[
            ("h_i stays if the translation goes on in time", moved @ rod.du(R @ r + b), h),
            ("v_i does not", moved @ rod.dt(R @ r + b), v + gained),
        ],
        fields=rod,
    )


@SECTION.states(
    "I06",
    "turning the rod as a whole leaves Pi_i and Omega_i",
    r"\boldsymbol{e}_i\to\boldsymbol{R}\cdot\boldsymbol{e}_i",
    remark="Also with (14) and (15) as printed, whose sums are -2 times as large.",
)
def moved_frame() -> Check:
    rod = Motion()
    (_, Pi), (_, Omega), e = rod.split(rod.turn), rod.split(rod.twist), rod.rotation.T
    R = SE3.rotation(rod.rigid_motion())
    return Check(
        printed=[_turning(e @ R.T, rod.du(e @ R.T)), _turning(e @ R.T, rod.dt(e @ R.T))],
        derived=[Pi, Omega],
        fields=rod,
    )


@SECTION.states(
    "(16)",
    "the length of the centreline per u",
    r"g=\lVert\boldsymbol{h}\rVert=\sqrt{h_1^2+h_2^2+h_3^2}",
    remark="Compared as squares. The metric itself has the coefficient g^2, see I03.",
)
def metric() -> Check:
    rod = Motion()
    h1, h2, h3 = rod.split(rod.turn)[0]
    R, a = SE3.rotation(rod.rigid_motion()), rod.constants("a", 3)
    slope, moved = rod.du(rod.position), rod.du(R @ rod.position + a)
    return Check(
        printed=h1**2 + h2**2 + h3**2,
        derived=dot(slope, slope),
        defines=True,
        also=[("a rigid motion leaves it", dot(moved, moved), dot(slope, slope))],
        fields=rod,
    )


@SECTION.states(
    "P03",
    "rods with the same turn differ by a rigid motion",
    r"E_1=E_2\;\Rightarrow\;(\varphi_2\varphi_1^{-1})'=0",
    remark="At each time by one of its own; by the same at all times if the twists agree too.",
)
def turn_fixes_the_shape() -> Check:
    rod = Motion()
    first, second = rod.configuration, SE3.pose(rod.array("s", 3), rod.array("S", 3, 3))
    slopes, rates = second @ SE3.hat(rod.turn), second @ SE3.hat(rod.twist)
    for part in (SE3.position, SE3.rotation):
        rod.law(part(second), u=part(slopes), t=part(rates))
    between, nothing = second @ SE3.inverse(first), np.zeros((4, 4), dtype=int)
    return Check(
        printed=np.zeros((4, 4), dtype=int),
        derived=rod.du(between),
        also=[("nor does it change in time, if the twists agree too", rod.dt(between), nothing)],
        fields=rod,
    )


@SECTION.states(
    "P04",
    "no component of turn and twist derives from a function",
    r"\dot{E}_\alpha-V_\alpha'\neq0\quad\text{for all six }\alpha",
    remark="In space. In the plane Pi and Omega are the derivatives of one angle.",
)
def non_holonomic() -> Check:
    return Check(
        printed=np.ones(6, dtype=int),
        derived=_not_closed(Motion(SE3)),
        also=[("in the plane all but the angle", _not_closed(Motion(SE2)), np.array([1, 1, 0]))],
    )


@SECTION.states(
    "(17)",
    "mixed derivatives of the centreline, in the moving frame",
    r"\dot{\underline{h}}+\underline{\Omega}\times\underline{h}=\underline{v}'+\underline{\Pi}\times\underline{v}",
)
def centreline_is_compatible() -> Check:
    rod = Motion()
    (h, Pi), (v, Omega), r = rod.split(rod.turn), rod.split(rod.twist), rod.position
    return Check(
        printed=[rod.dt(h) + cross(Omega, h), rod.du(v) + cross(Pi, v)],
        derived=[rod.body(rod.dt(rod.du(r))), rod.body(rod.dt(rod.du(r)))],
        fields=rod,
    )


@SECTION.states(
    "(18)",
    "mixed derivatives of the frame, in the moving frame",
    r"\dot{\underline{\Pi}}-\underline{\Omega}'=\underline{\Pi}\times\underline{\Omega}",
)
def frame_is_compatible() -> Check:
    rod = Motion()
    (_, Pi), (_, Omega) = rod.split(rod.turn), rod.split(rod.twist)
    return Check(printed=cross(Pi, Omega), derived=rod.dt(Pi) - rod.du(Omega), fields=rod)


@SECTION.states("(19)", "force in components", r"\boldsymbol{F}=F_i\boldsymbol{e}_i", part="(19a)")
def force_in_components() -> Check:
    rod = Motion()
    F, _ = rod.split(rod.stress)
    force, _ = _resultants(rod)
    return Check(printed=np.einsum("i,ij->j", F, rod.frame), derived=force, defines=True, fields=rod)


@SECTION.states("(19)", "force per length in components", r"\boldsymbol{f}=f_i\boldsymbol{e}_i", part="(19b)")
def applied_force_in_components() -> Check:
    rod = Motion()
    f, _ = rod.split(rod.wrench)
    F = rod.world(rod.split(rod.stress)[0])
    return Check(printed=np.einsum("i,ij->j", f, rod.frame), derived=-rod.du(F), defines=True, fields=rod)


@SECTION.states("(19)", "moment in components", r"\boldsymbol{M}=M_i\boldsymbol{e}_i", part="(19c)")
def moment_in_components() -> Check:
    rod = Motion()
    _, M = rod.split(rod.stress)
    force, about_origin = _resultants(rod)
    moment = about_origin - cross(rod.position, force)
    return Check(printed=np.einsum("i,ij->j", M, rod.frame), derived=moment, defines=True, fields=rod)


@SECTION.states("(19)", "moment per length in components", r"\boldsymbol{m}=m_i\boldsymbol{e}_i", part="(19d)")
def applied_moment_in_components() -> Check:
    rod = Motion()
    _, m = rod.split(rod.wrench)
    F, M = (rod.world(x) for x in rod.split(rod.stress))
    at_rest = -rod.du(M) - cross(rod.du(rod.position), F)
    return Check(printed=np.einsum("i,ij->j", m, rod.frame), derived=at_rest, defines=True, fields=rod)


@SECTION.states(
    "(20)",
    "no net force, in the moving frame",
    r"\underline{F}'+\underline{\Pi}\times\underline{F}+\underline{f}=0",
    part="(20a)",
)
def force() -> Check:
    rod = Motion()
    (_, Pi), (F, _), f = rod.split(rod.turn), rod.split(rod.stress), rod.array("f", 3)
    at_rest, _ = rod.split(rod.wrench)
    return Check(printed=rod.du(F) + cross(Pi, F) + f, derived=f - at_rest, fields=rod)


@SECTION.states(
    "(20)",
    "no net moment, in the moving frame",
    r"\underline{M}'+\underline{\Pi}\times\underline{M}+\underline{h}\times\underline{F}+\underline{m}=0",
    part="(20b)",
)
def moment() -> Check:
    rod = Motion()
    (h, Pi), (F, M), m = rod.split(rod.turn), rod.split(rod.stress), rod.array("m", 3)
    _, at_rest = rod.split(rod.wrench)
    return Check(printed=rod.du(M) + cross(Pi, M) + cross(h, F) + m, derived=m - at_rest, fields=rod)


def _resultants(rod: Motion) -> tuple[Array, Array]:
    """Force through a cross-section, and moment about the origin: the stress as a fixed observer there sees it, who
    finds the same power."""
    return rod.split(SE3.Ad(SE3.inverse(rod.configuration)).T @ rod.stress)


def _turning(e: Array, change: Array) -> Array:
    """What a frame, in rows, turns about, in its own components: from the change of each vector along the others."""
    return np.array([dot(change[1], e[2]), dot(change[2], e[0]), dot(change[0], e[1])], dtype=object)


def _not_closed(rod: Motion) -> Array:
    """1 where the mixed derivatives of a function with these derivatives along the rod and in time would disagree."""
    pairs = zip(rod.dt(rod.turn), rod.du(rod.twist), strict=True)
    return np.array([int(not compare(a, b, rod).vanishes) for a, b in pairs])
