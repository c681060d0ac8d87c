"""The limits of frozen modes against equations of the same rods written down by hand from vectors in the world."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import pytest
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3
from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.elimination import put_in
from geocosserat.derivation.equations import derive
from geocosserat.derivation.forms import document
from geocosserat.derivation.limit import LimitEquations, limit
from geocosserat.derivation.notation import T, U, field, field_names, fields, symbol
from geocosserat.derivation.printing import to_latex, to_text
from geocosserat.model.effects.weight import Weight
from geocosserat.model.errors import InputError
from geocosserat.model.records import End
from tests.derivation.rods import random_value
from tests.derivation.scenes import (
    BASE,
    FROZEN,
    FULL,
    NUMBERS,
    QUASISTATIC,
    VALUES,
    derived,
    diagonal,
    limited,
    number,
    planar,
    same,
    spatial,
    vector,
)  # fmt: skip

SCENES = pytest.mark.parametrize("name", FROZEN)
k1, k2, k3, k4, g1, g2, g3, g4 = (
    symbol(name) for name in ("k1", "k2", "k3", "k4", "gamma1", "gamma2", "gamma3", "gamma4")
)
theta, h1, h2, F1 = fields(("theta", "h1", "h2", "F1"))


def names(limits: LimitEquations) -> tuple[str, ...]:
    """The unknowns."""
    return tuple(f.func.__name__ for f in limits.unknowns)


def residuals(limits: LimitEquations) -> dict[str, sp.Expr]:
    """Each row as right - left, by the unknown that it fixes."""
    return {f.func.__name__: -e.residual for f, e in zip(limits.fixes, limits.rows, strict=True)}


def printed(limits: LimitEquations) -> str:
    """The limit as text, without breaks."""
    return " ".join(to_text(document(limits.equations, "limit")).split())


# the plane, from vectors of the world


def by_hand(stretch: sp.Expr, shear: sp.Expr, tension: sp.Expr, force: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """What a planar rod with those strains and those forces along e1 and e2 must satisfy: three zeros.

    The frame is e1 = (cos, sin), e2 = (-sin, cos) of theta; the slope of the line is r' = stretch e1 + shear e2.
    Without inertia n' + drag = 0 with n = tension e1 + force e2 and drag = -g1 v1 e1 - g2 v2 e2: this gives v. The line
    is moved by v, so the rate of r' is the slope of v: two zeros, along e1 and e2. The moment k3 theta' balances the
    lever r' x n and the drag -g3 theta_t: the third.
    """
    e1 = np.array([sp.cos(theta), sp.sin(theta)], dtype=object)
    e2 = np.array([-sp.sin(theta), sp.cos(theta)], dtype=object)
    slope, n = stretch * e1 + shear * e2, tension * e1 + force * e2
    pull = np.array([x.diff(U) for x in n], dtype=object)
    v = (pull @ e1) / g1 * e1 + (pull @ e2) / g2 * e2
    gap = np.array([x.diff(U) - y.diff(T) for x, y in zip(v, slope, strict=True)], dtype=object)
    lever = slope[0] * n[1] - slope[1] * n[0]
    moment = k3 * theta.diff(U, 2) + lever - g3 * theta.diff(T)
    return gap @ e1, gap @ e2, moment


def agrees(found: sp.Expr, expected: sp.Expr) -> bool:
    """The same number, 30 digits, at five random values of every field and derivative; theta enters only by these."""
    return all(abs(number(found - expected, s)) <= sp.Float("1e-30") * (1 + abs(number(expected, s))) for s in range(5))


@pytest.mark.parametrize("spin", [0, "gamma3"], ids=["no rotational friction", "rotational friction"])
def test_neither_stretch_nor_shear_is_the_nonlinear_euler_bernoulli_rod(spin: str | int) -> None:
    """In (theta, F1): r' = e1, and the force along e2 is what the moment needs, g3 theta_t - k3 theta''."""
    limits = limit(derive(planar(frozen=("h1", "h2"), friction=diagonal("gamma1", "gamma2", spin))))
    still = {g3: sp.S.Zero} if spin == 0 else {}
    force = (g3 * theta.diff(T) - k3 * theta.diff(U, 2)).subs(still)
    inextensible, unshearable, moment = by_hand(sp.S.One, sp.S.Zero, F1, force)
    assert moment.subs(still).expand().subs(sp.sin(theta) ** 2, 1 - sp.cos(theta) ** 2).expand() == 0
    assert names(limits) == ("theta", "F1")
    assert agrees(residuals(limits)["F1"], inextensible)
    assert agrees(residuals(limits)["theta"], unshearable)
    assert [f.func.__name__ for f in limits.multipliers] == ["F1"]


