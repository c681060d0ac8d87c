"""Growth rates, and where rods buckle, flutter and whirl: against determinants, and against runs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from geocosserat.cli import main
from geocosserat.conductor.equilibrium import NotReached
from geocosserat.conductor.kernels import kernel_text
from geocosserat.conductor.scene import load_any
from geocosserat.conductor.stability import Found, stability
from geocosserat.conductor.standing import stand
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.contract import Array
from geocosserat.kernel.load import load
from geocosserat.model.errors import InputError
from geocosserat.solver.integrate import integrate
from geocosserat.statics.newton import newton
from tests.references.stability import equilibria, table
from tests.references.stability.table import Value, all_values

VALUES = all_values()
QUICK = {"column_dead", "odd"}
# from the start that its scene has, Newton's method leads to a state beside the one that lost its stability
LEFT = {"ring_held"}


def cases(quick: set[str]) -> list[Any]:
    return [pytest.param(v, id=v.scene, marks=[] if v.scene in quick else pytest.mark.slow) for v in VALUES]


def scene_of(examples: Path, entry: Value) -> Path:
    return examples / "stability" / f"{entry.scene}.toml"


def folded(growth: complex) -> complex:
    """A rate with the frequency counted positive."""
    return complex(growth.real, abs(growth.imag))


@pytest.mark.parametrize("entry", cases(QUICK | {"heavy", "column_pinned", "twist_limit", "whirl_limit", "ring_held"}))
def test_growth_rates_are_those_of_the_determinant(entry: Value, examples: Path) -> None:
    """The leading one to eight digits before and after the loss, and as many others beside it as belong to it."""
    for value, expected in entry.growths[: 1 if entry.scene in LEFT else 2]:
        found = stability(scene_of(examples, entry), settings=[f"{entry.over}={value!r}"])
        rates = [complex(*pair) for pair in found.eigenvalues if pair[1] >= 0 or not expected.imag]
        moving = [g for g in rates if abs(g) > 1e-4 * abs(expected)]
        near = 1e-8 * abs(expected)
        for leading in moving[: entry.multiplicity if not complex(expected).imag else 1]:
            assert abs(folded(leading) - folded(complex(expected))) < near
        assert found.stable == (complex(expected).real < 0)
        assert found.neutral == entry.zeros


@pytest.mark.parametrize("entry", cases(QUICK))
def test_the_loss_of_stability_is_where_the_determinant_has_it(entry: Value, examples: Path) -> None:
    """Value and frequency to eight digits, its kind, and an error that is told and true."""
    low, high = entry.interval
    found = stability(scene_of(examples, entry), over=f"{entry.over}={low}:{high}")
    critical = found.critical
    assert critical["kind"] == entry.kind
    assert critical["value"] == pytest.approx(entry.value, rel=1e-8)
    assert (critical["frequency"] or 0.0) == pytest.approx(entry.frequency, rel=1e-8)
    assert critical["lost"]
    assert abs(critical["value"] - entry.value) < 10 * critical["error"] + 1e-11 * entry.value


def test_both_buckled_branches_are_followed(examples: Path) -> None:
    """They leave where the column buckles, and their tips are those of the elliptic integrals."""
    found = stability(examples / "stability" / "column_dead.toml", over="load=2:3.5")
    straight, *sides = found.record.followed.branches
    assert straight[-1].tip[1] == pytest.approx(0.0, abs=1e-12)
    assert len(sides) == 2
    tip, _ = equilibria.column(3.5)
    for side, sign in zip(sorted(sides, key=lambda branch: -branch[-1].tip[1]), (1, -1), strict=True):
        assert side[0].value == pytest.approx(found.critical["value"], rel=1e-6)
        assert side[-1].value == pytest.approx(3.5, abs=1e-9)
        assert side[-1].tip == pytest.approx((tip.x, sign * tip.y), abs=1e-6)
        assert side[-1].growth < 0
    assert all(point.growth > 0 for point in straight if point.value > found.critical["value"] * (1 + 1e-6))


def bent(**rod: Any) -> dict[str, Any]:
    """A clamped rod that a load bends."""
    plain = {"motion": "planar", "length": 1.0, "stiffness": [40.0, 16.0, 1.0], "friction": [1.0, 2.0, 0.02]}
    load = {"kind": "free", "force": [0.0, -2.0], "frame": "world"}
    return {"rod": {**plain, **rod}, "ends": {"left": {"kind": "clamped"}, "right": load}, "run": {"until": 1.0}}


@pytest.mark.parametrize(
    ("scene", "key", "last"),
    [(bent(), "rod.length", 2.0), (bent(frozen=["h1", "h2"]), "rod.stiffness.2", 3.0)],
    ids=["length", "frozen"],
)
def test_the_end_of_a_path_is_what_is_found_there_at_once(scene: dict[str, Any], key: str, last: float) -> None:
    """Whatever natural sizes the value changes."""
    followed = stability(scene, over=f"{key}=1:{last}").record.followed.branches[0][-1]
    alone = stability(scene, settings=[f"{key}={last}"])
    assert followed.value == last
    assert followed.growth == pytest.approx(alone.eigenvalues[0][0], rel=1e-4)
    assert followed.tip == pytest.approx(alone.tip["position"], abs=1e-4 * last)


def test_later_losses_are_found_too() -> None:
    """The second load of the column is that of a third of its length, as a divergence; but nothing is lost there that
    was there."""
    scene = {
        "parameters": {"load": 1.0},
        "rod": {"motion": "planar", "length": 1.0, "stiffness": [40.0, 16.0, 1.0], "friction": [1.0, 2.0, 0.02]},
        "ends": {"left": {"kind": "clamped"}, "right": {"kind": "free", "force": ["-load", 0.0], "frame": "world"}},
        "run": {"until": 1.0},
    }
    found = stability(scene, over=f"load=12:{1.1 * equilibria.second_load()}")
    assert found.critical is None
    (only,) = found.crossings
    assert only["value"] == pytest.approx(equilibria.second_load(), rel=1e-8)
    assert found.record.modes.unstable == 1


def grown(examples: Path, name: str, key: str, value: float) -> tuple[complex, complex]:
    """The leading rate, and the one that a run shows: a thousandth of the motion is added to the rest,
    and how it has grown after a while is measured with the left vector that sees no other motion."""
    scene = load_any(examples / "stability" / f"{name}.toml", [f"{key}={value!r}", "run.until=1"])
    standing = stand(scene, (2, 16), kernel_text)
    rest = newton(standing.system, standing.system.x)
    rates, motions = standing.spectrum(rest.linear, rest.x)
    rod = discretise(scene, 2, 16)
    kernel = load(kernel_text(rod.structure), rod, "numpy")
    n = len(standing.system.kept)
    own = rod.state.copy()
    own[:n] = standing.system.state(rest.x)[:n]
    J = kernel.jacobian(0.0, own)[:n, :n]
    left_rates, left = np.linalg.eig(J.T)
    seen = left[:, np.abs(left_rates - rates[0]).argmin()]
    start = own.copy()
    start[:n] += 1e-3 * standing.system.scale * motions[:, 0].real
    times = np.array([0.0, 1.0 / abs(rates[0])])
    atol: Array = np.full(len(own), 1e-10)
    ran = integrate(kernel, start, times, "radau", 1e-7, atol, lambda *_: None, lambda *_: None, ())
    first, last = (seen @ (state - own)[:n] for state in ran.states)
    return complex(rates[0]), np.log(last / first) / times[1]


RUNS = [
    ("column_dead", "load", 2.0),
    ("column_dead", "load", 2.5),
    ("follower_tip", "load", 30.0),
    ("heavy", "weight", 8.0),
    ("odd", "a", 14.0),
    ("whirl", "spin", 290.0),
]


@pytest.mark.parametrize(("name", "key", "value"), RUNS, ids=[f"{run[0]}-{run[2]:g}" for run in RUNS])
def test_runs_grow_at_the_rate_that_is_told(name: str, key: str, value: float, examples: Path) -> None:
    """Nonlinear runs from beside the rest, to five digits: the rest of it is nonlinear."""
    told, shown = grown(examples, name, key, value)
    assert abs(shown - told) < 1e-5 * abs(told)


@pytest.mark.parametrize("name", ["column_dead", "follower_tip"])
def test_large_rods_have_the_same_rates(name: str, examples: Path) -> None:
    """Those of thousands of unknowns are found without their matrices, by the kernel's elimination."""
    entry = table.value(name)
    value, expected = entry.growths[1]
    found = stability(
        scene_of(examples, entry), settings=[f"{entry.over}={value!r}", "run.elements=150", "run.degree=4"]
    )
    assert found.unknowns == 1800
    assert abs(folded(complex(*found.eigenvalues[0])) - expected) < 1e-6 * abs(expected)
    assert found.residual < 1e-12


