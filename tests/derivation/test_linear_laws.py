"""Laws of the linear equations: textbook rods, frames that do not matter, symmetry where there is an energy."""

from __future__ import annotations

import dataclasses

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.derivation.elimination import put_in
from geocosserat.derivation.equations import derive
from geocosserat.derivation.known_base import known_base
from geocosserat.derivation.linear import about, base_of, linearise
from geocosserat.derivation.linear_turn import turn_alone
from geocosserat.derivation.notation import T, U, field, fields, symbol
from geocosserat.model.effects.field import Field
from geocosserat.model.effects.flow import Flow
from geocosserat.model.effects.trap import Trap
from geocosserat.model.effects.weight import Weight
from geocosserat.model.errors import InputError
from geocosserat.model.records import End, RodModel
from tests.derivation.displaced import CLOSE, DIGITS, Array, Displaced, Numbers, of_law, precise, with_effect
from tests.derivation.rods import full
from tests.derivation.scenes import BASE, QUASISTATIC, diagonal, planar, same, spatial, vector
from tests.derivation.test_effects import every

GROUPS = pytest.mark.parametrize("group", [SE2, SE3], ids=["planar", "spatial"])
k1, k2, k3, k4, g1, g2, g3, g4 = (
    symbol(name) for name in ("k1", "k2", "k3", "k4", "gamma1", "gamma2", "gamma3", "gamma4")
)
eta1, eta2, eta3 = fields(("eta1", "eta2", "eta3"))


def numbers(matrix: Array, known: Numbers) -> Array:
    """A matrix of coefficients at a point."""
    return np.array([[precise(sp.S.Zero + e, known) for e in row] for row in matrix], dtype=object)


def largest(matrix: Array) -> sp.Expr:
    """The largest entry."""
    return max(abs(e) for e in matrix.ravel())


def about_its_base(model: RodModel) -> dict[str, sp.Expr]:
    """The right sides about the base that the scene has of its own, by the unknown of the row."""
    linear = linearise(derive(model))
    own = known_base(linear.base)
    assert own is not None
    return {f.func.__name__: e.right for f, e in zip(linear.motion.unknowns, own.of(linear.motion).rows, strict=True)}


def test_about_the_straight_rod_at_rest_stretch_diffuses_and_shear_turns_the_frame() -> None:
    """The overdamped Timoshenko beam, and a diffusion of its own for the stretch."""
    rows = about_its_base(planar())
    assert same(rows["eta1"], k1 * eta1.diff(U, 2) / g1)
    assert same(rows["eta2"], k2 * (eta2.diff(U, 2) - eta3.diff(U)) / g2)
    assert same(rows["eta3"], (k3 * eta3.diff(U, 2) + k2 * (eta2.diff(U) - eta3)) / g3)


def test_about_the_straight_rod_at_rest_twist_diffuses() -> None:
    """In space too, as displacement and as turn; and bends are those of the plane, each with its own friction."""
    rows = about_its_base(spatial())
    eta4, eta5, eta6 = fields(("eta4", "eta5", "eta6"))
    assert same(rows["eta4"], k3 * eta4.diff(U, 2) / g3)
    assert same(rows["eta6"], ((k4 + 1) * eta6.diff(U, 2) + k2 * (eta2.diff(U) - eta6)) / g4)
    assert same(rows["eta5"], (k4 * eta5.diff(U, 2) - k2 * (eta3.diff(U) + eta5)) / g4)
    base = base_of(derive(spatial()))
    alone, own = turn_alone(base), known_base(base)
    assert alone is not None
    assert own is not None
    dPi1 = field("dPi1")
    assert own.of(alone.motion).rows[3].left == dPi1.diff(T)
    assert same(own.of(alone.motion).rows[3].right, k3 * dPi1.diff(U, 2) / g3)


def test_without_stretch_shear_and_turning_friction_it_is_the_beam_of_euler_and_bernoulli() -> None:
    """gamma2 eta2_t = -k3 eta2'''': the frame along the centreline and the force by the moment are put in."""
    rows = about_its_base(planar(frozen=("h1", "h2"), friction=diagonal("gamma1", "gamma2", 0)))
    slender = {eta3: eta2.diff(U), field("dF2"): -k3 * eta2.diff(U, 3), eta1: sp.S.Zero, field("dF1"): sp.S.Zero}
    found = {name: put_in(e, slender) for name, e in rows.items()}
    assert same(found.pop("eta2"), -k3 * eta2.diff(U, 4) / g2)
    assert all(same(e, sp.S.Zero) for e in found.values())


