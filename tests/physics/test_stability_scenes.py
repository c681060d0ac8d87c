"""The scenes in `examples/stability`: each loads, and its kernels, linearised, have the growths of the references."""

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocosserat.model.scene import load_scene
from tests.physics.scenes import changed, growths, polynomial
from tests.references import chebyshev
from tests.references.stability import equilibria, michell
from tests.references.stability.equilibria import Equilibrium, all_equilibria
from tests.references.stability.table import RING, Value, all_values

FOLDER = Path(__file__).parents[2] / "examples" / "stability"
# held stress of frozen modes is not known from the start alone
WHOLE = [entry for entry in all_values() if not entry.scene.endswith("_limit")]


def _scene(entry: Value, parameter: float) -> dict[str, Any]:
    """The scene at one value of its parameter, starting from its state of rest."""
    with open(FOLDER / f"{entry.scene}.toml", "rb") as file:
        scene = tomllib.load(file)
    if entry.scene.startswith("ring"):
        scene["start"]["strain"] = michell.state(RING, parameter)[0].tolist()
    return changed(scene, {f"parameters.{entry.over}": parameter})


@pytest.mark.parametrize("file", sorted(FOLDER.glob("*.toml")), ids=lambda file: file.stem)
def test_every_scene_loads_and_says_what_one_sees(file: Path) -> None:
    """The first line is one comment of a line's length, and the scene prints its title."""
    scene = load_scene(file)
    first = file.read_text(encoding="utf-8").splitlines()[0]
    assert first.startswith("# ")
    assert 60 < len(first) <= 120
    assert scene.title in str(scene)


def test_every_value_has_its_scene() -> None:
    """The parameter of each value is one of its scene."""
    for entry in all_values():
        assert entry.over in load_scene(FOLDER / f"{entry.scene}.toml").model.parameters


@pytest.mark.parametrize("entry", WHOLE, ids=lambda entry: entry.scene)
def test_the_linearised_kernel_has_the_growths_of_the_reference(entry: Value) -> None:
    """Those of largest real part; strains that would open a rod held at both ends, or a ring, do not change."""
    for parameter, expected in entry.growths:
        found = growths(_scene(entry, parameter), 2, 10)
        moving = found[np.abs(found) > 1e-4]
        top = moving[np.argmax(moving.real)]
        assert abs(complex(top.real, abs(top.imag)) - expected) < 1e-6 * abs(expected)


def _bent(entry: Equilibrium) -> dict[str, Any]:
    """The scene of a bent equilibrium, starting from it: its strains as polynomials of u."""
    _, state = (
        equilibria.column(entry.settings["load"])
        if entry.scene == "column_buckled"
        else equilibria.bend(entry.settings["load"], entry.settings["torsion"])
    )
    u = chebyshev.points(16, state.length)
    turns = np.array([state.turn(stress) for stress in state.stress(u)])[:, state.parts]
    with open(FOLDER / f"{entry.scene}.toml", "rb") as file:
        scene = tomllib.load(file)
    scene.setdefault("start", {})["strain"] = [polynomial(u, turn, 16) for turn in turns.T]
    return changed(scene, {f"parameters.{name}": value for name, value in entry.settings.items()})


@pytest.mark.parametrize("entry", [all_equilibria()[1], all_equilibria()[-2]], ids=lambda entry: entry.scene)
def test_the_linearised_kernel_has_the_growths_of_the_bent_equilibrium(entry: Equilibrium) -> None:
    """Started from the strains of the reference, the leading growth is that of the table."""
    found = growths(_bent(entry), 2, 10)
    assert found[np.argmax(found.real)] == pytest.approx(entry.growth, rel=1e-5)
