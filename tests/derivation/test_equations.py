"""The derived equations against the vector form of the rod's mechanics, at random points to 30 digits."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3
from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.equations import derive
from geocosserat.derivation.notation import T, U, field, field_names, is_field
from geocosserat.model.effects.weight import Weight
from geocosserat.model.expressions import evaluate
from geocosserat.model.records import End, RodModel
from tests.derivation.rods import (
    HEAVY_PLANAR,
    HEAVY_SPATIAL,
    PLAIN_PLANAR,
    PLAIN_SPATIAL,
    POINTS,
    RODS,
    TINY,
    VALUES,
    diagonal,
    random_motion,
    random_value,
    smooth,
    value,
    vector,
)

ALL = pytest.mark.parametrize("model", RODS.values(), ids=RODS)
HEAVY = pytest.mark.parametrize("model", [HEAVY_PLANAR, HEAVY_SPATIAL], ids=["planar", "spatial"])


@ALL
def test_compatibility_is_the_equality_of_mixed_partials(model: RodModel) -> None:
    """Turn and twist of one smooth configuration field satisfy it, whatever the motion."""
    equations = derive(model)
    explicit = random_motion(model.group, 41).fields()
    for u, t in POINTS:
        for equation in equations.compatibility:
            assert abs(value(equation.residual, explicit, u, t)) < TINY, equation
    assert max(abs(value(e.left, explicit, *POINTS[0])) for e in equations.compatibility) > 0.01


@ALL
def test_compatibility_tells_turn_and_twist_of_different_motions_apart(model: RodModel) -> None:
    """The twist of another motion violates it."""
    explicit = random_motion(model.group, 41).fields()
    other = random_motion(model.group, 43).fields()
    mixed = explicit | {name: other[name] for name in model.group.twist}
    residuals = [abs(value(e.residual, mixed, *POINTS[0])) for e in derive(model).compatibility]
    assert min(residuals) > 1e-6


@ALL
def test_the_balance_is_that_of_forces_and_moments_in_the_world(model: RodModel) -> None:
    """R times the left side is F' + f and M' + r' x F + m of the vectors, for any stress and wrench."""
    group, equations = model.group, derive(model)
    motion = random_motion(group, 41)
    rng = np.random.default_rng(45)
    S, j = (np.array([smooth(rng) for _ in range(group.dimension)], dtype=object) for _ in range(2))
    explicit = motion.fields() | dict(zip((*group.stress, *group.wrench), (*S, *j), strict=True))
    n, R = group.space, motion.rotation
    force, moment, forcing, torque = S[:n], S[n:], j[:n], j[n:]
    slope = [x.diff(U) for x in motion.position]
    turning = R if n == 3 else np.array([[1]], dtype=object)
    # F' + f, then M' + r' x F + m, all in world components; in the plane moments are numbers
    world_force = R @ force
    lever = np.cross(slope, world_force) if n == 3 else [slope[0] * world_force[1] - slope[1] * world_force[0]]
    forces = [x.diff(U) + y for x, y in zip(world_force, R @ forcing, strict=True)]
    moments = [
        (sp.Integer(0) + x).diff(U) + y + z for x, y, z in zip(turning @ moment, lever, turning @ torque, strict=True)
    ]
    for u, t in POINTS:
        left = np.array([value(e.left, explicit, u, t) for e in equations.balance], dtype=object)
        R_here = np.array([[x.evalf(40, subs={U: u, T: t}) for x in row] for row in R], dtype=object)
        turning_here = R_here if n == 3 else np.array([[1]])
        found = [*(R_here @ left[:n]), *(turning_here @ left[n:])]
        for a, b in zip(found, [*forces, *moments], strict=True):
            assert abs(a - b.evalf(40, subs={U: u, T: t})) < TINY
    assert all(e.right == 0 for e in equations.balance)


