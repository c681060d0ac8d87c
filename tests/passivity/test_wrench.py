"""Wrenches: closed, exact, driven; the package's own effects, vortices, steps, turns, and loops that do work."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import pytest
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3
from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.notation import symbol
from geocosserat.model.effects.couple import Couple
from geocosserat.model.effects.effect import Effect
from geocosserat.model.effects.field import Field
from geocosserat.model.effects.flow import Flow
from geocosserat.model.effects.follower import Follower
from geocosserat.model.effects.trap import Trap
from geocosserat.model.effects.weight import Weight
from geocosserat.model.expressions import Call, Expression, Symbol, evaluate, parse, substitute, to_text
from geocosserat.model.law import Law, load_law
from geocosserat.model.seen import seen
from geocosserat.passivity.configuration import ConfigurationLoop, along_fields
from geocosserat.passivity.potential import residual
from geocosserat.passivity.regular import may_step, singular
from geocosserat.passivity.vanish import vanishes
from geocosserat.passivity.wrench import WrenchAnswer, wrench_answer
from geocosserat.passivity.wrench_form import brackets, continuous

OPEN, POSITIVE = {"symbol": True}, {"symbol": True, "positive": True}


def law(components: list[str] | tuple[str, ...], **parameters: Any) -> Law:
    """A law of a wrench alone: three components in the plane, six in space."""
    motion, group = ("planar", SE2) if len(components) == 3 else ("spatial", SE3)
    wrench = dict(zip(group.wrench, components, strict=True))
    return load_law({"name": "a", "motion": motion, "wrench": wrench, "parameters": parameters})


def answer(components: list[str] | tuple[str, ...], **parameters: Any) -> WrenchAnswer:
    """Its answer."""
    found = wrench_answer(law(components, **parameters))
    assert found is not None
    return found


def plane(fx: str, fy: str, m: str = "0") -> list[str]:
    """A force given in the world, and a couple, in the moving frame."""
    return [f"({fx})*cos(theta) + ({fy})*sin(theta)", f"({fy})*cos(theta) - ({fx})*sin(theta)", m]


def space(fx: str, fy: str, fz: str, *m: str) -> list[str]:
    """The same in space, the couple in the moving frame."""
    return [f"({fx})*e{i}x + ({fy})*e{i}y + ({fz})*e{i}z" for i in (1, 2, 3)] + list(m or ("0", "0", "0"))


def work_of(given: Law, loop: ConfigurationLoop) -> float:
    """Net work by matrices alone: the twist from differences of the configuration, the trapezoidal rule."""
    n, h = 2000, 1e-4

    def matrix(t: Any) -> Any:
        p = {name: np.broadcast_to(evaluate(e, {"t": t}), np.shape(t)) for name, e in loop.pose.items()}
        place = np.stack([p[a] for a in "xyz"[: given.group.space]], axis=-1)
        if given.group is SE2:
            c, s = np.cos(p["theta"]), np.sin(p["theta"])
            rows = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)
        else:
            rows = np.stack([np.stack([p[f"e{i}{a}"] for i in (1, 2, 3)], -1) for a in "xyz"], -2)
        return p, given.group.pose(place, rows)

    t = np.arange(n) / n
    p, g = matrix(t)
    around = [matrix(t + k * h)[1] for k in (-2, -1, 1, 2)]
    rate = (around[0] - 8 * around[1] + 8 * around[2] - around[3]) / (12 * h)
    twist = given.group.vee(np.linalg.inv(g) @ rate)
    env = {**p, **given.parameters, "u": 0.5, **loop.values, "t": t if loop.timed else 0.0}
    assert given.wrench is not None
    force = np.stack([np.broadcast_to(evaluate(e, env), (n,)) for e in given.wrench], axis=-1)
    return float((force * twist).sum(axis=-1).mean())


# the package's own effects

GAMMA = {2: (1.0, 2.0, 0.3), 3: (1.0, 2.0, 2.0, 0.1, 0.2, 0.3)}


def numbers(*texts: str) -> tuple[Expression, ...]:
    """Values of an effect."""
    return tuple(parse(text, ("u", "t")) for text in texts)


def effect_law(effect: Effect, n: int) -> Law:
    """The wrench of an effect, and the drag of its medium, with a law's names of the configuration."""
    world = seen(n)
    force, moment = effect.wrench(world)
    flow, spin = effect.medium(world)
    drag = [g * v for g, v in zip(GAMMA[n], (*flow, *spin), strict=True)]
    total = [j + d for j, d in zip((*force, *moment), drag, strict=True)]
    names = {f"place.{a}": Symbol(a) for a in "xyz"[:n]}
    if n == 2:
        names |= {"frame.cos": Call("cos", Symbol("theta")), "frame.sin": Call("sin", Symbol("theta"))}
    else:
        names |= {f"frame.{i}{a}": Symbol(f"e{i}{a}") for i in (1, 2, 3) for a in "xyz"}
    return law([to_text(substitute(e, names)) for e in total])


