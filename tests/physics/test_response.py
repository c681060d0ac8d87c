"""Small harmonic motions: complex amplitudes of whatever shakes a rod at its ends or along it, and their power."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from geocosserat.results.solution import Solution
from tests.marks import slow
from tests.physics.scenes import Array, Complex, Scene, changed, gap, simulate, straight
from tests.references import linear_rod
from tests.references.linear_rod import End

LENGTH = 1.3
ROD = linear_rod.Rod(LENGTH, 60.0, 0.8, 1.7, 0.05)
FREQUENCY = 9.0
PERIOD = 2.0 * np.pi / FREQUENCY
SIZE = 1e-5
"""What is not linear is of the square of it, or the third power, relative to it."""


def _shaken(left: Any, right: Any, **changes: Any) -> Scene:
    """The rod, softer in stretch than anything here asks, for twenty periods."""
    scene = straight([90.0, ROD.k2, ROD.k3], [1.0, ROD.friction2, ROD.friction3], length=LENGTH)
    return changed(scene, {"ends.left": left, "ends.right": right, "run.until": 20.0 * PERIOD} | changes)


def _solution(scene: Scene) -> Solution:
    """Frames of the last two periods, 16 in each: by then what was in the beginning is gone."""
    return simulate(scene, 1, 12, 1e-9, backend="auto", atol=1e-15, frames=20 * 16 + 1).solution


def _amplitude(time: Array, values: Array) -> Complex:
    """The complex amplitude of each column over the last two periods; a mean and a second harmonic are let go."""
    last = slice(-32, None)
    phase = FREQUENCY * time[last]
    columns = [np.cos(phase), -np.sin(phase), np.ones(32), np.cos(2 * phase), np.sin(2 * phase)]
    found = np.linalg.lstsq(np.stack(columns, axis=1), values[last], rcond=None)[0]
    return np.asarray(found[0] + 1j * found[1])


def _check(scene: Scene, left: End, right: End, rod: linear_rod.Rod = ROD, **profiles: Any) -> None:
    """Displacement and angle at the nodes, forces and moments at the points, relative to the largest of each."""
    solution = _solution(scene)
    at_nodes = linear_rod.response(rod, FREQUENCY, left, right, solution.u, **profiles)
    at_points = linear_rod.response(rod, FREQUENCY, left, right, solution.u_point, **profiles)
    assert solution.angle is not None
    pairs = [
        (solution.position[..., 1], at_nodes.displacement),
        (solution.angle, at_nodes.angle),
        (solution.stress[..., 1], at_points.force),
        (solution.stress[..., 2], at_points.moment),
    ]
    for values, expected in pairs:
        found = _amplitude(solution.time, values) / SIZE
        assert gap(found, expected) < 1e-6 * np.abs(expected).max()


CLAMPED, FREE, PINNED = ({"kind": kind} for kind in ("clamped", "free", "pinned"))
WAVE = "1e-5*cos(9*t)"


def _driven(turning: bool) -> dict[str, Any]:
    """The twist is a cosine, so that the place it makes has no mean."""
    return {"kind": "driven", "twist": ["0", WAVE, "1e-5*sin(9*t)" if turning else "0"]}


DRIVEN = linear_rod.driven(1.0, -1j, FREQUENCY)


@pytest.mark.parametrize(
    ("left", "right", "ends"),
    [
        (_driven(True), FREE, (DRIVEN, End("free"))),
        slow(FREE, _driven(True), (End("free"), DRIVEN)),
        slow(_driven(True), PINNED, (DRIVEN, End("pinned"))),
        (CLAMPED, _driven(False), (End("clamped"), linear_rod.driven(1.0, 0.0, FREQUENCY))),
        (_driven(True), _driven(False), (DRIVEN, linear_rod.driven(1.0, 0.0, FREQUENCY))),
    ],
    ids=["driven-free", "free-driven", "driven-pinned", "clamped-driven", "driven-driven"],
)
def test_an_end_that_is_driven_moves_the_rod_as_the_linear_theory_says(
    left: dict[str, Any], right: dict[str, Any], ends: tuple[End, End]
) -> None:
    """Shaken across and turned a quarter of a period later: six digits of amplitude and phase, everywhere."""
    _check(_shaken(left, right), *ends)


LOAD = {"force": ["0", WAVE], "torque": "2e-5*sin(9*t)"}


@pytest.mark.parametrize(
    ("left", "right", "ends"),
    [
        slow(FREE | LOAD, CLAMPED, (End("free", force=1.0, torque=-2j), End("clamped"))),
        (CLAMPED, FREE | LOAD | {"frame": "world"}, (End("clamped"), End("free", force=1.0, torque=-2j))),
        slow(FREE | LOAD, FREE, (End("free", force=1.0, torque=-2j), End("free"))),
        (PINNED | {"torque": WAVE}, CLAMPED, (End("pinned", torque=1.0), End("clamped"))),
        (CLAMPED, PINNED | {"torque": WAVE}, (End("clamped"), End("pinned", torque=1.0))),
        (PINNED, PINNED | {"torque": WAVE, "frame": "world"}, (End("pinned"), End("pinned", torque=1.0))),
    ],
    ids=["free-clamped", "clamped-free", "free-free", "pinned-clamped", "clamped-pinned", "pinned-pinned"],
)
def test_loads_on_either_end_move_the_rod_as_the_linear_theory_says(
    left: dict[str, Any], right: dict[str, Any], ends: tuple[End, End]
) -> None:
    """Force and torque on free ends, torque on pinned ones."""
    _check(_shaken(left, right), *ends)


def _bulge(u: Array) -> Array:
    return 1.0 + u**2


@pytest.mark.parametrize(
    ("effect", "profiles"),
    [
        ({"kind": "follower", "force": ["0", f"{WAVE}*(1 + u**2)"]}, {"force": _bulge}),
        slow({"kind": "weight", "force": ["0", f"{WAVE}*(1 + u**2)"]}, {"force": _bulge}),
        slow({"kind": "couple", "torque": f"{WAVE}*(1 + u**2)"}, {"couple": _bulge}),
        ({"kind": "field", "moment": ["1 + u**2", "0"], "field": ["0", WAVE]}, {"couple": _bulge}),
        ({"kind": "flow", "gradient": [0, 0], "velocity": ["0", WAVE]}, {"force": 1.7}),
        ({"kind": "flow", "gradient": [[0, 0], [WAVE, 0]], "velocity": [0, 0]},
         {"force": lambda u: 1.7 * u, "couple": 0.05 / 2}),
    ],
    ids=["follower", "weight", "couple", "field", "stream", "shear"],
)  # fmt: skip
def test_effects_move_the_rod_as_the_linear_theory_says(effect: dict[str, Any], profiles: dict[str, Any]) -> None:
    """Along a cantilever, growing towards its tip: what pushes across, what turns, what flows."""
    _check(_shaken(CLAMPED, FREE, effects=[effect]), End("clamped"), End("free"), **profiles)


def test_a_steady_field_stiffens_what_another_one_shakes() -> None:
    """Magnetised along itself, the field along the rod and a small one across."""
    rod = linear_rod.Rod(LENGTH, ROD.k2, ROD.k3, ROD.friction2, ROD.friction3, field=6.0)
    field = {"kind": "field", "moment": ["3", "0"], "field": ["2", WAVE]}
    _check(_shaken(PINNED, FREE, effects=[field]), End("pinned"), End("free"), rod, couple=3.0)


@pytest.mark.parametrize(("left", "kind"), [(FREE, "free"), slow(PINNED, "pinned"), slow(CLAMPED, "clamped")])
def test_a_travelling_wave_of_curvature_moves_the_rod_and_takes_the_power_it_must(
    left: dict[str, Any], kind: Any
) -> None:
    """A muscle: the amplitudes, and the work of the last period in the ledger, which friction takes, to six digits."""
    wave = f"{SIZE!r}*cos(9*t - 2*pi*u/1.3)"
    scene = _shaken(left, FREE, **{"rod.reference": ["1", "0", wave]})

    def curvature(u: Array) -> Complex:
        return np.exp(-2j * np.pi * u / LENGTH)

    _check(scene, End(kind), End("free"), curvature=curvature)
    solution = _solution(scene)
    x, weight = np.polynomial.legendre.leggauss(40)
    u = 0.5 * LENGTH * (1.0 + x)
    moment = linear_rod.response(ROD, FREQUENCY, End(kind), End("free"), u, curvature=curvature).moment
    # the energy is that of Pi - Pi0, so what changes Pi0 does the work -M per change
    mean = -0.5 * np.sum(0.5 * LENGTH * weight * moment * np.conj(1j * FREQUENCY * curvature(u))).real
    for series in (solution.work, solution.dissipated):
        assert gap((series[-1] - series[-17]) / (SIZE**2 * mean * PERIOD), 1.0) < 1e-6
