"""Section VIII, and what the introduction says of it: the rod that neither stretches nor shears."""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import SE2
from geocosserat.derivation.limit import limit
from geocosserat.derivation.notation import T
from geocosserat.derivation.small import small_motion
from geocosserat.referee.motion import Motion, cross, dot
from geocosserat.referee.statement import Check, Section, compare
from paper_checks.coordinates import coordinate_rod, in_jets, planar_rod, put, solved_by_geocosserat

SECTION = Section("Beam limits")

EPS = sp.Symbol("epsilon")


def held_rod() -> tuple[Motion, sp.Symbol]:
    """A planar rod whose h changes nowhere along it, and its angle theta, by (69) and (70)."""
    rod = Motion(SE2)
    theta, (_, _, Pi), (_, _, Omega) = rod.scalar("theta"), rod.turn, rod.twist
    rod.law(theta, u=Pi, t=Omega)
    rod.law(rod.turn[:2], u=np.array([0, 0]))
    return rod, theta


def held(e: Any) -> Any:
    """With h = (1, 0). Of a rate of h: what must vanish if it stays so."""
    h1, h2 = sp.symbols("h1 h2")
    return put(e, {h1: sp.S.One, h2: sp.S.Zero})


def whole(e: Any) -> Any:
    """Nothing left out."""
    return e


def beam(rod: Motion, keep: Any = whole) -> tuple[sp.Expr, sp.Expr]:
    """The rate of h1, which must vanish, and the spin that makes the rate of h2 vanish, without load.

    keep: what is kept of each equation before the velocities are eliminated between them.
    """
    (h1, h2, _), (v1, v2, Omega) = rod.turn, rod.twist
    V1, V2 = (keep(x) for x in held(-rod.wrench[:2]) / np.array(sp.symbols("gamma1 gamma2"), dtype=object))
    velocities = {v1: V1, v2: V2, rod.du(v1): rod.du(V1), rod.du(v2): rod.du(V2)}
    stretching, shearing = keep(held(rod.dt(h1))), keep(held(rod.dt(h2)))
    return put(stretching, velocities), put(shearing + Omega, velocities)


def any_beam() -> tuple[Motion, sp.Symbol]:
    """A rod of any law for M, with the F2 that (79) gives; its angle."""
    rod, theta = held_rod()
    rod.constants("gamma", 2)
    F1, _, M = rod.stress
    rod.stress = np.array([F1, -rod.du(M), M], dtype=object)
    return rod, theta


def linear_beam() -> tuple[Motion, sp.Symbol]:
    """A rod with M = k3 Pi and the F2 that (79) gives; its angle."""
    rod, theta = held_rod()
    rod.constants("gamma", 2)
    F1, M = rod.stress[0], rod.constant("k3") * rod.turn[2]
    rod.stress = np.array([F1, -rod.du(M), M], dtype=object)
    return rod, theta


def derivatives(rod: Motion, field: sp.Symbol) -> list[sp.Symbol]:
    """The field and its derivatives along the rod."""
    found = [field]
    for _ in range(4):
        found.append(rod.du(found[-1]))
    return found


def near_straight(rod: Motion, e: sp.Expr, tension: Any = 0, order: int = 1) -> sp.Expr:
    """With an angle and velocities of order epsilon, and a constant tension with a change of this order in it."""
    F1 = rod.stress[0]
    small = {x: EPS * x for field in (rod.turn[2], *rod.twist) for x in derivatives(rod, field)}
    small |= {x: EPS**order * x for x in derivatives(rod, F1)}
    return put(e, small | {F1: tension + EPS**order * F1})


def first_order(rod: Motion, e: sp.Expr, tension: Any = 0) -> sp.Expr:
    """What is linear in angle, velocities and the change of F1, about a straight rod under this tension."""
    return put(near_straight(rod, e, tension).diff(EPS), {EPS: sp.S.Zero})


def fast_angle() -> sp.Expr:
    """The rate at which the angle of a straight rod that can shear relaxes on a line that is held, over k/gamma3."""
    _, _, rates = coordinate_rod()
    k, gamma3 = sp.symbols("k gamma3", positive=True)
    c, s, slope_x, slope_y, bend = sp.symbols("c s x_u y_u theta_u")
    rate = s * rates[2].diff(c) - c * rates[2].diff(s)
    return put(rate, {c: sp.S.One, s: sp.S.Zero, slope_x: sp.S.One, slope_y: sp.S.Zero, bend: sp.S.Zero}) / (k / gamma3)