CONSERVATIVE = [
    (2, Weight(numbers("0.2", "-1 - u"))),
    (3, Weight(numbers("0.2", "0.1", "-1 - u"))),
    (2, Field(numbers("0.4", "0.1*u"), numbers("3", "-1"))),
    (3, Field(numbers("0.4", "0.1", "-0.3"), numbers("3", "-1", "2"))),
    (2, Trap(numbers("2 + u"), numbers("1", "0.2"))),
    (3, Trap(numbers("2 + u"), numbers("1", "0.2", "-0.7"))),
]
DRIVEN = [
    (2, Follower(numbers("0.5", "0"))),
    (3, Follower(numbers("0.5", "0", "0.1"))),
    (3, Couple(numbers("0", "0", "1"))),
    (2, Flow(numbers("0", "2", "-0.5", "0"), numbers("0.3", "1"))),
    (3, Flow(numbers("0", "2", "1", "-0.5", "0", "0.2", "3", "-1", "0.1"), numbers("0", "1", "-2"))),
]


def named(case: tuple[int, Effect]) -> str:
    """For the test's name."""
    return f"{case[1].kind} in {case[0]} dimensions"


@pytest.mark.parametrize("case", CONSERVATIVE, ids=named)
def test_weights_fields_and_traps_have_the_potential_that_the_effect_states(case: tuple[int, Effect]) -> None:
    """Exact, proved, with j = -X[U], and U as the effect writes it, up to a constant."""
    n, effect = case
    given = effect_law(effect, n)
    found = wrench_answer(given)
    assert found is not None
    assert (found.closed, found.exact, found.grade, found.witness) == (True, True, "proved", None)
    world = seen(n)
    stated = effect.potential(world)
    assert stated is not None
    assert found.potential is not None
    # at numbers: both potentials fall alike
    chance = np.random.default_rng(1)
    for _ in range(3):
        angles = chance.normal(size=4)
        values: dict[str, float] = dict(zip("xyz", chance.normal(size=3), strict=True)) | {"u": 0.3, "t": 0.0}
        if n == 2:
            values["theta"] = angles[0]
            frame = {"frame.cos": np.cos(angles[0]), "frame.sin": np.sin(angles[0])}
        else:
            q, _ = np.linalg.qr(chance.normal(size=(3, 3)))
            q *= np.linalg.det(q)
            frame = {f"frame.{i + 1}{a}": q[k, i] for i in range(3) for k, a in enumerate("xyz")}
            values |= {f"e{i + 1}{a}": q[k, i] for i in range(3) for k, a in enumerate("xyz")}
        here = float(found.potential.subs({symbol(k): v for k, v in values.items()}))
        there = evaluate(stated, {**frame, **{f"place.{a}": values[a] for a in "xyz"}, "u": 0.3, "t": 0.0})
        origin = {**dict.fromkeys(values, 0.0), "u": 0.3}
        zero = float(found.potential.subs({symbol(k): v for k, v in origin.items()})) if n == 3 else 0.0
        if effect.kind == "trap":
            centre = evaluate(stated, {"place.x": 0.0, "place.y": 0.0, "place.z": 0.0, "u": 0.3, "t": 0.0})
            zero, there = 0.0, there - float(centre)
        assert here - zero == pytest.approx(there, abs=1e-12)