def test_the_euler_bernoulli_equations_are_those_of_the_books() -> None:
    """Without rotational friction, term by term: drag along the rod over g1, across it over g2.

    v1 = (F1' - theta' F2)/g1 and v2 = (F2' + theta' F1)/g2 with F2 = -k3 theta''; then 0 = v1' - theta' v2 and
    theta_t = v2' + theta' v1.
    """
    limits = limit(derive(planar(frozen=("h1", "h2"), friction=diagonal("gamma1", "gamma2", 0))))
    Pi, bends = theta.diff(U), [theta.diff(U, n) for n in range(5)]
    tension = (F1.diff(U, 2) + k3 * bends[2] ** 2 + k3 * Pi * bends[3]) / g1 - (-k3 * Pi * bends[3] + Pi**2 * F1) / g2
    turning = (-k3 * bends[4] + bends[2] * F1 + Pi * F1.diff(U)) / g2 + (Pi * F1.diff(U) + k3 * Pi**2 * bends[2]) / g1
    first, second = limits.rows
    assert (first.left, second.left) == (0, theta.diff(T))
    assert same(first.right, tension)
    assert same(second.right, turning)


def test_a_rod_that_cannot_stretch_but_shears_is_nonlinear_timoshenko() -> None:
    """In (theta, h2, F1): r' = e1 + h2 e2, the force along e2 is k2 h2, and the moment balance moves theta."""
    limits = limit(derive(planar(frozen=("h1",))))
    inextensible, shearing, moment = by_hand(sp.S.One, h2, F1, k2 * h2)
    assert names(limits) == ("theta", "h2", "F1")
    assert agrees(residuals(limits)["F1"], inextensible)
    assert agrees(residuals(limits)["h2"], shearing)
    assert agrees(residuals(limits)["theta"], moment)


@pytest.mark.parametrize("spin", [0, "gamma3"], ids=["no rotational friction", "rotational friction"])
def test_a_rod_that_stretches_but_cannot_shear(spin: str | int) -> None:
    """In (theta, h1), no multiplier left: r' = h1 e1, tension k1 (h1 - 1), and the moment gives h1 F2."""
    limits = limit(derive(planar(frozen=("h2",), friction=diagonal("gamma1", "gamma2", spin))))
    still = {g3: sp.S.Zero} if spin == 0 else {}
    force = (g3 * theta.diff(T) - k3 * theta.diff(U, 2)).subs(still) / h1
    stretching, unshearable, _ = by_hand(h1, sp.S.Zero, k1 * (h1 - 1), force)
    assert names(limits) == ("theta", "h1")
    assert limits.multipliers == ()
    assert limits.divided
    assert agrees(residuals(limits)["h1"], stretching)
    assert agrees(residuals(limits)["theta"], unshearable)


def test_an_inextensible_rod_under_its_weight() -> None:
    """The weight is one more force: n' + f + drag = 0 with f = (0, -wa) in the world."""
    weight = Weight(vector(0, "-wa"))
    limits = limit(derive(planar(frozen=("h1", "h2"), friction=diagonal("gamma1", "gamma2", 0), effects=(weight,))))
    wa, s, c = symbol("wa"), sp.sin(theta), sp.cos(theta)
    Pi, F2 = theta.diff(U), -k3 * theta.diff(U, 2)
    v1 = (F1.diff(U) - Pi * F2 - wa * s) / g1
    v2 = (F2.diff(U) + Pi * F1 - wa * c) / g2
    assert same(limits.rows[0].right, v1.diff(U) - Pi * v2)
    assert same(limits.rows[1].right - limits.rows[1].left, v2.diff(U) + Pi * v1 - theta.diff(T))
    assert names(limits) == ("theta", "F1")