def test_rates_do_not_depend_on_the_frame() -> None:
    """A rod that is turned as a whole, with its load, has the same rates."""
    found = []
    for angle in (0.0, 1.1):
        c, s = np.cos(angle), np.sin(angle)
        scene = {
            "rod": {"motion": "planar", "length": 1.0, "stiffness": [40.0, 16.0, 1.0], "friction": [1.0, 2.0, 0.02]},
            "start": {"angle": angle},
            "ends": {
                "left": {"kind": "clamped"},
                "right": {"kind": "free", "force": [float(-2 * c + s), float(-2 * s - c)], "frame": "world"},
            },
            "run": {"until": 1.0},
        }
        found.append(np.array(stability(scene).eigenvalues))
    assert found[1] == pytest.approx(found[0], rel=1e-9)


def test_rates_of_a_passive_rod_are_real_and_those_of_an_odd_one_are_not(examples: Path) -> None:
    """Drag as the metric makes the linear rod symmetric unless something feeds it."""
    passive = stability(examples / "elastica.toml")
    assert all(abs(imaginary) < 1e-9 * abs(real) for real, imaginary in passive.eigenvalues)
    odd = stability(examples / "stability" / "odd.toml", settings=["a=14.0"])
    assert odd.eigenvalues[0][1] > 1.0