@SECTION.states(
    "P21",
    "the beam equations come from the linearised equations",
    r"\text{linearised equations}\;\Rightarrow\;\text{(86)--(88)}",
    r"\text{linearised equations}\;\Rightarrow\;\text{(88)};\quad\text{(71), (72)}\;\Rightarrow\;\text{(86)}",
    remark="Only the linear equation (88) follows from linearised equations. The nonlinear ones, (83) to (86), come "
    "from the full equations, and this is how Section VIII derives them.",
)
def from_linearised_equations() -> Check:
    rod, theta = linear_beam()
    gamma2, k3 = sp.symbols("gamma2 k3")
    _, spin = beam(rod)
    _, linear = beam(rod, keep=lambda e: first_order(rod, e))
    return Check(
        printed=-k3 * rod.du(rod.du(rod.du(rod.du(theta)))) / gamma2,
        derived=sp.expand(near_straight(rod, spin) / EPS),
        condition=("the angle and the tension are small, to first order", {EPS: 0}),
        also=[("linearised first, the equations give (88)", linear, first_order(rod, spin))],
        fields=rod,
    )


@SECTION.states("I61", "the slope of the centreline is e1: no stretch, no shear", r"h_1=1,\;h_2=0")
def frozen() -> Check:
    rod = Motion(SE2)
    return Check(
        printed=[1, 0],
        derived=rod.body(rod.frame[0]),
        defines=True,
        also=[("the package freezes them there", solved_by_geocosserat(0, ("h1", "h2")).turn[:2], [1, 0])],
        fields=rod,
    )


@SECTION.states(
    "P18",
    "the angle relaxes fast, so that moments balance without friction",
    r"\text{the angle relaxes fast}\;\Rightarrow\;M'+F_2=0",
    r"M'+F_2=\gamma_3\dot\theta",
    remark="What is needed is that friction against rotation is negligible: gamma3 q^2 far below gamma2 for bends of "
    "wave number q. While the rod can shear, the angle does relax fast, at a rate k/gamma3 on a line that is held; "
    "without shear it is the angle of the centreline, and slow: (86) evolves it.",
)
def angle_relaxes() -> Check:
    rod, theta = held_rod()
    gamma2, k3, gamma3 = sp.symbols("gamma2 k3 gamma3")
    F1, Pi, Omega = rod.stress[0], rod.turn[2], rod.twist[2]
    moment = k3 * Pi
    rod.stress = np.array([F1, gamma3 * rod.dt(theta) - rod.du(moment), moment], dtype=object)  # F2 by (72c)
    balanced = held(-rod.wrench)[2]
    _, spin = beam(rod)
    slowed = gamma3 * rod.du(rod.du(Omega)) - k3 * rod.du(rod.du(rod.du(Pi)))
    return Check(
        printed=0,
        derived=balanced,
        condition=("friction against rotation is negligible", {gamma3: 0}),
        also=[
            ("near the straight rod it only slows the angle", gamma2 * first_order(rod, spin), slowed),
            ("without it the angle still has a rate", int(compare(spin, 0, rod, {gamma3: 0}).vanishes), 0),
            ("with shear, the angle is fast on a line that is held", fast_angle(), 1),
        ],
        fields=rod,
    )


@SECTION.states(
    "(79)",
    "balance of moments, without friction and couple",
    r"M'+F_2=0",
    r"M'+F_2+m=\gamma_3\Omega",
    remark="The couple of (72) and the friction against rotation are left out.",
)
def moments() -> Check:
    rod, _ = held_rod()
    gamma3, m = rod.constant("gamma3"), rod.scalar("m")
    (_, F2, M), Omega = rod.stress, rod.twist[2]
    return Check(
        printed=rod.du(M) + F2,
        derived=m + held(-rod.wrench)[2] - gamma3 * Omega,  # zero: all moments on a piece of the rod
        condition=("no couple acts and friction against rotation is negligible", {m: 0, gamma3: 0}),
        fields=rod,
    )


@SECTION.states("(80)", "the rod does not stretch", r"0=v_1'-\Pi v_2")
def inextensible() -> Check:
    rod, _ = held_rod()
    (h1, _, Pi), (v1, v2, _) = rod.turn, rod.twist
    return Check(printed=rod.du(v1) - Pi * v2, derived=held(rod.dt(h1)), fields=rod)


