"""Section VII: the planar rod in coordinates."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3, Array, Group
from geocosserat.algebra.symbolic import Stumpff, exp
from geocosserat.derivation.equations import derive
from geocosserat.derivation.records import FieldEquations
from geocosserat.model.expressions import Expression, parse
from geocosserat.model.records import RodModel
from geocosserat.referee.jets import Jets
from geocosserat.referee.motion import Motion, dot
from geocosserat.referee.statement import Check, Section, compare

SECTION = Section("Coordinatised equations")

NUMBERS = dict.fromkeys(("k1", "k2", "k3", "gamma1", "gamma2", "gamma3"), 1.0)


def diagonal(*entries: str | float) -> tuple[tuple[Expression, ...], ...]:
    """A matrix of a scene."""
    rows = range(len(entries))
    return tuple(tuple(parse(entries[i] if i == j else 0, frozenset(NUMBERS)) for j in rows) for i in rows)


@cache
def solved_by_geocosserat(gamma3: str | float = "gamma3", frozen: tuple[str, ...] = ()) -> FieldEquations:
    """The equations that this package derives for a straight planar rod, clamped on the left and free on the right."""
    reference = tuple(parse(x, frozenset()) for x in (1, 0, 0))
    stiffness, friction = diagonal("k1", "k2", "k3"), diagonal("gamma1", "gamma2", gamma3)
    return derive(RodModel(SE2, 1.0, stiffness, friction, reference, frozen=frozen, parameters=NUMBERS))


def in_jets(e: sp.Expr, rod: Jets) -> sp.Expr:
    """An expression of the package's derivation in the fields of this rod that have the same names."""
    values: dict[sp.Expr, sp.Expr] = {x: sp.Symbol(x.name) for x in e.free_symbols}
    values |= {f: sp.Symbol(f.func.__name__) for f in e.atoms(sp.core.function.AppliedUndef)}
    for derivative in e.atoms(sp.Derivative):
        values[derivative] = values[derivative.expr]
        for along, times in derivative.variable_count:
            for _ in range(times):
                values[derivative] = getattr(rod, f"d{along}")(values[derivative])
    return e.xreplace(values)


def planar_rod() -> tuple[Motion, sp.Symbol]:
    """A rod in the plane, and theta: c and s, the components of e1, are its cosine and sine."""
    rod = Motion(SE2)
    theta, (c, s) = rod.scalar("theta"), rod.frame[0]
    rod.law(theta, u=c * rod.du(s) - s * rod.du(c), t=c * rod.dt(s) - s * rod.dt(c))
    return rod, theta


def turned(group: Group) -> Array:
    """The frame of the world turned about e3 by theta, from the exponential; c and s: cosine and sine of theta."""
    theta = sp.Symbol("theta", positive=True)
    moved = exp(group, np.array([0] * (group.dimension - 1) + [theta], dtype=object))
    short = {sp.cos(theta): sp.Symbol("c"), sp.sin(theta): sp.Symbol("s")}
    spelt = [{f: f.elementary() for f in sp.sympify(e).atoms(Stumpff)} for e in moved.ravel()]
    values = [sp.sympify(e).xreplace(f).xreplace(short) for e, f in zip(moved.ravel(), spelt, strict=True)]
    return np.array(values, dtype=object).reshape(moved.shape)


def put(e: Any, values: dict[Any, Any]) -> Any:
    """These values in an expression, or in an array of them."""
    if isinstance(e, np.ndarray):
        return np.array([put(x, values) for x in e.ravel()], dtype=object).reshape(e.shape)
    return sp.sympify(e, strict=True).xreplace(values)


def overdamped(rod: Motion, theta: sp.Symbol, friction: Array, load: Any = 0) -> Array:
    """(3,) rates of x, y and theta of a rod on whose pieces nothing acts but friction, for each mode, and a load."""
    V = (load - rod.wrench) / friction
    rates = rod.dt(np.array([*rod.position, theta], dtype=object))
    return np.asarray(put(rates, dict(zip(rod.twist, V, strict=True))))


