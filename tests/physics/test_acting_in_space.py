"""Large motions under everything that can act, however the ends are held, in space and in the plane: against a rod
computed from positions and quaternions at Chebyshev points, where what acts is written out once more."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from geocosserat.effects import Effect, Expression, Key, Pair, Seen, Vector, dot, nothing, register
from geocosserat.model.effects import registry
from tests.physics.scenes import Array, Scene, changed, gap, simulate, straight
from tests.references import acted_rod
from tests.references.acted_rod import End, medium
from tests.references.moving_rod import Shape, Values, rotated

pytestmark = pytest.mark.slow

STIFFNESS, FRICTION = [60.0, 50.0, 40.0, 0.9, 1.2, 1.0], [1.5, 2.0, 1.8, 0.03, 0.02, 0.025]
REFERENCE = {"spatial": [1.0, 0.0, 0.0, 1.0, 0.3, 2.0], "planar": [1.0, 0.0, 0.0, 0.0, 0.0, 2.0]}
POSITION = {"spatial": [0.1, -0.2, 0.3], "planar": [0.1, -0.2, 0.0]}
ROTATION = {"spatial": [0.3, -0.5, 0.8], "planar": [0.0, 0.0, 0.8]}
DEGREE = 16
KEPT = [0, 1, 5]
"""Components of the plane among those of space."""
UNTIL = 0.15
GENTLY = "sin(10*t)**2"


def gently(t: float) -> float:
    """All that acts comes on gently: a jump would make layers at the ends that no polynomial resolves."""
    return float(np.sin(10.0 * t) ** 2)


def _rod(motion: str) -> acted_rod.Rod:
    return acted_rod.Rod(
        1.0, np.diag(STIFFNESS), np.diag(FRICTION), np.array(REFERENCE[motion]), position=POSITION[motion],
        rotation=Rotation.from_rotvec(ROTATION[motion]).as_matrix(),
    )  # fmt: skip


def _scene(motion: str, **changes: Any) -> Scene:
    kept = KEPT if motion == "planar" else list(range(6))
    scene = straight([STIFFNESS[i] for i in kept], [FRICTION[i] for i in kept])
    place: dict[str, Any] = {"position": POSITION[motion][: 2 if motion == "planar" else 3]}
    place |= {"angle": ROTATION[motion][2]} if motion == "planar" else {"rotation": ROTATION[motion]}
    return changed(
        scene,
        {"rod.reference": [REFERENCE[motion][i] for i in kept], "start": place, "run.until": UNTIL} | changes,
    )


def _agree(scene: Scene, expected: Shape, flipped: bool = False) -> None:
    """Both ends and the middle, places and frames, to 3e-8; and something has moved. Flipped: counted from its other
    end."""
    solution = simulate(scene, 2, 12, 1e-11, backend="auto").solution
    space = solution.position.shape[-1]
    points = (-1, len(expected.u) // 2, 0) if flipped else (0, len(expected.u) // 2, -1)
    for node, point in zip((0, 12, -1), points, strict=True):
        rotation = expected.rotation[point] * (FLIP if flipped else 1.0)
        assert gap(solution.position[-1, node], expected.position[point, :space]) < 3e-8
        assert gap(solution.rotation[-1, node], rotation[:space, :space]) < 1e-7
    assert gap(solution.turn[-1], solution.turn[0]) > 0.05


# effects: what a scene says, and the same as world components of force and couple

GRADIENT = np.array([[0.0, 8.0, 1.0], [-3.0, 2.0, 0.0], [2.0, 0.0, -2.0]])


def _weight(t: float, u: Array, r: Values, q: Values) -> Any:
    return np.stack([3.0 + 0 * u, -6.0 * (1.0 + u), 2.0 + 0 * u], axis=-1) * gently(t), np.zeros(3)


def _follower(t: float, u: Array, r: Values, q: Values) -> Any:
    return rotated(q, np.stack([2.0 * u, 5.0 - u, np.cos(3.0 * u)], axis=-1) * gently(t)), np.zeros(3)


def _couple(t: float, u: Array, r: Values, q: Values) -> Any:
    return np.zeros(3), rotated(q, np.stack([0.5 * u, -0.4 + 0 * u, 1.0 - u], axis=-1) * gently(t))


def _field(t: float, u: Array, r: Values, q: Values) -> Any:
    magnet = rotated(q, np.stack([1.0 + u, 0.3 + 0 * u, 0.2 + 0 * u], axis=-1))
    world = 4.0 * gently(t) * np.array([np.cos(8.0 * t), np.sin(8.0 * t), 0.5])
    return np.zeros(3), np.cross(magnet, world)


def _flow(t: float, u: Array, r: Values, q: Values) -> Any:
    curl = np.array([GRADIENT[2, 1] - GRADIENT[1, 2], GRADIENT[0, 2] - GRADIENT[2, 0], GRADIENT[1, 0] - GRADIENT[0, 1]])
    stream = np.array([0.5, -1.0, 2.0]) + r @ GRADIENT.T
    return medium(np.diag(FRICTION), q, stream * gently(t), 0.5 * curl * gently(t))


def _trap(t: float, u: Array, r: Values, q: Values) -> Any:
    centre = np.array([0.5 + 0.1 * np.sin(6.0 * t), 0.2, 0.1])
    return 20.0 * (1.0 + u[:, None] ** 2) * gently(t) * (centre - r), np.zeros(3)


def _hardening(t: float, u: Array, r: Values, q: Values) -> Any:
    return -60.0 * gently(t) * r * np.sum(r * r, axis=-1, keepdims=True), np.zeros(3)


def _swirl(t: float, u: Array, r: Values, q: Values) -> Any:
    spun = np.stack([-r[..., 1], r[..., 0], 0.0 * r[..., 0]], axis=-1)
    return 20.0 * gently(t) * spun, np.zeros(3)


@dataclass(frozen=True)
class Hardening(Effect):
    """A spring to the origin whose force goes with the third power of the distance, by its potential."""

    kind = "hardening"
    keys = {"strength": Key("scalar")}  # noqa: RUF012
    strength: Vector

    def potential(self, seen: Seen) -> Expression:
        return self.strength[0] * dot(seen.position, seen.position) ** 2 / 4


@dataclass(frozen=True)
class Swirl(Effect):
    """A force about the z axis, which has no potential, by its wrench."""

    kind = "swirl"
    keys = {"rate": Key("scalar", "t")}  # noqa: RUF012
    rate: Vector

    def wrench(self, seen: Seen) -> Pair:
        x, y = seen.position[:2]
        around = (-self.rate[0] * y, self.rate[0] * x, 0.0)
        return seen.to_body(around[: seen.space]), nothing(seen.rotations)


@pytest.fixture
def own(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Two effects registered in Python, for one test."""
    with monkeypatch.context() as patch:
        patch.setattr(registry, "_KINDS", dict(registry._KINDS))
        for each in (Hardening, Swirl):
            register(each)
        yield