def test_a_straight_rod_under_thrust_has_static_waves_at_the_load_of_haringx() -> None:
    """k3 q^2 = N (1 - N/k1 + N/k2), with the shortening; the geometric stiffness is all that makes it buckle."""
    load = End("free", force=vector("-a", 0), frame="world")
    linear = linearise(derive(planar(right=load)))
    own = known_base(linear.base)
    assert own is not None
    system, (N, x) = own.of(linear.balance), sp.symbols("N x")
    wave = sp.Matrix(system.diffusion) * x**2 + sp.Matrix(system.advection) * x + sp.Matrix(system.reaction)
    thrust = {field("F1"): -N, field("h1"): 1 - N / k1}
    expected = k1 * k2 * x**4 * (k3 * x**2 + N * (1 - N / k1 + N / k2))
    assert sp.expand(wave.xreplace(thrust).det() - expected) == 0
    follower = known_base(base_of(derive(planar(right=End("free", force=vector("-a", 0))))))
    assert follower is not None
    assert "may be" in own.words
    assert "may be" not in follower.words


@pytest.mark.parametrize(
    "change",
    [
        {"effects": (Weight(vector(0, "-wa")),)},
        {"reference": vector("1 + a*t", 0, 0)},
        {"right": End("free", force=vector("-a", 1))},
        {"right": End("free", force=vector("-a*t", 0))},
        {"right": End("free", torque=vector("a"))},
        {"left": End("driven", twist=vector(0, 0, "a"))},
        {"left": End("free"), "joined": True},
        {"reference": vector(1, 0, "a"), "right": End("free", force=vector("-a", 0))},
    ],
    ids=["weight", "active", "across", "in time", "torque", "driven", "ring", "curved and loaded"],
)
def test_a_base_that_would_have_to_be_computed_is_not_guessed(change: dict[str, object]) -> None:
    """Only the symbolic base is there then."""
    assert known_base(base_of(derive(planar(**change)))) is None


def test_a_law_with_stress_at_the_reference_is_not_at_rest_there() -> None:
    """Its reference is no base."""
    stress = {"F1": "h1 - 1", "F2": "h2", "M": "Pi - 1"}
    assert known_base(base_of(derive(of_law("planar", stress)))) is None
    bent = of_law("planar", stress, reference=[1, 0, 1])
    assert known_base(base_of(derive(bent))) is not None


@GROUPS
@pytest.mark.parametrize("frozen", [(), ("h1",)], ids=["free", "frozen"])
def test_the_rates_are_the_balance_less_friction(group: Group, frozen: tuple[str, ...]) -> None:
    """Friction times each matrix of the solved equations is that of the balance, also where friction couples two."""
    d = group.dimension
    coupled = tuple(
        vector(*("1 + u" if i == j else f"b/{1 + i}" if {i, j} == {0, d - 1} else 0 for j in range(d)))
        for i in range(d)
    )
    linear = linearise(derive(dataclasses.replace(BASE[group], friction=coupled, frozen=frozen)))
    solved = linear.motion
    assert [list(row) for row in solved.mass[:d, :d]] == sp.eye(d).tolist()
    known = Displaced(linear.base.equations, 3).at(0)
    friction = numbers(linear.base.friction, known)
    for name in ("diffusion", "advection", "reaction"):
        before, after = (numbers(getattr(s, name), known) for s in (linear.balance, solved))
        assert largest(friction @ after[:d] - before[:d]) < CLOSE * (1 + largest(before))
        assert largest(after[d:] - before[d:]) < CLOSE if frozen else True
        assert largest(before) > 0.01


