"""Rods of Kelvin and Voigt: how fast they creep, what their viscosity takes, and what they tend to.

With Σ = K (E - Ē + τ Ė) in every mode that moves, each motion about a rod at rest that decays at a rate λ without
viscosity does so at λ / (1 + λ τ): the balance is linear in the stress, and of exp(-rate t) that makes K (1 - rate τ)
in place of K. That holds of the rod and of any discretisation of it, whatever the ends.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import geocosserat
from geocosserat.algebra.groups import SE2, SE3
from tests.marks import slow
from tests.physics.scenes import Array, Scene, changed, farthest, gap, growths, simulate, straight
from tests.references import axial_twist, euler_bernoulli, linear_rod

LENGTH, TAU = 1.3, 0.07
PLANE = ([60.0, 40.0, 1.0], [1.0, 1.7, 0.05])
SPACE = ([60.0, 40.0, 30.0, 0.8, 1.2, 1.0], [1.5, 2.0, 1.8, 0.03, 0.05, 0.04])
ENDS = [("clamped", "free"), ("free", "free"), ("clamped", "clamped"), ("pinned", "free"), ("free", "pinned")]


def damped(rates: Any, tau: float) -> Array:
    """The rates of decay with a retardation time in every mode that moves, from those without."""
    return np.asarray(rates) / (1.0 + np.asarray(rates) * tau)


def viscous(scene: Scene, *viscosity: str | float, **parameters: float) -> Scene:
    """The scene with its diagonal stiffness as a law, and a viscosity in each mode; 0 is none, not even a number."""
    group = SE2 if scene["rod"]["motion"] == "planar" else SE3
    rod = {key: value for key, value in scene["rod"].items() if key != "stiffness"}
    rest = rod.get("reference", [1, *[0] * (group.dimension - 1)])
    stress = {}
    for name, of, k, e0, eta in zip(
        group.stress, group.strain, scene["rod"]["stiffness"], rest, viscosity, strict=True
    ):
        more = "" if eta == 0 else f" + ({eta})*{of}_dot"
        stress[name] = f"({k})*({of} - ({e0})){more}"
    law = {"motion": rod["motion"], "name": "of Kelvin and Voigt", "stress": stress, "parameters": parameters}
    return {**scene, "rod": {**rod, "law": law}}


def proportional(scene: Scene, tau: float) -> Scene:
    """The same retardation time in all modes."""
    return viscous(scene, *(f"tau*({k})" for k in scene["rod"]["stiffness"]), tau=tau)


# rates


@pytest.mark.parametrize("ends", ENDS, ids="-".join)
@pytest.mark.parametrize("coefficients", [PLANE, SPACE], ids=["planar", "spatial"])
@pytest.mark.parametrize("frozen", [False, True], ids=["full", "frozen"])
def test_every_motion_about_rest_fades_as_the_retardation_time_says(
    ends: tuple[str, str], coefficients: Any, frozen: bool
) -> None:
    """All rates of the semi-discrete rod, curved at rest, on one element or three: from those of the elastic one."""
    rest = ["1", "0", "u"] if len(coefficients[0]) == 3 else ["1", "0", "0", "0.5", "u", "1"]
    held = [name for name in ("h1", "h2", "h3")[: len(rest) // 2]] if frozen else []
    scene = changed(straight(*coefficients, *ends, length=LENGTH), {"rod.reference": rest, "rod.frozen": held})
    for elements, degree in ((1, 6), (3, 2)):
        elastic = growths(scene, elements, degree)
        slow = -elastic[np.abs(elastic) > 1e-6].real  # at rest it may be anywhere
        found = -growths(proportional(scene, TAU), elements, degree)
        assert farthest(damped(slow, TAU), found) < 1e-9
        assert np.abs(found.imag).max() < 1e-7 / TAU


@pytest.mark.parametrize("ends", ENDS, ids="-".join)
def test_small_bends_creep_at_the_rates_of_the_linear_theory(ends: tuple[Any, Any]) -> None:
    """Five modes, of the rod that neither stretches nor shears and of the one that does: characteristic equations."""
    coefficients = [1e4, 400.0, 0.8], [1.0, 1.7, 0.02]
    scene = straight(*coefficients, *ends, length=LENGTH)
    named: Any = "-".join(sorted(ends, key=["clamped", "pinned", "free"].index))
    beam = euler_bernoulli.decay_rates(LENGTH, 0.8, 1.7, 0.02, named, 5)
    found = -growths(viscous(changed(scene, {"rod.frozen": ["h1", "h2"]}), 0, 0, 0.8 * TAU), 1, 22)
    assert farthest(damped(beam, TAU), found) < 1e-8
    full = linear_rod.decay_rates(linear_rod.Rod(LENGTH, 400.0, 0.8, 1.7, 0.02), *ends, 7)
    assert farthest(damped(full[full > 0.0][:5], TAU), -growths(proportional(scene, TAU), 1, 22)) < 1e-8


@pytest.mark.parametrize("component", [0, 3])
@pytest.mark.parametrize("ends", ["clamped-free", slow("free-free")])
@pytest.mark.parametrize("eta", [1e-3, 0.2, 50.0])
def test_pure_stretch_and_pure_twist_creep_in_their_closed_profiles(component: int, ends: Any, eta: float) -> None:
    """Of any size, two modes at once, on their way: strain and stress to 1e-11, and the ledger."""
    names = list(SE3.strain)
    waves = "0.3*cos(0.5*pi*u) - 0.2*cos(1.5*pi*u)" if ends == "clamped-free" else "0.3*sin(pi*u) - 0.2*sin(2*pi*u)"
    strain = ["1", "0", "0", "0", "0", "0"]
    strain[component] += f" + {waves}"
    scene = changed(
        straight(*SPACE, *ends.split("-")),
        {
            "rod.frozen": [name for i, name in enumerate(names) if i != component],
            "start.strain": strain,
            "run.until": 0.02,
        },
    )
    law = viscous(scene, *("eta" if i == component else 0 for i in range(6)), eta=eta)
    run = simulate(law, 1, 16, 1e-12, "auto", method="radau")
    k, friction = SPACE[0][component], SPACE[1][component]
    rates = damped(axial_twist.decay_rates(k, friction, 1.0, 2, ends), eta / k)
    now = np.array([0.3, -0.2]) * np.exp(-0.02 * rates)
    modes = axial_twist.strain_modes(run.solution.u_point, 1.0, 2, ends)
    assert gap(run.solution.turn[-1, :, component] - (component == 0), now @ modes) < 1e-11
    assert gap(run.solution.stress[-1, :, component], ((k - eta * rates) * now) @ modes) < 1e-11 * k
    stored = 0.25 * k * (now**2 - np.array([0.3, -0.2]) ** 2).sum()
    assert run.ledger["stored"] == pytest.approx(stored, rel=1e-10)
    assert run.ledger["dissipated"] == pytest.approx(-stored, rel=1e-10)


# what viscosity takes


def stirred(scene: Scene) -> Scene:
    """Under a weight, a load on its end that comes and goes, and from a bent start."""
    planar = scene["rod"]["motion"] == "planar"
    return changed(
        scene,
        {
            "rod.reference": ["1", "0", "1 - u"] if planar else ["1", "0", "0", "1", "u", "1"],
            "start.strain": ["1", "0", "2*(1 - u)"] if planar else ["1", "0", "0", "0", "1 - u", "2*(1 - u)"],
            "ends.right": {"kind": "free", "force": ["sin(9*t)", 1.0, -0.5][: 2 if planar else 3], "frame": "world"},
            "effects": [{"kind": "weight", "force": [0.5, -3.0, 1.0][: 2 if planar else 3]}],
            "run.until": 0.3,
        },
    )


@pytest.mark.parametrize("frozen", [slow(False), True], ids=["full", "frozen"])
@pytest.mark.parametrize("coefficients", [PLANE, slow(SPACE)], ids=["planar", "spatial"])
def test_the_ledger_closes(coefficients: Any, frozen: bool) -> None:
    """Large motions: stored and dissipated add up to the work, the better the tighter the tolerance, with radau to
    round-off; where viscosity makes a difference of some percent of the length."""
    held = {"rod.frozen": ["h1", "h2", "h3"][: len(coefficients[0]) // 2] if frozen else []}
    scene = changed(proportional(stirred(straight(*coefficients)), TAU), held)
    residuals = [simulate(scene, 1, 8, rtol, "auto").ledger["residual"] for rtol in (1e-5, 1e-7, 1e-9)]
    assert residuals[0] < 1e-2
    assert residuals[1] < 0.2 * residuals[0]
    assert residuals[2] < 1e-6
    run = simulate(scene, 1, 8, 1e-10, "auto", method="radau")
    assert run.ledger["residual"] < 1e-11
    elastic = simulate(changed(stirred(straight(*coefficients)), held), 1, 8, 1e-8, "auto")
    assert gap(run.solution.position[-1], elastic.solution.position[-1]) > 0.02


@pytest.mark.parametrize("ends", ENDS, ids="-".join)
@pytest.mark.parametrize("coefficients", [PLANE, slow(SPACE)], ids=["planar", "spatial"])
@pytest.mark.parametrize("rtol", [1e-3, 1e-8])
def test_a_passive_rod_without_loads_never_gains_energy(coefficients: Any, ends: tuple[str, str], rtol: float) -> None:
    """From a wild start, with viscosities that couple and turn what they resist aside: frame by frame, also at a loose
    tolerance."""
    rng, group = np.random.default_rng(5), SE2 if len(coefficients[0]) == 3 else SE3
    waves = [f"{a:.2f}*sin({b:.2f}*u) + {c:.2f}" for a, b, c in rng.uniform(-3, 3, (group.dimension, 3))]
    stretches = group.translations
    strain = [f"{int(i == 0)} + 0.02*({w})" if i < stretches else f"2*({w})" for i, w in enumerate(waves)]
    scene = changed(straight(*coefficients, *ends), {"start.strain": strain, "run.until": 0.3})
    scene = proportional(scene, 0.02)
    bend, twist = group.strain[-1], group.strain[stretches]
    law = scene["rod"]["law"]["stress"]
    law["F1"] += f" + 0.1*{bend}_dot + 0.1*h1_dot*{twist}**2"
    law["F2"] += f" + 0.01*{bend}_dot*{bend}"
    law[group.stress[-1]] += f" - 0.1*h1_dot - 0.01*h2_dot*{bend}"
    assert geocosserat.check(scene["rod"]["law"]).verdict == "passive"
    solution = simulate(scene, 1, 6, rtol, "auto", frames=60).solution
    start = solution.energy[0]
    assert np.all(np.diff(solution.energy) <= 0.1 * rtol * start)
    assert np.all(np.diff(solution.dissipated) >= -0.1 * rtol * start)
    np.testing.assert_array_equal(solution.work, 0.0)
    np.testing.assert_allclose(solution.energy + solution.dissipated, start, rtol=0, atol=1000 * rtol * start)
    assert solution.energy[-1] < 0.999 * start


@pytest.mark.parametrize(("sign", "verdict"), [(1.0, "passive"), (-1.0, "active")])
def test_grips_that_stretch_a_rod_to_and_fro_work_what_its_viscosity_says(sign: float, verdict: str) -> None:
    """h1 = 1 + a sin(2 pi t), once, between a clamped end and a driven one: eta (2 pi a)^2 / 2, taken or given, as the
    check of the law says; drag on the grips aside. What the rod consists of says that it is viscous."""
    eta, a = 0.3 * sign, 0.2
    law = {"motion": "planar", "stress": {"F1": f"2*(h1 - 1) + ({eta})*h1_dot", "F2": "h2", "M": "Pi"}}
    scene = {
        "rod": {"motion": "planar", "length": 1.0, "law": law, "friction": [1e-9, 1e-9, 1e-9]},
        "ends": {"left": {"kind": "clamped"}, "right": {"kind": "driven", "twist": [f"{a}*2*pi*cos(2*pi*t)", 0, 0]}},
        "run": {"until": 1.0},
    }
    assert geocosserat.check(law).verdict == verdict
    run = simulate(scene, 1, 1, 1e-10, "auto", method="radau")
    assert run.contents["law"]["verdict"] == verdict
    assert "viscosity" in run.contents["terms"]
    assert run.contents["fields"] == ["h1", "h2", "Pi", "F1"]
    assert run.ledger["dissipated"] == pytest.approx(0.5 * eta * (2 * np.pi * a) ** 2, rel=1e-7)
    assert run.ledger["work"] == pytest.approx(0.5 * eta * (2 * np.pi * a) ** 2, rel=1e-7)
    assert abs(run.ledger["stored"]) < 1e-8


@pytest.mark.usefixtures("patience")
@pytest.mark.parametrize("method", ["cvode", "radau", "bdf"])
def test_a_rod_that_its_viscosity_feeds_gains_energy_or_says_why_it_stops(
    method: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Short waves grow; it is said that the law is active, and the ledger closes as far as the run goes."""
    scene = changed(straight(*PLANE), {"start.strain": ["1", "0", "0.1*(1 - u)"], "run.until": 2.0})
    run = simulate(viscous(scene, 0, 0, -0.1), 1, 6, 1e-6, "auto", frames=21, method=method)
    assert "the law of Kelvin and Voigt is active" in capsys.readouterr().err
    energy = run.solution.energy
    assert energy[-1] > 10 * energy[0] or not run.reached
    assert run.reached or run.solution.reason
    assert run.ledger["residual"] < 1e-2


