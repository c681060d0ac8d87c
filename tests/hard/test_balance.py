"""Rods whose energy is no square: no step of the safe method makes any, and the books of the midpoint rule close."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import geocosserat
from benchmarks.torture.case import planar, spatial
from benchmarks.torture.cases import laws
from geocosserat.conductor import simulate
from geocosserat.conductor.kernels import choose_backend, kernel_text
from geocosserat.conductor.scene import load_any
from geocosserat.discretisation.correcting import correctable, corrected
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.kernel.balance import RodBalance
from geocosserat.kernel.load import load
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod
from geocosserat.solver.consistent import consistent
from geocosserat.solver.diagonal import GAMMAS, Diverged, Stepper
from geocosserat.solver.integrate import LAST_RESORTS
from tests.hard.test_safe import RODS
from tests.passivity.zoo import ZOO

Array = NDArray[np.float64]
ROUND_OFF = 1e-12
"""What some thousand roundings leave of an energy."""

STEPS = (1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1.0, 1e3)
BENT = {"planar": ["1 + 0.1*sin(3*s)", "0.1*cos(4*s)", "1.5*(1 - s)"],
        "spatial": ["1 + 0.1*sin(3*s)", "0.1*cos(4*s)", "0.1*s", "0.5*s", "1 - s", "s*(1 - s)"]}  # fmt: skip
SHIPPED = ("hertz", "isotropic", "kelvin_voigt", "piecewise", "tension_stiffening")
FILES = Path(__file__).parents[2] / "examples" / "laws"


def _of(law: Any, **more: Any) -> dict[str, Any]:
    """A rod of a law, that is bent."""
    make = spatial if law["motion"] == "spatial" else planar
    return make(**{"rod__law": law, "rod__stiffness": None, "start__strain": BENT[law["motion"]], **more})


TWO = {"motion": "planar", "energy": {"density": "500*(h1 - 1)**2 + 500*h2**2 + 0.05*(Pi**2 - 9)**2"}}
SPACE = {
    "motion": "spatial",
    "energy": {"density": "200*(h1 - 1)**2 + 99*(h2**2 + h3**2) + 0.4*Pi1**2*(1 + Pi2**2) + 2*cosh(Pi2) + Pi3**2/2"},
}
SLOW = {  # its bend is bistable, and creeps
    "motion": "planar",
    "stress": {"F1": "1e3*(h1 - 1)", "F2": "1e3*h2", "M": "0.2*Pi*(Pi**2 - 9) + 1e-3*Pi_dot"},
}
ODD = {  # part of its stress has no energy, and takes some only where the rod moves so
    "motion": "planar",
    "stress": {"F1": "50*(h1 - 1)", "F2": "50*h2 + 0.5*Pi", "M": "0.2*Pi*(Pi**2 - 9) - 0.5*h2"},
}
HILL = ["1", "0.01", "0.3*sin(3*pi*s) + 0.5"]
"""A bend from which a bistable rod goes down, the faster the farther."""

LAWS: dict[str, dict[str, Any]] = {
    **{case.name: dict(case.scene) for case in laws()},
    **{name: _of(tomllib.loads((FILES / f"{name}.toml").read_text())) for name in SHIPPED},
    "hardening, in space": _of(SPACE),
    "bistable, going down": _of(TWO, start__strain=HILL),
    "bistable and creeping": _of(SLOW, start__strain=HILL),
    "bistable and odd": _of(ODD, start__strain=HILL),
    "bistable, inextensible": _of(TWO, rod__frozen=["h1", "h2"], start__strain=["1", "0", HILL[2]]),
    "bistable, inextensible, held at both ends": _of(
        TWO, rod__frozen=["h1", "h2"], start__strain=["1", "0", HILL[2]],
        ends={"left": {"kind": "clamped"}, "right": {"kind": "clamped"}},
    ),
    "bistable, free": _of(TWO, start__strain=HILL, ends={"left": {"kind": "free"}, "right": {"kind": "free"}}),
    "bistable under weight": _of(
        TWO, start__strain=HILL, effects=[{"kind": "weight", "force": [3.0, -9.0]}]
    ),
    "bistable and pushed": _of(
        TWO, start__strain=HILL, effects=[{"kind": "follower", "force": ["-5*sin(40*t)", 8]}]
    ),
    "bistable, base driven": _of(
        TWO, start__strain=HILL, ends__left={"kind": "driven", "twist": [0, 0, "6*cos(20*t)"]}
    ),
}  # fmt: skip
SQUARES = ("isotropic", "kelvin_voigt", "creeping rod")
LOSING = ("bistable rod", *(name for name in LAWS if name.startswith("bistable")))
"""Laws of which the safe method by itself would make energy."""

PASSIVE = [
    name for name, known in ZOO.items()
    if known.verdict == "passive" and {"stress", "energy"} & set(known.law)
    and name not in ("a modulus as a root", "Kelvin-Voigt, cubic")  # which start, or run, as no rod does
]  # fmt: skip
QUICK = ("rational", "two-sided spring", "infinite at full compression", "a density")


def _of_zoo(name: str) -> dict[str, Any]:
    """A rod of a law of the zoo, with numbers for what it leaves open."""
    law = {key: value for key, value in ZOO[name].law.items() if key not in ("wrench", "friction")}
    if "parameters" in law:
        law["parameters"] = {key: 0.7 if isinstance(x, dict) else x for key, x in law["parameters"].items()}
    return _of(law)


class Rod:
    """A rod of a few points with its balance; counts the corrections that are tried."""

    def __init__(self, scene: dict[str, Any], backend: str = "numpy") -> None:
        rod = discretise(load_any(scene), 2, 3)
        assert correctable(rod.structure)
        self.rod: SemiDiscrete = corrected(rod)
        self.kernel: NativeRod | NumpyRod = load(kernel_text(self.rod.structure), self.rod, backend)
        self.balance = RodBalance(self.kernel, self.rod)
        self.tried = 0
        whole = self.balance.correct

        def correct(share: float) -> None:
            self.tried += share != 0.0
            whole(share)

        self.balance.correct = correct  # type: ignore[method-assign]

    def made(self, before: Array, after: Array) -> tuple[float, float]:
        """The energy that a step made of nothing, and what rounding may make: of strains, and so of the stresses."""
        size, energies = 0.0, []
        for y in (before, after):
            _, stress, energy = self.kernel.observe(0.0, y)
            strain = np.abs(self.rod.turn(y)) + 1.0
            size += float((np.abs(stress) * strain).sum(axis=0) @ self.rod.mesh.weight) + abs(energy)
            size += float(np.abs(y[-2:]).sum())
            energies.append(energy)
        dissipated, work = after[-2:] - before[-2:]
        return energies[1] - energies[0] + dissipated - work, ROUND_OFF * size

    def steps(self, method: str, h: float, count: int = 4) -> list[tuple[float, float]]:
        """Of some steps from the start, what was made and what rounding may make; fewer if one is too long."""
        start = consistent(self.kernel, 0.0, self.rod.state, blocks=True)
        stepper = Stepper(self.kernel, GAMMAS[method], 0.0, start, 1e-6, np.full(len(start), 1e-6), self.balance)
        told = []
        with np.errstate(all="ignore"):
            for _ in range(count):
                stepper.linearise(stepper.t, stepper.y)
                try:
                    end = stepper.end(h)
                except Diverged:
                    break
                told.append(self.made(stepper.y, end))
                stepper.t, stepper.y = stepper.t + h, end
        return told


@cache
def _rod(name: str) -> Rod:
    return Rod(LAWS[name])


@pytest.mark.parametrize("name", LAWS)
def test_no_step_of_the_safe_method_makes_energy_of_any_law(name: str) -> None:
    """Stored and dissipated less the work never grow, by more than round-off, in steps from tiny to huge."""
    rod = _rod(name)
    rod.tried = 0
    told = [step for h in STEPS for step in rod.steps("safe", h)]
    assert len(told) >= 12
    assert all(made <= noise for made, noise in told)
    assert rod.tried > 0 or name not in LOSING
    assert rod.tried == 0 or name not in SQUARES


@pytest.mark.parametrize("name", LAWS)
def test_the_books_of_the_midpoint_rule_close_for_any_law(name: str) -> None:
    """In each step, to round-off, in steps from tiny to huge; those of a square are kept by the rule itself."""
    rod = _rod(name)
    rod.tried = 0
    told = [step for h in STEPS for step in rod.steps("midpoint", h)]
    assert len(told) >= 12
    assert all(abs(made) <= noise for made, noise in told)
    assert (rod.tried > 0) == (name not in SQUARES)


@pytest.mark.parametrize("name", [pytest.param(n, marks=() if n in QUICK else pytest.mark.slow) for n in PASSIVE])
def test_no_passive_law_of_the_zoo_gives_energy_in_a_step(name: str) -> None:
    """Neither method makes any, and the midpoint rule loses none."""
    scene = _of_zoo(name)
    if not correctable(discretise(load_any(scene), 1, 2).structure):
        assert ZOO[name].law.get("domain") or "all six" in name  # no energy is known, so all is booked as lost
        return
    rod = Rod(scene)
    for method in LAST_RESORTS:
        told = [step for h in STEPS for step in rod.steps(method, h)]
        assert len(told) >= 3
        assert all(made <= noise and (method == "safe" or made >= -noise) for made, noise in told)


@pytest.mark.parametrize("method", LAST_RESORTS)
@pytest.mark.parametrize("name", ["hardening rod", "bistable, going down", "bistable, inextensible"])
def test_steps_that_are_made_again_are_of_second_order(name: str, method: str) -> None:
    """Half the step, a quarter of the error."""
    rod, ends = _rod(name), []
    for steps in (30, 60, 960):
        start = consistent(rod.kernel, 0.0, rod.rod.state, blocks=True)
        stepper = Stepper(rod.kernel, GAMMAS[method], 0.0, start, 1e-6, np.full(len(start), 1e-6), rod.balance)
        rod.tried = 0
        for _ in range(steps):
            stepper.linearise(stepper.t, stepper.y)
            stepper.y = stepper.end(2e-4 / steps)
        assert rod.tried > 0 or steps > 60 or (method == "safe" and name not in LOSING)
        ends.append(rod.rod.turn(stepper.y))
    coarse, fine = (np.abs(y - ends[-1]).max() for y in ends[:2])
    assert 3.4 < coarse / fine < 4.7


def test_a_correction_is_a_stress_beside_that_of_the_law() -> None:
    """It moves the rod, is told with the stress, and is in no energy and no loss; compiled or not."""
    for backend in dict.fromkeys(("numpy", choose_backend("auto"))):
        rod = Rod(LAWS["bistable and creeping"], backend)
        y = consistent(rod.kernel, 0.0, rod.rod.state, blocks=True)
        other = y.copy()
        other[:-2] *= 1.01
        does = rod.balance.aim(0.0, y, other)
        rod.balance.correct(1.0)
        assert does == pytest.approx(_power(rod, other - y))
        assert does > 0.0
        rod.balance.correct(0.0)
        before, energy = np.empty_like(y), rod.balance.stored(0.0, y)[0]
        rod.kernel.rate(0.0, y, before)
        rod.balance.correct(0.1)
        again, after = consistent(rod.kernel, 0.0, y, blocks=True), np.empty_like(y)
        rod.kernel.rate(0.0, again, after)
        moves = rod.kernel.algebraic == 0.0
        assert not np.allclose(after[moves], before[moves])
        assert rod.balance.stored(0.0, again)[0] == energy
        power = _power(rod, after)
        assert power != 0.0
        # what the law stores, and all that is booked, differ by the power of the correction alone
        h = 1e-7
        there, back = (rod.balance.stored(0.0, again + sign * h * after)[0] for sign in (1.0, -1.0))
        stored = (there - back) / (2 * h)
        assert stored + after[-2] - after[-1] == pytest.approx(-power, rel=1e-5)


def _power(rod: Rod, rates: Array) -> float:
    """What the correction does against the rates of the turn."""
    pushed = rod.rod.point[-3:]
    return float((pushed * rod.rod.turn(rates)).sum(axis=0) @ rod.rod.mesh.weight)


def test_a_correction_is_exact_in_the_jacobian() -> None:
    """Newton's method knows it: derivatives are those of the rates with it."""
    rod = Rod(LAWS["bistable, going down"])
    y = rod.rod.state
    rod.balance.aim(0.0, y, 1.01 * y)
    rod.balance.correct(0.5)
    J, h = rod.kernel.jacobian(0.0, y), 1e-6
    for i in range(0, len(y) - 2, 4):
        ends = []
        for sign in (1.0, -1.0):
            there, rate = y.copy(), np.empty_like(y)
            there[i] += sign * h
            rod.kernel.rate(0.0, there, rate)
            ends.append(rate)
        slope = (ends[0] - ends[1]) / (2 * h)
        np.testing.assert_allclose(J[:-2, i], slope[:-2], rtol=1e-5, atol=1e-6 * np.abs(J).max())