def test_friction_that_cannot_be_inverted_to_be_read_stays_on_the_left() -> None:
    """A full matrix of parameters; and a rotation without friction has an empty row, the others their rates."""
    linear = linearise(derive(dataclasses.replace(BASE[SE3], friction=full(SE3, "b"))))
    assert not linear.motion.solved
    assert np.all(linear.motion.mass == linear.base.friction)
    still = linearise(derive(dataclasses.replace(BASE[SE3], friction=QUASISTATIC[SE3]))).motion
    assert list(still.mass.diagonal()) == [1, 1, 1, 1, 0, 0]


def turned(group: Group, moved: bool) -> tuple[RodModel, Array, float]:
    """A rod that sees the world in every way; or all of that world turned and shifted, by that motion."""
    n, c, s = group.space, sp.Rational(3, 5), sp.Rational(4, 5)
    Q = np.array(sp.eye(n), dtype=object)
    if moved:
        Q[:2, :2] = [[c, -s], [s, c]]
        if n == 3:
            Q = Q @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]], dtype=object)
    shift = np.array([2, -1, sp.Rational(1, 2)][:n], dtype=object) * int(moved)
    rng = np.random.default_rng(8)
    f, B, centre, w, m = (np.array([sp.Rational(int(x), 8) for x in rng.integers(-9, 9, n)]) for _ in range(5))
    G = np.array([[sp.Rational(int(x), 8) for x in row] for row in rng.integers(-9, 9, (n, n))])

    def write(entries: Array) -> tuple[object, ...]:
        return vector(*(str(e) for e in np.ravel(entries)))

    turned_gradient = Q @ G @ Q.T
    effects_ = (
        Weight(write(Q @ f)),
        Field(write(m), write(Q @ B)),
        Trap(vector(2), write(Q @ centre + shift)),
        Flow(write(turned_gradient), write(Q @ w - turned_gradient @ shift)),
    )
    angle = mp.atan2(4, 3) * int(moved)
    return dataclasses.replace(BASE[group], effects=effects_), group.pose(shift, Q), angle


@GROUPS
def test_a_rigid_motion_of_rod_and_world_changes_nothing(group: Group) -> None:
    """Weight, field, trap and flow turned and shifted along with the base: every coefficient is the same."""
    with mp.workdps(DIGITS):
        (here, _, _), (there, g, angle) = turned(group, moved=False), turned(group, moved=True)
        systems = [linearise(derive(model)).balance for model in (here, there)]
        rods = [Displaced(derive(model), 23) for model in (here, there)]
        other = rods[1]
        number = np.vectorize(lambda x: mp.mpf(sp.Rational(x).p) / sp.Rational(x).q, otypes=[object])
        other.g, other.g_u, other.g_uu, other.g_t = (
            number(g) @ x for x in (other.g, other.g_u, other.g_uu, other.g_t)
        )
        other.angle += angle
        knowns = [rod.at(0) for rod in rods]
        for name in ("diffusion", "advection", "reaction"):
            one, two = (numbers(getattr(s, name), known) for s, known in zip(systems, knowns, strict=True))
            assert largest(one - two) < CLOSE * (1 + largest(one))
        alone = linearise(derive(BASE[group])).balance.reaction
        assert largest(numbers(systems[0].reaction - alone, knowns[0])) > 0.01


@GROUPS
def test_another_frame_in_the_cross_section_gives_the_same_rod(group: Group) -> None:
    """Frames phi a for phi, with a constant a: coefficients change as matrices between forces and displacements."""
    n, rng = group.space, np.random.default_rng(31)
    c, s = sp.Rational(5, 13), sp.Rational(12, 13)
    Q = np.array(sp.eye(n), dtype=object)
    Q[-2:, -2:] = [[c, -s], [s, c]]
    B = group.Ad(group.pose(np.array([sp.Rational(1, 3), -2, sp.Rational(1, 5)][:n], dtype=object), Q))
    stiffness = full(group, "a*(1 + u)")
    model = dataclasses.replace(BASE[group], stiffness=stiffness, friction=full(group, "b"))
    one = linearise(derive(model))
    columns = rng.integers(-20, 20, (4, group.dimension))
    E, E_u, V, S = (sp.Matrix([sp.Rational(int(x), 16) for x in column]) for column in columns)
    M = sp.Matrix(B)
    bases = [(E, E_u, V, S), (M.inv() * E, M.inv() * E_u, M.inv() * V, M.T * S)]
    K, Gamma = sp.Matrix(one.base.tangent), sp.Matrix(one.base.friction)
    tangents = [(K, Gamma), (M.T * K * M, M.T * Gamma * M)]
    found = []
    for (E, E_u, V, S), (K, Gamma) in zip(bases, tangents, strict=True):
        base = dataclasses.replace(one.base, tangent=np.array(K), friction=np.array(Gamma))
        known = dict(zip(fields(group.strain), E, strict=True)) | dict(zip(fields(group.twist), V, strict=True))
        known |= dict(zip(fields(group.stress), S, strict=True))
        known |= {f.diff(U): x for f, x in zip(fields(group.strain), E_u, strict=True)}
        system = about(base).balance
        found.append([numbers(getattr(system, x), known) for x in ("mass", "diffusion", "advection", "reaction")])
    for a, b in zip(*found, strict=True):
        assert largest(B.T @ a @ B - b) < CLOSE * (1 + largest(a))