@pytest.mark.parametrize(("group", "length"), [(SE2, 3), (SE3, 6)], ids=["planar", "spatial"])
def test_pure_stretch_is_diffusion(group: object, length: int) -> None:
    """g1 h1_t = (k1 (h1 - 1))'' of a rod that only stretches; no multiplier is needed."""
    model = planar() if group is SE2 else spatial()
    stiffness = diagonal("k1*(1 + u)", *["k2"] * (length - 1))
    for friction in (model.friction, QUASISTATIC[model.group]):
        frozen = model.group.strain[1:]
        limits = limit(derive(dataclasses.replace(model, frozen=frozen, stiffness=stiffness, friction=friction)))
        (row,) = limits.rows
        assert row.left == h1.diff(T)
        assert same(row.right, (k1 * (1 + U) * (h1 - 1)).diff(U, 2) / g1)
        assert limits.multipliers == ()
        assert [(e.left, e.right) for e in limits.right.equations] == [(h1, 1)]


def test_pure_twist_is_diffusion() -> None:
    """g3 Pi1_t = (k3 (Pi1 - reference))'' of a straight rod that only twists, whatever else has friction."""
    Pi1 = field("Pi1")
    for friction in (spatial().friction, QUASISTATIC[SE3]):
        model = spatial(
            frozen=("h1", "h2", "h3", "Pi2", "Pi3"), friction=friction, reference=vector(1, 0, 0, "a*u", 0, 0)
        )
        limits = limit(derive(model))
        (row,) = limits.rows
        assert row.left == Pi1.diff(T)
        assert same(row.right, (k3 * (Pi1 - symbol("a") * U)).diff(U, 2) / g3)
        assert {s.equation.left.func.__name__ for s in limits.solved if s.equation.right == 0} >= {"F1", "M3", "v2"}


@pytest.mark.parametrize(
    "right",
    [End("free", force=vector(0, "a")), End("free", torque=vector("a")), End("driven", twist=vector(0, "a", 0))],
    ids=["force", "torque", "drive"],
)
def test_multipliers_that_an_end_drives_are_kept(right: End) -> None:
    """A rod that only stretches, loaded or moved across itself: what keeps it straight is not zero."""
    limits = limit(derive(planar(frozen=("h2", "Pi"), right=right)))
    assert names(limits) == ("h1", "F2", "M")
    assert not any(s.origin == "nothing drives it" for s in limits.solved)
    along = End("free", force=vector("a", 0))
    assert names(limit(derive(planar(frozen=("h2", "Pi"), right=along)))) == ("h1",)


def test_multipliers_that_an_effect_drives_are_kept() -> None:
    """A couple bends the rod, and what keeps it straight is a moment; without it there is none."""
    couple = FULL[SE2].effects[2]
    assert names(limit(derive(planar(frozen=("h2", "Pi"), effects=(couple,))))) == ("h1", "F2", "M")


# space, in components: (R a)' = R (a' + Pi x a)


def kirchhoff(friction: Sequence[sp.Expr]) -> dict[str, Sequence[sp.Expr]]:
    """Twist and zeros of the Kirchhoff rod, r' = e1: velocities by friction, h constant, Pi compatible.

    F and M in the moving frame: drag balances F' + Pi x F and M' + Pi x M + e1 x F. That r' = e1 stays so: the slope of
    the velocity, v' + Pi x v, is the rate of e1, Omega x e1. That R is one frame: Pi_t = Omega' + Pi x Omega.
    """
    Pi, F = (np.array(fields(f"{letter}{i}" for i in (1, 2, 3)), dtype=object) for letter in ("Pi", "F"))
    M = np.array([k3, k4, k4 + 1], dtype=object) * Pi
    e1 = np.array([1, 0, 0], dtype=object)

    def carried(a: np.ndarray) -> np.ndarray:
        return np.array([x.diff(U) for x in a], dtype=object) + np.cross(Pi, a)

    v = carried(F) / np.array([g1, g2, g2], dtype=object)
    moments = carried(M) + np.cross(e1, F)
    Omega = np.array(
        [m / g if g != 0 else field(f"Omega{i}") for i, (m, g) in enumerate(zip(moments, friction, strict=True), 1)]
    )
    return {
        "moments": moments,
        "constraints": carried(v) - np.cross(Omega, e1),
        "rates": carried(Omega) - np.array([x.diff(T) for x in Pi], dtype=object),
    }