def _cut(motion: str, *values: str) -> list[str]:
    return [f"({value})*{GENTLY}" for value in values[: 2 if motion == "planar" else 3]]


def _effect(name: str, motion: str) -> dict[str, Any]:
    flat = motion == "planar"
    torque = _cut("spatial", "0.5*u", "-0.4", "1 - u")
    rows = [[f"{x!r}*{GENTLY}" for x in row[: 2 if flat else 3]] for row in GRADIENT.tolist()[: 2 if flat else 3]]
    return {
        "weight": {"kind": "weight", "force": _cut(motion, "3", "-6*(1 + u)", "2")},
        "follower": {"kind": "follower", "force": _cut(motion, "2*u", "5 - u", "cos(3*u)")},
        "couple": {"kind": "couple", "torque": torque[2] if flat else torque},
        "field": {"kind": "field", "moment": ["1 + u", "0.3", "0.2"][: 2 if flat else 3],
                  "field": _cut(motion, "4*cos(8*t)", "4*sin(8*t)", "2")},
        "flow": {"kind": "flow", "gradient": rows, "velocity": _cut(motion, "0.5", "-1", "2")},
        "trap": {"kind": "trap", "stiffness": f"20*(1 + u**2)*{GENTLY}",
                 "centre": ["0.5 + 0.1*sin(6*t)", "0.2", "0.1"][: 2 if flat else 3]},
        "hardening": {"kind": "hardening", "strength": f"60*{GENTLY}"},
        "swirl": {"kind": "swirl", "rate": f"20*{GENTLY}"},
    }[name]  # fmt: skip


ACTING = {
    "weight": _weight, "follower": _follower, "couple": _couple, "field": _field, "flow": _flow, "trap": _trap,
    "hardening": _hardening, "swirl": _swirl,
}  # fmt: skip


