"""What every semi-discrete rod obeys exactly: energy, balance of forces, indifference to frame and to direction."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.kernel.load import load
from geocosserat.kernel.pure import NumpyRod
from geocosserat.model.expressions import evaluate
from geocosserat.model.records import Scene
from tests.discretisation import oracle
from tests.discretisation.rods import LAWFUL, MOTIONS, NAMES, PLACED, SIZES, WORLD, random_state, rod, scene, yielding
from tests.kernel.kernels import Case, T, cases, kernel, rate, reference, state
from tests.kernel.mirror import lifted, reversed_scene, reversed_turn, turned

Array = NDArray[np.float64]
meshes = pytest.mark.parametrize("size", SIZES, ids=str)
names = pytest.mark.parametrize("name", NAMES)
told_otherwise = pytest.mark.parametrize("name", [name for name in NAMES if name not in LAWFUL])


def numpy_rod(scene: Scene, size: tuple[int, int], pull: float = 0.7) -> tuple[SemiDiscrete, NumpyRod]:
    r = yielding(discretise(scene, *size), pull)
    k = load(kernel_text(r.structure), r, "numpy")
    assert isinstance(k, NumpyRod)
    return r, k


def smooth_state(r: SemiDiscrete, seed: int) -> Array:
    """A turn (of frozen modes a stress) of low degree along the rod, at its start otherwise."""
    rng, y = np.random.default_rng(seed), r.state.copy()
    x = r.mesh.u_point / r.mesh.edges[-1]
    d = r.structure.group.dimension
    along(r, y)[:] += rng.normal(scale=0.3, size=(d, 3)) @ np.stack([np.ones_like(x), x, x**2])
    return y


def along(r: SemiDiscrete, y: Array) -> Array:
    """What a state, or its rate, holds at the points, (d, points): a view."""
    d, Q = r.structure.group.dimension, len(r.mesh.u_point)
    return y[: d * Q].reshape(d, Q)


# energy


def storing(name: str, size: tuple[int, int], t: float, y: Array, stress: Array, dy: Array) -> tuple[Array, Array]:
    """At the points: power that goes into the stored energy, as strains move away from the reference or as a law says
    and changes, and power of the stresses of frozen modes as far as they move, which they may not."""
    r, exact = rod(name, *size), reference(name, *size)
    frozen = np.array(r.structure.frozen)
    power = r.mesh.weight * stress * (along(r, dy) - oracle.floats(exact.reference_rate(oracle.MP.mpf(t))))
    if exact.law:
        instant = oracle.MP.mpf(t)
        conserved, supplied = map(oracle.floats, exact.conserved(instant, exact.unpack(instant, oracle.numbers(y))[0]))
        power = r.mesh.weight * conserved * along(r, dy)
        power[np.flatnonzero(~frozen)[0]] += r.mesh.weight * supplied
    yielding = r.mesh.weight * stress * (along(r, dy) + oracle.floats(np.array(exact.slack))[:, None] * stress)
    return power[~frozen], yielding[frozen]


@pytest.mark.parametrize("case", cases(), ids=str)
def test_energy_is_dissipated_worked_or_stored_to_the_last_digits(case: Case) -> None:
    """d energy/dt + dissipated = work: exact in the semi-discrete rod, at any state, for every load and effect, driven
    ends, moving media and references; what frozen modes do, as long as they move, counts with them."""
    y = state(case, 11)
    _, stress, _ = kernel(case).observe(T, y)
    dy = rate(case, T, y)
    stored, yielded = storing(case.name, case[1:3], T, y, stress, dy)
    lost, gained = dy[-2:]
    size = np.abs(stored).sum() + np.abs(yielded).sum() + abs(lost) + abs(gained)
    assert abs(stored.sum() + yielded.sum() + lost - gained) <= 2e-14 * size
    assert lost > 0 or case.name in LAWFUL


@names
def test_the_stored_energy_changes_as_its_state_does(name: str) -> None:
    """The energy that is observed is the one whose rate the stress gives: central differences along the motion, while
    the reference moves too."""
    case = Case(name, 4, 2, "numpy")
    k, y = kernel(case), state(case, 12)
    dy = rate(case, T, y)
    step = 1e-4 / max(np.abs(dy).max(), 10)
    ahead, behind = (k.observe(T + sign * step, y + sign * step * dy)[2] for sign in (1, -1))
    stress = k.observe(T, y)[1]
    power, _ = storing(name, (4, 2), T, y, stress, dy)
    assert (ahead - behind) / (2 * step) == pytest.approx(power.sum(), rel=1e-8)


@meshes
@pytest.mark.parametrize("name", [f"{m} {n}" for m in MOTIONS for n in ("plain", "held", "hoop")])
def test_a_rod_at_rest_without_loads_stays_at_rest(name: str, size: tuple[int, int]) -> None:
    """At its reference nothing moves and nothing is stored; with both ends held no load does any work there."""
    case = Case(name, *size, "numpy")
    y = rod(name, *size).state
    dy = rate(case, T, y)
    twist, _, energy = kernel(case).observe(T, y)
    if not name.endswith("held"):
        np.testing.assert_array_equal(dy, 0)
        assert energy == 0
    else:
        np.testing.assert_array_equal(twist[:, 0], 0)
        np.testing.assert_allclose(twist[:, -1], 0, rtol=0, atol=1e-15)


@names
def test_ends_move_as_they_are_told(name: str) -> None:
    """In any state: clamped ones not at all, pinned ones about their place, driven ones as the scene says, free ones as
    they will."""
    r, model = rod(name, 4, 2), scene(name).model
    y = state(Case(name, 4, 2, "numpy"), 13)
    twist = kernel(Case(name, 4, 2, "numpy")).observe(T, y)[0]
    if model.joined:
        np.testing.assert_array_equal(twist[:, 0], twist[:, -1])
        return
    for end, side, node in ((model.left, "left", 0), (model.right, "right", -1)):
        held = {"clamped": len(twist), "driven": len(twist), "pinned": model.group.translations}.get(end.kind, 0)
        wanted = np.zeros(held)
        if end.kind == "driven":
            wanted = [float(evaluate(e, {**model.parameters, "t": T})) for e in end.twist or ()]
        if r.structure.base == side:
            np.testing.assert_allclose(twist[:held, node], wanted, rtol=1e-15, atol=0)
        assert np.all(twist[held:, node] != 0)


@pytest.mark.parametrize("name", [name for name in NAMES if name.split()[1] in ("held", "cranked", "swept", "wrung")])
def test_a_far_end_that_strayed_goes_home(name: str) -> None:
    """Straight to its place, and about the axis that turns it back, at the rate that the pull says; one that is driven
    to where it should have been by now, besides moving as it is told."""
    r, model, y = rod(name, 4, 2), scene(name).model, state(Case(name, 4, 2, "numpy"), 14)
    node, end = (-1, model.right) if r.structure.base == "left" else (0, model.left)
    twist = kernel(Case(name, 4, 2, "numpy")).observe(T, y)[0][:, node]
    now, start, space = r.poses(y, T), r.poses(r.state), model.group.translations
    R, position, rotation = now.rotation[node], start.position[node], start.rotation[node]
    if end.kind == "driven":
        twist -= [float(evaluate(e, {**model.parameters, "t": T})) for e in end.twist or ()]
        turn, way = (oracle.floats(x)[..., :space] for x in reference(name, 4, 2).course(8, T))
        position, rotation = position + rotation @ way, rotation @ turn[:space]
    np.testing.assert_allclose(R @ twist[:space], 0.7 * (position - now.position[node]), rtol=0, atol=1e-14)
    if end.kind != "pinned":
        back = R.T @ rotation
        axis = (back - back.T)[[2, 0, 1], [1, 2, 0]] / 2 if space == 3 else [back[1, 0]]
        np.testing.assert_allclose(twist[space:], 0.7 * np.array(axis), rtol=0, atol=1e-14)
    still = kernel(Case(name, 4, 2, "numpy")).observe(0.0, r.state)[0][:, node]
    told = [float(evaluate(e, {**model.parameters, "t": 0.0})) for e in end.twist or ()] or np.zeros(len(twist))
    count = space if end.kind == "pinned" else len(twist)
    np.testing.assert_allclose(still[:count], told[:count], rtol=0, atol=1e-14)


# balance


def drag_and_load(name: str, size: tuple[int, int], y: Array) -> tuple[Array, Array, Array]:
    """Turn (6, points), drag of the kernel's motion relative to the medium, and what acts on the nodes (6, nodes)."""
    r, exact = rod(name, *size), reference(name, *size)
    motion = exact.move(T, y)
    slip = -oracle.floats(motion.medium)
    slip[exact.kept] += kernel(Case(name, *size, "numpy")).observe(T, y)[0]
    drag = -r.mesh.mass * np.einsum("nij,jn->in", oracle.floats(exact.friction), slip)
    return oracle.floats(motion.turn), drag, oracle.floats(motion.load + exact.mass * motion.wrench)