def test_the_kirchhoff_rod() -> None:
    """h1, h2, h3 frozen in space: three evolution equations for Pi and three constraints for the multipliers F."""
    limits = limit(derive(spatial(frozen=("h1", "h2", "h3"))))
    found, expected = residuals(limits), kirchhoff((g3, g4, g4))
    assert names(limits) == ("Pi1", "Pi2", "Pi3", "F1", "F2", "F3")
    for i in range(3):
        assert same(found[f"F{i + 1}"], expected["constraints"][i])
        assert same(found[f"Pi{i + 1}"], expected["rates"][i])


def test_the_kirchhoff_rod_whose_bending_has_no_friction() -> None:
    """The moment balances give F2 and F3, the constraints the spins Omega2 and Omega3: in (Pi, F1) alone."""
    limits = limit(derive(spatial(frozen=("h1", "h2", "h3"), friction=QUASISTATIC[SE3])))
    expected = kirchhoff((g3, sp.S.Zero, sp.S.Zero))
    F2, F3, Omega2, Omega3 = fields(("F2", "F3", "Omega2", "Omega3"))
    # M2' + (Pi x M)_2 - F3 = 0 and M3' + (Pi x M)_3 + F2 = 0
    forces = {F3: expected["moments"][1] + F3, F2: F2 - expected["moments"][2]}
    constraints = [put_in(e, forces) for e in expected["constraints"]]
    # the second constraint ends in -Omega3, the third in +Omega2
    spins = {Omega3: constraints[1] + Omega3, Omega2: Omega2 - constraints[2]}
    found = residuals(limits)
    assert names(limits) == ("Pi1", "Pi2", "Pi3", "F1")
    assert same(found["F1"], put_in(constraints[0], spins))
    for i in range(3):
        assert same(found[f"Pi{i + 1}"], put_in(put_in(expected["rates"][i], forces), spins))


def test_twist_without_friction_stays_an_equation() -> None:
    """Nothing gives Omega1 in closed form: the twisting balance is kept, and fixes the twist."""
    friction = diagonal("gamma1", "gamma2", "gamma2", 0, 0, 0)
    limits = limit(derive(spatial(frozen=("h1", "h2", "h3"), friction=friction)))
    assert names(limits) == ("Pi1", "Pi2", "Pi3", "Omega1", "F1")
    Pi1, Pi2, Pi3 = fields(("Pi1", "Pi2", "Pi3"))
    row = limits.rows[limits.fixes.index(Pi1)]
    assert row.left == 0
    assert same(row.right, k3 * Pi1.diff(U) + Pi2 * Pi3)
    assert "No equation gives Omega1 in closed form." in printed(limits)


def test_a_spatial_rod_with_one_free_bend_is_the_planar_one() -> None:
    """Pi3 alone is free: F3, M1 and M2 vanish, and theta' is Pi3."""
    flat = limit(
        derive(
            planar(frozen=("h1", "h2"), stiffness=diagonal("k1", "k2", "k4"), friction=diagonal("gamma1", "gamma2", 0))
        )
    )
    stiffness = diagonal("k1", "k2", "k2", "k3", "k3", "k4")
    solid = limit(
        derive(spatial(frozen=("h1", "h2", "h3", "Pi1", "Pi2"), stiffness=stiffness, friction=QUASISTATIC[SE3]))
    )
    assert names(solid) == ("Pi3", "F1")
    bend = {field("Pi3"): theta.diff(U)}
    inextensible, turning = flat.rows
    assert same(put_in(solid.rows[0].right, bend), inextensible.right)
    assert same(put_in(solid.rows[1].right, bend), turning.right.diff(U))
    assert {s.equation.left.func.__name__ for s in solid.solved if s.origin == "nothing drives it"} == {"M1", "M2"}


