"""Every kernel computes the semi-discrete rod: C, numpy and an independent 40-digit evaluation agree."""

from __future__ import annotations

import numpy as np
import pytest

from geocosserat.discretisation.semidiscrete import discretise
from tests.discretisation import oracle
from tests.discretisation.rods import NAMES, SIZES, changed, given, random_state, rod, yielding
from tests.kernel.kernels import (
    Case,
    T,
    cases,
    implicit,
    kernel,
    like,
    rate,
    reference,
    reference_derivative,
    reference_rate,
    state,
)

ids = pytest.mark.parametrize("case", cases(), ids=str)


@ids
def test_the_rate_is_that_of_the_semi_discrete_rod(case: Case) -> None:
    """At random states far from rest, also the rates of a carried pose and of both energies: round-off only."""
    for seed in (1, 2):
        found, wanted = rate(case, T, state(case, seed)), reference_rate(*case[:3], T, seed)
        size = np.abs(wanted[:-2]).max()
        np.testing.assert_allclose(found[:-2], wanted[:-2], rtol=0, atol=1e-13 * size)
        np.testing.assert_allclose(found[-2:], wanted[-2:], rtol=1e-13, atol=1e-13)


@ids
def test_the_jacobian_is_the_exact_derivative_of_the_rate(case: Case) -> None:
    """In random directions, row by row to round-off; nothing depends on the energies, whose rows are left zero."""
    for seed in (1, 2):
        y = state(case, seed)
        direction, wanted = reference_derivative(*case[:3], seed)
        J = kernel(case).jacobian(T, y)
        rows = np.abs(J) @ np.abs(direction)
        assert np.all(np.abs(J @ direction - wanted)[:-2] <= 1e-13 * rows[:-2])
        np.testing.assert_array_equal(J[-2:], 0)
        np.testing.assert_array_equal(J[:, -2:], 0)


@ids
def test_what_is_observed_is_what_moves_the_rod(case: Case) -> None:
    """Twist, stress (of frozen modes the one in the state) and stored energy of a state."""
    y, exact = state(case, 3), reference(*case[:3])
    twist, stress, energy = kernel(case).observe(T, y)
    motion, kept = exact.move(T, y), exact.kept
    for found, wanted in ((twist, motion.twist[kept]), (stress, motion.stress[kept]), (energy, exact.energy(T, y))):
        wanted = oracle.floats(wanted)
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-13 * np.abs(wanted).max())


@pytest.mark.parametrize("case", cases(("c",)), ids=str)
def test_c_and_numpy_agree_to_round_off(case: Case) -> None:
    """Rates and all entries of the Jacobian."""
    y, other = state(case, 4), case._replace(backend="numpy")
    for found, wanted in (
        (rate(case, T, y), rate(other, T, y)),
        (kernel(case).jacobian(T, y), kernel(other).jacobian(T, y)),
    ):
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-13 * np.abs(wanted).max())


@pytest.mark.parametrize("case", cases(("c",), ("planar everything",)), ids=str)
@pytest.mark.parametrize("bend", [0.0, -2.0, 9.0, -300.0, 4e4, 3e6])
def test_frames_may_turn_however_far(case: Case, bend: float) -> None:
    """Through all quadrants and many turns, also where C leaves cosines to its library; but for what is lost of the
    angle itself."""
    y, points = state(case, 5), case.elements * case.degree
    y[2 * points : 3 * points] += bend
    found, wanted = rate(case, T, y), rate(case._replace(backend="numpy"), T, y)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-13 * (1.0 + abs(bend)) * np.abs(wanted).max())


@pytest.mark.parametrize(
    "case",
    [c for c in cases() if c.name.endswith(("everything", "stirred", "cranked")) and c[1:3] == SIZES[1]],
    ids=str,
)
@pytest.mark.parametrize("t", [0.0, 0.2, 0.5, 7.0])
def test_loads_follow_the_time_they_are_asked_at(case: Case, t: float) -> None:
    """Also on the step at t = 0.2, where heaviside is a half, and before it."""
    wanted = reference_rate(*case[:3], t, 5)
    np.testing.assert_allclose(rate(case, t, state(case, 5)), wanted, rtol=1e-12, atol=1e-13 * np.abs(wanted).max())


