"""Section II: kinematics and dynamics as vectors in the world."""

import numpy as np
import sympy as sp

from geocosserat.discretisation.mesh import make_mesh
from geocosserat.referee.jets import Jets
from geocosserat.referee.motion import Motion, cross, dot
from geocosserat.referee.statement import Check, Section

SECTION = Section("Cosserat rods")


@SECTION.states("I01", "u numbers the cross-sections from one end to the other", r"u\in[0,L]")
def material_parameter() -> Check:
    rod, L = Motion(), 3
    ends = make_mesh(L, elements=4, degree=2).u[[0, -1]].astype(int)
    material = ("a cross-section keeps its u", rod.dt(rod.du(rod.position)), rod.du(rod.dt(rod.position)))
    return Check(printed=[0, L], derived=ends, defines=True, also=[material])


@SECTION.states("(1)", "h is the slope of the centreline", r"\boldsymbol{r}'=\boldsymbol{h}", part="(1a)")
def centreline_slope() -> Check:
    rod = Motion()
    h, _ = rod.split(rod.turn)
    return Check(printed=rod.world(h), derived=rod.du(rod.position), defines=True, fields=rod)


@SECTION.states(
    "(1)",
    "the frame turns along the rod about Pi",
    r"\boldsymbol{e}_i'=\boldsymbol{\Pi}\times\boldsymbol{e}_i",
    part="(1b)",
)
def frame_slope() -> Check:
    rod = Motion()
    _, Pi = rod.split(rod.turn)
    return Check(
        printed=[cross(rod.world(Pi), e) for e in rod.frame],
        derived=[rod.du(e) for e in rod.frame],
        defines=True,
        fields=rod,
    )


@SECTION.states("(2)", "v is the velocity of the centreline", r"\dot{\boldsymbol{r}}=\boldsymbol{v}", part="(2a)")
def centreline_rate() -> Check:
    rod = Motion()
    v, _ = rod.split(rod.twist)
    return Check(printed=rod.world(v), derived=rod.dt(rod.position), defines=True, fields=rod)


@SECTION.states(
    "(2)",
    "the frame turns in time about Omega",
    r"\dot{\boldsymbol{e}}_i=\boldsymbol{\Omega}\times\boldsymbol{e}_i",
    part="(2b)",
)
def frame_rate() -> Check:
    rod = Motion()
    _, Omega = rod.split(rod.twist)
    return Check(
        printed=[cross(rod.world(Omega), e) for e in rod.frame],
        derived=[rod.dt(e) for e in rod.frame],
        defines=True,
        fields=rod,
    )


@SECTION.states("I02", "s is the arc length of the centreline", r"ds^2=d\boldsymbol{r}\cdot d\boldsymbol{r}")
def arc_length() -> Check:
    rod = Motion()
    r, du = rod.position, sp.Symbol("du")
    return Check(printed=dot(rod.du(r), rod.du(r)) * du**2, derived=_squared_chord(rod, du), defines=True, fields=rod)


@SECTION.states(
    "I03",
    "the norm of h is the arc length per u",
    r"ds^2=\boldsymbol{r}'\cdot\boldsymbol{r}'\,du^2=h^2du^2",
    remark="The coefficient of the metric is the square of h; the paper calls h itself the metric, also in (16).",
)
def metric_of_the_centreline() -> Check:
    rod = Motion()
    h, _ = rod.split(rod.turn)
    r, du = rod.position, sp.Symbol("du")
    return Check(
        printed=[dot(rod.du(r), rod.du(r)) * du**2, dot(h, h) * du**2],
        derived=[_squared_chord(rod, du), _squared_chord(rod, du)],
        fields=rod,
    )