def loaded_rod() -> tuple[Motion, sp.Symbol, Array, Array, Array]:
    """A rod whatever its law; theta, the friction, the load per length, and the rates of x, y and theta."""
    rod, theta = planar_rod()
    friction, load = rod.constants("gamma", 3), rod.fields(SE2.wrench)
    return rod, theta, friction, load, overdamped(rod, theta, friction, load)


def linear_rod() -> tuple[Motion, sp.Symbol, Array]:
    """A rod of the law of (76); theta, and the rates of x, y and theta without load."""
    rod, theta = planar_rod()
    k, k3, gamma, gamma3 = (rod.constant(name) for name in ("k", "k3", "gamma", "gamma3"))
    rod.stress = np.array([k, k, k3], dtype=object) * (rod.turn - np.array([1, 0, 0], dtype=object))
    return rod, theta, overdamped(rod, theta, np.array([gamma, gamma, gamma3], dtype=object))


def coordinate_rod() -> tuple[Jets, Array, Array]:
    """The same rod with x, y and theta for fields, by (43) alone: these, and their rates; c, s as above."""
    rod = Jets()
    k, k3, gamma, gamma3 = sp.symbols("k k3 gamma gamma3", positive=True)
    x, y, theta = unknowns = rod.fields(["x", "y", "theta"])
    c, s = rod.fields(["c", "s"])
    rod.law(c, u=-s * rod.du(theta), t=-s * rod.dt(theta))
    rod.law(s, u=c * rod.du(theta), t=c * rod.dt(theta))
    rod.bound({}, [c**2 + s**2 - 1])
    phi = np.array([[1, 0, 0], [x, c, -s], [y, s, c]], dtype=object)
    E = SE2.vee(SE2.inverse(phi) @ rod.du(phi))
    stress = np.array([k, k, k3], dtype=object) * (E - np.array([1, 0, 0], dtype=object))
    V = (rod.du(stress) + SE2.coad(E) @ stress) / np.array([gamma, gamma, gamma3], dtype=object)
    return rod, unknowns, np.array([*SE2.position(phi @ SE2.hat(V)), V[2]], dtype=object)


@SECTION.states("I44", "position in the plane", r"\boldsymbol{r}=(x,y,0)")
def position() -> Check:
    x, y = sp.symbols("x y")
    displaced = exp(SE3, np.array([x, y, 0, 0, 0, 0], dtype=object))  # by x along one axis, by y along the other
    return Check(printed=[x, y, 0], derived=SE3.position(displaced), defines=True)


@SECTION.states("I45", "the frame is turned about e3 by theta: e1", r"\boldsymbol{e}_1=(\cos\theta,\sin\theta,0)")
def first_axis() -> Check:
    c, s = sp.symbols("c s")  # cosine and sine of theta
    return Check(printed=[c, s, 0], derived=SE3.rotation(turned(SE3))[:, 0], defines=True)


@SECTION.states("I46", "the frame is turned about e3 by theta: e2", r"\boldsymbol{e}_2=(-\sin\theta,\cos\theta,0)")
def second_axis() -> Check:
    c, s = sp.symbols("c s")
    return Check(printed=[-s, c, 0], derived=SE3.rotation(turned(SE3))[:, 1], defines=True)


@SECTION.states("I47", "the axis about which the frame turns", r"\boldsymbol{e}_3=(0,0,1)")
def third_axis() -> Check:
    return Check(printed=[0, 0, 1], derived=SE3.rotation(turned(SE3))[:, 2], defines=True)


@SECTION.states(
    "(67)",
    "the configuration of a planar rod",
    r"\varphi=\begin{bmatrix}1&0&0\\x&\cos\theta&-\sin\theta\\y&\sin\theta&\cos\theta\end{bmatrix}",
)
def configuration() -> Check:
    x, y, c, s = sp.symbols("x y c s")
    displaced = exp(SE2, np.array([x, y, 0], dtype=object))
    return Check(printed=[[1, 0, 0], [x, c, -s], [y, s, c]], derived=displaced @ turned(SE2))