@SECTION.states(
    "(81)",
    "the rod does not shear",
    r"0=v_2'+\Pi v_1-\Omega",
    remark="This does not follow from the compatibility condition for h2 as (71) has it, but from the right one.",
)
def unshearable() -> Check:
    rod, _ = held_rod()
    (_, h2, Pi), (v1, v2, Omega) = rod.turn, rod.twist
    return Check(printed=rod.du(v2) + Pi * v1 - Omega, derived=held(rod.dt(h2)), fields=rod)


@SECTION.states(
    "(82)",
    "balance of forces along the rod",
    r"\gamma_1v_1=F_1'+\Pi M'",
    r"\gamma_1v_1=F_1'+\Pi M'+f_1",
    remark="The load of (72) is left out, here and in what follows.",
    part="(82a)",
)
def balance_along() -> Check:
    rod, _ = any_beam()
    f1 = rod.scalar("f1")
    (F1, _, M), Pi = rod.stress, rod.turn[2]
    return Check(
        printed=rod.du(F1) + Pi * rod.du(M),
        derived=f1 + held(-rod.wrench)[0],
        condition=("no force acts from outside", {f1: 0}),
        fields=rod,
    )


@SECTION.states(
    "(82)",
    "balance of forces across the rod",
    r"\gamma_2v_2=-M''+\Pi F_1",
    r"\gamma_2v_2=-M''+\Pi F_1+f_2",
    remark="The load of (72) is left out, here and in what follows.",
    part="(82b)",
)
def balance_across() -> Check:
    rod, _ = any_beam()
    f2 = rod.scalar("f2")
    (F1, _, M), Pi = rod.stress, rod.turn[2]
    return Check(
        printed=-rod.du(rod.du(M)) + Pi * F1,
        derived=f2 + held(-rod.wrench)[1],
        condition=("no force acts from outside", {f2: 0}),
        fields=rod,
    )


@SECTION.states(
    "(83)",
    "the tension that keeps the rod from stretching",
    r"0=\frac1{\gamma_1}(F_1''+(\Pi M')')-\frac1{\gamma_2}\Pi(-M''+\Pi F_1)",
)
def tension() -> Check:
    rod, _ = any_beam()
    gamma1, gamma2 = sp.symbols("gamma1 gamma2")
    (F1, _, M), Pi = rod.stress, rod.turn[2]
    stretching, _ = beam(rod)
    return Check(
        printed=(rod.du(rod.du(F1)) + rod.du(Pi * rod.du(M))) / gamma1 - Pi * (-rod.du(rod.du(M)) + Pi * F1) / gamma2,
        derived=stretching,
        fields=rod,
    )


@SECTION.states(
    "(84)",
    "the spin of a rod that does not shear",
    r"\Omega=\frac1{\gamma_2}(-M''+\Pi F_1)'+\frac1{\gamma_1}\Pi(F_1'+\Pi M')",
)
def spin() -> Check:
    rod, _ = any_beam()
    gamma1, gamma2 = sp.symbols("gamma1 gamma2")
    (F1, _, M), Pi = rod.stress, rod.turn[2]
    _, spin = beam(rod)
    return Check(
        printed=rod.du(-rod.du(rod.du(M)) + Pi * F1) / gamma2 + Pi * (rod.du(F1) + Pi * rod.du(M)) / gamma1,
        derived=spin,
        fields=rod,
    )


@SECTION.states("I62", "in the plane spin and bend are derivatives of the angle", r"\Omega=\dot\theta,\quad\Pi=\theta'")
def angle() -> Check:
    rod, theta = planar_rod()
    Pi, Omega = rod.turn[2], rod.twist[2]
    return Check(printed=[rod.dt(theta), rod.du(theta)], derived=[Omega, Pi], fields=rod)


@SECTION.states(
    "(85)",
    "the tension, in terms of the angle",
    r"0=\frac1{\gamma_1}[F_1''+(\theta'M')']-\frac1{\gamma_2}(-\theta'M''+(\theta')^2F_1)",
    part="(85a)",
)
def tension_of_angle() -> Check:
    rod, theta = any_beam()
    gamma1, gamma2 = sp.symbols("gamma1 gamma2")
    F1, _, M = rod.stress
    bend = rod.du(theta)
    stretching, _ = beam(rod)
    return Check(
        printed=(rod.du(rod.du(F1)) + rod.du(bend * rod.du(M))) / gamma1
        - (-bend * rod.du(rod.du(M)) + bend**2 * F1) / gamma2,
        derived=stretching,
        fields=rod,
    )