POTENTIAL = ("weight", "field", "trap", "well")


def asymmetry(model: RodModel, seed: int, balanced: bool = True) -> list[sp.Expr]:
    """How far D, A and R at rest are from those of the transposed operator, by integration by parts.

    ``balanced``: the slope of the stress is what balances the wrench.
    """
    linear = linearise(derive(model))
    equations, system = linear.base.equations, linear.balance
    group = equations.group
    known = Displaced(equations, seed).at(0)
    known |= dict.fromkeys(equations.twist, sp.S.Zero)
    rng = np.random.default_rng(seed)
    for f in fields(group.stress):
        known |= {f: sp.Rational(int(rng.integers(-90, 90)), 64), f.diff(U): sp.S.Zero}
    known |= {e.left: precise(e.right, known) for e in equations.wrench_law}
    pushes = [precise(e.left, known) for e in equations.balance]
    known |= {f.diff(U): -x if balanced else x for f, x in zip(fields(group.stress), pushes, strict=True)}

    def slope(matrix: Array) -> Array:
        return np.array(sp.Matrix(matrix).diff(U))

    D, A, R = system.diffusion, system.advection, system.reaction
    transposed = (D.T, 2 * slope(D).T - A.T, slope(slope(D)).T - slope(A).T + R.T)
    return [largest(numbers(a - b, known)) for a, b in zip((D, A, R), transposed, strict=True)]


@GROUPS
@pytest.mark.parametrize("kind", POTENTIAL)
def test_where_forces_have_a_potential_the_operator_is_symmetric_at_equilibrium(kind: str, group: Group) -> None:
    """In the metric of friction, about any curved and stressed rod at rest, of a stiffness that varies."""
    model = dataclasses.replace(with_effect(group, every(group)[kind]), stiffness=full(group, "a*(1 + u)"))
    assert max(asymmetry(model, 37)) < CLOSE
    assert max(asymmetry(model, 37, balanced=False)) > 0.01


@GROUPS
def test_what_turns_with_the_rod_has_no_potential_and_no_symmetry(group: Group) -> None:
    """Though the rod is in equilibrium; but a couple in the plane turns about one axis, and near any angle it has a
    potential."""
    assert max(asymmetry(with_effect(group, every(group)["follower"]), 37)) > 0.01
    assert bool(max(asymmetry(with_effect(group, every(group)["couple"]), 37)) < CLOSE) == (group is SE2)


def test_a_stiffness_that_is_not_symmetric_has_no_symmetry() -> None:
    """An odd rod."""
    odd = (vector("k1", 0, 0), vector(0, "k2", "a"), vector(0, "-a", "k3"))
    assert max(asymmetry(planar(stiffness=odd), 41)) > 0.01
    assert max(asymmetry(planar(), 41)) < CLOSE


def test_a_stress_that_answers_to_rates_is_refused_with_the_reason() -> None:
    """Kelvin and Voigt: the rates would have to be solved for along the rod."""
    viscous = of_law("planar", {"F1": "h1 - 1", "F2": "h2", "M": "Pi + c*Pi_dot"})
    with pytest.raises(InputError, match=r"--form linearised: expected a stress that answers to the strain alone"):
        linearise(derive(viscous))