# every scene


@SCENES
def test_the_limit_says_what_the_closed_system_says(name: str) -> None:
    """With what was eliminated put in, each closed equation is 0 = 0 or one of the limit's, up to sign."""
    equations, limits = derived(name), limited(name)
    values = {s.equation.left: s.equation.right for s in limits.solved}
    rows = [number(e.residual, 7) for e in limits.rows]
    left = []
    for e in equations.closed:
        found = number(put_in(e.residual, values).doit(), 7)
        if abs(found) > sp.Float("1e-28"):
            assert any(abs(abs(found) - abs(row)) < sp.Float("1e-25") * (1 + abs(row)) for row in rows), e
            left.append(e)
    assert len(left) == len(rows) == len(limits.unknowns)
    sides = [side for e in limits.rows for side in (e.left, e.right)]
    assert field_names(sides) == field_names(limits.unknowns)
    assert sorted(limits.fixes, key=str) == sorted(limits.unknowns, key=str)
    for end in (limits.left, limits.right):
        assert field_names(side for e in end.equations for side in (e.left, e.right)) <= field_names(limits.unknowns)


@SCENES
def test_the_limit_prints_in_every_way(name: str) -> None:
    """Text, ASCII and LaTeX; no wrench, no orientation, and the unknowns named."""
    laid_out = document(derived(name), "limit")
    text, plain, latex = to_text(laid_out), to_text(laid_out, unicode=False), to_latex(laid_out)
    assert plain.isascii()
    assert latex.count("{") == latex.count("}")
    for words in (text, plain, latex):
        assert "Limit of the " in words.splitlines()[0]
        assert "Closed system" in words
        assert "wrench" not in words
        assert "Derivative" not in words
        assert "Subs" not in words


@pytest.mark.parametrize("frozen", [("h1",), ("h1", "h2"), ("Pi",)], ids=" ".join)
def test_a_planar_rod_that_feels_everything_has_a_limit(frozen: tuple[str, ...]) -> None:
    """All effects, a moving reference, loads on one end, the other driven."""
    model = dataclasses.replace(
        FULL[SE2],
        frozen=frozen,
        reference=vector("1 + a*t", "b*u", "sin(t)"),
        left=End("driven", twist=vector(0, "t", 0)),
        right=End("free", force=vector("a", "t"), frame="world"),
    )
    limits = limit(derive(model))
    assert len(limits.rows) == len(limits.unknowns)
    assert {"x", "y", "theta"} <= set(names(limits))
    assert "Small motions about the straight rod at rest: none are printed" in printed(limits)


def test_a_rod_in_space_that_feels_everything_has_a_limit() -> None:
    """As many equations as unknowns, the place and the frame among them."""
    limits = limit(derive(dataclasses.replace(FULL[SE3], frozen=("h1", "h2", "h3"))))
    assert len(limits.rows) == len(limits.unknowns) == 3 + 3 + 9 + 3


def test_a_rod_without_frozen_modes_has_no_limit() -> None:
    """One message: what was expected, what was found, what to do."""
    with pytest.raises(
        InputError, match=r'rod.frozen: expected a rod with frozen modes, found none; name some .*\["h1"\]'
    ):
        document(derive(planar()), "limit")


def test_where_friction_steps_the_velocities_stay_unknown() -> None:
    """The velocity is continuous there, friction is not: what friction gives must not be differentiated."""
    friction = diagonal("1 + heaviside(u - 0.5)", 1, 0)
    limits = limit(derive(planar(frozen=("h1", "h2"), friction=friction)))
    assert names(limits) == ("theta", "v1", "F1")
    assert not any(side.has(sp.DiracDelta) for e in limits.rows for side in (e.left, e.right))
    assert "No equation gives v1 in closed form." in printed(limits)