def _acting(names: tuple[str, ...], motion: str) -> acted_rod.Acting:
    """The sum of them; in the plane their forces along it and their couples across it."""
    u = acted_rod.Collocation(_rod(motion), DEGREE).u
    flat = motion == "planar"

    def acting(t: float, r: Values, q: Values) -> tuple[Values, Values]:
        force, couple = np.zeros(r.shape, dtype=r.dtype), np.zeros(r.shape, dtype=r.dtype)
        for name in names:
            f, c = ACTING[name](t, u, r, q)
            force, couple = force + f, couple + c
        if flat:
            force, couple = force * [1.0, 1.0, 0.0], couple * [0.0, 0.0, 1.0]
        return force, couple

    return acting


def _solved(rod: acted_rod.Rod, degree: int = DEGREE) -> Shape:
    return acted_rod.solve(rod, UNTIL, degree, longest=1 / 30)


@pytest.mark.usefixtures("own")
@pytest.mark.parametrize("motion", ["planar", "spatial"])
@pytest.mark.parametrize("name", ACTING)
def test_every_effect_moves_a_clamped_rod_as_it_must(name: str, motion: str) -> None:
    """Each by itself, changing in time and along the rod; and two of one's own, with a potential and without."""
    scene = _scene(motion, effects=[_effect(name, motion)])
    _agree(scene, _solved(replace(_rod(motion), acting=_acting((name,), motion))))


@pytest.mark.usefixtures("own")
@pytest.mark.parametrize("motion", ["planar", "spatial"])
def test_all_effects_at_once_move_a_free_rod_as_they_must(motion: str) -> None:
    """Their sum, on a rod that nothing holds."""
    scene = _scene(motion, effects=[_effect(name, motion) for name in ACTING], **{"ends.left.kind": "free"})
    _agree(scene, _solved(replace(_rod(motion), left=End("free"), acting=_acting(tuple(ACTING), motion))))


LOAD = np.array([4.0, 3.0, -2.0, 0.3, -0.4, 0.5])
KINDS = [
    ("free", "clamped"), ("clamped", "free"), ("free", "free"), ("pinned", "free"), ("free", "pinned"),
    ("pinned", "clamped"), ("clamped", "pinned"), ("pinned", "pinned"),
]  # fmt: skip


def _end(kind: str, frame: str, motion: str, sign: float) -> tuple[dict[str, Any], End]:
    """As a scene has it, and as the reference does; planar loads are in the plane."""
    if kind == "clamped":
        return {"kind": "clamped"}, End("clamped")
    flat = motion == "planar"
    size = sign * LOAD * ([1, 1, 0, 0, 0, 1] if flat else np.ones(6)) * ([0] * 3 + [1] * 3 if kind == "pinned" else 1)
    force, torque = ([f"{x!r}*{GENTLY}" for x in part.tolist()] for part in (size[:3], size[3:]))
    table: dict[str, Any] = {"kind": kind, "frame": frame, "torque": torque[2] if flat else torque}
    if kind == "free":
        table["force"] = force[: 2 if flat else 3]
    return table, End(kind, lambda t: size * gently(t), frame)  # type: ignore[arg-type]


@pytest.mark.parametrize("motion", ["planar", "spatial"])
@pytest.mark.parametrize("frames", [("body", "world"), ("world", "body")], ids="-".join)
@pytest.mark.parametrize("kinds", KINDS, ids="-".join)
def test_loads_on_any_ends_move_the_rod_as_they_must(
    kinds: tuple[str, str], frames: tuple[str, str], motion: str
) -> None:
    """Forces and torques, turning with the end or not, on whichever ends can move or turn."""
    left, right = (_end(k, f, motion, s) for k, f, s in zip(kinds, frames, (1.0, -0.7), strict=True))
    scene = _scene(motion, ends={"left": left[0], "right": right[0]})
    _agree(scene, _solved(replace(_rod(motion), left=left[1], right=right[1])))


# driven ends: phi(0, t) = phi(0, 0) exp(s(t) X), by screw X and s(t); the rider of the base sees a medium that flows

@dataclass(frozen=True)
class Screw:
    """travelled: the parameter of phi = exp(travelled screw) phi(0) at a time; its rate, as numbers and as a scene has
    it; degree: of the reference, which a rod that is dragged far needs more of."""

    motion: str
    screw: list[float]
    travelled: Callable[[float], float]
    rate: Callable[[float], float]
    text: str
    degree: int = DEGREE


def _cubic(motion: str, screw: list[float], factor: float, degree: int = DEGREE) -> Screw:
    return Screw(motion, screw, lambda t: factor * t**3, lambda t: 3 * factor * t**2, f"{3 * factor!r}*t**2", degree)