@ALL
def test_the_stress_law_is_stiffness_times_strain(model: RodModel) -> None:
    """S = K (E - reference), with the coefficients as the scene's own evaluation gives them."""
    equations = derive(model)
    u, t = 0.375, 0.625
    at = {**VALUES, "u": u, "t": t}
    K = np.array([[evaluate(e, at) for e in row] for row in model.stiffness])
    reference = np.array([evaluate(e, at) for e in model.reference])
    E = np.random.default_rng(46).normal(size=model.group.dimension)
    explicit = {name: sp.Float(x, 40) for name, x in zip(model.group.strain, E, strict=True)}
    found = [float(value(e.right, explicit, sp.Rational(3, 8), sp.Rational(5, 8))) for e in equations.stress_law]
    assert found == pytest.approx(K @ (E - reference), rel=1e-13)
    assert tuple(e.left for e in equations.stress_law) == equations.stress


@ALL
def test_the_wrench_is_drag_and_weight_seen_in_the_moving_frame(model: RodModel) -> None:
    """j = -Gamma V + R^T f: turned back into the world, the weight is the force density of the scene."""
    group, equations = model.group, derive(model)
    motion = random_motion(group, 41)
    u, t = POINTS[0]
    at = {**VALUES, "u": float(u), "t": float(t)}
    Gamma = np.array([[evaluate(e, at) for e in row] for row in model.friction])
    V = np.array([float(x.evalf(20, subs={U: u, T: t})) for x in motion.twist])
    R = np.array([[float(x.evalf(20, subs={U: u, T: t})) for x in row] for row in motion.rotation])
    weight = np.sum([[evaluate(e, at) for e in effect.force] for effect in model.effects] or [[0.0] * group.space], 0)
    expected = -Gamma @ V
    expected[: group.space] += R.T @ weight
    found = [float(value(e.right, motion.fields(), u, t)) for e in equations.wrench_law]
    assert found == pytest.approx(expected, rel=1e-12, abs=1e-12)


@HEAVY
def test_orientation_fields_follow_the_moving_frame(model: RodModel) -> None:
    """The frame of a smooth motion satisfies their rates in time and along the rod."""
    equations = derive(model)
    explicit = random_motion(model.group, 41).fields()
    for u, t in POINTS:
        for equation in (*equations.orientation_rates, *equations.orientation_slopes):
            assert abs(value(equation.residual, explicit, u, t)) < TINY, equation
    assert len(equations.orientation_rates) == len(equations.orientation.fields) > 0


@ALL
def test_the_motion_is_the_balance_with_the_laws_put_in(model: RodModel) -> None:
    """Friction minus push is minus the balance, once stress and wrench are replaced by their laws."""
    equations = derive(model)
    laws = {e.left: e.right for e in (*equations.stress_law, *equations.wrench_law)}
    for motion, balance in zip(equations.motion, equations.balance, strict=True):
        spelt_out = balance.left.xreplace(laws).doit()
        for seed in (49, 50):
            found = random_value(motion.residual, seed)
            assert abs(found + random_value(spelt_out, seed)) < TINY * (1 + abs(found))
        assert not motion.right.has(*equations.stress)
        assert not motion.residual.has(*equations.wrench)


@ALL
def test_stored_energy_changes_by_work_minus_dissipation(model: RodModel) -> None:
    """d/dt energy + dissipation - power of the weight - (S.V)' vanishes wherever the motion holds."""
    equations = derive(model)
    rates = {e.left: e.right for e in equations.compatibility}
    assert equations.energy is not None
    S = dict(zip((e.left for e in equations.stress_law), (e.right for e in equations.stress_law), strict=True))
    V = equations.twist
    stored = equations.energy.diff(T).xreplace(rates)
    flux = sp.Add(*(s * v for s, v in zip(S.values(), V, strict=True))).diff(U)
    push = {f: v for f, v in zip(V, [e.right for e in equations.wrench_law], strict=False)}
    at_rest = dict.fromkeys(V, sp.Integer(0))
    weight = sp.Add(*(v * e.right.xreplace(at_rest) for v, e in zip(push, equations.wrench_law, strict=True)))
    violated = sp.Add(*(v * e.residual for v, e in zip(V, equations.motion, strict=True)))
    for seed in (50, 51):
        balance = random_value(stored + equations.dissipation - weight - flux - violated, seed)
        assert abs(balance) < TINY * (1 + abs(random_value(stored, seed)))
        assert abs(random_value(stored, seed)) > 1e-3


