"""The mesh: elements end where coefficients step, and its sums are those of the rod."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocosserat.discretisation.mesh import make_mesh
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.model.scene import load_scene

lengths = st.floats(1e-3, 1e3)
counts = st.integers(1, 12)
degrees = st.integers(1, 6)
fractions = st.lists(st.floats(0.02, 0.98), max_size=4)


@given(lengths, counts, degrees, fractions)
def test_an_element_ends_on_every_step(length: float, elements: int, degree: int, places: list[float]) -> None:
    """Each step inside is an element edge, to the last digit; the ends are the first and the last edge."""
    steps = [length * x for x in places]
    mesh = make_mesh(length, elements, degree, steps)
    assert (mesh.edges[0], mesh.edges[-1]) == (0.0, length)
    assert np.all(np.diff(mesh.edges) > 0)
    for x in steps:
        assert np.min(np.abs(mesh.edges - x)) <= 1e-9 * length


@given(lengths, counts, degrees, fractions)
def test_a_mesh_has_at_least_the_elements_asked_for(
    length: float, elements: int, degree: int, places: list[float]
) -> None:
    """And at most one more for each step."""
    mesh = make_mesh(length, elements, degree, [length * x for x in places])
    assert elements <= mesh.elements <= elements + len(places)
    assert make_mesh(length, elements, degree).elements == elements


def test_pieces_round_their_share_of_the_elements_up() -> None:
    """Four elements over three equal pieces are two each: rounding to the nearest would lose one."""
    assert make_mesh(1.0, 4, 1, [1 / 3, 2 / 3]).elements == 6
    assert make_mesh(1.0, 5, 1, [0.5]).elements == 6
    assert make_mesh(1.0, 6, 1, [0.5]).elements == 6


@given(lengths, counts, degrees, fractions)
def test_masses_and_weights_add_up_to_the_length(
    length: float, elements: int, degree: int, places: list[float]
) -> None:
    """Nodes and Gauss points both carry the whole rod, and nodes lie between points."""
    mesh = make_mesh(length, elements, degree, [length * x for x in places])
    assert mesh.u.shape == mesh.mass.shape == (mesh.elements * degree + 1,)
    assert mesh.u_point.shape == mesh.weight.shape == (mesh.elements * degree,)
    np.testing.assert_allclose([mesh.mass.sum(), mesh.weight.sum()], length, rtol=1e-13)
    assert np.all(mesh.u[:-1] < mesh.u_point)
    assert np.all(mesh.u_point < mesh.u[1:])
    np.testing.assert_array_equal(mesh.u[::degree], mesh.edges)


@pytest.mark.parametrize("twin", [0.3, 0.3 * (1 + 4e-16), 0.3 * (1 - 4e-16)])
def test_steps_that_differ_by_round_off_are_one_step(twin: float) -> None:
    """The same place written in two ways makes no element of length 1e-17."""
    mesh = make_mesh(1.0, 4, 3, [0.3, twin])
    assert mesh.half.min() > 0.05


def test_steps_that_are_near_but_not_the_same_are_two() -> None:
    """A thin layer is somebody's layer, not round-off."""
    np.testing.assert_array_equal(make_mesh(1.0, 1, 3, [0.3, 0.3 + 1e-12]).edges, [0.0, 0.3, 0.3 + 1e-12, 1.0])


@pytest.mark.parametrize("step", [0.0, 1.0, -0.5, 1.5, 1e-17, 1 - 1e-16])
def test_a_step_on_an_end_or_outside_makes_no_element(step: float) -> None:
    """Nothing changes inside the rod there."""
    np.testing.assert_array_equal(make_mesh(1.0, 4, 2, [step]).edges, make_mesh(1.0, 4, 2).edges)


def test_one_sided_places_are_inside_their_element_and_at_their_node() -> None:
    """Each element looks at its own side of a step, however small the elements are."""
    for elements in (1, 3, 1000, 100_000):
        mesh = make_mesh(7.0, elements, 2)
        places = mesh.local_nodes()
        assert np.all(mesh.edges[:-1] < places[:, 0])
        assert np.all(places[:, -1] < mesh.edges[1:])
        np.testing.assert_allclose(places[:, :-1].ravel(), mesh.u[:-1], rtol=0, atol=2e-13)


@pytest.mark.parametrize("where", ["stiffness", "friction", "reference", "start", "weight"])
def test_a_step_anywhere_in_a_scene_ends_an_element(where: str) -> None:
    """In the law, the friction, the shape at rest, at the start, and in the weight."""
    step = "1 + heaviside(u - 0.3)"
    entries = {
        "rod": {"stiffness": [1.0, 1.0, 1.0], "friction": [1.0, 1.0, 1.0], "reference": [1.0, 0.0, 0.0]},
        "start": {"strain": [1.0, 0.0, 0.0]},
    }
    if where == "start":
        entries["start"]["strain"][2] = step
    elif where != "weight":
        entries["rod"][where][2] = step
    values = {
        "rod": {"motion": "planar", "length": 1.0, **entries["rod"]},
        "start": entries["start"],
        "effects": [{"kind": "weight", "force": ["t*" + step, 0.0]}] if where == "weight" else [],
        "run": {"until": 1.0},
    }
    mesh = discretise(load_scene(values), 1, 4).mesh
    np.testing.assert_allclose(mesh.edges, [0.0, 0.3, 1.0], rtol=1e-15)