@SECTION.states(
    "P01",
    "the frame stays orthonormal for all u and t",
    r"(\boldsymbol{e}_i\cdot\boldsymbol{e}_j)'=\partial_t(\boldsymbol{e}_i\cdot\boldsymbol{e}_j)=0",
)
def frame_stays_orthonormal() -> Check:
    triad = Jets()
    e, Pi, Omega = triad.array("e", 3, 3), triad.array("Pi", 3), triad.array("Omega", 3)
    triad.law(e, u=np.array([cross(Pi, a) for a in e]), t=np.array([cross(Omega, a) for a in e]))
    volume = dot(e[0], cross(e[1], e[2]))
    handed = ("and right-handed", np.array([triad.du(volume), triad.dt(volume)]), np.zeros(2, dtype=int))
    return Check(printed=np.zeros((2, 3, 3), dtype=int), derived=[triad.du(e @ e.T), triad.dt(e @ e.T)], also=[handed])


@SECTION.states(
    "(3)", "mixed derivatives of the centreline agree", r"\dot{\boldsymbol{h}}-\boldsymbol{v}'=0", part="(3a)"
)
def centreline_is_compatible() -> Check:
    rod = Motion()
    (h, _), (v, _) = rod.split(rod.turn), rod.split(rod.twist)
    return Check(
        printed=np.zeros(3, dtype=int),
        derived=rod.dt(rod.world(h)) - rod.du(rod.world(v)),
        fields=rod,
    )


@SECTION.states(
    "(3)",
    "mixed derivatives of the frame agree, as vectors",
    r"\dot{\boldsymbol{\Pi}}-\boldsymbol{\Omega}'=\boldsymbol{\Pi}\times\boldsymbol{\Omega}",
    r"\dot{\boldsymbol{\Pi}}-\boldsymbol{\Omega}'=\boldsymbol{\Omega}\times\boldsymbol{\Pi}",
    remark="The sign is that of the components in the moving frame, (18), not that of the vectors. Table I has the two "
    "the other way round.",
    part="(3b)",
)
def frame_is_compatible() -> Check:
    rod = Motion()
    (_, Pi), (_, Omega) = rod.split(rod.turn), rod.split(rod.twist)
    return Check(
        printed=cross(rod.world(Pi), rod.world(Omega)),
        derived=rod.dt(rod.world(Pi)) - rod.du(rod.world(Omega)),
        corrected=cross(rod.world(Omega), rod.world(Pi)),
        fields=rod,
    )


@SECTION.states("(4)", "balance of force", r"\dot{\boldsymbol{p}}=\boldsymbol{F}'+\boldsymbol{f}", part="(4a)")
def momentum() -> Check:
    rod = Motion()
    F = rod.world(rod.split(rod.stress)[0])
    at_rest = rod.world(rod.split(rod.wrench)[0])
    p = rod.array("p", 3)
    f = at_rest + rod.dt(p)  # inertia counts as one more load
    return Check(printed=rod.du(F) + f, derived=rod.dt(p), fields=rod)


@SECTION.states(
    "(4)",
    "balance of moment, about the centreline",
    r"\dot{\boldsymbol{L}}=\boldsymbol{M}'+\boldsymbol{h}\times\boldsymbol{F}+\boldsymbol{m}",
    r"\dot{\boldsymbol{L}}+\boldsymbol{v}\times\boldsymbol{p}="
    r"\boldsymbol{M}'+\boldsymbol{h}\times\boldsymbol{F}+\boldsymbol{m}",
    remark="About the origin the angular momentum is L + r x p, whose rate has a term v x p. It vanishes if the "
    "momentum is along the velocity: centres of mass on the centreline, and no added mass of the fluid. (5) has no "
    "momentum, so nothing later depends on it.",
    part="(4b)",
)
def angular_momentum() -> Check:
    rod = Motion()
    h, v = (rod.world(rod.split(x)[0]) for x in (rod.turn, rod.twist))
    F, M = (rod.world(x) for x in rod.split(rod.stress))
    r, m, rho, a = rod.position, rod.array("m", 3), rod.scalar("rho"), rod.array("a", 3)
    p = rho * v + a
    f = rod.dt(p) - rod.du(F)  # (4a)
    about_origin = rod.du(M + cross(r, F)) + m + cross(r, f)
    return Check(
        printed=rod.du(M) + cross(h, F) + m,
        derived=about_origin - rod.dt(cross(r, p)),
        corrected=rod.du(M) + cross(h, F) + m - cross(v, p),
        condition=("the momentum density is along the velocity, p = rho v", {x: sp.S.Zero for x in a}),
        fields=rod,
    )