@pytest.mark.parametrize("scene", RODS.values(), ids=RODS)
def test_a_rod_with_a_stiffness_is_left_alone(scene: dict[str, Any]) -> None:
    """Its energy is a square: its kernel and its steps are what they are without all this."""
    simulator = simulate.Simulator(load_any(scene), "numpy", kernel_text, simulate.Clock())
    rod, kernel, _ = simulator._on(2, 3)
    assert [simulator._for(method, rod, kernel) for method in LAST_RESORTS] == [(kernel, None)] * 2


def test_only_the_last_resorts_have_a_kernel_of_their_own() -> None:
    """Other methods have the one without corrections, whatever the law."""
    simulator = simulate.Simulator(load_any(LAWS["hardening rod"]), "numpy", kernel_text, simulate.Clock())
    rod, kernel, _ = simulator._on(2, 3)
    assert simulator._for("radau", rod, kernel) == (kernel, None)
    its, balance = simulator._for("safe", rod, kernel)
    assert its is not kernel
    assert balance is not None


def test_a_law_that_changes_in_time_is_left_alone() -> None:
    """Its energy changes without any motion, which no correction of a stress could make up for."""
    law = tomllib.loads((FILES / "beating.toml").read_text())
    assert not correctable(discretise(load_any(_of(law)), 1, 2).structure)