@pytest.mark.parametrize("weight", [(), ("a*u", "-g")], ids=["no weight", "weight"])
def test_a_planar_rod_is_a_spatial_rod_in_the_plane(weight: tuple[str, ...]) -> None:
    """With everything out of the plane zero, space gives the plane's equations and 0 = 0 for the rest."""
    effects = (Weight(vector(*weight)),) if weight else ()
    lifted = (Weight(vector(*weight, 0)),) if weight else ()
    planar = dataclasses.replace(
        PLAIN_PLANAR,
        reference=vector("1", "a", "u**2"),
        effects=effects,
        right=End("free", force=vector("a", "t")),
    )
    spatial = RodModel(
        SE3,
        1.0,
        diagonal("kappa", "kappa", "kappa", 3, 4, 1.0),
        diagonal(1.0, 2.0, 5.0, 6.0, 7.0, 0.01),
        vector("1", "a", 0, 0, 0, "u**2"),
        right=End("free", force=vector("a", "t", 0)),
        effects=lifted,
        parameters=VALUES,
    )
    flat, solid = derive(planar), derive(spatial)
    names = {"Pi3": "Pi", "Omega3": "Omega", "M3": "M", "m3": "m"}
    theta = field("theta")
    frame = {"e1x": sp.cos(theta), "e2x": -sp.sin(theta), "e1y": sp.sin(theta), "e2y": sp.cos(theta)}
    kept = {"h1", "h2", "v1", "v2", "F1", "F2", "f1", "f2"}

    def in_plane(e: sp.Expr) -> sp.Expr:
        functions = {f for f in e.atoms(sp.Function) if is_field(f)}
        image = {}
        for f in functions:
            name = f.func.__name__
            image[f] = frame.get(name, field(name) if name in kept else field(names[name]) if name in names else 0)
        return e.subs(image).doit()

    for part in ("compatibility", "balance", "motion", "stress", "wrench", "left end", "right end"):
        inside = flat.parts[part]
        outside = [in_plane(e.residual) for e in solid.parts[part]]
        for k, index in enumerate((0, 1, 5)):
            difference = inside[k].residual - outside[index]
            assert abs(random_value(difference, 52)) < TINY, (part, inside[k])
        assert all(outside[index] == 0 for index in (2, 3, 4)), part