@pytest.mark.parametrize("case", DRIVEN, ids=named)
def test_followers_couples_and_drag_do_work_on_a_loop(case: tuple[int, Effect]) -> None:
    """Not closed, proved; the witness's certified work is what matrices alone give."""
    given = effect_law(case[1], case[0])
    found = wrench_answer(given)
    assert found is not None
    assert (found.closed, found.exact, found.grade) == (False, False, "proved")
    assert found.witness is not None
    assert 0 < found.witness.low <= found.witness.work <= found.witness.high
    assert work_of(given, found.witness) == pytest.approx(found.witness.work, rel=1e-6)


def test_a_couple_in_the_plane_is_closed_but_does_work_with_every_turn() -> None:
    """SE(2) has the homotopy of a circle: the period is 2 pi m, certified."""
    given = effect_law(Couple(numbers("2")), 2)
    found = wrench_answer(given)
    assert found is not None
    assert (found.closed, found.exact, found.grade) == (True, False, "proved")
    (period,) = found.periods
    assert period.text == "4*pi"
    assert period.low is not None
    assert period.high is not None
    assert period.low <= 4 * np.pi <= period.high
    assert found.witness is not None
    assert "full turn" in found.witness.words
    assert work_of(given, found.witness) == pytest.approx(4 * np.pi)


def test_drag_by_an_irrotational_flow_is_conservative_if_friction_is_isotropic() -> None:
    """A gradient of velocity times one coefficient is a gradient; with two coefficients it is not."""
    assert answer(plane("0.3 + x + 2*y", "2*x - y")).exact is True
    components = plane("0.3 + x + 2*y", "2*x - y")
    assert answer([components[0], f"2*({components[1]})", "0"]).exact is False


# the verdicts of other laws

EXACT = {
    "angular spring": (plane("0", "0", "-2*sin(theta)*cos(theta)"), {}),
    "logarithm": (plane("-x/(x**2 + y**2)", "-y/(x**2 + y**2)"), {}),
    "spring with length": (
        plane("-k*x*(1 - l/sqrt(x**2 + y**2))", "-k*y*(1 - l/sqrt(x**2 + y**2))"),
        {"k": POSITIVE, "l": POSITIVE},
    ),
    "Gaussian": (plane("-x*exp(-(x**2 + y**2)/(2*l**2))", "-y*exp(-(x**2 + y**2)/(2*l**2))"), {"l": POSITIVE}),
    "wall": (plane("-tanh(x)", "0"), {}),
    "one-sided spring": (plane("-x*heaviside(x)", "0"), {}),
    "constant beyond a step": (plane("heaviside(x - 0.3)", "0"), {}),
    "field that varies in place": (plane("0.3*cos(theta)", "0", "-0.3*x*sin(theta)"), {}),
    "removable": (plane("-x**2/x", "0"), {}),
    "gravity": (space(*[f"-{c}/(x**2 + y**2 + z**2)**1.5" for c in "xyz"]), {}),
    "nematic": (["0", "0", "0", "0", "-2*e1x*e3x", "2*e1x*e2x"], {}),
    "nematic oblique": (
        ["0", "0", "0", "0", "-2*(0.6*e1x + 0.8*e1y)*(0.6*e3x + 0.8*e3y)",
         "2*(0.6*e1x + 0.8*e1y)*(0.6*e2x + 0.8*e2y)"],
        {},
    ),
    "field in disguise": (
        ["0", "0", "0", "0", "-(e3x*e1x**2 + e3x*e2x**2 + e3x**3)", "e2x*(e1x**2 + e2x**2 + e3x**2)"],
        {},
    ),
    "tiny weight": (plane("1e-30", "-1"), {}),
}  # fmt: skip


