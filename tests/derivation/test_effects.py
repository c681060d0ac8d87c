"""Effects in the derived equations: their wrenches, their media, and nothing of the effects that are not there."""

from __future__ import annotations

import dataclasses
from itertools import combinations

import numpy as np
import pytest
import sympy as sp

from geocosserat.algebra.fields import derivatives
from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.algebra.symbolic import configuration
from geocosserat.derivation import acting
from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.equations import derive
from geocosserat.derivation.forms import document
from geocosserat.derivation.notation import T, U, field, symbol
from geocosserat.derivation.printing import to_latex, to_text
from geocosserat.model.effects.effect import Effect, Key
from geocosserat.model.expressions import Expression
from geocosserat.model.seen import Seen, Vector, dot, seen
from tests.derivation.rods import POINTS, TINY, random_motion, random_value, value
from tests.derivation.scenes import BASE, FULL, NUMBERS, effects, planar, vector

GROUPS = pytest.mark.parametrize("group", [SE2, SE3], ids=["planar", "spatial"])
KINDS = tuple(effects(SE2))


@dataclasses.dataclass(frozen=True)
class Well(Effect):
    """A kind of effect from outside the package: a quartic well that also aligns e_1 with the x axis."""

    kind = "well"
    keys = {"depth": Key("scalar")}  # noqa: RUF012
    depth: Vector

    def potential(self, seen: Seen) -> Expression:
        """Depth times the square of the squared distance, less the alignment."""
        away = dot(seen.position, seen.position)
        return self.depth[0] * (away * away - seen.axes[0][0] ** 3)


@dataclasses.dataclass(frozen=True)
class Push(Effect):
    """Another: a wrench along the rod that turns into a moment, without a potential."""

    kind = "push"
    keys = {"size": Key("scalar")}  # noqa: RUF012
    size: Vector

    def wrench(self, seen: Seen) -> tuple[Vector, Vector]:
        """Force along e_1, and a moment of the same size."""
        (size,) = self.size
        return (size, *seen.to_body(seen.position)[1:]), (size, *([size * 0.0] * (seen.rotations - 1)))


def every(group: Group) -> dict[str, Effect]:
    """One effect of each kind, and two that are registered by no one."""
    own = {name: effect for name, (effect, _) in effects(group).items()}
    return own | {"well": Well(vector("a*(1 + u)")), "push": Push(vector("b*t"))}


def along(e: sp.Expr, group: Group, u: sp.Rational, t: sp.Rational) -> sp.Expr:
    """The value of e on a random motion, its place included."""
    motion = random_motion(group, 41)
    explicit = motion.fields() | dict(zip("xyz", motion.position, strict=False))
    return value(e.xreplace(NUMBERS), explicit, u, t)


POTENTIALS = ("weight", "field", "trap", "well")


@GROUPS
@pytest.mark.parametrize("kind", POTENTIALS)
def test_the_power_of_the_wrench_is_the_loss_of_potential(kind: str, group: Group) -> None:
    """d/dt potential - (its change at a fixed rod) = -(force . v + moment . Omega), on a random motion."""
    effect = every(group)[kind]
    energy = effect.potential(seen(group.space))
    assert energy is not None
    potential = acting.in_fields(group, energy)
    held = {f: sp.Dummy() for f in potential.atoms(sp.core.function.AppliedUndef)}
    at_a_fixed_rod = potential.xreplace(held).diff(T).xreplace({d: f for f, d in held.items()})
    twist = [field(name) for name in group.twist]
    power = sp.Add(*(w * v for w, v in zip(acting.push(group, (effect,)), twist, strict=True)))
    for u, t in POINTS:
        assert abs(along(potential.diff(T) - at_a_fixed_rod + power, group, u, t)) < TINY
        assert abs(along(power, group, u, t)) > 1e-6


@GROUPS
@pytest.mark.parametrize("kind", POTENTIALS)
def test_the_wrench_is_minus_the_invariant_derivative_of_the_potential(kind: str, group: Group) -> None:
    """-X_alpha[potential] on the group, X_alpha the left-invariant fields, is the wrench in the equations."""
    effect, n = every(group)[kind], group.space
    phi = configuration(group)
    R, r = group.rotation(phi), group.position(phi)
    frame = {"frame.cos": R[0, 0], "frame.sin": R[1, 0]}
    if n == 3:
        frame = {f"frame.{i + 1}{axis}": R[k, i] for k, axis in enumerate("xyz") for i in range(3)}
    names = frame | {f"place.{axis}": r[k] for k, axis in enumerate("xyz"[:n])}
    energy = effect.potential(seen(n))
    assert energy is not None
    function = to_sympy(energy).xreplace({symbol(name): x for name, x in names.items()})
    slopes = derivatives(group, function, phi)
    motion = random_motion(group, 41)
    pose = group.pose(motion.position, motion.rotation)
    for u, t in POINTS:
        at = {x: (sp.S.Zero + y).evalf(40, subs={U: u, T: t}) for x, y in zip(phi.ravel(), pose.ravel(), strict=True)}
        del at[0], at[1]
        for slope, wrench in zip(slopes, acting.push(group, (effect,)), strict=True):
            expected = (sp.S.Zero - slope).xreplace(NUMBERS).xreplace(at).xreplace({U: u, T: t}).evalf(40)
            assert abs(along(wrench, group, u, t) - expected) < TINY