RUNS = ("hardening rod", "bistable, going down", "bistable and creeping", "tension_stiffening", "piecewise")


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.slow if n in RUNS[2:] else ()) for n in RUNS])
@pytest.mark.parametrize("method", LAST_RESORTS)
def test_a_run_keeps_the_balance_at_any_tolerance(name: str, method: str) -> None:
    """By either method, with steps that are as long as can be."""
    settings = [f"run.method={method}", "run.elements=2", "run.degree=3", "run.rtol=0.1", "run.backend=numpy"]
    run = geocosserat.run(LAWS[name], settings=settings)
    assert run.reached
    found = run.solution
    scale = float(np.abs(found.stress * found.turn).sum(axis=(-1, -2)).max() + found.energy[0])
    balance = np.diff(found.energy + found.dissipated - found.work)
    assert balance.max() <= 1e-10 * scale
    assert np.diff(found.energy).max() <= 1e-10 * scale
    if method == "midpoint":
        assert balance.min() >= -1e-10 * scale


def test_where_the_safe_method_takes_over_it_keeps_the_balance(monkeypatch: pytest.MonkeyPatch) -> None:
    """The method that failed had a kernel without corrections, whose states serve on."""
    whole, given = simulate.integrate, []

    def integrate(kernel: Any, start: Array, times: Array, method: str, *rest: Any) -> Any:
        if method != "safe":
            return simulate.Trajectory(times[:1].copy(), start[None].copy(), 1, 0, 0, False, "it broke")
        given.append(rest[-1])
        return whole(kernel, start, times, method, *rest)

    monkeypatch.setattr(simulate, "integrate", integrate)
    scene = _of(TWO, start__strain=HILL, run__elements=2, run__degree=3, run__rtol=1e-2, run__accuracy=None)
    run = geocosserat.run(scene, settings=["run.backend=numpy"])
    assert run.reached
    assert run.fell_back["reason"] == "it broke"
    assert isinstance(given[-1], RodBalance)
    assert np.diff(run.solution.energy + run.solution.dissipated).max() <= 1e-12 * run.solution.energy[0]