@pytest.mark.parametrize("name", EXACT)
def test_conservative_laws_have_a_verified_potential(name: str) -> None:
    """Exact, proved, and the derivative of the potential along the group's fields is minus the wrench."""
    components, parameters = EXACT[name]
    found = answer(components, **parameters)
    assert (found.closed, found.exact, found.grade) == (True, True, "proved")
    assert found.potential is not None
    given = law(components, **parameters)
    from_law = _exact_components(given)
    positive = [n for n, sign in given.open.items() if sign == "positive"]
    assert vanishes(residual(given.group, from_law, found.potential), positive).value is True


def _exact_components(given: Law) -> list[sp.Expr]:
    assert given.wrench is not None
    return [to_sympy(e) for e in given.wrench]


TOPOLOGICAL = {
    "error function in the plane": (plane("exp(-x**2)", "0")),
    "error function in space": (space("exp(-x**2)", "0", "0")),
    "high power": (plane("-(x + y)**30", "-(x + y)**30")),
}


@pytest.mark.parametrize("name", TOPOLOGICAL)
def test_what_is_closed_and_regular_everywhere_is_exact_without_a_potential_in_closed_form(name: str) -> None:
    """By topology alone: no energy is given, the proof says why."""
    found = answer(TOPOLOGICAL[name])
    assert (found.closed, found.exact, found.grade, found.potential) == (True, True, "proved", None)


ACTIVE = {
    "shear": plane("y", "0"),
    "gradient plus a curl of 1e-30": plane("(1 + 1e-30)*y", "x"),
    "the same in space": space("(1 + 1e-30)*y", "x", "0"),
    "force that depends on the angle": plane("cos(theta)", "0"),
    "full law": space("-3*x + 0.2*exp(-x**2)", "-2*y + sin(y) + 0.1*x", "-z**3 - 1", "0", "-0.7*e3x*exp(e1x)",
                      "0.7*e2x*exp(e1x)"),
    "spring and follower": ["1", "0", "-2*theta"],
}  # fmt: skip


@pytest.mark.parametrize("name", ACTIVE)
def test_laws_that_are_not_closed_have_a_certified_loop(name: str) -> None:
    """Refuted at a point, and by the work on a loop."""
    given = law(ACTIVE[name])
    found = wrench_answer(given)
    assert found is not None
    assert (found.closed, found.exact, found.grade) == (False, False, "proved")
    assert found.witness is not None
    assert 0 < found.witness.low <= found.witness.high
    assert found.witness.high <= found.witness.low * (1 + 1e-6)
    if "1e-30" not in name and "same" not in name:
        assert work_of(given, found.witness) == pytest.approx(found.witness.work, rel=1e-6)


@pytest.mark.parametrize(
    "components",
    [plane("-y/(x**2 + y**2)", "x/(x**2 + y**2)"), space("-y/(x**2 + y**2)", "x/(x**2 + y**2)", "0")],
    ids=["plane", "space"],
)
def test_a_vortex_is_closed_but_does_work_round_its_axis(components: list[str]) -> None:
    """The period 2 pi, certified; the singular set is named."""
    found = answer(components)
    assert (found.closed, found.exact, found.grade) == (True, False, "proved")
    assert found.witness is not None
    assert found.witness.low <= 2 * np.pi <= found.witness.high
    assert [str(s) for s in found.singular] == ["pole where x**2 + y**2 = 0"]
    assert found.periods[0].value == pytest.approx(2 * np.pi)


def test_a_couple_that_varies_round_the_turn_does_the_work_of_its_mean() -> None:
    """m = 1/(2 + cos theta): 2 pi / sqrt(3) per turn; one without mean is exact."""
    found = answer(plane("0", "0", "1/(2 + cos(theta))"))
    assert (found.closed, found.exact) == (True, False)
    assert found.witness is not None
    assert found.witness.low <= 2 * np.pi / np.sqrt(3) <= found.witness.high
    assert answer(plane("0", "0", "sin(theta)/(2 + cos(theta))")).exact is True