@SECTION.states(
    "(68)",
    "the turn as a matrix",
    r"E=\begin{bmatrix}0&0&0\\h_1&0&-\Pi\\h_2&\Pi&0\end{bmatrix}",
    remark="With the usual hat, for which the matrix of Pi maps a vector to its product with Pi from the left. The "
    "index formula for the hat in Section IV has the transpose.",
    part="(68a)",
)
def turn_matrix() -> Check:
    rod = Motion(SE2)
    h1, h2, Pi = rod.turn
    phi = rod.configuration
    return Check(
        printed=[[0, 0, 0], [h1, 0, -Pi], [h2, Pi, 0]],
        derived=SE2.inverse(phi) @ rod.du(phi),
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "(68)",
    "the twist as a matrix",
    r"V=\begin{bmatrix}0&0&0\\v_1&0&-\Omega\\v_2&\Omega&0\end{bmatrix}",
    remark="With the usual hat, as for the turn.",
    part="(68b)",
)
def twist_matrix() -> Check:
    rod = Motion(SE2)
    v1, v2, Omega = rod.twist
    phi = rod.configuration
    return Check(
        printed=[[0, 0, 0], [v1, 0, -Omega], [v2, Omega, 0]],
        derived=SE2.inverse(phi) @ rod.dt(phi),
        defines=True,
        fields=rod,
    )


@SECTION.states("I48", "linear part of the turn: the slope, seen in the frame", r"\underline h=(h_1,h_2)^T")
def linear_turn() -> Check:
    rod = Motion(SE2)
    h1, h2, _ = rod.turn
    return Check(printed=[h1, h2], derived=rod.body(rod.du(rod.position)), defines=True, fields=rod)


@SECTION.states("I49", "linear part of the twist: the velocity, seen in the frame", r"\underline v=(v_1,v_2)^T")
def linear_twist() -> Check:
    rod = Motion(SE2)
    v1, v2, _ = rod.twist
    return Check(printed=[v1, v2], derived=rod.body(rod.dt(rod.position)), defines=True, fields=rod)


@SECTION.states("I50", "components of the turn in their order", r"\underline E=(h_1,h_2,\Pi)")
def turn_components() -> Check:
    rod = Motion(SE2)
    h1, h2, Pi = rod.turn
    phi = rod.configuration
    return Check(printed=[h1, h2, Pi], derived=SE2.vee(SE2.inverse(phi) @ rod.du(phi)), defines=True, fields=rod)


@SECTION.states("I51", "components of the twist in their order", r"\underline V=(v_1,v_2,\Omega)")
def twist_components() -> Check:
    rod = Motion(SE2)
    v1, v2, Omega = rod.twist
    phi = rod.configuration
    return Check(printed=[v1, v2, Omega], derived=SE2.vee(SE2.inverse(phi) @ rod.dt(phi)), defines=True, fields=rod)


@SECTION.states("I52", "the turn is the slope of the configuration, in its own frame", r"\varphi'=\varphi E")
def slope_of_configuration() -> Check:
    rod = Motion(SE2)
    phi, E = rod.configuration, SE2.hat(rod.turn)
    return Check(printed=phi @ E, derived=rod.du(phi), defines=True, fields=rod)


@SECTION.states("(69)", "slope of x", r"x'=h_1\cos\theta-h_2\sin\theta", part="(69a)")
def slope_of_x() -> Check:
    rod, _ = planar_rod()
    (x, _), (c, s) = rod.position, rod.frame[0]
    h1, h2, _ = rod.turn
    return Check(printed=h1 * c - h2 * s, derived=rod.du(x), fields=rod)


@SECTION.states("(69)", "slope of y", r"y'=h_1\sin\theta+h_2\cos\theta", part="(69b)")
def slope_of_y() -> Check:
    rod, _ = planar_rod()
    (_, y), (c, s) = rod.position, rod.frame[0]
    h1, h2, _ = rod.turn
    return Check(printed=h1 * s + h2 * c, derived=rod.du(y), fields=rod)