@pytest.mark.slow
def test_a_map_has_the_line_where_the_column_buckles() -> None:
    """Over load and stretch: the signs are those of the closed form everywhere."""
    scene = {
        "parameters": {"load": 1.0, "shear": 16.0},
        "rod": {"motion": "planar", "length": 1.0, "stiffness": [40.0, "shear", 1.0], "friction": [1.0, 2.0, 0.02]},
        "ends": {"left": {"kind": "clamped"}, "right": {"kind": "free", "force": ["-load", 0.0], "frame": "world"}},
        "run": {"until": 1.0, "elements": 1, "degree": 8},
    }
    found = stability(scene, over=["load=1:4", "shear=4:40"])
    loads, shears = (np.array(values) for values in found.map["values"])
    growth = np.array(found.map["growth"], dtype=float)
    # Haringx: P (1 - P / k1 + P / k2) = (pi / 2)^2 k3 / L^2, with both stiffnesses
    buckled = loads * (1 - loads / 40.0 + loads / shears[:, None]) > (np.pi / 2) ** 2
    assert ((growth > 0) == buckled).all()


def test_where_nothing_is_lost_it_says_so(examples: Path) -> None:
    """No critical value, and no crossing."""
    found = stability(examples / "stability" / "column_dead.toml", over="load=0.5:1")
    assert found.critical is None
    assert found.crossings == []
    assert found.reason == ""


WRONG = [
    ({"over": "load"}, r"--over: expected KEY=A:B"),
    ({"over": "load=1:1"}, r"--over: expected KEY=A:B with two numbers that differ"),
    ({"over": "load=1:inf"}, r"--over: expected KEY=A:B"),
    ({"over": "laod=1:2"}, r"laod.*load"),
    ({"over": ["load=1:2", "load=2:3"]}, r"--over: expected one key, or two different ones"),
    ({"over": "run.until=1:2"}, r"--over: expected a value of the rod"),
    ({"over": "rod.length=1:-1"}, r"rod\.length: expected"),
    ({"count": 0}, r"--count: expected at least 1 growth rate"),
]


@pytest.mark.parametrize(("options", "words"), WRONG)
def test_wrong_options_are_refused_before_anything_is_computed(
    options: dict[str, Any], words: str, examples: Path, tmp_path: Path
) -> None:
    """With what was expected; no folder is left."""
    with pytest.raises(InputError, match=words):
        stability(examples / "stability" / "column_dead.toml", tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()


def test_a_scene_without_rest_has_no_stability() -> None:
    """A rod that tumbles for ever."""
    scene = {
        "rod": {"motion": "planar", "length": 1.0, "stiffness": [40.0, 16.0, 1.0], "friction": [1.0, 2.0, 0.02]},
        "ends": {"left": {"kind": "free"}, "right": {"kind": "free"}},
        "effects": [{"kind": "flow", "gradient": [[0, 1], [0, 0]], "velocity": [0, 0]}],
        "run": {"until": 1.0, "elements": 1, "degree": 4},
    }
    with pytest.raises(NotReached, match="at once: "):
        stability(scene)


def test_the_program_tells_the_critical_value(examples: Path, tmp_path: Path) -> None:
    """As JSON, as lines, and as pictures."""
    scene, out = str(examples / "stability" / "follower_tip_limit.toml"), tmp_path / "out"
    done = CliRunner().invoke(main, ["stability", scene, "--over", "load=30:45", "--json", "--out", str(out)])
    assert done.exit_code == 0, done.output
    fields = json.loads(done.stdout)
    assert fields["critical"]["kind"] == "flutter"
    assert json.loads((out / "stability.json").read_text())["critical"] == fields["critical"]
    assert {path.name for path in out.iterdir()} == {"stability.png", "stability.svg", "stability.json"}
    told = CliRunner().invoke(main, ["stability", scene, "--over", "load=30:40"])
    assert f"load = {table.value('follower_tip_limit').value:.9g}" in told.stdout.replace("\n", "")
    assert "flutter begins" in told.stdout
    again = CliRunner().invoke(main, ["stability", scene, "--out", str(out)])
    assert again.exit_code == 2


def test_what_is_returned_has_the_fields_as_attributes(examples: Path) -> None:
    """And says so where one is not there."""
    found: Found = stability(examples / "stability" / "column_dead.toml")
    assert found.stable is True
    with pytest.raises(AttributeError, match="no field 'colour'"):
        _ = found.colour
