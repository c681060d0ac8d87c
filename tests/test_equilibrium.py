"""Where rods rest: against closed forms and shooting, on every mesh, and by every way to get there."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from geocosserat.cli import main
from geocosserat.conductor.equilibrium import Equilibrium, NotReached, equilibrium
from geocosserat.conductor.kernels import kernel_text
from geocosserat.conductor.run import run
from geocosserat.conductor.standing import stand
from geocosserat.model.errors import InputError
from geocosserat.model.scene import load_scene
from geocosserat.results.netcdf import load
from tests.references.stability import equilibria
from tests.references.stability.equilibria import Equilibrium as Known

KNOWN = equilibria.all_equilibria()
NAMES = [
    f"{known.scene}-{'-'.join(f'{x:g}' for x in known.settings.values())}{'-small' if known.small else ''}"
    for known in KNOWN
]


def settings(known: Known) -> list[str]:
    return [f"{key}={value!r}" for key, value in known.settings.items()]


def column(load: float, **more: Any) -> dict[str, Any]:
    """A column under a dead load, straight at the start."""
    return {
        "rod": {"motion": "planar", "length": 1.0, "stiffness": [40.0, 16.0, 1.0], "friction": [1.0, 2.0, 0.02]},
        "ends": {"left": {"kind": "clamped"}, "right": {"kind": "free", "force": [-load, 0.0], "frame": "world"}},
        "run": {"until": 1.0},
        **more,
    }


@pytest.mark.parametrize("known", KNOWN, ids=NAMES)
def test_the_tip_is_where_elliptic_integrals_and_shooting_have_it(known: Known, examples: Path) -> None:
    """To nine digits of the length, and the leading growth rate to eight; of a rod that snaps both buckled states."""
    scene = examples / "stability" / f"{known.scene}.toml"
    found = equilibrium(scene, settings=settings(known), accuracy=1e-11, every=known.branches > 3)
    if found.solutions is not None:
        assert len(found.solutions) == known.branches
        found = min(found.solutions, key=lambda one: float(np.linalg.norm(np.subtract(one.tip["position"], known.tip))))
    length = found.solution.length
    assert found.tip["position"] == pytest.approx(known.tip, abs=1e-10 * length)
    assert found.eigenvalues[0][0] == pytest.approx(known.growth, rel=1e-8)
    assert found.stable == (known.growth < 0)
    assert found.residual < 1e-12


@pytest.mark.parametrize(("load", "rests"), [(1.0, 1), (3.0, 3), pytest.param(16.0, 5, marks=pytest.mark.slow)])
def test_all_rests_of_a_column_are_found(load: float, rests: int) -> None:
    """The straight one, and a pair of mirror images for each load of buckling that is passed."""
    found = equilibrium(column(load), every=True)
    assert found.solutions is not None
    assert len(found.solutions) == rests
    assert found.stable == (rests == 1)
    stable = [one for one in found.solutions if one.stable]
    assert len(stable) == min(rests, 2)
    assert sum(one.tip["position"][1] for one in found.solutions) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.slow
def test_the_rest_is_where_a_long_run_ends(examples: Path) -> None:
    """The same place, by two ways that have nothing in common but the rod."""
    scene = (examples / "elastica.toml").read_text()
    found = equilibrium(scene, accuracy=1e-9)
    end = run(scene, settings=["run.until=2.0", "run.frames=2", "run.accuracy=1e-7"])
    assert found.tip["position"] == pytest.approx(end.tip["position"], abs=2e-7)
    assert found.energy["end"] == pytest.approx(end.energy["end"], rel=1e-6)


def test_the_estimated_error_covers_the_true_one(examples: Path) -> None:
    """At a loose accuracy, against the same state on a mesh that is as fine as it gets."""
    scene = examples / "hanging.toml"
    exact = equilibrium(scene, accuracy=1e-12).tip["position"]
    for accuracy in (1e-3, 1e-5, 1e-7):
        found = equilibrium(scene, accuracy=accuracy)
        error = float(np.linalg.norm(np.subtract(found.tip["position"], exact))) / found.solution.length
        assert error <= found.error["estimated"] <= accuracy


def test_a_rod_that_sinks_or_is_spun_rests_in_its_own_frame(examples: Path) -> None:
    """Its turn does not change; the twist is that of a rigid motion."""
    found = equilibrium(examples / "sinking.toml")
    falls = found.solution.twist[0]
    assert np.linalg.norm(falls) > 1.0
    assert np.abs(falls[:, 2] - falls[0, 2]).max() < 1e-9 * np.abs(falls).max()


def test_motions_that_nothing_resists_are_counted(examples: Path) -> None:
    """A trap does not care how the rod is turned about it: three rotations."""
    found = equilibrium(examples / "trapped.toml", accuracy=1e-6)
    assert (found.stable, found.neutral) == (True, 3)


def test_a_ring_rests_closed(examples: Path) -> None:
    """Its ends meet to round-off."""
    found = equilibrium(examples / "stability" / "ring.toml")
    first, last = found.solution.position[0, 0], found.solution.position[0, -1]
    assert np.linalg.norm(last - first) < 1e-12
    assert np.ptp(found.solution.position[0, :, 1]) > 0.3


def test_further_rests_are_as_exact_as_the_first() -> None:
    """The straight state settles on coarse meshes, the buckled ones do not: each is refined by itself."""
    found = equilibrium(column(6.0), every=True)
    tip = next(known.tip for known in KNOWN if known.settings == {"load": 6.0})
    bent = max(found.solutions or (), key=lambda one: one.tip["position"][1])
    assert bent.tip["position"] == pytest.approx(tip, abs=1e-6)
    assert 1e-12 < bent.error["estimated"] < 1e-6


def test_states_that_differ_by_whole_turns_are_two() -> None:
    """A straight rod that is twisted by a turn lies as one that is not."""
    rod = {"motion": "spatial", "length": 1.0, "stiffness": [40.0, 16.0, 16.0, 0.8, 1.0, 1.0]}
    clamps = {"left": {"kind": "clamped"}, "right": {"kind": "clamped"}}
    standing = []
    for turns in (0, 1):
        twisted = {"strain": [1.0, 0.0, 0.0, f"{turns}*2*pi", 0.0, 0.0]}
        scene = {"rod": {**rod, "friction": [1.0] * 6}, "ends": clamps, "start": twisted, "run": {"until": 1.0}}
        standing.append(stand(load_scene(scene), (1, 8), kernel_text))
    one, other = (rod.system.x for rod in standing)
    assert standing[0].same(one, one)
    assert not standing[0].same(one, other)


def test_frictions_do_not_move_the_rest() -> None:
    """Even without friction of rotations."""
    tips = []
    for friction in ([1.0, 2.0, 0.02], [7.0, 0.3, 5.0], [1.0, 2.0, 0.0]):
        bent = column(1.0, start={"strain": ["1", "0", "0.1"]})
        bent["rod"]["friction"] = friction
        bent["ends"]["right"]["force"] = [-2.0, -1.0]
        tips.append(equilibrium(bent, accuracy=1e-10).tip["position"])
    assert tips[1] == pytest.approx(tips[0], abs=1e-12)
    assert tips[2] == pytest.approx(tips[0], abs=1e-12)


def test_files_are_written_and_read_back(tmp_path: Path) -> None:
    """The state as a solution of one frame, the picture, and the fields."""
    found = equilibrium(column(3.0), tmp_path / "out", every=True)
    assert load(tmp_path / "out" / "equilibrium.nc") == found.solution
    fields = json.loads((tmp_path / "out" / "equilibrium.json").read_text())
    assert fields["stable"] is False
    assert len(fields["solutions"]) == 3
    assert (tmp_path / "out" / "equilibrium.png").stat().st_size > 10_000
    with pytest.raises(InputError, match=r"--out: expected none of these files"):
        equilibrium(column(3.0), tmp_path / "out")


REFUSED: list[tuple[dict[str, Any], str]] = [
    (column(1.0, effects=[{"kind": "follower", "force": ["sin(t)", 0]}]), r"t: expected a scene that does not vary"),
    (
        column(1.0, ends={"left": {"kind": "driven", "twist": [0, 0, 1]}, "right": {"kind": "clamped"}}),
        r"ends: expected a driven end opposite to a free one",
    ),
    (
        column(
            1.0,
            ends={"left": {"kind": "driven", "twist": [0, 0, 1]}, "right": {"kind": "free"}},
            effects=[{"kind": "weight", "force": [0, -1]}],
        ),
        r"ends: expected a driven end in a scene that looks the same from it",
    ),
]


@pytest.mark.parametrize(("scene", "words"), REFUSED, ids=["timed", "driven and held", "driven in the world"])
def test_scenes_that_cannot_rest_are_refused(scene: dict[str, Any], words: str) -> None:
    """With what was expected and what to do."""
    with pytest.raises(InputError, match=words):
        equilibrium(scene)


def test_a_rod_without_rest_is_not_reached(tmp_path: Path) -> None:
    """A straight rod in shear flow tumbles: each way says what it met, the program ends with 3 and leaves no folder."""
    flow = {"kind": "flow", "gradient": [[0, 1], [0, 0]], "velocity": [0, 0]}
    ends = {"left": {"kind": "free"}, "right": {"kind": "free"}}
    tumbling = column(1.0, ends=ends, effects=[flow], run={"until": 1.0, "elements": 1, "degree": 4})
    with pytest.raises(NotReached, match="at once: "):
        equilibrium(tumbling, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_the_program_prints_the_fields_or_the_state(examples: Path, tmp_path: Path) -> None:
    """One JSON object, or lines for people; 2 for wrong input."""
    scene = str(examples / "elastica.toml")
    done = CliRunner().invoke(main, ["equilibrium", scene, "--json"])
    assert done.exit_code == 0
    fields = json.loads(done.stdout)
    assert {"tip", "base", "residual", "stable", "eigenvalues", "energy", "error", "files"} <= set(fields)
    told = CliRunner().invoke(main, ["equilibrium", scene])
    assert "stable; leading rate" in told.stdout
    assert CliRunner().invoke(main, ["equilibrium", str(tmp_path / "none.toml")]).exit_code == 2


def test_what_is_returned_has_the_fields_as_attributes() -> None:
    """And says so where one is not there."""
    found: Equilibrium = equilibrium(column(1.0))
    assert found.tip == found.fields["tip"]
    with pytest.raises(AttributeError, match="no field 'colour'"):
        _ = found.colour