@SECTION.states("(69)", "the bend is the slope of the angle", r"\theta'=\Pi", part="(69c)")
def slope_of_theta() -> Check:
    rod, theta = planar_rod()
    _, _, Pi = rod.turn
    return Check(printed=Pi, derived=rod.du(theta), fields=rod)


@SECTION.states("I53", "the twist is the rate of the configuration, in its own frame", r"\dot\varphi=\varphi V")
def rate_of_configuration() -> Check:
    rod = Motion(SE2)
    phi, V = rod.configuration, SE2.hat(rod.twist)
    return Check(printed=phi @ V, derived=rod.dt(phi), defines=True, fields=rod)


@SECTION.states("(70)", "rate of x", r"\dot x=v_1\cos\theta-v_2\sin\theta", part="(70a)")
def rate_of_x() -> Check:
    rod, _ = planar_rod()
    (x, _), (c, s) = rod.position, rod.frame[0]
    v1, v2, _ = rod.twist
    return Check(printed=v1 * c - v2 * s, derived=rod.dt(x), fields=rod)


@SECTION.states("(70)", "rate of y", r"\dot y=v_1\sin\theta+v_2\cos\theta", part="(70b)")
def rate_of_y() -> Check:
    rod, _ = planar_rod()
    (_, y), (c, s) = rod.position, rod.frame[0]
    v1, v2, _ = rod.twist
    return Check(printed=v1 * s + v2 * c, derived=rod.dt(y), fields=rod)


@SECTION.states("(70)", "the spin is the rate of the angle", r"\dot\theta=\Omega", part="(70c)")
def rate_of_theta() -> Check:
    rod, theta = planar_rod()
    _, _, Omega = rod.twist
    return Check(printed=Omega, derived=rod.dt(theta), fields=rod)


@SECTION.states("I54", "mixed derivatives of the configuration agree", r"\dot E=V'+[E,V]")
def compatibility() -> Check:
    rod = Motion(SE2)
    phi, E, V = rod.configuration, SE2.hat(rod.turn), SE2.hat(rod.twist)
    inverse = SE2.inverse(phi)
    return Check(
        printed=rod.du(V) + E @ V - V @ E,
        derived=inverse @ rod.du(rod.dt(phi)) - inverse @ rod.dt(phi) @ inverse @ rod.du(phi),  # rate of inverse @ phi'
        also=[("so does the rate of E", rod.dt(E), rod.du(V) + SE2.hat(SE2.bracket(rod.turn, rod.twist)))],
        fields=rod,
    )


@SECTION.states("(71)", "rate of the stretch", r"\dot h_1-v_1'=\Omega h_2-\Pi v_2", part="(71a)")
def rate_of_h1() -> Check:
    rod = Motion(SE2)
    (h1, h2, Pi), (v1, v2, Omega) = rod.turn, rod.twist
    return Check(printed=Omega * h2 - Pi * v2, derived=rod.dt(h1) - rod.du(v1), fields=rod)


@SECTION.states(
    "(71)",
    "rate of the shear",
    r"\dot h_2-v_2'=\Omega h_1-\Pi v_1",
    r"\dot h_2-v_2'=\Pi v_1-\Omega h_1",
    remark="The right side has the opposite sign. A rod that turns as a whole must keep its shear: v2' = Omega h1, "
    "since its velocity grows along it by the spin. (81), and with it all of Section VIII, has the right sign.",
    part="(71b)",
)
def rate_of_h2() -> Check:
    rod = Motion(SE2)
    (h1, h2, Pi), (v1, v2, Omega) = rod.turn, rod.twist
    return Check(
        printed=Omega * h1 - Pi * v1,
        derived=rod.dt(h2) - rod.du(v2),
        corrected=Pi * v1 - Omega * h1,
        fields=rod,
    )


@SECTION.states("(71)", "rate of the bend", r"\dot\Pi=\Omega'", part="(71c)")
def rate_of_bend() -> Check:
    rod = Motion(SE2)
    (_, _, Pi), (_, _, Omega) = rod.turn, rod.twist
    return Check(printed=rod.du(Omega), derived=rod.dt(Pi), fields=rod)