@GROUPS
def test_effects_fixed_in_the_body_are_as_the_scene_has_them(group: Group) -> None:
    """A follower is its force and no moment, a couple its moment and no force, whatever the rod does."""
    n = group.space
    follower, couple = every(group)["follower"], every(group)["couple"]
    assert acting.push(group, (follower,))[:n] == tuple(to_sympy(e) for e in follower.force)
    assert set(acting.push(group, (follower,))[n:]) == {0}
    assert acting.push(group, (couple,))[n:] == tuple(to_sympy(e) for e in couple.torque)
    assert set(acting.push(group, (couple,))[:n]) == {0}


@GROUPS
def test_the_medium_is_the_flow_of_the_world_seen_in_the_frame(group: Group) -> None:
    """Turned back into the world: velocity + gradient . position, and half the vorticity."""
    n, flow = group.space, every(group)["flow"]
    motion = random_motion(group, 41)
    gradient = np.array([to_sympy(e).xreplace(NUMBERS) for e in flow.gradient], dtype=object).reshape(n, n)
    velocity = np.array([to_sympy(e).xreplace(NUMBERS) for e in flow.velocity], dtype=object)
    moving = velocity + gradient @ motion.position
    turning = [(gradient[1, 0] - gradient[0, 1]) / 2]
    if n == 3:
        turning = [(gradient[k, j] - gradient[j, k]) / 2 for j, k in ((1, 2), (2, 0), (0, 1))]
    for u, t in POINTS:
        R = np.array([[x.evalf(40, subs={U: u, T: t}) for x in row] for row in motion.rotation], dtype=object)
        found = [along(e, group, u, t) for e in acting.medium(group, (flow,))]
        spin = R @ found[n:] if n == 3 else found[n:]
        for a, b in zip([*(R @ found[:n]), *spin], [*moving, *turning], strict=True):
            assert abs(a - (sp.S.Zero + b).evalf(40, subs={U: u, T: t})) < TINY


@GROUPS
def test_a_rod_that_moves_with_the_medium_is_not_dragged(group: Group) -> None:
    """j = -Gamma (V - V_medium): where V is V_medium there is neither a wrench nor any loss."""
    flow = every(group)["flow"]
    equations = derive(dataclasses.replace(BASE[group], effects=(flow,)))
    with_it = dict(zip(equations.twist, acting.medium(group, (flow,)), strict=True))
    for law in equations.wrench_law:
        assert sp.expand(law.right.xreplace(with_it)) == 0
        assert sp.expand(law.right) != 0
    assert sp.expand(equations.dissipation.xreplace(with_it)) == 0


@GROUPS
def test_the_motion_is_the_balance_with_the_laws_put_in(group: Group) -> None:
    """With every effect at once: friction minus push is minus the balance."""
    equations = derive(FULL[group])
    laws = {e.left: e.right for e in (*equations.stress_law, *equations.wrench_law)}
    for motion, balance in zip(equations.motion, equations.balance, strict=True):
        difference = (motion.residual + balance.left.xreplace(laws).doit()).xreplace(NUMBERS)
        for seed in (49, 50):
            assert abs(random_value(difference, seed)) < TINY * 100
    assert not any(e.right.has(*equations.stress, *equations.wrench) for e in equations.motion)


@GROUPS
@pytest.mark.parametrize("frozen", [(), ("h1",), ("h1", "h2")], ids=["none frozen", "h1 frozen", "h1 h2 frozen"])
def test_energy_is_stored_from_what_the_wrench_does(frozen: tuple[str, ...], group: Group) -> None:
    """d/dt energy = (S.V)' + V.j - S.(rate of the reference) wherever the motion holds; loss against the medium."""
    reference = ("1 + a*t", "b*t*u", *["a*sin(t)"] * (group.dimension - 2))
    model = dataclasses.replace(FULL[group], frozen=frozen, reference=vector(*reference))
    equations = derive(model)
    assert equations.energy is not None
    rates = {e.left: e.right for e in equations.rates}
    laws = {e.left: e.right for e in equations.stress_law}
    S = [laws.get(s, s) for s in equations.stress]
    V, j = equations.twist, [e.right for e in equations.wrench_law]
    stored = equations.energy.diff(T).xreplace(rates)
    flux = sp.Add(*(s * v for s, v in zip(S, V, strict=True))).diff(U)
    done = sp.Add(*(v * w for v, w in zip(V, j, strict=True)))
    active = sp.Add(*(s * e.diff(T) for s, e in zip(S, equations.reference, strict=True)))
    violated = sp.Add(*(v * e.residual for v, e in zip(V, equations.motion, strict=True)))
    constrained = sp.Add(*(s * e.residual for s, e in zip(equations.multipliers, equations.constraints, strict=True)))
    medium, push = acting.medium(group, model.effects), acting.push(group, model.effects)
    lost = sp.Add(*((v - m) * (p - w) for v, m, p, w in zip(V, medium, push, j, strict=True)))
    for seed in (50, 51):
        balance = (stored + active - done - flux - violated - constrained).xreplace(NUMBERS)
        size = abs(random_value(stored.xreplace(NUMBERS), seed))
        assert size > 1e-3
        assert abs(random_value(balance, seed)) < TINY * (1 + size) * 1000
        assert abs(random_value((equations.dissipation - lost).xreplace(NUMBERS), seed)) < TINY * 1000