def wrenches(name: str, size: tuple[int, int], y: Array) -> tuple[Array, Array, Array]:
    """Total drag and total load, world components with moments about the origin, and the size of what is summed."""
    r, exact = rod(name, *size), reference(name, *size)
    poses = r.poses(y, T)
    _, drag, load = drag_and_load(name, size, y)
    space = poses.position.shape[-1]
    R, x = np.tile(np.eye(3), (exact.N, 1, 1)), np.zeros((exact.N, 3))
    R[:, :space, :space], x[:, :space] = poses.rotation, poses.position

    def total(local: Array) -> tuple[Array, Array]:
        force, moment = np.einsum("nij,jn->ni", R, local[:3]), np.einsum("nij,jn->ni", R, local[3:])
        world = np.concatenate([force, moment + np.cross(x, force)], axis=1)
        return world.sum(axis=0), np.abs(world).sum(axis=0)

    (lost, size_lost), (gained, size_gained) = total(drag), total(load)
    return lost, gained, size_lost + size_gained


FREE = [f"{motion} {name}" for motion in MOTIONS for name in ("drifting", "everything", "stirred")]


@meshes
@pytest.mark.parametrize("name", [name for name in FREE if name.startswith("spatial")])
def test_the_drag_on_a_free_rod_in_space_balances_its_loads_exactly(name: str, size: tuple[int, int]) -> None:
    """The sum of all drag forces is minus that of all loads, to round-off in any state: no stress pulls on the whole.

    For rows of the rotation are carried along the rod by the same collocation that the scheme takes slopes with.
    """
    drag, load, scale = wrenches(name, size, random_state(rod(name, *size), 14))
    assert np.all(np.abs(drag + load)[:3] <= 1e-13 * (1 + scale[:3]))