@SECTION.states(
    "(85)",
    "rate of the angle",
    r"\dot\theta=\frac1{\gamma_2}(-M''+\theta'F_1)'+\frac1{\gamma_1}(\theta'F_1'+(\theta')^2M')",
    part="(85b)",
)
def rate_of_angle() -> Check:
    rod, theta = any_beam()
    gamma1, gamma2 = sp.symbols("gamma1 gamma2")
    F1, _, M = rod.stress
    bend = rod.du(theta)
    _, spin = beam(rod)
    return Check(
        printed=rod.du(-rod.du(rod.du(M)) + bend * F1) / gamma2 + (bend * rod.du(F1) + bend**2 * rod.du(M)) / gamma1,
        derived=put(rod.dt(theta), {rod.twist[2]: spin}),
        fields=rod,
    )


@SECTION.states("I63", "a linear law for the moment", r"M=k_3\Pi=k_3\theta'")
def law_of_moment() -> Check:
    rod, theta = planar_rod()
    k3, Pi = rod.constant("k3"), rod.turn[2]
    (law,) = solved_by_geocosserat(0, ("h1", "h2")).stress_law  # the only one left when h is frozen
    M = in_jets(law.right, rod)
    return Check(printed=[k3 * Pi, k3 * rod.du(theta)], derived=[M, M], defines=True, fields=rod)


@SECTION.states(
    "(86)",
    "the nonlinear Euler-Bernoulli rod: its tension",
    r"0=\frac1{\gamma_1}(F_1''+k_3(\theta'')^2+k_3\theta'\theta''')-\frac1{\gamma_2}(-k_3\theta'\theta'''+(\theta')^2F_1)",
    part="(86a)",
)
def euler_bernoulli_tension() -> Check:
    rod, theta = linear_beam()
    gamma1, gamma2, k3 = sp.symbols("gamma1 gamma2 k3")
    F1, (_, d1, d2, d3, _) = rod.stress[0], derivatives(rod, theta)
    stretching, _ = beam(rod)
    row, _ = limit(solved_by_geocosserat(0, ("h1", "h2"))).rows
    return Check(
        printed=(rod.du(rod.du(F1)) + k3 * d2**2 + k3 * d1 * d3) / gamma1 - (-k3 * d1 * d3 + d1**2 * F1) / gamma2,
        derived=stretching,
        also=[("the package solves the same", in_jets(-row.residual, rod), stretching)],
        fields=rod,
    )


@SECTION.states(
    "(86)",
    "the nonlinear Euler-Bernoulli rod: rate of its angle",
    r"\dot\theta=\frac1{\gamma_2}(-k_3\theta''''+\theta''F_1+\theta'F_1')+\frac1{\gamma_1}(\theta'F_1'+k_3(\theta')^2\theta'')",
    part="(86b)",
)
def euler_bernoulli_rate() -> Check:
    rod, theta = linear_beam()
    gamma1, gamma2, k3 = sp.symbols("gamma1 gamma2 k3")
    F1, (_, d1, d2, _, d4) = rod.stress[0], derivatives(rod, theta)
    _, spin = beam(rod)
    _, row = limit(solved_by_geocosserat(0, ("h1", "h2"))).rows
    return Check(
        printed=(-k3 * d4 + d2 * F1 + d1 * rod.du(F1)) / gamma2 + (d1 * rod.du(F1) + k3 * d1**2 * d2) / gamma1,
        derived=put(rod.dt(theta), {rod.twist[2]: spin}),
        also=[("the package solves the same", in_jets(row.right, rod), spin)],
        fields=rod,
    )


