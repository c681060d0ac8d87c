"""The safe method on rods: energies, step by step, whatever the step; and what it takes over."""

from __future__ import annotations

import json
from dataclasses import replace
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from rich.console import Console

import geocosserat
from benchmarks.torture.case import planar, spatial
from geocosserat.conductor import simulate
from geocosserat.conductor.kernels import kernel_text
from geocosserat.conductor.scene import load_any
from geocosserat.discretisation.sampling import stiffnesses
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.kernel.load import load
from geocosserat.kernel.pure import NumpyRod
from geocosserat.results.summary import print_summary
from geocosserat.solver.consistent import consistent
from geocosserat.solver.diagonal import GAMMAS, Diverged, Stepper
from geocosserat.solver.trajectory import Trajectory

Array = NDArray[np.float64]
ROUND_OFF = 1e-12
"""What some thousand roundings leave of an energy."""

NOISE = "(sin(91234.567*s) + sin(67891.234*s**2))"
RODS = {
    "stiff": planar(rod__stiffness=[1e6, 1e6, 1.0]),
    "spatial": spatial(),
    "inextensible": planar(rod__frozen=["h1", "h2"]),
    "Kirchhoff": spatial(rod__frozen=["h1", "h2", "h3"], start__strain=["1", "0", "0", "3", "0", "5*s"]),
    "noisy": planar(start__strain=[f"1 + 0.1*{NOISE}", f"0.1*{NOISE}", f"9*{NOISE}"]),
    "inside out": planar(rod__stiffness=[1e2, 1e2, 1.0], start__strain=["-0.5", "0", "1"]),
    "under weight": planar(effects=[{"kind": "weight", "force": [3.0, -9.0]}]),
    "without rotational friction": planar(rod__friction=[1.0, 2.0, 0]),
}
STEPS = (1e-8, 1e-5, 1e-3, 1.0)


def _kernel(scene: dict[str, Any]) -> tuple[SemiDiscrete, NumpyRod]:
    """A rod of four elements, its kernel in numpy."""
    rod = discretise(load_any(scene), 4, 3)
    kernel = load(kernel_text(rod.structure), rod, "numpy")
    assert isinstance(kernel, NumpyRod)
    return rod, kernel


def _made(
    rod: SemiDiscrete, kernel: NumpyRod, stiff: Array, before: Array, after: Array
) -> tuple[float, float]:
    """The energy that a step made of nothing, and what rounding does to it: strains are rounded, by which stresses are
    off that act on them and on their changes."""
    (_, _, was), (_, _, stored) = kernel.observe(0.0, before), kernel.observe(0.0, after)
    dissipated, work = after[-2:] - before[-2:]
    turns = np.abs(rod.turn(before)), np.abs(rod.turn(after))
    stresses = [np.abs(kernel.observe(0.0, y)[1]) for y in (before, after)]
    off = stiff[:, None] * turns[1] * np.abs(rod.turn(after) - rod.turn(before))
    powers = stresses[0] * turns[0] + stresses[1] * turns[1] + off
    rounded = float(powers.sum(axis=0) @ rod.mesh.weight) + max(was, stored, abs(dissipated), abs(work))
    return stored - was + dissipated - work, ROUND_OFF * rounded


def _steps(name: str, method: str, h: float, count: int = 3) -> list[tuple[float, float, float]]:
    """Of some steps from the start: what was made, what may be by round-off, and what was dissipated; fewer if a step
    is so long that its equations are not solved."""
    rod, kernel = _kernel(RODS[name])
    stiff = np.array(stiffnesses(load_any(RODS[name]).model))
    start = consistent(kernel, 0.0, rod.state, blocks=True)
    stepper = Stepper(kernel, GAMMAS[method], 0.0, start, 1e-6, np.full(len(start), 1e-6))
    told = []
    for _ in range(count):
        stepper.linearise(stepper.t, stepper.y)
        try:
            end = stepper.end(h)
        except Diverged:
            break
        told.append((*_made(rod, kernel, stiff, stepper.y, end), float(end[-2] - stepper.y[-2])))
        stepper.t, stepper.y = stepper.t + h, end
    return told


@pytest.mark.parametrize("name", RODS)
def test_no_step_of_the_safe_method_makes_energy(name: str) -> None:
    """Stored and dissipated less the work never grow, by more than round-off, in steps from tiny to huge."""
    told = [step for h in STEPS for step in _steps(name, "safe", h)]
    assert len(told) >= 6
    for made, noise, dissipated in told:
        assert made <= noise
        assert dissipated >= 0.0