@pytest.mark.usefixtures("patience")
@pytest.mark.parametrize("viscosity", [(0, -0.1, 0), slow((0, 0, -0.004))])
def test_a_rod_that_its_viscosity_tears_apart_ever_faster_is_given_up(viscosity: tuple[float, ...]) -> None:
    """Steps of Radau that grow shorter without end: not a million of them are taken to see that they lead nowhere."""
    scene = changed(straight(*PLANE), {"start.strain": ["1", "0", "0.1*(1 - u)"], "run.until": 2.0})
    run = simulate(viscous(scene, *viscosity), 1, 6, 1e-2, "c", frames=2, method="radau")
    assert not run.reached
    assert "the motion may be singular here" in run.solution.reason
    assert run.evaluations["steps"] < 200_000


@pytest.mark.usefixtures("patience")
@pytest.mark.parametrize("method", ["cvode", "radau", "bdf"])
def test_a_viscosity_that_leaves_the_stress_open_is_said_to_have_no_solution(method: str) -> None:
    """Less than nothing by just as much as the drag on two half nodes resists: the balance holds with any stress."""
    scene = straight([60.0, 40.0, 1.0], [1.0, 1.0, 1.0], "free", "free")
    scene = changed(scene, {"rod.frozen": ["h2", "Pi"], "start.strain": ["1.1", "0", "0"]})
    run = simulate(viscous(scene, -0.25, 0, 0), 1, 1, 1e-6, "auto", method=method)
    assert not run.reached
    assert run.solution.reason == "the constraints have no solution"