@GROUPS
def test_place_and_orientation_follow_the_rod(group: Group) -> None:
    """The rates and slopes of all carried fields hold on a random motion."""
    equations = derive(FULL[group])
    carried = equations.orientation_rates + equations.orientation_slopes
    carried += equations.position_rates + equations.position_slopes
    assert len(equations.position.fields) == group.space
    for u, t in POINTS:
        for equation in carried:
            assert abs(along(equation.residual, group, u, t)) < TINY, equation


def stands_beside(pair: tuple[str, str]) -> bool:
    """Whether another effect with a wrench stands beside a weight: then the term of both has no name of its own."""
    return bool({"follower", "couple", "field", "trap"} & {*pair})


@GROUPS
@pytest.mark.parametrize("pair", list(combinations(KINDS, 2)), ids=" ".join)
def test_every_pair_of_effects_leaves_no_trace_of_the_others(pair: tuple[str, str], group: Group) -> None:
    """Fields, parameters, terms and text hold what the two bring and nothing else."""
    known = effects(group)
    equations = derive(dataclasses.replace(BASE[group], effects=tuple(known[kind][0] for kind in pair)))
    laid_out = document(equations)
    texts = (to_text(laid_out), to_text(laid_out, unicode=False), to_latex(laid_out))
    brought = frozenset[str]().union(*(known[kind][1] for kind in pair))
    assert equations.terms == ("elasticity", "friction", *pair)
    assert set(equations.parameters) - {"k1", "k2", "k3", "k4"} == brought | {
        name for name in equations.parameters if name.startswith("gamma")
    }
    world, place = bool({"weight", "field", "flow", "trap"} & {*pair}), bool({"flow", "trap"} & {*pair})
    assert bool(equations.orientation.fields) == world
    assert bool(equations.position.fields) == place
    for text in texts:
        assert ("Orientation" in text) == world
        assert ("Position" in text) == place
        assert ("medium" in text) == ("flow" in pair)
        assert ("rate of the orientation" in " ".join(text.split())) == world
        assert ("rate of the position" in " ".join(text.split())) == place
    assert ("j = -Gamma (V - V_m)" in texts[1]) == ("flow" in pair)
    assert ("Rᵀ f" in texts[0]) == ("weight" in pair and not stands_beside(pair))
    assert texts[1].isascii()
    assert len(equations.unknowns) == len(equations.closed)


def test_only_the_axes_that_a_trap_or_a_flow_needs_are_carried() -> None:
    """A shear flow along x that grows with y needs y and the axes x, y and z of the spin's plane, no more."""
    flow = dataclasses.replace(effects(SE3)["flow"][0], gradient=vector(0, "qa", 0, *[0] * 6), velocity=vector(0, 0, 0))
    equations = derive(dataclasses.replace(BASE[SE3], effects=(flow,)))
    assert [str(f.func) for f in equations.position.fields] == ["y"]
    axes = {str(f.func)[-1] for f in equations.orientation.fields}
    assert axes == {"x", "y", "z"}
    still = dataclasses.replace(BASE[SE3], effects=(flow,), friction=BASE[SE3].friction[:3] + ((vector(*[0] * 6),) * 3))
    assert {str(f.func)[-1] for f in derive(still).orientation.fields} == {"x", "y"}


@GROUPS
def test_an_effect_from_outside_is_derived_like_any_other(group: Group) -> None:
    """Named by its kind; what it does not see is not carried."""
    known = every(group)
    equations = derive(dataclasses.replace(BASE[group], effects=(known["push"], known["well"])))
    assert equations.terms[-2:] == ("push", "well")
    assert len(equations.position.fields) == group.space
    assert {"a", "b"} <= set(equations.parameters)


def test_effects_that_cancel_leave_nothing() -> None:
    """Two opposite weights are no weight."""
    weight = effects(SE2)["weight"][0]
    opposite = dataclasses.replace(weight, force=vector("-wa*t", "wa"))
    equations = derive(planar(effects=(weight, opposite)))
    assert equations.orientation.fields == ()
    assert "wa" not in equations.parameters