@pytest.mark.parametrize("case", [c for c in cases() if c.name.endswith(("everything", "held", "ring"))], ids=str)
def test_a_call_leaves_nothing_behind(case: Case) -> None:
    """Rates, Jacobians and solves of other states in between change no digit, and the state is not written to."""
    k, y, other = kernel(case), state(case, 6), state(case, 7)
    kept = y.copy()
    first = rate(case, T, y)
    J = k.jacobian(T, y)
    rate(case, 2 * T, other)
    k.observe(2 * T, other)
    k.prepare(2 * T, other)
    k.factor(0.3)
    k.solve(other, np.empty_like(other))
    k.jacobian(2 * T, other)
    np.testing.assert_array_equal(rate(case, T, y), first)
    np.testing.assert_array_equal(k.jacobian(T, y), J)
    np.testing.assert_array_equal(y, kept)


@pytest.mark.parametrize("case", [Case(name, 1, 1, "numpy") for name in NAMES], ids=str)
def test_the_smallest_rod_is_no_special_case(case: Case) -> None:
    """One element of degree 1 (two where there is a step): a point between two nodes, of which any may be held."""
    backends = ("numpy", "c") if case.name.endswith(("everything", "ring")) else ("numpy",)
    y, wanted = state(case, 21), reference_rate(*case[:3], T, 21)
    direction, slope = reference_derivative(*case[:3], 21)
    for backend in backends:
        k, out = like(Case(case.name, 6, 1, backend), rod(*case[:3])), np.empty_like(y)
        k.rate(T, y, out)
        np.testing.assert_allclose(out, wanted, rtol=1e-12, atol=1e-13 * np.abs(wanted).max())
        J = k.jacobian(T, y)
        rows = np.abs(J) @ np.abs(direction)
        assert np.all(np.abs(J @ direction - slope)[:-2] <= 1e-13 * rows[:-2] + 1e-16 * rows.max())
        k.prepare(T, y)
        k.factor(0.1)
        k.solve(y, out)
        matrix = implicit(case, J, 0.1)
        np.testing.assert_allclose(matrix @ out, y, rtol=0, atol=1e-13 * (np.abs(matrix) @ np.abs(out)).max())


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("motion", ["planar", "spatial"])
def test_unequal_elements_are_no_special_case(motion: str, backend: str) -> None:
    """A step off the middle: elements of two lengths, and a step of friction and weight on the node between them."""
    name, degree = f"{motion} held", 2
    uneven = changed(name, parameters={"middle": 0.4})
    r = yielding(discretise(uneven, 3, degree))
    assert len(set(np.round(r.mesh.half, 12))) == 2
    k = like(Case(name, 4, degree, backend), r)
    exact, y = oracle.Rod(uneven, r.mesh.edges, degree, r.base, given(r)), random_state(r, 8)
    wanted, out = oracle.floats(exact.rate(T, y)), np.empty_like(y)
    k.rate(T, y, out)
    np.testing.assert_allclose(out, wanted, rtol=1e-12, atol=1e-13 * np.abs(wanted).max())
    direction = np.random.default_rng(9).normal(size=len(y))
    slope, J = oracle.floats(exact.derivative(T, y, direction)), k.jacobian(T, y)
    assert np.all(np.abs(J @ direction - slope)[:-2] <= 1e-13 * (np.abs(J) @ np.abs(direction))[:-2])


@pytest.mark.parametrize("backend", ["numpy", "c"])
@pytest.mark.parametrize("name", ["planar towed", "spatial swept", "planar wrung", "spatial wrung"])
def test_a_driven_base_is_seen_at_every_time_of_the_run_and_at_no_other(name: str, backend: str) -> None:
    """In any cell of its course, on its edges and at both ends, as the other language sees it; outside there is no
    rate, rather than a wrong one."""
    case = Case(name, 4, 2, backend)
    course, y, other = rod(*case[:3]).course, state(case, 24), case._replace(backend="numpy")
    assert course is not None
    edges = course.edges
    for t in (*edges[[0, 1, 17, -2, -1]], *np.random.default_rng(3).uniform(edges[0], edges[-1], 20)):
        wanted = rate(other, t, y)
        np.testing.assert_allclose(rate(case, t, y), wanted, rtol=0, atol=1e-13 * np.abs(wanted).max())
    before = rate(case, np.nextafter(edges[5], 0), y)
    np.testing.assert_allclose(rate(case, edges[5], y), before, rtol=0, atol=1e-13 * np.abs(before).max())
    for t in (edges[0] - 0.1, edges[-1] + 0.1):
        assert np.isnan(rate(case, t, y)).any()