def rigid_motions(r: SemiDiscrete, E: Array) -> Array:
    """(6, N, 6): the twist, at every node, of each motion that changes no strain: unit twists of the left end, carried
    along by D V + [E, B V] = 0."""
    mesh, p = r.mesh, r.mesh.degree
    V = np.zeros((6, mesh.elements * p + 1, 6))
    V[:, 0] = np.eye(6)
    for e, half in enumerate(mesh.half):
        rows = np.zeros((6 * p, 6 * (p + 1)))
        for q in range(p):
            ad = oracle.floats(np.stack([oracle.bracket(E[:, e * p + q], unit) for unit in np.eye(6)], axis=1))
            rows[6 * q : 6 * q + 6] = np.kron(mesh.reference.slopes[q], np.eye(6)) / half
            rows[6 * q : 6 * q + 6] += np.kron(mesh.reference.values[q], ad)
        inside = np.linalg.solve(rows[:, 6:], -rows[:, :6] @ V[:, e * p])
        V[:, e * p + 1 : e * p + p + 1] = inside.reshape(p, 6, 6).swapaxes(0, 1)
    return V


@meshes
@pytest.mark.parametrize("name", FREE)
def test_the_total_drag_wrench_on_a_free_rod_is_minus_the_total_load_wrench(name: str, size: tuple[int, int]) -> None:
    """Force and moment, plane and space, any state and mesh, to round-off: wrenches are added up as the rod itself
    carries them to its left end, so that no motion that changes no strain meets any stress."""
    E, drag, load = drag_and_load(name, size, random_state(rod(name, *size), 14))
    rigid = rigid_motions(rod(name, *size), E)
    lost, gained = np.einsum("in,ink->k", drag, rigid), np.einsum("in,ink->k", load, rigid)
    size_of_terms = np.einsum("in,ink->k", np.abs(drag) + np.abs(load), np.abs(rigid))
    assert np.all(np.abs(lost + gained) <= 1e-13 * (1 + size_of_terms))


@pytest.mark.parametrize("name", FREE)
def test_the_drag_on_a_free_rod_balances_its_loads_in_force_and_moment_spectrally(name: str) -> None:
    """In the plane too, and moments about the origin: the gap falls by five digits from degree 6 to 12."""
    gaps = []
    for degree in (6, 12):
        drag, load, scale = wrenches(name, (1, degree), smooth_state(rod(name, 1, degree), 15))
        gaps.append(np.max(np.abs(drag + load) / (1 + scale)))
    assert gaps[0] < 1e-3
    assert gaps[1] < 1e-5 * gaps[0] or gaps[1] < 1e-13


# indifference


@pytest.mark.parametrize("name", [name for name in NAMES if name not in WORLD])
def test_a_rod_that_does_not_see_the_world_moves_alike_everywhere(name: str) -> None:
    """Starting a million lengths away and turned, not one digit of any rate changes."""
    planar = name.startswith("planar")
    away = turned(scene(name), [1.234] if planar else [0.4, -1.1, 2.0], [1e6, -2e6] if planar else [1e6, -2e6, 3e6])
    r, k = numpy_rod(away, (4, 2))
    case = Case(name, 4, 2, "numpy")
    y, out = state(case, 16), np.empty(len(r.state))
    k.rate(T, y, out)
    np.testing.assert_array_equal(out, rate(case, T, y))