SCREWS = {
    "spinning": _cubic("spatial", [0.0, 0.0, 0.0, 1.0, 0.0, 0.0], 400.0),
    "oscillating": Screw(
        "spatial", [0.0, 0.0, 0.0, 0.0, 0.6, 0.8], lambda t: 0.5 * np.sin(15 * t) ** 3,
        lambda t: 22.5 * np.sin(15 * t) ** 2 * np.cos(15 * t), "22.5*sin(15*t)**2*cos(15*t)",
    ),
    "translating": _cubic("spatial", [0.4, 0.3, -0.5, 0.0, 0.0, 0.0], 300.0, 22),
    "screwing": _cubic("spatial", [0.5, -0.2, 0.3, 1.0, -0.5, 0.7], 200.0),
    "rocking in the plane": _cubic("planar", [0.5, -0.3, 0.0, 0.0, 0.0, 1.0], 200.0),
}  # fmt: skip


def _matrix(screw: Array) -> Array:
    """The velocity of the configuration [[1, 0], [r, R]] at the identity."""
    x, y, z = screw[3:]
    out = np.zeros((4, 4))
    out[1:, 0], out[1:, 1:] = screw[:3], [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
    return out


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("name", SCREWS)
def test_a_driven_end_moves_the_rod_as_it_must(name: str, side: str) -> None:
    """Spun, rocked, moved along and all at once, under weight, at either end: clamped, for who rides on it."""
    driven = SCREWS[name]
    motion, screw = driven.motion, np.array(driven.screw)
    flat = motion == "planar"
    weight = np.array([1.0, -5.0, 0.0 if flat else 2.0])
    start = np.eye(4)
    start[1:, 0], start[1:, 1:] = POSITION[motion], Rotation.from_rotvec(ROTATION[motion]).as_matrix()
    spatial = start @ _matrix(screw) @ np.linalg.inv(start)
    velocity, spin = spatial[1:, 0], np.array([spatial[3, 2], spatial[1, 3], spatial[2, 1]])

    def acting(t: float, r: Values, q: Values) -> tuple[Values, Values]:
        rate, turned = driven.rate(t), expm(driven.travelled(t) * spatial)[1:, 1:]
        force, couple = medium(np.diag(FRICTION), q, -rate * (velocity + np.cross(spin, r)), -rate * spin)
        return force + turned.T @ weight * gently(t), couple

    seen = _solved(replace(_rod(motion), acting=acting), driven.degree)
    carried = expm(driven.travelled(UNTIL) * spatial)
    expected = Shape(
        seen.u, carried[1:, 0] + seen.position @ carried[1:, 1:].T, carried[1:, 1:] @ seen.rotation, seen.turn
    )
    kept = KEPT if flat else list(range(6))
    effect = {"kind": "weight", "force": [f"{w!r}*{GENTLY}" for w in weight.tolist()[: 2 if flat else 3]]}
    twist = [f"{screw.tolist()[i]!r}*{driven.text}" for i in kept]
    scene = _scene(motion, effects=[effect], **{"ends.left": {"kind": "driven", "twist": twist}})
    _agree(scene if side == "left" else _counted_from_the_other_end(scene, motion), expected, side == "right")


FLIP = np.array([-1.0, -1.0, 1.0])
"""The frame of a rod that is counted from its other end: e1 goes the other way, and so does e2."""


def _counted_from_the_other_end(scene: Scene, motion: str) -> Scene:
    """The same rod with u running the other way: its left end is driven, so its right one will be."""
    kept = KEPT if motion == "planar" else list(range(6))
    strain = np.array([1.0, 1.0, -1.0, 1.0, 1.0, -1.0])
    shape = acted_rod.Collocation(_rod(motion), 20)
    tip = shape.shape(shape.begin())
    turned = tip.rotation[-1] * FLIP
    place: dict[str, Any] = {"position": tip.position[-1][: len(kept) // 3 + 1].tolist()}
    vector = Rotation.from_matrix(turned).as_rotvec().tolist()
    place |= {"angle": vector[2]} if motion == "planar" else {"rotation": vector}
    twist = [
        f"{sign!r}*({x})"
        for sign, x in zip(np.tile(FLIP, 2)[kept].tolist(), scene["ends"]["left"]["twist"], strict=True)
    ]
    return changed(
        scene,
        {
            "rod.reference": (np.array(REFERENCE[motion]) * strain)[kept].tolist(),
            "start": place,
            "ends": {"left": {"kind": "free"}, "right": {"kind": "driven", "twist": twist}},
        },
    )