@SECTION.states("I55", "components of the stress in their order", r"\underline\Sigma=(F_1,F_2,M)")
def stress_components() -> Check:
    rod, theta = planar_rod()
    F, (M,) = rod.split(rod.stress)
    power = dot(rod.world(F), rod.dt(rod.position)) + M * rod.dt(theta)  # of the stress on a section
    return Check(printed=[*F, M], derived=[power.diff(V) for V in rod.twist], defines=True, fields=rod)


@SECTION.states(
    "I56",
    "each mode has its own friction",
    r"\Gamma=\mathrm{diag}(\gamma_1,\gamma_2,\gamma_3)",
    remark="In the order of the twist: along e1, along e2, and in rotation. What the package puts on the left of the "
    "three balances is this matrix times the twist.",
)
def friction_matrix() -> Check:
    rod = Motion(SE2)
    gamma1, gamma2, gamma3 = rod.constants("gamma", 3)
    drag = [in_jets(row.left, rod) for row in solved_by_geocosserat().motion]
    return Check(
        printed=[[gamma1, 0, 0], [0, gamma2, 0], [0, 0, gamma3]],
        derived=[[force.diff(V) for V in rod.twist] for force in drag],
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "I57", "friction is balanced by stress and load", r"\Gamma\underline V=\mathcal D^*\underline\Sigma+\underline j"
)
def balance() -> Check:
    rod = Motion(SE2)
    load = rod.fields(SE2.wrench)
    return Check(
        printed=rod.du(rod.stress) + SE2.coad(rod.turn) @ rod.stress + load,
        derived=load - rod.wrench,  # load and friction are all that acts on a piece of the rod
        fields=rod,
    )


@SECTION.states("(72)", "balance of forces along e1", r"\gamma_1v_1=F_1'-\Pi F_2+f_1", part="(72a)")
def balance_along() -> Check:
    rod = Motion(SE2)
    f1, _, _ = load = rod.fields(SE2.wrench)
    (F1, F2, _), (_, _, Pi) = rod.stress, rod.turn
    friction = load - rod.wrench
    return Check(printed=rod.du(F1) - Pi * F2 + f1, derived=friction[0], fields=rod)


@SECTION.states("(72)", "balance of forces along e2", r"\gamma_2v_2=F_2'+\Pi F_1+f_2", part="(72b)")
def balance_across() -> Check:
    rod = Motion(SE2)
    _, f2, _ = load = rod.fields(SE2.wrench)
    (F1, F2, _), (_, _, Pi) = rod.stress, rod.turn
    friction = load - rod.wrench
    return Check(printed=rod.du(F2) + Pi * F1 + f2, derived=friction[1], fields=rod)


@SECTION.states("(72)", "balance of moments", r"\gamma_3\Omega=M'+h_1F_2-h_2F_1+m", part="(72c)")
def balance_of_moments() -> Check:
    rod = Motion(SE2)
    _, _, m = load = rod.fields(SE2.wrench)
    (F1, F2, M), (h1, h2, _) = rod.stress, rod.turn
    friction = load - rod.wrench
    return Check(printed=rod.du(M) + h1 * F2 - h2 * F1 + m, derived=friction[2], fields=rod)


@SECTION.states(
    "(73)",
    "rate of x for any law",
    r"\dot x=\frac1{\gamma_1}(F_1'-\theta'F_2)\cos\theta-\frac1{\gamma_2}(F_2'+\theta'F_1)\sin\theta",
    r"\dot x=\frac1{\gamma_1}(F_1'-\theta'F_2+f_1)\cos\theta-\frac1{\gamma_2}(F_2'+\theta'F_1+f_2)\sin\theta",
    remark="The load of (72) is left out. (76) and the beams of Section VIII are without load, too.",
    part="(73a)",
)
def motion_of_x() -> Check:
    rod, theta, (gamma1, gamma2, _), (f1, f2, _), rates = loaded_rod()
    (F1, F2, _), (c, s) = rod.stress, rod.frame[0]
    return Check(
        printed=(rod.du(F1) - rod.du(theta) * F2) * c / gamma1 - (rod.du(F2) + rod.du(theta) * F1) * s / gamma2,
        derived=rates[0],
        condition=("no force acts from outside", {f1: 0, f2: 0}),
        fields=rod,
    )