# what it tends to


@pytest.mark.slow
@pytest.mark.parametrize("coefficients", [PLANE, SPACE], ids=["planar", "spatial"])
def test_with_ever_less_viscosity_it_tends_to_the_elastic_rod(coefficients: Any) -> None:
    """Linearly over two decades: poses, strains, stresses."""
    elastic = simulate(stirred(straight(*coefficients)), 1, 8, 1e-11, "auto").solution
    near = [
        simulate(proportional(stirred(straight(*coefficients)), tau), 1, 8, 1e-11, "auto").solution
        for tau in (1e-4, 1e-5, 1e-6)
    ]
    for what in ("position", "turn", "stress"):
        errors = [gap(getattr(one, what)[-1], getattr(elastic, what)[-1]) for one in near]
        np.testing.assert_allclose(np.divide(errors[:-1], errors[1:]), 10.0, rtol=0.1)


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["h1", "Pi", "Pi1", "Pi3"])
def test_with_ever_more_viscosity_a_mode_tends_to_a_frozen_one(mode: str) -> None:
    """As one over the viscosity, from a start at which it is frozen: poses, and the stress that holds it."""
    coefficients, group = (SPACE, SE3) if mode in ("Pi1", "Pi3") else (PLANE, SE2)
    i = group.strain.index(mode)
    scene = stirred(straight(*coefficients))
    scene["start"]["strain"][i] = scene["rod"]["reference"][i]
    limit = simulate(changed(scene, {"rod.frozen": [mode]}), 1, 8, 1e-11, "auto").solution
    of = ["eta" if j == i else 0 for j in range(group.dimension)]
    near = [simulate(viscous(scene, *of, eta=eta), 1, 8, 1e-11, "auto").solution for eta in (1e3, 1e4, 1e5)]
    for errors in (
        [gap(one.position[-1], limit.position[-1]) for one in near],
        [gap(one.stress[-1, :, i], limit.stress[-1, :, i]) for one in near],
    ):
        np.testing.assert_allclose(np.divide(errors[:-1], errors[1:]), 10.0, rtol=0.1)