def test_a_law_in_the_bare_angle_lives_where_turns_are_counted() -> None:
    """A torsion spring has a potential there, even with a constant couple; that is said."""
    for m in ("-2*theta", "3 - 2*theta"):
        found = answer(["0", "0", m])
        assert (found.closed, found.exact) == (True, True)
        assert "counts turns" in found.assumptions[0]
    assert answer(["0", "0", "-2*sin(theta)"]).assumptions == ()


# what must never be called exact

JUMPS = {
    "step of a shear": plane("0", "heaviside(x)"),
    "sign by a root": plane("0", "-x/sqrt(x**2)"),
    "sign by a modulus": plane("0", "-x/abs(x)"),
    "sign by the root of a square": plane("0", "-(x - 1)/sqrt(x**2 - 2*x + 1)"),
    "step of a shear far away": plane("0", "heaviside(x - 200)"),
    "sign far away": plane("0", "-(x - 200)/sqrt((x - 200)**2)"),
    "essential": plane("-y*(1 - tanh(1/x)**2)*(-1/x**2)", "-tanh(1/x)"),
}


@pytest.mark.parametrize("name", JUMPS)
def test_what_is_closed_on_either_side_of_a_jump_is_not_called_exact(name: str) -> None:
    """A loop across the jump does work: refuted by it, or not decided."""
    assert answer(JUMPS[name]).exact is not True


def test_a_potential_that_may_step_at_a_pole_is_not_trusted() -> None:
    """It is found and verified beside the pole, and said not to decide, without asking a loop."""
    found = answer(JUMPS["sign by a root"])
    assert found.exact is None
    assert "may step" in found.how


def test_a_step_of_a_shear_is_refuted_by_a_loop_across() -> None:
    """Its work is the height of the part of the circle beyond the step: the diameter."""
    found = answer(plane("0", "heaviside(x)"))
    assert found.exact is False
    assert found.witness is not None
    assert found.witness.low <= 2 <= found.witness.high


def test_a_vortex_anywhere_is_found() -> None:
    """Its axis is where the singular set is, not at the origin."""
    found = answer(plane("-(y - 7)/((x + 3)**2 + (y - 7)**2)", "(x + 3)/((x + 3)**2 + (y - 7)**2)"))
    assert (found.closed, found.exact) == (True, False)
    assert found.witness is not None
    assert found.witness.low <= 2 * np.pi <= found.witness.high


@pytest.mark.parametrize(
    ("energy", "steps"),
    [("y*x/abs(x)", True), ("y*tanh(1/x)", True), ("exp(-1/x)", True), ("(x - 1)/sqrt(x**2 - 2*x + 1)", True),
     ("log(abs(x))", False), ("1/x + y", False), ("x/sqrt(x**2 + y**2)", False), ("sqrt(x)*sin(y)", False)],
)  # fmt: skip
def test_bounded_jumps_across_poles_are_suspected(energy: str, steps: bool) -> None:
    """What is unbounded at a wall, or singular on a line, is no jump."""
    assert may_step(to_sympy(parse(energy, ("x", "y"))), [symbol("x"), symbol("y")]) is steps


@pytest.mark.parametrize(
    ("energy", "group", "holds"),
    [("x*heaviside(x)", SE2, True), ("y*heaviside(x)", SE2, False), ("(x - y)**2*heaviside(x - y)", SE2, True),
     ("e1x*heaviside(e1x)", SE3, True), ("e1y*heaviside(e1x)", SE3, False), ("heaviside(x*y)", SE2, False),
     ("heaviside(sin(theta))", SE2, False)],
)  # fmt: skip
def test_a_potential_is_continuous_only_if_its_jump_vanishes_on_the_step(energy: str, group: Any, holds: bool) -> None:
    """By putting the step's place in, or by division."""
    names = ("x", "y", "theta", "e1x", "e1y")
    assert continuous(group, to_sympy(parse(energy, names))) is holds


