"""How fast small disturbances fade: for each end, each limit, in a field, round a ring, and of a rod that is spun."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tests.marks import slow
from tests.physics.scenes import Complex, Scene, changed, farthest, gap, growths, simulate, straight
from tests.references import axial_twist, euler_bernoulli, linear_rod, ring, whirl

LENGTH = 1.3
K2, K3, FRICTION2, FRICTION3 = 400.0, 0.8, 1.7, 0.02
ENDS = [
    ("clamped", "free"), ("free", "clamped"), ("free", "free"), ("clamped", "clamped"), ("pinned", "pinned"),
    ("clamped", "pinned"), ("pinned", "clamped"), ("pinned", "free"), ("free", "pinned"),
]  # fmt: skip
STIFFNESS, FRICTION = [70.0, 50.0, 40.0, 0.9, 1.2, 1.0], [1.5, 2.0, 1.8, 0.03, 0.006, 0.008]


def _decays(scene: Scene, degree: int, elements: int = 1) -> Complex:
    """Decay rates; the imaginary parts, which must vanish, count as errors of theirs."""
    return np.asarray(-growths(scene, elements, degree))


def _bending(ends: tuple[str, str], friction3: float, **changes: Any) -> Scene:
    scene = straight([1e4, K2, K3], [1.0, FRICTION2, friction3], *ends, length=LENGTH)
    return changed(scene, {path.replace("__", "."): value for path, value in changes.items()})


@pytest.mark.parametrize("ends", ENDS, ids="-".join)
@pytest.mark.parametrize("frozen", [[], ["h1"]], ids=["full", "inextensible"])
def test_bending_fades_at_the_rates_of_the_linear_theory_whatever_holds_the_ends(
    ends: tuple[Any, Any], frozen: list[str]
) -> None:
    """Finite k2 and friction3: five modes; the same if the rod cannot stretch."""
    expected = linear_rod.decay_rates(linear_rod.Rod(LENGTH, K2, K3, FRICTION2, FRICTION3), *ends, 7)
    found = _decays(_bending(ends, FRICTION3, rod__frozen=frozen), 22)
    assert farthest(expected[expected > 0.0][:5], found) < 1e-8


@pytest.mark.parametrize("ends", ENDS, ids="-".join)
def test_frozen_stretch_and_shear_leave_the_rates_of_euler_and_bernoulli(ends: tuple[Any, Any]) -> None:
    """With friction of the rotation; five modes."""
    expected = euler_bernoulli.decay_rates(LENGTH, K3, FRICTION2, FRICTION3, _named(ends), 5)
    found = _decays(_bending(ends, FRICTION3, rod__frozen=["h1", "h2"]), 22)
    assert farthest(expected, found) < 1e-8


@pytest.mark.parametrize("ends", ENDS, ids="-".join)
def test_the_same_without_friction_of_the_rotation(ends: tuple[Any, Any]) -> None:
    """Three modes, to three digits: what is left of the friction, 1e-10, costs the Jacobian's sums ten of them."""
    expected = euler_bernoulli.decay_rates(LENGTH, K3, FRICTION2, 0, _named(ends), 3)
    assert farthest(expected, _decays(_bending(ends, 0, rod__frozen=["h1", "h2"]), 14)) < 1e-3


@pytest.mark.parametrize("ends", [("clamped", "free"), ("free", "free"), ("clamped", "clamped")], ids="-".join)
def test_frozen_shear_alone_leaves_the_rates_of_euler_and_bernoulli_beside_those_of_the_heat_equation(
    ends: tuple[Any, Any],
) -> None:
    """A straight rod bends as if it could not stretch, and stretches as if it could not bend; four modes of each."""
    found = _decays(changed(_bending(ends, FRICTION3), {"rod.stiffness": [90.0, 1.0, K3], "rod.frozen": ["h2"]}), 22)
    bending = euler_bernoulli.decay_rates(LENGTH, K3, FRICTION2, FRICTION3, _named(ends), 4)
    assert farthest(bending, found) < 1e-8
    if "free" in ends:
        stretching = axial_twist.decay_rates(90.0, 1.0, LENGTH, 4, "-".join(ends))  # type: ignore[arg-type]
        assert farthest(stretching, found) < 1e-8


def _named(ends: tuple[Any, Any]) -> Any:
    return "-".join(sorted(ends, key=["clamped", "pinned", "free"].index))


@pytest.mark.parametrize(
    ("ends", "bend"),
    [
        (("clamped", "free"), "1"),
        slow(("free", "free"), "u*(1.3 - u)"),
        slow(("free", "pinned"), "u"),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, tuple) else "",
)
@pytest.mark.parametrize("frozen", [[], ["h1", "h2"]], ids=["full", "frozen"])
def test_without_friction_of_the_rotation_the_slowest_mode_fades_as_it_must(
    ends: tuple[Any, Any], bend: str, frozen: list[str]
) -> None:
    """In a run, once all others are gone: with a finite k2, and Euler's and Bernoulli's of the tables; seven digits.

    Not between ends that are held: to become straight there, a bent rod would have to become shorter.
    """
    expected = linear_rod.decay_rates(linear_rod.Rod(LENGTH, math.inf if frozen else K2, K3, FRICTION2, 0), *ends, 4)
    first, second = expected[expected > 0.0][:2]
    if frozen:
        table = euler_bernoulli.decay_rates(LENGTH, K3, FRICTION2, 0, _named(ends), 2)
        np.testing.assert_allclose([first, second], table, rtol=1e-12)
    # the second mode fades by e^-25 against the first before the measurement, in which the first loses e^-2 or more
    begin = 25.0 / (second - first)
    frames = 1 + math.ceil(2.0 / (first * begin))
    scene = _bending(ends, 0, rod__frozen=frozen, start__strain=["1", "0", f"1e-4*{bend}"])
    scene = changed(scene, {"run.until": begin * frames})
    energy = simulate(scene, 1, 14, 1e-11, backend="auto", atol=1e-16, frames=frames + 1).solution.energy
    rate = np.log(energy[1] / energy[-1]) / (2.0 * begin * (frames - 1))
    assert gap(rate / first, 1.0) < 1e-7