@SECTION.states(
    "P19",
    "F1 is a Lagrange multiplier; the angle alone has a rate",
    r"F_1\text{ enforces inextensibility};\quad\theta\text{ is the only degree of freedom}",
    remark="Counted: fields with a rate, multipliers that are left, and rates of F1. In the power F1 is multiplied by "
    "the rate of stretching, which (86) makes vanish. F2 is the multiplier of the shear, eliminated by (79).",
)
def multiplier() -> Check:
    rod, _ = linear_beam()
    F1, F2, M = sp.symbols("F1 F2 M")
    Omega = rod.twist[2]
    slope = rod.du(rod.position)
    n = rod.world(np.array([F1, F2]))
    power = dot(n, rod.dt(slope)) - Omega * cross(slope, n)[0] + M * rod.du(Omega)  # in deforming the rod
    limits = limit(solved_by_geocosserat(0, ("h1", "h2")))
    rates = [d for row in limits.rows for d in row.residual.atoms(sp.Derivative) if T in d.variables]
    stretching, _ = beam(rod)
    return Check(
        printed=[1, 1, 0],
        derived=[
            len({rate.expr for rate in rates}),
            len(limits.multipliers),
            sum(rate.expr.func.__name__ == "F1" for rate in rates),
        ],
        also=[
            ("the power of F1 is that of stretching", held(power.diff(F1)), held(rod.dt(rod.turn[0]))),
            ("(86) makes it vanish", in_jets(-limits.rows[0].residual, rod), stretching),
        ],
        fields=rod,
    )


@SECTION.states(
    "P20",
    "the linearised equations are those of the Euler-Bernoulli beam",
    r"\text{(87), (88) have the structure of Euler and Bernoulli's beam}",
    remark="True of (88): it is the slope of the overdamped beam equation for the deflection w, with w' for the angle. "
    "(87) is not linear.",
)
def overdamped_beam() -> Check:
    rod, theta = linear_beam()
    gamma2, k3 = sp.symbols("gamma2 k3")
    w, _, _, _, d4 = derivatives(rod, rod.scalar("w"))
    _, spin = beam(rod)
    deflected = dict(zip(derivatives(rod, theta), derivatives(rod, rod.du(w)), strict=True))
    return Check(
        printed=rod.du(-k3 * d4 / gamma2),  # the slope of the rate of w
        derived=put(first_order(rod, spin), deflected),
        fields=rod,
    )


@SECTION.states(
    "(87)",
    "tension of a rod that is nearly straight",
    r"0=\frac1{\gamma_1}F_1''+\frac{k_3}{\gamma_1}(\theta'')^2",
    r"0=\frac1{\gamma_1}F_1''",
    remark="A square of the angle is kept in a linear equation. To second order two more terms of the same size belong "
    "to it, k3 theta' theta''' (1/gamma1 + 1/gamma2). (88) does not need it.",
)
def linear_tension() -> Check:
    rod, theta = linear_beam()
    gamma1, gamma2, k3 = sp.symbols("gamma1 gamma2 k3")
    F1, (_, d1, d2, d3, _) = rod.stress[0], derivatives(rod, theta)
    stretching, _ = beam(rod)
    second = near_straight(rod, stretching, order=2).diff(EPS, 2) / 2
    complete = (rod.du(rod.du(F1)) + k3 * d2**2) / gamma1 + k3 * d1 * d3 * (1 / gamma1 + 1 / gamma2)
    return Check(
        printed=rod.du(rod.du(F1)) / gamma1 + k3 * d2**2 / gamma1,
        derived=first_order(rod, stretching),
        corrected=rod.du(rod.du(F1)) / gamma1,
        also=[("to second order more terms belong to it", complete, put(second, {EPS: sp.S.Zero}))],
        fields=rod,
    )


@SECTION.states(
    "(88)",
    "rate of the angle of a rod that is nearly straight",
    r"\dot\theta=-\frac{k_3}{\gamma_2}\theta''''",
    r"\dot\theta=-\frac{k_3}{\gamma_2}\theta''''+\frac N{\gamma_2}\theta''",
    remark="About a straight rod without tension. With a tension N at its ends the last term joins in.",
)
def linear_rate() -> Check:
    rod, theta = linear_beam()
    gamma2, k3 = sp.symbols("gamma2 k3")
    N = rod.constant("N")
    _, spin = beam(rod)
    small = small_motion(limit(solved_by_geocosserat(0, ("h1", "h2"))))
    assert small is not None
    _, row = small.rows
    return Check(
        printed=-k3 * rod.du(rod.du(rod.du(rod.du(theta)))) / gamma2,
        derived=first_order(rod, spin, tension=N),
        condition=("the straight rod is without tension", {N: 0}),
        also=[("the package has the same without tension", in_jets(row.right, rod), first_order(rod, spin))],
        fields=rod,
    )