# ways to compute it


@pytest.mark.parametrize("frozen", [slow(False), True], ids=["full", "frozen"])
def test_all_methods_and_both_languages_find_the_same(frozen: bool) -> None:
    """Implicit ones that know constraints, and ordinary ones for which the stress is solved for in each evaluation."""
    scene = changed(proportional(stirred(straight(*PLANE)), TAU), {"rod.frozen": ["h1"] if frozen else []})
    exact = simulate(scene, 1, 6, 1e-11, "auto", method="radau").solution
    ways = (("cvode", "auto"), ("cvode", "numpy"), ("bdf", "numpy"), ("lsoda", "numpy"), ("bdf", "auto"))
    for method, backend in ways:
        found = simulate(scene, 1, 6, 1e-8, backend, method=method).solution
        for what, digits in (("position", 1e-6), ("turn", 1e-5), ("stress", 1e-3)):
            assert gap(getattr(found, what)[-1], getattr(exact, what)[-1]) < digits, (method, backend, what)


def test_a_viscosity_may_be_there_on_a_part_of_the_rod_and_change_in_time() -> None:
    """Where and when there is none the stress is the elastic one; elements end where it steps."""
    scene = viscous(stirred(straight(*PLANE)), 0, 0, "0.1*heaviside(u - 0.3)*heaviside(0.15 - t)")
    run = simulate(scene, 2, 8, 1e-9, "auto", frames=5)
    solution = run.solution
    bend = solution.turn[..., 2] - (1.0 - solution.u_point)
    excess = solution.stress[..., 2] - bend
    assert np.abs(excess[:, solution.u_point < 0.3]).max() < 1e-9
    assert np.abs(excess[solution.time > 0.15]).max() < 1e-9
    assert np.abs(excess[1, solution.u_point > 0.3]).max() > 1e-2
    assert run.ledger["residual"] < 1e-6