@pytest.mark.parametrize(
    ("text", "empty"),
    [("1/(1 + x**2)", True), ("1/(2 + cos(theta))", True), ("1/(x**2 - 2*x*y + 2*y**2 + 1)", True),
     ("sqrt(1 + exp(x))", True), ("1/x", False), ("1/(x**2 + y**2)", False), ("1/(1 + cos(theta))", False),
     ("log(x**2)", False), ("abs(x)", False), ("tan(theta)", False), ("1/(x**2 - 2*x*y + 2*y**2)", False)],
)  # fmt: skip
def test_singular_sets_are_empty_only_if_proved(text: str, empty: bool) -> None:
    """By bounds, or by a definite quadratic form."""
    assert (singular(SE2, [parse(text, ("x", "y", "theta"))], ()) == ()) is empty


# time and open parameters


def test_laws_in_time_are_timed_and_gain_on_a_loop_that_runs_with_them() -> None:
    """At each instant they have a potential; that changes, and a loop takes work from it."""
    given = law(plane("sin(2*pi*t)", "0"))
    found = wrench_answer(given)
    assert found is not None
    assert found.timed
    assert found.exact is True
    assert found.witness is not None
    assert found.witness.timed
    assert found.witness.work > 0
    assert work_of(given, found.witness) == pytest.approx(found.witness.work)
    assert not answer(plane("1", "0")).timed


def test_conditions_on_open_parameters_are_exact() -> None:
    """Closed, and exact, if and only if."""
    assert answer(["0", "0", "a"], a=OPEN).conditions == ("exact if and only if a = 0",)
    found = answer(plane("a*y", "b*x", "c"), a=OPEN, b=OPEN, c=OPEN)
    assert found.conditions == ("closed if and only if a = b", "exact if and only if a = b and c = 0")
    assert (found.closed, found.exact) == (None, None)
    assert found.witness is not None
    spatial = answer(space("a*y", "b*x", "0", "0", "c*e3x", "d*e2x"), a=OPEN, b=OPEN, c=OPEN, d=OPEN)
    assert spatial.conditions == ("closed and exact if and only if a = b and c = -d",)
    assert answer(["f", "0", "0"], f=POSITIVE).exact is False


def test_values_of_parameters_decide() -> None:
    """The same law with numbers in place of its open parameters."""
    assert answer(plane("a*y", "b*x"), a=2.0, b=2.0).exact is True
    assert answer(plane("a*y", "b*x"), a=2.0, b=2.1).exact is False
    assert answer(plane("a*y", "0.3*x"), a=0.1 + 0.2).exact is False


def test_brackets_see_the_structure_constants() -> None:
    """A force fixed in the body is a constant form: its bracket is the structure constants alone."""
    f = symbol("f")
    off = brackets(SE2, [f, sp.S.Zero, sp.S.Zero])
    d = 3
    expected = [-int(SE2.structure[a, b, 0]) * f for a in range(d) for b in range(a + 1, d)]
    assert off == expected
    assert any(off)


def test_the_gradient_of_any_function_is_closed() -> None:
    """Of functions with no structure at all, in both groups."""
    for group, text in ((SE2, "exp(x*sin(theta)) + y**2*cos(3*theta)"), (SE3, "e1x*y + exp(e2z)*x*e3y - z*e1y**2")):
        names = ("x", "y", "z", "theta", *(f"e{i}{a}" for i in (1, 2, 3) for a in "xyz"))
        energy = to_sympy(parse(text, names))
        wrench = [-e for e in along_fields(group, energy)]
        assert vanishes(brackets(group, wrench)).value is True


def test_a_full_spatial_law_is_decided_in_seconds() -> None:
    """Forces of place, couples of directions, and an exact answer."""
    start = time.perf_counter()
    found = answer(
        space("-3*x + 0.2*cos(x)", "-2*y + sin(y)", "-z**3 - 1", "0", "-0.7*e3x*exp(e1x)", "0.7*e2x*exp(e1x)")
    )
    assert found.exact is True
    assert time.perf_counter() - start < 10