@pytest.mark.parametrize("name", RODS)
def test_the_ledger_of_the_midpoint_rule_closes_in_each_step(name: str) -> None:
    """To round-off, in steps from tiny to huge: nothing is made and nothing lost."""
    told = [step for h in STEPS for step in _steps(name, "midpoint", h)]
    assert len(told) >= 6
    for made, noise, _ in told:
        assert abs(made) <= noise


def test_a_large_step_of_the_safe_method_brings_a_rod_to_rest() -> None:
    """One a million times as long as the rod takes to relax leaves next to nothing of its energy."""
    rod, kernel = _kernel(RODS["stiff"])
    stepper = Stepper(kernel, GAMMAS["safe"], 0.0, rod.state, 1e-6, np.full(len(rod.state), 1e-6))
    stepper.linearise(0.0, rod.state)
    end = stepper.end(1e6)
    assert kernel.observe(0.0, end)[2] < 1e-8 * kernel.observe(0.0, rod.state)[2]


@pytest.mark.slow
@pytest.mark.parametrize("scene", [RODS["stiff"], RODS["Kirchhoff"]])
def test_a_run_by_the_safe_method_agrees_with_the_default(scene: dict[str, Any]) -> None:
    """To the accuracy asked for, and the ledger says what the step control let pass."""
    safe = geocosserat.run(scene, settings=["run.method=safe", "run.accuracy=1e-4"])
    other = geocosserat.run(scene, settings=["run.accuracy=1e-6"])
    assert safe.reached
    assert safe.method == "safe"
    assert safe.fell_back is None
    assert np.linalg.norm(np.subtract(safe.tip["position"], other.tip["position"])) < 1e-4
    assert safe.ledger["residual"] < 1e-3
    assert np.all(np.diff(safe.solution.energy) <= 0.0)


def _failing(monkeypatch: pytest.MonkeyPatch, at: float, methods: tuple[str, ...]) -> None:
    """Some methods stop at that part of the time."""
    whole = simulate.integrate

    def integrate(kernel: Any, start: Array, times: Array, method: str, *rest: Any) -> Trajectory:
        if method not in methods:
            return whole(kernel, start, times, method, *rest)
        some = times[: max(1, round(at * len(times)))]
        if len(some) < 2:
            return Trajectory(times[:1].copy(), start[None].copy(), 1, 0, 0, False, f"{method} broke")
        return replace(whole(kernel, start, some, method, *rest), reached=False, reason=f"{method} broke")

    monkeypatch.setattr(simulate, "integrate", integrate)


@pytest.mark.parametrize("at", [0.0, 0.5])
def test_the_safe_method_takes_over_where_the_default_fails(at: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """From the last good state on, to the end, with the accuracy; and the run says so."""
    scene = planar(run__accuracy=1e-4)
    right = geocosserat.run(scene)
    _failing(monkeypatch, at, ("radau", "cvode"))
    run = geocosserat.run(scene)
    assert run.reached
    assert run.method == "safe"
    assert run.fell_back["from"] == right.method
    assert run.fell_back["reason"] == f"{right.method} broke"
    assert run.fell_back["at"] == pytest.approx(at * 0.05, abs=0.003)
    assert len(run.solution.time) == 26
    assert np.linalg.norm(np.subtract(run.tip["position"], right.tip["position"])) < 1e-4


def test_a_method_that_was_asked_for_is_not_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    """Who names a method wants that one: its failure is told as it is."""
    _failing(monkeypatch, 0.5, ("radau",))
    run = geocosserat.run(planar(run__method="radau", run__elements=2, run__degree=3))
    assert not run.reached
    assert run.reason == "radau broke"
    assert run.method == "radau"
    assert run.fell_back is None


def test_where_the_safe_method_fails_as_well_both_reasons_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """And the last good state is kept."""
    _failing(monkeypatch, 0.0, ("cvode", "safe"))
    run = geocosserat.run(planar(run__elements=2, run__degree=3))
    assert not run.reached
    assert run.reason == "cvode broke; safe broke"
    assert run.solution.time.tolist() == [0.0]


def test_falling_back_is_printed_and_saved(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The summary has a line, the files have the field."""
    _failing(monkeypatch, 0.5, ("cvode",))
    run = geocosserat.run(planar(run__elements=2, run__degree=3), tmp_path)
    told = {"from": "cvode", "at": pytest.approx(0.024), "reason": "cvode broke"}
    assert json.loads((tmp_path / "summary.json").read_text())["fell_back"] == told
    assert geocosserat.load(tmp_path / "solution.nc").fell_back == told
    text = StringIO()
    print_summary(run.solution, Console(file=text, width=200))
    assert "to the safe method from t = 0.024 on: cvode broke" in text.getvalue()