def test_in_space_the_components_are_cross_products() -> None:
    """h_t = v' + Pi x v - Omega x h, Pi_t = Omega' + Pi x Omega; the balance has Pi x F, Pi x M, h x F."""
    equations = derive(PLAIN_SPATIAL)
    E, V, S, j = (
        np.array(x, dtype=object) for x in (equations.turn, equations.twist, equations.stress, equations.wrench)
    )
    h, Pi, v, Omega, F, M = E[:3], E[3:], V[:3], V[3:], S[:3], S[3:]
    rates = [*(np.cross(Pi, v) - np.cross(Omega, h)), *np.cross(Pi, Omega)]
    pulls = [*np.cross(Pi, F), *(np.cross(Pi, M) + np.cross(h, F))]
    for k in range(6):
        assert sp.expand(equations.compatibility[k].right - V[k].diff(U) - rates[k]) == 0
        assert sp.expand(equations.balance[k].left - S[k].diff(U) - pulls[k] - j[k]) == 0


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("group", [SE2, SE3], ids=["planar", "spatial"])
@pytest.mark.parametrize("frame", ["body", "world"])
def test_the_stress_at_a_loaded_end_does_the_power_of_the_load(side: str, group: object, frame: str) -> None:
    """Outward stress times twist is force . velocity + torque . angular velocity, in the load's frame."""
    model = HEAVY_PLANAR if group is SE2 else HEAVY_SPATIAL
    load = (vector("a", "b*t"), vector("g")) if group is SE2 else (vector("a", "b*t", "g"), vector(1, "t", "a"))
    end = End("free", force=load[0], torque=load[1], frame="body" if frame == "body" else "world")
    equations = derive(dataclasses.replace(model, effects=(), **{side: end}))
    motion = random_motion(model.group, 41)
    n, R = model.group.space, motion.rotation
    force, torque = ([to_sympy(x) for x in part] for part in load)
    v, Omega = motion.twist[:n], motion.twist[n:]
    if frame == "world":
        v = R @ v
        Omega = R @ Omega if n == 3 else Omega
    power = sp.Add(*(x * y for x, y in zip([*force, *torque], [*v, *Omega], strict=True)))
    conditions = equations.left if side == "left" else equations.right
    sign = -1 if side == "left" else 1
    done = sp.Add(*(sign * e.right * x for e, x in zip(conditions.equations, motion.twist, strict=True)))
    u, t = POINTS[0]
    assert abs(value(done - power, motion.fields(), u, t)) < TINY
    assert tuple(e.left for e in conditions.equations) == equations.stress


def test_a_clamped_end_does_not_move_and_a_free_end_carries_nothing() -> None:
    """Clamped: V = 0 at u = 0. Free: S = 0 at u = length."""
    equations = derive(PLAIN_PLANAR)
    assert [(e.left, e.right) for e in equations.left.equations] == [(v, 0) for v in equations.twist]
    assert [(e.left, e.right) for e in equations.right.equations] == [(s, 0) for s in equations.stress]
    assert (equations.left.position, equations.right.position) == (0, 1)
    assert derive(HEAVY_PLANAR).right.position == sp.Rational(5, 2)


def test_a_rod_that_does_not_see_the_world_has_no_orientation() -> None:
    """Without weight or dead load there is no orientation field or equation; a follower load needs none."""
    follower = dataclasses.replace(PLAIN_SPATIAL, right=End("free", force=vector(0, "a", 0), frame="body"))
    for model in (PLAIN_PLANAR, PLAIN_SPATIAL, follower):
        equations = derive(model)
        assert equations.orientation.fields == equations.orientation_rates == equations.orientation_slopes == ()
        assert not any(name.startswith(("theta", "e1", "e2", "e3")) for name in equations.fields)
        assert "weight" not in equations.terms


@pytest.mark.parametrize(("force", "axes"), [((0, 0, -1), "z"), (("a", 0, 0), "x"), ((0, 1, "t"), "yz")])
def test_only_the_world_axes_that_act_are_carried(force: tuple[str | int, ...], axes: str) -> None:
    """A weight along z carries e1z, e2z, e3z and no more."""
    equations = derive(dataclasses.replace(PLAIN_SPATIAL, effects=(Weight(vector(*force)),)))
    expected = {f"e{i}{axis}" for axis in axes for i in (1, 2, 3)}
    assert {str(f.func) for f in equations.orientation.fields} == expected
    assert {name for name in equations.fields if name.startswith("e")} == expected


def test_zero_coefficients_leave_no_field_and_no_term() -> None:
    """No bending stiffness: no M. No rotational friction: no m, and the moment balance is algebraic."""
    floppy = derive(dataclasses.replace(PLAIN_PLANAR, stiffness=diagonal("kappa", 1, 0)))
    assert "M" not in floppy.fields
    assert len(floppy.stress_law) == len(floppy.right.equations) == 2
    quasistatic = derive(dataclasses.replace(PLAIN_PLANAR, friction=diagonal(1, 1, 0)))
    assert "m" not in quasistatic.fields
    assert quasistatic.motion[2].left == 0
    assert not quasistatic.dissipation.has(field("Omega"))