@SECTION.states(
    "(73)",
    "rate of y for any law",
    r"\dot y=\frac1{\gamma_1}(F_1'-\theta'F_2)\sin\theta+\frac1{\gamma_2}(F_2'+\theta'F_1)\cos\theta",
    r"\dot y=\frac1{\gamma_1}(F_1'-\theta'F_2+f_1)\sin\theta+\frac1{\gamma_2}(F_2'+\theta'F_1+f_2)\cos\theta",
    remark="The load of (72) is left out, as in the rate of x.",
    part="(73b)",
)
def motion_of_y() -> Check:
    rod, theta, (gamma1, gamma2, _), (f1, f2, _), rates = loaded_rod()
    (F1, F2, _), (c, s) = rod.stress, rod.frame[0]
    return Check(
        printed=(rod.du(F1) - rod.du(theta) * F2) * s / gamma1 + (rod.du(F2) + rod.du(theta) * F1) * c / gamma2,
        derived=rates[1],
        condition=("no force acts from outside", {f1: 0, f2: 0}),
        fields=rod,
    )


@SECTION.states(
    "(73)",
    "rate of theta for any law",
    r"\dot\theta=\frac1{\gamma_3}[M'+(x'\sin\theta-y'\cos\theta)F_1+(x'\cos\theta+y'\sin\theta)F_2]",
    r"\dot\theta=\frac1{\gamma_3}[M'+(x'\sin\theta-y'\cos\theta)F_1+(x'\cos\theta+y'\sin\theta)F_2+m]",
    remark="The couple of (72) is left out, as the force is in the rates of x and y.",
    part="(73c)",
)
def motion_of_theta() -> Check:
    rod, _, (_, _, gamma3), (_, _, m), rates = loaded_rod()
    (F1, F2, M), (c, s), (x, y) = rod.stress, rod.frame[0], rod.position
    return Check(
        printed=(
            rod.du(M) + (rod.du(x) * s - rod.du(y) * c) * F1 + (rod.du(x) * c + rod.du(y) * s) * F2
        ) / gamma3,
        derived=rates[2],
        condition=("no couple acts from outside", {m: 0}),
        fields=rod,
    )  # fmt: skip


@SECTION.states("(74)", "a clamped end keeps its configuration", r"\varphi=\mathrm{const}")
def clamped_end() -> Check:
    rod = Motion(SE2)
    phi = rod.configuration
    still = {in_jets(e.left, rod): e.right for e in solved_by_geocosserat().left.equations}  # what the package asks for
    return Check(
        printed=np.zeros((3, 3), dtype=int),
        derived=put(rod.dt(phi), still),
        defines=True,
        also=[("what keeps its configuration has no twist", SE2.vee(SE2.inverse(phi) @ rod.dt(phi)), rod.twist)],
        fields=rod,
    )


@SECTION.states("(75)", "at a free end all three components of the stress vanish", r"\Sigma=0\iff F_1=0,\;F_2=0,\;M=0")
def free_end() -> Check:
    rod, theta = planar_rod()
    F1, F2, M = rod.stress
    power = dot(rod.world(np.array([F1, F2])), rod.dt(rod.position)) + M * rod.dt(theta)  # zero however the end moves
    asked = [in_jets(e.residual, rod) for e in solved_by_geocosserat().right.equations]
    return Check(
        printed=[F1, F2, M],
        derived=[power.diff(V) for V in rod.twist],
        also=[("the package asks for the same", asked, rod.stress)],
        fields=rod,
    )