def test_where_the_law_steps_the_stress_stays_unknown() -> None:
    """The moment is continuous where the bending stiffness steps; it stays with its law."""
    stiffness = diagonal("k1", "k2", "k3*(1 + heaviside(u - 0.5))")
    limits = limit(derive(planar(frozen=("h1", "h2"), stiffness=stiffness, friction=diagonal("gamma1", "gamma2", 0))))
    assert set(names(limits)) == {"theta", "M", "F1"}
    assert not any(side.has(sp.DiracDelta) for e in limits.rows for side in (e.left, e.right))


def test_friction_that_couples_few_velocities_is_inverted_and_much_of_it_is_kept() -> None:
    """A numerical matrix is always inverted; of symbols no more than three at a time."""
    few = (vector("gamma1", "a", 0), vector("a", "gamma2", 0), vector(0, 0, "gamma3"))
    limits = limit(derive(planar(frozen=("h1", "h2"), friction=few)))
    assert names(limits) == ("theta", "F1")
    a = symbol("a")
    assert not any(e.left == 0 and e.right.has(field("v1")) for e in limits.rows)
    assert any(e.right.has(a) for e in limits.rows)
    numbers = tuple(vector(*(9 if i == j else 1 / (1 + i + j) for j in range(6))) for i in range(6))
    assert names(limit(derive(spatial(frozen=("h1", "Pi1", "Pi2", "Pi3"), friction=numbers)))) == (
        "h2", "h3", "F1", "M1", "M2", "M3"
    )  # fmt: skip
    many = tuple(vector(*("gamma1 + 9" if i == j else "a" for j in range(6))) for i in range(6))
    kept = names(limit(derive(spatial(frozen=("h1", "Pi1", "Pi2", "Pi3"), friction=many))))
    assert set(SE3.twist) <= set(kept)


# how it reads


def test_the_euler_bernoulli_limit_reads_as_one_would_write_it() -> None:
    """Nonlinear and linear, in ASCII."""
    model = planar(frozen=("h1", "h2"), friction=diagonal("gamma1", "gamma2", 0))
    lines = to_text(document(derive(model), "limit"), unicode=False).splitlines()
    for line in (
        "  unknown y = (theta, F1)",
        "     F2 = -k3 theta_uu",
        "  2 equations for the 2 unknown fields theta and F1; in the order in which they stand they fix F1",
        "  and theta. F1 is a Lagrange multiplier.",
        "  theta_t = -k3 theta_uuuu/gamma2",
        "        0 = F1_uu/gamma1",
        "  theta is the angle of e1 from the world's x axis. F2 by the row of Omega; v1 and v2 by friction.",
    ):
        assert line in lines, line
    assert "k1" not in "\n".join(lines)
    assert len([line for line in lines if line.startswith("Small motions")]) == 1


def test_the_ends_of_the_limit_are_those_of_a_cantilever() -> None:
    """Clamped: neither velocity nor spin. Free: no tension, no moment, no shear force."""
    limits = limit(derive(planar(frozen=("h1", "h2"), friction=diagonal("gamma1", "gamma2", 0))))
    assert [(e.left, e.right) for e in limits.right.equations] == [
        (F1, 0), (theta.diff(U, 2), 0), (theta.diff(U), 0)
    ]  # fmt: skip
    v1, v2, spin = (e.left for e in limits.left.equations)
    assert same(v1, (F1.diff(U) + k3 * theta.diff(U) * theta.diff(U, 2)) / g1)
    assert same(v2, (theta.diff(U) * F1 - k3 * theta.diff(U, 3)) / g2)
    assert spin == theta.diff(T)


def test_joined_ends_are_those_of_the_rod() -> None:
    """They are said in what the cross-section shares."""
    model = planar(frozen=("h1",), joined=True, left=End("free"), right=End("free"))
    text = to_text(document(derive(model), "limit"), unicode=False)
    assert "v1(0) = v1(1)" in text
    assert "as eliminated above" in text


def test_all_parameters_have_values() -> None:
    """The helper's numbers cover every name that a scene of these tests uses."""
    assert {str(s) for s in NUMBERS} == set(VALUES)
    assert not random_value(to_sympy(BASE[SE2].stiffness[0][0]).xreplace(NUMBERS), 1).free_symbols