def test_terms_that_cancel_are_gone() -> None:
    """With equal stretch and shear stiffness the turning moment h1 F2 - h2 F1 keeps only its linear part."""
    assert derive(PLAIN_PLANAR).motion[2].right == sp.Symbol("kappa", real=True) * field("h2") + field("Pi").diff(U)


def test_the_parameters_listed_are_those_that_occur() -> None:
    """In the order of the scene; one that nothing uses is not listed."""
    assert derive(PLAIN_PLANAR).parameters == ("kappa",)
    assert derive(PLAIN_SPATIAL).parameters == ("kappa", "b")
    assert derive(HEAVY_PLANAR).parameters == ("kappa", "g", "a", "b")


def test_the_fields_listed_are_those_that_occur() -> None:
    """Turn, twist, stress, wrench and orientation, in this order."""
    assert derive(PLAIN_PLANAR).fields == (*SE2.strain, *SE2.twist, *SE2.stress, *SE2.wrench)
    assert derive(HEAVY_PLANAR).fields[-1] == "theta"
    for model in RODS.values():
        equations = derive(model)
        occurring = {f for part in equations.parts.values() for e in part for f in field_names((e.left, e.right))}
        assert set(equations.fields) == occurring


def test_the_terms_are_listed_in_words() -> None:
    """What the rod feels, and nothing else."""
    assert derive(PLAIN_PLANAR).terms == ("elasticity", "friction")
    assert derive(HEAVY_SPATIAL).terms == (
        "elasticity", "friction", "weight", "load on the left end", "load on the right end",
    )  # fmt: skip


def test_where_the_law_steps_the_stress_stays_a_field() -> None:
    """A stepped stiffness would put a point source into S(E)'; the stress is continuous, so it is kept."""
    stepped = derive(dataclasses.replace(PLAIN_PLANAR, stiffness=diagonal("1 + heaviside(u - 0.5)", 1, 1)))
    assert not any(e.right.has(sp.DiracDelta) for e in stepped.motion)
    assert stepped.motion[0].right.has(field("F1").diff(U))
    switched = derive(dataclasses.replace(PLAIN_PLANAR, reference=vector("1", 0, "heaviside(t - 0.5)")))
    assert not any(e.right.has(*switched.stress) for e in switched.motion)


def test_an_asymmetric_stiffness_has_no_energy() -> None:
    """Odd elasticity is derived all the same, without an energy density."""
    odd = (vector("kappa", 0, 0), vector(0, 1, "a"), vector(0, "-a", 1))
    equations = derive(dataclasses.replace(PLAIN_PLANAR, stiffness=odd))
    assert equations.energy is None
    assert sp.expand(equations.stress_law[2].right - field("Pi") + sp.Symbol("a", real=True) * field("h2")) == 0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"left": End("glued")}, r"left end: expected one of clamped, free, pinned, driven, found glued; choose"),
        ({"right": End("clamped", force=vector(1, 0))}, r"right end: expected no load on a clamped end.*remove"),
        ({"right": End("pinned", force=vector(1, 0))}, r"right end: expected no force on a pinned end.*remove"),
        ({"left": End("driven")}, r"left end: expected a twist if it is driven and only then, found driven"),
        ({"left": End("free", twist=vector(0, 0, 1))}, r"left end: expected a twist if it is driven and only then"),
    ],
)
def test_ends_that_there_are_not_are_refused(change: dict[str, object], message: str) -> None:
    """Nothing in a model is silently left out."""
    with pytest.raises(ValueError, match=message):
        derive(dataclasses.replace(PLAIN_PLANAR, **change))


def test_the_record_prints_readably() -> None:
    """One line for each equation, with the name of its part."""
    lines = str(derive(PLAIN_PLANAR)).splitlines()
    assert "stress: F1(u, t) = kappa*(h1(u, t) - 1)" in lines
    assert len(lines) == 3 * 5 + 3 + 3
