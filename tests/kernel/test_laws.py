"""What every semi-discrete rod obeys exactly: energy, balance of forces, indifference to frame and to direction."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from geocosserat.conductor import kernel_text
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.kernel.load import load
from geocosserat.kernel.pure import NumpyRod
from geocosserat.model.records import Scene
from tests.discretisation import oracle
from tests.discretisation.rods import MOTIONS, NAMES, SIZES, WORLD, random_state, rod, scene
from tests.kernel.kernels import Case, T, cases, kernel, rate, reference, state
from tests.kernel.mirror import lifted, reversed_scene, reversed_turn, turned

Array = NDArray[np.float64]
meshes = pytest.mark.parametrize("size", SIZES, ids=str)
names = pytest.mark.parametrize("name", NAMES)


def numpy_rod(scene: Scene, size: tuple[int, int]) -> tuple[SemiDiscrete, NumpyRod]:
    r = discretise(scene, *size)
    k = load(kernel_text(r.structure), r, "numpy")
    assert isinstance(k, NumpyRod)
    return r, k


def smooth_state(r: SemiDiscrete, seed: int) -> Array:
    """A turn of low degree along the rod, at its start otherwise."""
    rng, y = np.random.default_rng(seed), r.state.copy()
    x = r.mesh.u_point / r.mesh.edges[-1]
    d = r.structure.group.dimension
    turn = r.turn(y)
    turn += rng.normal(scale=0.3, size=(d, 3)) @ np.stack([np.ones_like(x), x, x**2])
    y[: turn.size] = turn.ravel()
    return y


# energy


@pytest.mark.parametrize("case", cases(), ids=str)
def test_energy_is_dissipated_worked_or_stored_to_the_last_digits(case: Case) -> None:
    """d energy/dt + dissipated = work: exact in the semi-discrete rod, at any state and for every load."""
    r, y = rod(*case[:3]), state(case, 11)
    _, stress, _ = kernel(case).observe(T, y)
    dy = rate(case, T, y)
    stored = r.mesh.weight * stress * r.turn(dy)
    lost, gained = dy[-2:]
    assert abs(stored.sum() + lost - gained) <= 1e-14 * (np.abs(stored).sum() + lost + abs(gained))
    assert lost > 0


@names
def test_the_stored_energy_changes_as_its_state_does(name: str) -> None:
    """The energy that is observed is the one whose rate the stress gives: central differences along the motion."""
    case = Case(name, 4, 2, "numpy")
    k, y, r = kernel(case), state(case, 12), rod(name, 4, 2)
    dy = rate(case, T, y)
    step = 1e-4 / np.abs(dy).max()
    slope = (k.observe(T, y + step * dy)[2] - k.observe(T, y - step * dy)[2]) / (2 * step)
    stress = k.observe(T, y)[1]
    assert slope == pytest.approx((r.mesh.weight * stress * r.turn(dy)).sum(), rel=1e-9)


@meshes
@pytest.mark.parametrize("name", [f"{m} {n}" for m in MOTIONS for n in ("plain", "held")])
def test_a_rod_at_rest_without_loads_stays_at_rest(name: str, size: tuple[int, int]) -> None:
    """At its reference nothing moves and nothing is stored; with both ends held no load does any work there."""
    case = Case(name, *size, "numpy")
    y = rod(name, *size).state
    dy = rate(case, T, y)
    if name.endswith("plain"):
        np.testing.assert_array_equal(dy, 0)
        assert kernel(case).observe(T, y)[2] == 0
    twist = kernel(case).observe(T, y)[0]
    np.testing.assert_array_equal(twist[:, 0], 0)


@names
def test_held_ends_do_not_move(name: str) -> None:
    """In any state; and free ends do."""
    case = Case(name, 4, 2, "numpy")
    twist = kernel(case).observe(T, state(case, 13))[0]
    for held, node in zip(rod(name, 4, 2).structure.held, (0, -1), strict=True):
        assert np.all(twist[:, node] == 0) == held


# balance


def wrenches(name: str, size: tuple[int, int], y: Array) -> tuple[Array, Array, Array]:
    """Total drag and total load, world components with moments about the origin, and the size of what is summed."""
    r, exact = rod(name, *size), reference(name, *size)
    k = kernel(Case(name, *size, "numpy"))
    poses, twist = r.poses(y), k.observe(T, y)[0]
    drag = np.zeros((6, exact.N))
    drag[exact.kept] = -r.mesh.mass * np.einsum("nij,jn->in", oracle.floats(exact.friction), twist)
    load = oracle.floats(exact.move(T, y)[1])
    space = poses.position.shape[-1]
    R, x = np.tile(np.eye(3), (exact.N, 1, 1)), np.zeros((exact.N, 3))
    R[:, :space, :space], x[:, :space] = poses.rotation, poses.position

    def total(local: Array) -> tuple[Array, Array]:
        force, moment = np.einsum("nij,jn->ni", R, local[:3]), np.einsum("nij,jn->ni", R, local[3:])
        world = np.concatenate([force, moment + np.cross(x, force)], axis=1)
        return world.sum(axis=0), np.abs(world).sum(axis=0)

    (lost, size_lost), (gained, size_gained) = total(drag), total(load)
    return lost, gained, size_lost + size_gained


FREE = [f"{motion} {name}" for motion in MOTIONS for name in ("drifting", "everything")]


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
    r, exact, y = rod(name, *size), reference(name, *size), random_state(rod(name, *size), 14)
    E, load, _ = (oracle.floats(part) for part in exact.move(T, y))
    drag = np.zeros((6, exact.N))
    twist = kernel(Case(name, *size, "numpy")).observe(T, y)[0]
    drag[exact.kept] = -r.mesh.mass * np.einsum("nij,jn->in", oracle.floats(exact.friction), twist)
    rigid = rigid_motions(r, E)
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
@pytest.mark.parametrize("name", WORLD)
def test_turning_the_world_with_the_rod_changes_nothing(name: str, size: tuple[int, int]) -> None:
    """Loads and weight turned along with the start, and all of it moved a million lengths away."""
    planar = name.startswith("planar")
    away = turned(scene(name), [1.234] if planar else [0.4, -1.1, 2.0], [1e6, -2e6] if planar else [1e6, -2e6, 3e6])
    r, k = numpy_rod(away, size)
    case = Case(name, *size, "numpy")
    y, out = state(case, 17), np.empty(len(r.state))
    k.rate(T, y, out)
    wanted = rate(case, T, y)
    np.testing.assert_allclose(out, wanted, rtol=0, atol=1e-13 * np.abs(wanted).max())


@meshes
@names
def test_a_reversed_rod_moves_in_reverse(name: str, size: tuple[int, int]) -> None:
    """Ends swapped, coordinate reversed, frame turned by pi: the same motion, the same energies, to round-off."""
    case = Case(name, *size, "numpy")
    here = rod(name, *size)
    y = state(case, 18)
    if here.structure.carried:
        y[-2 - here.structure.carried : -2] = here.state[-2 - here.structure.carried : -2]
    # held at both ends or at none, both rods march from their own left end: it must be where the other one ends now
    at_start = y if here.structure.held[0] == here.structure.held[1] else here.state
    there, k = numpy_rod(reversed_scene(scene(name), here, at_start), size)
    np.testing.assert_allclose(there.mesh.edges, 1.3 - here.mesh.edges[::-1], rtol=0, atol=1e-15)
    mirrored, out = there.state.copy(), np.empty(len(there.state))
    turn = reversed_turn(here.turn(y))
    mirrored[: turn.size] = turn.ravel()
    k.rate(T, mirrored, out)
    wanted = rate(case, T, y)
    size_of_rates = np.abs(wanted).max()
    np.testing.assert_allclose(there.turn(out), reversed_turn(here.turn(wanted)), rtol=0, atol=2e-13 * size_of_rates)
    np.testing.assert_allclose(out[-2:], wanted[-2:], rtol=1e-12, atol=1e-12)


PLANAR = [name for name in NAMES if name.startswith("planar")]


@meshes
@pytest.mark.parametrize("name", [name for name in PLANAR if name not in WORLD])
def test_a_planar_rod_moves_alike_in_space(name: str, size: tuple[int, int]) -> None:
    """Lifted into space it has the same rates to round-off, and none out of its plane."""
    compare_lifted(name, size, state(Case(name, *size, "numpy"), 19), 1e-13)


@pytest.mark.parametrize("name", [name for name in PLANAR if name in WORLD])
def test_a_planar_rod_that_sees_the_world_moves_alike_in_space(name: str) -> None:
    """There the frames are marched in two ways, which agree where both have converged."""
    compare_lifted(name, (2, 14), smooth_state(rod(name, 2, 14), 20), 1e-11)


def compare_lifted(name: str, size: tuple[int, int], y: Array, digits: float) -> None:
    here = rod(name, *size)
    there, k = numpy_rod(lifted(scene(name)), size)
    if here.structure.carried:
        y[-5:-2] = 0
    solid, out = there.state.copy(), np.empty(len(there.state))
    turn = there.turn(solid)
    turn[[0, 1, 5]] = here.turn(y)
    turn[[2, 3, 4]] = 0
    solid[: turn.size] = turn.ravel()
    k.rate(T, solid, out)
    wanted = rate(Case(name, *size, "numpy"), T, y)
    found, size_of_rates = there.turn(out), np.abs(wanted).max()
    np.testing.assert_allclose(found[[0, 1, 5]], here.turn(wanted), rtol=0, atol=digits * size_of_rates)
    np.testing.assert_allclose(found[[2, 3, 4]], 0, rtol=0, atol=digits * size_of_rates)
    np.testing.assert_allclose(out[-2:], wanted[-2:], rtol=0, atol=10 * digits * (1 + np.abs(wanted[-2:]).max()))