@SECTION.states(
    "I58",
    "a linear law, uncoupled",
    r"F_1=k_1(h_1-1),\quad F_2=k_2h_2,\quad M=k_3\Pi",
    remark="For the straight reference (1, 0, 0) and a diagonal stiffness.",
)
def linear_law() -> Check:
    rod = Motion(SE2)
    k1, k2, k3 = rod.constants("k", 3)
    h1, h2, Pi = rod.turn
    energy = in_jets(solved_by_geocosserat().energy, rod)
    return Check(
        printed=[k1 * (h1 - 1), k2 * h2, k3 * Pi],
        derived=[in_jets(law.right, rod) for law in solved_by_geocosserat().stress_law],
        defines=True,
        also=[("it has an energy", [k1 * (h1 - 1), k2 * h2, k3 * Pi], [energy.diff(E) for E in rod.turn])],
    )


@SECTION.states(
    "I59",
    "the same friction along and across",
    r"\gamma_1=\gamma_2=\gamma",
    remark="Then friction has no direction: seen in the world it is gamma times the velocity, as (76) has it.",
)
def one_friction() -> Check:
    rod = Motion(SE2)
    gamma = rod.constant("gamma")
    drag = rod.body(gamma * rod.dt(rod.position))  # left sides of (76)
    v1, v2, _ = rod.twist
    return Check(printed=[gamma, gamma], derived=[drag[0].diff(v1), drag[1].diff(v2)], defines=True, fields=rod)


@SECTION.states(
    "I60",
    "the same stiffness against stretch and shear",
    r"k_1=k_2=k",
    remark="Then the force is k (r' - e1), whatever the direction, and (76) has its slope. k must not vary along the "
    "rod.",
)
def one_stiffness() -> Check:
    rod, theta = planar_rod()
    k = rod.constant("k")
    (h1, h2, _), (x, y), (c, s) = rod.turn, rod.position, rod.frame[0]
    force = k * (rod.du(rod.position) - rod.frame[0])
    F1, F2 = rod.body(force)
    bracket = [rod.du(rod.du(x)) + rod.du(theta) * s, rod.du(rod.du(y)) - rod.du(theta) * c]
    return Check(
        printed=[k, k],
        derived=[F1.diff(h1), F2.diff(h2)],
        defines=True,
        also=[("its slope is what (76) has", rod.du(force), k * np.array(bracket))],
        fields=rod,
    )


@SECTION.states(
    r"U7 [76, x-line, \nonumber]",
    "rate of x for the linear law",
    r"\gamma\dot x=k(x''+\theta'\sin\theta)",
    remark="For constant k and gamma, the reference (1, 0, 0) and no load.",
)
def linear_motion_of_x() -> Check:
    rod, theta, rates = linear_rod()
    (x, _), (_, s) = rod.position, rod.frame[0]
    k, gamma = sp.symbols("k gamma")
    return Check(printed=k * (rod.du(rod.du(x)) + rod.du(theta) * s), derived=gamma * rates[0], fields=rod)


@SECTION.states(
    r"U8 [76, y-line, \nonumber]",
    "rate of y for the linear law",
    r"\dot{\gamma y}=k(y''-\theta'\cos\theta)",
    remark="The dot is over gamma and y: gamma does not depend on time, so this is gamma times the rate of y.",
)
def linear_motion_of_y() -> Check:
    rod, theta, rates = linear_rod()
    (_, y), (c, _) = rod.position, rod.frame[0]
    k, gamma = sp.symbols("k gamma")
    return Check(
        printed=k * (rod.du(rod.du(y)) - rod.du(theta) * c),
        derived=gamma * rates[1],
        also=[("gamma may stand before the dot", rod.dt(gamma * y), gamma * rod.dt(y))],
        fields=rod,
    )


@SECTION.states(
    "(76)",
    "rate of theta for the linear law",
    r"\gamma_3\dot\theta=k_3\theta''+k(y'\cos\theta-x'\sin\theta)",
)
def linear_motion_of_theta() -> Check:
    rod, theta, rates = linear_rod()
    (x, y), (c, s) = rod.position, rod.frame[0]
    k, k3, gamma3 = sp.symbols("k k3 gamma3")
    return Check(
        printed=k3 * rod.du(rod.du(theta)) + k * (rod.du(y) * c - rod.du(x) * s),
        derived=gamma3 * rates[2],
        fields=rod,
    )