@SECTION.states("(5)", "no net force, without inertia", r"\boldsymbol{F}'+\boldsymbol{f}=0", part="(5a)")
def force() -> Check:
    rod = Motion()
    F = rod.world(rod.split(rod.stress)[0])
    at_rest = rod.world(rod.split(rod.wrench)[0])
    f = rod.array("f", 3)
    return Check(printed=rod.du(F) + f, derived=f - at_rest, fields=rod)


@SECTION.states(
    "(5)",
    "no net moment, without inertia",
    r"\boldsymbol{M}'+\boldsymbol{h}\times\boldsymbol{F}+\boldsymbol{m}=0",
    part="(5b)",
)
def moment() -> Check:
    rod = Motion()
    r, m = rod.position, rod.array("m", 3)
    h = rod.world(rod.split(rod.turn)[0])
    F, M = (rod.world(x) for x in rod.split(rod.stress))
    f = -rod.du(F)  # (5a)
    about_origin = rod.du(M + cross(r, F)) + m + cross(r, f)
    return Check(printed=rod.du(M) + cross(h, F) + m, derived=about_origin, fields=rod)


@SECTION.states(
    "P02",
    "as many balances as unknowns, all coupled",
    r"\text{six coupled equations for }\boldsymbol{r},\boldsymbol{e}_i",
)
def six_equations() -> Check:
    rod = Motion()
    R = rod.rotation
    numbers = np.concatenate([rod.position, R.ravel()])
    rates = sp.Matrix(rod.dt(numbers)).jacobian(list(rod.twist))
    bound = sp.Matrix((R.T @ R)[np.triu_indices(3)]).jacobian(list(numbers))
    unknowns, constraints = (_rank(rod, m) for m in (rates, bound))
    free = ("twelve numbers less those bound by orthonormality", len(numbers) - constraints, unknowns)
    # as many unknowns, as many balances, one group of them
    return Check(printed=[6, 6, 1], derived=[unknowns, len(rod.wrench), _coupled_groups(rod)], also=[free])


def _squared_chord(rod: Motion, du: sp.Symbol) -> sp.Expr:
    """Between the points of the centreline at u and u + du, to second order in du."""
    step = rod.du(rod.position) * du + rod.du(rod.du(rod.position)) * du**2 / 2
    return dot(step, step).diff(du, 2).subs(du, 0) / 2 * du**2


def _rank(rod: Motion, matrix: sp.Matrix) -> int:
    """At a rotation about an axis that is nothing special."""
    turned = dict(zip(sp.symbols("q0:4"), (sp.Rational(x, 15) for x in (2, 5, 14, 0)), strict=True))
    return int(matrix.xreplace(rod.parameters).xreplace(turned).rank())


def _coupled_groups(rod: Motion) -> int:
    """How many groups of balances share no unknown, if each component of the stress follows its own of the turn."""
    upright = dict(zip(sp.symbols("q0:4"), (1, 0, 0, 0), strict=True))
    balances = [sp.expand(e.xreplace(rod.parameters).xreplace(upright)) for e in rod.wrench]
    unknowns = [{x, y, rod.du(x), rod.du(y)} for x, y in zip(rod.turn, rod.stress, strict=True)]
    enters = np.array([[bool(e.free_symbols & x) for x in unknowns] for e in balances], dtype=int)
    linked = np.linalg.matrix_power(enters @ enters.T, len(balances)) > 0
    return len(np.unique(linked, axis=0))
