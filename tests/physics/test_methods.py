"""Four integrators, two languages, two linear solvers, one rod."""

from __future__ import annotations

import numpy as np
import pytest

from geocosserat.conductor.kernels import kernel_text
from geocosserat.conductor.simulate import tolerances
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.load import load
from geocosserat.model.scene import load_scene
from geocosserat.solver import cvode, integrate
from geocosserat.solver.integrate import integrate as integrated
from tests.physics.scenes import Array, Scene, changed, example, simulate, straight, tip

pytestmark = pytest.mark.slow

SCENES = {name: changed(example(name), {"run.until": until}) for name, until in (("follower", 0.3), ("sinking", 0.02))}
CURLED = changed(example("helix"), {"rod.reference": [1.0, 0.0, 0.0, 2.0, 0.0, 4.0], "run.until": 0.02})


def _everything(scene: Scene, degree: int, rtol: float, **run: object) -> Array:
    """Positions at the end, and the ledger, as one array."""
    found = simulate(scene, 1, degree, rtol, **run)
    ledger = [found.ledger[name] for name in ("stored", "dissipated", "work")]
    return np.concatenate([found.solution.position[-1].ravel(), np.array(ledger) / max(map(abs, ledger))])


@pytest.mark.parametrize("method", ["radau", "bdf", "lsoda"])
@pytest.mark.parametrize("name", SCENES)
def test_all_methods_agree(name: str, method: str) -> None:
    """Positions and ledger are those of CVODE, within what their tolerances leave."""
    loose, tight = (
        np.abs(_everything(SCENES[name], 6, rtol, method=method) - _everything(SCENES[name], 6, 1e-11)).max()
        for rtol in (1e-5, 1e-9)
    )
    assert loose < 1e-2
    assert tight < 1e-6
    assert tight < 1e-2 * loose


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize("name", [*SCENES, "euler_bernoulli", "kirchhoff"])
def test_radau_in_c_agrees_with_cvode(name: str) -> None:
    """Positions and ledger, with frozen modes and without, in less than half the steps; tighter ones come closer."""
    scene = SCENES.get(name) or example(name)
    exact = _everything(scene, 6, 1e-11, backend="c")
    loose, tight = (
        np.abs(_everything(scene, 6, rtol, method="radau", backend="c") - exact).max() for rtol in (1e-3, 1e-8)
    )
    assert loose < 1e-2
    assert tight < 1e-7
    ours, other = (simulate(scene, 1, 6, 1e-8, "c", method=m).evaluations["steps"] for m in ("radau", "cvode"))
    assert 2 * ours < other


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize("rtol", [1e-1, 1e-3, 1e-5, 1e-7, 1e-9])
@pytest.mark.parametrize("name", ["euler_bernoulli", "inextensible", "kirchhoff"])
def test_radau_finds_the_stresses_of_frozen_modes_to_its_tolerance(name: str, rtol: float) -> None:
    """They count less in its Newton's method than what moves, for they follow from it; at every frame of an example."""
    scene = load_scene(example(name))
    rod = discretise(scene, 1, 8)
    kernel = load(kernel_text(rod.structure), rod, "c")
    times = np.linspace(0.0, scene.run.until, 21)
    exact, found = (
        integrated(kernel, rod.state, times, "radau", tight, tolerances(rod, tight, None, 1.0)).states
        for tight in (1e-12, rtol)
    )
    may = tolerances(rod, rtol, None, 1.0) + rtol * np.abs(exact).max(axis=0)
    stress = kernel.algebraic > 0.0
    assert np.abs(exact[:, stress]).max() > 0.1, "there is next to no stress: this compares nothing"
    assert np.all(np.abs(found - exact)[:, stress] <= may[stress])


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize("method", ["cvode", "bdf"])
@pytest.mark.parametrize("scene", [SCENES["sinking"], CURLED], ids=["sinking", "curled"])
def test_numpy_gives_what_c_gives(scene: Scene, method: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """At a loose tolerance too: through the same binding both compute the same numbers, so the steps are the same."""
    monkeypatch.setattr(integrate, "sundials", lambda _: None)
    c, numpy = (_everything(scene, 6, 1e-6, method=method, backend=backend) for backend in ("c", "numpy"))
    np.testing.assert_allclose(numpy, c, rtol=0, atol=1e-9)


@pytest.mark.parametrize("scene", [SCENES["sinking"], CURLED], ids=["sinking", "curled"])
def test_dense_and_block_elimination_agree(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same rod with dense matrices and with the kernel's own elimination as preconditioner, on three elements."""
    tips, steps = [], []
    for limit in (10_000, 0):
        monkeypatch.setattr(cvode, "DENSE_LIMIT", limit)
        run = simulate(scene, 3, 6, 1e-9, "numpy")
        tips.append(tip(run))
        steps.append(run.evaluations["steps"])
    np.testing.assert_allclose(tips[0], tips[1], rtol=0, atol=1e-7)
    assert steps[1] < 2 * steps[0] + 50


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize("elements", [1, 3])
@pytest.mark.parametrize("scene", [SCENES["sinking"], CURLED], ids=["sinking", "curled"])
def test_sundials_called_directly_gives_what_it_gives_through_its_binding(
    scene: Scene, elements: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """There its own matrices are used, here the kernel's blocks; with about as many steps."""
    here = simulate(scene, elements, 6, 1e-9, "c")
    monkeypatch.setattr(integrate, "sundials", lambda _: None)
    there = simulate(scene, elements, 6, 1e-9, "c")
    np.testing.assert_allclose(tip(here), tip(there), rtol=0, atol=1e-7)
    assert here.evaluations["steps"] < 1.2 * there.evaluations["steps"] + 50


@pytest.mark.usefixtures("c_compiler")
@pytest.mark.parametrize("frozen", [[], ["h1", "h2"]], ids=["full", "frozen"])
def test_a_rotation_without_friction_takes_about_as_many_steps_as_one_with_some(frozen: list[str]) -> None:
    """Under a couple that no moment balances at first; and the ledger closes."""
    field = {"kind": "field", "moment": [1.0, 0.0], "field": [2.0, 1.0]}
    runs = [
        simulate(
            changed(
                straight([60.0, 40.0, 1.0], [1.0, 1.7, friction]),
                {"rod.frozen": frozen, "effects": [field], "run.until": 0.5},
            ),
            1, 12, 1e-7, "c",
        )
        for friction in (0.02, 0)
    ]  # fmt: skip
    rubbed, quasi_static = (run.evaluations["steps"] for run in runs)
    assert quasi_static < 3 * rubbed
    assert max(run.ledger["residual"] for run in runs) < 1e-3