@SECTION.states(
    "(77)",
    "the clamp is at the origin of the world, its axes along those of the world",
    r"x=0,\quad y=0,\quad\theta=0",
    remark="The constant of (74) is then the identity; any other clamp differs by a change of the world's axes.",
)
def clamp_in_coordinates() -> Check:
    clamp = SE2.identity().astype(int)
    (x, y), (c, s) = SE2.position(clamp), SE2.rotation(clamp)[:, 0]
    return Check(
        printed=[0, 0, 0],
        derived=[x, y, s],
        defines=True,
        also=[("theta is zero, not half a turn", 1, c)],
    )


@SECTION.states(
    "(78)",
    "a free end has its stretch at rest",
    r"x'\cos\theta+y'\sin\theta=\bar h_1",
    remark="What is said of the stress in (75), since no stiffness is zero.",
    part="(78a)",
)
def free_end_stretch() -> Check:
    rod, _ = planar_rod()
    (x, y), (c, s) = rod.position, rod.frame[0]
    k1, rest = rod.constant("k1"), rod.constant("rest")
    F1 = k1 * (rod.turn[0] - rest)
    return Check(printed=rod.du(x) * c + rod.du(y) * s - rest, derived=F1 / k1, fields=rod)


@SECTION.states("(78)", "a free end has its shear at rest", r"-x'\sin\theta+y'\cos\theta=\bar h_2", part="(78b)")
def free_end_shear() -> Check:
    rod, _ = planar_rod()
    (x, y), (c, s) = rod.position, rod.frame[0]
    k2, rest = rod.constant("k2"), rod.constant("rest")
    F2 = k2 * (rod.turn[1] - rest)
    return Check(printed=-rod.du(x) * s + rod.du(y) * c - rest, derived=F2 / k2, fields=rod)


@SECTION.states("(78)", "a free end has its bend at rest", r"\theta'=\bar\Pi", part="(78c)")
def free_end_bend() -> Check:
    rod, theta = planar_rod()
    k3, rest = rod.constant("k3"), rod.constant("rest")
    M = k3 * (rod.turn[2] - rest)
    return Check(printed=rod.du(theta) - rest, derived=M / k3, fields=rod)


@SECTION.states(
    "P17",
    "three equations; coupled, nonlinear and parabolic, each of them",
    r"\text{(76): three coupled nonlinear parabolic equations}",
    remark="Counted: the equations, those that hold another unknown, those that are not linear, and the positive "
    "coefficients of the second derivatives. These are k/gamma, k/gamma and k3/gamma3, each of the own unknown: "
    "parabolic, for positive friction and stiffness.",
)
def kind_of_equations() -> Check:
    rod, unknowns, rates = coordinate_rod()
    k, k3, gamma, gamma3 = sp.symbols("k k3 gamma gamma3", positive=True)
    c, s = sp.symbols("c s")

    def depends(e: sp.Expr) -> bool:
        return not compare(e, 0, rod).vanishes

    slopes = [[rate.diff(slope) for slope in rod.du(unknowns)] for rate in rates]
    coupled = [any(depends(a) for j, a in enumerate(row) if i != j) for i, row in enumerate(slopes)]
    nonlinear = [any(depends(c * a.diff(s) - s * a.diff(c)) for a in row) for row in slopes]  # a varies with theta
    second = [[rate.diff(curve) for curve in rod.du(rod.du(unknowns))] for rate in rates]
    diffusion = [k / gamma, k / gamma, k3 / gamma3]
    return Check(
        printed=[3, 3, 3, 3],
        derived=[len(rates), sum(coupled), sum(nonlinear), sum(a.is_positive for a in diffusion)],
        also=[("each second derivative is that of the own unknown", second, np.diag(diffusion))],
        fields=rod,
    )