@pytest.mark.parametrize("ends", [("clamped", "free"), ("pinned", "free"), ("free", "free"), ("pinned", "pinned")])
def test_a_field_along_the_rod_holds_it_straight(ends: tuple[Any, Any]) -> None:
    """The magnetised rod as the linear theory has it; one that nothing else holds turns into the field."""
    field = {"kind": "field", "moment": [3.0, 0.0], "field": [2.0, 0.0]}
    rod = linear_rod.Rod(LENGTH, K2, K3, FRICTION2, FRICTION3, field=6.0)
    expected = linear_rod.decay_rates(rod, *ends, 6)
    found = _decays(_bending(ends, FRICTION3, effects=[field]), 22)
    assert farthest(expected[expected > 0.0][:5], found) < 1e-8


@pytest.mark.parametrize("component", [0, 3])
def test_all_modes_but_one_frozen_leave_pure_stretch_or_pure_twist(component: int) -> None:
    """The heat equation of the one mode, clamped and free, free and free, joined to a ring only for the twist."""
    names = ["h1", "h2", "h3", "Pi1", "Pi2", "Pi3"]
    frozen = {"rod.frozen": [name for i, name in enumerate(names) if i != component]}
    for ends in ("clamped-free", "free-free"):
        expected = axial_twist.decay_rates(STIFFNESS[component], FRICTION[component], LENGTH, 5, ends)
        scene = changed(straight(STIFFNESS, FRICTION, *ends.split("-"), length=LENGTH), frozen)
        assert farthest(expected, _decays(scene, 18)) < 1e-8


RING = ring.Ring(LENGTH, (90.0, 60.0, 0.8), (1.0, 1.7, 0.02))


def _round(**changes: Any) -> Scene:
    scene = straight(list(RING.stiffness), list(RING.friction), length=LENGTH)
    scene["ends"] = {"joined": True}
    return changed(scene, {"rod.reference": [1.0, 0.0, "2*pi/1.3"]} | changes)


@pytest.mark.parametrize("motion", ["planar", "spatial"])
def test_a_ring_fades_at_the_rates_of_its_fourier_modes(motion: str) -> None:
    """Breathing, tilting, shifting, bending with up to three waves; also of a ring in space, within its plane."""
    scene = _round()
    if motion == "spatial":
        scene = straight([90.0, 60.0, 50.0, 0.7, 0.9, 0.8], [1.0, 1.7, 1.5, 0.01, 0.03, 0.02], length=LENGTH)
        scene["ends"], scene["rod"]["reference"] = {"joined": True}, [1.0, 0.0, 0.0, 0.0, 0.0, "2*pi/1.3"]
    expected = np.concatenate([ring.decay_rates(RING, n) for n in range(4)])
    assert farthest(expected, _decays(scene, 14, elements=2)) < 1e-8


def test_a_ring_that_neither_stretches_nor_shears_fades_at_the_rates_of_its_limit() -> None:
    """Two, three and four waves, the slowest modes."""
    found = _decays(_round(**{"rod.frozen": ["h1", "h2"]}), 14, elements=3)
    assert farthest([ring.inextensible_rate(RING, n) for n in (2, 3, 4)], found) < 1e-8


@pytest.mark.parametrize("share", [0.6, 1.3])
def test_a_spun_rod_is_disturbed_as_the_theory_of_whirling_says(share: float) -> None:
    """Below and above the threshold: six growths, complex, in the frame that turns with the base."""
    rod = whirl.Rod(LENGTH, K2, K3, FRICTION2, 0.03, 0.01, 1.0)
    rod = whirl.Rod(LENGTH, K2, K3, FRICTION2, 0.03, 0.01, share * whirl.threshold(rod)[0])
    scene = straight([1e4, K2, K2, 0.3, K3, K3], [1.0, FRICTION2, FRICTION2, 0.03, 0.01, 0.01], length=LENGTH)
    slope = 0.03 * rod.spin / 0.3
    scene = changed(
        scene,
        {
            "ends.left": {"kind": "driven", "twist": [0.0, 0.0, 0.0, rod.spin, 0.0, 0.0]},
            "start.strain": ["1", "0", "0", f"-{slope!r}*(1.3 - u)", "0", "0"],
        },
    )
    expected = whirl.growths(rod, 6)
    assert (expected[0].real > 0.0) == (share > 1.0)
    assert farthest(expected - 1j * rod.spin, growths(scene, 2, 22)) < 1e-7