@meshes
@pytest.mark.parametrize("name", [name for name in WORLD if name not in LAWFUL])
def test_turning_the_world_with_the_rod_changes_nothing(name: str, size: tuple[int, int]) -> None:
    """Loads and effects turned along with the start, and all of it moved: a million lengths away where only directions
    matter, a few where places do."""
    planar = name.startswith("planar")
    far = np.array([1.0, -2.0] if planar else [1.0, -2.0, 3.0]) * (1 if name in PLACED else 1e6)
    away = turned(scene(name), [1.234] if planar else [0.4, -1.1, 2.0], far.tolist())
    r, k = numpy_rod(away, size)
    case = Case(name, *size, "numpy")
    y, out = state(case, 17), np.empty(len(r.state))
    k.rate(T, y, out)
    wanted = rate(case, T, y)
    np.testing.assert_allclose(out, wanted, rtol=0, atol=(2e-13 if name in PLACED else 1e-13) * np.abs(wanted).max())


@meshes
@told_otherwise
def test_a_reversed_rod_moves_in_reverse(name: str, size: tuple[int, int]) -> None:
    """Ends swapped, coordinate reversed, frame turned by pi: the same motion, the same energies, to round-off."""
    # held alike at both ends, a rod is drawn home at the one that is last; without a pull both sides are the same
    alike = scene(name).model.left.kind == scene(name).model.right.kind
    here, k_here = numpy_rod(scene(name), size, 0.0 if alike else 0.7)
    y, at = random_state(here, 18), T if here.guide is not None else 0.0
    if here.structure.carried:
        y[-2 - here.structure.carried : -2] = here.state[-2 - here.structure.carried : -2]
    # then both rods march from their own left end as well: it must be where the other one ends now
    there, k = numpy_rod(reversed_scene(scene(name), here, y if alike else here.state, at), size, 0.0 if alike else 0.7)
    np.testing.assert_allclose(there.mesh.edges, 1.3 - here.mesh.edges[::-1], rtol=0, atol=1e-15)
    mirrored, out, wanted = there.state.copy(), np.empty(len(there.state)), np.empty(len(y))
    along(there, mirrored)[:] = reversed_turn(along(here, y))
    k.rate(T, mirrored, out)
    k_here.rate(T, y, wanted)
    size_of_rates = np.abs(wanted).max()
    found = along(there, out)
    np.testing.assert_allclose(found, reversed_turn(along(here, wanted)), rtol=0, atol=2e-13 * size_of_rates)
    np.testing.assert_allclose(out[-2:], wanted[-2:], rtol=1e-12, atol=1e-12)


PLANAR = [name for name in NAMES if name.startswith("planar")]


@meshes
@pytest.mark.parametrize("name", [name for name in PLANAR if name not in (*WORLD, *LAWFUL)])
def test_a_planar_rod_moves_alike_in_space(name: str, size: tuple[int, int]) -> None:
    """Lifted into space it has the same rates to round-off, and none out of its plane."""
    compare_lifted(name, size, state(Case(name, *size, "numpy"), 19), 1e-13)


@pytest.mark.parametrize("name", [name for name in PLANAR if name in WORLD and name not in LAWFUL])
def test_a_planar_rod_that_sees_the_world_moves_alike_in_space(name: str) -> None:
    """There the frames are marched in two ways, which agree where both have converged."""
    compare_lifted(name, (2, 14), smooth_state(rod(name, 2, 14), 20), 1e-11)


def compare_lifted(name: str, size: tuple[int, int], y: Array, digits: float) -> None:
    here = rod(name, *size)
    there, k = numpy_rod(lifted(scene(name)), size)
    if here.structure.carried:
        y[-5:-2] = 0
    solid, out = there.state.copy(), np.empty(len(there.state))
    along(there, solid)[[0, 1, 5]] = along(here, y)
    along(there, solid)[[2, 3, 4]] = 0
    k.rate(T, solid, out)
    wanted = rate(Case(name, *size, "numpy"), T, y)
    found, size_of_rates = along(there, out), np.abs(wanted).max()
    np.testing.assert_allclose(found[[0, 1, 5]], along(here, wanted), rtol=0, atol=digits * size_of_rates)
    np.testing.assert_allclose(found[[2, 3, 4]], 0, rtol=0, atol=digits * size_of_rates)
    np.testing.assert_allclose(out[-2:], wanted[-2:], rtol=0, atol=10 * digits * (1 + np.abs(wanted[-2:]).max()))
